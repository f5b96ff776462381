//! A rotor that falls, tilts and bends, in rings that may stand on mounts and turn in ball bearings.
//!
//! The axis at the place z is displaced by r(z) = p + z a + sum of phi_k(z) eta_k, with the tilt
//! a = (theta_y, -theta_x) and the modes' coordinates eta_k. A ring's place u counts from where it
//! rests under its own weight; r - u is what its clearance bounds. Free tilt turns as a'' = i g w a',
//! g = J_p/J_t, x + iy: forward nutation.
//!
//! Limits: the damping of bending is taken in the frame that does not turn (no instability above a
//! critical speed), a mode is not split by its gyroscopic effect, a couple unbalance bends nothing,
//! small tilt, and unbalance does not act on the spin.

use super::super::press::Press;
use super::pull::Pull;
use super::soft::Soft;
use super::surroundings::{Body, Surroundings};
use super::system::{Hold, Link, Mode, System};
use touchdown_base::machine::Machine;
use touchdown_scene::{Base, Magnet, Mode as Bending, Race, Stop, Support, Unbalance};

/// Distance from its stop, in clearances or travels, at which a ring that the rotor strikes is on it.
const AT_STOP: f64 = 1e-3;

/// A ring and what holds it; without mount it is fixed, without race it doesn't turn. The mount's stop has no friction;
/// a rigid one has no rebound, and one that gives way gives all back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retainer {
    /// Along the axis from the centre of mass, m.
    pub place: f64,
    /// Of the rotor there, m.
    pub radius: f64,
    /// Radial gap, m.
    pub clearance: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Under the ring.
    pub mount: Option<Support>,
    /// In the ring, with the clearance added to the rotor's radius as its bore.
    pub race: Option<Race>,
    /// How its bore gives way, where it isn't rigid.
    pub press: Option<Press>,
}

impl Retainer {
    /// Of the bore.
    fn hold(&self) -> Hold {
        let &Self {
            clearance,
            friction,
            restitution,
            ..
        } = self;
        match self.press {
            Some(press) => Hold::Soft(Soft::new(clearance, friction, restitution, press)),
            None => Hold::Wall {
                clearance,
                friction,
                restitution,
            },
        }
    }
}

/// Of a ring's stop.
fn at_stop(stop: Stop) -> Hold {
    match stop.stiffness {
        Some(stiffness) => Hold::Soft(Soft::stop(stop.travel, stiffness)),
        None => Hold::Wall {
            clearance: stop.travel,
            friction: 0.0,
            restitution: 0.0,
        },
    }
}

/// Rotor and surroundings, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoupledMachine {
    /// kg.
    pub mass: f64,
    /// kg m^2.
    pub polar_inertia: f64,
    /// About the centre of mass, kg m^2.
    pub transverse_inertia: f64,
    /// In the plane, m/s^2.
    pub gravity: [f64; 2],
    /// One at least.
    pub retainers: Vec<Retainer>,
    /// The force m e w^2 and the moment (J_t - J_p) chi w^2; none by default.
    pub unbalance: Unbalance,
    /// Any number.
    pub magnets: Vec<Magnet>,
    /// Modes of the free rotor, any number.
    pub bending: Vec<Bending>,
    /// What it stands on, and is seen from, where that moves.
    pub base: Option<Base>,
}

impl CoupledMachine {
    /// A rotor in one ring, at its centre of mass: it never tilts.
    pub fn level(rotor: &Machine, mount: Option<Support>, race: Option<Race>) -> Self {
        Self {
            mass: rotor.mass,
            polar_inertia: rotor.polar_inertia,
            transverse_inertia: rotor.polar_inertia,
            gravity: [0.0, -rotor.gravity],
            retainers: vec![Retainer {
                place: 0.0,
                radius: rotor.radius,
                clearance: rotor.clearance,
                friction: rotor.friction,
                restitution: rotor.restitution,
                mount,
                race,
                press: None,
            }],
            ..Self::default()
        }
    }

    fn bodies(&self) -> usize {
        2 + self.bending.len() + self.retainers.len()
    }

    /// Of rotor and inner rings; then the angle of the base, which nothing changes the rate of.
    fn spins(&self) -> usize {
        1 + self.retainers.len() + usize::from(self.base.is_some())
    }

    /// Force of inertia on a mass, as it is at an angle of the base of 0.
    fn shaken(&self, mass: f64) -> [f64; 2] {
        let of = |base: Base| base.amplitude.map(|it| mass * base.rate * base.rate * it);
        self.base.map_or([0.0; 2], of)
    }

    /// Parts of the bodies in the displacement of the axis.
    fn axis(&self, place: f64) -> Vec<f64> {
        let mut shares = vec![1.0, place];
        shares.extend(self.bending.iter().map(|mode| mode.at(place)));
        shares.resize(self.bodies(), 0.0);
        shares
    }

