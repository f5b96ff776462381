//! A rotor in its rings without units, for the coupled engine looked at from inside.

use touchdown_models::{
    ActuatorConfig, Coupled, CoupledConfig, CoupledState, Placement, RingConfig, UnbalanceConfig,
};

/// A rigid ring like the first at this place.
pub fn ring(place: f64) -> RingConfig {
    RingConfig {
        place,
        clearance: 1.0,
        radius: 1.0,
        friction: 0.0,
        restitution: 1.0,
        compliant: None,
        mount: None,
        race: None,
        shape: [0.0; 3],
    }
}

/// Mass, transverse inertia, gap, gravity and radius of 1 make the units those of the model; then the
/// spin in V is in rad/T, and nutation is at `polar` times that.
pub fn rotor<const N: usize>(rings: [RingConfig; N], polar: f64, step: f64) -> CoupledConfig<N> {
    CoupledConfig {
        mass: 1.0,
        polar_inertia: polar,
        transverse_inertia: 1.0,
        rings,
        gravity: [0.0, -1.0],
        speed: 1.0,
        unbalance: UnbalanceConfig::default(),
        magnets: [ActuatorConfig::default(); 4],
        base: None,
        modes: [None; 3],
        step,
    }
}

/// The model of a valid configuration; `Q` coordinates, 2 of a rigid rotor that tilts.
pub fn built<const N: usize, const Q: usize>(config: &CoupledConfig<N>) -> Coupled<f64, N, Q> {
    Coupled::try_new(config).expect("valid configuration")
}

/// Runs for `time` T without a look at what happens.
pub fn run<const N: usize>(
    config: &CoupledConfig<N>,
    start: &Placement<f64>,
    spin: f64,
    time: f64,
) -> CoupledState<f64, N, 2> {
    let model = built(config);
    let mut state = model.start(start, spin, |_| {}).expect("valid start");
    for _ in 0..(time / config.step).round() as u64 {
        model.step(&mut state, |_| {});
    }
    state
}
