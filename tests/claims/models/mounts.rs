//! Mounts that are stiffer along one axis, and mounts that rub: their closed forms.

use touchdown_models::{Coupled, CoupledConfig, CoupledState, MountConfig, Placement, StopConfig};
use touchdown_tests::mounted::{one, random_drop};
use touchdown_tests::rotors::built;

/// Of the ring, over the rotor's: it is left behind by a rotor that bounces off it.
const HEAVY: f64 = 2.0;
/// Of the ring after a head-on impact of a rotor at speed 1 without loss.
const KICKED: f64 = 2.0 / (1.0 + HEAVY);

const MOUNT: MountConfig = MountConfig {
    mass: HEAVY,
    stiffness: 18.0,
    damping: 0.0,
    vertical: None,
    friction: 0.0,
    stop: None,
};

/// At the wall, moving into it.
fn into_wall(direction: [f64; 2]) -> Placement<f64> {
    Placement {
        position: direction,
        velocity: direction,
        ..Placement::default()
    }
}

fn run(config: &CoupledConfig<1>, start: &Placement<f64>, time: f64) -> (Coupled<f64, 1, 2>, CoupledState<f64, 1, 2>) {
    let model = built::<1, 2>(config);
    let mut state = model.start(start, 0.0, |_| {}).expect("valid");
    let first = model.energy(&state).total();
    for _ in 0..(time / config.step).round() as u32 {
        model.step(&mut state, |_| ());
    }
    let account = model.energy(&state).total() - first;
    assert!(account.abs() < 1e-13, "account {account:e}");
    (model, state)
}

#[test]
fn a_ring_that_is_struck_swings_along_each_axis_by_itself() {
    let mount = MountConfig { damping: 0.4, vertical: Some([50.0, 1.2]), ..MOUNT };
    let direction = [0.6, -0.8];
    let time = 1.0;
    let swing = |speed: f64, [stiffness, damping]: [f64; 2]| {
        let decay = 0.5 * damping / HEAVY;
        let rate = (stiffness / HEAVY - decay * decay).sqrt();
        speed / rate * (rate * time).sin() * (-decay * time).exp()
    };
    let exact = [
        swing(KICKED * direction[0], [18.0, 0.4]),
        swing(KICKED * direction[1], [50.0, 1.2]),
    ];
    let mut errors = Vec::new();
    for step in [4e-3, 2e-3] {
        let (model, state) = run(&one(mount, step), &into_wall(direction), time);
        let [x, y] = model.ring(&state, 0).position;
        errors.push(f64::hypot(x - exact[0], y - exact[1]));
    }
    println!("off by {errors:?}");
    assert!(errors[1] < 2e-5 && (3.7..4.3).contains(&(errors[0] / errors[1])), "{errors:?}");
}

/// Swings about the place to which friction F moves the rest, F/k to either side, until it stops within F/k of the middle.
#[test]
fn dry_friction_stops_a_ring_where_its_closed_form_does() {
    let friction = 1.1;
    let mount = MountConfig { friction, ..MOUNT };
    let off = friction / MOUNT.stiffness;
    let rate = (MOUNT.stiffness / HEAVY).sqrt();
    let mut place = (off * off + (KICKED / rate).powi(2)).sqrt() - off;
    // Half a swing each.
    let mut side = 1.0;
    while place > off {
        (place, side) = (place - 2.0 * off, -side);
    }
    let exact = side * place;
    let mut errors = Vec::new();
    for step in [4e-3, 2e-3, 1e-3] {
        let (model, state) = run(&one(mount, step), &into_wall([1.0, 0.0]), 4.0);
        let ring = model.ring(&state, 0);
        assert_eq!(ring.velocity, [0.0; 2]);
        let taken = model.energy(&state).mounts;
        let left = 0.5 * MOUNT.stiffness * exact * exact;
        assert!((taken + left - 0.5 * HEAVY * KICKED * KICKED).abs() < 1e-3, "{taken} {left}");
        errors.push((ring.position[0] - exact).abs());
    }
    println!("stops at {exact:.4}, off by {errors:?}");
    // A ring that stops at the end of its last stretch, and not where its speed ends, is off by 3e-7.
    assert!(exact.abs() > 0.01 && errors[2] < 1e-7, "{errors:?}");
}

