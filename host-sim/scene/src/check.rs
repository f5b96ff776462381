//! From the file's units and names to a valid scene.

use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::Monitor;

use super::calibration::CalibrationTable;
use super::diagnostic::Diagnostic;
use super::faults::faults;
use super::file::{RunTable, SceneFile};
use super::machine::{rotor, start};
use super::materials::materials;
use super::model::model;
use super::outputs::auto;
use super::rule::{Keys, MICRO, MILLI, translate};
use super::scales;
use super::support::SupportTable;
use super::{
    BallBearing, Base, Fidelity, Retainer, Rotor, Run, Scene, Start, Support, TwoPlane, limits,
};
use crate::sensors::{SensorsConfig, Tachometers};
use touchdown_base::plain::Number;

pub(super) fn scene(name: &str, file: SceneFile) -> Result<Scene, Diagnostic> {
    let rotor = rotor(&file.rotor)?;
    let retainer = Retainer::from(&file.retainer);
    // The rings of a rotor that tilts are looked at below.
    let clearance = match file.two_plane {
        Some(_) => f64::INFINITY,
        None => retainer.clearance,
    };
    let start = start(&file.start, clearance)?;
    let run = run(&file.run)?;
    let support = file.support.as_ref().map(SupportTable::check).transpose()?;
    let ball_bearing = file.ball_bearing.as_ref().map(BallBearing::from);
    // Marks are seen on the ring of one plane only.
    let plane = ball_bearing.filter(|_| file.two_plane.is_none());
    let tachometers = plane.and_then(|it| it.tachometers(rotor.radius + retainer.clearance));
    let two_plane = two_plane(&file, &rotor, &retainer, &start, (support, ball_bearing))?;
    let compliant = compliant(&file, two_plane.as_ref(), ball_bearing)?;
    let needed = needed(&file, two_plane.as_ref(), compliant);
    let model = model(&file.model, &run, needed)?;
    let top = file.fidelity.as_deref();
    let auto = auto(top, &file.model, file.outputs.as_ref(), &model)?;
    let sensors = sensors(&file, tachometers)?;
    let faults = faults(&file.fault, &sensors, &run)?;
    let mut scene = Scene {
        name: name.to_owned(),
        title: file.title,
        source: file.source,
        rotor,
        retainer,
        stator_gap: file.stator.map(|it| MILLI * it.gap_mm),
        support,
        ball_bearing,
        two_plane,
        start,
        run,
        model,
        auto,
        materials: materials(file.materials.as_ref())?,
        sensors,
        faults,
        tuning: file.detector,
        guard: GuardConfig {
            alert: file.guard.alert,
            danger: file.guard.danger,
        },
        zones: zones(file.guard.zones)?,
    };
    let given = file.model.step_us.is_some();
    give_way(&mut scene, compliant)?;
    match scene.model.rung {
        Fidelity::Hertz => scene.model.step = step_in_contact(&scene, given)?,
        Fidelity::Coupled if !given => scene.model.step = resolved_step(&scene),
        _ => {}
    }
    // The core has the last word: what it refuses is a flaw of the key that the value came from.
    Monitor::try_new(&scene.monitor_config()).map_err(|error| translate(&error))?;
    Ok(scene)
}

/// With what was found of them, and those of the ball bearing.
fn sensors(
    file: &SceneFile,
    tachometers: Option<Tachometers>,
) -> Result<SensorsConfig, Diagnostic> {
    let calibration = file.calibration.as_ref().map(CalibrationTable::check);
    let sensors = SensorsConfig {
        calibration: calibration.transpose()?,
        tachometers,
        ..file.sensors
    };
    sensors.check().map_err(|error| translate(&error))?;
    Ok(sensors)
}

/// The step of a contact that takes time: as asked for if that is stable, else a whole part of a sample
/// that is accurate.
pub(super) fn step_in_contact(scene: &Scene, given: bool) -> Result<f64, Diagnostic> {
    let compliance = scales::compliance(scene).map_err(|error| translate(&error))?;
    let step = scene.model.step;
    if !given {
        return Ok(step / (step / compliance.accurate_step()).ceil());
    }
    let longest = compliance.longest_step();
    if step > longest {
        let [longest, step] = [longest, step].map(|it| Number(it / MICRO));
        let rule = format!(
            "step_us must be no more than {longest:.4}, the limit of stability 2/omega_c of this contact, is {step}"
        );
        return Err(Diagnostic::new("model", "step_us", rule));
    }
    Ok(step)
}

/// Of fidelity `coupled`: a whole part of a sample that follows the fastest motion and short bounces, as far as
/// the run has no more steps than it can pay.
fn resolved_step(scene: &Scene) -> f64 {
    let machine = scene.two_plane.as_ref();
    let fastest = machine.map_or(0.0, |it| it.fastest(scene.rotor.spin));
    let wanted = (limits::ANGLE_OF_STEP / fastest).min(limits::RESOLVED);
    let wanted = wanted.min(scales::accurate_step(scene));
    let least = (scene.run.duration / limits::STEPS).max(MICRO);
    let sample = scene.model.step;
    let parts = (sample / wanted).ceil().min((sample / least).floor());
    sample / parts.max(1.0)
}

