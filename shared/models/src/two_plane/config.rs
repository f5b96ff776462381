//! A rotor in its rings, SI.

use super::{Magnet, Ring, TwoPlane, Unbalance};
use crate::vector::Vector;
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::precision::Precision;
use touchdown_rotor::real::Real;
use touchdown_rotor::scales::{Scales, not_negative, positive};

/// Most rings.
pub(super) const MOST_RINGS: usize = 4;
/// Part of the motion's own rate, (h/2)^2 times the largest stiffness over mass, that a step may take from the
/// implicit magnet force; at 1 the step has no solution.
const STIFFEST: f64 = 0.25;

/// A retainer ring and the rotor in it.
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
}

/// What is left of a magnetic bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MagnetConfig<R> {
    /// Axial place from the centre of mass, m.
    pub place: R,
    /// Force over displacement, N/m: positive pulls away from the centre, negative holds.
    pub stiffness: R,
    /// At the centre, N.
    pub force: [R; 2],
}

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

/// A rotor in its rings, SI; x right, y up, z along the axis, spin from x to y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoPlaneConfig<R, const N: usize> {
    /// kg.
    pub mass: R,
    /// About the axis, kg m^2; up to twice the transverse one.
    pub polar_inertia: R,
    /// About the centre of mass across the axis, kg m^2.
    pub transverse_inertia: R,
    /// 1 to 4 rings; clearance and radius of the first set the scales.
    pub rings: [RingConfig<R>; N],
    /// Across the axis, m/s^2; 0 for a vertical machine.
    pub gravity: [R; 2],
    /// Typical speed, m/s: sets the scales where gravity is 0, else unused.
    pub speed: R,
    /// Unbalance.
    pub unbalance: UnbalanceConfig<R>,
    /// Two planes of magnets; all 0 without.
    pub magnets: [MagnetConfig<R>; 2],
    /// Length of a step, s.
    pub step: R,
}

fn finite<R: Real>(name: &'static str, values: &[R]) -> Result<(), ConfigError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(ConfigError::NotFinite(name))
    }
}

impl<R: Precision, const N: usize> TwoPlaneConfig<R, N> {
    fn check(&self) -> Result<(), ConfigError> {
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
        }
        finite("gravity", &self.gravity)?;
        let unbalance = &self.unbalance;
        finite(
            "unbalance",
            &[unbalance.eccentricity, unbalance.angle, unbalance.skew],
        )?;
        finite("skew_angle", &[unbalance.skew_angle])?;
        for magnet in &self.magnets {
            finite("magnets", &[magnet.place, magnet.stiffness])?;
            finite("magnets", &magnet.force)?;
        }
        positive("step", self.step)
    }
}

impl<R: Precision, const N: usize> TwoPlane<R, N> {
    /// Checks `config` and works out the coefficients.
    pub fn try_new(config: &TwoPlaneConfig<R, N>) -> Result<Self, ConfigError> {
        config.check()?;
        let Some(first) = config.rings.first() else {
            return Err(ConfigError::OutOfRange("rings", "1 to 4"));
        };
        let pull = Vector::new(config.gravity).length();
        let scales = Scales::try_new(first.clearance, pull, first.radius, config.speed)?;
        let arm = (config.transverse_inertia / config.mass).sqrt();
        let ratio = config.polar_inertia / config.transverse_inertia;
        let size = scales.length / first.radius;
        let rate = scales.time * scales.time / scales.length;
        let magnets = config.magnets.map(|magnet| Magnet {
            zeta: magnet.place / arm,
            stiffness: magnet.stiffness / config.mass * scales.time * scales.time,
            force: Vector::new(magnet.force).times(rate / config.mass),
        });
        let offset = |size: R, angle: R| {
            let (sin, cos) = angle.sin_cos();
            Vector::new([size * cos, size * sin])
        };
        let unbalance = &config.unbalance;
        let radius = config.polar_inertia / config.mass / first.radius;
        let model = Self {
            rings: config.rings.map(|ring| Ring {
                zeta: ring.place / arm,
                limit: ring.clearance / first.clearance,
                surface: ring.radius / first.radius,
                friction: ring.friction,
                restitution: ring.restitution,
            }),
            inertia_ratio: radius / first.radius,
            gyration: ratio * size,
            turn: size,
            gravity: Vector::new(config.gravity).times(rate),
            magnets,
            unbalance: Unbalance {
                weight: offset(unbalance.eccentricity / scales.length, unbalance.angle),
                couple: offset(
                    (R::ONE - ratio) * unbalance.skew * arm / scales.length,
                    unbalance.skew_angle,
                ),
            },
            step: config.step / scales.time,
            tilt: scales.length / arm,
            scales,
        };
        model.checked()
    }

    /// What rounding or the scales make of the numbers.
    fn checked(self) -> Result<Self, ConfigError> {
        positive("step", self.step)?;
        positive("inertia_ratio", self.inertia_ratio)?;
        for ring in &self.rings {
            finite("place", &[ring.zeta * ring.zeta])?;
        }
        let [direct, cross, tilting] = self.stiffness();
        finite("magnets", &[direct, cross, tilting])?;
        let half = R::HALF * (direct - tilting);
        let largest = R::HALF * (direct + tilting) + (half * half + cross * cross).sqrt();
        let quarter = R::HALF * R::HALF * self.step * self.step;
        if quarter * largest > R::lit(STIFFEST) {
            let rule = "no more than 1 over the rate at which the magnets pull away";
            return Err(ConfigError::OutOfRange("step", rule));
        }
        Ok(self)
    }
}
