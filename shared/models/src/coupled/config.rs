//! The machine, SI.

use core::array::from_fn;
use core::cmp::Ordering;

use super::compliant::{Compliant, CompliantConfig};
use super::magnets::Magnet;
use super::mount::{MountConfig, Sprung};
use super::race::{BallBearing, RaceConfig};
use super::vector::Vector;
use super::{Base, Coupled, MAGNETS, Ring, Units, product, shape_of};
use touchdown_rotor::RigidConfig;
use touchdown_rotor::clock::Instant;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{Scales, not_negative, positive};

/// Most rings.
const MOST_RINGS: usize = 4;
/// Most bending modes.
pub(super) const MODES: usize = 3;
/// (h/2)^2 times the stiffness that pulls away, over mass; at 1 the step has no solution.
const STIFFEST: f64 = 0.25;

/// Static and couple unbalance; angles on the rotor, from its x axis at spin angle 0, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnbalanceConfig {
    /// Of the centre of mass from the axis, m.
    pub eccentricity: f64,
    /// Of the eccentricity.
    pub angle: f64,
    /// Of the principal axis from the axis, rad.
    pub skew: f64,
    /// Of the skew.
    pub skew_angle: f64,
}

/// A retainer ring, the rotor in it, what it stands on and what turns in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingConfig {
    /// Axial place from the centre of mass, m.
    pub place: f64,
    /// Radial clearance, m.
    pub clearance: f64,
    /// Of the rotor there, m.
    pub radius: f64,
    /// Coefficient of friction, 0 or more.
    pub friction: f64,
    /// Restitution, 0 to 1.
    pub restitution: f64,
    /// A wall that gives way; one with restitution without.
    pub compliant: Option<CompliantConfig>,
    /// Spring and damper; a rigid seat without.
    pub mount: Option<MountConfig>,
    /// Ball bearing; a bushing without.
    pub race: Option<RaceConfig>,
    /// Each bending mode's displacement there.
    pub shape: [f64; MODES],
}

/// A magnetic bearing after the release, or while it is on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ActuatorConfig {
    /// Axial place from the centre of mass, m.
    pub place: f64,
    /// Force over displacement, N/m: positive pulls away from the centre, negative holds.
    pub stiffness: f64,
    /// N s/m, 0 or more.
    pub damping: f64,
    /// At the centre, N.
    pub force: [f64; 2],
    /// Greatest force on each axis, either way, N; without bound where none.
    pub limit: Option<f64>,
    /// From when and until when it is on, s after the release; always without.
    pub on: Option<[f64; 2]>,
    /// Each bending mode's displacement there.
    pub shape: [f64; MODES],
}

/// What rings and magnets stand on goes to and fro: by its amplitude times the cosine of an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseConfig {
    /// m.
    pub amplitude: [f64; 2],
    /// Of the angle, rad/s, above 0.
    pub rate: f64,
    /// Angle at the release, rad.
    pub phase: f64,
}

/// A bending mode of the free rotor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModeConfig {
    /// rad/s.
    pub speed: f64,
    /// Part of critical damping, in the frame that does not turn.
    pub damping_ratio: f64,
    /// kg, for the shapes that are given.
    pub mass: f64,
    /// Displacement at the centre of mass.
    pub centre: f64,
}

/// A rotor and all that holds it, SI; x right, y up, z along the axis, spin from x to y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledConfig<const N: usize> {
    /// kg.
    pub mass: f64,
    /// About the axis, kg m^2; up to twice the transverse one.
    pub polar_inertia: f64,
    /// About the centre of mass across the axis, kg m^2.
    pub transverse_inertia: f64,
    /// 1 to 4; clearance and radius of the first set the scales.
    pub rings: [RingConfig; N],
    /// Across the axis, m/s^2; 0 for a vertical machine.
    pub gravity: [f64; 2],
    /// Typical speed, m/s: sets the scales where gravity is 0, else unused.
    pub speed: f64,
    /// Unbalance.
    pub unbalance: UnbalanceConfig,
    /// Magnetic bearings; all 0 without.
    pub magnets: [ActuatorConfig; MAGNETS],
    /// Motion of the base; all places are seen from it.
    pub base: Option<BaseConfig>,
    /// Bending modes; those beyond the model's `Q` - 2 must be none.
    pub modes: [Option<ModeConfig>; MODES],
    /// Length of a step, s.
    pub step: f64,
}

