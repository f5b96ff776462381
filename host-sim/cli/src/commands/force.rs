//! `touchdown force`.

use std::path::Path;

use super::args::ForceArgs;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_force::instrument::Instrument;
use touchdown_force::{example, read, write};
use touchdown_page::json;
use touchdown_scene::Scene;

/// The scene whose impacts the example has.
const EXAMPLE: &str = "rig";

/// Finds, says and writes the forces of a recording; or writes an example.
pub(super) fn measure(args: &ForceArgs) -> Result<(), Failure> {
    if let Some(folder) = &args.example {
        return write_example(folder);
    }
    let name = args.recording.as_deref().unwrap_or_default();
    let mut out = Gate::new()
        .reads("RECORDING", [name])
        .reads("--calibration", &args.calibration)
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .open()?;
    let recording = read::recording(Path::new(name))?;
    let hits: Result<Vec<_>, _> = (args.calibration.iter())
        .map(|file| read::calibration(Path::new(file)))
        .collect();
    let measurement = touchdown_force::measure(&recording, &hits?)?;
    out.json("--json", || json::text(&measurement))?;
    out.put("--report", || {
        touchdown_force::page(&recording, &measurement)
    })?;
    out.finish(|_| touchdown_force::text(name, &measurement))
}

fn write_example(folder: &str) -> Result<(), Failure> {
    let files = ["calibration.csv", "recording.csv", "truth.json"];
    let [calibration, recording, truth] =
        files.map(|it| Path::new(folder).join(it).display().to_string());
    let mut out = Gate::new()
        .makes_folder(folder)
        .writes("calibration", [&calibration])
        .writes("recording", [&recording])
        .writes("truth", [&truth])
        .open()?;
    let scene = Scene::load(EXAMPLE)?;
    let example = example::example(&scene, &Instrument::default());
    out.put("calibration", || write::calibration(&example.calibration))?;
    out.put("recording", || write::recording(&example.recording))?;
    out.json("truth", || json::text(&example.truth))?;
    out.finish_with(|files| {
        format!(
            "{files}the rig's first impacts on the simulated device; now\n  \
             touchdown force {recording} --calibration {calibration} --report force.html\n"
        )
    })
}
