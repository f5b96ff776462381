//! The reference for a ring on a mount that is stiffer along y than along x, against the closed form.

use touchdown_base::history::ModelEvent;
use touchdown_base::machine::Machine;
use touchdown_scene::Support;
use touchdown_tests::close::close_pair;
use touchdown_tests::rig::RIG;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart};

const ROTOR: Machine = Machine { friction: 0.0, gravity: 0.0, ..RIG };
/// The ring of 0.4 kg: along x, then along y.
const AXES: [[f64; 2]; 2] = [[2e6, 300.0], [5e6, 100.0]];

fn mount() -> Support {
    Support {
        mass: 0.4,
        stiffness: AXES[0][0],
        damping: AXES[0][1],
        vertical: Some(AXES[1]),
        friction: 0.0,
        stop: None,
    }
}

/// Of a damped oscillator of 0.4 kg, s after it left its rest with 1 m/s, m.
fn swing([stiffness, damping]: [f64; 2], time: f64) -> f64 {
    let decay = damping / 0.8;
    let rate = (stiffness / 0.4 - decay * decay).sqrt();
    (-decay * time).exp() * (rate * time).sin() / rate
}

/// Struck along a diagonal, it swings along x and along y at two rates.
#[test]
fn a_ring_swings_at_the_rate_of_each_axis() {
    let machine = CoupledMachine::level(&ROTOR, Some(mount()), None);
    let start = CoupledStart {
        velocity: [0.03, 0.04],
        ..CoupledStart::default()
    };
    let mut reference = CoupledReference::new(&machine, &start, 0.0);
    let touch = ROTOR.clearance / 0.05;
    let given = 0.05 * 1.8 * ROTOR.mass / (ROTOR.mass + 0.4);
    let mut impacts = Vec::new();
    let mut seen = 0;
    for k in 0..400 {
        let time = touch + f64::from(k) * 1e-5;
        let state = reference.advance(time, &mut |_, it| match it {
            ModelEvent::Impact(it) => impacts.push(it.state.time),
            it => panic!("{it:?}"),
        });
        if impacts.len() > 1 {
            break;
        }
        let want = AXES.map(|axis| swing(axis, time - touch) * given);
        close_pair(state.rings[0].position, [0.6 * want[0], 0.8 * want[1]], 1e-12 * ROTOR.clearance);
        seen += 1;
    }
    println!("{seen} moments until {impacts:?}");
    assert!(seen > 20);
}

/// In elastic impacts.
#[test]
fn without_damping_energy_is_kept_on_both_axes() {
    let rotor = Machine { restitution: 1.0, gravity: 9.81, ..ROTOR };
    let mut vertical = mount();
    (vertical.damping, vertical.vertical) = (0.0, Some([5e6, 0.0]));
    let machine = CoupledMachine::level(&rotor, Some(vertical), None);
    let start = CoupledStart { position: [1e-4, 2e-5], ..CoupledStart::default() };
    let mut reference = CoupledReference::new(&machine, &start, 0.0);
    let first = reference.advance(0.0, &mut |_, _| {});
    let first = reference.energy(&first);
    let mut count = 0;
    let end = reference.advance(1.0, &mut |_, _| count += 1);
    let lost = (reference.energy(&end) - first) / (rotor.mass * rotor.gravity * rotor.clearance);
    println!("{count} impacts: energy {lost:.1e}");
    assert!(count > 100 && lost.abs() < 1e-11);
}
