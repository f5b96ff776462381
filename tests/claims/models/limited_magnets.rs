//! Magnets whose force has a limit: their closed form, and what they take.

use touchdown_models::{ActuatorConfig, Placement};
use touchdown_tests::rotors::{built, ring, rotor};

/// Of the magnet at the centre of mass; the rotor's mass is 1.
const HOLDS: f64 = 9.0;
const LIMIT: f64 = 1.8;
const FROM: f64 = 0.5;

/// Up to the place where the spring is at its limit by a constant force, then the quarter of a swing and beyond.
fn exact(time: f64) -> f64 {
    let bend = LIMIT / HOLDS;
    let constant = (2.0 * (FROM - bend) / LIMIT).sqrt();
    let speed = LIMIT * constant;
    let rate = HOLDS.sqrt();
    assert!(time > constant && rate * (time - constant) < std::f64::consts::PI);
    let (sin, cos) = (rate * (time - constant)).sin_cos();
    bend * cos - speed / rate * sin
}

#[test]
fn a_rotor_in_a_limited_magnet_has_its_closed_form() {
    let time = 0.9;
    let mut errors = Vec::new();
    for step in [4e-3, 2e-3] {
        let mut config = rotor([ring(0.0)], 0.4, step);
        config.gravity = [0.0; 2];
        config.magnets[0] = ActuatorConfig {
            stiffness: -HOLDS,
            limit: Some(LIMIT),
            ..ActuatorConfig::default()
        };
        let start = Placement { position: [0.0, FROM], ..Placement::default() };
        let model = built::<1, 2>(&config);
        let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
        let first = model.energy(&state).total();
        for _ in 0..(time / step).round() as u32 {
            model.step(&mut state, |_| panic!("no contact"));
        }
        let account = model.energy(&state).total() - first;
        assert!(account.abs() < 1e-14, "{account:e}");
        errors.push((state.centre().0[1] - exact(time)).abs());
    }
    println!("{:.4}, off by {errors:?}", exact(time));
    assert!(errors[0] < 5e-5 && (3.0..5.0).contains(&(errors[0] / errors[1])), "{errors:?}");
}

/// Each axis has a limit of its own: across the other nothing changes.
#[test]
fn one_axis_at_its_limit_leaves_the_other_as_it_is() {
    let mut config = rotor([ring(0.0)], 0.4, 2e-3);
    config.gravity = [0.0; 2];
    let start = Placement { position: [0.1, FROM], ..Placement::default() };
    let mut places = Vec::new();
    for limit in [None, Some(LIMIT)] {
        config.magnets[0] = ActuatorConfig {
            stiffness: -HOLDS,
            damping: 0.3,
            limit,
            ..ActuatorConfig::default()
        };
        let model = built::<1, 2>(&config);
        let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
        for _ in 0..200 {
            model.step(&mut state, |_| panic!("no contact"));
        }
        places.push(state.centre().0);
    }
    let [[a, b], [c, d]] = places[..] else { unreachable!() };
    assert!((a - c).abs() < 1e-14 && (b - d).abs() > 0.05, "{places:?}");
}
