//! The f64 reference against closed forms and invariants.

use proptest::prelude::*;
use std::f64::consts::PI;
use touchdown_base::history::{ModelEvent, History, PhaseKind, Recorder, Regime, RotorState};
use touchdown_base::machine::{Machine, Start};
use touchdown_tests::close::close;
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::{Reference, energy};

const INERTIA: f64 = 0.5;
const SPIN: f64 = 1000.0 * PI;
/// Length, mass, time and speed in units of the scale law: dyadic inputs stay exact.
const SCALED: Machine = Machine {
    mass: 1.0,
    radius: 1.0,
    polar_inertia: 0.5,
    clearance: 1.0,
    friction: 0.1,
    restitution: 0.8,
    gravity: 1.0,
};

fn run(machine: &Machine, start: &Start, spin: f64, end: f64) -> History {
    let mut reference = Reference::new(machine, start, spin);
    let mut recorder = Recorder::new(0.0);
    let state = reference.advance(end, &mut |happening| recorder.take(happening));
    recorder.finish(state, reference.still_speed())
}

fn free(position: [f64; 2], velocity: [f64; 2]) -> Start {
    Start::Free { position, velocity }
}

/// Angle from the bottom and tangential speed.
fn polar(state: &RotorState) -> (f64, f64) {
    let ([x, y], [vx, vy]) = (state.position, state.velocity);
    let angle = x.atan2(-y);
    (angle, vx * angle.cos() + vy * angle.sin())
}

fn slip(machine: &Machine, state: &RotorState) -> f64 {
    polar(state).1 + machine.radius * state.spin
}

#[test]
fn straight_drop_from_the_centre() {
    let fall = f64::sqrt(2.0 * RIG.clearance / RIG.gravity);
    let history = run(&RIG, &free([0.0; 2], [0.0; 2]), 0.0, 0.1);
    close(history.impacts[0].state.time, fall, 1e-17);
    close(history.impacts[0].normal_speed, fall * RIG.gravity, 1e-16);
    close(
        history.impacts[0].normal_impulse,
        RIG.mass * 1.8 * fall * RIG.gravity,
        1e-15,
    );
    // (V/g)(1 + eps)/(1 - eps) = 9 V/g from the release.
    close(history.contact_starts[0], 9.0 * fall, 1e-15);
    close(history.contact_starts[0], 70.385_57e-3, 5e-9);
    assert_eq!(history.regime, Regime::Rest);
}

#[test]
fn no_restitution_is_contact_at_once() {
    let machine = Machine {
        restitution: 0.0,
        ..RIG
    };
    let history = run(&machine, &free([2e-5, 0.0], [0.0; 2]), -SPIN, 0.1);
    assert_eq!(history.impacts.len(), 1);
    assert_eq!(history.contact_starts, [history.impacts[0].state.time]);
}

#[test]
fn sliding_invariant() {
    let (friction, unit) = (RIG.friction, (RIG.clearance * RIG.gravity).sqrt());
    for spin in [-SPIN, SPIN] {
        let rub = -friction * spin.signum();
        let scale = 1.0 + 4.0 * friction * friction;
        let (a, b) = (
            2.0 * (1.0 - 2.0 * friction * friction) / scale,
            6.0 * rub / scale,
        );
        let invariant = |state: &RotorState| {
            let (angle, speed) = polar(state);
            let orbit = (speed / unit).powi(2) - a * angle.cos() - b * angle.sin();
            orbit * (-2.0 * rub * angle).exp()
        };
        let start = Start::Wall {
            angle: 0.3,
            tangential: 0.02,
        };
        let mut reference = Reference::new(&RIG, &start, spin);
        let mut none = |_: ModelEvent| {};
        let first = invariant(&reference.advance(0.0, &mut none));
        let mut worst = 0.0_f64;
        for k in 1..=10_000 {
            let state = reference.advance(f64::from(k) * 2e-3, &mut none);
            worst = worst.max((invariant(&state) - first).abs());
        }
        println!("sliding invariant over 20 s: {worst:.1e}");
        assert!(worst < 2e-14);
        assert_eq!(reference.phase(), PhaseKind::Sliding);
    }
}

