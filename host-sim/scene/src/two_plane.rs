//! `[two_plane]` and `[[ring]]`: a rotor that tilts, in retainer rings at their places.

use serde::Deserialize;
use touchdown_core::sensing::AxialPlaces;
use touchdown_models::UnbalanceConfig;

use super::base::Base;
use super::diagnostic::Diagnostic;
use super::magnet::{Magnet, MagnetTable, all_magnets};
use super::materials::CompliantWall;
use super::mode::{Mode, ModeTable, all_modes};
use super::rule::{Keys, MILLI, ON_THE_WALL, exactly, exactly_if_there};
use super::support::{BallBearing, BallBearingTable, Stop, Support, SupportTable};
use super::{Retainer, Rotor, Scene, Start, limits};
use touchdown_base::plain::Number;

/// Most rings.
pub const RINGS: usize = 4;
const GRAM_MM: f64 = 1e-6;

/// Static and couple unbalance.
pub type Unbalance = UnbalanceConfig;

/// A rotor with two ends.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoPlane {
    /// About an axis across the rotor, through its centre of mass, kg m^2.
    pub transverse_inertia: f64,
    /// Of the centre of mass and of the principal axis.
    pub unbalance: Unbalance,
    /// First bending mode of the rotor, Hz.
    pub elastic_mode: Option<f64>,
    /// Slope of the rotor's axis at the release: change of x and y along z.
    pub tilt: [f64; 2],
    /// rad/s.
    pub tilt_rate: [f64; 2],
    /// From down, counter-clockwise, rad.
    pub gravity_angle: f64,
    /// Of the sensor planes, m.
    pub sensors: [f64; 2],
    /// One to four.
    pub rings: Vec<Ring>,
    /// None to four.
    pub magnets: Vec<Magnet>,
    /// Bending modes of the free rotor, none to three.
    pub modes: Vec<Mode>,
    /// Motion of what the machine stands on.
    pub base: Option<Base>,
}

impl TwoPlane {
    /// Where the sensors and the outermost rings are, where they are apart and the sensors show what the rotor does at the rings.
    pub fn places(&self) -> Option<AxialPlaces> {
        let [a, b] = self.sensors;
        let mut rings = ends(&self.rings);
        if a > b {
            rings.reverse();
        }
        let places = AxialPlaces {
            sensors: self.sensors.map(|it| it as f32),
            rings: rings.map(|it| it as f32),
        };
        (self.sensors != rings && places.overhang().is_some()).then_some(places)
    }
}

/// A retainer ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// For people.
    pub name: String,
    /// From the rotor's centre of mass, m.
    pub place: f64,
    /// Of the rotor in it, m.
    pub radius: f64,
    /// Its gap and law.
    pub retainer: Retainer,
    /// In place of restitution, where contacts are to have a force and a duration.
    pub wall: Option<CompliantWall>,
    /// What it stands on, where that gives way.
    pub support: Option<Support>,
    /// Its ball bearing, where it has one.
    pub ball_bearing: Option<BallBearing>,
}

impl Ring {
    /// That of a rotor that does not tilt: on the mounts of all rings, and turning with all, side by side.
    pub fn of_plane(scene: &Scene) -> Self {
        let all = || scene.rings().iter();
        Self {
            name: String::new(),
            place: 0.0,
            radius: scene.rotor.radius,
            retainer: scene.retainer,
            wall: None,
            support: mounts(all().filter_map(|it| it.support)).or(scene.support),
            ball_bearing: races(all().filter_map(|it| it.ball_bearing)).or(scene.ball_bearing),
        }
    }
}

fn mounts(all: impl Iterator<Item = Support>) -> Option<Support> {
    all.reduce(|a, b| Support {
        mass: a.mass + b.mass,
        stiffness: a.stiffness + b.stiffness,
        damping: a.damping + b.damping,
        vertical: (a.vertical.is_some() || b.vertical.is_some())
            .then(|| [0, 1].map(|k| a.axes()[1][k] + b.axes()[1][k])),
        friction: a.friction + b.friction,
        stop: match (a.stop, b.stop) {
            (Some(a), Some(b)) => Some(Stop {
                travel: a.travel.min(b.travel),
                stiffness: a.stiffness.zip(b.stiffness).map(|(a, b)| a + b),
            }),
            (a, b) => a.or(b),
        },
    })
}

fn races(all: impl Iterator<Item = BallBearing>) -> Option<BallBearing> {
    all.reduce(|mut a, BallBearing { race: b, .. }| {
        a.race.inertia += b.inertia;
        a.race.dry_drag += b.dry_drag;
        a.race.viscous_drag += b.viscous_drag;
        a.race.heat_capacity += b.heat_capacity;
        a.race.heat_loss += b.heat_loss;
        a
    })
}

