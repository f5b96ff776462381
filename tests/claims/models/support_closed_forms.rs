//! Rung `support` against closed forms: the rotor on its springs, whirl on a support, impacts with a
//! ring that is free to move.

use std::f64::consts::TAU;

use touchdown_rotor::{Change, Touch};
use touchdown_tests::moment::Moment;
use touchdown_tests::ring_scenes::Fall;

const GRAVITY: f64 = 9.81;

/// Rotor and ring together on spring and damper.
struct Oscillator {
    sag: f64,
    decay: f64,
    rate: f64,
}

impl Oscillator {
    fn of(fall: &Fall) -> Self {
        let mount = fall.mount.expect("a support");
        let mass = fall.rigid.mass + mount.mass;
        let decay = 0.5 * mount.damping / mass;
        Self {
            sag: fall.rigid.mass * GRAVITY / mount.stiffness,
            decay,
            rate: (mount.stiffness / mass - decay * decay).sqrt(),
        }
    }

    /// Depth after `time`, from 0 at this speed downwards.
    fn depth(&self, time: f64, speed: f64) -> f64 {
        let (sin, cos) = (self.rate * time).sin_cos();
        let swing = self.sag * cos + (self.decay * self.sag - speed) / self.rate * sin;
        self.sag - (-self.decay * time).exp() * swing
    }
}

/// Largest error of the ring's depth, in sags, of a rotor laid on its ring.
fn laid_on(damping: f64, step: f64) -> (f64, Moment) {
    let fall = Fall::new(step).mounted(1.0, 1e6, damping).on_wall(0.0, 0.0);
    let oscillator = Oscillator::of(&fall);
    let (mut worst, mut last) = (0.0_f64, None);
    let told = fall.follow::<f64>(0.2, |now| {
        let error = -now.ring[1] - oscillator.depth(now.time, 0.0);
        worst = worst.max(error.abs() / oscillator.sag);
        assert_ne!(now.touch, Touch::None, "{now:?}");
        last = Some(*now);
    });
    assert_eq!(told.len(), 2, "{told:?}");
    (worst, last.expect("the start"))
}