#[test]
fn whirl_without_gravity_ends_in_rolling() {
    let machine = Machine {
        gravity: 0.0,
        ..RIG
    };
    let start = Start::Wall {
        angle: 0.0,
        tangential: 0.12,
    };
    let rolling = (0.12 + INERTIA * RIG.radius * SPIN) / (1.0 + INERTIA);
    let expected = RIG.clearance / RIG.friction * (1.0 / 0.12 - 1.0 / rolling);
    let history = run(&machine, &start, -SPIN, 0.03);
    close(expected, 24.881_012_541_524_722e-3, 1e-17);
    close(history.rolling_starts[0], expected, 1e-16);
    close(polar(&history.end).1, rolling, 1e-12);
    let turns = (rolling / 0.12).ln() / RIG.friction / (2.0 * PI)
        + rolling * (0.03 - expected) / RIG.clearance / (2.0 * PI);
    close(history.end.turns_in_contact, turns, 1e-10);
    assert_eq!(history.regime, Regime::BackwardWhirl);
}

#[test]
fn rolling_pendulum_keeps_energy_and_period() {
    let (amplitude, friction) = (0.8_f64, 0.5);
    let machine = Machine { friction, ..RIG };
    let rate = (RIG.gravity / RIG.clearance / (1.0 + INERTIA)).sqrt();
    let (mut a, mut b) = (1.0_f64, (amplitude / 2.0).cos());
    for _ in 0..6 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let period = 2.0 * PI / (rate * a);
    let start = Start::Wall {
        angle: amplitude,
        tangential: 0.0,
    };
    let mut reference = Reference::new(&machine, &start, 0.0);
    let mut none = |_: ModelEvent| {};
    let first = reference.advance(0.0, &mut none);
    let end = reference.advance(10_000.0 * period, &mut none);
    assert_eq!(reference.phase(), PhaseKind::Rolling);
    let lost = (energy(&machine, &end) - energy(&machine, &first)).abs();
    let unit = machine.mass * machine.gravity * machine.clearance;
    let phase = polar(&end).1 / (rate * rate * amplitude.sin() * machine.clearance) * rate;
    println!(
        "10 000 swings: energy {:.1e}, phase {phase:.1e} rad",
        lost / unit
    );
    assert!(lost / unit < 1e-14);
    assert!(phase.abs() < 1e-9);
}

#[test]
fn rolling_slips_where_friction_cannot_hold_it() {
    let machine = Machine {
        friction: 0.15,
        ..SCALED
    };
    let square = 1.2_f64;
    let start = Start::Wall {
        angle: 0.0,
        tangential: square.sqrt(),
    };
    let mut times = Vec::new();
    let mut reference = Reference::new(&machine, &start, -square.sqrt());
    reference.advance(1.0, &mut |happening| match happening {
        ModelEvent::ContactStart { rolling, .. } => assert!(rolling),
        ModelEvent::SlidingStart(time) => times.push(time),
        other => panic!("{other:?}"),
    });
    let (angle, speed) =
        polar(&Reference::new(&machine, &start, -square.sqrt()).advance(times[0], &mut |_| {}));
    let rolling = square - 2.0 * (1.0 - angle.cos()) / (1.0 + INERTIA);
    close(speed * speed, rolling, 1e-14);
    let needed = INERTIA * angle.sin() / (1.0 + INERTIA);
    close(needed, machine.friction * (rolling + angle.cos()), 1e-14);
}

