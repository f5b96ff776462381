//! Contact force and contact time of the rig: what the paper estimates before measuring.

use super::hertz::{Contact, force_constant, modulus, product_constant, time_constant};
use super::rig::{WIDE_GAP, fall_speed};
use super::row::Row;
use crate::scene::Scene;

/// Constant of (8) in print.
const PRINTED_FORCE: f64 = 0.814;
/// Constant of (9) in print.
const PRINTED_TIME: f64 = 4.252;
/// Of steel, Pa.
const YOUNG: f64 = 2.1e11;
/// Of steel.
const POISSON: f64 = 0.3;
/// Measured contact time in print, s.
pub const MEASURED: f64 = 0.2e-3;

/// The rows. Ours has to be measured on a run with contact force; the rigid rung has none.
pub fn rows(base: &Scene) -> Vec<Row> {
    let steel = modulus(YOUNG, POISSON);
    let whole = whole(base);
    let wide = wide(whole, base);
    let slow = Contact {
        speed: 0.02,
        ..wide
    };
    let (right_force, right_time) = (force_constant(), time_constant());
    let frequency = |contact: &Contact| 1.0 / contact.time(right_time);
    let by_print = 1.0 / wide.time(PRINTED_TIME);
    let unmeasured = "no run of ours: the rung rigid has no contact force";
    let rows = vec![
        Row::new("eq. (8), constant", "", right_force)
            .printed(PRINTED_FORCE)
            .note("(5/4)^(3/5) (4/(3 pi))^(2/5)"),
        Row::new("eq. (9), constant", "", right_time)
            .printed(PRINTED_TIME)
            .note("2 sqrt(pi) Gamma(7/5)/Gamma(9/10) (15 pi/16)^(2/5)"),
        Row::new("eq. (8) times (9), F0 T_c/(m V)", "", product_constant())
            .printed(PRINTED_FORCE * PRINTED_TIME)
            .note("the printed constants contradict each other"),
        Row::new("eq. (10), E_r steel on steel", "Pa", steel)
            .note("pi E/(2 (1 - nu^2)); right as printed"),
        Row::new("F0 of the rig, 0.3 mm", "N", whole.force(right_force))
            .printed(whole.force(PRINTED_FORCE))
            .note("3.42 kg after a fall through the gap; printed: eq. (8) with its constant"),
        Row::new("T_c of the rig, 0.3 mm", "s", whole.time(right_time))
            .printed(whole.time(PRINTED_TIME))
            .note("likewise, eq. (9)"),
        Row::new("f_c = 1/T_c of the rig, 0.75 mm", "Hz", frequency(&wide))
            .printed(3500.0)
            .note(&format!(
                "printed: higher than; {by_print:.0} Hz with the printed constant"
            )),
        Row::new("f_c at 0.02 m/s, 0.75 mm", "Hz", frequency(&slow))
            .printed(3500.0)
            .note("f_c goes with V^(1/5): slow impacts are below the printed bound"),
        Row::new(
            "T_c, half the mass, 0.3 mm",
            "s",
            half(whole).time(right_time),
        )
        .printed(MEASURED)
        .note("printed: measured at 3000 rpm; two bearings share the rotor"),
        Row::new(
            "T_c, half the mass, 0.75 mm",
            "s",
            half(wide).time(right_time),
        )
        .printed(MEASURED)
        .note("the same in the wider gap"),
        Row::new("1/(0.2 ms)", "Hz", 1.0 / MEASURED)
            .printed(5000.0)
            .note("right; a half sine of that length would belong to 2500 Hz"),
    ];
    rows.into_iter()
        .map(|row| match row.unit {
            "N" | "s" => row.note(unmeasured),
            _ => row,
        })
        .collect()
}

/// The rig's rotor after a fall through its gap.
pub fn whole(base: &Scene) -> Contact {
    Contact {
        mass: base.rotor.mass,
        radius: base.rotor.radius,
        clearance: base.retainer.clearance,
        modulus: modulus(YOUNG, POISSON),
        speed: fall_speed(base),
    }
}

/// The same in the wide gap.
pub fn wide(narrow: Contact, base: &Scene) -> Contact {
    let mut scene = base.clone();
    scene.retainer.clearance = WIDE_GAP;
    Contact {
        clearance: WIDE_GAP,
        speed: fall_speed(&scene),
        ..narrow
    }
}

/// Half the mass on each of two bearings.
pub fn half(whole: Contact) -> Contact {
    Contact {
        mass: 0.5 * whole.mass,
        ..whole
    }
}
