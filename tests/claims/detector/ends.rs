//! The two ends of a rotor for themselves: each end's impacts, contact and lift-off, and conical motion.
//! Truth: the motion given, in which each end falls and bounces by the closed form, as ends do that are
//! each other's centre of percussion.

use std::f64::consts::TAU;
use std::io::Sink;

use touchdown_core::detect::Phase;
use touchdown_core::event::{Event, EventKind, Motion, Notice, Plane};
use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_run::drop;
use touchdown_run::outcome::DetectedEvent;
use touchdown_run::target::Target;
use touchdown_scene::sensors::{Motion as Movement, Sensors};
use touchdown_scene::{BUILT_IN, Scene};

const CLEARANCE: f64 = 0.3e-3;
const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.8;
const RATE: f64 = 20_000.0;
/// Levitated time before a release, s.
const BEFORE: f64 = 0.3;

/// What the monitor said and which phases it saw.
struct Watched {
    events: Vec<Event>,
    confirmed: Vec<u16>,
    withdrawn: Vec<u16>,
    /// By sample, each end's.
    phases: Vec<[Phase; 2]>,
    motions: Vec<Motion>,
}

impl Watched {
    fn of(&self, kind: EventKind) -> impl Iterator<Item = &Event> {
        self.events.iter().filter(move |event| event.kind == kind)
    }

    fn at(&self, time: f64) -> [Phase; 2] {
        self.phases[(time * RATE) as usize]
    }
}

fn scene() -> Scene {
    Scene::load("rig").expect("built-in scene")
}

/// Runs a motion (position of each end in m, by time in s) through sensors and monitor.
fn watch_in(scene: &Scene, seconds: f64, ends: impl Fn(f64) -> [[f64; 2]; 2]) -> Watched {
    let sensors = Sensors::try_new(&scene.sensors, RATE).expect("valid sensors");
    let mut seen = sensors.start(scene.run.seed);
    let monitor = Monitor::try_new(&scene.monitor_config()).expect("valid");
    let mut state = MonitorState::default();
    let mut watched = Watched {
        events: Vec::new(),
        confirmed: Vec::new(),
        withdrawn: Vec::new(),
        phases: Vec::new(),
        motions: Vec::new(),
    };
    for k in 0..(seconds * RATE) as u64 {
        let movement = Movement {
            planes: ends(k as f64 / RATE),
            spin: scene.rotor.spin,
            levitated: true,
            bearing: None,
        };
        let sample = sensors.read(&mut seen, &movement);
        for notice in monitor.update(&mut state, &sample) {
            match notice {
                Notice::Declared(event) => watched.events.push(event),
                Notice::Confirmed { number, .. } => watched.confirmed.push(number),
                Notice::Withdrawn { number, .. } => watched.withdrawn.push(number),
                _ => {}
            }
        }
        watched.phases.push(state.detector.phases());
        watched.motions.push(state.detector.motion());
    }
    watched
}

fn watch(seconds: f64, ends: impl Fn(f64) -> [[f64; 2]; 2]) -> Watched {
    watch_in(&scene(), seconds, ends)
}

/// A fall from a height (m) above the wall's bottom, released at time 0, bouncing.
#[derive(Clone, Copy)]
struct Drop(f64);

impl Drop {
    /// Times of the impacts, s, and speeds into the wall, m/s.
    fn impacts(self) -> impl Iterator<Item = (f64, f64)> {
        let mut fall = (2.0 * self.0 / GRAVITY).sqrt();
        let mut time = fall;
        (0..80).map(move |_| {
            let impact = (time, GRAVITY * fall);
            fall *= RESTITUTION;
            time += 2.0 * fall;
            impact
        })
    }

    /// Time at which the bounces end, s.
    fn end(self) -> f64 {
        let fall = (2.0 * self.0 / GRAVITY).sqrt();
        fall * (1.0 + RESTITUTION) / (1.0 - RESTITUTION)
    }

