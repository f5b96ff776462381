//! What two configurations differ in.

use serde::Serialize;
use touchdown_protocol::config_block::Settings;

use super::file;

/// A key that has another value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// With its table, as `retainer.clearance_mm`.
    pub key: String,
    /// As it was written, where it was.
    pub from: Option<String>,
    /// As it is written, where it is.
    pub to: Option<String>,
}

/// What changes from `old` to `new`, in the words of the file.
pub fn differences(old: &Settings, new: &Settings) -> Vec<Difference> {
    let [old, new] = [old, new].map(|it| lines(&file::text(it)));
    let value = |lines: &[(String, String)], key: &str| {
        let line = lines.iter().find(|(it, _)| it == key);
        line.map(|(_, value)| value.clone())
    };
    let gone = old.iter().filter(|(key, _)| value(&new, key).is_none());
    let keys = new.iter().chain(gone).map(|(key, _)| key);
    let all = keys.map(|key| Difference {
        from: value(&old, key),
        to: value(&new, key),
        key: key.clone(),
    });
    all.filter(|it| it.from != it.to).collect()
}

/// Key and value of each line: none of ours goes over two.
fn lines(text: &str) -> Vec<(String, String)> {
    let mut table = "";
    let mut lines = Vec::new();
    for line in text.lines() {
        if let Some((key, value)) = line.split_once(" = ") {
            let key = key.trim_start_matches("# ");
            lines.push((format!("{table}.{key}"), value.to_owned()));
        } else {
            table = line.trim_matches(['[', ']']);
        }
    }
    lines
}
