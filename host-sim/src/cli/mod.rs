//! The command line.

mod args;
mod compare;
mod config;
mod force;
mod help;
mod limits;
mod live;
mod log;
mod paper;
#[cfg(unix)]
mod rig;
mod scene;
mod score;
mod subject;
mod sweep;
mod trade;

pub use args::Cli;

use std::io::{self, IsTerminal, Write};
use std::path::Path;

use clap::CommandFactory;

use args::{Command, DropArgs, ReplayArgs};

use crate::failure::Failure;
use crate::json;
use crate::output::{Output, STDOUT};
use crate::paint::Paint;
use crate::plain::shown;
use crate::scene::{BUILT_IN, Scene};
use crate::{drop, fidelity, replay, report, timeline};

/// Where the report goes when nothing is asked for.
const DEFAULT_REPORT: &str = "touchdown-report.html";

/// Does what the command line asks.
pub fn run(cli: Cli) -> Result<(), Failure> {
    match cli.command {
        None => drop_scene(&DropArgs {
            scene: BUILT_IN[0].name.to_owned(),
            report: Some(DEFAULT_REPORT.to_owned()),
            ..DropArgs::default()
        }),
        Some(Command::Drop(args)) => drop_scene(&args),
        Some(Command::Replay(args)) => replay_stream(&args),
        Some(Command::Compare(args)) => compare::compare_recordings(&args),
        Some(Command::Trade(args)) => trade::table(&args),
        Some(Command::Paper(args)) => paper::check(&args),
        Some(Command::Force(args)) => force::measure(&args),
        Some(Command::Limits(args)) => limits::check(&args),
        Some(Command::Score(args)) => score::measure(&args),
        Some(Command::Sweep(args)) => sweep::sweep(&args),
        #[cfg(unix)]
        Some(Command::Rig(args)) => rig::rig(&args),
        Some(Command::Log { what }) => log::log(&what),
        Some(Command::Live(args)) => live::live(&args),
        Some(Command::Config(args)) => config::config(&args),
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "touchdown", &mut script);
            say(&[], &String::from_utf8_lossy(&script));
            Ok(())
        }
        Some(Command::Scene { what }) => scene::look(&what),
    }
}

fn drop_scene(args: &DropArgs) -> Result<(), Failure> {
    let names = [&args.json, &args.report, &args.stream];
    one_standard_output(&names)?;
    let mut scene = load(&args.scene)?;
    let why = choose(&mut scene)?;
    let target = args.place.target()?;
    let [json_out, report_out, stream_out] = names.map(open);
    let (mut json_out, mut report_out) = (json_out?, report_out?);
    let (outcome, stream) = drop::run(&scene, &target, stream_out?)?;
    let stream_out = stream.map_err(Failure::output(args.stream.as_deref().unwrap_or_default()))?;
    if let Some(out) = &mut json_out {
        let text = json::drop(&scene, &outcome).map_err(io::Error::from);
        out.put(&text.map_err(Failure::output(out.name()))?)?;
    }
    if let Some(out) = &mut report_out {
        out.put(&report::render(&subject::subject(&scene), &outcome))?;
    }
    let files = commit([json_out, report_out, stream_out])?;
    let text = timeline::drop(&scene, &outcome, paint(&names));
    say(&names, &(why + &text + &files));
    Ok(())
}

/// Takes the cheapest model that gives what the scene asks, where it leaves the model open; why, for
/// people.
fn choose(scene: &mut Scene) -> Result<String, Failure> {
    let Some(auto) = &scene.auto else {
        return Ok(String::new());
    };
    let choice = fidelity::choose(scene, auto);
    let why = fidelity::explain(&choice);
    let Some(best) = choice.best() else {
        return Err(Failure::Usage(format!("{}: {why}", scene.name)));
    };
    scene.model = best.model;
    Ok(why + "\n")
}

fn replay_stream(args: &ReplayArgs) -> Result<(), Failure> {
    let names = [&args.json, &args.report];
    one_standard_output(&names)?;
    let scene = load(&args.scene)?;
    let target = args.place.target()?;
    let [json_out, report_out] = names.map(open);
    let (mut json_out, mut report_out) = (json_out?, report_out?);
    let path = Path::new(&args.stream);
    let reading = args.reading.load()?;
    let replay = replay::recording(path, &reading, &scene, &target)?;
    warn(&replay.warnings);
    let detection = &replay.detection;
    if let Some(out) = &mut json_out {
        let text = json::replay(detection).map_err(io::Error::from);
        out.put(&text.map_err(Failure::output(out.name()))?)?;
    }
    if let Some(out) = &mut report_out {
        let drop = replay::first_drop(path, &reading, &scene, &replay)?;
        out.put(&replay::page(&args.stream, &scene, &replay, drop.as_ref()))?;
    }
    for out in [json_out, report_out].into_iter().flatten() {
        out.commit()?;
    }
    let format = replay.format.map_or(String::new(), |it| {
        format!("{}: {it}, {} Hz\n", shown(&args.stream), replay.rate)
    });
    say(
        &names,
        &(format + &timeline::replay(&args.stream, detection)),
    );
    Ok(())
}

/// Gives the files their names; what was written, for people.
fn commit(outputs: [Option<Output>; 3]) -> Result<String, Failure> {
    let mut files = String::new();
    for out in outputs.into_iter().flatten() {
        if out.name() != STDOUT {
            files += &format!("wrote {}\n", out.name());
        }
        out.commit()?;
    }
    Ok(files)
}

fn load(name: &str) -> Result<Scene, Failure> {
    let scene = Scene::load(name)?;
    warn(&scene.warnings());
    Ok(scene)
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        remark(&format!("warning: {}\n", shown(warning)));
    }
}

fn open(name: &Option<String>) -> Result<Option<Output>, Failure> {
    name.as_deref().map(Output::create).transpose()
}

fn one_standard_output(names: &[&Option<String>]) -> Result<(), Failure> {
    let given: Vec<_> = names.iter().copied().flatten().collect();
    for (index, name) in given.iter().enumerate() {
        if given[..index].contains(name) {
            let what = if *name == STDOUT {
                "standard output"
            } else {
                name
            };
            return Err(Failure::Usage(format!("two outputs go to {what}")));
        }
    }
    Ok(())
}

/// How [`say`] may colour.
fn paint(names: &[&Option<String>]) -> Paint {
    if is_taken(names) {
        Paint::on(&io::stderr())
    } else {
        Paint::on(&io::stdout())
    }
}

/// Whether a file has taken standard output.
fn is_taken(names: &[&Option<String>]) -> bool {
    names.iter().any(|name| name.as_deref() == Some(STDOUT))
}

/// Text for people: on standard output, or on standard error where a file has taken that. A reader
/// that has gone away is no failure.
fn say(names: &[&Option<String>], text: &str) {
    let _ = if is_taken(names) {
        io::stderr().lock().write_all(text.as_bytes())
    } else {
        io::stdout().lock().write_all(text.as_bytes())
    };
}

/// Text for people beside the result: on standard error, if somebody reads that.
fn remark(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Shows why a command failed.
pub fn complain(failure: &Failure) {
    let theme = if io::stderr().is_terminal() && Paint::wanted() {
        miette::GraphicalTheme::unicode()
    } else {
        miette::GraphicalTheme::none()
    };
    let handler = miette::GraphicalReportHandler::new_themed(theme)
        .with_wrap_lines(false)
        .with_context_lines(1);
    let mut text = String::new();
    if handler.render_report(&mut text, failure).is_err() {
        text = failure.to_string();
    }
    remark(&format!("error:\n{}\n", text.trim_end()));
}
