//! The detector on the rig of the source paper at 1 um noise, 20 and 50 kHz; truth from the reference.

use std::io::Sink;

use touchdown_base::history::Regime;
use touchdown_core::event::EventKind;
use touchdown_run::drop;
use touchdown_run::matching::{Matches, match_events};
use touchdown_run::outcome::{DetectedEvent, Outcome};
use touchdown_run::target::Target;
use touchdown_scene::Scene;

const RATES: [f64; 2] = [20_000.0, 50_000.0];
const SEEDS: std::ops::Range<u64> = 0..50;

fn dropped(name: &str, rate: f64, seed: u64) -> (Outcome, Matches) {
    let mut scene = Scene::load(name).expect("built-in scene");
    scene.run.sample_rate = rate;
    scene.run.seed = seed;
    watched(&scene)
}

fn watched(scene: &Scene) -> (Outcome, Matches) {
    let (outcome, _) = drop::by_reference::<Sink>(scene, &Target::Host, None).expect("a valid scene drops");
    let matches = match_events(&outcome.truth.whole, &outcome.detection);
    (outcome, matches)
}

fn campaign(name: &str) -> Vec<(f64, Outcome, Matches)> {
    let mut all = Vec::new();
    for rate in RATES {
        for seed in SEEDS {
            let (outcome, matches) = dropped(name, rate, seed);
            all.push((rate, outcome, matches));
        }
    }
    all
}

fn names(events: &[DetectedEvent]) -> Vec<EventKind> {
    events.iter().map(|event| event.event).collect()
}

/// Lowest mean latency of a fall that 1 um noise on two planes allows at one false alarm in 1e9
/// samples, s: t = (20 d^2 sigma^2/(g^2 rate))^(1/5) with d^2 = 2 ln 1e9.
fn bound(rate: f64) -> f64 {
    let variance = 0.5 * (1e-12 + (2e-3_f64 / 4096.0).powi(2) / 12.0);
    (20.0 * 2.0 * 1e9_f64.ln() * variance / (9.81 * 9.81 * rate)).powf(0.2)
}

