//! From the file's units and names to a valid scene.

use touchdown_core::error::ConfigError;
use touchdown_core::monitor::Monitor;

use super::auto::auto;
use super::contact::{materials, step_in_contact};
use super::file::{
    ModelTable, RetainerTable, RotorTable, RunTable, SceneFile, SensorsTable, StartTable,
};
use super::flaw::Flaw;
use super::limits;
use super::{Math, Model, Precision, Retainer, Rotor, Run, Rung, Scene, Scheme, Start};
use crate::sensors::SensorsConfig;

const RPM: f64 = std::f64::consts::TAU / 60.0;
pub(super) const MILLI: f64 = 1e-3;
pub(super) const MICRO: f64 = 1e-6;
/// How far outside the gap rounding may put a start on the wall, relative to the clearance.
const ON_THE_WALL: f64 = 1e-9;

pub(super) fn scene(name: &str, file: SceneFile) -> Result<Scene, Flaw> {
    let rotor = rotor(&file.rotor)?;
    let retainer = retainer(&file.retainer)?;
    let start = start(&file.start, &retainer)?;
    let run = run(&file.run)?;
    let model = model(&file.model, &run)?;
    let auto = auto(&file, &model)?;
    let materials = materials(&file.materials)?;
    let mut scene = Scene {
        name: name.to_owned(),
        title: file.title,
        source: file.source,
        rotor,
        retainer,
        start,
        run,
        model,
        auto,
        materials,
        sensors: sensors(&file.sensors)?,
        tuning: file.detector,
    };
    if scene.model.rung == Rung::Hertz {
        scene.model.step = step_in_contact(&scene, file.model.step_us.is_some())?;
    }
    monitor(&scene)?;
    Ok(scene)
}

pub(super) fn above_zero(table: &'static str, key: &'static str, value: f64) -> Result<f64, Flaw> {
    if value > 0.0 {
        return Ok(value);
    }
    Err(Flaw::new(
        table,
        key,
        format!("{key} must be above 0, is {value}"),
    ))
}

fn zero_or_more(table: &'static str, key: &'static str, value: f64) -> Result<f64, Flaw> {
    if value >= 0.0 {
        return Ok(value);
    }
    Err(Flaw::new(
        table,
        key,
        format!("{key} must be 0 or more, is {value}"),
    ))
}

pub(super) fn between(
    table: &'static str,
    key: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
) -> Result<f64, Flaw> {
    if range.contains(&value) {
        return Ok(value);
    }
    let (low, high) = range.into_inner();
    let rule = format!("{key} must be {low} to {high}, is {value}");
    Err(Flaw::new(table, key, rule))
}

fn rotor(table: &RotorTable) -> Result<Rotor, Flaw> {
    let mass = above_zero("rotor", "mass_kg", table.mass_kg)?;
    let mass = between("rotor", "mass_kg", mass, limits::MASS_KG)?;
    let radius = above_zero("rotor", "radius_mm", table.radius_mm)?;
    let radius = MILLI * between("rotor", "radius_mm", radius, limits::RADIUS_MM)?;
    let solid = 0.5 * mass * radius * radius;
    let polar_inertia = match table.polar_inertia_kg_m2 {
        Some(inertia) => {
            let inertia = above_zero("rotor", "polar_inertia_kg_m2", inertia)?;
            let ratio = inertia / solid;
            if !limits::INERTIA_RATIO.contains(&ratio) {
                let (low, high) = limits::INERTIA_RATIO.into_inner();
                let rule = format!(
                    "polar_inertia_kg_m2 must be {low} to {high} times that of a solid cylinder \
                     ({solid:.3e}), is {inertia}"
                );
                return Err(Flaw::new("rotor", "polar_inertia_kg_m2", rule));
            }
            inertia
        }
        None => solid,
    };
    let speed = between("rotor", "speed_rpm", table.speed_rpm, limits::SPEED_RPM)?;
    Ok(Rotor {
        mass,
        radius,
        polar_inertia,
        spin: RPM * speed,
    })
}

