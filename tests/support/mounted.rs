//! A rotor in one ring on a mount, without units.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use touchdown_models::{Coupled, CoupledConfig, CoupledState, MountConfig, Placement, StopConfig};

use crate::rotors::{built, ring, rotor};

/// One ring at the centre of mass on this mount, no gravity, no friction, no loss.
pub fn one(mount: MountConfig, step: f64) -> CoupledConfig<1> {
    let mut seat = ring(0.0);
    seat.mount = Some(mount);
    let mut config = rotor([seat], 0.4, step);
    config.gravity = [0.0; 2];
    config
}

/// A number, even over the decades between these powers of ten.
pub fn decades(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    10_f64.powf(random.random_range(low..high))
}

/// A random rotor that falls and bounces in a ring on a random mount that rubs, with a rigid stop, by steps that may be too
/// long for it; `change` is the last to draw.
pub fn random_drop(
    seed: u64,
    change: impl FnOnce(&mut MountConfig, &mut ChaCha8Rng),
) -> (Coupled<f64, 1, 2>, CoupledState<f64, 1, 2>) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = |low, high| decades(&mut random, low, high);
    let mut mount = MountConfig {
        mass: draw(-3.0, 0.5),
        stiffness: draw(-1.0, 4.0),
        damping: 0.0,
        vertical: Some([draw(-1.0, 4.0), 0.0]),
        friction: draw(-2.0, 1.0),
        stop: Some(StopConfig::rigid(draw(-2.0, 0.0))),
    };
    let step = draw(-4.0, -1.0);
    let restitution = draw(-2.0, 0.0);
    let velocity = [draw(-2.0, 0.5), -draw(-2.0, 0.5)];
    let spin = draw(-1.0, 1.0);
    change(&mut mount, &mut random);
    let mut config = one(mount, step);
    config.gravity = [0.0, -1.0];
    config.rings[0].restitution = restitution;
    config.rings[0].friction = 0.3;
    let start = Placement {
        velocity,
        ..Placement::default()
    };
    let model = built::<1, 2>(&config);
    let state = model.start(&start, spin, |_| {}).expect("valid");
    (model, state)
}
