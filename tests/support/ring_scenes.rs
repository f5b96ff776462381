//! A rotor in a ring that moves, in SI, by the model and by the reference.

use crate::moment::{Moment, scaled};
use touchdown_base::machine::Machine;
use touchdown_models::{
    Coupled, CoupledConfig, CoupledState, Load, MountConfig, Placement, RaceConfig, RingEvent,
    StopConfig,
};
use touchdown_rotor::{Change, Precision, RigidConfig};
use touchdown_truth::reference;
use touchdown_truth::reference::coupled::{CoupledMachine, CoupledReference, CoupledStart};

/// A rotor, what it falls into, and how.
#[derive(Clone, Copy, Debug)]
pub struct Fall {
    /// Rotor, gap and step.
    pub rigid: RigidConfig<f64>,
    /// None: the ring is fixed.
    pub mount: Option<MountConfig>,
    /// None: a bushing.
    pub race: Option<RaceConfig>,
    /// SI.
    pub start: reference::Start,
    /// rad/s.
    pub spin: f64,
}

/// A change of motion: when (s), and what.
pub type Told = (f64, Change<f64>);

impl Fall {
    /// A rotor of 5 kg in a gap of 0.3 mm, released at the centre without spin.
    pub fn new(step: f64) -> Self {
        let (mass, radius) = (5.0, 0.025);
        Self {
            rigid: RigidConfig {
                mass,
                radius,
                polar_inertia: 0.5 * mass * radius * radius,
                clearance: 3e-4,
                friction: 0.15,
                restitution: 0.6,
                gravity: 9.81,
                speed: 0.05,
                step,
            },
            mount: None,
            race: None,
            start: reference::Start::Free {
                position: [0.0; 2],
                velocity: [0.0; 2],
            },
            spin: 0.0,
        }
    }

    /// With a ring of this mass (kg) on a spring (N/m) and a damper (N s/m).
    pub fn mounted(self, mass: f64, stiffness: f64, damping: f64) -> Self {
        Self {
            mount: Some(MountConfig {
                mass,
                stiffness,
                damping,
                vertical: None,
                friction: 0.0,
                stop: None,
            }),
            ..self
        }
    }

    /// With a stop after this way of the ring, m.
    pub fn stopping(mut self, travel: f64) -> Self {
        self.mount = self.mount.map(|mount| MountConfig {
            stop: Some(StopConfig::rigid(travel)),
            ..mount
        });
        self
    }

    /// With an inner ring of this inertia (kg m^2) that nothing drags.
    pub fn turning(self, inertia: f64) -> Self {
        Self {
            race: Some(RaceConfig {
                inertia,
                dry_drag: 0.0,
                viscous_drag: 0.0,
                cage_ratio: 0.4,
                heat_capacity: 92.0,
                heat_loss: 0.0,
            }),
            ..self
        }
    }

    /// With drag on the inner ring: N m, and N m s.
    pub fn dragged(mut self, dry_drag: f64, viscous_drag: f64) -> Self {
        self.race = self.race.map(|race| RaceConfig {
            dry_drag,
            viscous_drag,
            ..race
        });
        self
    }

    /// Radius of the inner ring's bore, m.
    pub fn bore(&self) -> f64 {
        self.rigid.radius + self.rigid.clearance
    }

    /// On the wall, at an angle from the bottom (rad), moving along it (m/s).
    pub fn on_wall(self, angle: f64, tangential: f64) -> Self {
        Self {
            start: reference::Start::Wall { angle, tangential },
            ..self
        }
    }

    /// In the gap, from the centre of the ring.
    pub fn free(self, position: [f64; 2], velocity: [f64; 2]) -> Self {
        Self {
            start: reference::Start::Free { position, velocity },
            ..self
        }
    }

    /// Turning, rad/s.
    pub fn spinning(self, spin: f64) -> Self {
        Self { spin, ..self }
    }

