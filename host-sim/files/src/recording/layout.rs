//! How a text is written: found in its first part.

use super::mapping::{Comment, Decimal, Delimiter, TextHints};
use super::pick::Heading;
use super::unit::is_unit;
use crate::stream::is_missing;

/// Bytes in which header and first rows must be.
pub const HEAD: usize = 1 << 16;
/// Rows that are looked at.
const LOOKED_AT: usize = 64;

/// How a text is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub delimiter: Delimiter,
    pub decimal: Decimal,
    /// What a line that is none of the table begins with.
    pub comment: Option<Comment>,
    /// The columns; without names where the file has none.
    pub columns: Vec<Heading>,
    /// Bytes and lines before the first row.
    pub before: (usize, u64),
}

/// A line that may be of the table.
struct Line {
    text: String,
    /// Its first byte in the head, and its number from 1.
    at: (usize, u64),
}

/// The text of bytes that are UTF-8, or else Latin-1.
pub fn text_of(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

impl Layout {
    /// From the first bytes of a file, `whole` if that is all of it. Else the line and the rule.
    pub fn find(head: &[u8], whole: bool, hints: &TextHints) -> Result<Self, (u64, String)> {
        if let Some(place) = head.iter().position(|byte| *byte == 0) {
            let line = 1 + head[..place].iter().filter(|it| **it == b'\n').count() as u64;
            let rule = "is no text: it has a zero byte (COMTRADE ends in .cfg, .dat or .cff; \
                        Parquet has to be converted to CSV: docs/use/recordings.md)";
            return Err((line, rule.to_owned()));
        }
        let has_mark = head.starts_with(b"\xef\xbb\xbf");
        let mut lines = lines(head, if has_mark { 3 } else { 0 });
        if !whole {
            lines.pop();
        }
        let comment = hints.comment.or_else(|| comment_of(&lines));
        let is_comment = |line: &&Line| comment.is_some_and(|it| line.begins_with(it));
        let is_blank = |it: &Line| it.text.trim().is_empty();
        let table = lines.iter().filter(|it| !is_blank(it) && !is_comment(it));
        let table: Vec<&Line> = table.collect();
        let tail = &table[table.len().saturating_sub(LOOKED_AT)..];
        let Some((delimiter, decimal)) = marks(tail, hints) else {
            let rule = "there are no rows of two numbers or more with commas, semicolons or tabs between them";
            return Err((table.first().map_or(1, |it| it.at.1), rule.to_owned()));
        };
        let fields = |line: &&Line| split(&line.text, delimiter);
        let usual = usual_rows(tail, delimiter);
        let width = usual.first().map_or(0, Vec::len);
        let numbers = |column: usize| {
            let fields = usual.iter().map(|row| &row[column]);
            fields.filter(|it| is_value(it, decimal)).count()
        };
        let numeric = (0..width).map(|column| 2 * numbers(column) > usual.len());
        let numeric: Vec<bool> = numeric.collect();
        let is_row = |line: &&Line| {
            let fields = fields(line);
            let numbers = fields.iter().filter(|it| is_number(it, decimal));
            fields.len() == width
                && numbers.count() > 0
                && (fields.iter().zip(&numeric))
                    .all(|(field, numeric)| !numeric || is_value(field, decimal))
        };
        let after = hints.header_line.unwrap_or(0);
        let Some(first) = table.iter().position(|it| it.at.1 > after && is_row(it)) else {
            let rule = format!("there are no rows of numbers in its first {HEAD} bytes");
            return Err((table.first().map_or(1, |it| it.at.1), rule));
        };
        let at = table[first].at;
        let above = table[..first].iter().rev();
        let above = above.take_while(|it| it.at.1 >= after).map(fields);
        let above = above.take_while(|it| it.len() == width).take(2);
        let mut above: Vec<Vec<String>> = above.collect();
        if above.is_empty() {
            // NumPy and gnuplot put the names into a comment.
            let mut before = lines.iter().rev().filter(|it| it.at.1 < at.1);
            let names = before.find(is_comment).map(|it| {
                let names = it.text.trim_start().trim_start_matches(['#', '%']);
                split(names.trim_start(), delimiter)
            });
            above.extend(names.filter(|it| it.len() == width));
        }
        let has_units = above.len() == 2 && above[0].iter().any(|it| is_unit(it));
        let none = vec![String::new(); width];
        let units = has_units.then(|| above.remove(0));
        let names = above.into_iter().next().unwrap_or_else(|| none.clone());
        let columns = names.into_iter().zip(units.unwrap_or(none));
        let columns = columns.map(|(text, unit)| Heading {
            text,
            unit: Some(unit).filter(|it| !it.is_empty()),
        });
        Ok(Self {
            delimiter,
            decimal,
            comment,
            columns: columns.collect(),
            before: (at.0, at.1 - 1),
        })
    }
}

impl Line {
    fn begins_with(&self, mark: Comment) -> bool {
        self.text.trim_start().as_bytes().first() == Some(&(mark as u8))
    }
}

/// Each line with its place; a last one without an end is one too.
fn lines(head: &[u8], from: usize) -> Vec<Line> {
    let (mut lines, mut start) = (Vec::new(), from);
    while start < head.len() {
        let rest = &head[start..];
        let length = rest.iter().position(|it| *it == b'\n' || *it == b'\r');
        let length = length.unwrap_or(rest.len());
        lines.push(Line {
            text: text_of(&rest[..length]),
            at: (start, lines.len() as u64 + 1),
        });
        let ends_in_both = rest[length..].starts_with(b"\r\n");
        start += length + if ends_in_both { 2 } else { 1 };
    }
    lines
}

fn comment_of(lines: &[Line]) -> Option<Comment> {
    let mut marks = [Comment::Hash, Comment::Percent].into_iter();
    marks.find(|mark| lines.iter().any(|it| it.begins_with(*mark)))
}

/// The fields of a line, without blanks and quotes about them, as they are read later.
fn split(line: &str, delimiter: Delimiter) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new();
    let reader = reader.has_headers(false).trim(csv::Trim::All);
    let reader = reader.delimiter(delimiter as u8);
    let record = reader.from_reader(line.as_bytes()).records().next();
    let record = record.and_then(Result::ok).unwrap_or_default();
    record.iter().map(str::to_owned).collect()
}

