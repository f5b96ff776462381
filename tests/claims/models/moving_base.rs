//! A base that goes to and fro: a held rotor and a ring on its spring against their forced oscillations in closed form,
//! in model and reference; and a drop on it in both.

use touchdown_base::machine::Machine;
use touchdown_models::{ActuatorConfig, BaseConfig, MountConfig, Placement};
use touchdown_run::model;
use touchdown_scene::Scene;
use touchdown_tests::rotors::{built, ring, rotor};
use touchdown_scene::{Base, Magnet, Support};
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart};

/// In units of the model: the base, and the squares of the rates of rotor and ring.
const AMPLITUDE: [f64; 2] = [0.04, -0.03];
const RATE: f64 = 2.3;
const PHASE: f64 = 0.7;
const HOLDS: f64 = 9.0;
const SPRUNG: f64 = 40.0;
const END: f64 = 3.0;

/// x'' = -k x + A W^2 cos(W t + phase) from rest at 0.
fn forced(k: f64, amplitude: f64) -> f64 {
    let (rate, size) = (k.sqrt(), amplitude * RATE * RATE / (k - RATE * RATE));
    let (sin, cos) = (rate * END).sin_cos();
    let start = size * (PHASE.cos() * cos - RATE / rate * PHASE.sin() * sin);
    size * (RATE * END + PHASE).cos() - start
}

fn off(k: f64, place: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis| place[axis] - forced(k, AMPLITUDE[axis]));
    f64::hypot(x, y)
}

#[test]
fn a_held_rotor_and_its_ring_follow_the_base() {
    let mut errors = Vec::new();
    for step in [4e-3, 2e-3] {
        let mut config = rotor([ring(0.0)], 0.4, step);
        config.gravity = [0.0; 2];
        config.magnets[0] = ActuatorConfig { stiffness: -HOLDS, ..ActuatorConfig::default() };
        config.rings[0].mount =
            Some(MountConfig { mass: 0.2, stiffness: 0.2 * SPRUNG, damping: 0.0, vertical: None, friction: 0.0, stop: None });
        config.base = Some(BaseConfig { amplitude: AMPLITUDE, rate: RATE, phase: PHASE });
        let model = built::<1, 2>(&config);
        let mut state = model.start(&Placement::default(), 0.0, |_| {}).expect("valid");
        let first = model.energy(&state).total();
        for _ in 0..(END / step).round() as u32 {
            model.step(&mut state, |_| panic!("no contact"));
        }
        let account = model.energy(&state).total() - first;
        let found = [
            off(HOLDS, state.centre().0),
            off(SPRUNG, model.ring(&state, 0).position),
        ];
        println!("step {step}: off by {:.2e}, {:.2e}; account {account:.1e}", found[0], found[1]);
        assert!(account.abs() < 1e-13);
        errors.push(found);
    }
    for k in 0..2 {
        let ratio = errors[0][k] / errors[1][k];
        assert!(errors[0][k] < 1e-4 && (3.9..4.1).contains(&ratio), "{errors:?}");
    }
}

#[test]
fn the_reference_follows_it_to_rounding() {
    let rotor = Machine {
        mass: 1.0,
        radius: 1.0,
        polar_inertia: 0.4,
        clearance: 1.0,
        friction: 0.0,
        restitution: 1.0,
        gravity: 0.0,
    };
    let mount = Support { mass: 0.2, stiffness: 0.2 * SPRUNG, damping: 0.0, vertical: None, friction: 0.0, stop: None };
    let mut machine = CoupledMachine::level(&rotor, Some(mount), None);
    let magnet = Magnet { place: 0.0, stiffness: -HOLDS, force: [0.0; 2], damping: 0.0, limit: None, on: None };
    machine.magnets = vec![magnet];
    machine.base = Some(Base { amplitude: AMPLITUDE, rate: RATE, phase: PHASE });
    let mut reference = CoupledReference::new(&machine, &CoupledStart::default(), 0.0);
    let state = reference.advance(END, &mut |_, _| panic!("no contact"));
    let found = [off(HOLDS, state.position), off(SPRUNG, state.rings[0].position)];
    println!("off by {:.1e}, {:.1e}", found[0], found[1]);
    assert!(found.iter().all(|it| *it < 1e-14));
}

/// York's compressor on soft mounts, on a deck that shakes with 3 g at 40 Hz.
#[test]
fn a_drop_on_a_moving_base_is_the_references() {
    let text = Scene::text("york-ymc2").expect("built in").into_owned();
    let text = text + "\n[base]\namplitude_mm = [0.2, 0.4]\nfrequency_hz = 40.0\nphase_deg = 30.0\n";
    let mut scene = Scene::parse("deck", &text).expect("valid");
    scene.run.duration = 0.05;
    scene.model.step = 1e-6;
    let still = {
        let mut scene = scene.clone();
        scene.two_plane.as_mut().expect("two ends").base = None;
        touchdown_truth::simulate(&scene).impacts[0].state.time
    };
    let ours = model::run(&scene).expect("valid");
    let truth = touchdown_truth::simulate(&scene);
    let first = [&ours.histories.whole, &truth].map(|it| it.impacts[0]);
    let late = first[0].state.time - first[1].state.time;
    println!("{:e} s without; {:e} s, off by {late:e}", still, first[1].state.time);
    assert!(late.abs() < 1e-9 && (first[1].state.time - still).abs() > 1e-4);
    let ledger = ours.ledger.expect("kept");
    assert!(ledger.imbalance_j().abs() < 1e-9 * ledger.stored_j().abs(), "{}", ledger.imbalance_j());
}
