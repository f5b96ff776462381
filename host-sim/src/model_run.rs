//! The model under test over a scene.

use touchdown_core::error::ConfigError;
use touchdown_core::model::{
    Change, Instant, Kinematics, Precision, Rigid, RigidConfig, RigidState, Start as ScaledStart,
    Touch,
};
use touchdown_core::scales::Scales;

use crate::history::{Happening, History, Impact, Recorder, RotorState};
use crate::reference::Start;
use crate::scene::{self, Scene};

/// Part of the speed scale below which a rotor in contact is at rest.
const STILL: f64 = 1e-6;

/// Runs the scene's rung from the release to the end.
pub fn simulate(scene: &Scene) -> Result<History, ConfigError> {
    let model = Rigid::try_new(&RigidConfig {
        mass: scene.rotor.mass,
        radius: scene.rotor.radius,
        polar_inertia: scene.rotor.polar_inertia,
        clearance: scene.retainer.clearance,
        friction: scene.retainer.friction,
        restitution: scene.retainer.restitution,
        gravity: scene.run.gravity,
        speed: start_speed(scene),
        step: scene.model.step,
    })?;
    let scales = *model.scales();
    let spin = scene.rotor.spin / scales.spin;
    match (scene.model.precision, scaled(&scene.start, &scales)) {
        (scene::Precision::F64, start) => run(&model, &start, spin, scene, &scales),
        (scene::Precision::F32, start) => run(
            &model.rounded(),
            &rounded(&start),
            spin as f32,
            scene,
            &scales,
        ),
    }
}

/// Sets the scale where there is no gravity.
fn start_speed(scene: &Scene) -> f64 {
    let speed = match scene.start {
        Start::Free { velocity, .. } => velocity[0].hypot(velocity[1]),
        Start::Wall { tangential, .. } => tangential.abs(),
    };
    if speed > 0.0 { speed } else { 1.0 }
}

fn scaled(start: &Start, scales: &Scales<f64>) -> ScaledStart<f64> {
    match *start {
        Start::Free { position, velocity } => ScaledStart::Free {
            position: position.map(|x| x / scales.length),
            velocity: velocity.map(|v| v / scales.speed),
        },
        Start::Wall { angle, tangential } => {
            let (sin, cos) = angle.sin_cos();
            ScaledStart::Wall {
                sin,
                cos,
                tangential: tangential / scales.speed,
            }
        }
    }
}

fn rounded(start: &ScaledStart<f64>) -> ScaledStart<f32> {
    match *start {
        ScaledStart::Free { position, velocity } => ScaledStart::Free {
            position: position.map(|x| x as f32),
            velocity: velocity.map(|v| v as f32),
        },
        ScaledStart::Wall {
            sin,
            cos,
            tangential,
        } => ScaledStart::Wall {
            sin: sin as f32,
            cos: cos as f32,
            tangential: tangential as f32,
        },
    }
}

fn run<R: Precision>(
    model: &Rigid<R>,
    start: &ScaledStart<R>,
    spin: R,
    scene: &Scene,
    scales: &Scales<f64>,
) -> Result<History, ConfigError> {
    let step = scene.model.step;
    let mut recorder = Recorder::new(-scene.first_sample_time());
    let mass = scene.rotor.mass;
    let mut take = |happening: touchdown_core::model::Happening<R>| {
        let time = seconds(happening.at, step);
        let after = to_si(&happening.after, time, scales);
        recorder.take(match happening.change {
            Change::Impact(normal) => {
                let normal_speed = normal.to_f64() * scales.speed;
                Happening::Impact(Impact {
                    state: after,
                    normal_speed,
                    normal_impulse: mass * (1.0 + scene.retainer.restitution) * normal_speed,
                })
            }
            Change::ContactStarts => Happening::ContactStart {
                time,
                rolling: happening.after.touch == Touch::Rolling,
            },
            Change::RollingStarts => Happening::RollingStart(time),
            Change::SlidingStarts => Happening::SlidingStart(time),
            Change::LiftsOff => Happening::LiftOff(time),
        });
    };
    let mut state = model.start(start, spin, &mut take)?;
    let end = end_of_run::<R>(scene.run.duration / step);
    for _ in 0..end.tick {
        model.step(&mut state, &mut take);
    }
    if end.fraction > R::ZERO {
        model.advance(&mut state, end, &mut take);
    }
    let last = last_state(model, &state, scene.run.duration, scales);
    Ok(recorder.finish(last, STILL * scales.speed))
}

/// A duration that is a whole number of steps but for rounding ends on the last of them.
fn end_of_run<R: Precision>(steps: f64) -> Instant<R> {
    let nearest = steps.round();
    if (steps - nearest).abs() <= 1e-9 * nearest {
        return Instant::at_tick(nearest as u64);
    }
    Instant {
        tick: steps.floor() as u64,
        fraction: R::lit(steps.fract()),
    }
}

fn seconds<R: Precision>(at: Instant<R>, step: f64) -> f64 {
    (at.tick as f64 + at.fraction.to_f64()) * step
}

fn last_state<R: Precision>(
    model: &Rigid<R>,
    state: &RigidState<R>,
    time: f64,
    scales: &Scales<f64>,
) -> RotorState {
    to_si(&model.kinematics(state), time, scales)
}

fn to_si<R: Precision>(k: &Kinematics<R>, time: f64, scales: &Scales<f64>) -> RotorState {
    RotorState {
        time,
        position: k.position.map(|x| x.to_f64() * scales.length),
        velocity: k.velocity.map(|v| v.to_f64() * scales.speed),
        spin: k.spin.to_f64() * scales.spin,
        turns_in_contact: k.turns.0 as f64 + k.turns.1.to_f64() / std::f64::consts::TAU,
    }
}
