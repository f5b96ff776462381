//! Numbers as the documents write them.

use anyhow::{bail, ensure};

/// How a number is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Whole: `12 652`.
    Count,
    /// With so many digits: `0.054`, `2.2e-16`.
    Digits(usize),
    /// With so many after the point.
    Fixed(usize),
}

impl Format {
    /// `digits N` or `fixed N`.
    pub fn parse(words: &[&str]) -> anyhow::Result<Self> {
        match *words {
            ["digits", digits] => Ok(Self::Digits(digits.parse()?)),
            ["fixed", digits] => Ok(Self::Fixed(digits.parse()?)),
            _ => bail!("\"{}\" is no format", words.join(" ")),
        }
    }

    /// The number, written so.
    pub fn of(self, number: f64) -> anyhow::Result<String> {
        ensure!(number.is_finite(), "it is no number");
        Ok(match self {
            Self::Count => count(number),
            Self::Digits(_) if number == 0.0 => "0".into(),
            Self::Digits(most) => digits(number, most.max(1)),
            Self::Fixed(after) => format!("{number:.after$}"),
        })
    }
}

/// Rounded, in groups of three.
fn count(number: f64) -> String {
    let digits = format!("{:.0}", number.abs());
    let mut text = String::from(if number <= -0.5 { "-" } else { "" });
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// From 1e-4 to 1e6 without an exponent.
fn digits(number: f64, most: usize) -> String {
    let text = format!("{number:.*e}", most - 1);
    let Some((_, exponent)) = text.split_once('e') else {
        return text;
    };
    match exponent.parse::<i32>() {
        Ok(exponent) if (-4..6).contains(&exponent) => {
            let after = (most as i32 - 1 - exponent).max(0) as usize;
            let rounded = text.parse::<f64>().unwrap_or(number);
            format!("{rounded:.after$}")
        }
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_in_the_documents() {
        for (format, number, text) in [
            (Format::Count, 12_652.4, "12 652"),
            (Format::Count, 441.0, "441"),
            (Format::Count, -1_174.6, "-1 175"),
            (Format::Digits(2), 2.220_446e-16, "2.2e-16"),
            (Format::Digits(2), 0.053_87, "0.054"),
            (Format::Digits(2), 0.0, "0"),
            (Format::Digits(3), 1_502.5, "1500"),
            (Format::Digits(4), 334.588, "334.6"),
            (Format::Digits(2), 0.000_13, "0.00013"),
            (Format::Digits(1), 0.99, "1"),
            (Format::Fixed(3), 0.069, "0.069"),
        ] {
            assert_eq!(format.of(number).unwrap(), text);
        }
        assert!(Format::Count.of(f64::NAN).is_err());
    }
}
