//! The measured tables of the documents, written from what was measured: `xtask/figures/README.md`.

mod blocks;
mod number;
mod program;
mod sources;
mod stamp;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail, ensure};

use self::blocks::Document;
use crate::{files, workspace};

/// For people, after the options.
pub const HELP: &str = "\
A measured table of README.md or docs/ stands between `<!-- table: NAME -->` and `<!-- end -->`.
It is one of these:
  generated  xtask/figures/NAME.md is its template; figures are written in the language of Jinja there
  stamped    the opening marker says where its figures come from:
             <!-- table: NAME; measured DATE at COMMIT on MACHINE; by: COMMAND -->
Edit the template of a generated table, not the document. What a template may say: xtask/figures/README.md.

Examples:
  cargo xtask figures                 writes all generated tables; `git diff` shows what changed
  cargo xtask figures --check         fails where one is not what was measured, as in CI
  cargo xtask budget --keep           measures the firmware again, and keeps it for the tables

It runs `limits`, `paper`, `trade` and `drop` of the program, half a minute in all.";

/// Writes the generated tables; or, to `check`, fails where one differs. Figures of the program come from `program`,
/// else from that of the tests, which it builds.
pub fn run(check: bool, program: Option<PathBuf>) -> anyhow::Result<()> {
    let documents = read_documents()?;
    let templates = read_templates(&workspace().join("xtask/figures"))?;
    one_origin_each(&documents, &templates)?;
    let program = program.map_or_else(program::built, Ok)?;
    println!("Figures: of {}", program.display());
    let fill = sources::filler(&program, &documents)?;
    let mut differences = Vec::new();
    for document in &documents {
        let mut text = document.text.clone();
        // From the last on, so that those before keep their places.
        for block in document.blocks.iter().rev() {
            let Some(template) = templates.get(&block.name) else {
                continue;
            };
            let new = fill(template).with_context(|| format!("xtask/figures/{}.md", block.name))?;
            let old = &document.text[block.body.clone()];
            if new != old {
                differences.push(difference(document, block, old, &new));
                text.replace_range(block.body.clone(), &new);
            }
        }
        if !check && text != document.text {
            fs::write(workspace().join(&document.file), text)
                .with_context(|| format!("cannot write {}", document.file))?;
        }
    }
    print!("{}", differences.concat());
    println!(
        "{} generated tables, {} of them {}",
        templates.len(),
        differences.len(),
        if check { "out of date" } else { "written" }
    );
    ensure!(
        !check || differences.is_empty(),
        "the documents are out of date: `cargo xtask figures` writes them"
    );
    Ok(())
}

/// README.md and all pages of docs/.
fn read_documents() -> anyhow::Result<Vec<Document>> {
    let mut files = files::below(&workspace().join("docs"), "md")?;
    files.insert(0, workspace().join("README.md"));
    let read = |file: &PathBuf| {
        let name = file.strip_prefix(workspace())?.display().to_string();
        Document::parse(name, files::text(file)?)
    };
    files.iter().map(read).collect()
}

/// By the name of their table.
fn read_templates(folder: &Path) -> anyhow::Result<BTreeMap<String, String>> {
    let mut templates = BTreeMap::new();
    for file in files::below(folder, "md")? {
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        if name != "README" {
            templates.insert(name.into_owned(), files::text(&file)?);
        }
    }
    Ok(templates)
}

/// Fails if a name stands twice, if a table has no template and no stamp, or both, or if a template has no table.
fn one_origin_each(
    documents: &[Document],
    templates: &BTreeMap<String, String>,
) -> anyhow::Result<()> {
    let mut places = BTreeMap::<&str, String>::new();
    for document in documents {
        for block in &document.blocks {
            let (name, place) = (block.name.as_str(), document.place(block));
            if let Some(first) = places.insert(name, place.clone()) {
                bail!("{place}: table {name} stands at {first} already");
            }
            match (templates.contains_key(name), block.stamped) {
                (false, false) => bail!(
                    "{place}: table {name} is neither generated (xtask/figures/{name}.md) nor stamped \
                     (<!-- table: {name}; measured DATE at COMMIT on MACHINE; by: COMMAND -->)"
                ),
                (true, true) => bail!("{place}: table {name} is generated, and stamped too"),
                _ => {}
            }
        }
    }
    match templates
        .keys()
        .find(|it| !places.contains_key(it.as_str()))
    {
        Some(name) => bail!("xtask/figures/{name}.md: no document has its table"),
        None => Ok(()),
    }
}

/// The lines of one that the other lacks.
fn difference(document: &Document, block: &blocks::Block, old: &str, new: &str) -> String {
    let lines = |sign: char, of: &str, other: &str| {
        let lacks = |line: &&str| !other.lines().any(|it| it == *line);
        let lines = of.lines().filter(lacks);
        lines
            .map(|it| format!("  {sign} {it}\n"))
            .collect::<String>()
    };
    let head = format!("{}: {}\n", document.place(block), block.name);
    head + &lines('-', old, new) + &lines('+', new, old)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> Document {
        Document::parse("a.md".into(), text.into()).unwrap()
    }

    #[test]
    fn the_documents_are_in_order() {
        let templates = read_templates(&workspace().join("xtask/figures")).unwrap();
        one_origin_each(&read_documents().unwrap(), &templates).unwrap();
    }

    #[test]
    fn a_table_has_one_name_and_one_origin() {
        let stamped =
            "<!-- table: a; measured 2026-11-21 at 7a3f1b5 on x86-64; by: x -->\n<!-- end -->\n";
        let none = BTreeMap::new();
        let bare = "<!-- table: a -->\n<!-- end -->\n";
        let template = BTreeMap::from([("a".to_owned(), String::new())]);
        let fails = |texts: &[&str], templates| {
            let documents: Vec<_> = texts.iter().map(|it| document(it)).collect();
            one_origin_each(&documents, templates)
                .err()
                .map(|it| it.to_string())
        };
        assert_eq!(fails(&[stamped], &none), None);
        assert_eq!(fails(&[bare], &template), None);
        for (texts, templates, error) in [
            (&[bare][..], &none, "neither generated"),
            (&[stamped], &template, "stamped too"),
            (&[], &template, "no document"),
            (&[bare, bare], &template, "stands at a.md:1 already"),
        ] {
            let found = fails(texts, templates).unwrap();
            assert!(found.contains(error), "{found}");
        }
    }
}
