//! A fall out of an orbit: the detector follows what a floating rotor does periodically, and sees the rest.

use std::f64::consts::TAU;

use touchdown_core::event::{EventKind, Notice};
use touchdown_core::monitor::MonitorConfig;
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Motion, Sensors};
use touchdown_tests::monitor_run;

const GRAVITY: f64 = 9.81;
/// Levitated time, s.
const FLOATS: f64 = 1.0;
const FALLS: f64 = 6e-3;

/// A rotor in orbit that loses its bearings.
#[derive(Clone, Copy, Debug)]
struct Case {
    rate: f64,
    /// Of orbit and shaft, Hz; its change, parts a second.
    frequency: f64,
    sweep: f64,
    radius: f64,
    runout: f64,
    harmonic: u32,
    /// Whether the speed is measured.
    speed: bool,
}

impl Case {
    fn angle(&self, time: f64, phase: f64) -> [f64; 2] {
        let turns = self.frequency * (time + 0.5 * self.sweep * time * time);
        let rate = TAU * self.frequency * (1.0 + self.sweep * time);
        [TAU * turns + phase, rate]
    }

    /// Latency of the fall, s; events declared before it.
    fn latency(&self, seed: u64) -> (Option<f64>, usize) {
        let mut scene = Scene::load("rig").expect("built-in scene");
        scene.run.sample_rate = self.rate;
        scene.sensors.runout = self.runout;
        scene.sensors.runout_harmonic = self.harmonic;
        scene.sensors.speed = self.speed;
        let config: MonitorConfig = scene.monitor_config();
        let sensors = Sensors::try_new(&scene.sensors, self.rate).expect("sensors");
        let mut state = sensors.start(seed);
        let phase = seed as f64;
        let release = FLOATS + 0.37 * seed as f64 / self.rate;
        let [angle, spin] = self.angle(release, phase);
        let (sin, cos) = angle.sin_cos();
        let r = self.radius;
        let samples = (0..((release + FALLS) * self.rate) as u64).map(|k| {
            let time = k as f64 / self.rate;
            let [now, turning] = self.angle(time, phase);
            let fallen = time - release;
            let position = if fallen < 0.0 {
                [r * now.cos(), r * now.sin()]
            } else {
                let flown = r * spin * fallen;
                [
                    r * cos - flown * sin,
                    r * sin + flown * cos - 0.5 * GRAVITY * fallen * fallen,
                ]
            };
            let motion = Motion {
                planes: [position; 2],
                spin: turning,
                levitated: fallen < 0.0,
                bearing: None,
            };
            sensors.read(&mut state, &motion)
        });
        let notices = monitor_run::run(&config, samples).expect("valid").notices;
        let falls: Vec<f64> = notices
            .iter()
            .filter_map(|notice| match notice {
                Notice::Declared(event) if event.kind == EventKind::FreeFall => {
                    Some(event.declared as f64 / self.rate - release)
                }
                _ => None,
            })
            .collect();
        let early = falls.iter().filter(|latency| **latency < 0.0).count();
        (falls.into_iter().find(|latency| *latency >= 0.0), early)
    }
}

/// As in `detector.rs`.
fn bound(rate: f64) -> f64 {
    let variance = 0.5 * (1e-12 + (2e-3_f64 / 4096.0).powi(2) / 12.0);
    (20.0 * 2.0 * 1e9_f64.ln() * variance / (GRAVITY * GRAVITY * rate)).powf(0.2)
}

/// Orbit and runout, m, with its waves round the shaft.
const MOTIONS: [(f64, f64, u32); 6] = [
    (30e-6, 0.0, 1),
    (30e-6, 5e-6, 1),
    (30e-6, 5e-6, 2),
    (30e-6, 5e-6, 3),
    (0.0, 5e-6, 1),
    (0.0, 5e-6, 3),
];

/// Where the orbit throws the rotor as hard as gravity pulls, what is left of both depends on where it is.
fn is_near(case: &Case, latencies: &[f64]) -> bool {
    let worst = if case.frequency == 100.0 { 2.5 } else { 2.0 };
    let ratio = |latency: f64| latency / bound(case.rate);
    ratio(latencies[latencies.len() / 2]) <= 1.5 && ratio(latencies[latencies.len() - 1]) <= worst
}

