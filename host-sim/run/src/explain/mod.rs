//! What a scene models, what it leaves out and why, and the numbers that decide how it goes.

mod contact;
mod model;
mod numbers;
mod sensors;

use std::fmt::Write;

use serde::Serialize;

use touchdown_base::plain::shown;
use touchdown_scene::parts::{Part, parts};
use touchdown_scene::{Fidelity, Scene};

type Row = (&'static str, String);

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
        sections.push(section("Contact", contact::contact(scene)));
    }
    sections.extend([
        section("Modelled", chosen(&parts, true)),
        section("Left out", chosen(&parts, false)),
        section("Scales", numbers::scales(scene)),
        section("Speeds and times", numbers::speeds(scene)),
        section("Sensors", sensors::sensors(&scene.sensors, scene)),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rig_has_the_known_numbers() {
        let scene = Scene::load("rig").unwrap();
        let text = explain(&scene);
        for number in [
            "334.",
            "7.8206 ms",
            "5.5300 ms",
            "54.2494 mm/s",
            "-1389.84",
            "28.780 Hz",
        ] {
            assert!(text.contains(number), "{number} in\n{text}");
        }
    }

    #[test]
    fn a_scene_without_gravity_is_explained_too() {
        let text = touchdown_scene::BUILT_IN[0]
            .text
            .replace("duration_s", "gravity_m_s2 = 0\nduration_s");
        assert!(explain(&Scene::parse("s", &text).unwrap()).contains("no gravity"));
    }
}
