//! The parts of a machine: which of them a scene has, and which its rung models.

use super::model::Removable;
use super::{Fidelity, Scene, TwoPlane};

/// A part of the machine or of its physics.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// For people.
    pub name: &'static str,
    /// None where every model has it, or none can.
    pub removable: Option<Removable>,
    /// Whether the scene's rung has it.
    pub modelled: bool,
    /// Whether the scene asks for it.
    pub asked: bool,
    /// Why it is in or out.
    pub reason: String,
}

/// All parts, in the order of the ladder.
pub fn parts(scene: &Scene) -> Vec<Part> {
    let rung = scene.model.rung;
    let rings = || scene.rings().iter();
    let support = rings().find_map(|it| it.support.as_ref());
    let support = scene.support.as_ref().or(support);
    let bearing = rings().find_map(|it| it.ball_bearing.as_ref());
    let bearing = scene.ball_bearing.as_ref().or(bearing);
    let two_plane = scene.two_plane.as_ref();
    let fixed = |name, modelled, asked, reason: &str| Part {
        name,
        removable: None,
        modelled,
        asked,
        reason: reason.to_owned(),
    };
    let (takes_time, laws, force) = contact(scene);
    let mut parts = vec![
        fixed("gap, restitution, friction, spin", true, true, laws),
        fixed("contact force and its duration", takes_time, false, force),
    ];
    let mut part = |removable: Removable, asked: bool, needs: Fidelity, key: &str| {
        let has = scene.model.has(removable);
        let modelled = asked && has && (rung == needs || rung == Fidelity::Coupled);
        parts.push(Part {
            name: removable.into(),
            removable: Some(removable),
            modelled,
            asked,
            reason: match (asked, modelled) {
                (_, true) => format!("{key} is given"),
                (true, _) if !has => "given, but not needed for what is asked".to_owned(),
                (true, false) => format!("given, but only rung {needs} has it"),
                (false, _) => format!("no {key}"),
            },
        });
    };
    use Removable::{BallBearing, Base, Bending, Magnets, Mount, Stop, Tilt, Unbalance};
    let (s, t, c) = (Fidelity::Support, Fidelity::TwoPlane, Fidelity::Coupled);
    let stop = support.is_some_and(|it| it.stop.is_some());
    let is = |of: fn(&TwoPlane) -> bool| two_plane.is_some_and(of);
    let turns = is(|it| it.unbalance.eccentricity > 0.0 || it.unbalance.skew > 0.0);
    part(Mount, support.is_some(), s, "[support]");
    part(Stop, stop, s, "travel_mm");
    part(BallBearing, bearing.is_some(), s, "[ball_bearing]");
    part(Tilt, two_plane.is_some(), t, "[two_plane]");
    part(Unbalance, turns, t, "unbalance_g_mm or skew_mrad");
    part(Magnets, is(|it| !it.magnets.is_empty()), t, "[[magnet]]");
    part(Bending, is(|it| !it.modes.is_empty()), c, "[[mode]]");
    part(Base, is(|it| it.base.is_some()), c, "[base]");
    parts.push(fixed("wear", false, false, "no rung has it"));
    parts
}

/// Whether a contact takes time, and why all laws and its force are in or out.
fn contact(scene: &Scene) -> (bool, &'static str, &'static str) {
    let in_time = "as losses of a contact that takes time";
    let gives_way = scene.rings().iter().any(|it| it.wall.is_some());
    match scene.model.rung {
        Fidelity::Hertz => (true, in_time, "rung hertz is asked for"),
        Fidelity::Coupled if gives_way => (true, in_time, "contact = \"compliant\" is given"),
        _ => (
            false,
            "the laws that all rungs share",
            "rung hertz has them, and contact = \"compliant\"",
        ),
    }
}

/// Parts that the scene's model has and can do without.
pub fn removable(scene: &Scene) -> Vec<Removable> {
    let modelled = parts(scene).into_iter().filter(|part| part.modelled);
    modelled.filter_map(|part| part.removable).collect()
}

/// Of the scene's rung.
pub fn degrees_of_freedom(scene: &Scene) -> (usize, &'static str) {
    let has = removable(scene);
    let [ring, race] = [Removable::Mount, Removable::BallBearing].map(|it| has.contains(&it));
    match scene.model.rung {
        Fidelity::Rigid | Fidelity::Moreau | Fidelity::Hertz => (3, "x, y, spin"),
        Fidelity::TwoPlane => (5, "x, y, two tilts, spin"),
        Fidelity::Coupled => (
            coupled(scene),
            "x, y, two tilts, spin; x, y of modes and rings; inner rings' spin",
        ),
        Fidelity::Support => match (ring, race) {
            (false, false) => (3, "x, y, spin"),
            (true, false) => (5, "x, y, spin; ring x, y"),
            (false, true) => (4, "x, y, spin; inner ring's spin"),
            (true, true) => (6, "x, y, spin; ring x, y; inner ring's spin"),
        },
    }
}

fn coupled(scene: &Scene) -> usize {
    let count = |part, of: usize| if scene.model.has(part) { of } else { 0 };
    scene.two_plane.as_ref().map_or(5, |machine| {
        let mounts = machine.rings.iter().filter(|it| it.support.is_some());
        let races = machine.rings.iter().filter(|it| it.ball_bearing.is_some());
        5 + count(Removable::Bending, 2 * machine.modes.len())
            + count(Removable::Mount, 2 * mounts.count())
            + count(Removable::BallBearing, races.count())
    })
}
