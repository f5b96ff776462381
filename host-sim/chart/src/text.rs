//! Numbers as text.

use crate::plot::minus;

/// A number with four significant digits and an SI prefix before its unit.
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [&str; 9] = ["f", "p", "n", "\u{b5}", "m", "", "k", "M", "G"];
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    let group = match value {
        0.0 => 0,
        _ => ((value.abs().log10() + 1e-9) / 3.0)
            .floor()
            .clamp(-5.0, 3.0) as i32,
    };
    let prefix = PREFIXES[(group + 5) as usize];
    let scaled = significant(value / 1000f64.powi(group), 4);
    format!("{scaled}\u{a0}{prefix}{unit}")
}

/// A number rounded to so many significant digits, without trailing zeros and exponent.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    } else if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 17) as usize;
    let text = format!("{value:.decimals$}");
    let short = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    minus(short)
}

/// A time in milliseconds, to the microsecond, without its unit.
pub fn ms(seconds: f64) -> String {
    minus(&format!("{:.3}", seconds * 1e3))
}

/// A value as `show` writes it, a dash where there is none.
pub fn or_dash(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.map_or("\u{2013}".to_owned(), show)
}

/// A positive quantity in a column: three decimals, powers of ten where they would all be zero.
pub fn column(value: f64) -> String {
    match value >= 1e-3 {
        true => format!("{value:.3}"),
        false => error(value),
    }
}

/// A small error, in powers of ten.
pub fn error(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ => minus(&format!("{value:.1e}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(si(0.0767213, "m/s"), "76.72\u{a0}mm/s");
        assert_eq!(si(3.42, "kg"), "3.42\u{a0}kg");
        assert_eq!(si(-0.001, "s"), "\u{2212}1\u{a0}ms");
        assert_eq!(si(0.0, "s"), "0\u{a0}s");
        assert_eq!(significant(30000.0, 4), "30000");
        assert_eq!(significant(-1389.84, 4), "\u{2212}1390");
        assert_eq!(ms(0.007811915), "7.812");
        assert_eq!(error(-2.14e-12), "\u{2212}2.1e\u{2212}12");
    }
}