/// After so many steps.
fn moment<R: Real>(steps: f64) -> Instant<R> {
    if !steps.is_finite() {
        return Instant::NEVER;
    }
    let whole = steps.floor();
    Instant {
        tick: whole.to_u64(),
        fraction: R::lit(steps - whole),
    }
}

fn finite(name: &'static str, values: &[f64]) -> Result<(), ConfigError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(ConfigError::NotFinite(name))
    }
}

impl<const N: usize> CoupledConfig<N> {
    /// The plane's rotor in rings like the plane's, at these places (m), with all other parts left out; it does not tilt.
    pub fn of_plane(plane: &RigidConfig<f64>, places: [f64; N]) -> Self {
        let ring = |place| RingConfig {
            place,
            clearance: plane.clearance,
            radius: plane.radius,
            friction: plane.friction,
            restitution: plane.restitution,
            compliant: None,
            mount: None,
            race: None,
            shape: [0.0; MODES],
        };
        Self {
            mass: plane.mass,
            polar_inertia: plane.polar_inertia,
            transverse_inertia: plane.polar_inertia,
            rings: places.map(ring),
            gravity: [0.0, -plane.gravity],
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
        if self.polar_inertia > 2.0 * self.transverse_inertia {
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
            if ring.restitution > 1.0 {
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
    /// Checks `config` and works out the coefficients, each rounded once.
    pub fn try_new(config: &CoupledConfig<N>) -> Result<Self, ConfigError> {
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
        let size = scales.length / first.radius;
        let rate = scales.time * scales.time / scales.length;
        let mode = |k: usize| config.modes.get(k.checked_sub(2)?)?.as_ref();
        let scaled = |of: &dyn Fn(&ModeConfig) -> f64| from_fn(|k| mode(k).map_or(0.0, of));
        let axis = Bent {
            mode_scale: scaled(&|it| (config.mass / it.mass).sqrt()),
            tilt: scales.length / arm,
            scales,
        };
        // Each by its own.
        let mut rings = [axis.ring(first, config)?; N];
        for (ring, of) in rings.iter_mut().zip(&config.rings) {
            *ring = axis.ring(of, config)?;
        }
        let inertia_ratio = config.polar_inertia / config.mass / first.radius / first.radius;
        let step = config.step / scales.time;
        positive("step", step)?;
        positive("inertia_ratio", inertia_ratio)?;
        let magnets = axis.magnets(config)?;
        let repeats =
            |ring: &Ring<R, Q>| ring.race.is_some() || ring.mount.is_some_and(|it| it.rubs());
        let limited = magnets.iter().flatten().any(|it| it.limit.is_some());
        Ok(Self {
            inertia_ratio: R::lit(inertia_ratio),
            gyration: R::lit(ratio * size),
            turn: R::lit(size),
            gravity: Vector::new(config.gravity).times(rate).rounded(),
            base: config.base.map(|it| Base {
                push: Vector::new(it.amplitude)
                    .times(it.rate * it.rate * rate)
                    .rounded(),
                rate: R::lit(it.rate * scales.time),
                phase: R::lit(it.phase),
            }),
            frequency: scaled(&|it| it.speed * scales.time).map(R::lit),
            decay: scaled(&|it| 2.0 * it.damping_ratio * it.speed * scales.time).map(R::lit),
            mode_scale: axis.mode_scale.map(R::lit),
            weight: axis.unbalanced(config).map(|it| it.rounded()),
            repeats: limited || rings.iter().any(repeats),
            rings,
            magnets,
            step: R::lit(step),
            tilt: R::lit(axis.tilt),
            scales: scales.rounded(),
        })
    }
}

/// The rotor's axis, tilted and bent.
struct Bent<const Q: usize> {
    mode_scale: [f64; Q],
    tilt: f64,
    scales: Scales<f64>,
}

impl<const Q: usize> Bent<Q> {
    /// [`Coupled::shape_at`].
    fn at(&self, place: f64, modes: [f64; MODES]) -> [f64; Q] {
        shape_of(
            self.mode_scale,
            place * self.tilt / self.scales.length,
            modes,
        )
    }

    fn ring<R: Precision, const N: usize>(
        &self,
        ring: &RingConfig,
        config: &CoupledConfig<N>,
    ) -> Result<Ring<R, Q>, ConfigError> {
        let first = &config.rings[0];
        let units = Units {
            mass: config.mass,
            radius: first.radius,
            bore: ring.radius + ring.clearance,
            step: config.step / self.scales.time,
            scales: self.scales,
        };
        let limit = ring.clearance / first.clearance;
        let compliant = |it| Compliant::try_new(it, ring.restitution, limit, &units);
        let mount = |it| Sprung::try_new(it, &units);
        let race = |it| BallBearing::try_new(it, &units);
        Ok(Ring {
            shape: self.at(ring.place, ring.shape).map(R::lit),
            limit: R::lit(limit),
            surface: R::lit(ring.radius / first.radius),
            friction: R::lit(ring.friction),
            restitution: R::lit(ring.restitution),
            compliant: ring.compliant.as_ref().map(compliant).transpose()?,
            mount: ring.mount.as_ref().map(mount).transpose()?,
            race: ring.race.as_ref().map(race).transpose()?,
        })
    }

    /// Checked for what rounding or the scales make of the numbers, with the rings' places.
    fn magnets<R: Real, const N: usize>(
        &self,
        config: &CoupledConfig<N>,
    ) -> Result<[Option<Magnet<R, Q>>; MAGNETS], ConfigError> {
        let (time, mut pull) = (self.scales.time, 0.0);
        let rate = time * time / self.scales.length;
        let mut magnets = [None; MAGNETS];
        for (to, magnet) in magnets.iter_mut().zip(&config.magnets) {
            let [x, y] = magnet.force;
            if [magnet.stiffness, magnet.damping, x, y] == [0.0; 4] {
                continue;
            }
            let shape = self.at(magnet.place, magnet.shape);
            let stiffness = magnet.stiffness / config.mass * time * time;
            let square = product(&shape, &shape);
            finite("magnets", &[stiffness * square])?;
            pull += stiffness.most(0.0) * square;
            let moments = |it: [f64; 2]| it.map(|time| moment(time / config.step));
            *to = Some(Magnet {
                shape: shape.map(R::lit),
                stiffness: R::lit(stiffness),
                damping: R::lit(magnet.damping / config.mass * time),
                force: Vector::new(magnet.force)
                    .times(rate / config.mass)
                    .rounded(),
                limit: magnet.limit.map(|it| R::lit(it * rate / config.mass)),
                on: magnet.on.map(moments),
            });
        }
        for ring in &config.rings {
            let shape = self.at(ring.place, ring.shape);
            finite("place", &[product(&shape, &shape)])?;
        }
        let step = config.step / time;
        if 0.5 * 0.5 * step * step * pull > STIFFEST {
            let rule = "no more than 1 over the rate at which the magnets pull away";
            return Err(ConfigError::OutOfRange("step", rule));
        }
        Ok(magnets)
    }

    /// Of the unbalance: the offset of each coordinate's mass.
    fn unbalanced<const N: usize>(&self, config: &CoupledConfig<N>) -> [Vector<f64>; Q] {
        let offset = |size: f64, angle: f64| {
            let (sin, cos) = angle.sin_cos();
            Vector::new([size * cos, size * sin])
        };
        let (unbalance, length) = (&config.unbalance, self.scales.length);
        let weight = offset(unbalance.eccentricity / length, unbalance.angle);
        let ratio = config.polar_inertia / config.transverse_inertia;
        let couple = (1.0 - ratio) * unbalance.skew / self.tilt;
        let centres = config.modes.map(|it| it.map_or(0.0, |it| it.centre));
        let mut weights = self.at(0.0, centres).map(|b| weight.times(b));
        if let Some(tilt) = weights.get_mut(1) {
            *tilt = offset(couple, unbalance.skew_angle);
        }
        weights
    }
}
