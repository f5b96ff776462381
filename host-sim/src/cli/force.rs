//! `touchdown force`.

use std::io;
use std::path::Path;

use super::args::ForceArgs;
use super::{commit, one_standard_output, open, say};
use crate::failure::Failure;
use crate::force::instrument::InstrumentConfig;
use crate::force::{self, example, read, write};
use crate::output::Output;
use crate::scene::Scene;

/// The scene whose impacts the example has.
const EXAMPLE: &str = "rig";

/// Finds, says and writes the forces of a recording; or writes an example.
pub(super) fn measure(args: &ForceArgs) -> Result<(), Failure> {
    if let Some(folder) = &args.example {
        return write_example(Path::new(folder));
    }
    let names = [&args.json, &args.report];
    one_standard_output(&names)?;
    let name = args.recording.as_deref().unwrap_or_default();
    let recording = read::recording(Path::new(name))?;
    let hits: Result<Vec<_>, _> = (args.calibration.iter())
        .map(|file| read::calibration(Path::new(file)))
        .collect();
    let measurement = force::measure(&recording, &hits?)?;
    let [json_out, page_out] = names.map(open);
    let (mut json_out, mut page_out) = (json_out?, page_out?);
    if let Some(out) = &mut json_out {
        let text = force::json(&measurement).map_err(io::Error::from);
        out.put(&text.map_err(Failure::output(out.name()))?)?;
    }
    if let Some(out) = &mut page_out {
        out.put(&force::page(&recording, &measurement))?;
    }
    let files = commit([json_out, page_out, None])?;
    say(&names, &(force::table(name, &measurement) + &files));
    Ok(())
}

fn write_example(folder: &Path) -> Result<(), Failure> {
    let scene = Scene::load(EXAMPLE)?;
    let example = example::example(&scene, &InstrumentConfig::default())?;
    let shown = folder.display().to_string();
    std::fs::create_dir_all(folder).map_err(Failure::output(&shown))?;
    let name = |file: &str| folder.join(file).display().to_string();
    let [calibration, recording, truth] =
        ["calibration.csv", "recording.csv", "truth.json"].map(name);
    let right = serde_json::to_string_pretty(&example.truth).map_err(io::Error::from);
    let right = right.map_err(Failure::output(&truth))? + "\n";
    let outputs = [
        (&calibration, write::calibration(&example.calibration)),
        (&recording, write::recording(&example.recording)),
        (&truth, right),
    ];
    let opened = outputs.map(|(name, text)| -> Result<Output, Failure> {
        let mut out = Output::create(name)?;
        out.put(&text)?;
        Ok(out)
    });
    let [a, b, c] = opened;
    let files = commit([Some(a?), Some(b?), Some(c?)])?;
    let next = format!(
        "the rig's first impacts on the simulated device; now\n  \
         touchdown force {recording} --calibration {calibration} --report force.html\n"
    );
    say(&[], &(files + &next));
    Ok(())
}