/// Upper ends of the zones A, B and C.
fn zones(zones: [f64; 3]) -> Result<[f64; 3], Diagnostic> {
    let [a, b, c] = zones;
    if 0.0 < a && a < b && b < c && c <= 1.0 {
        return Ok(zones);
    }
    let rule = "zones must be three parts of the clearance, each above the one before, to 1";
    Err(Diagnostic::new("guard", "zones", rule))
}

const RUN: Keys = Keys("run");
/// m/s^2.
const STANDARD_GRAVITY: f64 = 9.81;
/// Hz.
const USUAL_RATE: f64 = 20_000.0;

fn run(table: &RunTable) -> Result<Run, Diagnostic> {
    let duration = table.duration_s;
    if duration > 86_400.0 {
        let duration = Number(duration);
        let rule = format!("duration_s must be no more than 86400, is {duration}");
        return Err(RUN.broken("duration_s", rule));
    }
    let gravity = gravity(table.gravity_m_s2.unwrap_or(STANDARD_GRAVITY))?;
    let across = gravity * table.inclination_deg.to_radians().cos();
    // A vertical axis leaves rounding only.
    let pulls = across >= limits::LEAST_GRAVITY_M_S2;
    let gravity = if pulls { across } else { 0.0 };
    Ok(Run {
        duration,
        gravity,
        sample_rate: table.sample_rate_hz.unwrap_or(USUAL_RATE),
        seed: table.seed.unwrap_or(1),
    })
}

/// Gravity, m/s^2, within its limits: too little is none.
pub fn gravity(gravity: f64) -> Result<f64, Diagnostic> {
    if gravity > 0.0 && gravity < limits::LEAST_GRAVITY_M_S2 {
        let [least, is] = [limits::LEAST_GRAVITY_M_S2, gravity].map(Number);
        let rule = format!("gravity_m_s2 must be 0, or {least} or more, is {is}");
        return Err(RUN.broken("gravity_m_s2", rule));
    }
    Ok(gravity)
}

/// Whether contacts are to have a force and a duration; what only such have must not stand without it.
fn compliant(
    file: &SceneFile,
    two_plane: Option<&TwoPlane>,
    ball_bearing: Option<BallBearing>,
) -> Result<bool, Diagnostic> {
    const KEYS: Keys = Keys("model");
    let names = ["restitution", "compliant"];
    let contact = KEYS.named_or("contact", &file.model.contact, names[0], &names)?;
    let compliant = contact == names[1];
    if compliant && two_plane.is_none() {
        let rule =
            "contact = \"compliant\" needs [two_plane]: in the plane rung = \"hertz\" is that";
        return Err(KEYS.broken("contact", rule));
    }
    let rings = two_plane.iter().flat_map(|it| &it.rings);
    let mut bearings = rings.filter_map(|it| it.ball_bearing).chain(ball_bearing);
    if !compliant && bearings.any(|it| it.stiffness.is_some()) {
        let rule = "stiffness_n_m of balls is that of [model] contact = \"compliant\"";
        return Err(Keys("ball_bearing").broken("stiffness_n_m", rule));
    }
    Ok(compliant)
}

/// Makes the walls of all rings give way, where they are to.
fn give_way(scene: &mut Scene, compliant: bool) -> Result<(), Diagnostic> {
    let Some(mut machine) = scene.two_plane.take_if(|_| compliant) else {
        return Ok(());
    };
    for k in 0..machine.rings.len() {
        let wall = scales::wall(scene, &machine, &machine.rings[k]);
        machine.rings[k].wall = Some(wall.map_err(|error| translate(&error))?);
    }
    scene.two_plane = Some(machine);
    Ok(())
}

/// The lowest rung that has all parts of the machine.
fn needed(file: &SceneFile, two_plane: Option<&TwoPlane>, compliant: bool) -> Fidelity {
    match two_plane {
        Some(machine) if compliant || machine.is_coupled() => Fidelity::Coupled,
        Some(_) => Fidelity::TwoPlane,
        None if file.support.is_some() || file.ball_bearing.is_some() => Fidelity::Support,
        None => Fidelity::Rigid,
    }
}

fn two_plane(
    file: &SceneFile,
    rotor: &Rotor,
    retainer: &Retainer,
    start: &Start,
    (support, ball_bearing): (Option<Support>, Option<BallBearing>),
) -> Result<Option<TwoPlane>, Diagnostic> {
    let Some(table) = &file.two_plane else {
        let without = [
            ("ring", "z_mm", file.ring.len()),
            ("magnet", "z_mm", file.magnet.len()),
            ("mode", "frequency_hz", file.mode.len()),
        ];
        if file.base.is_some() {
            let rule = "[base] needs [two_plane]";
            return Err(Diagnostic::new("base", "frequency_hz", rule));
        }
        return match without.iter().find(|(_, _, count)| *count > 0) {
            Some((table, key, _)) => {
                let rule = format!("[[{table}]] needs [two_plane]");
                Err(Diagnostic::new(table, key, rule))
            }
            None => Ok(None),
        };
    };
    let (rings, magnets, modes) = (&file.ring, &file.magnet, &file.mode);
    let mut two_plane = table.check(rotor, retainer, rings, magnets, modes)?;
    two_plane.base = file.base.as_ref().map(Base::from);
    for ring in &mut two_plane.rings {
        ring.support = ring.support.or(support);
        ring.ball_bearing = ring.ball_bearing.or(ball_bearing);
    }
    two_plane.check_start(start)?;
    Ok(Some(two_plane))
}
