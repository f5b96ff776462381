//! A rotor in its rings without units, for the model of two planes looked at from inside.

use touchdown_models::{
    MagnetConfig, Placement, RingConfig, TwoPlane, TwoPlaneConfig, TwoPlaneState, UnbalanceConfig,
};

/// A ring like the first at this place.
pub fn ring(place: f64) -> RingConfig<f64> {
    RingConfig {
        place,
        clearance: 1.0,
        radius: 1.0,
        friction: 0.0,
        restitution: 1.0,
    }
}

/// Mass, transverse inertia, gap, gravity and radius of 1 make the units those of the model; then the
/// spin in V is in rad/T, and nutation is at `polar` times that.
pub fn rotor<const N: usize>(
    rings: [RingConfig<f64>; N],
    polar: f64,
    step: f64,
) -> TwoPlaneConfig<f64, N> {
    TwoPlaneConfig {
        mass: 1.0,
        polar_inertia: polar,
        transverse_inertia: 1.0,
        rings,
        gravity: [0.0, -1.0],
        speed: 1.0,
        unbalance: UnbalanceConfig::default(),
        magnets: [MagnetConfig::default(); 2],
        step,
    }
}

/// The model of a valid configuration.
pub fn built<const N: usize>(config: &TwoPlaneConfig<f64, N>) -> TwoPlane<f64, N> {
    TwoPlane::try_new(config).expect("valid configuration")
}

/// Runs for `time` T without a look at what happens.
pub fn run<const N: usize>(
    config: &TwoPlaneConfig<f64, N>,
    start: &Placement<f64>,
    spin: f64,
    time: f64,
) -> TwoPlaneState<f64, N> {
    let model = built(config);
    let mut state = model.start(start, spin, |_, _| {}).expect("valid start");
    for _ in 0..(time / config.step).round() as u64 {
        model.step(&mut state, |_, _| {});
    }
    state
}
