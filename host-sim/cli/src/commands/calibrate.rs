//! `touchdown calibrate`.

use std::collections::BTreeMap;
use std::path::Path;

use chrono::Utc;
use serde_json::json;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sensing::{Calibration, PLANES, PlaneCalibration};
use touchdown_protocol::config_block::Settings;

use super::args::{CalibrateArgs, Scale};
use super::{load, warn};
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_base::input_error::InputError;
use touchdown_base::plain::shown;
use touchdown_calibrate::{Checked, Plane, Readings, page, plane};
use touchdown_files::configuration;
use touchdown_files::recording::Recording;
use touchdown_page::json;
use touchdown_scene::Scene;
use touchdown_scene::calibration::{day, text_of_day};
use touchdown_scene::sensors::{SensorsConfig, to_sensor_axes};

/// Name and channels of each plane.
const NAMED: [(&str, u8); PLANES] = [("a", 0b0011), ("b", 0b1100)];

/// Finds zero, gain and skew of each plane, says them, and writes them into a configuration.
pub(super) fn calibrate(args: &CalibrateArgs) -> Result<(), Failure> {
    let mut out = Gate::new()
        .reads_recording("RECORDING", &args.recording)
        .reads("--scene", &args.scene)
        .reads("--config", &args.config)
        .reads("--columns", &args.reading.columns)
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .writes("--write", &args.write)
        .open()?;
    let today = || day(&Utc::now().format("%Y-%m-%d").to_string());
    let date = args.date.or_else(today).unwrap_or_default();
    let (mut settings, scene) = machine(args)?;
    let name = scene.heading();
    let told_clearance = &mut settings.monitor.detector.machine.clearance;
    if let Some(clearance) = args.clearance {
        *told_clearance = (1e-3 * clearance) as f32;
    }
    let believed = (args.scale == Scale::Clearance).then_some(f64::from(*told_clearance));
    let planes = check(args, &settings.monitor, &scene, believed)?;
    let title = format!("Commissioning check: {name}");
    let told = json!({
        "date": text_of_day(date),
        "machine": name,
        "scale": args.scale,
        "planes": planes.iter().map(|it| (it.name, it)).collect::<BTreeMap<_, _>>(),
    });
    out.json("--json", || json::text(&told))?;
    out.put("--report", || page::page(&title, &planes))?;
    let mut text: String = planes.iter().map(page::text).collect();
    let why = |it: &Checked| Some(format!("plane {}: {}", it.name, it.refused.as_ref()?));
    if let Some(why) = planes.iter().find_map(why) {
        out.leave("--write");
        out.finish(|_| text)?;
        return Err(Failure::Check(format!("{}: {why}", shown(&args.recording))));
    }
    text += &record(&mut settings.monitor, date, &planes);
    if let Some(file) = &args.write {
        let valid = settings.validate();
        valid.map_err(|it| Failure::Check(format!("{file}: {it}")))?;
    }
    out.put("--write", || configuration::record_text(&settings, name))?;
    out.finish(|_| text)
}

/// What the machine is told, and how its recordings are read: from the scene or the configuration.
fn machine(args: &CalibrateArgs) -> Result<(Settings, Scene), Failure> {
    let Some(name) = &args.config else {
        let scene = load(args.scene.as_deref().unwrap_or_default())?;
        let mut settings = Settings::from(scene.monitor_config());
        settings.wiring.levitation = scene.sensors.levitation_signal;
        return Ok((settings, scene));
    };
    let settings = super::config::load(name)?;
    let told = &settings.monitor;
    let (sensing, machine) = (&told.sensing, &told.detector.machine);
    let bits = (u16::BITS - sensing.full_scale.leading_zeros()).max(4);
    let mut scene = Scene::load("rig")?;
    (scene.name, scene.title) = (name.clone(), None);
    scene.retainer.clearance = f64::from(machine.clearance);
    scene.rotor.spin = f64::from(machine.spin);
    scene.sensors = SensorsConfig {
        planes: 1 + u8::from(told.fitted & NAMED[1].1 != 0),
        bits,
        range: f64::from(sensing.resolution) * f64::from(1 << (bits - 1)),
        mounting_angle: sensing.mounting_angle.map(f64::from),
        ..scene.sensors
    };
    Ok((settings, scene))
}

/// Reads the recording and looks at each plane that it has.
fn check(
    args: &CalibrateArgs,
    config: &MonitorConfig,
    scene: &Scene,
    clearance: Option<f64>,
) -> Result<Vec<Checked>, Failure> {
    let sensing = &config.sensing;
    let resolution = f64::from(sensing.resolution);
    // What the converter shows, neither at 0 nor at full scale.
    let shown = 0.5..f64::from(sensing.full_scale) - 0.5;
    let is_shown = |it: &f64| shown.contains(&(it / resolution + f64::from(sensing.zero_count)));
    let mut recording = Recording::open(Path::new(&args.recording), &args.reading.load()?, scene)?;
    let mut readings: [Readings; PLANES] = Default::default();
    for row in recording.by_ref() {
        let row = row?;
        let (positions, _) = row.positions.as_chunks::<2>();
        let mounted = positions.iter().zip(sensing.mounting_angle);
        for ((position, angle), readings) in mounted.zip(&mut readings) {
            let along = to_sensor_axes(*position, angle.into());
            if along.iter().all(is_shown) {
                readings.push(along);
            }
        }
    }
    warn(&recording.warnings());
    let planes: Vec<_> = (NAMED.into_iter().zip(readings))
        .filter(|((_, channels), it)| config.fitted & channels != 0 && !it.kept.is_empty())
        .map(|((name, _), readings)| {
            let found = plane(&readings.kept, resolution, clearance);
            let refused = (found.as_ref()).map_or_else(|why| Some(why.clone()), Plane::why_not);
            Checked {
                name,
                plane: found.ok(),
                refused,
                readings,
            }
        })
        .collect();
    if planes.is_empty() {
        let rule = "no plane that is fitted has a reading within the converter's range";
        return Err(InputError::of_file(&args.recording, rule).into());
    }
    Ok(planes)
}

/// Puts what was found on record; what is worth a warning.
fn record(monitor: &mut MonitorConfig, date: u32, planes: &[Checked]) -> String {
    // A plane that the recording lacks keeps what it had.
    let mut calibration = Calibration {
        date,
        ..monitor.sensing.calibration.unwrap_or_default()
    };
    let mut radii = Vec::new();
    for it in planes {
        let Some(found) = &it.plane else { continue };
        calibration.planes[usize::from(it.name == NAMED[1].0)] = PlaneCalibration {
            zero: found.zero_m.map(|it| it.value as f32),
            gain: found.gain.map(|it| it.value as f32),
            skew: found.skew_rad.value as f32,
        };
        radii.push(found.radius_m.value);
    }
    monitor.sensing.calibration = Some(calibration);
    monitor.commissioned = true;
    // Of radii that were given, what was given.
    let mean = radii.iter().sum::<f64>() / radii.len() as f64;
    monitor.detector.machine.clearance = mean as f32;
    let apart = radii.iter().map(|it| (it / mean - 1.0).abs());
    let apart = apart.fold(0.0, f64::max);
    if apart <= f64::from(monitor.detector.tuning.wall_tolerance) {
        return String::new();
    }
    let apart = format!(
        "the planes' radii differ by {:.0} % from their mean",
        100.0 * apart
    );
    format!("warning: {apart}, which is set as the clearance: more than wall_tolerance\n")
}
