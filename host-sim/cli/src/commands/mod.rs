//! The command line.

mod args;
mod calibrate;
mod compare;
mod config;
mod force;
mod lab;
mod live;
mod log;
mod order;
#[cfg(unix)]
mod rig;
mod scene;
mod sweep;

pub use args::Cli;

use std::io::{self, IsTerminal, Write};
use std::path::Path;

use clap::{CommandFactory, Parser};

use args::{Command, DropArgs, ReplayArgs};

use crate::gate::{Gate, note, said};
use touchdown_base::failure::Failure;
use touchdown_base::paint::Paint;
use touchdown_base::plain::shown;
use touchdown_core::event::Act;
use touchdown_page::{json, report, timeline};
use touchdown_run::{drop, fidelity, replay};
use touchdown_scene::{BUILT_IN, Scene};

/// Where the report goes when nothing is asked for.
const DEFAULT_REPORT: &str = "touchdown-report.html";

/// Reads the command line and does what it asks.
pub fn main() -> Result<(), Failure> {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) if usage.use_stderr() => usage.exit(),
        Err(help) => return said(help.print().and_then(|()| io::stdout().flush())),
    };
    match cli.command {
        None => drop_scene(&DropArgs {
            scene: BUILT_IN[0].name.to_owned(),
            report: Some(DEFAULT_REPORT.to_owned()),
            ..DropArgs::default()
        }),
        Some(Command::Drop(args)) => drop_scene(&args),
        Some(Command::Replay(args)) => replay_stream(&args),
        Some(Command::Compare(args)) => compare::compare_recordings(&args),
        Some(Command::Trade(args)) => lab::measure_trade(&args),
        Some(Command::Paper(args)) => lab::check_paper(&args),
        Some(Command::Calibrate(args)) => calibrate::calibrate(&args),
        Some(Command::Force(args)) => force::measure(&args),
        Some(Command::Limits(args)) => lab::check_limits(&args),
        Some(Command::Score(args)) => lab::measure_score(&args),
        Some(Command::Sweep(args)) => sweep::sweep(&args),
        #[cfg(unix)]
        Some(Command::Rig(args)) => rig::rig(&args),
        Some(Command::Log(what)) => log::log(&what),
        Some(Command::Live(args)) => live::live(&args),
        Some(Command::Clear(args)) => order::order(Act::Clear, &args),
        Some(Command::Config(args)) => config::config(&args),
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "touchdown", &mut script);
            let script = String::from_utf8_lossy(&script).into_owned();
            Gate::new().open()?.finish(|_| script)
        }
        Some(Command::Scene(what)) => scene::look(&what),
    }
}

fn drop_scene(args: &DropArgs) -> Result<(), Failure> {
    let target = args.place.target()?;
    let mut out = Gate::new()
        .reads("SCENE", [&args.scene])
        .reads("--image", target.image())
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .writes("--stream", &args.stream)
        .open()?;
    let mut scene = load(&args.scene)?;
    let why = choose(&mut scene)?;
    let moved = if args.truth {
        drop::by_reference
    } else {
        drop::run
    };
    let (outcome, stream) = moved(&scene, &target, out.file("--stream"))?;
    stream.map_err(Failure::output(args.stream.as_deref().unwrap_or_default()))?;
    out.json("--json", || json::drop(&scene, &outcome))?;
    out.put("--report", || report::render(&scene, &outcome))?;
    out.finish(|paint| why + &timeline::drop(&scene, &outcome, paint))
}

/// Takes the cheapest model that gives what the scene asks, where it leaves the model open, or what comes nearest; why,
/// for people.
fn choose(scene: &mut Scene) -> Result<String, Failure> {
    let Some(auto) = &scene.auto else {
        return Ok(String::new());
    };
    let Some(choice) = fidelity::choose(scene, auto) else {
        let rule = "no model has all that [model] says";
        return Err(Failure::Usage(format!("{}: {rule}", scene.name)));
    };
    scene.model = choice.taken().model;
    Ok(fidelity::explain(&choice) + "\n")
}

fn replay_stream(args: &ReplayArgs) -> Result<(), Failure> {
    let target = args.place.target()?;
    let mut out = Gate::new()
        .reads_recording("FILE", &args.stream)
        .reads("--scene", [&args.scene])
        .reads("--columns", &args.reading.columns)
        .reads("--image", target.image())
        .writes("--json", &args.json)
        .writes("--report", &args.report)
        .open()?;
    let scene = load(&args.scene)?;
    let path = Path::new(&args.stream);
    let reading = args.reading.load()?;
    let orders = replay::Orders {
        power_on: args.power_on,
        clear_at: args.clear_at.clone(),
    };
    let replay = replay::recording(path, &reading, &scene, &target, &orders)?;
    warn(&replay.warnings);
    let detection = &replay.detection;
    out.json("--json", || json::replay(&replay))?;
    if let Some(page) = out.file("--report") {
        let drop = replay::first_drop(path, &reading, &scene, &replay)?;
        page.put(&touchdown_page::replay::page(
            &args.stream,
            &scene,
            &replay,
            drop.as_ref(),
        ))?;
    }
    let format = replay.format.map_or(String::new(), |it| {
        format!("{}: {it}, {} Hz\n", shown(&args.stream), replay.rate)
    });
    let controller = replay.conduct.told(replay.timebase);
    let told = format + &timeline::replay(&args.stream, detection);
    out.finish(|paint| told + &controller.text(paint))
}

/// Fails with `rule` where a check does not hold.
fn holds(is_held: bool, rule: impl FnOnce() -> String) -> Result<(), Failure> {
    is_held.then_some(()).ok_or_else(|| Failure::Check(rule()))
}

fn load(name: &str) -> Result<Scene, Failure> {
    let scene = Scene::load(name)?;
    warn(&scene.warnings());
    Ok(scene)
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        note(&format!("warning: {}\n", shown(warning)));
    }
}

/// Shows why a command failed.
pub fn report_error(failure: &Failure) {
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
    note(&format!("error:\n{}\n", text.trim_end()));
}
