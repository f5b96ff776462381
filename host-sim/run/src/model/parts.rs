//! What rings, mounts and bearings the rungs `support`, `two-plane` and `coupled` have of a scene.

use touchdown_models::{MountConfig, RingConfig};

use touchdown_scene::{Fidelity, MODES, Magnet, Mode, Removable, Ring, Scene, TwoPlane};

/// The rotor's ends, where the rung has them.
pub(super) fn ends(scene: &Scene) -> Option<&TwoPlane> {
    let has = scene.model.rung != Fidelity::Support;
    scene.two_plane.as_ref().filter(|_| has)
}

/// Bending modes that the rung has.
pub(super) fn modelled_modes(scene: &Scene) -> impl Iterator<Item = &Mode> {
    let has = scene.model.rung == Fidelity::Coupled && scene.model.has(Removable::Bending);
    let modes = ends(scene).into_iter().flat_map(|it| &it.modes);
    modes.filter(move |_| has)
}

/// Magnets that it has.
pub(super) fn modelled_magnets(scene: &Scene) -> impl Iterator<Item = &Magnet> {
    let magnets = ends(scene).into_iter().flat_map(|it| &it.magnets);
    magnets.filter(|_| scene.model.has(Removable::Magnets))
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
pub(super) fn seats(scene: &Scene) -> Vec<RingConfig> {
    let whole = Ring::of_plane(scene);
    let rings = ends(scene).map_or(std::slice::from_ref(&whole), |it| &it.rings);
    let turns = Removable::BallBearing;
    let has = |part| scene.model.rung != Fidelity::TwoPlane && scene.model.has(part);
    let has_walls = scene.model.rung == Fidelity::Coupled;
    let seat = |ring: &Ring| RingConfig {
        place: ring.place,
        clearance: ring.retainer.clearance,
        radius: ring.radius,
        friction: ring.retainer.friction,
        restitution: ring.retainer.restitution,
        compliant: ring.wall.filter(|_| has_walls).map(|it| it.law),
        mount: ring
            .support
            .filter(|_| has(Removable::Mount))
            .map(|it| MountConfig {
                stop: it.stop.filter(|_| has(Removable::Stop)),
                ..it
            }),
        race: ring.ball_bearing.filter(|_| has(turns)).map(|it| it.race),
        shape: shape(scene, ring.place),
    };
    rings.iter().map(seat).collect()
}
