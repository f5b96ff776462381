//! The machine of a scene, followed by the reference that has all its parts.

use touchdown_scene::sensors::{Motion, PLANES};

use super::{Units, press};
use crate::reference::Reference;
use crate::reference::coupled::{
    CoupledMachine, CoupledReference, CoupledStart, CoupledState, Retainer, RingState,
};
use crate::reference::press::Press;
use touchdown_base::history::{ModelEvent, PhaseKind, Recorder, RotorState};
use touchdown_base::rings::{Histories, Merge};
use touchdown_scene::{RINGS, Scene, Start, TwoPlane};

/// Part of the speed scale below which a rotor in contact is at rest.
const STILL: f64 = 1e-9;

/// What moves besides the rotor's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moving {
    /// Nothing.
    Nothing,
    /// The retainer ring.
    Ring {
        /// From its rest place, m.
        position: [f64; 2],
        /// Spin of the inner ring, rad/s.
        race_spin: f64,
        /// Turned by it since the release, rad.
        race_angle: f64,
    },
    /// The rotor's ends: displacement in each ring, m.
    Ends([[f64; 2]; RINGS]),
}

/// The machine at one moment, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueState {
    /// The rotor; its centre of mass, where it tilts.
    pub rotor: RotorState,
    /// Of the rotor as a whole.
    pub phase: PhaseKind,
    /// Displacement at the sensors' planes, m.
    pub sensed: [[f64; 2]; PLANES],
    /// The rest.
    pub moving: Moving,
}

impl TrueState {
    /// For the sensors; no ring with marks is told of.
    pub fn motion(&self, levitated: bool) -> Motion {
        Motion {
            planes: self.sensed,
            spin: self.rotor.spin,
            levitated,
            bearing: None,
        }
    }
}

enum Source {
    Planar(Box<Reference>),
    Coupled(Box<CoupledReference>),
}

/// A drop of a scene's machine, followed from its release.
pub struct Truth<'a> {
    scene: &'a Scene,
    source: Source,
    merge: Merge,
    whole: Recorder,
    rings: Vec<Recorder>,
}

impl<'a> Truth<'a> {
    /// At the release.
    pub fn new(scene: &'a Scene) -> Self {
        Self::of(scene, source(scene))
    }

    /// By the reference that has all parts, to another accuracy: the size of the last terms of its series.
    pub fn to_accuracy(scene: &'a Scene, accuracy: f64) -> Self {
        let mut reference = coupled(scene);
        reference.set_accuracy(accuracy);
        Self::of(scene, Source::Coupled(Box::new(reference)))
    }

    fn of(scene: &'a Scene, source: Source) -> Self {
        let rings = scene.rings().len();
        let recorder = Recorder::new(-scene.first_sample_time());
        Self {
            scene,
            source,
            merge: Merge::new(rings.max(1)),
            whole: recorder.clone(),
            rings: vec![recorder; rings],
        }
    }

    /// The machine at `time` (s since the release; times must not decrease). Before the release it is
    /// held at the start.
    pub fn advance(&mut self, time: f64) -> TrueState {
        if time < 0.0 {
            return held(self.scene, time);
        }
        let (rotor, sensed, moving) = match &mut self.source {
            Source::Planar(reference) => {
                let whole = &mut self.whole;
                let state = reference.advance(time, &mut |happening| whole.take(happening));
                (state, [state.position; PLANES], Moving::Nothing)
            }
            Source::Coupled(reference) => {
                let (whole, rings, merge) = (&mut self.whole, &mut self.rings, &mut self.merge);
                let contacts = rings.len().max(1);
                let state = reference.advance(time, &mut |contact, happening: ModelEvent| {
                    if let Some(ring) = rings.get_mut(contact) {
                        ring.take(happening);
                    } else if contact >= contacts {
                        // A ring at its stop is no matter of the rotor.
                        return;
                    }
                    if let Some(happening) = merge.take(contact, happening) {
                        whole.take(happening);
                    }
                });
                of_machine(self.scene.two_plane.as_ref(), &state)
            }
        };
        TrueState {
            rotor,
            phase: self.whole.phase(),
            sensed,
            moving,
        }
    }

    /// When it was given up, s: it would take too long. It stays there.
    pub fn given_up(&self) -> Option<f64> {
        match &self.source {
            Source::Planar(_) => None,
            Source::Coupled(reference) => reference.given_up(),
        }
    }

    /// Goes on to the end of the run, or to where it is given up.
    pub fn finish(mut self) -> Histories {
        let duration = self.scene.run.duration;
        let end = self.advance(duration).rotor;
        let (still, ends) = match &mut self.source {
            Source::Planar(reference) => (reference.still_speed(), Vec::new()),
            Source::Coupled(reference) => {
                let state = reference.advance(duration, &mut |_, _| ());
                let rings = state.rings.iter().zip(&state.turns_in_contact);
                let end = |(ring, turns): (&RingState, &f64)| RotorState {
                    time: duration,
                    position: ring.displacement,
                    velocity: ring.displacement_rate,
                    spin: state.spin,
                    turns_in_contact: *turns,
                };
                let still = STILL * Units::of(self.scene).speed;
                (still, rings.map(end).collect())
            }
        };
        let rings = self.rings.into_iter().zip(ends);
        Histories {
            whole: self.whole.finish(end, still),
            rings: rings.map(|(ring, end)| ring.finish(end, still)).collect(),
        }
    }
}