    fn height(self, time: f64) -> f64 {
        if time <= 0.0 {
            return self.0;
        }
        let mut last = (0.0, (2.0 * GRAVITY * self.0).sqrt() * 0.0);
        for (at, speed) in self.impacts() {
            if time < at {
                let since = time - last.0;
                let from = if last.1 == 0.0 { self.0 } else { 0.0 };
                return (from + last.1 * since - 0.5 * GRAVITY * since * since).max(0.0);
            }
            last = (at, RESTITUTION * speed);
        }
        0.0
    }

    fn place(self, time: f64) -> [f64; 2] {
        [0.0, self.height(time) - CLEARANCE]
    }
}

/// One end floats low, the other high: they land 3.4 ms and end 31 ms apart.
const LOW: Drop = Drop(0.15e-3);
const HIGH: Drop = Drop(0.4e-3);

fn tilted_drop(seed: u64, low_end: usize) -> Watched {
    let mut scene = scene();
    scene.run.seed = seed;
    watch_in(&scene, BEFORE + 0.3, |t| {
        let [low, high] = [LOW, HIGH].map(|drop| drop.place(t - BEFORE));
        if low_end == 0 {
            [low, high]
        } else {
            [high, low]
        }
    })
}

#[test]
fn each_end_of_a_tilted_drop_has_its_own_impacts() {
    let (mut found, mut missed, mut false_ones) = (0, 0, 0);
    let mut errors = Vec::new();
    for seed in 0..20 {
        let watched = tilted_drop(seed, 0);
        let falls: Vec<_> = watched.of(EventKind::FreeFall).collect();
        assert_eq!(falls.len(), 1, "{falls:?}");
        assert_eq!(watched.confirmed, [falls[0].number]);
        for (plane, drop) in [(Plane::A, LOW), (Plane::B, HIGH)] {
            let seen: Vec<_> = watched
                .of(EventKind::Impact)
                .filter(|event| event.plane == plane)
                .map(|event| event.onset.samples() / RATE - BEFORE)
                .collect();
            for (time, speed) in drop.impacts() {
                let near = seen.iter().map(|at| (at - time).abs()).fold(1.0, f64::min);
                if near < 1e-3 {
                    errors.push(near * RATE);
                    found += 1;
                } else if speed > 0.02 {
                    missed += 1;
                }
            }
            false_ones += seen
                .iter()
                .filter(|at| drop.impacts().all(|(time, _)| (*at - time).abs() > 1e-3))
                .count();
        }
        assert!(
            watched
                .of(EventKind::Impact)
                .all(|event| event.plane != Plane::Both)
        );
    }
    errors.sort_by(f64::total_cmp);
    let median = errors[errors.len() / 2];
    println!(
        "{found} found, {missed} above 20 mm/s missed, {false_ones} false, median {median:.2} samples"
    );
    assert_eq!((missed, false_ones), (0, 0));
    assert!(median <= 1.0, "{median}");
}

#[test]
fn one_end_lies_while_the_other_flies() {
    let mut errors = Vec::new();
    for low_end in [0, 1] {
        for seed in 0..100 {
            let watched = tilted_drop(seed, low_end);
            // The low end has lain for 10 ms, the high one bounces for another 21 ms.
            let phases = watched.at(BEFORE + LOW.end() + 10e-3);
            assert!(phases[low_end].is_contact(), "{seed}: {phases:?}");
            assert_eq!(phases[1 - low_end], Phase::Impact, "{seed}");
            let first = watched.of(EventKind::Sliding).next().expect("lies");
            assert_eq!(first.plane, [Plane::A, Plane::B][low_end], "{seed}");
            errors.push((first.onset.samples() / RATE - BEFORE - LOW.end()).abs());
            let last = watched.phases.last().expect("samples");
            assert!(
                last.iter().all(|phase| phase.is_contact()),
                "{seed}: {last:?}"
            );
        }
    }
    errors.sort_by(f64::total_cmp);
    let [median, late] = [0.5, 0.95].map(|part| errors[(part * errors.len() as f64) as usize]);
    println!("contact: median {:.2} ms, 95 % {:.2} ms", median * 1e3, late * 1e3);
    assert!(median <= 1e-3 && late <= 2.5e-3, "{median} {late}");
}

