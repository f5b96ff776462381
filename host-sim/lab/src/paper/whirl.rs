//! Whirl: what speed it takes, how it grows, where it ends.

use std::f64::consts::{PI, TAU};

use super::ending::{Ending, of_model, of_reference};
use super::equations::jump_without_cap;
use super::rig::{WIDE_GAP, change, first_jump, from_centre, on_wall, pendulum_square, rate, run};
use super::row::Row;
use touchdown_base::failure::Failure;
use touchdown_base::regions::Plane;
use touchdown_scene::Scene;

/// Whirl speed read off the paper's Fig. 3, rad/s.
pub const PRINTED: f64 = 350.0;
/// Time for a turn from the bottom, at any speed of interest, s.
const A_TURN: f64 = 0.1;
/// Tolerance of a threshold, rad/s.
const CLOSE: f64 = 1e-6;

pub fn rows(base: &Scene) -> Result<Vec<Row>, Failure> {
    let mut rows = thresholds(base)?;
    rows.push(gap(base)?);
    rows.extend(fig_3(base)?);
    rows.extend(growth(base)?);
    rows.push(spin_down(base)?);
    Ok(rows)
}

fn thresholds(base: &Scene) -> Result<Vec<Row>, Failure> {
    let mut smooth = base.clone();
    smooth.retainer.friction = 0.0;
    let by_reference = after_lift_off(base, |scene| Ok(of_reference(scene)))?;
    let by_model = after_lift_off(base, of_model)?;
    let friction = change(0.0, 0.5, |mu| Ok(contact_kept(base, mu) <= PRINTED))?;
    let friction_of_model = change(0.0, 0.5, |mu| {
        let mut scene = base.clone();
        scene.retainer.friction = mu;
        keeps_contact(&scene, PRINTED)
    })?;
    Ok(vec![
        Row::new("whirl speed, contact kept", "rad/s", contact_kept(base, base.retainer.friction))
            .printed(PRINTED)
            .ours(least_whirl(base)?, CLOSE)
            .note("theta' at the bottom; sqrt(g/rho0 (3 (1 + e^(-2 pi mu))/(1 + 4 mu^2) - 1)); ours: bisection on runs"),
        Row::new("whirl speed, after one lift-off", "rad/s", by_reference)
            .printed(PRINTED)
            .ours(by_model, CLOSE)
            .note("every speed above it whirls within 0.5 s, single ones below it too; right: reference"),
        Row::new("whirl speed without friction", "rad/s", (5.0 * pendulum_square(base)).sqrt())
            .ours(least_whirl(&smooth)?, CLOSE)
            .note("sqrt(5 g/rho0)"),
        Row::new("friction whose whirl speed is 350 rad/s", "", friction)
            .ours(friction_of_model, 1e-9)
            .note("the closed form solved for mu; ours: bisection on runs from 350 rad/s"),
    ])
}

/// The least theta' at the bottom from which on all speeds up to that of kept contact end in whirl, rad/s:
/// down in small steps to the first that does not, then bisection.
fn after_lift_off(
    base: &Scene,
    ending: impl Fn(&Scene) -> Result<Ending, Failure>,
) -> Result<f64, Failure> {
    const LONG_ENOUGH: f64 = 0.5;
    const SPACING: f64 = 0.1;
    let whirls = |rate| Ok(ending(&on_wall(base, 0.0, rate, LONG_ENOUGH))? == Ending::Whirl);
    let mut rate = contact_kept(base, base.retainer.friction);
    while whirls(rate - SPACING)? {
        rate -= SPACING;
    }
    change(rate - SPACING, rate, whirls)
}

/// Jump and whirl speed shrink alike with the gap.
fn gap(base: &Scene) -> Result<Row, Failure> {
    let share = |clearance: f64| -> Result<f64, Failure> {
        let mut scene = base.clone();
        scene.retainer.clearance = clearance;
        Ok(first_jump(&from_centre(&scene, 0.02))? / least_whirl(&scene)?)
    };
    let of_speed = jump_without_cap(base) / contact_kept(base, base.retainer.friction);
    Ok(Row::new("first jump/whirl speed, 0.75 by 0.3 mm", "", 1.0)
        .ours(share(WIDE_GAP)? / share(base.retainer.clearance)?, 1e-8)
        .note(&format!(
            "both go with 1/sqrt(rho0), so the share, {of_speed:.4}, has no gap in it"
        )))
}

