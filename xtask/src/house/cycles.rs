//! Files of a crate that import one another in a circle.

use std::collections::BTreeSet;

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

use super::source::Source;

/// The circles of imports among `sources`, all of one crate, by module path.
pub fn cycles(sources: &[Source]) -> Vec<Vec<String>> {
    let modules: BTreeSet<&[String]> = sources.iter().map(|it| it.module.as_slice()).collect();
    let mut graph = DiGraphMap::<&[String], ()>::new();
    for Source {
        module, imports, ..
    } in sources
    {
        for path in imports.iter().filter_map(|it| absolute(module, it)) {
            // The file that the longest beginning of the path names.
            let mut beginnings = (1..=path.len()).rev().map(|length| &path[..length]);
            let file = beginnings.find_map(|it| modules.get(it).copied());
            // A module and what lies within it are one thing: the outer lists the inner.
            let unrelated = |to: &&[String]| !module.starts_with(to) && !to.starts_with(module);
            if let Some(to) = file.filter(unrelated) {
                graph.add_edge(module, to, ());
            }
        }
    }
    let circles = tarjan_scc(&graph).into_iter();
    let named = circles.filter(|files| files.len() > 1).map(|files| {
        let mut names: Vec<_> = files.iter().map(|it| it.join("::")).collect();
        names.sort();
        names
    });
    named.collect()
}

/// An import from the crate's root; `None` for one of another crate.
fn absolute(module: &[String], import: &[String]) -> Option<Vec<String>> {
    let mut path = match import.first()?.as_str() {
        "crate" => return Some(import[1..].to_vec()),
        "self" | "super" => module.to_vec(),
        _ => return None,
    };
    for name in import {
        match name.as_str() {
            "self" => {}
            "super" => {
                path.pop()?;
            }
            name => path.push(name.to_owned()),
        }
    }
    Some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(module: &str, imports: &[&str]) -> Source {
        let names = |path: &str| path.split("::").map(str::to_owned).collect();
        Source {
            module: names(module),
            imports: imports.iter().map(|it| names(it)).collect(),
            ..Source::default()
        }
    }

    #[test]
    fn a_circle_is_found_whatever_the_path_is_called() {
        let sources = [
            source("a", &["crate::b::c::Thing", "serde::Serialize"]),
            source("b", &["self::c::Thing"]),
            source("b::c", &["super::d::Thing"]),
            source("b::d", &["crate::a::Thing"]),
            source("e", &["crate::a"]),
        ];
        assert_eq!(cycles(&sources), [["a", "b::c", "b::d"]]);
        assert!(cycles(&sources[..3]).is_empty());
    }
}
