//! A parameter of a sweep: a key of the scene, and the values that it takes.

use rand::Rng;
use rand_distr::{Distribution as _, Normal};
use serde::Deserialize;
use toml::{Spanned, Value};

use touchdown_scene::rule::exactly_if_there;

/// As it is written in the plan.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterTable {
    pub key: Spanned<String>,
    values: Option<Vec<Value>>,
    from: Option<f64>,
    to: Option<f64>,
    steps: Option<u32>,
    #[serde(default)]
    log: bool,
    #[serde(default, deserialize_with = "exactly_if_there")]
    uniform: Option<[f64; 2]>,
    #[serde(default, deserialize_with = "exactly_if_there")]
    log_uniform: Option<[f64; 2]>,
    #[serde(default, deserialize_with = "exactly_if_there")]
    normal: Option<[f64; 2]>,
}

/// Most values of a range.
const MOST_STEPS: u32 = 1_000;

/// What a parameter takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    /// Each in turn: one axis of the grid.
    Listed(Vec<Value>),
    /// Drawn anew for each drop.
    Drawn(Distribution),
}

/// Of a drawn parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Distribution {
    /// Evenly between both.
    Uniform(f64, f64),
    /// Evenly between the logarithms of both.
    LogUniform(f64, f64),
    /// Mean and standard deviation.
    Normal(f64, f64),
}

impl ParameterTable {
    /// The values; the rule, where there are none.
    pub fn values(&self) -> Result<Values, String> {
        let range = self.from.is_some() || self.to.is_some() || self.steps.is_some();
        let drawn = [self.uniform, self.log_uniform, self.normal];
        let lists = usize::from(self.values.is_some()) + usize::from(range);
        if lists + drawn.iter().flatten().count() != 1 {
            return Err(
                "takes one of: values; from, to and steps; uniform; log_uniform; normal".to_owned(),
            );
        }
        if self.log && !range {
            return Err("log belongs to from, to and steps".to_owned());
        }
        let distribution = match drawn {
            [Some([lo, hi]), ..] => {
                ordered(lo, hi)?;
                Distribution::Uniform(lo, hi)
            }
            [_, Some([lo, hi]), _] => {
                ordered(lo, hi)?;
                above_zero(lo)?;
                Distribution::LogUniform(lo, hi)
            }
            [.., Some([mean, deviation])] => {
                if !(mean.is_finite() && deviation.is_finite() && deviation > 0.0) {
                    return Err("normal takes a mean and a standard deviation above 0".to_owned());
                }
                Distribution::Normal(mean, deviation)
            }
            _ => {
                let listed = self.values.as_deref().map_or_else(|| self.range(), listed);
                return listed.map(Values::Listed);
            }
        };
        Ok(Values::Drawn(distribution))
    }

    fn range(&self) -> Result<Vec<Value>, String> {
        let (Some(from), Some(to), Some(steps)) = (self.from, self.to, self.steps) else {
            return Err("a range takes from, to and steps (how many values)".to_owned());
        };
        if !(2..=MOST_STEPS).contains(&steps) {
            return Err(format!("steps must be 2 to {MOST_STEPS}, not {steps}"));
        }
        if !(from.is_finite() && to.is_finite()) {
            return Err("from and to must be finite".to_owned());
        }
        if self.log {
            above_zero(from.min(to))?;
        }
        let value = |k: u32| {
            let part = f64::from(k) / f64::from(steps - 1);
            match (k, self.log) {
                (0, _) => from,
                (k, _) if k == steps - 1 => to,
                (_, true) => from * (to / from).powf(part),
                (_, false) => from + (to - from) * part,
            }
        };
        Ok((0..steps).map(|k| Value::Float(value(k))).collect())
    }
}

fn listed(values: &[Value]) -> Result<Vec<Value>, String> {
    let is_plain = |it: &Value| !(it.is_array() || it.is_table() || it.is_datetime());
    if values.is_empty() || !values.iter().all(is_plain) {
        return Err("values must be a list of numbers, texts or booleans".to_owned());
    }
    for (index, value) in values.iter().enumerate() {
        if values[..index].contains(value) {
            return Err(format!("has the value {value} twice"));
        }
    }
    Ok(values.to_vec())
}

