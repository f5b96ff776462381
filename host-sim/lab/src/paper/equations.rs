//! The equations, put to numbers on one flight and one impact of the rig.

use super::rig::{self, from_centre, run};
use super::row::Row;
use touchdown_base::failure::Failure;
use touchdown_base::history::RotorState;
use touchdown_scene::Scene;
use touchdown_truth::reference::Reference;

/// A moment between the first and the second impact, s.
const MOMENT: f64 = 12e-3;
/// Spacing of the positions whose second differences are taken, s.
const SPACING: f64 = 20e-6;
/// A spin so slow that the first impact ends the slip, rad/s: 4 rpm.
const SLOW: f64 = -0.418_879_020_478_639_1;

pub fn rows(base: &Scene) -> Result<Vec<Row>, Failure> {
    let mut rows = flight(base)?;
    rows.extend(friction(base)?);
    rows.push(restitution(base)?);
    Ok(rows)
}

/// (1) and (2): the polar accelerations from the reference's state, against second differences of the
/// model's positions.
fn flight(base: &Scene) -> Result<Vec<Row>, Failure> {
    let scene = from_centre(base, MOMENT);
    let mut reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
    let state = reference.advance(MOMENT, &mut |_| {});
    let mut samples = [[0.0; 2]; 5];
    for (sample, offset) in samples.iter_mut().zip([-2.0, -1.0, 0.0, 1.0, 2.0]) {
        let end = run(&from_centre(base, MOMENT + offset * SPACING))?.end;
        *sample = polar(&end);
    }
    let g = base.run.gravity;
    let ([x, y], [vx, vy]) = (state.position, state.velocity);
    let [radius, angle] = polar(&state);
    let (sin, cos) = angle.sin_cos();
    let (radial, turning) = ((x * vx + y * vy) / radius, rig::rate(&state));
    Ok(vec![
        Row::new("eq. (1), rho'' in flight, 12 ms", "m/s^2", radius * turning * turning - g * sin)
            .printed(-2.0 * radial * turning - g * sin)
            .ours(second_difference(samples.map(|[radius, _]| radius)), 1e-6)
            .note("Coriolis and centrifugal term exchanged in print; ours: second differences of the model's path"),
        Row::new(
            "eq. (2), theta'' in flight, 12 ms",
            "rad/s^2",
            -(2.0 * radial * turning + g * cos) / radius,
        )
        .printed(radius * turning * turning + g * cos)
        .ours(second_difference(samples.map(|[_, angle]| angle)), 1e-2)
        .note("the printed right side is in m/s^2, not rad/s^2"),
    ])
}

/// (5) and (7) at the first impact, with the printed equation at the right speed.
fn friction(base: &Scene) -> Result<Vec<Row>, Failure> {
    let printed = jump_without_cap(base);
    let jump = |spin: f64| -> Result<f64, Failure> {
        let mut scene = from_centre(base, 10e-3);
        scene.rotor.spin = spin;
        rig::first_jump(&scene)
    };
    let beta = base.rotor.polar_inertia / (base.rotor.mass * base.rotor.radius.powi(2));
    let sticking = -base.rotor.radius * SLOW * beta / (1.0 + beta) / base.retainer.clearance;
    Ok(vec![
        Row::new("eq. (5), first jump, spin reversed", "rad/s", -printed)
            .printed(printed)
            .ours(jump(-base.rotor.spin)?, 1e-9)
            .note("friction acts against the slip, not always towards +theta"),
        Row::new("eq. (7), first jump at 4 rpm", "rad/s", sticking)
            .printed(printed)
            .ours(jump(SLOW)?, 1e-9)
            .note("friction stops once it has ended the slip: -s beta/((1 + beta) rho0)"),
    ])
}

/// kappa times the speed of a fall through the gap, rad/s.
pub fn jump_without_cap(base: &Scene) -> f64 {
    kappa(base) * rig::fall_speed(base)
}

/// mu (1 + eps)/rho0, 1/m.
pub fn kappa(base: &Scene) -> f64 {
    base.retainer.friction * (1.0 + base.retainer.restitution) / base.retainer.clearance
}

/// The text allows any eps from 0; above 1 an impact would create energy.
fn restitution(base: &Scene) -> Result<Row, Failure> {
    let largest = rig::change(0.0, 4.0, |restitution| {
        let mut scene = from_centre(base, 1e-3);
        scene.retainer.restitution = restitution;
        Ok(run(&scene).is_err())
    })?;
    Ok(Row::new("text, largest restitution", "", 1.0)
        .ours(largest, 1e-9)
        .note("printed: 0 and above; right: an impact keeps eps^2 of its energy; ours: largest accepted"))
}

/// Radius (m) and angle from x (rad).
fn polar(state: &RotorState) -> [f64; 2] {
    let [x, y] = state.position;
    [f64::hypot(x, y), y.atan2(x)]
}

/// At the middle of five values, [`SPACING`] apart; error of fourth order.
fn second_difference([a, b, c, d, e]: [f64; 5]) -> f64 {
    (16.0 * (b + d) - (a + e) - 30.0 * c) / (12.0 * SPACING * SPACING)
}
