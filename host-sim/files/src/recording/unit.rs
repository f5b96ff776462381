//! Units as loggers and people write them.

use serde::Deserialize;

/// Of a displacement, or of what a sensor gives for one.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub enum Displacement {
    /// Metres in one of it.
    Length(f64),
    /// Volts in one of it.
    Volts(f64),
}

/// Of a time: the power of ten of its seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Time(pub i32);

/// Of a speed: rad/s in one of it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub struct Speed(pub f64);

/// Volts per metre of displacement, as in `"200 mV/mil"`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub struct Sensitivity(pub f64);

const INCH: f64 = 25.4e-3;
const TURN: f64 = std::f64::consts::TAU;

/// Without brackets, in lower case but for a leading M, with one letter for micro.
fn plain(text: &str) -> String {
    let text = text.trim().trim_matches(['[', ']', '(', ')']).trim();
    let text: String = text.chars().filter(|it| !it.is_whitespace()).collect();
    text.replace(['\u{b5}', '\u{3bc}'], "u").to_lowercase()
}

fn unknown<T>(quantity: &str, units: &str, text: &str) -> Result<T, String> {
    let rule = format!("must be {units}, is {text:?}");
    Err(format!("the unit of {quantity} {rule}"))
}

impl TryFrom<String> for Displacement {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Ok(match plain(&text).as_str() {
            "um" | "micron" | "microns" | "micrometer" | "micrometre" => Self::Length(1e-6),
            "nm" => Self::Length(1e-9),
            "mm" => Self::Length(1e-3),
            "m" => Self::Length(1.0),
            "mil" | "mils" | "thou" => Self::Length(1e-3 * INCH),
            "in" | "inch" => Self::Length(INCH),
            "v" | "volt" | "volts" => Self::Volts(1.0),
            "mv" => Self::Volts(1e-3),
            _ => return unknown("a displacement", "um, nm, mm, m, mil, in, V or mV", &text),
        })
    }
}

impl TryFrom<String> for Time {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Ok(Self(match plain(&text).as_str() {
            "s" | "sec" | "second" | "seconds" => 0,
            "ms" | "msec" => -3,
            "us" | "usec" => -6,
            "ns" => -9,
            _ => return unknown("time", "s, ms, us or ns", &text),
        }))
    }
}

impl TryFrom<String> for Speed {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Ok(Self(match plain(&text).as_str() {
            "rpm" | "r/min" | "1/min" | "min-1" | "rev/min" => TURN / 60.0,
            "rad/s" => 1.0,
            "hz" | "1/s" | "rps" | "rev/s" => TURN,
            _ => return unknown("a speed", "rpm, rad/s or Hz", &text),
        }))
    }
}

impl TryFrom<String> for Sensitivity {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let rule = || {
            let examples = "as \"200 mV/mil\" or \"-7.87 V/mm\"";
            format!("a sensitivity is a number and its unit, {examples}, is {text:?}")
        };
        let text = text.trim();
        let digits = |it: char| it.is_ascii_digit() || "+-.".contains(it);
        let end = text.find(|it| !digits(it)).ok_or_else(rule)?;
        let number: f64 = text[..end].parse().map_err(|_| rule())?;
        let (volts, length) = text[end..].split_once('/').ok_or_else(rule)?;
        let units = [volts, length].map(|it| it.to_owned().try_into());
        let [
            Ok(Displacement::Volts(volts)),
            Ok(Displacement::Length(length)),
        ] = units
        else {
            return Err(rule());
        };
        if number == 0.0 {
            return Err("a sensitivity must not be 0".to_owned());
        }
        Ok(Self(number * volts / length))
    }
}

/// A column's name and the unit in it: `X1 [um]`, `X1 (um)`, `X1 / um`, `X1, um`, `x1_um`.
pub fn split(heading: &str) -> (&str, Option<&str>) {
    let heading = heading.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inside) = heading.strip_suffix(close)
            && let Some((name, unit)) = inside.rsplit_once(open)
        {
            return (name.trim(), Some(unit.trim()));
        }
    }
    for between in [" / ", ", ", "_"] {
        if let Some((name, unit)) = heading.rsplit_once(between)
            && is_unit(unit)
        {
            return (name.trim(), Some(unit.trim()));
        }
    }
    (heading, None)
}

/// Whether it is the unit of anything that a recording has.
pub fn is_unit(text: &str) -> bool {
    let text = || text.to_owned();
    Displacement::try_from(text()).is_ok()
        || Time::try_from(text()).is_ok()
        || Speed::try_from(text()).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_have_their_units_in_many_places() {
        for heading in [
            "X1 [\u{b5}m]",
            "X1 (\u{3bc}m)",
            "X1 / um",
            "X1, um",
            "X1_um",
        ] {
            let (name, unit) = split(heading);
            assert_eq!(name, "X1", "{heading}");
            assert_eq!(
                unit.unwrap().to_owned().try_into(),
                Ok(Displacement::Length(1e-6)),
                "{heading}"
            );
        }
        assert_eq!(split("shaft_x"), ("shaft_x", None));
        assert_eq!(split("Speed [1/min]"), ("Speed", Some("1/min")));
    }

    #[test]
    fn sensitivities_of_proximity_probes() {
        let of = |text: &str| Sensitivity::try_from(text.to_owned()).map(|it| it.0);
        // 200 mV/mil is 7.874 V/mm.
        assert!((of("200 mV/mil").unwrap() - 7_874.015_748).abs() < 1e-3);
        assert!((of("-7.87 V/mm").unwrap() + 7870.0).abs() < 1e-9);
        for wrong in [
            "200",
            "200 mV",
            "mV/mil",
            "0 V/mm",
            "200 mil/mV",
            "1.2.3 V/mm",
        ] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
    }
}