fn ordered(lo: f64, hi: f64) -> Result<(), String> {
    let is_ordered = lo.is_finite() && hi.is_finite() && lo < hi;
    let rule = || format!("takes a lower and an upper end, not {lo} and {hi}");
    is_ordered.then_some(()).ok_or_else(rule)
}

fn above_zero(value: f64) -> Result<(), String> {
    let rule = || format!("a logarithmic scale needs values above 0, not {value}");
    (value > 0.0).then_some(()).ok_or_else(rule)
}

impl Distribution {
    /// One value.
    pub fn draw(&self, random: &mut impl Rng) -> f64 {
        match *self {
            Self::Uniform(lo, hi) => random.random_range(lo..hi),
            Self::LogUniform(lo, hi) => random.random_range(lo.ln()..hi.ln()).exp(),
            // A deviation above 0 is always accepted.
            Self::Normal(mean, deviation) => {
                Normal::new(mean, deviation).map_or(mean, |it| it.sample(random))
            }
        }
    }

    /// Values to try a scene with before the sweep begins.
    pub fn samples(&self) -> Vec<f64> {
        match *self {
            Self::Uniform(lo, hi) | Self::LogUniform(lo, hi) => vec![lo, hi],
            Self::Normal(mean, deviation) => {
                [-4.0, 0.0, 4.0].map(|k| mean + k * deviation).to_vec()
            }
        }
    }
}

/// Of a whole or decimal number.
pub(super) fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(whole) => Some(*whole as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// For people and tables.
pub(super) fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => format!("{number}"),
        other => other.to_string(),
    }
}

/// A number of a range can have seventeen digits.
pub(super) fn short(value: &str) -> String {
    match value.parse::<f64>() {
        Ok(number) if value.len() > 8 => {
            let digits = 4 - number.abs().max(1e-300).log10().floor() as i32;
            let scale = 10f64.powi(digits.clamp(0, 12));
            format!("{}", (number * scale).round() / scale)
        }
        _ => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Result<Values, String> {
        let table = format!("key = \"retainer.friction\"\n{text}");
        toml::from_str::<ParameterTable>(&table)
            .expect(text)
            .values()
    }

    #[test]
    fn a_range_has_both_its_ends() {
        let Ok(Values::Listed(found)) = values("from = 0.1\nto = 0.4\nsteps = 4") else {
            panic!("a range is a list");
        };
        let found: Vec<_> = found.iter().filter_map(Value::as_float).collect();
        assert_eq!([found[0], found[3]], [0.1, 0.4]);
        assert!((found[1] - 0.2).abs() < 1e-15 && found.len() == 4);
        let Ok(Values::Listed(found)) = values("from = 1\nto = 100\nsteps = 3\nlog = true") else {
            panic!("a range is a list");
        };
        assert!((found[1].as_float().expect("a number") - 10.0).abs() < 1e-12);
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for text in [
            "",
            "values = []",
            "values = [1, 1]",
            "values = [[1]]",
            "values = [1]\nuniform = [0, 1]",
            "from = 1\nto = 2",
            "from = 1\nto = 2\nsteps = 1",
            "from = 0\nto = 2\nsteps = 3\nlog = true",
            "uniform = [2, 1]",
            "log_uniform = [0, 1]",
            "normal = [1, 0]",
            "values = [1]\nlog = true",
        ] {
            assert!(values(text).is_err(), "{text}");
        }
    }

    #[test]
    fn long_numbers_become_short() {
        assert_eq!(short("0.30000000000000004"), "0.3");
        assert_eq!(short("12345.678912"), "12346");
        assert_eq!(short("polynomial-of-old"), "polynomial-of-old");
        assert_eq!(short("0.1"), "0.1");
    }
}