#[test]
fn slip_reverses_where_friction_cannot_hold_it() {
    let machine = Machine {
        friction: 0.05,
        ..SCALED
    };
    let start = Start::Wall {
        angle: 1.2,
        tangential: 0.0,
    };
    let mut reference = Reference::new(&machine, &start, 0.1);
    let mut happenings = 0;
    let before = reference.advance(0.09, &mut |_| happenings += 1);
    let after = reference.advance(0.11, &mut |_| happenings += 1);
    assert!(slip(&machine, &before) > 0.0 && slip(&machine, &after) < 0.0);
    // Friction turns with the slip: from then on it speeds the spin up, by mu n / beta.
    let later = reference.advance(0.111, &mut |_| happenings += 1);
    let (angle, speed) = polar(&after);
    let pressing = speed * speed + angle.cos();
    close(
        (later.spin - after.spin) / 1e-3,
        machine.friction * pressing / INERTIA,
        1e-4,
    );
    assert_eq!((happenings, reference.phase()), (1, PhaseKind::Sliding));
}

#[test]
fn whirl_threshold() {
    for friction in [0.0, 0.1, 0.3] {
        let machine = Machine { friction, ..RIG };
        let decay = (-2.0 * PI * friction).exp();
        let square = 3.0 * (1.0 + decay) / (1.0 + 4.0 * friction * friction) - 1.0;
        let threshold = (RIG.gravity * RIG.clearance * square).sqrt();
        for (part, kept) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
            let tangential = part * threshold;
            let start = Start::Wall {
                angle: 0.0,
                tangential,
            };
            let history = run(
                &machine,
                &start,
                -SPIN,
                2.5 * PI * RIG.clearance / threshold,
            );
            assert_eq!(
                history.lift_offs.is_empty(),
                kept,
                "friction {friction}, {part}"
            );
        }
    }
}

#[test]
fn flight_after_lift_off() {
    let start = Start::Wall {
        angle: 0.2,
        tangential: 0.09,
    };
    let mut reference = Reference::new(&RIG, &start, SPIN);
    let mut times = Vec::new();
    reference.advance(0.02, &mut |happening| match happening {
        ModelEvent::LiftOff(time) => times.push(time),
        ModelEvent::Impact(impact) => times.push(impact.state.time),
        _ => {}
    });
    let at_lift_off = Reference::new(&RIG, &start, SPIN).advance(times[0], &mut |_| {});
    let (angle, speed) = polar(&at_lift_off);
    close(
        speed * speed / (RIG.gravity * RIG.clearance),
        -angle.cos(),
        1e-14,
    );
    close(
        times[1] - times[0],
        4.0 * at_lift_off.velocity[1] / RIG.gravity,
        1e-16,
    );
}

#[test]
fn elastic_frictionless_bounces_keep_energy() {
    let machine = Machine {
        restitution: 1.0,
        friction: 0.0,
        ..RIG
    };
    let start = free([1e-4, 2e-5], [0.0; 2]);
    let mut reference = Reference::new(&machine, &start, 0.0);
    let first = energy(&machine, &reference.advance(0.0, &mut |_| {}));
    let (mut worst, mut count) = (0.0_f64, 0);
    reference.advance(30.0, &mut |happening| {
        if let ModelEvent::Impact(impact) = happening {
            worst = worst.max((energy(&machine, &impact.state) - first).abs());
            count += 1;
        }
    });
    let unit = machine.mass * machine.gravity * machine.clearance;
    println!("{count} impacts: energy {:.1e}", worst / unit);
    assert!(count > 3000);
    assert!(worst / unit < 1e-12);
}

#[test]
fn impact_invariant_and_friction_law() {
    for (friction, spin) in [
        (0.1, -SPIN),
        (0.1, SPIN),
        (1.5, 10.0),
        (0.3, 0.0),
        (0.0, SPIN),
    ] {
        let machine = Machine { friction, ..RIG };
        let start = free([1e-4, 2e-5], [0.01, 0.02]);
        let impacts = run(&machine, &start, spin, 0.1).impacts;
        assert!(impacts.len() > 40);
        let mut reference = Reference::new(&machine, &start, spin);
        for impact in impacts.iter().take(40) {
            let before = reference.advance(impact.state.time.next_down(), &mut |_| {});
            let angular =
                |state: &RotorState| INERTIA * machine.radius * state.spin - polar(state).1;
            let tolerance = 1e-15 * (1.0 + machine.radius * spin.abs());
            close(angular(&impact.state), angular(&before), tolerance);
            let limit = friction * impact.normal_impulse / machine.mass;
            let rubbed = polar(&impact.state).1 - polar(&before).1;
            let stick = slip(&machine, &before) * INERTIA / (1.0 + INERTIA);
            close(rubbed, (-stick).clamp(-limit, limit), 1e-14);
        }
    }
}

