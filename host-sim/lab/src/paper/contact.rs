//! Contact force and contact time of the rig: what the paper estimates before measuring.

use super::hertz::{Contact, force_constant, modulus, product_constant, time_constant};
use super::rig::{WIDE_GAP, fall_speed};
use super::row::Row;
use super::straight::{self, TOLERANCE};
use touchdown_base::failure::Failure;
use touchdown_scene::Scene;

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

/// The rows. Ours is the pulse of a run on rung `hertz`, which steps through the contact.
pub fn rows(base: &Scene) -> Result<Vec<Row>, Failure> {
    let steel = modulus(YOUNG, POISSON);
    let whole = whole(base);
    let wide = wide(whole, base);
    let speed = 0.02;
    let slow = Contact { speed, ..wide };
    let (right_force, right_time) = (force_constant(), time_constant());
    let by_print = 1.0 / wide.time(PRINTED_TIME);
    let run = straight::pulse(base, &whole)?;
    let product = run.peak_force * run.duration / (whole.mass * whole.speed);
    let by_force = (run.peak_force / whole.force(right_force)).powf(2.5) * steel;
    let time = |item: &str, contact: &Contact| -> Result<Row, Failure> {
        let duration = straight::pulse(base, contact)?.duration;
        Ok(Row::new(item, "s", contact.time(right_time)).near(duration, 1.0))
    };
    let frequency = |item: &str, contact: &Contact| -> Result<Row, Failure> {
        let frequency = 1.0 / straight::pulse(base, contact)?.duration;
        let right = 1.0 / contact.time(right_time);
        let row = Row::new(item, "Hz", right).near(frequency, 1.0);
        Ok(row.printed(3500.0))
    };
    Ok(vec![
        Row::new("eq. (8), constant", "", right_force)
            .near(run.peak_force / whole.force(1.0), 1.0)
        .printed(PRINTED_FORCE)
        .note("(5/4)^(3/5) (4/(3 pi))^(2/5); ours: F0 of a run over the rest of (8)"),
        Row::new("eq. (9), constant", "", right_time)
            .near(run.duration / whole.time(1.0), 1.0)
        .printed(PRINTED_TIME)
        .note(
            "2 sqrt(pi) Gamma(7/5)/Gamma(9/10) (15 pi/16)^(2/5); ours: T_c of a run over the rest of (9)",
        ),
        Row::new("eq. (8) times (9), F0 T_c/(m V)", "", product_constant())
            .near(product, 2.0)
        .printed(PRINTED_FORCE * PRINTED_TIME)
        .note("the printed constants contradict each other; ours: F0 and T_c of a run"),
        Row::new("eq. (10), E_r steel on steel", "Pa", steel)
            .near(by_force, 2.5)
            .note("pi E/(2 (1 - nu^2)), right as printed; ours: from F0 of a run by (8)"),
        Row::new("F0 of the rig, 0.3 mm", "N", whole.force(right_force))
            .near(run.peak_force, 1.0)
        .printed(whole.force(PRINTED_FORCE))
        .note("3.42 kg after a fall through the gap; printed: eq. (8) with its constant"),
        time("T_c of the rig, 0.3 mm", &whole)?
            .printed(whole.time(PRINTED_TIME))
            .note("likewise, eq. (9)"),
        frequency("f_c = 1/T_c of the rig, 0.75 mm", &wide)?.note(&format!(
            "printed: higher than; {by_print:.0} Hz with the printed constant"
        )),
        frequency("f_c at 0.02 m/s, 0.75 mm", &slow)?
            .note("f_c goes with V^(1/5): slow impacts are below the printed bound"),
        time("T_c, half the mass, 0.3 mm", &half(whole))?
            .printed(MEASURED)
            .note("printed: measured at 3000 rpm; two bearings share the rotor"),
        time("T_c, half the mass, 0.75 mm", &half(wide))?
            .printed(MEASURED)
            .note("the same in the wider gap"),
        Row::new("1/(0.2 ms)", "Hz", 1.0 / MEASURED)
            .printed(5000.0)
            .note("right; a half sine of that length would belong to 2500 Hz")
            .note("no run of ours: one printed number over the other"),
    ])
}

impl Row {
    /// With ours, as close as `power` times a run's force or time is.
    fn near(self, ours: f64, power: f64) -> Self {
        let tolerance = rounded(power * TOLERANCE * self.right);
        self.ours(ours, tolerance)
    }
}

/// To one digit, downwards.
fn rounded(value: f64) -> f64 {
    let digits = 10_f64.powi(-value.log10().floor() as i32);
    (value * digits).floor() / digits
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
    let mass = 0.5 * whole.mass;
    Contact { mass, ..whole }
}
