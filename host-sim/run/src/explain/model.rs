//! The rung, what it holds in memory and what it costs on the target; its contact, and the sensors.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision, Stepper};

use super::Row;
use crate::instructions::Instructions;
use crate::model::{Subject, Use, with_model};
use touchdown_scene::parts::degrees_of_freedom;
use touchdown_scene::scales::{compliance, validity};
use touchdown_scene::{Contact, Fidelity, Scene, Start};

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

/// How stiff a contact is that takes time.
pub(super) fn contact(scene: &Scene) -> Vec<Row> {
    let (law, exponent) = match scene.materials.contact {
        Contact::Point => ("K, force is K d^n", "1.5"),
        Contact::LinePower { .. } => ("K, force is K d^n", "1"),
        Contact::Line { .. } => ("K, force F is K d/(ln(4 K c/F) - 1)", "1"),
    };
    let Ok(compliance) = compliance(scene) else {
        return Vec::new();
    };
    let micros = |seconds: f64| format!("{:.4} us", seconds * 1e6);
    vec![
        ("shape", scene.materials.contact.to_string()),
        (law, format!("{:.6e} N/m^{exponent}", compliance.stiffness)),
        (
            "fastest impact: force, depth",
            format!(
                "{:.1} N, {:.4} um",
                compliance.peak_force,
                compliance.deepest * 1e6
            ),
        ),
        ("omega_c, there", format!("{:.1} rad/s", compliance.rate)),
        ("T_c, its duration", micros(compliance.contact_time)),
        (
            "steps: accurate, longest",
            format!(
                "{}, {}",
                micros(compliance.accurate_step()),
                micros(compliance.longest_step())
            ),
        ),
    ]
}

/// Their resolution and noise.
pub(super) fn sensors(scene: &Scene) -> Vec<Row> {
    let config = &scene.sensors;
    let resolution = config.resolution();
    // A uniform error of one count has this standard deviation.
    let noise = config.noise.hypot(resolution / 12_f64.sqrt());
    let channels = f64::from(config.planes);
    let bandwidth = config.bandwidth.map_or_else(
        || "not modelled".to_owned(),
        |corner| format!("{corner} Hz"),
    );
    let mut rows = vec![
        ("planes", config.planes.to_string()),
        ("sample rate", format!("{} Hz", scene.run.sample_rate)),
        ("range", format!("+-{} um", short(config.range * 1e6))),
        (
            "one count",
            format!("{:.4} um ({} bits)", resolution * 1e6, config.bits),
        ),
        (
            "noise of a channel",
            format!("{:.4} um rms with rounding", noise * 1e6),
        ),
        (
            "noise of the mean position",
            format!("{:.4} um rms", noise * 1e6 / channels.sqrt()),
        ),
        ("bandwidth", bandwidth),
        ("speed signal", yes(config.speed)),
        ("levitation signal", yes(config.levitation_signal)),
    ];
    let distorts = config.runout > 0.0
        || config.nonlinearity != 0.0
        || config
            .offset
            .iter()
            .chain(&config.gain_error)
            .any(|value| *value != 0.0);
    let distortion = if distorts {
        "as the scene asks"
    } else {
        "none"
    };
    rows.push(("runout, gain, offset, curve", distortion.to_owned()));
    rows
}

fn short(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn yes(wired: bool) -> String {
    if wired { "yes" } else { "no" }.to_owned()
}
