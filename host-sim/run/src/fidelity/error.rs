//! How wrong an output is.

use super::force::pulses;
use touchdown_base::history::{History, Impact, Pulse, Regime};
use touchdown_scene::{Output, Scene};
use touchdown_truth::reference::pulse::Pulse as True;

/// Impacts that are looked at.
const IMPACTS: usize = 10;

/// Error of `output`: s for times, a part of the true value for the rest, 0 or infinite for the regime.
/// Infinite where the model does not give it.
pub fn error(output: Output, history: &History, truth: &History, scene: &Scene) -> f64 {
    match output {
        Output::Regime if history.regime == truth.regime => 0.0,
        Output::Regime => f64::INFINITY,
        Output::ImpactTime => impacts(history, truth, |a, b| (a.state.time - b.state.time).abs()),
        Output::ImpactSpeed => impacts(history, truth, |a, b| {
            relative(a.normal_speed, b.normal_speed)
        }),
        Output::Phases => phases(history, truth),
        Output::WhirlLoad => relative(load(history, scene), load(truth, scene)),
        Output::PeakForce => force(history, truth, scene, |ours, real| {
            relative(ours.peak_force, real.peak_force)
        }),
        Output::ContactTime => force(history, truth, scene, |ours, real| {
            relative(ours.duration, real.duration)
        }),
    }
}

fn force(
    history: &History,
    truth: &History,
    scene: &Scene,
    apart: impl Fn(&Pulse, &True) -> f64,
) -> f64 {
    pulses(history, truth, scene).map_or(f64::INFINITY, |(ours, real)| apart(&ours, &real))
}

fn relative(ours: f64, theirs: f64) -> f64 {
    if ours == theirs {
        0.0
    } else {
        (ours - theirs).abs() / theirs.abs()
    }
}

fn impacts(history: &History, truth: &History, apart: impl Fn(&Impact, &Impact) -> f64) -> f64 {
    let expected = truth.impacts.len().min(IMPACTS);
    if history.impacts.len() < expected {
        return f64::INFINITY;
    }
    let pairs = history.impacts.iter().zip(&truth.impacts).take(expected);
    pairs.map(|(a, b)| apart(a, b)).fold(0.0, f64::max)
}

fn phases(history: &History, truth: &History) -> f64 {
    let [ours, theirs] =
        [history, truth].map(|it| [&it.contact_starts, &it.rolling_starts, &it.lift_offs]);
    let mut worst = 0.0;
    for (ours, theirs) in ours.into_iter().zip(theirs) {
        if ours.len() != theirs.len() {
            return f64::INFINITY;
        }
        for (a, b) in ours.iter().zip(theirs) {
            worst = f64::max(worst, (a - b).abs());
        }
    }
    worst
}

/// N; 0 without whirl.
fn load(history: &History, scene: &Scene) -> f64 {
    if !matches!(history.regime, Regime::ForwardWhirl | Regime::BackwardWhirl) {
        return 0.0;
    }
    let [u, v] = history.end.velocity;
    scene.rotor.mass * (u * u + v * v) / scene.retainer.clearance
}
