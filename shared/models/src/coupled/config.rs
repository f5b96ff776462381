//! The machine, SI.

use core::cmp::Ordering;

use super::compliant::{Compliant, CompliantConfig};
use super::magnets::Magnet;
use super::mount::{MountConfig, Sprung};
use super::race::{BallBearing, RaceConfig};
use super::vector::Vector;
use super::{Base, Coupled, Ring, Units, product};
use touchdown_rotor::RigidConfig;
use touchdown_rotor::clock::Instant;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{Scales, not_negative, positive};

/// Most rings.
const MOST_RINGS: usize = 4;
/// Most magnetic bearings: two planes of them, as they are left and as they come back.
pub(super) const MAGNETS: usize = 4;
/// Most bending modes.
pub(super) const MODES: usize = 3;
/// (h/2)^2 times the stiffness that pulls away, over mass; at 1 the step has no solution.
const STIFFEST: f64 = 0.25;

/// Static and couple unbalance; angles on the rotor, from its x axis at spin angle 0, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnbalanceConfig<R> {
    /// Of the centre of mass from the axis, m.
    pub eccentricity: R,
    /// Of the eccentricity.
    pub angle: R,
    /// Of the principal axis from the axis, rad.
    pub skew: R,
    /// Of the skew.
    pub skew_angle: R,
}

/// A retainer ring, the rotor in it, what it stands on and what turns in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingConfig<R> {
    /// Axial place from the centre of mass, m.
    pub place: R,
    /// Radial clearance, m.
    pub clearance: R,
    /// Of the rotor there, m.
    pub radius: R,
    /// Coefficient of friction, 0 or more.
    pub friction: R,
    /// Restitution, 0 to 1.
    pub restitution: R,
    /// A wall that gives way; one with restitution without.
    pub compliant: Option<CompliantConfig<R>>,
    /// Spring and damper; a rigid seat without.
    pub mount: Option<MountConfig<R>>,
    /// Ball bearing; a bushing without.
    pub race: Option<RaceConfig<R>>,
    /// Each bending mode's displacement there.
    pub shape: [R; MODES],
}

/// A magnetic bearing after the release, or while it is on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ActuatorConfig<R> {
    /// Axial place from the centre of mass, m.
    pub place: R,
    /// Force over displacement, N/m: positive pulls away from the centre, negative holds.
    pub stiffness: R,
    /// N s/m, 0 or more.
    pub damping: R,
    /// At the centre, N.
    pub force: [R; 2],
    /// Greatest force on each axis, either way, N; without bound where none.
    pub limit: Option<R>,
    /// From when and until when it is on, s after the release; always without.
    pub on: Option<[R; 2]>,
    /// Each bending mode's displacement there.
    pub shape: [R; MODES],
}

/// What rings and magnets stand on goes to and fro: by its amplitude times the cosine of an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseConfig<R> {
    /// m.
    pub amplitude: [R; 2],
    /// Of the angle, rad/s, above 0.
    pub rate: R,
    /// Angle at the release, rad.
    pub phase: R,
}

/// A bending mode of the free rotor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModeConfig<R> {
    /// rad/s.
    pub speed: R,
    /// Part of critical damping, in the frame that does not turn.
    pub damping_ratio: R,
    /// kg, for the shapes that are given.
    pub mass: R,
    /// Displacement at the centre of mass.
    pub centre: R,
}

/// A rotor and all that holds it, SI; x right, y up, z along the axis, spin from x to y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledConfig<R, const N: usize> {
    /// kg.
    pub mass: R,
    /// About the axis, kg m^2; up to twice the transverse one.
    pub polar_inertia: R,
    /// About the centre of mass across the axis, kg m^2.
    pub transverse_inertia: R,
    /// 1 to 4; clearance and radius of the first set the scales.
    pub rings: [RingConfig<R>; N],
    /// Across the axis, m/s^2; 0 for a vertical machine.
    pub gravity: [R; 2],
    /// Typical speed, m/s: sets the scales where gravity is 0, else unused.
    pub speed: R,
    /// Unbalance.
    pub unbalance: UnbalanceConfig<R>,
    /// Magnetic bearings; all 0 without.
    pub magnets: [ActuatorConfig<R>; MAGNETS],
    /// Motion of the base; all places are seen from it.
    pub base: Option<BaseConfig<R>>,
    /// Bending modes; those beyond the model's `Q` - 2 must be none.
    pub modes: [Option<ModeConfig<R>>; MODES],
    /// Length of a step, s.
    pub step: R,
}

/// After so many steps.
fn moment<R: Real>(steps: R) -> Instant<R> {
    if !steps.is_finite() {
        return Instant::NEVER;
    }
    let whole = steps.floor();
    Instant {
        tick: whole.to_u64(),
        fraction: steps - whole,
    }
}

fn finite<R: Real>(name: &'static str, values: &[R]) -> Result<(), ConfigError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(ConfigError::NotFinite(name))
    }
}