impl TwoPlane {
    /// Of the rotor's axis at `place`, from the bearing's centre, where the centre of mass is at `centre`
    /// (or the velocities instead of all of these).
    pub fn at(centre: [f64; 2], tilt: [f64; 2], place: f64) -> [f64; 2] {
        [centre[0] + place * tilt[0], centre[1] + place * tilt[1]]
    }

    /// Whether it has what only rigid rings and a rigid rotor lack.
    pub fn is_coupled(&self) -> bool {
        let seated = |it: &Ring| it.support.is_some() || it.ball_bearing.is_some();
        let (mut rings, mut magnets) = (self.rings.iter(), self.magnets.iter());
        rings.any(|it| seated(it) || it.wall.is_some())
            || magnets.any(|it| it.damping > 0.0 || it.on.is_some() || it.limit.is_some())
            || !self.modes.is_empty()
            || self.base.is_some()
    }

    /// Of spin (rad/s), bending modes, mounts and the decay of their motion, the fastest, rad/s.
    pub fn fastest(&self, spin: f64) -> f64 {
        let modes = self.modes.iter().map(|it| it.speed);
        let mounts = self.rings.iter().filter_map(|it| it.support);
        let mounts = mounts.flat_map(|it| {
            let stop = it.stop.and_then(|it| it.stiffness).unwrap_or(0.0);
            it.axes().map(|[spring, damper]| {
                f64::max(((spring + stop) / it.mass).sqrt(), damper / it.mass)
            })
        });
        let base = self.base.map(|it| it.rate);
        modes.chain(mounts).chain(base).fold(spin.abs(), f64::max)
    }

    /// What lets the axis tilt beyond small angles, if anything does.
    pub(super) fn tilt_warning(&self) -> Option<String> {
        if let ([ring], []) = (&*self.rings, &*self.magnets) {
            let far = ring.place.abs() > ring.retainer.clearance / limits::SMALL_TILT;
            return far.then(|| {
                format!(
                    "one ring, {} mm from the centre of mass, does not hold the tilt: it is taken as small",
                    Number(ring.place / MILLI)
                )
            });
        }
        let pairs = self.rings.iter().enumerate();
        let pairs = pairs.flat_map(|(k, a)| self.rings[..k].iter().map(move |b| (a, b)));
        let held = pairs.map(|(a, b)| {
            (a.retainer.clearance + b.retainer.clearance) / (a.place - b.place).abs()
        });
        let held = held.fold(f64::INFINITY, f64::min);
        (self.rings.len() > 1 && held > limits::SMALL_TILT).then(|| {
            format!(
                "the rings hold the tilt to {:.0} mrad: it is taken as small, {:.0} mrad at most",
                held / MILLI,
                limits::SMALL_TILT / MILLI
            )
        })
    }

    /// The start must be within every ring.
    pub(super) fn check_start(&self, start: &Start) -> Result<(), Diagnostic> {
        let Start::Free { position, .. } = *start else {
            let rule = "a start on the wall is for one plane: give x_mm, y_mm and tilt_mrad";
            return Err(Diagnostic::new("start", "angle_deg", rule));
        };
        for (row, ring) in self.rings.iter().enumerate() {
            let [x, y] = Self::at(position, self.tilt, ring.place);
            let clearance = ring.retainer.clearance;
            if x.hypot(y) > clearance * (1.0 + ON_THE_WALL) {
                let rule = format!(
                    "the start is outside the gap of ring {}: {:.6} mm from its centre, the clearance is {} mm",
                    ring.name,
                    Number(x.hypot(y) / MILLI),
                    Number(clearance / MILLI)
                );
                return Err(RING.broken("z_mm", rule).in_row(row));
            }
        }
        Ok(())
    }
}