#[test]
fn exact_graze_is_no_impact() {
    // Touches the top at t = 1/2 with speed 1/2, then lands where tau^2 = 3.
    let start = free([-0.25, 0.875], [0.5, 0.5]);
    let history = run(&SCALED, &start, 0.0, 2.5);
    close(history.impacts[0].state.time, 0.5 + f64::sqrt(3.0), 1e-15);
    assert!(history.impacts[0].normal_speed > 0.5);
}

#[test]
fn rounded_grazes_are_no_impacts() {
    let unit = (RIG.clearance / RIG.gravity).sqrt();
    for k in 0..200 {
        let (angle, back) = (PI - 0.005 * f64::from(k), 0.3);
        let speed = 0.6 * (-angle.cos()).sqrt();
        let (sine, cosine) = angle.sin_cos();
        let (vx, vy) = (speed * cosine, speed * sine);
        let position = [sine - vx * back, -cosine - vy * back - 0.5 * back * back];
        let start = free(
            position.map(|p| p * RIG.clearance),
            [vx, vy + back].map(|v| v * RIG.clearance / unit),
        );
        let history = run(&RIG, &start, 0.0, 10.0 * unit);
        assert!(
            history.impacts[0].state.time > 1.01 * back * unit,
            "angle {angle}"
        );
    }
}

#[test]
fn straight_bouncing_without_gravity() {
    let machine = Machine {
        gravity: 0.0,
        friction: 0.0,
        ..RIG
    };
    let speed = 0.1;
    let impacts = run(&machine, &free([0.0; 2], [speed, 0.0]), SPIN, 10.0).impacts;
    let (mut time, mut v) = (RIG.clearance / speed, speed);
    assert!(impacts.len() > 20);
    for (k, impact) in impacts.iter().enumerate() {
        close(impact.state.time / time, 1.0, 1e-14);
        close(impact.normal_speed / v, 1.0, 1e-14);
        close(impact.state.position[0].abs(), RIG.clearance, 1e-19);
        assert_eq!(impact.state.position[0] > 0.0, k % 2 == 0);
        v *= RIG.restitution;
        time += 2.0 * RIG.clearance / v;
    }
}

#[test]
fn nothing_happens_at_rest_without_gravity() {
    let machine = Machine {
        gravity: 0.0,
        ..RIG
    };
    let history = run(&machine, &free([1e-4, 0.0], [0.0; 2]), SPIN, 1e4);
    assert!(history.impacts.is_empty() && history.contact_starts.is_empty());
    assert_eq!(history.end.position, [1e-4, 0.0]);
    let wall = Start::Wall {
        angle: 1.0,
        tangential: 0.0,
    };
    assert_eq!(run(&machine, &wall, SPIN, 10.0).end.turns_in_contact, 0.0);
}

#[test]
fn starts_on_the_wall() {
    let down = [0.0, -RIG.clearance];
    let outward = run(&RIG, &free(down, [0.0, -0.05]), 0.0, 0.01);
    assert_eq!(outward.impacts[0].state.time, 0.0);
    close(outward.impacts[0].normal_speed, 0.05, 1e-17);
    let inward = run(&RIG, &free(down, [0.0, 0.05]), 0.0, 0.02);
    close(inward.impacts[0].state.time, 0.1 / RIG.gravity, 1e-17);
    let resting = run(&RIG, &free(down, [0.0; 2]), 0.0, 0.01);
    assert_eq!(
        (resting.contact_starts.as_slice(), resting.regime),
        (&[0.0][..], Regime::Rest)
    );
    let top = Start::Wall {
        angle: PI,
        tangential: 0.01,
    };
    let falling = run(&RIG, &top, SPIN, 0.1);
    assert_eq!(
        (falling.contact_starts[0], falling.lift_offs[0]),
        (0.0, 0.0)
    );
    assert_eq!(falling.phases[0].phase, PhaseKind::FreeFall);
    let side = Start::Wall {
        angle: PI / 2.0,
        tangential: 0.0,
    };
    assert!(run(&RIG, &side, 0.0, 0.01).lift_offs.is_empty());
}