impl<R: Precision, const N: usize> CoupledConfig<R, N> {
    /// The plane's rotor in rings like the plane's, at these places (m), with all other parts left out; it does not tilt.
    pub fn of_plane(plane: &RigidConfig<R>, places: [R; N]) -> Self {
        let ring = |place| RingConfig {
            place,
            clearance: plane.clearance,
            radius: plane.radius,
            friction: plane.friction,
            restitution: plane.restitution,
            compliant: None,
            mount: None,
            race: None,
            shape: [R::ZERO; MODES],
        };
        Self {
            mass: plane.mass,
            polar_inertia: plane.polar_inertia,
            transverse_inertia: plane.polar_inertia,
            rings: places.map(ring),
            gravity: [R::ZERO, -plane.gravity],
            speed: plane.speed,
            unbalance: UnbalanceConfig::default(),
            magnets: [ActuatorConfig::default(); MAGNETS],
            base: None,
            modes: [None; MODES],
            step: plane.step,
        }
    }

    fn check(&self, modes: usize) -> Result<(), ConfigError> {
        positive("mass", self.mass)?;
        positive("transverse_inertia", self.transverse_inertia)?;
        positive("polar_inertia", self.polar_inertia)?;
        if self.polar_inertia > R::TWO * self.transverse_inertia {
            let rule = "no more than twice the transverse inertia";
            return Err(ConfigError::OutOfRange("polar_inertia", rule));
        }
        if N > MOST_RINGS {
            return Err(ConfigError::OutOfRange("rings", "1 to 4"));
        }
        for ring in &self.rings {
            finite("place", &[ring.place])?;
            positive("clearance", ring.clearance)?;
            positive("radius", ring.radius)?;
            not_negative("friction", ring.friction)?;
            not_negative("restitution", ring.restitution)?;
            if ring.restitution > R::ONE {
                return Err(ConfigError::OutOfRange("restitution", "0 to 1"));
            }
            finite("shape", &ring.shape)?;
        }
        finite("gravity", &self.gravity)?;
        let unbalance = &self.unbalance;
        finite("unbalance", &[unbalance.eccentricity, unbalance.angle])?;
        finite("unbalance", &[unbalance.skew, unbalance.skew_angle])?;
        for magnet in &self.magnets {
            finite("magnets", &[magnet.place, magnet.stiffness])?;
            finite("magnets", &magnet.force)?;
            finite("shape", &magnet.shape)?;
            not_negative("magnets", magnet.damping)?;
            if let Some(limit) = magnet.limit {
                positive("magnets", limit)?;
            }
            if let Some([from, until]) = magnet.on {
                not_negative("magnets", from)?;
                if until.partial_cmp(&from) != Some(Ordering::Greater) {
                    return Err(ConfigError::OutOfRange("magnets", "off after on"));
                }
            }
        }
        if let Some(base) = &self.base {
            finite("base", &base.amplitude)?;
            finite("base", &[base.phase])?;
            positive("base", base.rate)?;
        }
        if self.modes.iter().skip(modes).any(Option::is_some) {
            return Err(ConfigError::OutOfRange("modes", "as many as the model has"));
        }
        for mode in self.modes.iter().flatten() {
            positive("mode_frequency", mode.speed)?;
            not_negative("mode_damping", mode.damping_ratio)?;
            positive("mode_mass", mode.mass)?;
            finite("shape", &[mode.centre])?;
        }
        positive("step", self.step)
    }
}

