//! A model watched step by step: what must hold whatever the scene.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Kinematics, Precision, Stepper};

use touchdown_run::model::{Subject, Use};
use touchdown_scene::{Fidelity, Scene};

/// Of a place, in units of the last digit.
pub const ROUNDED: f64 = 16.0;

/// What was seen, worst of all steps of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watched {
    /// Farthest beyond the wall, rho0.
    pub outside: f64,
    /// The same in parts of half a step's path, half of h (v + h) at the speed v after the step.
    pub outside_path: f64,
    /// Largest rise of translation, spin and height above the lowest so far, in m g rho0.
    pub energy_gain: f64,
    /// Rounding of the spin as it is shown, in the same unit; 0 where it did not change.
    pub spin_rounding: f64,
    /// Steps after which a number was NaN or infinite.
    pub not_finite: u32,
    /// Most changes of motion in a step.
    pub changes: u32,
    /// What rounding of the largest translation may add up to, in m g rho0: once for each change of motion,
    /// and in a model that integrates for each step.
    pub path_rounding: f64,
}

/// Most of a number over several runs, 0 at least.
pub fn most(runs: &[Watched], of: fn(&Watched) -> f64) -> f64 {
    runs.iter().map(of).fold(0.0, f64::max)
}

/// Watches the scene's model over the scene's duration.
pub struct Watch<'a>(pub &'a Scene);

impl Use for Watch<'_> {
    type Output = Watched;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Watched, ConfigError> {
        let (model, scales) = (&subject.model, &subject.scales);
        let step = self.0.model.step / scales.time;
        let rounded_in_a_step = u64::from(self.0.model.rung != Fidelity::Rigid);
        let mut watched = Watched::default();
        let mut state = model.start(&subject.start, subject.spin, |_| watched.changes += 1)?;
        let first = model.kinematics(&state).spin;
        let mut lowest = energy(self.0, &model.kinematics(&state), first);
        let (mut fastest, mut in_all) = (0.0_f64, 1_u64);
        for _ in 0..(self.0.run.duration / self.0.model.step).ceil() as u64 {
            let mut in_step = 0;
            let mut finite = true;
            model.step(&mut state, |happening| {
                in_step += 1;
                finite &= is_finite(&happening.after);
                if let Change::Impact { speed, .. } = happening.change {
                    finite &= speed.is_finite();
                }
            });
            let now = model.kinematics(&state);
            let [x, y] = now.position.map(R::to_f64);
            let [u, v] = now.velocity.map(R::to_f64);
            let speed = u.hypot(v);
            let energy = energy(self.0, &now, first);
            let outside = x.hypot(y) - 1.0;
            watched.outside = watched.outside.max(outside);
            let path = 0.5 * step * (speed + step) + ROUNDED * R::EPSILON.to_f64();
            watched.outside_path = watched.outside_path.max(outside / path);
            watched.energy_gain = watched.energy_gain.max(energy - lowest);
            watched.not_finite += u32::from(!(finite && is_finite(&now)));
            watched.changes = watched.changes.max(in_step);
            fastest = fastest.max(speed);
            in_all += u64::from(in_step) + rounded_in_a_step;
            lowest = lowest.min(energy);
            if now.spin != first {
                let largest = first.to_f64().abs().max(now.spin.to_f64().abs());
                watched.spin_rounding = inertia(self.0) * largest * largest * R::EPSILON.to_f64();
            }
        }
        // Without bias it adds up as a random walk does: four deviations.
        let walk = 4.0 * (in_all as f64).sqrt();
        watched.path_rounding = 0.5 * fastest * fastest * walk * R::EPSILON.to_f64();
        Ok(watched)
    }
}

/// J/(m r^2).
pub fn inertia(scene: &Scene) -> f64 {
    let rotor = &scene.rotor;
    rotor.polar_inertia / (rotor.mass * rotor.radius * rotor.radius)
}

/// Translation, height and what the spin has over its first value, in m g rho0: small differences of
/// large spins are exact.
pub fn energy<R: Precision>(scene: &Scene, k: &Kinematics<R>, first: R) -> f64 {
    let [u, v] = k.velocity.map(R::to_f64);
    let [spin, first] = [k.spin, first].map(R::to_f64);
    let height = if scene.run.gravity > 0.0 {
        k.position[1].to_f64()
    } else {
        0.0
    };
    0.5 * (u * u + v * v) + 0.5 * inertia(scene) * (spin - first) * (spin + first) + height
}

/// Whether every number is.
pub fn is_finite<R: Precision>(k: &Kinematics<R>) -> bool {
    let mut all = k.position.iter().chain(&k.velocity).chain([&k.spin]);
    all.all(|x| x.is_finite())
}
