//! What a scene models, what it leaves out and why, and the numbers that decide how it goes.

mod contact;
mod model;
mod numbers;
mod sensors;

use std::fmt::Write;

use super::parts::{Part, parts};
use super::{Rung, Scene};

/// The explanation, for people.
pub fn explain(scene: &Scene) -> String {
    let mut text = format!("{}\n", scene.heading());
    if let Some(source) = &scene.source {
        text += &format!("source: {source}\n");
    }
    let parts = parts(scene);
    section(&mut text, "Model", &model::model(scene));
    if scene.model.rung == Rung::Hertz {
        section(&mut text, "Contact", &contact::contact(scene));
    }
    section(&mut text, "Modelled", &chosen(&parts, true));
    section(&mut text, "Left out", &chosen(&parts, false));
    section(&mut text, "Scales", &numbers::scales(scene));
    section(&mut text, "Speeds and times", &numbers::speeds(scene));
    section(
        &mut text,
        "Sensors",
        &sensors::sensors(&scene.sensors, scene),
    );
    text
}

type Row = (&'static str, String);

fn chosen(parts: &[Part], modelled: bool) -> Vec<Row> {
    let parts = parts.iter().filter(|part| part.modelled == modelled);
    parts
        .map(|part| (part.name, part.reason.to_owned()))
        .collect()
}

fn section(text: &mut String, title: &str, rows: &[Row]) {
    let _ = write!(text, "\n{title}\n");
    for (name, value) in rows {
        let _ = writeln!(text, "  {name:<37}{value}");
    }
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
        let text = crate::scene::BUILT_IN[0]
            .text
            .replace("duration_s", "gravity_m_s2 = 0\nduration_s");
        assert!(explain(&Scene::parse("s", &text).unwrap()).contains("no gravity"));
    }
}
