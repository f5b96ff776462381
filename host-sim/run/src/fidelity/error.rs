//! How wrong an output is.

use super::force::pulses;
use touchdown_base::history::{History, Impact, Regime};
use touchdown_scene::{Output, Scene};

/// Impacts that are looked at.
const IMPACTS: usize = 10;

/// Error of `output`: s for times, a part of the true value for the rest, 0 or infinite for the regime.
/// Infinite where the model does not give it.
pub fn error(output: Output, history: &History, truth: &History, scene: &Scene) -> f64 {
    match output {
        Output::Regime if history.regime == truth.regime => 0.0,
        Output::Regime => f64::INFINITY,
        Output::ImpactTime => impact_times(&history.impacts, &truth.impacts),
        Output::ImpactSpeed => impact_speeds(history, truth),
        Output::Phases => phases(history, truth),
        Output::WhirlLoad => relative(load(history, scene), load(truth, scene)),
        Output::PeakForce | Output::ContactTime => {
            let Some((ours, real)) = pulses(history, truth, scene) else {
                return f64::INFINITY;
            };
            match output {
                Output::PeakForce => relative(ours.peak_force, real.peak_force),
                _ => relative(ours.duration, real.duration),
            }
        }
    }
}

fn relative(ours: f64, theirs: f64) -> f64 {
    if ours == theirs {
        0.0
    } else {
        (ours - theirs).abs() / theirs.abs()
    }
}

/// Of the first impacts that are true the farthest from any of ours, and of ours until then the farthest from any true one:
/// bounces that follow each other more closely than that may be one.
fn impact_times(ours: &[Impact], truth: &[Impact]) -> f64 {
    let first = &truth[..truth.len().min(IMPACTS)];
    let end = match first.last() {
        Some(last) if first.len() < truth.len() => last.state.time,
        _ => f64::INFINITY,
    };
    let till_then = &ours[..ours.partition_point(|it| it.state.time <= end)];
    farthest(first, ours).max(farthest(till_then, truth))
}

/// Greatest time from one of `these` to the nearest of `those`, s.
fn farthest(these: &[Impact], those: &[Impact]) -> f64 {
    let alone = |it: &Impact| {
        let apart = |other: &Impact| (other.state.time - it.state.time).abs();
        those.iter().map(apart).fold(f64::INFINITY, f64::min)
    };
    these.iter().map(alone).fold(0.0, f64::max)
}

fn impact_speeds(history: &History, truth: &History) -> f64 {
    let expected = truth.impacts.len().min(IMPACTS);
    if history.impacts.len() < expected {
        return f64::INFINITY;
    }
    let pairs = history.impacts.iter().zip(&truth.impacts).take(expected);
    pairs
        .map(|(a, b)| relative(a.normal_speed, b.normal_speed))
        .fold(0.0, f64::max)
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

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_base::history::RotorState;

    fn at(times: &[f64]) -> Vec<Impact> {
        let impact = |&time: &f64| Impact {
            state: RotorState {
                time,
                ..RotorState::default()
            },
            normal_speed: 0.1,
            normal_impulse: 1.0,
            pulse: None,
        };
        times.iter().map(impact).collect()
    }

    #[test]
    fn impact_times_are_apart_from_the_nearest_either_way() {
        let error = |ours: &[f64], truth: &[f64]| impact_times(&at(ours), &at(truth));
        let is = |error: f64, right: f64| (error - right).abs() < 1e-12;
        assert!(is(error(&[1.0, 2.0], &[1.0, 2.0]), 0.0));
        assert!(is(error(&[1.1, 2.0], &[1.0, 2.0]), 0.1));
        // A bounce in no time is one with the next, one that lasts is not.
        assert!(is(error(&[1.0], &[1.0, 1.001]), 1e-3));
        assert!(is(error(&[1.0], &[1.0, 1.5]), 0.5));
        assert!(is(error(&[1.0, 1.5], &[1.0]), 0.5));
        assert!(is(error(&[], &[]), 0.0));
        assert_eq!(error(&[], &[1.0]), f64::INFINITY);
        assert_eq!(error(&[1.0], &[]), f64::INFINITY);
        // The first ten.
        let many: Vec<f64> = (0..12).map(f64::from).collect();
        assert!(is(error(&many[..10], &many), 0.0));
        assert!(is(error(&many[..9], &many), 1.0));
    }
}