fn retainer(table: &RetainerTable) -> Result<Retainer, Flaw> {
    let clearance = above_zero("retainer", "clearance_mm", table.clearance_mm)?;
    let friction = zero_or_more("retainer", "friction", table.friction)?;
    Ok(Retainer {
        clearance: MILLI * between("retainer", "clearance_mm", clearance, limits::CLEARANCE_MM)?,
        friction: between("retainer", "friction", friction, limits::FRICTION)?,
        restitution: between("retainer", "restitution", table.restitution, 0.0..=1.0)?,
    })
}

fn start(table: &StartTable, retainer: &Retainer) -> Result<Start, Flaw> {
    let free = [
        ("x_mm", table.x_mm),
        ("y_mm", table.y_mm),
        ("vx_mm_s", table.vx_mm_s),
        ("vy_mm_s", table.vy_mm_s),
    ];
    let wall = [
        ("angle_deg", table.angle_deg),
        ("tangential_mm_s", table.tangential_mm_s),
    ];
    let first = |keys: &[(&'static str, Option<f64>)]| {
        keys.iter()
            .find(|(_, value)| value.is_some())
            .map(|(key, _)| *key)
    };
    if let Some(wall_key) = first(&wall) {
        if let Some(free_key) = first(&free) {
            let rule = format!(
                "{wall_key} starts the rotor on the wall, {free_key} starts it free: give one kind"
            );
            return Err(Flaw::new("start", wall_key, rule));
        }
        let angle = table.angle_deg.unwrap_or(0.0);
        let angle = between("start", "angle_deg", angle, limits::ANGLE_DEG)?;
        let speed = table.tangential_mm_s.unwrap_or(0.0);
        let speed = between("start", "tangential_mm_s", speed, limits::SPEED_MM_S)?;
        return Ok(Start::Wall {
            angle: angle.to_radians(),
            tangential: MILLI * speed,
        });
    }
    for (key, speed) in &free[2..] {
        between("start", key, speed.unwrap_or(0.0), limits::SPEED_MM_S)?;
    }
    let [x, y, vx, vy] = free.map(|(_, value)| MILLI * value.unwrap_or(0.0));
    let distance = x.hypot(y);
    if distance > retainer.clearance * (1.0 + ON_THE_WALL) {
        let key = if x.abs() > y.abs() { "x_mm" } else { "y_mm" };
        let rule = format!(
            "the start is outside the gap: {} mm from the centre, the clearance is {} mm",
            distance / MILLI,
            retainer.clearance / MILLI
        );
        return Err(Flaw::new("start", key, rule));
    }
    Ok(Start::Free {
        position: [x, y],
        velocity: [vx, vy],
    })
}

fn run(table: &RunTable) -> Result<Run, Flaw> {
    let duration = above_zero("run", "duration_s", table.duration_s)?;
    if duration > 86_400.0 {
        let rule = format!("duration_s must be no more than 86400, is {duration}");
        return Err(Flaw::new("run", "duration_s", rule));
    }
    let rate = table.sample_rate_hz;
    let gravity = zero_or_more("run", "gravity_m_s2", table.gravity_m_s2)?;
    if gravity > 0.0 && gravity < limits::LEAST_GRAVITY_M_S2 {
        let rule = format!(
            "gravity_m_s2 must be 0, or {:e} or more, is {gravity:e}",
            limits::LEAST_GRAVITY_M_S2
        );
        return Err(Flaw::new("run", "gravity_m_s2", rule));
    }
    Ok(Run {
        duration,
        gravity: between("run", "gravity_m_s2", gravity, limits::GRAVITY_M_S2)?,
        sample_rate: between("run", "sample_rate_hz", rate, 100.0..=200_000.0)?,
        seed: table.seed,
    })
}

fn model(table: &ModelTable, run: &Run) -> Result<Model, Flaw> {
    let rung = match table.rung.as_deref() {
        None => Rung::Rigid,
        Some(name) => named("model", "rung", name, &Rung::ALL, Rung::name)?,
    };
    let scheme = match table.scheme.as_deref() {
        None => rung.schemes()[0],
        Some(name) => named("model", "scheme", name, rung.schemes(), Scheme::name)?,
    };
    let precision = match table.precision.as_deref() {
        None => Precision::F64,
        Some(name) => named("model", "precision", name, &Precision::ALL, Precision::name)?,
    };
    let math = match table.math.as_deref() {
        None => Math::Libm,
        Some(name) => named("model", "math", name, precision.maths(), Math::name)?,
    };
    let step = match table.step_us {
        Some(step) => MICRO * between("model", "step_us", step, limits::STEP_US)?,
        None => (1.0 / run.sample_rate).clamp(MICRO, 1000.0 * MICRO),
    };
    Ok(Model {
        rung,
        scheme,
        precision,
        math,
        step,
    })
}

/// The one of `all` that has this name.
pub(super) fn named<T: Copy>(
    table: &'static str,
    key: &'static str,
    given: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> Result<T, Flaw> {
    all.iter()
        .copied()
        .find(|&item| name(item) == given)
        .ok_or_else(|| {
            let names: Vec<_> = all
                .iter()
                .map(|&item| format!("\"{}\"", name(item)))
                .collect();
            let rule = format!("{key} must be {}, is \"{given}\"", names.join(" or "));
            Flaw::new(table, key, rule)
        })
}

fn sensors(table: &SensorsTable) -> Result<SensorsConfig, Flaw> {
    let config = SensorsConfig {
        planes: table.planes,
        bits: table.bits,
        range: MICRO * table.range_um,
        noise: MICRO * table.noise_um,
        bandwidth: table.bandwidth_hz,
        mounting_angle: table.mounting_deg.map(f64::to_radians),
        offset: table.offset_um.map(|offset| MICRO * offset),
        gain_error: table.gain_error_percent.map(|error| error / 100.0),
        nonlinearity: table.nonlinearity_percent / 100.0,
        runout: MICRO * table.runout_um,
        runout_harmonic: table.runout_harmonic,
        speed: table.speed,
        levitation_signal: table.levitation_signal,
        tachometers: None,
    };
    config.check().map_err(|error| translate(&error))?;
    Ok(config)
}

/// The core has the last word: what it refuses is a flaw of the key that the value came from.
fn monitor(scene: &Scene) -> Result<(), Flaw> {
    Monitor::try_new(&scene.monitor_config())
        .map(|_| ())
        .map_err(|error| translate(&error))
}

/// A rule in the words of the configuration, in those of the file.
pub(super) fn translate(error: &ConfigError) -> Flaw {
    let parameter = error.parameter();
    let (table, key) = match parameter {
        "clearance" => ("retainer", "clearance_mm"),
        "friction" => ("retainer", "friction"),
        "restitution" => ("retainer", "restitution"),
        "gravity" => ("run", "gravity_m_s2"),
        "sample_rate" => ("run", "sample_rate_hz"),
        "rotor_radius" => ("rotor", "radius_mm"),
        "inertia_ratio" => ("rotor", "polar_inertia_kg_m2"),
        "spin" => ("rotor", "speed_rpm"),
        "length" => ("materials", "length_mm"),
        "fastest" => ("start", "vx_mm_s"),
        "planes" => ("sensors", "planes"),
        "bits" | "full_scale" | "zero_count" => ("sensors", "bits"),
        "range" | "resolution" => ("sensors", "range_um"),
        "noise" => ("sensors", "noise_um"),
        "bandwidth" => ("sensors", "bandwidth_hz"),
        "mounting_angle" => ("sensors", "mounting_deg"),
        "offset" => ("sensors", "offset_um"),
        "gain_error" => ("sensors", "gain_error_percent"),
        "nonlinearity" => ("sensors", "nonlinearity_percent"),
        "runout" => ("sensors", "runout_um"),
        "runout_harmonic" => ("sensors", "runout_harmonic"),
        tuning => ("detector", tuning),
    };
    let rule = error.to_string().replacen(parameter, key, 1);
    Flaw::new(table, key, rule)
}
