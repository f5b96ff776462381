//! The guard and the touches alone: readings in, verdict, alarms and touches out.

use proptest::prelude::*;
use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::{Alarm, Level, Notice, Notices, Plane, Touch};
use touchdown_core::guard::{Guard, GuardConfig, GuardState, Verdict};
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::touch::{TouchState, Touches};

const GAP: f32 = 0.3e-3;
const RATE: f32 = 20_000.0;

struct Bench {
    guard: Guard,
    state: GuardState,
    counter: Touches,
    touch: TouchState,
    alarms: Vec<Alarm>,
    touches: Vec<Touch>,
    sample: u64,
    /// A bit for each channel that tells the same count all the time.
    stuck: u8,
}

fn detector(rate: f32, gravity: f32) -> DetectorConfig {
    DetectorConfig {
        sample_rate: rate,
        machine: MachineConfig {
            mass: 3.42,
            clearance: GAP,
            gravity,
            rotor_radius: 24e-3,
            inertia_ratio: 0.5,
            friction: 0.1,
            restitution: 0.8,
            spin: 3_141.6,
        },
        tuning: Tuning::default(),
    }
}

impl Bench {
    fn new(rate: f32, gravity: f32, commissioned: bool) -> Self {
        let config = GuardConfig::default();
        let guard = Guard::try_new(&config, &detector(rate, gravity), 0b1111, commissioned);
        Self {
            guard: guard.expect("a valid configuration"),
            state: GuardState::default(),
            counter: Touches::new(GAP, rate),
            touch: TouchState::default(),
            alarms: Vec::new(),
            touches: Vec::new(),
            sample: 0,
            stuck: 0,
        }
    }

    fn rig() -> Self {
        Self::new(RATE, 9.81, false)
    }

    /// Each plane at parts of the gap.
    fn planes(&mut self, planes: [Option<[f32; 2]>; 2], levitated: Option<bool>) {
        let places = planes.map(|it| it.map(|place| place.map(|part| part * GAP)));
        self.guard.update(&mut self.state, places, levitated);
        // What the places are from has a count of noise.
        let noise = (self.sample / 3 % 2) as u16;
        let counts =
            [0, 1, 2, 3].map(|at| 2_048 + if self.stuck >> at & 1 == 0 { noise } else { 0 });
        let mut notices = Notices::new();
        self.guard.follow(
            &mut self.state,
            &places,
            &Sample {
                counts,
                valid: 0b1111,
                spin: None,
                levitated,
                edges: [None; TACHOMETERS],
            },
            self.sample,
            &mut notices,
        );
        self.counter
            .update(&mut self.touch, &places, self.sample, &mut notices);
        for notice in notices {
            match notice {
                Notice::Alarm(alarm) => self.alarms.push(alarm),
                Notice::Touch(touch) => self.touches.push(touch),
                other => panic!("{other:?}"),
            }
        }
        self.sample += 1;
    }

    fn verdict(&self) -> Verdict {
        self.state.verdict
    }

    fn at(&mut self, place: [f32; 2]) {
        self.planes([Some(place); 2], None);
    }

    /// For so many samples; whether one of them completed a proof.
    fn stay(&mut self, place: [f32; 2], samples: u32) -> bool {
        (0..samples).fold(false, |shown, _| {
            self.at(place);
            shown | self.verdict().floats
        })
    }

    /// From one place to another in so many samples.
    fn go(&mut self, from: [f32; 2], to: [f32; 2], samples: u32) {
        for number in 1..=samples {
            let part = number as f32 / samples as f32;
            self.at([
                from[0] + part * (to[0] - from[0]),
                from[1] + part * (to[1] - from[1]),
            ]);
        }
    }
}

#[test]
fn danger_is_three_quarters_of_the_last_millisecond() {
    let mut bench = Bench::rig();
    bench.stay([0.0; 2], 100);
    for number in 1..=15 {
        bench.at([0.0, -0.7]);
        assert_eq!(bench.verdict().danger, number == 15, "{number}");
    }
    // Of the last twenty five were inside before.
    for number in 1..=6 {
        bench.at([0.0; 2]);
        assert_eq!(bench.verdict().danger, number <= 5, "{number}");
    }
}