#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct TwoPlaneTable {
    transverse_inertia_kg_m2: Option<f64>,
    rotor_length_mm: Option<f64>,
    unbalance_g_mm: f64,
    unbalance_deg: f64,
    skew_mrad: f64,
    skew_deg: f64,
    elastic_mode_hz: Option<f64>,
    #[serde(deserialize_with = "exactly")]
    tilt_mrad: [f64; 2],
    #[serde(deserialize_with = "exactly")]
    tilt_rate_rad_s: [f64; 2],
    gravity_deg: f64,
    #[serde(deserialize_with = "exactly_if_there")]
    sensor_z_mm: Option<[f64; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RingTable {
    name: Option<String>,
    z_mm: f64,
    radius_mm: Option<f64>,
    clearance_mm: Option<f64>,
    friction: Option<f64>,
    restitution: Option<f64>,
    support: Option<SupportTable>,
    ball_bearing: Option<BallBearingTable>,
}

const KEYS: Keys = Keys("two_plane");

impl TwoPlaneTable {
    pub fn check(
        &self,
        rotor: &Rotor,
        retainer: &Retainer,
        rings: &[RingTable],
        magnets: &[MagnetTable],
        modes: &[ModeTable],
    ) -> Result<TwoPlane, Diagnostic> {
        let rings = all_rings(rotor, retainer, rings)?;
        let ends = ends(&rings);
        let places = |it: [f64; 2]| it.map(|place| MILLI * place);
        Ok(TwoPlane {
            transverse_inertia: self.transverse_inertia(rotor)?,
            unbalance: Unbalance {
                eccentricity: GRAM_MM * self.unbalance_g_mm / rotor.mass,
                angle: self.unbalance_deg.to_radians(),
                skew: MILLI * self.skew_mrad,
                skew_angle: self.skew_deg.to_radians(),
            },
            elastic_mode: self.elastic_mode_hz,
            tilt: self.tilt_mrad.map(|tilt| MILLI * tilt),
            tilt_rate: self.tilt_rate_rad_s,
            gravity_angle: self.gravity_deg.to_radians(),
            sensors: self.sensor_z_mm.map_or(ends, places),
            rings,
            magnets: all_magnets(magnets)?,
            modes: all_modes(modes, rotor.mass, self.rotor_length_mm)?,
            base: None,
        })
    }

    /// As given, or that of a solid cylinder of the given length.
    fn transverse_inertia(&self, rotor: &Rotor) -> Result<f64, Diagnostic> {
        let key = "transverse_inertia_kg_m2";
        let (inertia, key) = match (self.transverse_inertia_kg_m2, self.rotor_length_mm) {
            (Some(inertia), None) => (inertia, key),
            (None, Some(length)) => {
                let length = MILLI * length;
                let square = rotor.radius * rotor.radius / 4.0 + length * length / 12.0;
                (rotor.mass * square, "rotor_length_mm")
            }
            (Some(_), Some(_)) => {
                let rule = "transverse_inertia_kg_m2 or rotor_length_mm: give one";
                return Err(KEYS.broken(key, rule));
            }
            (None, None) => {
                let rule = "transverse_inertia_kg_m2 or rotor_length_mm must be given";
                return Err(KEYS.broken(key, rule));
            }
        };
        let ratio = rotor.polar_inertia / inertia;
        if limits::GYROSCOPIC_RATIO.contains(&ratio) {
            return Ok(inertia);
        }
        let (low, high) = limits::GYROSCOPIC_RATIO.into_inner();
        let rule = format!(
            "polar over transverse inertia must be {low:e} to {high} (a thin disc), is {:.6}",
            Number(ratio)
        );
        Err(KEYS.broken(key, rule))
    }
}

/// Places of the outermost ones, m.
fn ends(rings: &[Ring]) -> [f64; 2] {
    let places = rings.iter().map(|ring| ring.place);
    let lowest = places.clone().fold(f64::INFINITY, f64::min);
    [lowest, places.fold(f64::NEG_INFINITY, f64::max)]
}

fn all_rings(
    rotor: &Rotor,
    retainer: &Retainer,
    tables: &[RingTable],
) -> Result<Vec<Ring>, Diagnostic> {
    let count = tables.len();
    if !(1..=RINGS).contains(&count) {
        let rule = format!("[[ring]] must stand 1 to {RINGS} times, stands {count} times");
        let keys = if count == 0 { KEYS } else { RING };
        return Err(keys.broken("z_mm", rule));
    }
    RING.rows("z_mm", tables, RINGS, |row, table| {
        table.check(["a", "b", "c", "d"][row], rotor, retainer)
    })
}

const RING: Keys = Keys("ring");

impl RingTable {
    /// `name` where it gives none.
    fn check(&self, name: &str, rotor: &Rotor, retainer: &Retainer) -> Result<Ring, Diagnostic> {
        let support = self.support.as_ref().map(SupportTable::check);
        // A flaw of a table in a ring's row stands at that table.
        let there = |flaw: Diagnostic| RING.broken(flaw.table, flaw.rule);
        Ok(Ring {
            name: self.name.clone().unwrap_or_else(|| name.to_owned()),
            place: MILLI * self.z_mm,
            radius: self.radius_mm.map_or(rotor.radius, |it| MILLI * it),
            retainer: Retainer {
                clearance: (self.clearance_mm).map_or(retainer.clearance, |it| MILLI * it),
                friction: self.friction.unwrap_or(retainer.friction),
                restitution: self.restitution.unwrap_or(retainer.restitution),
            },
            wall: None,
            support: support.transpose().map_err(there)?,
            ball_bearing: self.ball_bearing.as_ref().map(BallBearing::from),
        })
    }
}
