//! Each extreme scene on rung `hertz`, in both schemes: steps that it refuses, and what holds at those
//! that it takes. It is watched step by step: the energy that it has, and how deep it is in the wall.

use touchdown_models::{Compliance, Shape};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Kinematics, Precision as Number, Stepper, Touch};

use crate::limits::extreme::{Extreme, STEPS, at_step};
use crate::limits::row::{Row, Worst};
use crate::limits::watch::{ROUNDED, energy, inertia, is_finite};
use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::scales::{compliance, fastest_impact};
use touchdown_scene::{Contact, Fidelity, Precision, Scene, Scheme};

/// Part of 2/omega_c that is still taken, and the part that no longer is.
const TAKEN: f64 = 0.999;
const REFUSED: f64 = 1.001;
/// Part of the largest translation that a run may gain: the 0.5 % to which restitution is kept at
/// T_c/25, twice as much in energy (`docs/know/model.md`).
const ENERGY: f64 = 0.01;

/// Of the fastest impact that stiffness and longest step are made for: beyond it neither was chosen for what comes. At
/// twice the speed the rate of a contact is 15 % higher.
const EXPECTED: f64 = 2.0;

/// All measures of one extreme in one precision.
pub fn rows(extreme: &Extreme, precision: Precision) -> Result<Vec<Row>, ConfigError> {
    let stiff = compliance(&compliant(extreme, precision, 1e-6))?;
    let (limit, accurate) = (stiff.longest_step(), stiff.accurate_step());
    let (mut taken, mut refused): (Vec<f64>, Vec<f64>) =
        extreme.steps.iter().partition(|step| **step <= limit);
    if extreme.steps == STEPS {
        taken.extend([accurate, TAKEN * limit]);
    }
    refused.push(REFUSED * limit);

    let (mut energy, mut accepted) = (Worst::default(), 0_u32);
    let (mut drawn, mut deepest, mut not_finite) = (0.0, 0.0_f64, 0);
    for &scheme in Fidelity::Hertz.schemes() {
        let watched = |step| {
            let mut scene = compliant(extreme, precision, step);
            scene.model.scheme = scheme;
            let (scene, stiff) = (&scene, &stiff);
            with_model(scene, Press { scene, stiff })
        };
        for &step in &taken {
            let seen = watched(step)?;
            if step <= accurate {
                let rounding = super::rounding(precision) + seen.rounding;
                let late = match scheme {
                    Scheme::Euler => seen.half_steps,
                    _ => 0.0,
                };
                let limit = ENERGY * seen.translation + late + rounding;
                energy.take(seen.energy_gain, limit);
                drawn = f64::max(drawn, seen.drawn);
            }
            deepest = deepest.max(seen.depth);
            not_finite = not_finite.max(seen.not_finite);
        }
        for &step in &refused {
            accepted += u32::from(watched(step).is_ok());
        }
    }
    let row = |measure: &str| Row::of(format!("hertz: {}: {measure}", extreme.name), precision);
    let mut rows = vec![row("steps above 2/omega_c").at_most(accepted.into(), 0.0, "accepted")];
    if !taken.is_empty() {
        rows.extend([
            row("energy gained at T_c/25 and below").worst(energy, "m g rho0"),
            row("translation at any speed, T_c/25 and below").at_most(
                drawn,
                1.0 + ENERGY,
                "of all energy at the start",
            ),
            row("deepest compression").at_most(deepest, 1.0, "of what the speed allows"),
            row("steps with NaN or infinity").at_most(f64::from(not_finite), 0.0, "steps"),
        ]);
    }
    Ok(rows)
}

fn compliant(extreme: &Extreme, precision: Precision, step: f64) -> Scene {
    let mut scene = at_step(&extreme.scene, precision, step);
    scene.model.rung = Fidelity::Hertz;
    scene
}

/// What was seen, worst of all steps. Depth and energy count as long as the rotor is as slow as
/// expected.
#[derive(Clone, Copy, Debug, Default)]
struct Pressed {
    /// Energy stored in the wall, over what motion and pressing force could put there.
    depth: f64,
    /// Largest rise of the energy above the lowest so far, in m g rho0. It counts in the gap and in
    /// permanent contact; in a bounce the schemes' energy swings with the force.
    energy_gain: f64,
    /// Largest energy of translation, in m g rho0.
    translation: f64,
    /// What the work of gravity in half a step, at entry and at release of each impact, amounts to, in
    /// m g rho0: semi-implicit Euler has the place a half step before the speed, the flight does not.
    half_steps: f64,
    /// Largest energy of translation at any speed, over all that the rotor had at its start.
    drawn: f64,
    /// What rounding may add to the energy, in m g rho0.
    rounding: f64,
    /// Steps after which a number was NaN or infinite.
    not_finite: u32,
}

