//! Writes a campaign's table into the docs, with date, commit and command.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Puts `table` (lines of Markdown) between the markers of the table `name` of a document of the workspace, and says in
/// the first marker where it comes from: `command`, today, at the commit of a tree without changes.
///
/// # Errors
/// If the tree has changes in its sources, or the document no such table.
pub fn record(document: &str, name: &str, command: &str, table: &str) -> Result<(), String> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let said = |program: &str, arguments: &[&str]| {
        let output = Command::new(program)
            .args(arguments)
            .current_dir(&workspace)
            .output();
        let output = output.map_err(|error| format!("{program}: {error}"))?;
        Ok::<_, String>(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let changed = said("git", &["status", "--porcelain", "--", ":!docs"])?;
    if !changed.is_empty() {
        return Err(format!(
            "commit these first: a table names its commit\n{changed}"
        ));
    }
    let commit = said("git", &["rev-parse", "--short=7", "HEAD"])?;
    let date = said("date", &["+%F"])?;
    let machine = std::env::consts::ARCH.replace('_', "-");
    let stamp = format!("measured {date} at {commit} on {machine}; by: {command}");
    let path = workspace.join(document);
    let text = fs::read_to_string(&path).map_err(|error| format!("{document}: {error}"))?;
    let text =
        replaced(&text, name, &stamp, table).ok_or(format!("{document}: no table {name}"))?;
    fs::write(&path, text).map_err(|error| format!("{document}: {error}"))
}

/// The document with another table and stamp.
fn replaced(text: &str, name: &str, stamp: &str, table: &str) -> Option<String> {
    let opening = format!("<!-- table: {name};");
    let begin = text.find(&opening)?;
    let rest = &text[begin..];
    let end = begin + rest.find("<!-- end -->")?;
    let (before, after) = (&text[..begin], &text[end..]);
    Some(format!(
        "{before}{opening} {stamp} -->\n{}\n{after}",
        table.trim_end()
    ))
}
