//! Numbers as the documents write them: filters of the templates.

use minijinja::{Error, ErrorKind};

fn finite(number: f64) -> Result<f64, Error> {
    let error = || Error::new(ErrorKind::InvalidOperation, "it is no number");
    Some(number).filter(|it| it.is_finite()).ok_or_else(error)
}

/// Rounded to a whole one, in groups of three: `12 652`.
pub fn count(number: f64) -> Result<String, Error> {
    let digits = format!("{:.0}", finite(number)?.abs());
    let mut text = String::from(if number <= -0.5 { "-" } else { "" });
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    Ok(text)
}

/// With so many digits, from 1e-4 to 1e6 without an exponent: `0.054`, `2.2e-16`.
pub fn digits(number: f64, most: usize) -> Result<String, Error> {
    if finite(number)? == 0.0 {
        return Ok("0".into());
    }
    let text = format!("{number:.*e}", most.max(1) - 1);
    let exponent = text.split_once('e').and_then(|it| it.1.parse().ok());
    Ok(match exponent {
        Some(exponent @ -4..6) => {
            let after = (most.max(1) as i32 - 1 - exponent).max(0) as usize;
            let rounded = text.parse().unwrap_or(number);
            format!("{rounded:.after$}")
        }
        _ => text,
    })
}

/// With so many digits after the point.
pub fn fixed(number: f64, after: usize) -> Result<String, Error> {
    Ok(format!("{:.after$}", finite(number)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_in_the_documents() {
        for (number, text) in [(12_652.4, "12 652"), (441.0, "441"), (-1_174.6, "-1 175")] {
            assert_eq!(count(number).unwrap(), text);
        }
        for (number, most, text) in [
            (2.220_446e-16, 2, "2.2e-16"),
            (0.053_87, 2, "0.054"),
            (0.0, 2, "0"),
            (1_502.5, 3, "1500"),
            (334.588, 4, "334.6"),
            (0.000_13, 2, "0.00013"),
            (0.99, 1, "1"),
        ] {
            assert_eq!(digits(number, most).unwrap(), text);
        }
        assert_eq!(fixed(0.069, 3).unwrap(), "0.069");
        assert!(count(f64::NAN).is_err());
    }
}
