//! A broken rule of a scene, and where in the text it stands.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use touchdown_base::plain::Number;

use super::limits::Limit;

/// A key that breaks a rule.
#[derive(Debug)]
pub struct Diagnostic {
    /// Its table.
    pub table: &'static str,
    /// The key.
    pub key: &'static str,
    /// The rule that it breaks.
    pub rule: String,
    /// Where the table stands several times: which.
    row: usize,
}

impl Diagnostic {
    /// In a table that stands once.
    pub fn new(table: &'static str, key: &'static str, rule: impl Into<String>) -> Self {
        Self {
            table,
            key,
            rule: rule.into(),
            row: 0,
        }
    }

    /// In the table of this name that stands at `row`, from 0.
    pub fn in_row(self, row: usize) -> Self {
        Self { row, ..self }
    }

    /// Where the key stands; its table, or the start of the text, where it is not written.
    pub fn span(&self, text: &str) -> Range<usize> {
        let Ok(root) = DeTable::parse(text) else {
            return 0..0;
        };
        let Some((_, table)) = root.get_ref().get_key_value(self.table) else {
            return 0..0;
        };
        let table = match table.get_ref() {
            DeValue::Array(rows) => rows.get(self.row).unwrap_or(table),
            _ => table,
        };
        let key = table.get_ref().as_table().and_then(|t| {
            let (key, value) = t.get_key_value(self.key)?;
            Some(key.span().start..value.span().end)
        });
        key.unwrap_or_else(|| table.span())
    }
}

/// A rule that a number breaks, and its place.
type Broken = (String, Range<usize>);
/// Limits of the numbers of a key in a table.
pub type Limits = fn(&str, &str) -> Option<Limit>;

/// The first number of the text that is not finite or beyond its limits.
pub(super) fn first_broken(text: &str, limits: Limits) -> Option<Broken> {
    let root = DeTable::parse(text).ok()?;
    in_table("", root.get_ref(), limits)
}

fn in_table(name: &str, table: &DeTable<'_>, limits: Limits) -> Option<Broken> {
    let broken = table.iter().filter_map(|(key, value)| {
        let whole = key.span().start..value.span().end;
        in_value(name, key.get_ref(), value, whole, limits)
    });
    broken.min_by_key(|(_, span)| span.start)
}

/// `whole` is the place of key and value.
fn in_value(
    table: &str,
    key: &str,
    value: &Spanned<DeValue<'_>>,
    whole: Range<usize>,
    limits: Limits,
) -> Option<Broken> {
    let number = match value.get_ref() {
        DeValue::Float(it) => it.as_str().parse().unwrap_or(f64::NAN),
        DeValue::Integer(it) => i64::from_str_radix(it.as_str(), it.radix()).ok()? as f64,
        DeValue::Table(inner) => return in_table(key, inner, limits),
        DeValue::Array(items) => {
            let mut items = items.iter();
            return items.find_map(|it| in_value(table, key, it, whole.clone(), limits));
        }
        _ => return None,
    };
    if !number.is_finite() {
        return Some((format!("{key} must be a finite number"), value.span()));
    }
    let rule = limits(table, key)?.broken(number)?;
    let number = Number(number);
    Some((format!("{key} must be {rule}, is {number}"), whole))
}