fn source(scene: &Scene) -> Source {
    if let (None, None, None) = (&scene.two_plane, scene.support, scene.ball_bearing) {
        let reference = Reference::new(&scene.machine(), &scene.start, scene.rotor.spin);
        return Source::Planar(Box::new(reference));
    }
    Source::Coupled(Box::new(coupled(scene)))
}

fn coupled(scene: &Scene) -> CoupledReference {
    let machine = match &scene.two_plane {
        Some(machine) => tilting(scene, machine),
        None => {
            let race = scene.ball_bearing.map(|it| it.race);
            CoupledMachine::level(&scene.machine(), scene.support, race)
        }
    };
    let tilted = scene.two_plane.as_ref();
    let start = CoupledStart {
        tilt: tilted.map_or([0.0; 2], |it| it.tilt),
        tilt_rate: tilted.map_or([0.0; 2], |it| it.tilt_rate),
        ..CoupledStart::level(&scene.start, scene.retainer.clearance)
    };
    CoupledReference::new(&machine, &start, scene.rotor.spin)
}

fn tilting(scene: &Scene, machine: &TwoPlane) -> CoupledMachine {
    let retainer = |it: &touchdown_scene::Ring| Retainer {
        place: it.place,
        radius: it.radius,
        clearance: it.retainer.clearance,
        friction: it.retainer.friction,
        restitution: it.retainer.restitution,
        mount: it.support,
        race: it.ball_bearing.map(|it| it.race),
        press: it.wall.map(|wall| Press {
            balls: wall.law.balls,
            slowest: wall.law.slowest,
            ..press(
                scene,
                [it.radius, it.retainer.clearance],
                wall.law.stiffness,
            )
        }),
    };
    let (sin, cos) = machine.gravity_angle.sin_cos();
    CoupledMachine {
        mass: scene.rotor.mass,
        polar_inertia: scene.rotor.polar_inertia,
        transverse_inertia: machine.transverse_inertia,
        gravity: [scene.run.gravity * sin, -scene.run.gravity * cos],
        retainers: machine.rings.iter().map(retainer).collect(),
        unbalance: machine.unbalance,
        magnets: machine.magnets.clone(),
        bending: machine.modes.clone(),
        base: machine.base,
    }
}

/// By the magnetic bearings, before the release.
pub fn held(scene: &Scene, time: f64) -> TrueState {
    let position = match scene.start {
        Start::Free { position, .. } => position,
        Start::Wall { .. } => [0.0; 2],
    };
    let at = |tilting: &TwoPlane, place| TwoPlane::at(position, tilting.tilt, place);
    TrueState {
        rotor: RotorState {
            time,
            position,
            spin: scene.rotor.spin,
            ..RotorState::default()
        },
        phase: PhaseKind::Levitated,
        sensed: scene.two_plane.as_ref().map_or([position; PLANES], |it| {
            it.sensors.map(|place| at(it, place))
        }),
        moving: match (&scene.two_plane, scene.support, scene.ball_bearing) {
            (Some(it), ..) => in_rings(it.rings.iter().map(|ring| at(it, ring.place))),
            (None, None, None) => Moving::Nothing,
            _ => Moving::Ring {
                position: [0.0; 2],
                race_spin: 0.0,
                race_angle: 0.0,
            },
        },
    }
}

fn in_rings(of: impl Iterator<Item = [f64; 2]>) -> Moving {
    let mut ends = [[0.0; 2]; RINGS];
    for (end, displacement) in ends.iter_mut().zip(of) {
        *end = displacement;
    }
    Moving::Ends(ends)
}

fn of_machine(
    machine: Option<&TwoPlane>,
    state: &CoupledState,
) -> (RotorState, [[f64; 2]; PLANES], Moving) {
    let rings = state.rings.len();
    let most = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
    let turns = state.turns_in_contact.iter().take(rings).fold(0.0, most);
    let rotor = RotorState {
        time: state.time,
        position: state.position,
        velocity: state.velocity,
        spin: state.spin,
        turns_in_contact: turns,
    };
    let Some(machine) = machine else {
        let ring = state.rings[0];
        let moving = Moving::Ring {
            position: ring.position,
            race_spin: ring.race_spin,
            race_angle: ring.race_angle,
        };
        return (rotor, [state.position; PLANES], moving);
    };
    let sensed = machine.sensors.map(|place| {
        let shapes: Vec<f64> = machine.modes.iter().map(|mode| mode.at(place)).collect();
        state.displacement(place, &shapes)
    });
    let ends = state.rings.iter().map(|ring| ring.displacement);
    (rotor, sensed, in_rings(ends))
}