/// sqrt(k/(m + m_s)) = 65 Hz. The midpoint rule is slow by (w h)^2/12: 1.1e-4 rad after 82.
#[test]
fn a_rotor_laid_on_its_ring_swings_at_the_natural_frequency() {
    let (coarse, fine) = (laid_on(0.0, 2e-5).0, laid_on(0.0, 1e-5).0);
    println!("of the sag: {coarse:.2e} {fine:.2e}");
    assert!(fine < 1.2e-4, "{fine}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
}

/// The same phase error, largest where exp(-d t) has fallen to 1/e: (w h)^2/12 (w/d)/e, 4.2e-6.
#[test]
fn a_damped_support_decays_to_its_sag() {
    let ((coarse, _), (fine, last)) = (laid_on(600.0, 2e-5), laid_on(600.0, 1e-5));
    println!("of the sag: {coarse:.2e} {fine:.2e}");
    assert!(fine < 5e-6, "{fine}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
    // exp(-50 t) is left of it.
    let weight = 5.0 * GRAVITY;
    assert!((last.load.normal / weight - 1.0).abs() < 1e-4, "{last:?}");
    assert!(
        (-last.ring[1] * 1e6 / weight - 1.0).abs() < 1e-4,
        "{last:?}"
    );
}

/// Without restitution the ring is caught up: v1 = v0 m/(m + m_s), and falls on with the rotor.
#[test]
fn a_drop_on_a_soft_support_goes_as_deep_as_its_energy() {
    let errors = [4e-5, 2e-5, 1e-5].map(|step| {
        let mut fall = Fall::new(step).mounted(1.0, 1e6, 0.0);
        fall.rigid.restitution = 0.0;
        let oscillator = Oscillator::of(&fall);
        let speed = (2.0 * GRAVITY * 3e-4_f64).sqrt() * 5.0 / 6.0;
        let swing = oscillator.sag.hypot(speed / oscillator.rate);
        let force = 5.0 * (GRAVITY + oscillator.rate * oscillator.rate * swing);
        let (mut depth, mut load) = (0.0_f64, 0.0);
        fall.follow::<f64>(0.0125, |now| {
            depth = depth.max(-now.ring[1]);
            load = now.load.held_peak;
        });
        let (depth, force) = (depth / (oscillator.sag + swing) - 1.0, load / force - 1.0);
        println!("{step:.0e} s: depth {depth:.1e}, force {force:.1e}");
        (depth, force)
    });
    // Of second order, with where in a step the deepest point falls.
    for (step, (depth, force)) in [4.0_f64, 2.0, 1.0].iter().zip(errors) {
        assert!(depth.abs() < 3e-5 * step * step, "{depth}");
        assert!(force.abs() < 3e-5 * step * step, "{force}");
    }
}

/// Frequency (rad/s) and load (N) of steady whirl with slip, without gravity: rotor and ring go round
/// at angles to the contact that friction and damper set. With D = k - m_s W^2 + i c W, arg((D - m
/// W^2)/D) = atan(mu); the load follows from the clearance.
fn steady_whirl(fall: &Fall) -> (f64, f64) {
    let (rotor, mount) = (&fall.rigid, fall.mount.expect("a support"));
    let stiffness = |rate: f64| mount.stiffness - mount.mass * rate * rate;
    let lean = |rate: f64| {
        let (spring, damper) = (stiffness(rate), mount.damping * rate);
        damper.atan2(spring - rotor.mass * rate * rate) - damper.atan2(spring)
    };
    let (mut slow, mut fast) = (1.0, (mount.stiffness / (rotor.mass + mount.mass)).sqrt());
    for _ in 0..100 {
        let middle = 0.5 * (slow + fast);
        if lean(middle) < rotor.friction.atan() {
            slow = middle;
        } else {
            fast = middle;
        }
    }
    let (spring, damper) = (stiffness(slow), mount.damping * slow);
    let square = spring * spring + damper * damper;
    let into = 1.0 / (rotor.mass * slow * slow) - spring / square;
    let across = damper / square;
    (slow, rotor.clearance / (into + rotor.friction * across))
}

/// Errors of frequency and load, relative, of whirl that friction has driven until it settled.
fn whirl(damping: f64, step: f64) -> (f64, f64) {
    // A heavy spin, against which friction is constant.
    let mut fall = Fall::new(step).mounted(1.0, 1e6, damping).spinning(-3000.0);
    fall.rigid.gravity = 0.0;
    fall.rigid.polar_inertia *= 1e6;
    let fall = fall.on_wall(0.0, 0.05);
    let (rate, load) = steady_whirl(&fall);
    let (mut from, mut to) = (None, None);
    fall.follow::<f64>(4.0, |now| {
        if now.time > 3.0 {
            from.get_or_insert(*now);
            to = Some(*now);
        }
    });
    let (from, to) = (from.expect("a start"), to.expect("an end"));
    let found = TAU * (to.turns - from.turns) / (to.time - from.time);
    // Settled, and slipping all the while.
    assert!((to.load.normal / from.load.normal - 1.0).abs() < 1e-9);
    assert_eq!(to.touch, Touch::Sliding);
    println!(
        "c {damping}, {step:.0e} s: {:.3} Hz, {load:.1} N, errors {:.1e} {:.1e}",
        rate / TAU,
        found / rate - 1.0,
        to.load.normal / load - 1.0
    );
    (found / rate - 1.0, to.load.normal / load - 1.0)
}

/// On a rigid ring it would grow without bound.
#[test]
fn whirl_settles_at_the_frequency_and_the_load_that_the_support_gives_it() {
    for damping in [200.0, 600.0, 2000.0] {
        let (coarse, fine) = (whirl(damping, 4e-5), whirl(damping, 2e-5));
        assert!(fine.0.abs() < 6e-6 && fine.1.abs() < 9e-6, "{fine:?}");
        assert!((coarse.0 / fine.0 - 4.0).abs() < 0.1, "{coarse:?} {fine:?}");
        assert!((coarse.1 / fine.1 - 4.0).abs() < 0.1, "{coarse:?} {fine:?}");
    }
}

/// m v + m_s u' stays, and the speeds part at the restitution; the spring is too soft to matter.
#[test]
fn an_impact_with_a_free_ring_keeps_the_momentum() {
    for ring in [1e-3, 1.0, 1e3] {
        let mut fall = Fall::new(1e-5).mounted(ring, 1e-9, 0.0);
        fall.rigid.gravity = 0.0;
        let fall = fall.free([1e-4, 0.0], [0.03, -0.04]).spinning(40.0);
        let (end, told) = fall.end::<f64>(0.01);
        let impacts = told.iter().filter(|t| matches!(t.1, Change::Impact { .. }));
        assert_eq!(impacts.count(), 1, "{told:?}");
        let start = [5.0 * 0.03, 5.0 * -0.04];
        for (k, start) in start.iter().enumerate() {
            let now = 5.0 * end.velocity[k] + ring * end.ring_velocity[k];
            assert!((now - start).abs() < 1e-14, "{ring} kg: {now} {start}");
        }
        // The impact's normal is where the ring went but for friction.
        let (Change::Impact { speed, .. }, at) = (told[0].1, told[0].0) else {
            panic!("{told:?}");
        };
        let met = [1e-4 + 0.03 * at, -0.04 * at].map(|x| x / 3e-4);
        let left = [0, 1].map(|k| end.velocity[k] - end.ring_velocity[k]);
        let apart = -(met[0] * left[0] + met[1] * left[1]);
        assert!(
            (apart / speed - 0.6).abs() < 1e-9,
            "{ring} kg: {apart} {speed}"
        );
    }
}