    /// The whole run in `R`; `each` sees the start and the end of every step.
    ///
    /// # Panics
    /// If the configuration is not valid.
    pub fn follow<R: Precision>(&self, time: f64, mut each: impl FnMut(&Moment)) -> Vec<Told> {
        let model = self.built::<R>();
        let scales = *model.scales();
        let [length, speed, spin] = [scales.length, scales.speed, scales.spin].map(R::to_f64);
        let (position, velocity) = match self.start {
            reference::Start::Free { position, velocity } => {
                (position.map(|x| x / length), velocity.map(|v| v / speed))
            }
            reference::Start::Wall { angle, tangential } => (
                [angle.sin(), -angle.cos()],
                [angle.cos(), angle.sin()].map(|part| part * tangential / speed),
            ),
        };
        let start = Placement {
            position: position.map(R::lit),
            velocity: velocity.map(R::lit),
            ..Placement::default()
        };
        let step = self.rigid.step;
        let told = core::cell::RefCell::new(Vec::new());
        let on_event = |RingEvent { event: h, .. }: RingEvent<R>| {
            let at = (h.at.tick as f64 + h.at.fraction.to_f64()) * step;
            let change = match h.change {
                Change::Impact {
                    speed: into,
                    impulse,
                } => Change::Impact {
                    speed: into.to_f64() * speed,
                    impulse: impulse.to_f64() * speed,
                },
                Change::ContactStarts => Change::ContactStarts,
                Change::RollingStarts => Change::RollingStarts,
                Change::SlidingStarts => Change::SlidingStarts,
                Change::LiftsOff => Change::LiftsOff,
                Change::Released(_) => unreachable!("impacts take no time here"),
            };
            told.borrow_mut().push((at, change));
        };
        let mut state = model
            .start(&start, R::lit(self.spin / spin), on_event)
            .expect("valid start");
        each(&self.moment(&model, &state));
        for _ in 0..(time / step).round() as u64 {
            model.step(&mut state, on_event);
            each(&self.moment(&model, &state));
        }
        told.into_inner()
    }

    fn built<R: Precision>(&self) -> Coupled<R, 1, 1> {
        let mut config = CoupledConfig::of_plane(&self.rigid, [0.0]);
        (config.rings[0].mount, config.rings[0].race) = (self.mount, self.race);
        Coupled::try_new(&config).expect("valid configuration")
    }

    fn moment<R: Precision>(
        &self,
        model: &Coupled<R, 1, 1>,
        state: &CoupledState<R, 1, 1>,
    ) -> Moment {
        let scales = model.scales();
        let [length, speed, spin] = [scales.length, scales.speed, scales.spin].map(R::to_f64);
        let places = |x: [R; 2]| x.map(|x| x.to_f64() * length);
        let speeds = |v: [R; 2]| v.map(|v| v.to_f64() * speed);
        let newtons = |f: R| f.to_f64() * self.rigid.mass * speed * speed / length;
        let (seen, ring) = (model.kinematics_at(state, 0), model.ring(state, 0));
        let (energy, load) = (model.energy(state), model.load(state, 0));
        Moment {
            time: state.now().tick as f64 * self.rigid.step,
            position: places(seen.position),
            velocity: speeds(seen.velocity),
            spin: seen.spin.to_f64() * spin,
            displacement: places(model.displacement(state, 0)),
            ring: places(ring.position),
            ring_velocity: speeds(ring.velocity),
            stopped: ring.stopped,
            race: ring.race.map_or([0.0; 3], |race| {
                let [turn, cage] = [race.spin, race.cage].map(|w| w.to_f64() * spin);
                [turn, cage, race.temperature.to_f64()]
            }),
            touch: seen.touch,
            turns: seen.turns.0 as f64 + seen.turns.1.to_f64() / core::f64::consts::TAU,
            energy: scaled(&energy.to_f64(), self.rigid.mass * speed * speed),
            load: Load {
                normal: newtons(load.normal),
                peak: newtons(load.peak),
                held_peak: newtons(load.held_peak),
            },
            shortened: state.shortened(),
        }
    }

    /// The state after `time`, and what happened on the way.
    pub fn end<R: Precision>(&self, time: f64) -> (Moment, Vec<Told>) {
        let mut last = None;
        let told = self.follow::<R>(time, |moment| last = Some(*moment));
        (last.expect("the start at least"), told)
    }

    /// Rotor and gap, for the reference.
    pub fn machine(&self) -> Machine {
        let rigid = &self.rigid;
        Machine {
            mass: rigid.mass,
            radius: rigid.radius,
            polar_inertia: rigid.polar_inertia,
            clearance: rigid.clearance,
            friction: rigid.friction,
            restitution: rigid.restitution,
            gravity: rigid.gravity,
        }
    }

    /// The same machine by the reference.
    pub fn reference(&self) -> CoupledReference {
        let rotor = self.machine();
        let mount = self.mount.map(|mount| touchdown_scene::Support {
            mass: mount.mass,
            stiffness: mount.stiffness,
            damping: mount.damping,
            vertical: None,
            friction: 0.0,
            stop: mount.stop,
        });
        let machine = CoupledMachine::level(&rotor, mount, self.race);
        let start = CoupledStart::level(&self.start, rotor.clearance);
        CoupledReference::new(&machine, &start, self.spin)
    }
}