fn check(frequency: f64, sweep: f64, speed: bool) {
    for (radius, runout, harmonic) in MOTIONS {
        let case = Case {
            rate: 20_000.0,
            frequency,
            sweep,
            radius,
            runout,
            harmonic,
            speed,
        };
        let runs: Vec<_> = (0..9).map(|seed| case.latency(seed)).collect();
        let early: usize = runs.iter().map(|run| run.1).sum();
        assert_eq!(early, 0, "{case:?}");
        let mut found: Vec<f64> = runs.iter().filter_map(|run| run.0).collect();
        assert_eq!(found.len(), runs.len(), "{case:?}");
        found.sort_by(f64::total_cmp);
        println!("{case:?}: median {:.3} ms", 1e3 * found[found.len() / 2]);
        assert!(is_near(&case, &found), "{case:?}: {found:?}");
    }
}

#[test]
fn a_fall_out_of_a_steady_orbit_is_declared_near_the_bound() {
    for frequency in [10.0, 20.0, 50.0, 100.0, 200.0, 500.0] {
        check(frequency, 0.0, false);
    }
}

#[test]
fn a_fall_while_the_speed_changes_is_declared_near_the_bound() {
    for frequency in [20.0, 50.0, 100.0, 200.0, 500.0] {
        for sweep in [0.2, -0.2] {
            for speed in [false, true] {
                check(frequency, sweep, speed);
            }
        }
    }
}

/// Orbits of up to 0.4 of the clearance are no lift from the wall: machines run with them for long (ISO 14839-2, up to zone B).
#[test]
fn a_fall_out_of_a_wide_orbit_is_found() {
    for (part, frequency) in [(0.2, 100.0), (0.3, 50.0), (0.4, 25.0)] {
        let case = Case {
            rate: 20_000.0,
            frequency,
            sweep: 0.0,
            radius: part * 300e-6,
            runout: 0.0,
            harmonic: 1,
            speed: false,
        };
        for seed in 0..9 {
            let (latency, early) = case.latency(seed);
            assert!(latency.is_some() && early == 0, "{part} {seed} {latency:?}");
        }
    }
}

/// Falls confirmed of a rotor that the magnets hold, in an orbit of this frequency (Hz) that grows to the wall in so long (s) and
/// goes round there; the shaft turns `times` as fast.
fn confirmed_of_a_rub(frequency: f64, times: f64, growth: f64, seed: u64) -> usize {
    let mut scene = Scene::load("rig").expect("built-in scene");
    let rate = scene.run.sample_rate;
    scene.rotor.spin = TAU * frequency * times;
    let sensors = Sensors::try_new(&scene.sensors, rate).expect("sensors");
    let mut state = sensors.start(seed);
    let samples = (0..((FLOATS + growth + 0.1) * rate) as u64).map(|k| {
        let time = k as f64 / rate;
        let part = ((time - FLOATS) / growth).clamp(0.0, 1.0);
        let (sin, cos) = (TAU * frequency * time + seed as f64).sin_cos();
        let radius = part * scene.retainer.clearance;
        let motion = Motion {
            planes: [[radius * cos, radius * sin]; 2],
            spin: scene.rotor.spin,
            levitated: true,
            bearing: None,
        };
        sensors.read(&mut state, &motion)
    });
    let answer = monitor_run::run(&scene.monitor_config(), samples).expect("valid");
    let is_confirmed = |notice: &&Notice| matches!(notice, Notice::Confirmed { .. });
    answer.notices.iter().filter(is_confirmed).count()
}

#[test]
fn a_rub_of_a_rotor_that_is_held_is_no_fall() {
    let orbits = [
        (70.0, 1.0),
        (90.0, 1.0),
        (110.0, 1.0),
        (70.0, 0.5),
        (70.0, -1.0),
        (90.0, 1.5),
    ];
    for (frequency, times) in orbits {
        for seed in 0..20 {
            let growth = 0.05 + 0.005 * seed as f64;
            let confirmed = confirmed_of_a_rub(frequency, times, growth, seed);
            assert_eq!(confirmed, 0, "{frequency} Hz, {times}, {growth} s, {seed}");
        }
    }
}
