//! The rig of the paper, and runs of it on the model under test.

use touchdown_rotor::error::ConfigError;

use touchdown_base::failure::Failure;
use touchdown_base::history::{History, RotorState};
use touchdown_run::model;
use touchdown_scene::{BUILT_IN, Scene, Start};

/// Gap of the paper's calculations, m.
pub const GAP: f64 = 0.3e-3;
/// Gap of the magnetic bearings, where the measurements were made, m.
pub const WIDE_GAP: f64 = 0.75e-3;
/// Output interval, s: what a run gives does not depend on it.
const STEP: f64 = 1e-3;
/// Halvings of a search: to 1e-12 of its range.
const HALVINGS: usize = 40;

/// The rig with 0.3 mm of gap, on the desktop's first built-in scene.
pub fn rig() -> Result<Scene, Failure> {
    let mut scene = Scene::parse(BUILT_IN[0].name, BUILT_IN[0].text)?;
    scene.model.step = STEP;
    Ok(scene)
}

/// `scene` released at rest in the centre.
pub fn from_centre(scene: &Scene, duration: f64) -> Scene {
    let start = Start::Free {
        position: [0.0; 2],
        velocity: [0.0; 2],
    };
    started(scene, start, duration)
}

/// `scene` from the wall: `angle` from the bottom, rad, and its rate, rad/s.
pub fn on_wall(scene: &Scene, angle: f64, rate: f64, duration: f64) -> Scene {
    let tangential = rate * scene.retainer.clearance;
    started(scene, Start::Wall { angle, tangential }, duration)
}

/// `scene` from `start`, for `duration` s.
pub fn started(scene: &Scene, start: Start, duration: f64) -> Scene {
    let mut scene = scene.clone();
    scene.start = start;
    scene.run.duration = duration;
    scene
}

/// Runs the model under test.
pub fn run(scene: &Scene) -> Result<History, Failure> {
    model::simulate(scene).map_err(refused(scene))
}

/// For `map_err`.
pub fn refused(scene: &Scene) -> impl Fn(ConfigError) -> Failure + '_ {
    move |error| Failure::Usage(format!("{}: {error}", scene.name))
}

/// g/rho0, 1/s^2.
pub fn pendulum_square(scene: &Scene) -> f64 {
    scene.run.gravity / scene.retainer.clearance
}

/// Speed after a fall through the gap, m/s.
pub fn fall_speed(scene: &Scene) -> f64 {
    (2.0 * scene.run.gravity * scene.retainer.clearance).sqrt()
}

/// Speed along the wall as angular speed round the bearing, rad/s.
pub fn rate(state: &RotorState) -> f64 {
    turning(state.position, state.velocity)
}

/// The same just after the first impact of a run; not a number without one.
pub fn first_jump(scene: &Scene) -> Result<f64, Failure> {
    let first = run(scene)?.impacts.into_iter().next();
    Ok(first.map_or(f64::NAN, |it| rate(&it.state)))
}

/// Angular speed of a velocity at a position.
pub fn turning([x, y]: [f64; 2], [vx, vy]: [f64; 2]) -> f64 {
    (x * vy - y * vx) / (x * x + y * y)
}

/// Where `holds` changes from false at `lo` to true at `hi`, by halving; one such place if there are more.
pub fn change(
    mut lo: f64,
    mut hi: f64,
    mut holds: impl FnMut(f64) -> Result<bool, Failure>,
) -> Result<f64, Failure> {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (lo + hi);
        if holds(middle)? {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    Ok(0.5 * (lo + hi))
}