/// Weight 1 on a ring that rubs: it stays where that suffices, else it goes down until the spring carries the rest.
#[test]
fn a_ring_that_rubs_carries_the_rotor_at_rest() {
    for (friction, travels) in [(1.2, false), (0.3, true)] {
        let mut config = one(MountConfig { friction, damping: 4.0, ..MOUNT }, 2e-3);
        config.gravity = [0.0, -1.0];
        config.rings[0].restitution = 0.0;
        let start = Placement { position: [0.0, -1.0], ..Placement::default() };
        let (model, state) = run(&config, &start, 8.0);
        let ring = model.ring(&state, 0);
        let [_, y] = ring.position;
        println!("friction {friction}: rests at {y:.4}");
        assert_eq!(ring.velocity, [0.0; 2]);
        // In the band in which friction holds what the spring does not.
        let held = -1.0 - MOUNT.stiffness * y;
        assert!(held.abs() <= friction && (y < -1e-3) == travels, "{y}");
    }
}

/// Struck on the slant, beside a spring that pulls another way: friction is against the motion, which turns.
#[test]
fn dry_friction_turns_with_the_motion() {
    let mount = MountConfig { friction: 0.6, vertical: Some([60.0, 0.0]), ..MOUNT };
    let ends: Vec<[f64; 2]> = [4e-3, 2e-3, 1e-3, 1.25e-4]
        .into_iter()
        .map(|step| {
            let (model, state) = run(&one(mount, step), &into_wall([0.8, -0.6]), 0.9);
            let it = model.ring(&state, 0);
            assert!(model.energy(&state).mounts > 0.0);
            it.position
        })
        .collect();
    let off = |k: usize| f64::hypot(ends[k][0] - ends[3][0], ends[k][1] - ends[3][1]);
    println!("{ends:?}: {:.1e} {:.1e} {:.1e}", off(0), off(1), off(2));
    assert!(off(0) < 1e-3 && off(2) < 0.5 * off(0));
}

/// Whatever moves the ring: rotors fall and bounce in it, with a stop, by steps that are too long for its mount.
#[test]
fn dry_friction_gives_no_energy() {
    let mut rubbed = 0;
    for seed in 0..300 {
        let (model, mut state) = random_drop(seed, |_, _| ());
        let (mut taken, first) = (0.0, model.energy(&state).total());
        for _ in 0..2_000 {
            model.step(&mut state, |_| ());
            let energy = model.energy(&state);
            let account = energy.total() - first;
            assert!(energy.mounts >= taken - 1e-13, "{seed}: {taken:e}");
            assert!(account.abs() < 1e-9, "{seed}: account {account:e}");
            taken = energy.mounts;
        }
        rubbed += usize::from(taken > 0.0);
    }
    println!("{rubbed} of 300 rubbed");
    assert!(rubbed > 150);
}

/// A rotor that spins lies on a ring on its stop, with more weight than the ring's dry friction holds and less friction: the
/// stop takes the weight, dry friction what the rotor drags by.
#[test]
fn dry_friction_holds_a_ring_that_is_pressed_onto_its_stop() {
    let mount = MountConfig {
        stiffness: 1.0,
        damping: 2.0,
        friction: 0.5,
        stop: Some(StopConfig::rigid(0.05)),
        ..MOUNT
    };
    let mut config = one(mount, 2e-3);
    config.gravity = [0.0, -1.0];
    config.rings[0].restitution = 0.0;
    config.rings[0].friction = 0.3;
    let start = Placement { position: [0.0, -1.0], ..Placement::default() };
    let model = built::<1, 2>(&config);
    let mut state = model.start(&start, 20.0, |_| {}).expect("valid");
    let mut places = Vec::new();
    for _ in 0..2 {
        (0..1_000).for_each(|_| model.step(&mut state, |_| ()));
        let ring = model.ring(&state, 0);
        assert_eq!((ring.stopped, ring.velocity), (true, [0.0; 2]));
        places.push(ring.position);
    }
    assert_eq!(places[0], places[1]);
}
