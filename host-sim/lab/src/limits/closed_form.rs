//! Extremes whose result is known in closed form. Each is run at every step, or at the one it is about.

use crate::limits::extreme::{STEPS, free, wall};
use crate::limits::watch::inertia;
use touchdown_base::history::History;
use touchdown_base::input_error::InputError;
use touchdown_scene::Scene;
use touchdown_truth::Units;
use touchdown_truth::reference::energy;

/// A scene and what is known of it.
pub struct ClosedForm {
    /// In words, with what is measured.
    pub name: &'static str,
    /// Whatever its precision and step.
    pub scene: Scene,
    /// Steps at which it is run, s; the worst counts.
    pub steps: &'static [f64],
    /// Error of a run, in `unit`.
    pub error: Box<dyn Fn(&History) -> f64>,
    /// f64 and f32.
    pub limits: [f64; 2],
    /// Of both.
    pub unit: &'static str,
}

impl ClosedForm {
    /// Of a scene whose first impact comes after `time`, T, whatever the step.
    fn of_first_impact(name: &'static str, scene: Scene, time: f64, limits: [f64; 2]) -> Self {
        let units = Units::of(&scene);
        Self {
            name,
            scene,
            steps: &STEPS,
            error: Box::new(move |h| first(&h.impacts, |i| i.state.time / units.time - time)),
            limits,
            unit: "T",
        }
    }
}

/// Errors of times and speeds, f64 and f32: what is asked of the time of permanent contact.
const EVENT: [f64; 2] = [1e-11, 1e-5];

/// All of them.
pub fn closed_forms() -> Result<Vec<ClosedForm>, InputError> {
    let rig = Scene::load("rig")?;
    Ok(vec![
        fall_from_the_top(&rig),
        force_ends_where_it_starts(&rig),
        graze(&rig),
        rolling_at_the_limit(&rig),
        impact_at_the_limit(&rig),
        whirl(&rig, WHIRL),
        whirl(&rig, GROWTH_IN_ONE_STEP),
        series_in_one_step(&rig),
        hundreds_of_impacts_in_one_step(&rig),
        denormals(&rig, DENORMAL),
        denormals(&rig, SINGLE_DENORMAL),
    ])
}

/// On the wall at the top, at rest: the wall can only push, so it falls at once, through 2 rho0.
fn fall_from_the_top(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    scene.start = wall(std::f64::consts::PI, 0.0);
    let name = "no normal speed where gravity pulls off the wall: first impact";
    ClosedForm::of_first_impact(name, scene, 2.0, EVENT)
}

/// v^2 = -g rho0 cos phi: the wall force is zero at the start and falls. The flight lasts 4 v_y/g.
fn force_ends_where_it_starts(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    let units = Units::of(&scene);
    let angle = 2.0_f64;
    let speed = (-angle.cos()).sqrt();
    scene.start = wall(angle, speed * units.speed);
    let flight = 4.0 * speed * angle.sin();
    let name = "no wall force at the start, and less to come: first impact";
    // Rounding of the force decides which flight it is: the root of it is lost.
    ClosedForm::of_first_impact(name, scene, flight, [1e-7, 1e-3])
}

/// A parabola that touches the wall from inside at the top right and bends away: no impact there. From
/// there on |p|^2 - 1 = (v^2 + p.g) t^2 + v.g t^3 + t^4/4 in the model's units, 0 at the first impact.
fn graze(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    let units = Units::of(&scene);
    let (angle, speed, before) = (2.5_f64, 0.6, 0.4);
    let there = [speed * angle.cos(), speed * angle.sin()];
    let position = [
        angle.sin() - there[0] * before,
        -angle.cos() - there[1] * before - 0.5 * before * before,
    ];
    let velocity = [there[0], there[1] + before];
    scene.start = free(
        position.map(|x| x * units.length),
        velocity.map(|v| v * units.speed),
    );
    let (square, cube) = (speed * speed + angle.cos(), -there[1]);
    let landing = before + 2.0 * ((cube * cube - square).sqrt() - cube);
    let name = "graze, where the path touches the wall and bends away: first impact";
    // The root of what rounding takes off.
    ClosedForm::of_first_impact(name, scene, landing, [1e-6, 1e-5])
}

/// Released where rolling needs just the friction there is: it rolls, and keeps its energy.
fn rolling_at_the_limit(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    let angle = 0.6_f64;
    let beta = inertia(&scene);
    scene.rotor.spin = 0.0;
    scene.retainer.friction = angle.tan() * beta / (1.0 + beta);
    scene.start = wall(angle, 0.0);
    let machine = scene.machine();
    let unit = machine.mass * machine.gravity * machine.clearance;
    let height = -machine.clearance * angle.cos() * machine.mass * machine.gravity;
    ClosedForm {
        name: "rolling that needs all the friction there is: energy lost or gained",
        scene,
        steps: &STEPS,
        error: Box::new(move |h| ((energy(&machine, &h.end) - height) / unit).abs()),
        limits: [1e-12, 1e-4],
        unit: "m g rho0",
    }
}

