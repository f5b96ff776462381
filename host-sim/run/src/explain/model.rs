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
    let rung = match scene.model.rung {
        Fidelity::Rigid => "rigid: impacts take no time",
        Fidelity::Moreau => "moreau: impacts take no time, and lie in the middle of a step",
        Fidelity::Hertz => "hertz: impacts have a force and take time",
        Fidelity::Support => "support: the retainer gives way or turns; impacts as in moreau",
        Fidelity::TwoPlane => {
            "two-plane: the rotor tilts, each ring touches on its own; impacts as in moreau"
        }
        Fidelity::Coupled => {
            "coupled: the rotor tilts and bends, each ring gives way or turns on its own; impacts are located"
        }
    };
    let step = match scene.model.rung {
        Fidelity::Rigid => ", output only: impacts lie between steps",
        Fidelity::Hertz => "; the limits stand below",
        Fidelity::Coupled => "; times are off by the square of it",
        _ => "; times are off by about as much an impact",
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
        ("step", format!("{:.4} us{step}", scene.model.step * 1e6)),
        ("state", state(scene)),
    ];
    rows.extend(instructions(scene));
    rows.push(("start", start.to_owned()));
    if let Some(validity) = validity(scene) {
        rows.push(("rigid rotor", validity.to_string()));
    }
    let truth = "independent event-located solution in f64";
    rows.push(("truth", truth.to_owned()));
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
    let flight = format!("{:.0} on the target", each.flight);
    let contact = format!("{:.0}", each.contact);
    let mut rows = vec![
        ("instructions a step in flight", flight),
        ("instructions a step in contact", contact),
    ];
    if each.impact > 0.0 {
        let more = format!("{:.0}, {:.0}", each.impact, each.stretch);
        rows.push(("more for an impact, a contact", more));
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
    let (force, depth) = (compliance.peak_force, compliance.deepest * 1e6);
    let steps = [compliance.accurate_step(), compliance.longest_step()].map(micros);
    vec![
        ("shape", scene.materials.contact.to_string()),
        (law, format!("{:.6e} N/m^{exponent}", compliance.stiffness)),
        (
            "fastest impact: force, depth",
            format!("{force:.1} N, {depth:.4} um"),
        ),
        ("omega_c, there", format!("{:.1} rad/s", compliance.rate)),
        ("T_c, its duration", micros(compliance.contact_time)),
        ("steps: accurate, longest", steps.join(", ")),
    ]
}

/// Their resolution and noise.
pub(super) fn sensors(scene: &Scene) -> Vec<Row> {
    let config = &scene.sensors;
    let resolution = config.resolution();
    // A uniform error of one count has this standard deviation.
    let noise = config.noise.hypot(resolution / 12_f64.sqrt());
    let channels = f64::from(config.planes);
    let bandwidth = config.bandwidth.map(|corner| format!("{corner} Hz"));
    let count = format!("{:.4} um ({} bits)", resolution * 1e6, config.bits);
    let mean = noise * 1e6 / channels.sqrt();
    let mut errors = config.offset.iter().chain(&config.gain_error);
    let bent = config.runout > 0.0 || config.nonlinearity != 0.0;
    let distortion = match bent || errors.any(|value| *value != 0.0) {
        true => "as the scene asks",
        false => "none",
    };
    let not_modelled = || "not modelled".to_owned();
    let yes = |wired: bool| ["no", "yes"][usize::from(wired)].to_owned();
    let range = (config.range * 1e6 * 1e6).round() / 1e6;
    vec![
        ("planes", config.planes.to_string()),
        ("sample rate", format!("{} Hz", scene.run.sample_rate)),
        ("range", format!("+-{range} um")),
        ("one count", count),
        (
            "noise of a channel",
            format!("{:.4} um rms with rounding", noise * 1e6),
        ),
        ("noise of the mean position", format!("{mean:.4} um rms")),
        ("bandwidth", bandwidth.unwrap_or_else(not_modelled)),
        ("speed signal", yes(config.speed)),
        ("levitation signal", yes(config.levitation_signal)),
        ("runout, gain, offset, curve", distortion.to_owned()),
    ]
}
