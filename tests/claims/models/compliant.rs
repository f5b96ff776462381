//! Walls that give way, in the coupled model: Hertz' closed forms, what is kept, and restitution.

use touchdown_models::{
    CompliantConfig, Coupled, CoupledConfig, CoupledState, MountConfig, Placement, Shape, StopConfig,
};
use touchdown_rotor::{Change, Precision, Pulse};
use touchdown_tests::rotors::{built, ring, rotor};

/// Of a rotor of mass 1 at speed 1.
const STIFF: f64 = 4e4;

fn wall(shape: Shape, stiffness: f64) -> Option<CompliantConfig> {
    Some(CompliantConfig { shape, stiffness, balls: None, slowest: 1e-3 })
}

/// One ring at the centre of mass, no gravity.
fn one(compliant: Option<CompliantConfig>, restitution: f64, step: f64) -> CoupledConfig<1> {
    let mut seat = ring(0.0);
    seat.restitution = restitution;
    seat.compliant = compliant;
    let mut config = rotor([seat], 0.4, step);
    config.gravity = [0.0; 2];
    config
}

/// Into the wall at the bottom at speed 1; the pulse, the model and its state after it.
fn strike<R: Precision>(config: &CoupledConfig<1>) -> (Pulse<f64>, Coupled<R, 1, 2>, CoupledState<R, 1, 2>) {
    let model = Coupled::<R, 1, 2>::try_new(config).expect("valid");
    let start = Placement { position: [0.0, -0.99], velocity: [0.0, -1.0], ..Placement::default() };
    let mut state = model.start(&start.rounded(), R::ZERO, |_| {}).expect("valid");
    let mut pulse = None;
    for _ in 0..1_000_000 {
        model.step(&mut state, |it| match it.event.change {
            Change::Released(it) => {
                pulse = Some(Pulse {
                    peak_force: it.peak_force.to_f64(),
                    duration: it.duration.to_f64(),
                    impulse: it.impulse.to_f64(),
                });
            }
            Change::Impact { speed, .. } => assert!((speed.to_f64() - 1.0).abs() < 1e-5),
            change => panic!("{change:?}"),
        });
        if let Some(pulse) = pulse {
            return (pulse, model, state);
        }
    }
    panic!("never released");
}

/// F0 = K^(2/5) (5 m V^2/4)^(3/5), T_c = 2.94328 (5 m V^2/(4 K))^(2/5)/V (Johnson, Contact Mechanics, 1985, chapter 11).
#[test]
fn a_point_contact_without_loss_is_hertz() {
    let force = STIFF.powf(0.4) * 1.25_f64.powf(0.6);
    let time = 2.943_275_278_886_26 * (1.25 / STIFF).powf(0.4);
    let mut off = Vec::new();
    for parts in [25.0, 50.0, 100.0] {
        let config = one(wall(Shape::Point, STIFF), 1.0, time / parts);
        let (pulse, model, state) = strike::<f64>(&config);
        let speed = state.centre().1[1];
        println!("T_c/{parts}: force {:.5}, time {:.5}, leaves at 1 - {:.1e}", pulse.peak_force / force, pulse.duration / time, 1.0 - speed);
        assert!((speed - 1.0).abs() < 1e-12 && (model.energy(&state).total() - 0.5).abs() < 1e-13);
        assert!((pulse.impulse - 2.0).abs() < 1e-12);
        off.push((pulse.peak_force / force - 1.0).abs());
        assert!((pulse.duration / time - 1.0).abs() < 2.0 / parts);
        let (single, ..) = strike::<f32>(&config);
        assert!((single.peak_force / pulse.peak_force - 1.0).abs() < 1e-3, "{single:?}");
    }
    assert!(off[0] < 2e-2 && off[2] < 2e-3, "{off:?}");
}

#[test]
fn a_damped_contact_leaves_with_its_restitution() {
    let time = 2.943 * (1.25 / STIFF).powf(0.4);
    for restitution in [0.1, 0.4, 0.6, 0.8, 0.95] {
        let mut errors = Vec::new();
        for parts in [50.0, 100.0] {
            let config = one(wall(Shape::Point, STIFF), restitution, time / parts);
            let (_, model, state) = strike::<f64>(&config);
            let account = model.energy(&state).total() - 0.5;
            assert!(account.abs() < 1e-13, "{account:e}");
            errors.push((state.centre().1[1] - restitution).abs());
        }
        println!("{restitution}: off by {:.1e} and {:.1e}", errors[0], errors[1]);
        assert!(errors[0] < 2e-3 && errors[1] < 0.5 * errors[0].max(1e-5), "{restitution}: {errors:?}");
    }
}

/// Springs: of the wall alone, and with as stiff balls behind it.
#[test]
fn balls_behind_a_spring_halve_its_stiffness() {
    for (balls, stiffness) in [(None, STIFF), (Some(STIFF), 0.5 * STIFF)] {
        let time = std::f64::consts::PI / stiffness.sqrt();
        let compliant = wall(Shape::Spring, STIFF).map(|it| CompliantConfig { balls, ..it });
        let (pulse, model, state) = strike::<f64>(&one(compliant, 1.0, time / 200.0));
        println!("force {:.5}, time {:.5}", pulse.peak_force / stiffness.sqrt(), pulse.duration / time);
        assert!((pulse.peak_force / stiffness.sqrt() - 1.0).abs() < 1e-3);
        assert!((pulse.duration / time - 1.0).abs() < 1e-2);
        assert!((model.energy(&state).total() - 0.5).abs() < 1e-13);
    }
}

/// A rotor that falls, bounces and lies, at one end or both, on fixed rings and soft ones: it comes to permanent contact,
/// and all energy is accounted for.
#[test]
fn a_fall_ends_in_permanent_contact() {
    for (shape, sprung) in [
        (Shape::Point, false),
        (Shape::Line, false),
        (Shape::Point, true),
    ] {
        let seats = [1.1, -0.7].map(|place| {
            let mut seat = ring(place);
            seat.restitution = 0.5;
            seat.friction = 0.15;
            seat.compliant = wall(shape, STIFF);
            seat.mount = sprung.then_some(MountConfig {
                mass: 0.1,
                stiffness: 300.0,
                damping: 3.0,
                vertical: None,
                friction: 0.2,
                stop: Some(StopConfig::rigid(0.05)),
            });
            seat
        });
        let config = rotor(seats, 0.4, 1e-3);
        let model = built::<2, 2>(&config);
        let start = Placement { position: [0.05, 0.1], ..Placement::default() };
        let (mut impacts, mut starts) = (0, 0);
        let mut state = model.start(&start, -20.0, |_| {}).expect("valid");
        let first = model.energy(&state).total();
        for _ in 0..10_000 {
            model.step(&mut state, |it| match it.event.change {
                Change::Impact { .. } => impacts += 1,
                Change::ContactStarts => starts += 1,
                _ => (),
            });
        }
        let energy = model.energy(&state);
        println!("{shape:?}, soft {sprung}: {impacts} impacts, {starts} contacts, account {:.1e}, lost {:.3}", energy.total() - first, energy.lost);
        assert!((energy.total() - first).abs() < 1e-11 && energy.lost > 0.1);
        assert!(impacts > 6 && starts >= 2, "{impacts} {starts}");
    }
}