/// Watches the scene's model, of this stiffness, over the scene's duration.
struct Press<'a> {
    /// The scene.
    scene: &'a Scene,
    /// Of its contact.
    stiff: &'a Compliance,
}

impl Use for Press<'_> {
    type Output = Pressed;

    fn with<R: Number, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Pressed, ConfigError> {
        let (scene, model, scales) = (self.scene, &subject.model, &subject.scales);
        let n = match scene.materials.contact {
            Contact::Point => 1.5,
            Contact::Line { .. } | Contact::LinePower { .. } => 1.0,
        };
        let by_logarithm = matches!(scene.materials.contact, Contact::Line { .. });
        let weight = scene.rotor.mass * scales.speed * scales.speed;
        let stiffness = self.stiff.stiffness * scales.length.powf(n + 1.0) / weight;
        let stored = |depth: f64| {
            if by_logarithm {
                let power = Shape::Line.power(depth, 1.0);
                return 0.5 * stiffness * power * (depth.max(0.0) - 0.5 * power);
            }
            stiffness * depth.max(0.0).powf(n + 1.0) / (n + 1.0)
        };
        let gravity = if scene.run.gravity > 0.0 { 1.0 } else { 0.0 };
        let step = scene.model.step / scales.time;
        let epsilon = R::EPSILON.to_f64();

        let mut seen = Pressed::default();
        let mut state = model.start(&subject.start, subject.spin, |_| {})?;
        let begun = model.kinematics(&state);
        let first = begun.spin;
        let (beta, spun) = (inertia(scene), first.to_f64());
        let depth = |k: &Kinematics<R>| k.position[0].to_f64().hypot(k.position[1].to_f64()) - 1.0;
        let speed = |k: &Kinematics<R>| k.velocity[0].to_f64().hypot(k.velocity[1].to_f64());
        let whole = |k: &Kinematics<R>| energy(scene, k, first) + stored(depth(k));
        // Height counts from the bottom.
        let all = whole(&begun) + 0.5 * beta * spun * spun + gravity;
        let expected = EXPECTED * fastest_impact(scene) / scales.speed;
        let (mut fastest, mut slow_fastest) = (speed(&begun), speed(&begun));
        let (mut lowest, mut largest, mut impacts) = (f64::INFINITY, 0.0_f64, 0_u32);
        let steps = (scene.run.duration / scene.model.step).ceil();
        for _ in 0..steps as u64 {
            let mut hits = 0;
            model.step(&mut state, |h| {
                hits += u32::from(matches!(h.change, Change::Impact { .. }))
            });
            let now = model.kinematics(&state);
            seen.not_finite += u32::from(!is_finite(&now));
            if now.spin != first {
                largest = largest.max(now.spin.to_f64().abs()).max(spun.abs());
            }
            fastest = fastest.max(speed(&now));
            if fastest > expected {
                continue;
            }
            // The wall answers from the step on that begins in it.
            let pushed = depth(&now) - step * (slow_fastest + step) - ROUNDED * epsilon;
            if pushed > 0.0 {
                let square = slow_fastest * slow_fastest;
                let most = 0.5 * square + (square + gravity) * pushed;
                seen.depth = seen.depth.max(stored(pushed) / most);
            }
            if depth(&now) <= 0.0 || now.touch != Touch::None {
                let energy = whole(&now);
                lowest = lowest.min(energy);
                seen.energy_gain = seen.energy_gain.max(energy - lowest);
            }
            slow_fastest = fastest;
            impacts += hits;
        }
        let fall = gravity * step * slow_fastest;
        seen.half_steps = fall * f64::from(impacts);
        seen.translation = 0.5 * slow_fastest * slow_fastest;
        // Without bias it adds up as a random walk does: four deviations.
        let walk = 4.0 * steps.sqrt();
        seen.rounding = epsilon * (beta * largest * largest + walk * seen.translation);
        seen.drawn = 0.5 * fastest * fastest / all;
        Ok(seen)
    }
}
