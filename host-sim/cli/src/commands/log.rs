//! `touchdown log`.

use std::path::Path;

use super::args::{DumpArgs, ExportFormat, LogCommand};
use super::holds;
use super::order::order;
use crate::gate::{Gate, Outputs};
use touchdown_base::failure::Failure;
use touchdown_base::paint::Paint;
use touchdown_core::event::Act;
use touchdown_files::drop_log::{
    Dump, Episode, EpisodeRange, comtrade, fetch, is_sound, list, read, show, stream,
};
use touchdown_files::link::Port;
use touchdown_page::json::text;

const OUT: &str = "--out";
const CFG: &str = "--out (.cfg)";
const DAT: &str = "--out (.dat)";

/// Lists, shows, exports or verifies the episodes of a log; keeps or erases those of a controller.
pub(super) fn log(command: &LogCommand) -> Result<(), Failure> {
    match command {
        LogCommand::List(args) => all(args).map(drop),
        LogCommand::Show { dump, number } => {
            let out = gate(dump)?;
            let episode = episode(&dump.file, *number)?;
            tell(out, &episode, |paint| show(&episode, paint))
        }
        LogCommand::Export {
            file,
            number,
            format,
            out: name,
        } => {
            let mut gate = Gate::new().reads("FILE", [file]);
            for (option, name) in files(*format, name) {
                gate = gate.writes(option, [name]);
            }
            let out = gate.open()?;
            export(&episode(file, *number)?, *format, out)
        }
        LogCommand::Verify(args) => {
            let is_sound = is_sound(&all(args)?);
            holds(is_sound, || format!("{}: an episode is damaged", args.file))
        }
        LogCommand::Lock(args) => order(Act::Lock(args.episode), &args.order),
        LogCommand::Unlock(args) => order(Act::Unlock(args.episode), &args.order),
        LogCommand::Erase(args) => order(Act::Erase(args.episode), &args.order),
    }
}

fn gate(args: &DumpArgs) -> Result<Outputs, Failure> {
    let gate = Gate::new().reads("FILE", [&args.file]);
    gate.writes("--json", &args.json).open()
}

/// Lists all episodes.
fn all(args: &DumpArgs) -> Result<Dump, Failure> {
    let out = gate(args)?;
    let dump = source(&args.file, |all| all)?;
    tell(out, &dump, |paint| list(&dump, paint))?;
    Ok(dump)
}

/// The log in a file, or as much of a controller's as is wanted.
fn source(name: &str, wanted: impl FnOnce(EpisodeRange) -> EpisodeRange) -> Result<Dump, Failure> {
    let Some(port) = Port::if_no_file(name) else {
        return Ok(read(name)?);
    };
    fetch(&port, wanted).map_err(|it| it.at(&port))
}

fn tell(
    mut out: Outputs,
    what: &impl serde::Serialize,
    told: impl FnOnce(Paint) -> String,
) -> Result<(), Failure> {
    out.json("--json", || text(what))?;
    out.finish(told)
}

fn episode(file: &str, number: Option<u32>) -> Result<Episode, Failure> {
    let dump = source(file, |all| {
        let wanted = number.unwrap_or(*all.end());
        wanted..=wanted
    })?;
    let mut all = dump.episodes.into_iter().rev();
    let found = match number {
        Some(number) => all.find(|it| it.sequence == number),
        None => all.next(),
    };
    found.ok_or_else(|| {
        let what = number.map_or(String::new(), |it| format!(" {it}"));
        let rule = format!("touchdown log list {file} shows what there is");
        Failure::Usage(format!("{file}: no episode{what}; {rule}"))
    })
}

/// The option of each file.
fn files(format: ExportFormat, name: &str) -> Vec<(&'static str, String)> {
    let ending = |it| Path::new(name).with_extension(it).display().to_string();
    match format {
        ExportFormat::Comtrade => vec![(CFG, ending("cfg")), (DAT, ending("dat"))],
        ExportFormat::Csv | ExportFormat::Json => vec![(OUT, name.to_owned())],
    }
}

fn export(episode: &Episode, format: ExportFormat, mut out: Outputs) -> Result<(), Failure> {
    let headless = || {
        let rule = "the episode's header is lost or impossible: neither rate nor scale are known";
        Failure::Usage(rule.to_owned())
    };
    match format {
        ExportFormat::Json => out.json(OUT, || text(episode))?,
        ExportFormat::Csv => {
            let Some(file) = out.file(OUT) else {
                return Ok(());
            };
            let name = file.name().to_owned();
            if !stream(episode, file).map_err(Failure::output(&name))? {
                return Err(headless());
            }
        }
        ExportFormat::Comtrade => {
            let [cfg, dat] = comtrade(episode).ok_or_else(headless)?;
            out.put(CFG, || cfg)?;
            out.put(DAT, || dat)?;
        }
    }
    out.finish(|_| String::new())
}
