//! What is wrong with an input file: the file, the line and the rule.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;
use std::sync::Arc;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use crate::plain::shown;

/// Larger than any scene, plan or mapping, bytes.
pub const LARGEST_TOML: u64 = 4 << 20;

/// A flaw in a scene or a recorded stream.
#[derive(Debug, Diagnostic, Error)]
#[error("{}{}: {}", shown(.file), .line.map_or(String::new(), |it| format!(":{it}")), shown(.rule))]
pub struct InputError {
    file: String,
    line: Option<u64>,
    rule: String,
    #[source_code]
    excerpt: Option<Arc<NamedSource<String>>>,
    #[label]
    span: Option<SourceSpan>,
}

impl InputError {
    /// A flaw of the file as a whole.
    pub fn of_file(file: &str, rule: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line: None,
            rule: rule.into(),
            excerpt: None,
            span: None,
        }
    }

    /// A flaw of one line, counted from 1.
    pub fn at_line(file: &str, line: u64, rule: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::of_file(file, rule)
        }
    }

    /// A flaw of the bytes `span` of `text`; the excerpt is shown.
    pub fn at_span(
        file: &str,
        text: &str,
        span: std::ops::Range<usize>,
        rule: impl Into<String>,
    ) -> Self {
        let start = text.floor_char_boundary(span.start.min(text.len()));
        let end = text.ceil_char_boundary(span.end.clamp(start, text.len()));
        let line = 1 + text[..start].matches('\n').count();
        let parts = [&text[..start], &text[start..end], &text[end..]].map(shown);
        let source = NamedSource::new(shown(file), parts.concat());
        Self {
            excerpt: Some(Arc::new(source.with_language("toml"))),
            span: Some((parts[0].len(), parts[1].len()).into()),
            ..Self::at_line(file, line as u64, rule)
        }
    }

    /// The same of a file that another file names, which may be none of the reader's: nothing of its text is told, neither
    /// the excerpt nor what the rule quotes.
    pub fn of_named_file(self) -> Self {
        Self {
            rule: without_quotes(&self.rule),
            excerpt: None,
            span: None,
            ..self
        }
    }

    /// The same, with more about the rule.
    pub fn and(mut self, more: String) -> Self {
        self.rule += &more;
        self
    }

    /// The same, so many lines further on.
    pub fn further(mut self, lines: u64) -> Self {
        self.line = self.line.map(|line| line + lines);
        self
    }

    /// The whole text of a file of at most `most` bytes.
    pub fn read(path: &Path, most: u64) -> Result<String, Self> {
        let bytes = Self::read_bytes(path, most)?;
        let file = path.display().to_string();
        if is_utf_16(&bytes) {
            return Err(Self::at_line(&file, 1, UTF_16));
        }
        String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let before = &error.as_bytes()[..valid];
            let line = 1 + before.iter().filter(|b| **b == b'\n').count();
            Self::at_line(&file, line as u64, "the text is not UTF-8")
        })
    }

    /// All bytes of a file, at most `most`; what is not a file may have no end.
    pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, Self> {
        let file = path.display().to_string();
        let unread = |error: std::io::Error| Self::of_file(&file, reason(&error));
        let (there, size) = Self::open(path)?;
        let mut bytes = Vec::new();
        if size <= most {
            there
                .take(most + 1)
                .read_to_end(&mut bytes)
                .map_err(unread)?;
            if bytes.len() as u64 <= most {
                return Ok(bytes);
            }
        }
        let rule = format!("is larger than {} MiB, the most that is read", most >> 20);
        Err(Self::of_file(&file, rule))
    }

    /// Opens a file; also how many bytes it has.
    pub fn open(path: &Path) -> Result<(BufReader<File>, u64), Self> {
        let file = path.display().to_string();
        if path.is_dir() {
            return Err(Self::of_file(&file, "is a folder, not a file"));
        }
        let unread = |error: std::io::Error| Self::of_file(&file, reason(&error));
        let there = File::open(path).map_err(unread)?;
        let size = there.metadata().map_err(unread)?.len();
        Ok((BufReader::with_capacity(1 << 16, there), size))
    }

    /// The rule that is broken; may quote the file as it is.
    pub fn rule(&self) -> &str {
        &self.rule
    }

    /// The line, counted from 1.
    pub fn line(&self) -> Option<u64> {
        self.line
    }
}

/// Dots for all from the first quotation mark or grave accent to the last.
fn without_quotes(rule: &str) -> String {
    const MARKS: [char; 2] = ['"', '`'];
    match (rule.find(MARKS), rule.rfind(MARKS)) {
        (Some(first), Some(last)) if first < last => {
            format!("{}...{}", &rule[..=first], &rule[last..])
        }
        _ => rule.to_owned(),
    }
}

/// What is wrong with a text of [`is_utf_16`].
pub const UTF_16: &str = "the text is UTF-16; save it as UTF-8";

/// Whether a text begins as UTF-16 does.
pub fn is_utf_16(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff])
}

/// Why a file cannot be opened, read or written, without the number of the system's error.
pub fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        std::io::ErrorKind::NotADirectory => "is no folder".to_owned(),
        _ => match error.to_string().split_once(" (os error") {
            Some((text, _)) => text.to_owned(),
            None => error.to_string(),
        },
    }
}