#[test]
fn sampling_does_not_matter() {
    let start = Start::Wall {
        angle: 0.2,
        tangential: 0.09,
    };
    let mut reference = Reference::new(&RIG, &start, SPIN);
    for k in 0..14_000 {
        reference.advance(f64::from(k) * 1e-5, &mut |_| {});
    }
    let whole = run(&RIG, &start, SPIN, 0.14).end;
    assert_eq!(reference.advance(0.14, &mut |_| {}), whole);
}

#[test]
fn elastic_hopping_is_bounded() {
    // Hops of 1e-2 and 5e-4 units of time: flown, and taken as contact.
    for (launch, flown) in [(1e-2, true), (5e-4, false)] {
        let machine = Machine {
            restitution: 1.0,
            friction: 0.0,
            ..SCALED
        };
        let start = free([0.0, -1.0], [1.0, launch]);
        let history = run(&machine, &start, 0.0, 1.0);
        assert_eq!(history.contact_starts.is_empty(), flown);
        assert_eq!(history.impacts.len() > 50, flown);
        assert!(history.impacts.len() < 1000);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None,
                                        rng_seed: prop::test_runner::RngSeed::Fixed(1),
                                        ..ProptestConfig::default() })]

    #[test]
    fn laws_hold_everywhere(
        friction in prop_oneof![Just(0.0), 0.0..1.5_f64],
        restitution in prop_oneof![Just(0.0), Just(1.0), 0.0..0.99_f64],
        gravity in prop_oneof![4 => Just(9.81), 1 => Just(0.0)],
        spin in prop_oneof![Just(0.0), -20.0..20.0_f64, -1e4..1e4_f64],
        on_wall in any::<bool>(),
        (angle, part, vx, vy) in (-PI..PI, 0.0..1.0_f64, -0.2..0.2_f64, -0.2..0.2_f64),
    ) {
        let machine = Machine { friction, restitution, gravity, ..RIG };
        let start = if on_wall {
            Start::Wall { angle, tangential: vx }
        } else {
            let distance = part * machine.clearance;
            free([distance * angle.sin(), -distance * angle.cos()], [vx, vy])
        };
        let mut reference = Reference::new(&machine, &start, spin);
        let mut happenings = Vec::new();
        let mut before = energy(&machine, &reference.advance(0.0, &mut |h| happenings.push(h)));
        let tolerance = 1e-12 * (before.abs() + machine.mass * gravity * machine.clearance);
        for k in 1..=2000 {
            let state = reference.advance(f64::from(k) * 1e-4, &mut |h| happenings.push(h));
            let distance = f64::hypot(state.position[0], state.position[1]) / machine.clearance;
            prop_assert!(distance <= 1.0 + 1e-13, "left the gap: {distance}");
            let now = energy(&machine, &state);
            prop_assert!(now <= before + tolerance, "energy rose by {}", now - before);
            before = now;
            if reference.phase() == PhaseKind::Rolling {
                let slip = slip(&machine, &state);
                prop_assert!(slip.abs() <= 1e-13 * (1.0 + state.spin.abs()), "slip {slip}");
            }
        }
        let mut last = 0.0;
        for happening in happenings {
            let time = match happening {
                ModelEvent::Impact(impact) => {
                    prop_assert!(impact.normal_speed > 0.0);
                    impact.state.time
                }
                ModelEvent::Released { state, .. } => state.time,
                ModelEvent::ContactStart { time, .. }
                | ModelEvent::RollingStart(time)
                | ModelEvent::SlidingStart(time)
                | ModelEvent::LiftOff(time) => time,
            };
            prop_assert!(time >= last);
            last = time;
        }
    }
}