#[test]
fn bursts_of_thirty_percent_are_no_danger_and_no_touch() {
    let mut bench = Bench::rig();
    bench.stay([0.1, 0.05], 50);
    let mut noise = 1_u32;
    for number in 0..20_000 {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let is_hit = noise >> 16 < 19_660;
        let angle = (number % 97) as f32;
        let far = [2.5 * angle.cos(), 2.5 * angle.sin()];
        bench.at(if is_hit { far } else { [0.1, 0.05] });
        assert!(!bench.verdict().danger, "{number}");
    }
    assert_eq!(bench.touches, []);
}

#[test]
fn alarms_are_told_at_each_rise_after_a_fall_of_a_tenth() {
    let mut bench = Bench::rig();
    bench.stay([0.0; 2], 50);
    for height in [0.55, 0.45, 0.55, 0.35, 0.55, 0.70, 0.60, 0.70, 0.50, 0.70] {
        bench.stay([height, 0.0], 50);
    }
    let of_a = bench.alarms.iter().filter(|it| it.plane == Plane::A);
    let levels: Vec<(Level, f32)> = of_a.map(|it| (it.level, it.fraction)).collect();
    let told: Vec<Level> = levels.iter().map(|it| it.0).collect();
    use Level::{Alert, Danger};
    assert_eq!(told, [Alert, Alert, Danger, Danger]);
    for (level, fraction) in levels {
        let expected = if level == Alert { 0.55 } else { 0.7 };
        assert!((fraction - expected).abs() < 1e-4, "{fraction}");
    }
    assert_eq!(bench.alarms.len(), 8, "both planes");
}

#[test]
fn first_sample_tells_the_higher_limit_alone_and_no_touch() {
    let mut bench = Bench::rig();
    bench.stay([0.0, -1.0], 2);
    let told: Vec<_> = bench
        .alarms
        .iter()
        .map(|it| (it.level, it.sample))
        .collect();
    assert_eq!(told, [(Level::Danger, 0); 2]);
    assert!(bench.verdict().danger);
    bench.stay([0.0, -1.0], 5_000);
    assert_eq!((bench.alarms.len(), bench.touches.len()), (2, 0));
}

#[test]
fn lost_after_a_millisecond_and_off_after_three_samples() {
    let mut bench = Bench::rig();
    bench.stay([0.0; 2], 50);
    for number in 1..=20 {
        bench.planes([None; 2], Some(true));
        assert_eq!(bench.verdict().lost, number == 20);
    }
    bench.planes([None, Some([0.0; 2])], Some(true));
    assert!(bench.verdict().lost, "one plane is still gone");
    bench.planes([Some([0.0; 2]); 2], Some(true));
    assert!(!bench.verdict().lost);
    for number in 1..=20 {
        bench.planes([Some([0.0; 2]), None], Some(true));
        assert_eq!(bench.verdict().lost, number == 20, "one plane is gone");
    }
    for number in 1..=3 {
        bench.planes([Some([0.0; 2]); 2], Some(false));
        assert_eq!(bench.verdict().off, number == 3);
    }
    bench.planes([Some([0.0; 2]); 2], Some(true));
    assert!(!bench.verdict().off);
}

#[test]
fn a_lift_is_a_proof_and_nothing_that_lies_is() {
    let mut bench = Bench::rig();
    assert!(!bench.stay([0.0, -1.0], 20_000), "at rest");
    bench.go([0.0, -1.0], [0.0; 2], 2_000);
    assert!(bench.stay([0.0; 2], 4_100), "within 0.2 s and a part");
    // A float that nobody saw lifted.
    let mut bench = Bench::rig();
    assert!(!bench.stay([0.0; 2], 40_000));
    bench.state.proof.assume_lift();
    assert!(bench.stay([0.0; 2], 4_100));
    // Beyond the alert limit, lifted or not.
    let mut bench = Bench::rig();
    bench.stay([0.0, -1.0], 5_000);
    assert!(!bench.stay([0.0, -0.55], 20_000));
    // A wall that is told far too wide reads within all limits: what lies there is not lifted.
    let mut bench = Bench::rig();
    assert!(!bench.stay([0.0, -0.43], 40_000));
}

