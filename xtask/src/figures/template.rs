//! A template: text with figures in it, each as `{{SOURCE WORDS / UNIT : FORMAT}}`.

use anyhow::{Context, bail, ensure};

use super::number::Format;

/// What a source gives.
#[derive(Clone, Debug, PartialEq)]
pub enum Figure {
    Number(f64),
    /// As it is, of one line or more.
    Text(String),
}

/// Puts in each figure what `source` gives for its words.
pub fn expand(
    template: &str,
    source: impl Fn(&[&str]) -> anyhow::Result<Figure>,
) -> anyhow::Result<String> {
    let (mut text, mut rest) = (String::new(), template);
    while let Some((before, after)) = rest.split_once("{{") {
        let (inner, after) = after.split_once("}}").context("{{ is not closed")?;
        text += before;
        text += &figure(inner, &source).with_context(|| format!("{{{{{inner}}}}}"))?;
        rest = after;
    }
    Ok(text + rest)
}

fn figure(
    inner: &str,
    source: impl Fn(&[&str]) -> anyhow::Result<Figure>,
) -> anyhow::Result<String> {
    let words = words(inner)?;
    let colon = words.iter().position(|it| *it == ":");
    let (mut words, format) = words.split_at(colon.unwrap_or(words.len()));
    let mut unit = 1.0;
    if let [before @ .., "/", number] = words {
        (words, unit) = (before, number.parse()?);
    }
    match (source(words)?, format) {
        (Figure::Number(number), []) => Format::Count.of(number / unit),
        (Figure::Number(number), [_, format @ ..]) => Format::parse(format)?.of(number / unit),
        (Figure::Text(text), []) => Ok(text),
        (Figure::Text(_), _) => bail!("a text has no format"),
    }
}

/// Between spaces, or quoted.
fn words(inner: &str) -> anyhow::Result<Vec<&str>> {
    let (mut words, mut rest) = (Vec::new(), inner.trim());
    while !rest.is_empty() {
        let (word, after) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').context("\" is not closed")?,
            None => rest.split_once(' ').unwrap_or((rest, "")),
        };
        words.push(word);
        rest = after.trim_start();
    }
    ensure!(!words.is_empty(), "no source is named");
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(words: &[&str]) -> anyhow::Result<Figure> {
        match *words {
            ["tick", "worst"] => Ok(Figure::Number(7272.0)),
            ["name of it"] => Ok(Figure::Text("rig".into())),
            _ => bail!("no {words:?}"),
        }
    }

    #[test]
    fn figures_take_the_place_of_their_words() {
        let text = expand("| {{tick worst}} | {{ \"name of it\" }} |", source).unwrap();
        assert_eq!(text, "| 7 272 | rig |");
        let text = expand("{{tick worst / 1e3 : digits 2}} k", source).unwrap();
        assert_eq!(text, "7.3 k");
    }

    #[test]
    fn errors_show_the_figure() {
        let error = |text| format!("{:#}", expand(text, source).unwrap_err());
        assert_eq!(error("{{tick}}"), "{{tick}}: no [\"tick\"]");
        assert_eq!(error("a {{tick"), "{{ is not closed");
        assert!(error("{{\"name of it\" : digits 2}}").contains("no format"));
        assert!(error("{{tick worst : round}}").contains("round"));
    }
}