impl<R: Precision, const N: usize, const Q: usize> Coupled<R, N, Q> {
    /// Checks `config` and works out the coefficients.
    pub fn try_new(config: &CoupledConfig<R, N>) -> Result<Self, ConfigError> {
        if !(1..=2 + MODES).contains(&Q) {
            return Err(ConfigError::OutOfRange("modes", "0 to 3"));
        }
        config.check(Q.saturating_sub(2))?;
        let Some(first) = config.rings.first() else {
            return Err(ConfigError::OutOfRange("rings", "1 to 4"));
        };
        let pull = Vector::new(config.gravity).length();
        let scales = Scales::try_new(first.clearance, pull, first.radius, config.speed)?;
        let arm = (config.transverse_inertia / config.mass).sqrt();
        let ratio = config.polar_inertia / config.transverse_inertia;
        let radius = first.radius;
        let size = scales.length / radius;
        let rate = scales.time * scales.time / scales.length;
        let mut model = Self {
            // Each by its own below.
            rings: [Ring::try_new([R::ZERO; Q], first, config, &scales)?; N],
            inertia_ratio: config.polar_inertia / config.mass / radius / radius,
            gyration: ratio * size,
            turn: size,
            gravity: Vector::new(config.gravity).times(rate),
            magnets: [None; MAGNETS],
            base: config.base.map(|it| Base {
                push: Vector::new(it.amplitude).times(it.rate * it.rate * rate),
                rate: it.rate * scales.time,
                phase: it.phase,
            }),
            frequency: [R::ZERO; Q],
            decay: [R::ZERO; Q],
            mode_scale: [R::ZERO; Q],
            weight: [Vector::default(); Q],
            repeats: false,
            step: config.step / scales.time,
            tilt: scales.length / arm,
            scales,
        };
        for (k, mode) in config.modes.iter().enumerate() {
            if let (Some(mode), Some(scale)) = (mode, model.mode_scale.get_mut(k + 2)) {
                *scale = (config.mass / mode.mass).sqrt();
                model.frequency[k + 2] = mode.speed * scales.time;
                model.decay[k + 2] = R::TWO * mode.damping_ratio * mode.speed * scales.time;
            }
        }
        for (k, ring) in config.rings.iter().enumerate() {
            let shape = model.shape_at(ring.place, ring.shape);
            model.rings[k] = Ring::try_new(shape, ring, config, &scales)?;
        }
        for k in 0..MAGNETS {
            let magnet = &config.magnets[k];
            let [x, y] = magnet.force;
            let pulls = [magnet.stiffness, magnet.damping, x, y];
            model.magnets[k] = pulls.iter().any(|it| *it != R::ZERO).then(|| Magnet {
                shape: model.shape_at(magnet.place, magnet.shape),
                stiffness: magnet.stiffness / config.mass * scales.time * scales.time,
                damping: magnet.damping / config.mass * scales.time,
                force: Vector::new(magnet.force).times(rate / config.mass),
                limit: magnet.limit.map(|limit| limit * rate / config.mass),
                on: magnet
                    .on
                    .map(|it| it.map(|time| moment(time / config.step))),
            });
        }
        let repeats = |ring: &Ring<R, Q>| {
            let rubs = ring.mount.is_some_and(|it| it.rubs());
            ring.race.is_some() || rubs
        };
        let limited = model.magnets.iter().flatten().any(|it| it.limit.is_some());
        model.repeats = limited || model.rings.iter().any(repeats);
        model.weight = model.unbalanced(config);
        model.checked()
    }

    /// Of the unbalance: the offset of each coordinate's mass.
    fn unbalanced<const M: usize>(&self, config: &CoupledConfig<R, M>) -> [Vector<R>; Q] {
        let offset = |size: R, angle: R| {
            let (sin, cos) = angle.sin_cos();
            Vector::new([size * cos, size * sin])
        };
        let (unbalance, length) = (&config.unbalance, self.scales.length);
        let weight = offset(unbalance.eccentricity / length, unbalance.angle);
        let ratio = config.polar_inertia / config.transverse_inertia;
        let couple = (R::ONE - ratio) * unbalance.skew / self.tilt;
        let centres = config.modes.map(|it| it.map_or(R::ZERO, |it| it.centre));
        let mut weights = self.shape_at(R::ZERO, centres).map(|b| weight.times(b));
        if let Some(tilt) = weights.get_mut(1) {
            *tilt = offset(couple, unbalance.skew_angle);
        }
        weights
    }

    /// What rounding or the scales make of the numbers.
    fn checked(self) -> Result<Self, ConfigError> {
        positive("step", self.step)?;
        positive("inertia_ratio", self.inertia_ratio)?;
        let mut pull = R::ZERO;
        for magnet in self.magnets.iter().flatten() {
            let square = product(&magnet.shape, &magnet.shape);
            finite("magnets", &[magnet.stiffness * square])?;
            pull += magnet.stiffness.most(R::ZERO) * square;
        }
        for ring in &self.rings {
            finite("place", &[product(&ring.shape, &ring.shape)])?;
        }
        if R::HALF * R::HALF * self.step * self.step * pull > R::lit(STIFFEST) {
            let rule = "no more than 1 over the rate at which the magnets pull away";
            return Err(ConfigError::OutOfRange("step", rule));
        }
        Ok(self)
    }
}

impl<R: Precision, const Q: usize> Ring<R, Q> {
    fn try_new<const N: usize>(
        shape: [R; Q],
        ring: &RingConfig<R>,
        config: &CoupledConfig<R, N>,
        scales: &Scales<R>,
    ) -> Result<Self, ConfigError> {
        let first = &config.rings[0];
        let units = Units {
            mass: config.mass,
            radius: first.radius,
            bore: ring.radius + ring.clearance,
            step: config.step / scales.time,
            scales: *scales,
        };
        let limit = ring.clearance / first.clearance;
        let compliant = |it| Compliant::try_new(it, ring.restitution, limit, &units);
        let mount = |it| Sprung::try_new(it, &units);
        let race = |it| BallBearing::try_new(it, &units);
        Ok(Self {
            shape,
            limit,
            surface: ring.radius / first.radius,
            friction: ring.friction,
            restitution: ring.restitution,
            compliant: ring.compliant.as_ref().map(compliant).transpose()?,
            mount: ring.mount.as_ref().map(mount).transpose()?,
            race: ring.race.as_ref().map(race).transpose()?,
        })
    }
}
