//! What a search looks for, and what it found.

use serde::Serialize;

use super::parameter::short;

/// What a search found along its axis, which it takes whirl to grow or to fall along.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    pub(super) key: String,
    pub(super) limit: f64,
    /// With 0.95 at least, whirl is less probable than the limit here; none of the values.
    pub(super) below_at: Option<f64>,
    /// And more probable here.
    pub(super) above_at: Option<f64>,
    pub(super) confidence: f64,
}

/// What is looked for, from `whirl < LIMIT`: where whirl is less probable than that.
pub(super) fn limit(text: &str) -> Result<f64, String> {
    let rule = || "find is \"whirl < P\", P between 0 and 1: its values are 0 to 1".to_owned();
    let (what, limit) = text.split_once('<').ok_or_else(rule)?;
    let limit: f64 = limit.trim().parse().map_err(|_| rule())?;
    if what.trim() != "whirl" || !(limit > 0.0 && limit < 1.0) {
        return Err(rule());
    }
    Ok(limit)
}

impl Found {
    /// For people.
    pub fn told(&self) -> String {
        let Self { key, limit, .. } = self;
        let sure = format!("with {} % confidence", 100.0 * self.confidence);
        let [below, above] =
            [self.below_at, self.above_at].map(|it| it.map(|it| short(&it.to_string())));
        match (below, above) {
            (Some(below), Some(above)) => format!(
                "Whirl is less probable than {limit} at {key} = {below} and more probable at {above}, {sure}."
            ),
            (Some(below), None) => {
                format!("Whirl is less probable than {limit} up to {key} = {below}, {sure}.")
            }
            (None, Some(above)) => {
                format!("Whirl is more probable than {limit} from {key} = {above} on, {sure}.")
            }
            (None, None) => format!("No value of {key} was decided: give more drops."),
        }
    }
}
