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
    pub name: String,
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
    /// Of a scene that has the error of a time or a speed at every step.
    fn new(
        name: &str,
        scene: Scene,
        error: impl Fn(&History) -> f64 + 'static,
        unit: &'static str,
    ) -> Self {
        Self {
            name: name.to_owned(),
            scene,
            steps: &STEPS,
            error: Box::new(error),
            limits: EVENT,
            unit,
        }
    }

    /// Of a scene whose first impact comes after `time`, T, whatever the step.
    fn of_first_impact(name: &str, scene: Scene, time: f64) -> Self {
        let unit = Units::of(&scene).time;
        let error = move |h: &History| first(&h.impacts, |i| i.state.time / unit - time);
        Self::new(name, scene, error, "T")
    }
}

/// Errors of times and speeds, f64 and f32: what is asked of the time of permanent contact.
const EVENT: [f64; 2] = [1e-11, 1e-5];

pub fn closed_forms() -> Result<Vec<ClosedForm>, InputError> {
    let rig = || Scene::load("rig");
    Ok(vec![
        fall_from_the_top(rig()?),
        force_ends_where_it_starts(rig()?),
        graze(rig()?),
        rolling_at_the_limit(rig()?),
        impact_at_the_limit(rig()?),
        whirl_at_high_rate(rig()?),
        growth_in_one_step(rig()?),
        series_in_one_step(rig()?),
        hundreds_of_impacts_in_one_step(rig()?),
        denormals("f64", f64::MIN_POSITIVE / 1024.0, rig()?),
        denormals("f32", 1e-42, rig()?),
    ])
}

/// On the wall at the top, at rest: the wall can only push, so it falls at once, through 2 rho0.
fn fall_from_the_top(mut scene: Scene) -> ClosedForm {
    scene.start = wall(std::f64::consts::PI, 0.0);
    let name = "no normal speed where gravity pulls off the wall: first impact";
    ClosedForm::of_first_impact(name, scene, 2.0)
}

/// v^2 = -g rho0 cos phi: the wall force is zero at the start and falls. The flight lasts 4 v_y/g.
fn force_ends_where_it_starts(mut scene: Scene) -> ClosedForm {
    let units = Units::of(&scene);
    let angle = 2.0_f64;
    let speed = (-angle.cos()).sqrt();
    scene.start = wall(angle, speed * units.speed);
    let flight = 4.0 * speed * angle.sin();
    let name = "no wall force at the start, and less to come: first impact";
    ClosedForm {
        // Rounding of the force decides which flight it is: the root of it is lost.
        limits: [1e-7, 1e-3],
        ..ClosedForm::of_first_impact(name, scene, flight)
    }
}

/// A parabola that touches the wall from inside at the top right and bends away: no impact there. From
/// there on |p|^2 - 1 = (v^2 + p.g) t^2 + v.g t^3 + t^4/4 in the model's units, 0 at the first impact.
fn graze(mut scene: Scene) -> ClosedForm {
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
    ClosedForm {
        // The root of what rounding takes off.
        limits: [1e-6, 1e-5],
        ..ClosedForm::of_first_impact(name, scene, landing)
    }
}

/// Released where rolling needs just the friction there is: it rolls, and keeps its energy.
fn rolling_at_the_limit(mut scene: Scene) -> ClosedForm {
    let angle = 0.6_f64;
    let beta = inertia(&scene);
    scene.rotor.spin = 0.0;
    scene.retainer.friction = angle.tan() * beta / (1.0 + beta);
    scene.start = wall(angle, 0.0);
    let machine = scene.machine();
    let unit = machine.mass * machine.gravity * machine.clearance;
    let height = -machine.clearance * angle.cos() * machine.mass * machine.gravity;
    let name = "rolling that needs all the friction there is: energy lost or gained";
    let error = move |h: &History| ((energy(&machine, &h.end) - height) / unit).abs();
    ClosedForm {
        limits: [1e-12, 1e-4],
        ..ClosedForm::new(name, scene, error, "m g rho0")
    }
}

/// A straight fall whose first impact has just the impulse to stop the slip.
fn impact_at_the_limit(mut scene: Scene) -> ClosedForm {
    let unit = Units::of(&scene).speed;
    let retainer = scene.retainer;
    let beta = inertia(&scene);
    let impulse = (1.0 + retainer.restitution) * 2.0_f64.sqrt();
    let slip = retainer.friction * impulse * (1.0 + beta) / beta;
    let radius = scene.rotor.radius;
    scene.rotor.spin = -slip * unit / radius;
    scene.start = free([0.0; 2], [0.0; 2]);
    let name = "impact with just the friction that stops the slip: slip after it";
    let error = move |h: &History| {
        first(&h.impacts, |i| {
            (i.state.velocity[0] + radius * i.state.spin) / unit
        })
    };
    ClosedForm {
        limits: [1e-14, 1e-6],
        ..ClosedForm::new(name, scene, error, "V")
    }
}