/// Points of the regions' boundaries.
fn fig_3(base: &Scene) -> Result<Vec<Row>, Failure> {
    const BETWEEN: f64 = 320.0;
    let plane = Plane::new(pendulum_square(base), base.retainer.friction);
    let edge = plane.widest_swing().rate(0.0);
    let widest = change(100.0, 300.0, |rate| Ok(!keeps_contact(base, rate)?))?;
    let lost = plane.orbit(0.0, BETWEEN * BETWEEN).held_until(0.5 * PI, PI);
    let lift_offs = run(&on_wall(base, 0.0, BETWEEN, A_TURN))?.lift_offs;
    let lift_off = lift_offs.first().copied().unwrap_or(f64::NAN);
    let [x, y] = run(&on_wall(base, 0.0, BETWEEN, lift_off))?.end.position;
    Ok(vec![
        Row::new("Fig. 3, edge of B at the bottom", "rad/s", edge)
            .ours(widest, CLOSE)
            .note(
                "widest swing that keeps contact: it stops at 90 degrees; ours: bisection on runs",
            ),
        Row::new("Fig. 3, lift-off from 320 rad/s", "deg", lost.to_degrees())
            .ours(x.atan2(-y).to_degrees(), 1e-6)
            .note("from the bottom, where theta'^2 + g/rho0 cos phi falls through 0"),
    ])
}

/// Without gravity: theta' grows as 1/(1/theta'_0 - mu t), until the slip ends.
fn growth(base: &Scene) -> Result<Vec<Row>, Failure> {
    let mut scene = base.clone();
    scene.run.gravity = 0.0;
    let (mu, clearance) = (scene.retainer.friction, scene.retainer.clearance);
    let time = 1.0 / (mu * PRINTED);
    let part = 0.7 * time;
    let grown = rate(&run(&on_wall(&scene, 0.0, PRINTED, part))?.end);
    let beta = scene.rotor.polar_inertia / (scene.rotor.mass * scene.rotor.radius.powi(2));
    let surface = scene.rotor.radius * scene.rotor.spin;
    let last = (PRINTED * clearance - beta * surface) / (1.0 + beta);
    let [vx, vy] = run(&on_wall(&scene, 0.0, PRINTED, time))?.end.velocity;
    let speed = f64::hypot(vx, vy);
    let frequency = |speed: f64| speed / (TAU * clearance);
    let load = |speed: f64| scene.rotor.mass * speed * speed / clearance;
    Ok(vec![
        Row::new("growth time from 350 rad/s, weightless", "s", time)
            .ours(part / (1.0 - PRINTED / grown), 1e-12)
            .note("1/(mu theta'_0); ours: from the speed after 0.7 of it"),
        Row::new("whirl ends at, weightless", "m/s", last)
            .ours(speed, 1e-9)
            .note("rolling: (v0 - beta r omega)/(1 + beta); a rigid retainer knows no other end"),
        Row::new("its frequency", "Hz", frequency(last))
            .ours(frequency(speed), 1e-5)
            .note("v/(2 pi rho0)"),
        Row::new("its load", "N", load(last))
            .ours(load(speed), 1e-2)
            .note("m v^2/rho0"),
    ])
}

/// The swing lasts as long as the spin: here the rotor lies where friction holds it.
fn spin_down(base: &Scene) -> Result<Row, Failure> {
    let mu = base.retainer.friction;
    let beta = base.rotor.polar_inertia / (base.rotor.mass * base.rotor.radius.powi(2));
    let surface = (base.rotor.radius * base.rotor.spin).abs();
    let right = beta * surface / (mu * base.run.gravity * mu.atan().cos());
    let history = run(&on_wall(base, mu.atan(), 0.0, 1.05 * right))?;
    let ours = history.rolling_starts.first().copied();
    Ok(Row::new("spin used up, lying on the bearing", "s", right)
        .ours(ours.unwrap_or(f64::NAN), 1e-6)
        .note("beta r |omega|/(mu g cos(atan mu)): until then friction feeds the swing"))
}

/// The closed form, rad/s.
pub fn contact_kept(base: &Scene, mu: f64) -> f64 {
    let decay = (-2.0 * PI * mu).exp();
    let square = 3.0 * (1.0 + decay) / (1.0 + 4.0 * mu * mu) - 1.0;
    (pendulum_square(base) * square).sqrt()
}

/// The least theta' at the bottom that carries the model over the top in contact, rad/s.
pub fn least_whirl(base: &Scene) -> Result<f64, Failure> {
    let most = 3.0 * pendulum_square(base).sqrt();
    change(0.6 * most, most, |rate| keeps_contact(base, rate))
}

/// Whether the model keeps contact from the bottom.
fn keeps_contact(base: &Scene, rate: f64) -> Result<bool, Failure> {
    let time = 6.0 / pendulum_square(base).sqrt();
    Ok(run(&on_wall(base, 0.0, rate, time))?.lift_offs.is_empty())
}
