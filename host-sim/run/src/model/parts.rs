//! What rings, mounts and bearings the rungs `support`, `two-plane` and `coupled` have of a scene.

use touchdown_models::{MountConfig, RaceConfig, RingConfig, SeatConfig};

use touchdown_scene::{Fidelity, MODES, Ring, Scene, TwoPlane};

/// The rotor's ends, where the rung has them.
pub(super) fn ends(scene: &Scene) -> Option<&TwoPlane> {
    let has = scene.model.rung != Fidelity::Support;
    scene.two_plane.as_ref().filter(|_| has)
}

/// Bending modes that the rung has.
pub(super) fn modelled_modes(scene: &Scene) -> impl Iterator<Item = &touchdown_scene::Mode> {
    let has = scene.model.rung == Fidelity::Coupled;
    let modes = ends(scene).into_iter().flat_map(|it| &it.modes);
    modes.filter(move |_| has)
}

/// Each bending mode's displacement at a place.
pub(super) fn shape(scene: &Scene, place: f64) -> [f64; MODES] {
    let mut shape = [0.0; MODES];
    for (to, mode) in shape.iter_mut().zip(modelled_modes(scene)) {
        *to = mode.at(place);
    }
    shape
}

/// The retainer's rings with what the rung has of them.
pub(super) fn seats(scene: &Scene) -> Vec<SeatConfig<f64>> {
    let whole = Ring {
        name: String::new(),
        place: 0.0,
        radius: scene.rotor.radius,
        retainer: scene.retainer,
        support: scene.support,
        ball_bearing: scene.ball_bearing,
    };
    let rings = ends(scene).map_or(std::slice::from_ref(&whole), |it| &it.rings);
    let moves = scene.model.rung != Fidelity::TwoPlane;
    let seat = |ring: &Ring| SeatConfig {
        ring: RingConfig {
            place: ring.place,
            clearance: ring.retainer.clearance,
            radius: ring.radius,
            friction: ring.retainer.friction,
            restitution: ring.retainer.restitution,
        },
        mount: ring.support.as_ref().filter(|_| moves).map(mount),
        race: ring.ball_bearing.as_ref().filter(|_| moves).map(race),
        shape: shape(scene, ring.place),
    };
    rings.iter().map(seat).collect()
}

fn mount(support: &touchdown_scene::Support) -> MountConfig<f64> {
    MountConfig {
        mass: support.mass,
        stiffness: support.stiffness,
        damping: support.damping,
        travel: support.travel,
    }
}

fn race(bearing: &touchdown_scene::BallBearing) -> RaceConfig<f64> {
    RaceConfig {
        inertia: bearing.inertia,
        dry_drag: bearing.dry_drag,
        viscous_drag: bearing.viscous_drag,
        cage_ratio: bearing.cage_ratio,
        heat_capacity: bearing.heat_capacity,
        heat_loss: bearing.heat_loss,
    }
}
