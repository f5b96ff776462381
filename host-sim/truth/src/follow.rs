//! The machine of a scene, followed by the reference that has all its parts.

use touchdown_scene::sensors::PLANES;

use super::Units;
use crate::reference::Reference;
use crate::reference::coupled::{
    Bending, CoupledMachine, CoupledReference, CoupledStart, CoupledState, Magnet, Mount, Race,
    Retainer, Ring, SupportMachine, SupportReference, SupportStart, SupportState, TwoPlaneMachine,
    TwoPlaneReference, TwoPlaneStart, TwoPlaneState, Unbalance,
};
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

enum Source {
    Planar(Box<Reference>),
    Support(Box<SupportReference>),
    TwoPlane(Box<TwoPlaneReference>),
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
        let rings = scene.two_plane.as_ref().map_or(0, |it| it.rings.len());
        let recorder = Recorder::new(-scene.first_sample_time());
        Self {
            scene,
            source: source(scene),
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
            Source::Support(reference) => {
                let whole = &mut self.whole;
                // The ring at its stop is no matter of the rotor.
                let state = reference.advance(time, &mut |contact, happening| {
                    if contact == 0 {
                        whole.take(happening);
                    }
                });
                of_support(&state)
            }
            Source::TwoPlane(reference) => {
                let (whole, rings, merge) = (&mut self.whole, &mut self.rings, &mut self.merge);
                let state = reference.advance(time, &mut |ring, happening: ModelEvent| {
                    rings[ring].take(happening);
                    if let Some(happening) = merge.take(ring, happening) {
                        whole.take(happening);
                    }
                });
                of_ends(self.scene.two_plane.as_ref(), &state)
            }
            Source::Coupled(reference) => {
                let (whole, rings, merge) = (&mut self.whole, &mut self.rings, &mut self.merge);
                let state = reference.advance(time, &mut |contact, happening: ModelEvent| {
                    // A ring at its stop is no matter of the rotor.
                    let Some(ring) = rings.get_mut(contact) else {
                        return;
                    };
                    ring.take(happening);
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
            Source::Support(reference) => reference.given_up(),
            Source::TwoPlane(reference) => reference.given_up(),
            Source::Coupled(reference) => reference.given_up(),
        }
    }

    /// Goes on to the end of the run, or to where it is given up.
    pub fn finish(mut self) -> Histories {
        let duration = self.scene.run.duration;
        let end = self.advance(duration).rotor;
        let still = match &self.source {
            Source::Planar(reference) => reference.still_speed(),
            _ => STILL * Units::of(self.scene).speed,
        };
        let ends = match (&mut self.source, &self.scene.two_plane) {
            (Source::TwoPlane(reference), Some(machine)) => {
                let state = reference.advance(duration, &mut |_, _| ());
                let rings = machine.rings.iter().enumerate();
                rings
                    .map(|(index, ring)| RotorState {
                        time: duration,
                        position: state.displacement(ring.place),
                        velocity: state.displacement_rate(ring.place),
                        spin: state.spin,
                        turns_in_contact: state.turns_in_contact[index],
                    })
                    .collect()
            }
            (Source::Coupled(reference), Some(_)) => {
                let state = reference.advance(duration, &mut |_, _| ());
                let rings = state.rings.iter().zip(&state.turns_in_contact);
                rings
                    .map(|(ring, turns)| RotorState {
                        time: duration,
                        position: ring.displacement,
                        velocity: ring.displacement_rate,
                        spin: state.spin,
                        turns_in_contact: *turns,
                    })
                    .collect()
            }
            _ => Vec::new(),
        };
        let rings = self.rings.into_iter().zip(ends);
        Histories {
            whole: self.whole.finish(end, still),
            rings: rings.map(|(ring, end)| ring.finish(end, still)).collect(),
        }
    }
}

fn source(scene: &Scene) -> Source {
    let spin = scene.rotor.spin;
    if let Some(machine) = &scene.two_plane {
        return if machine.is_coupled() {
            Source::Coupled(Box::new(coupled(scene, machine)))
        } else {
            Source::TwoPlane(Box::new(two_plane(scene, machine)))
        };
    }
    if scene.support.is_none() && scene.ball_bearing.is_none() {
        let reference = Reference::new(&scene.machine(), &scene.start, spin);
        return Source::Planar(Box::new(reference));
    }
    let machine = SupportMachine {
        rotor: scene.machine(),
        mount: scene.support.as_ref().map(mount),
        race: scene.ball_bearing.as_ref().map(race),
    };
    let start = SupportStart::new(scene.start, spin);
    Source::Support(Box::new(SupportReference::new(&machine, &start)))
}

fn mount(support: &touchdown_scene::Support) -> Mount {
    Mount {
        mass: support.mass,
        stiffness: support.stiffness,
        damping: support.damping,
        travel: support.travel,
    }
}

fn race(bearing: &touchdown_scene::BallBearing) -> Race {
    Race {
        inertia: bearing.inertia,
        dry_drag: bearing.dry_drag,
        viscous_drag: bearing.viscous_drag,
    }
}

fn ring(ring: &touchdown_scene::Ring) -> Ring {
    Ring {
        place: ring.place,
        radius: ring.radius,
        clearance: ring.retainer.clearance,
        friction: ring.retainer.friction,
        restitution: ring.retainer.restitution,
    }
}

fn magnet(magnet: &touchdown_scene::Magnet) -> Magnet {
    Magnet {
        place: magnet.place,
        stiffness: magnet.stiffness,
        force: magnet.force,
    }
}

fn gravity(scene: &Scene, machine: &TwoPlane) -> [f64; 2] {
    let (sin, cos) = machine.gravity_angle.sin_cos();
    [scene.run.gravity * sin, -scene.run.gravity * cos]
}

fn unbalance(scene: &Scene, machine: &TwoPlane) -> Unbalance {
    Unbalance {
        eccentricity: machine.unbalance[0] / scene.rotor.mass,
        angle: machine.unbalance[1],
        skew: machine.skew[0],
        skew_angle: machine.skew[1],
    }
}

/// Position and velocity of the centre of mass.
fn centre(scene: &Scene) -> [[f64; 2]; 2] {
    match scene.start {
        Start::Free { position, velocity } => [position, velocity],
        // No valid scene of a rotor that tilts starts so.
        Start::Wall { .. } => [[0.0; 2]; 2],
    }
}

fn two_plane(scene: &Scene, machine: &TwoPlane) -> TwoPlaneReference {
    let [position, velocity] = centre(scene);
    TwoPlaneReference::new(
        &TwoPlaneMachine {
            mass: scene.rotor.mass,
            polar_inertia: scene.rotor.polar_inertia,
            transverse_inertia: machine.transverse_inertia,
            gravity: gravity(scene, machine),
            rings: machine.rings.iter().map(ring).collect(),
            unbalance: unbalance(scene, machine),
            magnets: machine.magnets.iter().map(magnet).collect(),
        },
        &TwoPlaneStart {
            position,
            velocity,
            tilt: machine.tilt,
            tilt_rate: machine.tilt_rate,
        },
        scene.rotor.spin,
    )
}

fn coupled(scene: &Scene, machine: &TwoPlane) -> CoupledReference {
    let [position, velocity] = centre(scene);
    let retainer = |it: &touchdown_scene::Ring| Retainer {
        ring: ring(it),
        mount: it.support.as_ref().map(mount),
        race: it.ball_bearing.as_ref().map(race),
    };
    let bending = |mode: &touchdown_scene::Mode| Bending {
        rate: mode.speed,
        damping_ratio: mode.damping_ratio,
        modal_mass: mode.mass,
        at_rings: machine.rings.iter().map(|it| mode.at(it.place)).collect(),
        at_magnets: machine.magnets.iter().map(|it| mode.at(it.place)).collect(),
        at_centre: mode.at(0.0),
    };
    let magnets = machine.magnets.iter().map(|it| (magnet(it), it.damping));
    CoupledReference::new(
        &CoupledMachine {
            mass: scene.rotor.mass,
            polar_inertia: scene.rotor.polar_inertia,
            transverse_inertia: machine.transverse_inertia,
            gravity: gravity(scene, machine),
            retainers: machine.rings.iter().map(retainer).collect(),
            unbalance: unbalance(scene, machine),
            magnets: magnets.collect(),
            bending: machine.modes.iter().map(bending).collect(),
        },
        &CoupledStart {
            position,
            velocity,
            tilt: machine.tilt,
            tilt_rate: machine.tilt_rate,
            ..CoupledStart::default()
        },
        scene.rotor.spin,
    )
}

/// By the magnetic bearings, before the release.
fn held(scene: &Scene, time: f64) -> TrueState {
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
            (Some(it), ..) => Moving::Ends(in_rings(it, |place| at(it, place))),
            (None, None, None) => Moving::Nothing,
            _ => Moving::Ring {
                position: [0.0; 2],
                race_spin: 0.0,
                race_angle: 0.0,
            },
        },
    }
}

