//! What a scene models, what it leaves out and why, and the numbers that decide how it goes.

mod model;
pub mod numbers;

use std::fmt::Write;

use serde::Serialize;

use touchdown_base::plain::shown;
use touchdown_scene::parts::{Part, parts};
use touchdown_scene::{Fidelity, Scene};

/// Name and value.
pub type Row = (&'static str, String);

/// What there is to say of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    heading: String,
    source: Option<String>,
    sections: Vec<Section>,
}

#[derive(Clone, Debug, Serialize)]
struct Section {
    title: &'static str,
    rows: Vec<Named>,
}

#[derive(Clone, Debug, Serialize)]
struct Named {
    name: &'static str,
    value: String,
}

/// The explanation, for programs.
pub fn explanation(scene: &Scene) -> Explanation {
    let parts = parts(scene);
    let mut sections = vec![section("Model", model::model(scene))];
    if scene.model.rung == Fidelity::Hertz {
        sections.push(section("Contact", model::contact(scene)));
    }
    sections.extend([
        section("Modelled", chosen(&parts, true)),
        section("Left out", chosen(&parts, false)),
        section("Scales", numbers::scales(scene)),
        section("Speeds and times", numbers::speeds(scene)),
        section("Sensors", model::sensors(scene)),
    ]);
    Explanation {
        heading: scene.heading().to_owned(),
        source: scene.source.clone(),
        sections,
    }
}

/// The explanation, for people.
pub fn explain(scene: &Scene) -> String {
    let explanation = explanation(scene);
    let mut text = format!("{}\n", shown(&explanation.heading));
    if let Some(source) = &explanation.source {
        text += &format!("source: {}\n", shown(source));
    }
    for section in &explanation.sections {
        let _ = write!(text, "\n{}\n", section.title);
        for Named { name, value } in &section.rows {
            let _ = writeln!(text, "  {name:<37}{}", shown(value));
        }
    }
    text
}

fn section(title: &'static str, rows: Vec<Row>) -> Section {
    let rows = rows.into_iter().map(|(name, value)| Named { name, value });
    Section {
        title,
        rows: rows.collect(),
    }
}

fn chosen(parts: &[Part], modelled: bool) -> Vec<Row> {
    let parts = parts.iter().filter(|part| part.modelled == modelled);
    parts
        .map(|part| (part.name, part.reason.to_owned()))
        .collect()
}