#[test]
fn one_end_lifts_off_while_the_other_lies() {
    for (end, plane) in [(0, Plane::A), (1, Plane::B)] {
        let (mut late, mut of_both) = (0.0_f64, 0);
        for seed in 0..100 {
            let mut scene = scene();
            scene.run.seed = seed;
            // Both lie; from 0.3 s on one end is lifted, with the third power of time to 0.2 mm in 20 ms.
            let watched = watch_in(&scene, 0.32, |t| {
                let part = ((t - 0.3) / 0.02).max(0.0);
                let mut ends = [[0.0, -CLEARANCE]; 2];
                ends[end][1] += 0.2e-3 * part * part * part;
                ends
            });
            let lift_offs: Vec<_> = watched.of(EventKind::LiftOff).collect();
            let [lift_off] = lift_offs[..] else {
                panic!("{seed}: {lift_offs:?}");
            };
            let onset = lift_off.onset.samples() / RATE - 0.3;
            late = late.max(onset.abs());
            if lift_off.plane == Plane::Both {
                of_both += 1;
                continue;
            }
            assert_eq!(lift_off.plane, plane, "{seed}");
            let last = watched.phases.last().expect("samples");
            assert_eq!(last[end], Phase::FreeFall, "{seed}");
            assert!(last[1 - end].is_contact(), "{seed}: {last:?}");
        }
        println!(
            "end {end}: dated within {:.2} ms, {of_both} told of both",
            late * 1e3
        );
        // By then it is 4 um away, four standard deviations.
        let visible = 0.02 * (4e-6_f64 / 0.2e-3).cbrt();
        assert!(late < visible, "{late} {visible}");
        // Even odds at the first sign of it decide for both: 1 of 300 in longer runs.
        assert!(of_both <= 2, "{of_both}");
    }
}

/// Orbits of 30 um before the fall are no error of the sensors on the wall after it.
#[test]
fn a_lift_off_after_an_orbit_is_seen() {
    const HOP: f64 = BEFORE + 0.25;
    for hz in [50.0, 150.0, 400.0] {
        let watched = watch(HOP + 0.01, |t| {
            let [x, mut y] = HIGH.place(t - BEFORE);
            // From 0.25 s on it rises with the third power of time, to 30 um in 10 ms.
            y += 30e-6 * ((t - HOP) / 0.01).max(0.0).powi(3);
            let (sin, cos) = (TAU * hz * t).sin_cos();
            let radius = if t < BEFORE { 30e-6 } else { 0.0 };
            [[x + radius * cos, y + radius * sin]; 2]
        });
        assert_eq!(watched.confirmed.len(), 1, "{hz} Hz");
        let lift_offs: Vec<_> = watched.of(EventKind::LiftOff).collect();
        let [lift_off] = lift_offs[..] else {
            panic!("{hz} Hz: {lift_offs:?}");
        };
        assert_eq!(lift_off.plane, Plane::Both, "{hz} Hz");
        let late = lift_off.declared as f64 / RATE - HOP;
        // By then it is 5 um away.
        assert!(late < 0.0055, "{hz} Hz: {late}");
    }
}

/// An orbit throws it up and it falls back, for longer than `catch_time` within the circle of the orbit: no controller
/// has caught it.
#[test]
fn a_fall_through_the_orbit_is_not_withdrawn() {
    for hz in [80.0, 100.0, 120.0, 140.0, 160.0] {
        let rate = TAU * hz;
        let watched = watch(BEFORE + 0.02, |t| {
            let (since, radius) = (t - BEFORE, 30e-6);
            let (sin, cos) = (rate * since).sin_cos();
            let flown = radius * rate * since - 0.5 * GRAVITY * since * since;
            let place = if since < 0.0 {
                [radius * cos, radius * sin]
            } else {
                [radius, flown]
            };
            [place; 2]
        });
        assert!(watched.withdrawn.is_empty(), "{hz} Hz");
        assert_eq!(watched.of(EventKind::FreeFall).count(), 1, "{hz} Hz");
        assert_eq!(watched.confirmed.len(), 1, "{hz} Hz");
    }
}

