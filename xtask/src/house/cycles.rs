//! Files of a crate that import one another in a circle.

use std::collections::BTreeMap;

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

use super::source::Source;

/// The circles of imports among `sources`, all of one crate, by module path.
pub fn cycles(sources: &[Source]) -> Vec<Vec<String>> {
    let numbers: BTreeMap<&[String], usize> = (sources.iter().enumerate())
        .map(|(number, source)| (source.module.as_slice(), number))
        .collect();
    let mut graph = DiGraphMap::<usize, ()>::new();
    for (from, source) in sources.iter().enumerate() {
        for import in &source.imports {
            let target = absolute(&source.module, import).and_then(|it| file_of(&numbers, &it));
            // A module and what lies within it are one thing: the outer lists the inner.
            let related = target.is_none_or(|to| {
                let [a, b] = [&source.module, &sources[to].module];
                a.starts_with(b) || b.starts_with(a)
            });
            if let (Some(to), false) = (target, related) {
                graph.add_edge(from, to, ());
            }
        }
    }
    let circles = tarjan_scc(&graph)
        .into_iter()
        .filter(|files| files.len() > 1);
    let named = circles.map(|files| {
        let mut names: Vec<_> = files
            .into_iter()
            .map(|it| sources[it].module.join("::"))
            .collect();
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

/// The file that the longest beginning of `path` names.
fn file_of(numbers: &BTreeMap<&[String], usize>, path: &[String]) -> Option<usize> {
    (1..=path.len())
        .rev()
        .find_map(|length| numbers.get(&path[..length]).copied())
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