fn median(mut values: Vec<f64>) -> f64 {
    assert!(!values.is_empty());
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn a_fall_is_declared_near_the_bound_and_confirmed() {
    for rate in RATES {
        let mut latencies = Vec::new();
        for (_, outcome, matches) in campaign("rig").into_iter().filter(|run| run.0 == rate) {
            let fall = matches.of_kind(EventKind::FreeFall).next().expect("a fall");
            latencies.push(fall.latency_s.expect("declared"));
            let event = &outcome.detection.events[fall.detected.expect("declared")];
            assert!(
                event
                    .confirmed_s
                    .is_some_and(|t| t < outcome.truth.whole.impacts[0].state.time)
            );
            assert!(event.withdrawn_s.is_none());
        }
        let median = median(latencies);
        println!(
            "{rate} Hz: median {:.3} ms, bound {:.3} ms",
            median * 1e3,
            bound(rate) * 1e3
        );
        assert!(median <= 1.15 * bound(rate), "{median} at {rate} Hz");
    }
}

#[test]
fn impacts_are_found_dated_and_measured() {
    let mut found = 0;
    for name in ["rig", "rig-wide-gap"] {
        let mut errors = Vec::new();
        for (rate, outcome, matches) in campaign(name) {
            for (impact, event) in outcome
                .truth
                .whole
                .impacts
                .iter()
                .zip(matches.of_kind(EventKind::Impact))
            {
                // Both scenes have a restitution of 0.8.
                if 1.8 * impact.normal_speed < 0.018 {
                    continue;
                }
                let index = event
                    .detected
                    .unwrap_or_else(|| panic!("{name} {rate} Hz: {:?} missed", impact.state.time));
                let seen = outcome.detection.events[index].normal_speed_m_s;
                let off = seen.expect("a speed") / impact.normal_speed - 1.0;
                assert!(off.abs() < 0.25, "{name}: speed off by {off}");
                errors.push(event.onset_error_s.expect("dated").abs() * rate);
                found += 1;
            }
        }
        let median = median(errors);
        println!("{name}: median onset error {median:.2} samples");
        assert!(median <= 1.0, "{name}: {median} samples");
    }
    assert!(found > 800, "{found}");
}

#[test]
fn nothing_is_declared_that_did_not_happen() {
    for name in [
        "rig",
        "rig-wide-gap",
        "rolling",
        "backward-whirl",
        "lift-off",
    ] {
        for (rate, outcome, matches) in campaign(name) {
            let invented: Vec<_> = matches
                .false_events
                .iter()
                .map(|&index| &outcome.detection.events[index])
                .collect();
            assert!(invented.is_empty(), "{name} {rate} Hz: {invented:?}");
        }
    }
}

#[test]
fn runout_delays_the_verdicts_but_invents_none() {
    for (runout, fall_within, contact_within) in [
        (1e-6, 1.2e-3, 2e-3),
        (2e-6, 1.7e-3, 3e-3),
        (5e-6, 2.5e-3, 6e-3),
    ] {
        let (mut falls, mut contacts) = (Vec::new(), Vec::new());
        for seed in 0..20 {
            let mut scene = Scene::load("rig").expect("built-in scene");
            scene.sensors.runout = runout;
            scene.run.seed = seed;
            let (outcome, matches) = watched(&scene);
            let invented = matches.false_events.len();
            assert_eq!(invented, 0, "{runout:e} m: {:?}", outcome.detection.events);
            let latency = |kind| {
                let found = matches.of_kind(kind).next().expect("happens");
                found.latency_s.expect("declared")
            };
            falls.push(latency(EventKind::FreeFall));
            contacts.push(latency(EventKind::Sliding));
        }
        let (fall, contact) = (median(falls), median(contacts));
        println!(
            "{runout:e} m: fall {:.2} ms, contact {:.2} ms",
            fall * 1e3,
            contact * 1e3
        );
        assert!(
            fall < fall_within && contact < contact_within,
            "{runout:e} m"
        );
    }
}

#[test]
fn permanent_contact_is_dated_by_the_series() {
    for name in ["rig", "rig-wide-gap", "rolling"] {
        let mut errors = Vec::new();
        for (_, _, matches) in campaign(name) {
            let sliding = matches.of_kind(EventKind::Sliding).next().expect("slides");
            errors.push(sliding.onset_error_s.expect("declared").abs());
        }
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let median = median(errors);
        println!(
            "{name}: median {:.2} ms, worst {:.2} ms",
            median * 1e3,
            worst * 1e3
        );
        assert!(median <= 1e-3, "{name}: median {median}");
        assert!(worst <= 2e-3, "{name}: worst {worst}");
    }
}

#[test]
fn sliding_turns_to_rolling() {
    for (rate, outcome, matches) in campaign("rolling") {
        let rolling = matches.of_kind(EventKind::Rolling).next().expect("rolls");
        let error = rolling.onset_error_s.expect("declared").abs();
        assert!(error < 10e-3, "{rate} Hz: {error}");
        assert_eq!(outcome.truth.whole.regime, Regime::Pendulum);
        assert!(names(&outcome.detection.events).contains(&EventKind::Pendulum));
    }
}

#[test]
fn a_cold_start_in_whirl_has_the_right_sign() {
    for (rate, outcome, _) in campaign("backward-whirl") {
        assert_eq!(outcome.truth.whole.regime, Regime::BackwardWhirl);
        let names = names(&outcome.detection.events);
        assert_eq!(names[0], EventKind::Sliding, "{rate} Hz");
        assert!(names.contains(&EventKind::BackwardWhirl), "{names:?}");
        assert!(!names.contains(&EventKind::ForwardWhirl), "{names:?}");
    }
}

#[test]
fn lift_offs_are_found() {
    for (rate, outcome, matches) in campaign("lift-off") {
        for lift_off in matches.of_kind(EventKind::LiftOff) {
            let found = lift_off.latency_s;
            assert!(found.is_some_and(|t| t < 5e-3), "{rate} Hz: {lift_off:?}");
        }
        assert!(outcome.truth.whole.lift_offs.len() >= 2);
    }
}

/// What the instants of the banks buy, over drops of the rig.
#[derive(Debug)]
struct Bought {
    /// s.
    fall: f64,
    impact: f64,
    /// Samples.
    onset: f64,
    missed: usize,
}

fn bought(rate: f64, instants: u8, seeds: std::ops::Range<u64>) -> Bought {
    let (mut falls, mut impacts, mut onsets, mut missed) = (vec![], vec![], vec![], 0);
    for seed in seeds {
        let mut scene = Scene::load("rig").expect("built-in scene");
        scene.run.sample_rate = rate;
        scene.run.seed = seed;
        scene.tuning.release_instants = instants;
        scene.tuning.impact_instants = instants;
        let (outcome, matches) = watched(&scene);
        let fall = matches.of_kind(EventKind::FreeFall).next();
        falls.push(fall.and_then(|it| it.latency_s).unwrap_or(f64::INFINITY));
        let clear = |speed: f64| 1.8 * speed >= 0.018;
        for (_, event) in (outcome.truth.whole.impacts.iter())
            .zip(matches.of_kind(EventKind::Impact))
            .filter(|(impact, _)| clear(impact.normal_speed))
        {
            missed += usize::from(event.detected.is_none());
            impacts.push(event.latency_s.unwrap_or(f64::INFINITY));
            onsets.extend(event.onset_error_s.map(|error| error.abs() * rate));
        }
    }
    Bought {
        fall: falls.iter().sum::<f64>() / falls.len() as f64,
        impact: median(impacts),
        onset: median(onsets),
        missed,
    }
}

#[test]
fn twice_the_instants_find_nothing_sooner() {
    let [half, all] = [16, 32].map(|instants| bought(20_000.0, instants, 0..60));
    println!("{half:?} {all:?}");
    // A quarter of a sample: the mean over 60 seeds.
    assert!(half.fall <= all.fall + 0.25 / 20_000.0, "{half:?} {all:?}");
    assert!(half.impact <= 1.05 * all.impact, "{half:?} {all:?}");
    assert!(half.missed <= all.missed, "{half:?} {all:?}");
    assert!(half.onset <= all.onset + 0.1, "{half:?} {all:?}");
}

#[test]
#[ignore = "hundreds of drops: the figures of docs/build/timing.md"]
fn instants_against_latency() {
    for rate in RATES {
        for instants in [32, 24, 16, 12, 8, 6, 4] {
            println!("{rate} {instants} {:?}", bought(rate, instants, 0..100));
        }
    }
}