/// A straight fall whose first impact has just the impulse to stop the slip.
fn impact_at_the_limit(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    let units = Units::of(&scene);
    let retainer = scene.retainer;
    let beta = inertia(&scene);
    let impulse = (1.0 + retainer.restitution) * 2.0_f64.sqrt();
    let slip = retainer.friction * impulse * (1.0 + beta) / beta;
    let radius = scene.rotor.radius;
    scene.rotor.spin = -slip * units.speed / radius;
    scene.start = free([0.0; 2], [0.0; 2]);
    ClosedForm {
        name: "impact with just the friction that stops the slip: slip after it",
        scene,
        steps: &STEPS,
        error: Box::new(move |h| {
            first(&h.impacts, |i| {
                (i.state.velocity[0] + radius * i.state.spin) / units.speed
            })
        }),
        limits: [1e-14, 1e-6],
        unit: "V",
    }
}

/// Start of a whirl without gravity: name, rad/s, steps and duration.
type Whirl = (&'static str, f64, &'static [f64], f64);
/// 13 kHz at the end: 0.8 rad in 10 us.
const WHIRL: Whirl = (
    "whirl to rolling at 0.8 rad a step: moment and speed of rolling",
    350.0,
    &[1e-5],
    0.03,
);
/// h mu v = 2 at the start: in plain arithmetic the speed passes infinity inside the step.
const GROWTH_IN_ONE_STEP: Whirl = (
    "growth to infinity inside one step (h mu v of 2): moment and speed of rolling",
    20_000.0,
    &[1e-3],
    0.002,
);

/// Weightless whirl: v' = mu v^2 until it rolls at (v - beta W)/(1 + beta).
fn whirl(rig: &Scene, (name, turning, steps, duration): Whirl) -> ClosedForm {
    let mut scene = rig.clone();
    let beta = inertia(&scene);
    let clearance = scene.retainer.clearance;
    let start = turning * clearance;
    scene.run.gravity = 0.0;
    scene.run.duration = duration;
    scene.start = wall(0.0, start);
    let surface = scene.rotor.radius * scene.rotor.spin;
    let last = (start - beta * surface) / (1.0 + beta);
    let until = clearance / scene.retainer.friction * (1.0 / start - 1.0 / last);
    ClosedForm {
        name,
        scene,
        steps,
        error: Box::new(move |h| {
            let [u, v] = h.end.velocity;
            let time = first(&h.rolling_starts, |t| t / until - 1.0);
            time.max((u.hypot(v) / last - 1.0).abs())
        }),
        limits: EVENT,
        unit: "relative",
    }
}

/// A fall through 1 um with all its bounces: sqrt(2) T (1 + eps)/(1 - eps) is less than a step.
fn series_in_one_step(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    scene.retainer.clearance = 1e-6;
    scene.retainer.restitution = 0.2;
    scene.retainer.friction = 0.0;
    scene.run.duration = 1e-3;
    scene.start = free([0.0; 2], [0.0; 2]);
    let units = Units::of(&scene);
    ClosedForm {
        name: "fall and whole bounce series in one step: time of permanent contact",
        scene,
        steps: &[1e-3],
        error: Box::new(move |h| {
            first(&h.contact_starts, |t| t / units.time - 1.5 * 2.0_f64.sqrt())
        }),
        limits: EVENT,
        unit: "T",
    }
}

/// Thrown up from the bottom: hops of 2 v/g, each shorter by eps, all of them in a step.
fn hundreds_of_impacts_in_one_step(rig: &Scene) -> ClosedForm {
    let mut scene = rig.clone();
    let speed = 2e-4;
    scene.retainer.clearance = 10e-6;
    scene.retainer.restitution = 0.95;
    scene.retainer.friction = 0.0;
    scene.run.duration = 1e-3;
    scene.start = free([0.0, -scene.retainer.clearance], [0.0, speed]);
    let units = Units::of(&scene);
    let until = 2.0 * speed / (scene.run.gravity * (1.0 - scene.retainer.restitution));
    ClosedForm {
        name: "hundreds of impacts in one step: time of permanent contact",
        scene,
        steps: &[1e-3],
        error: Box::new(move |h| first(&h.contact_starts, |t| (t - until) / units.time)),
        limits: EVENT,
        unit: "T",
    }
}

/// Name and size of the numbers.
type Denormal = (&'static str, f64);
const DENORMAL: Denormal = (
    "denormals of f64 for spin, friction, restitution and start: first impact",
    f64::MIN_POSITIVE / 1024.0,
);
const SINGLE_DENORMAL: Denormal = (
    "denormals of f32 for spin, friction, restitution and start: first impact",
    1e-42,
);

/// Numbers too small to keep their digits are as good as 0.
fn denormals(rig: &Scene, (name, least): Denormal) -> ClosedForm {
    let mut scene = rig.clone();
    scene.rotor.spin = least;
    scene.retainer.friction = least;
    scene.retainer.restitution = least;
    scene.start = free([least, -least], [-least, least]);
    ClosedForm::of_first_impact(name, scene, 2.0_f64.sqrt(), EVENT)
}

/// Size of an error of the first of `all`; without one there is no telling.
fn first<T>(all: &[T], error: impl Fn(&T) -> f64) -> f64 {
    all.first()
        .map_or(f64::INFINITY, |first| error(first).abs())
}