/// Delimiter and decimal sign by which most of the last lines' fields are numbers.
fn marks(tail: &[&Line], hints: &TextHints) -> Option<(Delimiter, Decimal)> {
    let mut best = None;
    let mut most = (0.0, 0);
    for delimiter in [Delimiter::Semicolon, Delimiter::Tab, Delimiter::Comma] {
        for decimal in [Decimal::Point, Decimal::Comma] {
            let wanted = hints.delimiter.is_none_or(|it| it == delimiter)
                && hints.decimal.is_none_or(|it| it == decimal);
            if !wanted || (delimiter == Delimiter::Comma && decimal == Decimal::Comma) {
                continue;
            }
            let mut fields = usual_rows(tail, delimiter);
            fields.retain(|row| row.len() > 1);
            let fields = fields.concat();
            let numbers = fields.iter().filter(|it| is_value(it, decimal)).count();
            let part = numbers as f64 / fields.len().max(1) as f64;
            if numbers > 0 && (part, numbers) > most {
                (most, best) = ((part, numbers), Some((delimiter, decimal)));
            }
        }
    }
    best
}

/// The fields of those lines that have as many as most.
fn usual_rows(lines: &[&Line], delimiter: Delimiter) -> Vec<Vec<String>> {
    let mut rows: Vec<_> = (lines.iter().map(|it| split(&it.text, delimiter))).collect();
    let alike = |row: &&Vec<String>| rows.iter().filter(|it| it.len() == row.len()).count();
    let width = rows.iter().max_by_key(alike).map_or(0, Vec::len);
    rows.retain(|it| it.len() == width);
    rows
}

/// A number, or what stands for a missing one.
fn is_value(field: &str, decimal: Decimal) -> bool {
    is_missing(field) || is_number(field, decimal)
}

fn is_number(field: &str, decimal: Decimal) -> bool {
    let begins = field.starts_with(|it: char| it.is_ascii_digit() || "+-.,".contains(it));
    begins && with_point(field, decimal).is_some_and(|it| it.parse::<f64>().is_ok())
}

/// The field with a decimal point; `None` where it has one but should not.
pub fn with_point(field: &str, decimal: Decimal) -> Option<std::borrow::Cow<'_, str>> {
    match decimal {
        Decimal::Point => Some(field.into()),
        Decimal::Comma if field.contains('.') => None,
        Decimal::Comma => Some(field.replacen(',', ".", 1).into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(text: &str) -> Layout {
        Layout::find(text.as_bytes(), true, &TextHints::default()).unwrap()
    }

    fn names(layout: &Layout) -> Vec<&str> {
        layout.columns.iter().map(|it| it.text.as_str()).collect()
    }

    #[test]
    fn decimal_commas_and_a_preamble() {
        let layout = find(
            "Messung 3;12.03.2024\r\nKanaele;3\r\n\r\nt;X1;Y1\r\ns;\u{b5}m;\u{b5}m\r\n0,000;1,5;-2\r\n0,001;;3\r\n",
        );
        assert_eq!(
            (layout.delimiter, layout.decimal),
            (Delimiter::Semicolon, Decimal::Comma)
        );
        assert_eq!(names(&layout), ["t", "X1", "Y1"]);
        assert_eq!(layout.columns[1].unit.as_deref(), Some("\u{b5}m"));
        assert_eq!(layout.before.1, 5);
    }

    #[test]
    fn names_in_a_comment_and_no_names_at_all() {
        let layout = find("# made by NumPy\n# t,x,y\n0,1,2\n1,2,3\n");
        assert_eq!(names(&layout), ["t", "x", "y"]);
        assert_eq!(layout.comment, Some(Comment::Hash));
        assert_eq!(names(&find("0\t1\t2\n1\t2\t3\n")), ["", "", ""]);
    }

    #[test]
    fn a_bad_cell_in_the_data_is_no_header() {
        let layout = find("t,x,y\n0,1,2\n1,one,3\n2,1,3\n3,1,3\n");
        assert_eq!(layout.before.1, 1);
        assert_eq!(names(&layout), ["t", "x", "y"]);
    }

    #[test]
    fn a_column_of_clock_times_is_left_alone() {
        let layout = find("clock,x,y\n12:00:00,1.5,2\n12:00:01,2.5,2\n");
        assert_eq!(names(&layout), ["clock", "x", "y"]);
        assert_eq!(layout.before.1, 1);
    }
}
