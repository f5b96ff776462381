//! The reference where contacts come and go: bounce series, lift-off from a ring that moves, stiff mounts.

use touchdown_base::history::ModelEvent;
use touchdown_base::machine::{Machine, Start};
use touchdown_scene::{BUILT_IN, Scene, Support};
use touchdown_tests::close::close;
use touchdown_truth::Truth;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart};

const CLEARANCE: f64 = 3e-4;
const GRAVITY: f64 = 9.81;

/// The rig's rotor, which neither turns nor rubs.
fn falling(restitution: f64, mount: Option<Support>, start: &Start) -> CoupledReference {
    let rotor = Machine {
        mass: 3.42,
        radius: 0.024,
        polar_inertia: 0.000_984_96,
        clearance: CLEARANCE,
        friction: 0.0,
        restitution,
        gravity: GRAVITY,
    };
    let machine = CoupledMachine::level(&rotor, mount, None);
    CoupledReference::new(&machine, &CoupledStart::level(start, CLEARANCE), 0.0)
}

/// Dropped from the centre onto a fixed ring: the hops sum up to 2 eps v/(g (1 - eps)). Contact is early by the rest of the
/// series below the cut-off, 2 v/(g (1 - eps)), where v is 1e-10 V, and more where a unit of time has more than 250 impacts.
#[test]
fn a_bounce_series_ends_at_the_sum_of_its_hops() {
    let (time, speed) = ((CLEARANCE / GRAVITY).sqrt(), (CLEARANCE * GRAVITY).sqrt());
    let centre = Start::Free { position: [0.0; 2], velocity: [0.0; 2] };
    for (restitution, cutoff) in [(0.3, 1e-10), (0.8, 1e-10), (0.9, 1e-10), (0.99, 1e-8), (0.999, 2e-5)] {
        let mut reference = falling(restitution, None, &centre);
        let (mut starts, mut impacts) = (Vec::new(), 0);
        let sum = time * 2.0_f64.sqrt() * (1.0 + 2.0 * restitution / (1.0 - restitution));
        reference.advance(1.1 * sum, &mut |_, it| match it {
            ModelEvent::ContactStart { time, .. } => starts.push(time),
            ModelEvent::Impact(_) => impacts += 1,
            _ => panic!("{it:?}"),
        });
        let early = sum - starts[0];
        let most = 2.0 * cutoff * speed / (GRAVITY * (1.0 - restitution));
        println!("{restitution}: {impacts} impacts, contact early by {:.1e} T", early / time);
        assert_eq!(starts.len(), 1);
        assert!(early > -1e-13 * sum * f64::from(impacts) && early < most, "{early:e} of {most:e}");
        assert_eq!(reference.given_up(), None);
    }
}

/// A rotor without rebound hits a ring on spring and damper: both go as one oscillator until the spring's and the damper's
/// force is the ring's weight. There the rotor leaves without a jump: its force only passes through 0.
#[test]
fn a_rotor_leaves_a_damped_ring_where_the_force_ends() {
    let (rotor, ring) = (3.42, 0.2);
    let mut count = 0;
    for stiffness in [1e6, 1e7, 1e8, 1e9] {
        for part in [0.01, 0.1, 0.3] {
            for speed in [0.02, 0.05, 0.1] {
                let both = rotor + ring;
                let damping = 2.0 * part * f64::sqrt(stiffness * both);
                let mount = Support { mass: ring, stiffness, damping, vertical: None, friction: 0.0, stop: None };
                let start = Start::Free { position: [0.0, -CLEARANCE], velocity: [0.0, -speed] };
                let mut reference = falling(0.0, Some(mount), &start);

                let decay = 0.5 * damping / both;
                let rate = (stiffness / both - decay * decay).sqrt();
                let rest = -rotor * GRAVITY / stiffness;
                let first = -rest;
                let second = (-speed * rotor / both + decay * first) / rate;
                let moving = |t: f64| {
                    let ((sine, cosine), left) = ((rate * t).sin_cos(), (-decay * t).exp());
                    let swing = first * cosine + second * sine;
                    let turned = rate * (second * cosine - first * sine);
                    [rest + left * swing, left * (turned - decay * swing)]
                };
                let presses = |t: f64| {
                    let [place, speed] = moving(t);
                    ring * GRAVITY - stiffness * place - damping * speed
                };
                let step = 1e-3 / rate;
                let leaving = (1..10_000).map(|k| f64::from(k) * step).find(|t| presses(*t) < 0.0);
                let Some(mut after) = leaving else { continue };
                count += 1;
                let mut before = after - step;
                for _ in 0..60 {
                    let middle = 0.5 * (before + after);
                    *(if presses(middle) < 0.0 { &mut after } else { &mut before }) = middle;
                }

                let mut left = Vec::new();
                let [place, leaves] = moving(after);
                let later = after + 0.5 * leaves / GRAVITY;
                let state = reference.advance(later, &mut |_, it| {
                    if let ModelEvent::LiftOff(time) = it {
                        left.push(time);
                    }
                });
                assert_eq!((left.len(), reference.given_up()), (1, None), "{stiffness} {part} {speed}");
                close(left[0], after, 1e-10 / rate);
                let want = place - CLEARANCE + 0.375 * leaves * leaves / GRAVITY;
                close(state.position[1], want, 1e-10 * CLEARANCE);
            }
        }
    }
    println!("{count} of 36 leave");
    assert!(count > 20);
}

#[test]
fn every_built_in_scene_is_followed_for_a_second() {
    for it in BUILT_IN {
        let mut scene = Scene::load(it.name).expect("a built-in scene");
        scene.run.duration = 1.0;
        let mut truth = Truth::new(&scene);
        truth.advance(1.0);
        assert_eq!(truth.given_up(), None, "{}", it.name);
    }
}

/// The rig on rings of 0.2 kg.
#[test]
fn stiff_mounts_are_followed_for_a_second() {
    for stiffness in [1e7, 1e8, 1e9] {
        for damping in [200.0, 2e3, 2e4] {
            let mut scene = Scene::load("rig").expect("a built-in scene");
            scene.support = Some(Support { mass: 0.2, stiffness, damping, vertical: None, friction: 0.0, stop: None });
            scene.run.duration = 1.0;
            let mut truth = Truth::new(&scene);
            truth.advance(1.0);
            assert_eq!(truth.given_up(), None, "{stiffness} {damping}");
        }
    }
}
