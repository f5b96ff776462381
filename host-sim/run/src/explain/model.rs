//! The rung, what it holds in memory and what it costs on the target.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision, Stepper};

use super::Row;
use crate::instructions::Instructions;
use crate::model::{Subject, Use, with_model};
use touchdown_scene::parts::degrees_of_freedom;
use touchdown_scene::scales::validity;
use touchdown_scene::{Fidelity, Scene, Start};

pub(super) fn model(scene: &Scene) -> Vec<Row> {
    let step = scene.model.step * 1e6;
    let (rung, step) = match scene.model.rung {
        Fidelity::Rigid => (
            "rigid: impacts take no time",
            format!("{step:.4} us, output only: impacts lie between steps"),
        ),
        Fidelity::Moreau => (
            "moreau: impacts take no time, and lie in the middle of a step",
            format!("{step:.4} us; times are off by about as much an impact"),
        ),
        Fidelity::Hertz => (
            "hertz: impacts have a force and take time",
            format!("{step:.4} us; the limits stand below"),
        ),
        Fidelity::Support => (
            "support: the retainer gives way or turns; impacts as in moreau",
            format!("{step:.4} us; times are off by about as much an impact"),
        ),
        Fidelity::TwoPlane => (
            "two-plane: the rotor tilts, each ring touches on its own; impacts as in moreau",
            format!("{step:.4} us; times are off by about as much an impact"),
        ),
        Fidelity::Coupled => (
            "coupled: the rotor tilts and bends, each ring gives way or turns on its own; impacts are located",
            format!("{step:.4} us; times are off by the square of it"),
        ),
    };
    let start = match scene.start {
        Start::Free { .. } => "released in the gap, after 0.2 s of levitation",
        Start::Wall { .. } => "on the wall; the detector starts cold",
    };
    let (count, which) = degrees_of_freedom(scene);
    let mut rows = vec![
        ("rung", rung.to_owned()),
        ("scheme", scene.model.scheme.to_string()),
        ("degrees of freedom", format!("{count}: {which}")),
        ("number format", scene.model.precision.to_string()),
        ("functions", scene.model.math.to_string()),
        ("step", step),
        ("state", state(scene)),
    ];
    rows.extend(instructions(scene));
    rows.push(("start", start.to_owned()));
    if let Some(validity) = validity(scene) {
        rows.push(("rigid rotor", validity.to_string()));
    }
    rows.push((
        "truth",
        "independent event-located solution in f64".to_owned(),
    ));
    rows
}

struct Size;

impl Use for Size {
    type Output = usize;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<usize, ConfigError> {
        Ok(subject.state_size)
    }
}

fn state(scene: &Scene) -> String {
    let size = with_model(scene, Size);
    size.map_or_else(|error| error.to_string(), |it| format!("{it} bytes"))
}

/// Counted on the emulated target, with output of the place.
fn instructions(scene: &Scene) -> Vec<Row> {
    let Some(each) = Instructions::of(&scene.model) else {
        return vec![("instructions on the target", "not counted".to_owned())];
    };
    let mut rows = vec![
        (
            "instructions a step in flight",
            format!("{:.0} on the target", each.flight),
        ),
        (
            "instructions a step in contact",
            format!("{:.0}", each.contact),
        ),
    ];
    if each.impact > 0.0 {
        rows.push((
            "more for an impact, a contact",
            format!("{:.0}, {:.0}", each.impact, each.stretch),
        ));
    }
    rows
}