/// At the told centre it would be the best of proofs.
#[test]
fn a_channel_that_is_not_seen_to_work_proves_nothing() {
    for stuck in 1..1 << 4 {
        let mut bench = Bench::rig();
        bench.stay([0.0, -1.0], 5_000);
        bench.go([0.0, -1.0], [0.0; 2], 2_000);
        bench.stuck = stuck;
        assert!(!bench.stay([0.0; 2], 40_000), "{stuck:b}");
        bench.stuck = 0;
        assert!(bench.stay([0.0; 2], 4_100), "{stuck:b}");
    }
    // One that stops late in a stay; one that is not fitted.
    let mut bench = Bench::rig();
    bench.stay([0.0, -1.0], 5_000);
    let proven = (0..100).any(|_| {
        bench.stuck = 0;
        let early = bench.stay([0.0; 2], 1_600);
        bench.stuck = 0b0100;
        early | bench.stay([0.0; 2], 400)
    });
    assert!(!proven);
    let (config, machine) = (GuardConfig::default(), detector(RATE, 9.81));
    bench.guard = Guard::try_new(&config, &machine, 0b0011, false).expect("a valid configuration");
    assert!(bench.stay([0.0; 2], 4_100));
}

/// For whoever runs by a proof: at the latest after two looks of 10 ms.
#[test]
fn a_channel_that_freezes_is_told_and_one_that_is_not_fitted_is_not() {
    for stuck in 1..1 << 4 {
        let mut bench = Bench::rig();
        bench.stay([0.0; 2], 1_030);
        assert!(!bench.verdict().lost);
        bench.stuck = stuck;
        let told = (1..=400).find(|_| {
            bench.at([0.0; 2]);
            bench.verdict().lost
        });
        assert!(told.is_some_and(|it| it > 200), "{stuck:b}: {told:?}");
        bench.stuck = 0;
        bench.stay([0.0; 2], 400);
        assert!(!bench.verdict().lost);
    }
    let mut bench = Bench::rig();
    let (config, machine) = (GuardConfig::default(), detector(RATE, 9.81));
    bench.guard = Guard::try_new(&config, &machine, 0b0011, false).expect("a valid configuration");
    bench.stuck = 0b1100;
    for _ in 0..1_000 {
        bench.planes([Some([0.0; 2]), None], None);
        assert!(!bench.verdict().lost);
    }
}

/// Without a plane nothing would be asked of a proof.
#[test]
fn fitted_are_whole_planes_and_one_at_least() {
    let (config, machine) = (GuardConfig::default(), detector(RATE, 9.81));
    for fitted in 0..=u8::MAX {
        let is_taken = Guard::try_new(&config, &machine, fitted, false).is_ok();
        assert_eq!(
            is_taken,
            [0b0011, 0b1100, 0b1111].contains(&fitted),
            "{fitted:b}"
        );
    }
}

/// Lies, as it reads with zero and gain told wrong, is lifted and drops: danger is told where 0.67 of what is told is
/// never reached.
#[test]
fn a_fall_back_to_where_it_lay_is_danger_whatever_is_told() {
    let mut bench = Bench::rig();
    bench.stay([0.1, -0.6], 5_000);
    bench.go([0.1, -0.6], [0.0; 2], 2_000);
    assert!(bench.stay([0.0; 2], 4_100));
    bench.stay([0.0, -0.36], 100);
    assert!(!bench.verdict().danger);
    bench.stay([0.0, -0.42], 15);
    assert!(bench.verdict().danger);
    // A proof that was lost takes its floor along.
    bench.state.proof.forget();
    bench.stay([0.0, -0.42], 20);
    assert!(!bench.verdict().danger);
}

/// A spike down while it lies is not where it lay.
#[test]
fn a_spike_is_not_the_lowest_place() {
    let mut bench = Bench::rig();
    bench.stay([0.0, -0.45], 1_000);
    bench.stay([0.0, -0.95], 10);
    assert!(!bench.stay([0.0, -0.45], 20_000));
}

#[test]
fn rocking_bouncing_and_whirling_are_no_proof() {
    let shown = |place: &dyn Fn(f32) -> [f32; 2]| {
        let mut bench = Bench::rig();
        // The wall as it reads with gap, zero and gain told wrong.
        bench.stay([0.0, -0.43], 5_000);
        (0..60_000).any(|number| {
            bench.at(place(number as f32 / RATE));
            bench.verdict().floats
        })
    };
    let turn = |time: f32, hz: f32| core::f32::consts::TAU * hz * time;
    assert!(!shown(&|time| {
        let angle = 0.35 * turn(time, 15.0).sin();
        [0.43 * angle.sin(), -0.43 * angle.cos()]
    }));
    assert!(!shown(&|time| {
        let part = (time % 0.012) / 0.012;
        [0.0, -0.43 + 0.64 * 4.0 * part * (1.0 - part)]
    }));
    for hz in [2.0, 20.0, 150.0] {
        assert!(!shown(&|time| [
            0.43 * turn(time, hz).sin(),
            -0.43 * turn(time, hz).cos()
        ]));
    }
}