#[test]
fn ends_that_fall_together_stay_one() {
    let watched = watch(BEFORE + 0.3, |t| [HIGH.place(t - BEFORE); 2]);
    assert!(
        watched
            .events
            .iter()
            .all(|event| event.plane == Plane::Both)
    );
    assert!(
        watched
            .events
            .iter()
            .all(|event| event.motion == Motion::Cylindrical)
    );
    assert!(watched.phases.iter().all(|[a, b]| a == b));
}

#[test]
fn symmetric_drops_are_never_split() {
    let mut drops = 0;
    for built_in in BUILT_IN {
        for seed in 0..20 {
            for runout in [0.0, 3e-6] {
                let mut scene = Scene::load(built_in.name).expect("built-in scene");
                if scene.two_plane.is_some() {
                    continue;
                }
                scene.run.seed = seed;
                scene.sensors.runout = runout;
                let (outcome, _) = drop::by_reference::<Sink>(&scene, &Target::Host, None).expect("drops");
                let split =
                    |event: &&DetectedEvent| event.plane != "both" || event.motion != "cylindrical";
                let found = outcome.detection.events.iter().find(split);
                assert!(found.is_none(), "{} {seed}: {found:?}", built_in.name);
                drops += 1;
            }
        }
    }
    assert!(drops >= 200, "{drops}");
}

#[test]
fn ends_that_have_landed_are_one_again() {
    let watched = tilted_drop(1, 0);
    // The high end lies from 81 ms on, and one `still_time` (50 ms) and a margin later they are one.
    let mut united = watched
        .of(EventKind::Rest)
        .chain(watched.of(EventKind::Pendulum))
        .filter(|event| event.declared as f64 / RATE > BEFORE + 0.25);
    assert!(
        united.all(|event| event.plane == Plane::Both),
        "{:?}",
        watched.events
    );
    let [a, b] = watched.phases.last().expect("samples");
    assert_eq!(a, b);
}

/// Floats, then both ends go round on opposite sides (or the same), out to the wall within 6 ms, where
/// they bounce off, and through the centre.
fn spiral(side: f64) -> impl Fn(f64) -> [[f64; 2]; 2] {
    move |t| {
        let since = (t - BEFORE).max(0.0);
        let way = (since / 0.006) % 2.0;
        let out = if way < 1.0 { way } else { 2.0 - way };
        let (sin, cos) = (TAU * 10.0 * since).sin_cos();
        let [x, y] = [CLEARANCE * out * cos, CLEARANCE * out * sin];
        [[x, y], [side * x, side * y]]
    }
}

#[test]
fn ends_that_go_against_each_other_are_conical() {
    let mut scene = scene();
    scene.run.gravity = 0.0;
    let after = (BEFORE * RATE) as usize;
    let conical = watch_in(&scene, BEFORE + 0.2, spiral(-1.0));
    assert!(
        conical.motions[..after]
            .iter()
            .all(|it| *it == Motion::Cylindrical)
    );
    // One `catch_time` (5 ms) averages, and a few um must be passed.
    assert!(
        conical.motions[after + 200..]
            .iter()
            .all(|it| *it == Motion::Conical)
    );
    let fall = conical.of(EventKind::FreeFall).next().expect("a fall");
    assert_eq!(fall.motion, Motion::Conical);
    // At 51 um, `confirm_travel`, of a way of 50 um/ms: 1.02 ms.
    let latency = fall.declared as f64 / RATE - BEFORE;
    assert!(latency < 1.3e-3, "{latency}");
    assert_eq!(conical.confirmed, [fall.number]);
    let impacts: Vec<_> = conical.of(EventKind::Impact).collect();
    for plane in [Plane::A, Plane::B] {
        assert!(
            impacts.iter().any(|event| event.plane == plane),
            "{impacts:?}"
        );
    }
    assert!(impacts.iter().all(|event| event.motion == Motion::Conical));
    let cylindrical = watch_in(&scene, BEFORE + 0.2, spiral(1.0));
    assert!(cylindrical.of(EventKind::FreeFall).next().is_some());
    assert!(
        cylindrical
            .motions
            .iter()
            .all(|it| *it == Motion::Cylindrical)
    );
    assert!(
        cylindrical
            .events
            .iter()
            .all(|event| event.plane == Plane::Both)
    );
}

