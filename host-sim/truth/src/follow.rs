//! The machine of a scene, followed by the reference that has all its parts.

use touchdown_scene::sensors::PLANES;

use super::Units;
use crate::reference::Reference;
use crate::reference::coupled::{
    Magnet, Mount, Race, Ring, SupportMachine, SupportReference, SupportStart, SupportState,
    TwoPlaneMachine, TwoPlaneReference, TwoPlaneStart, TwoPlaneState, Unbalance,
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
    /// No reference has all parts of the machine; whether it was asked for.
    None(bool),
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
            Source::None(asked) => {
                *asked = true;
                let held = held(self.scene, 0.0);
                (held.rotor, held.sensed, held.moving)
            }
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
            Source::None(asked) => asked.then_some(0.0),
            Source::Support(reference) => reference.given_up(),
            Source::TwoPlane(reference) => reference.given_up(),
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
            (Source::None(_), Some(machine)) => vec![end; machine.rings.len()],
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
    if scene.two_plane.as_ref().is_some_and(TwoPlane::is_coupled) {
        return Source::None(false);
    }
    if let Some(machine) = &scene.two_plane {
        return Source::TwoPlane(Box::new(two_plane(scene, machine)));
    }
    if scene.support.is_none() && scene.ball_bearing.is_none() {
        let reference = Reference::new(&scene.machine(), &scene.start, spin);
        return Source::Planar(Box::new(reference));
    }
    let machine = SupportMachine {
        rotor: scene.machine(),
        mount: scene.support.map(|support| Mount {
            mass: support.mass,
            stiffness: support.stiffness,
            damping: support.damping,
            travel: support.travel,
        }),
        race: scene.ball_bearing.map(|bearing| Race {
            inertia: bearing.inertia,
            dry_drag: bearing.dry_drag,
            viscous_drag: bearing.viscous_drag,
        }),
    };
    let start = SupportStart::new(scene.start, spin);
    Source::Support(Box::new(SupportReference::new(&machine, &start)))
}

fn two_plane(scene: &Scene, machine: &TwoPlane) -> TwoPlaneReference {
    let (sin, cos) = machine.gravity_angle.sin_cos();
    let ring = |ring: &touchdown_scene::Ring| Ring {
        place: ring.place,
        radius: ring.radius,
        clearance: ring.retainer.clearance,
        friction: ring.retainer.friction,
        restitution: ring.retainer.restitution,
    };
    let magnet = |magnet: &touchdown_scene::Magnet| Magnet {
        place: magnet.place,
        stiffness: magnet.stiffness,
        force: magnet.force,
    };
    let (position, velocity) = match scene.start {
        Start::Free { position, velocity } => (position, velocity),
        // No valid scene of a rotor that tilts starts so.
        Start::Wall { .. } => ([0.0; 2], [0.0; 2]),
    };
    TwoPlaneReference::new(
        &TwoPlaneMachine {
            mass: scene.rotor.mass,
            polar_inertia: scene.rotor.polar_inertia,
            transverse_inertia: machine.transverse_inertia,
            gravity: [scene.run.gravity * sin, -scene.run.gravity * cos],
            rings: machine.rings.iter().map(ring).collect(),
            unbalance: Unbalance {
                eccentricity: machine.unbalance[0] / scene.rotor.mass,
                angle: machine.unbalance[1],
                skew: machine.skew[0],
                skew_angle: machine.skew[1],
            },
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
