//! A broken rule of a scene, and where in the text it stands.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

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

/// The first number of the text that is not finite: its key and its place.
pub(super) fn not_finite(text: &str) -> Option<(String, Range<usize>)> {
    let root = DeTable::parse(text).ok()?;
    in_table(root.get_ref())
}

fn in_table(table: &DeTable<'_>) -> Option<(String, Range<usize>)> {
    let found = table.iter().filter_map(|(key, value)| {
        let (inner, span) = in_value(value.get_ref(), value.span())?;
        Some((inner.unwrap_or_else(|| key.get_ref().to_string()), span))
    });
    found.min_by_key(|(_, span)| span.start)
}

/// With the key where the number stands in a table of its own.
fn in_value(value: &DeValue<'_>, span: Range<usize>) -> Option<(Option<String>, Range<usize>)> {
    match value {
        DeValue::Float(number) => {
            let finite = number.as_str().parse().is_ok_and(f64::is_finite);
            (!finite).then_some((None, span))
        }
        DeValue::Array(items) => items
            .iter()
            .find_map(|item| in_value(item.get_ref(), item.span())),
        DeValue::Table(table) => in_table(table).map(|(key, span)| (Some(key), span)),
        _ => None,
    }
}