/// 13 kHz at the end: 0.8 rad in 10 us.
fn whirl_at_high_rate(scene: Scene) -> ClosedForm {
    let name = "whirl to rolling at 0.8 rad a step: moment and speed of rolling";
    ClosedForm {
        steps: &[1e-5],
        ..whirl(name, scene, 350.0, 0.03)
    }
}

/// h mu v = 2 at the start: in plain arithmetic the speed passes infinity inside the step.
fn growth_in_one_step(scene: Scene) -> ClosedForm {
    let name = "growth to infinity inside one step (h mu v of 2): moment and speed of rolling";
    ClosedForm {
        steps: &[1e-3],
        ..whirl(name, scene, 20_000.0, 0.002)
    }
}

/// Weightless whirl from `turning`, rad/s: v' = mu v^2 until it rolls at (v - beta W)/(1 + beta).
fn whirl(name: &str, mut scene: Scene, turning: f64, duration: f64) -> ClosedForm {
    let beta = inertia(&scene);
    let clearance = scene.retainer.clearance;
    let start = turning * clearance;
    scene.run.gravity = 0.0;
    scene.run.duration = duration;
    scene.start = wall(0.0, start);
    let surface = scene.rotor.radius * scene.rotor.spin;
    let last = (start - beta * surface) / (1.0 + beta);
    let until = clearance / scene.retainer.friction * (1.0 / start - 1.0 / last);
    let error = move |h: &History| {
        let [u, v] = h.end.velocity;
        let time = first(&h.rolling_starts, |t| t / until - 1.0);
        time.max((u.hypot(v) / last - 1.0).abs())
    };
    ClosedForm::new(name, scene, error, "relative")
}

/// A fall through 1 um with all its bounces: sqrt(2) T (1 + eps)/(1 - eps) is less than a step.
fn series_in_one_step(mut scene: Scene) -> ClosedForm {
    scene.retainer.clearance = 1e-6;
    scene.retainer.restitution = 0.2;
    scene.retainer.friction = 0.0;
    scene.run.duration = 1e-3;
    scene.start = free([0.0; 2], [0.0; 2]);
    let unit = Units::of(&scene).time;
    let until = 1.5 * 2.0_f64.sqrt();
    let name = "fall and whole bounce series in one step: time of permanent contact";
    let error = move |h: &History| first(&h.contact_starts, |t| t / unit - until);
    ClosedForm {
        steps: &[1e-3],
        ..ClosedForm::new(name, scene, error, "T")
    }
}

/// Thrown up from the bottom: hops of 2 v/g, each shorter by eps, all of them in a step.
fn hundreds_of_impacts_in_one_step(mut scene: Scene) -> ClosedForm {
    let speed = 2e-4;
    scene.retainer.clearance = 10e-6;
    scene.retainer.restitution = 0.95;
    scene.retainer.friction = 0.0;
    scene.run.duration = 1e-3;
    scene.start = free([0.0, -scene.retainer.clearance], [0.0, speed]);
    let unit = Units::of(&scene).time;
    let until = 2.0 * speed / (scene.run.gravity * (1.0 - scene.retainer.restitution));
    let name = "hundreds of impacts in one step: time of permanent contact";
    let error = move |h: &History| first(&h.contact_starts, |t| (t - until) / unit);
    ClosedForm {
        steps: &[1e-3],
        ..ClosedForm::new(name, scene, error, "T")
    }
}

/// Numbers of this size, too small to keep their digits in the format, are as good as 0.
fn denormals(format: &str, least: f64, mut scene: Scene) -> ClosedForm {
    scene.rotor.spin = least;
    scene.retainer.friction = least;
    scene.retainer.restitution = least;
    scene.start = free([least, -least], [-least, least]);
    let name =
        format!("denormals of {format} for spin, friction, restitution and start: first impact");
    ClosedForm::of_first_impact(&name, scene, 2.0_f64.sqrt())
}

/// Size of an error of the first of `all`; without one there is no telling.
fn first<T>(all: &[T], error: impl Fn(&T) -> f64) -> f64 {
    all.first()
        .map_or(f64::INFINITY, |first| error(first).abs())
}
