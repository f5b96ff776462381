//! Magnets that are switched off and on again, in model and reference: against the closed form of a fall between two
//! oscillations, whatever the step; and a rotor that is lifted off its retainers.

use touchdown_base::machine::Machine;
use touchdown_models::{ActuatorConfig, Placement};
use touchdown_run::model;
use touchdown_scene::Scene;
use touchdown_tests::rotors::{built, ring, rotor};
use touchdown_scene::Magnet;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart};

/// Switched off and on at these times; places and speeds in units of the model.
const OFF: f64 = 0.307;
const ON: f64 = 0.9011;
const END: f64 = 2.0;
/// Of the magnet, over the rotor's mass.
const HOLDS: f64 = 9.0;
const SAG: f64 = 1.0 / HOLDS;

/// It rests in the magnet's field, falls from `OFF` to `ON`, and then swings.
fn exact() -> [f64; 2] {
    let fall = ON - OFF;
    let (place, speed) = (-0.5 * fall * fall, -fall);
    let (rate, time) = (HOLDS.sqrt(), END - ON);
    let (sin, cos) = (rate * time).sin_cos();
    let swing = place * cos + speed / rate * sin;
    [swing - SAG, speed * cos - place * rate * sin]
}

#[test]
fn a_fall_between_two_holds_has_its_closed_form() {
    let magnet = |on| ActuatorConfig {
        stiffness: -HOLDS,
        on: Some(on),
        ..ActuatorConfig::default()
    };
    let mut errors = Vec::new();
    for step in [4e-3, 2e-3] {
        let mut config = rotor([ring(0.0)], 0.4, step);
        config.magnets[0] = magnet([0.0, OFF]);
        config.magnets[2] = magnet([ON, f64::INFINITY]);
        let start = Placement {
            position: [0.0, -SAG],
            ..Placement::default()
        };
        let model = built::<1, 2>(&config);
        let mut state = model.start(&start, 0.0, |_| {}).expect("valid");
        let first = model.energy(&state).total();
        for _ in 0..(END / step).round() as u32 {
            model.step(&mut state, |_| panic!("no contact"));
        }
        let ([_, y], [_, v]) = state.centre();
        let [place, speed] = exact();
        errors.push(f64::hypot(y - place, v - speed));
        let account = model.energy(&state).total() - first;
        println!("step {step}: off by {:.2e}, account {account:.1e}", errors[errors.len() - 1]);
        assert!(account.abs() < 1e-13);
    }
    assert!(errors[0] < 5e-5 && (3.9..4.1).contains(&(errors[0] / errors[1])), "{errors:?}");
}

#[test]
fn the_reference_has_it_to_rounding() {
    let rotor = Machine {
        mass: 1.0,
        radius: 1.0,
        polar_inertia: 0.4,
        clearance: 1.0,
        friction: 0.0,
        restitution: 1.0,
        gravity: 1.0,
    };
    let mut machine = CoupledMachine::level(&rotor, None, None);
    let magnet = |on| Magnet {
        place: 0.0,
        stiffness: -HOLDS,
        force: [0.0; 2],
        damping: 0.0,
        limit: None,
        on: Some(on),
    };
    machine.magnets = vec![magnet([0.0, OFF]), magnet([ON, f64::INFINITY])];
    let start = CoupledStart {
        position: [0.0, -SAG],
        ..CoupledStart::default()
    };
    let mut reference = CoupledReference::new(&machine, &start, 0.0);
    let state = reference.advance(END, &mut |_, _| panic!("no contact"));
    let [place, speed] = exact();
    let off = f64::hypot(state.position[1] - place, state.velocity[1] - speed);
    println!("off by {off:.1e}");
    assert!(off < 1e-14);
}

/// Dropped, and lifted again after 60 ms: model and reference end afloat, at the same place.
#[test]
fn a_rotor_is_lifted_again() {
    let scene = "[rotor]\nmass_kg = 10.0\nradius_mm = 20.0\nspeed_rpm = 6000.0\n\
        [retainer]\nclearance_mm = 0.2\nfriction = 0.1\nrestitution = 0.5\n\
        [two_plane]\nrotor_length_mm = 400.0\n[[ring]]\nz_mm = -150.0\n[[ring]]\nz_mm = 150.0\n\
        [[magnet]]\nz_mm = -100.0\nstiffness_n_m = -1.5e6\ndamping_n_s_m = 3000.0\nfrom_s = 0.06\n\
        [[magnet]]\nz_mm = 100.0\nstiffness_n_m = -1.5e6\ndamping_n_s_m = 3000.0\nfrom_s = 0.06\n\
        [run]\nduration_s = 0.3\n[model]\nstep_us = 5.0\n";
    let scene = Scene::parse("lifted", scene).expect("valid");
    let ours = model::run(&scene).expect("valid").histories.whole;
    let truth = touchdown_truth::simulate(&scene);
    let sag = -10.0 * 9.81 / 3e6;
    for history in [&ours, &truth] {
        let [x, y] = history.end.position;
        println!("{} impacts, ends at {x:e} {y:e}", history.impacts.len());
        assert!(!history.impacts.is_empty());
        assert!(f64::hypot(x, y - sag) < 1e-9, "{x:e} {y:e}");
        assert_eq!(history.lift_offs.len(), 1);
    }
    let off = (ours.lift_offs[0] - truth.lift_offs[0]).abs();
    assert!(off < 1e-5, "{off:e}");
}
