//! A scene without one of its parts: what the machine would be if the model did not have it.

use super::parts::{Part, SPRING, parts};
use super::{BallBearing, Fidelity, Scene, Support};

/// Parts that the scene's rung has and that can be left out, in the order of [`parts`].
pub fn removable(scene: &Scene) -> Vec<Part> {
    let mut all = parts(scene);
    all.retain(|part| part.modelled && without(scene, part).is_some());
    all
}

/// The scene without `part`; `None` where every model has it.
pub fn without(scene: &Scene, part: &Part) -> Option<Scene> {
    let mut scene = scene.clone();
    match part.name {
        SPRING => supports(&mut scene, |_| None),
        "hard stop of the retainer" => {
            supports(&mut scene, |it| Some(Support { travel: None, ..it }))
        }
        "inner ring, cage, drag, heat" => {
            scene.ball_bearing = None;
            for ring in scene.two_plane.iter_mut().flat_map(|it| &mut it.rings) {
                ring.ball_bearing = None;
            }
        }
        "tilt, gyroscopic effect, both ends" => {
            let ends = scene.two_plane.take()?;
            let rings = || ends.rings.iter();
            scene.support = scene
                .support
                .or(together(rings().filter_map(|it| it.support)));
            let bearings = rings().filter_map(|it| it.ball_bearing);
            scene.ball_bearing = scene.ball_bearing.or(turning_together(bearings));
            scene.model.rung = Fidelity::Support;
        }
        "unbalance" => {
            let ends = scene.two_plane.as_mut()?;
            (ends.unbalance, ends.skew) = ([0.0; 2], [0.0; 2]);
        }
        "magnetic force that is left" => scene.two_plane.as_mut()?.magnets.clear(),
        "bending of the shaft" => scene.two_plane.as_mut()?.modes.clear(),
        "motion of the base" => scene.two_plane.as_mut()?.base = None,
        _ => return None,
    }
    Some(scene)
}

/// Changes every support.
fn supports(scene: &mut Scene, change: impl Fn(Support) -> Option<Support>) {
    scene.support = scene.support.and_then(&change);
    for ring in scene.two_plane.iter_mut().flat_map(|it| &mut it.rings) {
        ring.support = ring.support.and_then(&change);
    }
}

/// Side by side, as a rotor that does not tilt has them.
fn together(supports: impl Iterator<Item = Support>) -> Option<Support> {
    supports.reduce(|a, b| Support {
        mass: a.mass + b.mass,
        stiffness: a.stiffness + b.stiffness,
        damping: a.damping + b.damping,
        travel: match (a.travel, b.travel) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        },
    })
}

/// Likewise.
fn turning_together(bearings: impl Iterator<Item = BallBearing>) -> Option<BallBearing> {
    bearings.reduce(|a, b| BallBearing {
        inertia: a.inertia + b.inertia,
        dry_drag: a.dry_drag + b.dry_drag,
        viscous_drag: a.viscous_drag + b.viscous_drag,
        heat_capacity: a.heat_capacity + b.heat_capacity,
        heat_loss: a.heat_loss + b.heat_loss,
        ..a
    })
}
