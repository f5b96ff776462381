//! The parts of a machine: which of them a scene has, and which its rung models.

use super::{Fidelity, Scene};

/// A part of the machine or of its physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// For people.
    pub name: &'static str,
    /// Whether the scene's rung has it.
    pub modelled: bool,
    /// Whether the scene asks for it.
    pub asked: bool,
    /// Why it is in or out.
    pub reason: &'static str,
}

/// Name of the part that bounds whirl.
pub const SPRING: &str = "retainer's mass, spring, damper";

/// All parts, in the order of the ladder.
pub fn parts(scene: &Scene) -> Vec<Part> {
    let rung = scene.model.rung;
    let rings = || scene.two_plane.iter().flat_map(|it| &it.rings);
    let support = rings().find_map(|it| it.support.as_ref());
    let support = scene.support.as_ref().or(support);
    let bearing = rings().find_map(|it| it.ball_bearing.as_ref());
    let bearing = scene.ball_bearing.as_ref().or(bearing);
    let two_plane = scene.two_plane.as_ref();
    let laws = match rung {
        Fidelity::Hertz => "as losses of a contact that takes time",
        _ => "the laws that all rungs share",
    };
    let mut parts = vec![
        Part {
            name: "gap, restitution, friction, spin",
            modelled: true,
            asked: true,
            reason: laws,
        },
        Part {
            name: "contact force and its duration",
            modelled: rung == Fidelity::Hertz,
            asked: false,
            reason: if rung == Fidelity::Hertz {
                "rung hertz is asked for"
            } else {
                "rung hertz has them"
            },
        },
    ];
    let mut part = |name, asked: bool, needs: Fidelity, given, absent| {
        let modelled = asked && (rung == needs || rung == Fidelity::Coupled);
        let reason = match (asked, modelled) {
            (_, true) => given,
            (true, false) => match needs {
                Fidelity::Support => "given, but only rung support has it",
                Fidelity::Coupled => "given, but only rung coupled has it",
                _ => "given, but only rung two-plane has it",
            },
            (false, _) => absent,
        };
        parts.push(Part {
            name,
            modelled,
            asked,
            reason,
        });
    };
    let s = Fidelity::Support;
    part(
        SPRING,
        support.is_some(),
        s,
        "[support] is given",
        "no [support]",
    );
    part(
        "hard stop of the retainer",
        support.is_some_and(|it| it.travel.is_some()),
        s,
        "travel_mm is given",
        "no travel_mm in [support]",
    );
    part(
        "inner ring, cage, drag, heat",
        bearing.is_some(),
        s,
        "[ball_bearing] is given",
        "no [ball_bearing]",
    );
    let t = Fidelity::TwoPlane;
    part(
        "tilt, gyroscopic effect, both ends",
        two_plane.is_some(),
        t,
        "[two_plane] is given",
        "no [two_plane]",
    );
    part(
        "unbalance",
        two_plane.is_some_and(|it| it.unbalance[0] > 0.0 || it.skew[0] > 0.0),
        t,
        "unbalance_g_mm or skew_mrad is given",
        "none given",
    );
    part(
        "magnetic force that is left",
        two_plane.is_some_and(|it| !it.magnets.is_empty()),
        t,
        "[[magnet]] is given",
        "no [[magnet]]",
    );
    let c = Fidelity::Coupled;
    part(
        "bending of the shaft",
        two_plane.is_some_and(|it| !it.modes.is_empty()),
        c,
        "[[mode]] is given",
        "no [[mode]]",
    );
    part(
        "motion of the base",
        two_plane.is_some_and(|it| it.base.is_some()),
        c,
        "[base] is given",
        "no [base]",
    );
    parts.push(Part {
        name: "wear",
        modelled: false,
        asked: false,
        reason: "no rung has it",
    });
    parts
}

/// Of the scene's rung.
pub fn degrees_of_freedom(scene: &Scene) -> (usize, &'static str) {
    let (ring, race) = (scene.support.is_some(), scene.ball_bearing.is_some());
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
    scene.two_plane.as_ref().map_or(5, |machine| {
        let ring = |ring: &super::Ring| {
            2 * usize::from(ring.support.is_some()) + usize::from(ring.ball_bearing.is_some())
        };
        5 + 2 * machine.modes.len() + machine.rings.iter().map(ring).sum::<usize>()
    })
}