    /// Walls of the rings, of the stops, brakes and seats.
    fn links(&self) -> Vec<Link> {
        let (mut walls, mut stops, mut brakes) = (Vec::new(), Vec::new(), Vec::new());
        let mut seats = Vec::new();
        let with = |mut of: Vec<f64>, index: usize, value: f64| {
            of[index] = value;
            of
        };
        let none = vec![0.0; self.bodies()];
        let still = vec![0.0; self.spins()];
        for (i, ring) in self.retainers.iter().enumerate() {
            let body = 2 + self.bending.len() + i;
            let bore = ring.radius + ring.clearance;
            let told = self.axis(ring.place);
            walls.push(Link {
                shares: with(told.clone(), body, -1.0),
                arms: with(with(still.clone(), 0, ring.radius), 1 + i, -bore),
                hold: ring.hold(),
                mode: Mode::Flight,
                near: 0.0,
                told,
            });
            let own = |hold| Link {
                shares: with(none.clone(), body, 1.0),
                arms: still.clone(),
                hold,
                mode: Mode::Flight,
                near: 0.0,
                told: with(none.clone(), body, 1.0),
            };
            let mounted = ring.mount.and_then(|mount| mount.stop);
            let rigid = mounted.filter(|stop| stop.stiffness.is_none());
            let near = rigid.map_or(0.0, |stop| AT_STOP * ring.clearance.min(stop.travel));
            let stop = rigid.map(|_| self.retainers.len() + stops.len());
            let limit = ring.mount.map_or(0.0, |mount| mount.friction);
            seats.extend((limit > 0.0).then(|| own(Hold::Seat { limit, stop })));
            stops.extend(mounted.map(|stop| Link {
                near,
                ..own(at_stop(stop))
            }));
            let dry = ring.race.map_or(0.0, |race| race.dry_drag);
            brakes.extend((dry > 0.0).then(|| Link {
                shares: none.clone(),
                arms: with(still.clone(), 1 + i, bore),
                told: none.clone(),
                ..own(Hold::Brake(dry / bore))
            }));
        }
        [walls, stops, brakes, seats].concat()
    }

    /// What acts on it.
    pub(super) fn surroundings(&self) -> Surroundings {
        let centre = self.mass * self.unbalance.eccentricity;
        let angle = self.unbalance.angle;
        let couple = (self.transverse_inertia - self.polar_inertia) * self.unbalance.skew;
        let mut bodies = vec![
            Body {
                weight: self.gravity.map(|g| self.mass * g),
                turning: (centre, angle),
                shaken: self.shaken(self.mass),
                ..Body::default()
            },
            Body {
                turning: (couple, self.unbalance.skew_angle),
                ..Body::default()
            },
        ];
        bodies.extend(self.bending.iter().map(|mode| Body {
            stiffness: [mode.mass * mode.speed * mode.speed; 2],
            damping: [2.0 * mode.damping_ratio * mode.mass * mode.speed; 2],
            turning: (mode.at(0.0) * centre, angle),
            ..Body::default()
        }));
        bodies.extend(self.retainers.iter().map(|it| {
            let axes = it.mount.map_or([[0.0; 2]; 2], |mount| mount.axes());
            Body {
                stiffness: axes.map(|[stiffness, _]| stiffness),
                damping: axes.map(|[_, damping]| damping),
                shaken: self.shaken(it.mount.map_or(0.0, |mount| mount.mass)),
                ..Body::default()
            }
        }));
        let magnet = |magnet: &Magnet| Pull {
            magnet: *magnet,
            shares: self.axis(magnet.place),
            on: magnet.on.is_none(),
            cut: [0.0; 2],
        };
        let races = self.retainers.iter().map(|it| it.race);
        let drags = races.map(|race| race.map_or(0.0, |race| race.viscous_drag));
        Surroundings {
            polar_inertia: self.polar_inertia,
            bodies,
            magnets: self.magnets.iter().map(magnet).collect(),
            viscous_drags: [0.0].into_iter().chain(drags).collect(),
            base: self.base.is_some(),
        }
    }

    /// Its masses and links; `length` is the least clearance, m.
    pub(super) fn system(&self, length: f64) -> System {
        let both = |values: Vec<f64>| values.into_iter().flat_map(|value| [value; 2]);
        let over = |of: Option<f64>| of.map_or(0.0, |of| 1.0 / of);
        let reach = |parts: &mut dyn Iterator<Item = f64>| {
            let largest = parts.map(f64::abs).fold(0.0, f64::max);
            if largest > 0.0 { length / largest } else { 1.0 }
        };
        let mut mobility = vec![1.0 / self.mass, 1.0 / self.transverse_inertia];
        let mut size = vec![length, reach(&mut self.retainers.iter().map(|it| it.place))];
        for mode in &self.bending {
            mobility.push(1.0 / mode.mass);
            let at_rings = self.retainers.iter().map(|it| mode.at(it.place));
            size.push(reach(&mut { at_rings }));
        }
        for it in &self.retainers {
            mobility.push(over(it.mount.map(|mount| mount.mass)));
            size.push(length);
        }
        let races = self.retainers.iter().map(|it| it.race);
        let races = races.map(|race| over(race.map(|race| race.inertia)));
        let spins = [1.0 / self.polar_inertia].into_iter().chain(races);
        let base = self.base.map(|_| 0.0);
        System {
            mobility: both(mobility).chain(spins).chain(base).collect(),
            size: both(size).chain(vec![1.0; self.spins()]).collect(),
            links: self.links(),
        }
    }
}