#[test]
fn a_machine_without_weight_needs_the_signal_and_a_commissioning_check() {
    for (commissioned, signal, shown) in [
        (true, Some(true), true),
        (true, None, false),
        (false, Some(true), false),
        (true, Some(false), false),
    ] {
        let mut bench = Bench::new(RATE, 0.0, commissioned);
        let proven = (0..10_000).any(|_| {
            bench.planes([Some([0.1, 0.0]); 2], signal);
            bench.verdict().floats
        });
        assert_eq!(proven, shown, "{commissioned} {signal:?}");
    }
}

#[test]
fn a_plane_that_is_fitted_and_does_not_deliver_proves_nothing() {
    let mut bench = Bench::rig();
    bench.state.proof.assume_lift();
    let proven = (0..20_000).any(|_| {
        bench.planes([Some([0.0; 2]), None], None);
        bench.verdict().floats
    });
    assert!(!proven);
}

#[test]
fn each_time_at_the_wall_is_a_touch() {
    let mut bench = Bench::rig();
    bench.stay([0.0; 2], 100);
    for number in 0..5 {
        bench.go([0.0; 2], [0.0, -0.9], 60);
        bench.go([0.0, -0.9], [0.0; 2], 60);
        assert_eq!(bench.touch.count, number + 1);
    }
    // One that comes to stay.
    bench.go([0.0; 2], [0.0, -1.0], 60);
    bench.stay([0.0, -1.0], 5_000);
    let told = bench.touches.chunks(2).take(5);
    for touch in told {
        let [begun, ended] = touch else { panic!() };
        assert_eq!((begun.end, begun.number), (None, ended.number));
        assert!(ended.end.is_some_and(|end| end > begun.onset));
        assert!((ended.peak - 0.9).abs() < 1e-3, "{ended:?}");
    }
    assert_eq!(bench.touches.len(), 11);
    assert_eq!(bench.touches[10].end, None);
    assert_eq!(bench.touches[10].plane, Plane::Both);
}

#[test]
fn one_plane_that_touches_is_named() {
    let mut bench = Bench::rig();
    bench.stay([0.0; 2], 100);
    for number in 0..120 {
        let out = 0.95 * (number as f32 / 120.0);
        bench.planes([Some([0.0; 2]), Some([out, 0.0])], None);
    }
    assert_eq!(bench.touches.len(), 1);
    assert_eq!(bench.touches[0].plane, Plane::B);
}

proptest! {
    /// A count over the samples themselves says what the guard says, whatever they are.
    #[test]
    fn window_is_a_count(readings in prop::collection::vec(prop::option::weighted(0.9, 0.5_f32..0.8), 1..200)) {
        let mut bench = Bench::rig();
        let mut seen = Vec::new();
        for reading in readings {
            bench.planes([reading.map(|it| [it, 0.0]), None], None);
            if let Some(reading) = reading {
                if seen.is_empty() {
                    seen = vec![reading; 20];
                }
                seen.push(reading);
            }
            let last = &seen[seen.len().saturating_sub(20)..];
            let beyond = last.iter().filter(|it| (**it * GAP).powi(2) >= (0.67 * GAP).powi(2)).count();
            prop_assert_eq!(bench.verdict().danger, beyond >= 15);
        }
    }

    /// Beyond danger for 2 ms at any rate from 4 kHz on is danger, and was told as an alarm.
    #[test]
    fn never_mute(rate in 4_000.0_f32..200_000.0, angle in 0.0_f32..core::f32::consts::TAU, before in 0_u32..300) {
        let mut bench = Bench::new(rate, 9.81, false);
        bench.stay([0.1, 0.1], before);
        let samples = (2e-3 * rate) as u32;
        bench.stay([0.7 * angle.cos(), 0.7 * angle.sin()], samples);
        prop_assert!(bench.verdict().danger);
        prop_assert!(bench.alarms.iter().any(|it| it.level == Level::Danger));
    }
}