#[test]
fn one_end_alone_is_not_conical() {
    let watched = watch(BEFORE + 0.2, |t| {
        [[0.0; 2], Drop(CLEARANCE).place(t - BEFORE)]
    });
    assert!(watched.of(EventKind::Impact).next().is_some());
    assert!(
        watched
            .of(EventKind::Impact)
            .all(|event| event.plane == Plane::B)
    );
    assert!(watched.motions.iter().all(|it| *it == Motion::Cylindrical));
}

#[test]
fn a_tilted_rotor_that_floats_is_quiet_and_a_caught_fall_of_it_is_withdrawn() {
    let tilted = |fallen: f64| [[0.0, -0.1e-3 - fallen], [0.0, 0.1e-3 - fallen]];
    assert!(watch(5.0, |_| tilted(0.0)).events.is_empty());
    // Falls by 12 um within 10 ms and is brought back.
    let watched = watch(1.0, |t| {
        let part = ((t - 0.5) / 0.01).clamp(0.0, 1.0);
        tilted(6e-6 * (1.0 - (TAU * part).cos()))
    });
    let falls: Vec<_> = watched.of(EventKind::FreeFall).collect();
    assert!(!falls.is_empty(), "{:?}", watched.events);
    let numbers: Vec<_> = falls.iter().map(|event| event.number).collect();
    assert_eq!(watched.withdrawn, numbers);
    assert!(watched.confirmed.is_empty());
    assert_eq!(watched.phases.last(), Some(&[Phase::Levitated; 2]));
}

#[test]
fn an_orbit_of_the_tilt_is_no_fall() {
    for (frequency, radius) in [(50.0, 60e-6), (500.0, 30e-6), (10.0, 60e-6)] {
        let watched = watch(5.0, |t| {
            let (sin, cos) = (TAU * frequency * t).sin_cos();
            let [x, y] = [radius * cos, radius * sin];
            [[x, y], [-x, -y]]
        });
        assert!(
            watched.events.is_empty(),
            "{frequency} Hz: {:?}",
            watched.events
        );
    }
}

#[test]
fn a_spike_on_one_plane_is_no_tilt() {
    let watched = watch(1.0, |t| {
        let spike = (t * RATE) as u64 == 12_000;
        [[0.0, if spike { 0.2e-3 } else { 0.0 }], [0.0; 2]]
    });
    assert!(watched.phases.iter().all(|[a, b]| a == b));
    assert!(watched.confirmed.is_empty());
}

#[test]
fn one_plane_that_fails_leaves_the_other_to_go_on() {
    let scene = scene();
    let watched = watch_in(&scene, BEFORE + 0.3, |t| {
        let [low, high] = [LOW, HIGH].map(|drop| drop.place(t - BEFORE));
        // Beyond the sensors' range: 25 ms after the release plane a is gone.
        [if t > BEFORE + 25e-3 { [2e-3, 0.0] } else { low }, high]
    });
    let fault = watched.of(EventKind::SensorFault).next().expect("told");
    assert_eq!(fault.plane, Plane::A);
    let later = watched
        .events
        .iter()
        .filter(|event| event.declared > fault.declared);
    assert!(
        later.clone().all(|event| event.plane == Plane::B),
        "{:?}",
        watched.events
    );
    assert!(later.clone().any(|event| event.kind == EventKind::Impact));
    assert!(watched.phases.last().expect("samples")[1].is_contact());
}