fn in_rings(machine: &TwoPlane, at: impl Fn(f64) -> [f64; 2]) -> [[f64; 2]; RINGS] {
    let mut ends = [[0.0; 2]; RINGS];
    for (end, ring) in ends.iter_mut().zip(&machine.rings) {
        *end = at(ring.place);
    }
    ends
}

fn of_ends(
    machine: Option<&TwoPlane>,
    state: &TwoPlaneState,
) -> (RotorState, [[f64; 2]; PLANES], Moving) {
    let most = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
    let rotor = RotorState {
        time: state.time,
        position: state.position,
        velocity: state.velocity,
        spin: state.spin,
        turns_in_contact: state.turns_in_contact.iter().fold(0.0, most),
    };
    let Some(machine) = machine else {
        return (rotor, [state.position; PLANES], Moving::Nothing);
    };
    let at = |place| state.displacement(place);
    (
        rotor,
        machine.sensors.map(at),
        Moving::Ends(in_rings(machine, at)),
    )
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
    let sensed = machine.map_or([state.position; PLANES], |machine| {
        machine.sensors.map(|place| {
            let shapes: Vec<f64> = machine.modes.iter().map(|mode| mode.at(place)).collect();
            state.displacement(place, &shapes)
        })
    });
    let mut ends = [[0.0; 2]; RINGS];
    for (end, ring) in ends.iter_mut().zip(&state.rings) {
        *end = ring.displacement;
    }
    (rotor, sensed, Moving::Ends(ends))
}

fn of_support(state: &SupportState) -> (RotorState, [[f64; 2]; PLANES], Moving) {
    let rotor = RotorState {
        time: state.time,
        position: state.position,
        velocity: state.velocity,
        spin: state.spin,
        turns_in_contact: state.turns_in_contact,
    };
    let moving = Moving::Ring {
        position: state.ring_position,
        race_spin: state.race_spin,
        race_angle: state.race_angle,
    };
    (rotor, [state.position; PLANES], moving)
}
