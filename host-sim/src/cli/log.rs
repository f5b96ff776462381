//! `touchdown log`.

use std::io;
use std::path::Path;

use super::args::{ExportFormat, LogCommand};
use super::{commit, open, paint, say};
use crate::drop_log::{Dump, Episode, Wanted, comtrade, fetch, is_sound, list, read, show, stream};
use crate::failure::Failure;
use crate::link::Port;
use crate::output::Output;

/// Lists, shows, exports or verifies the episodes of a log.
pub(super) fn log(command: &LogCommand) -> Result<(), Failure> {
    match command {
        LogCommand::List { file, json } => {
            let dump = source(file, Wanted::All)?;
            tell(json, &dump, &list(&dump, paint(&[json])))
        }
        LogCommand::Show { file, number, json } => {
            let dump = source(file, wanted(*number))?;
            let episode = chosen(file, &dump, *number)?;
            tell(json, episode, &show(episode, paint(&[json])))
        }
        LogCommand::Export {
            file,
            number,
            format,
            out,
        } => {
            let dump = source(file, wanted(*number))?;
            export(chosen(file, &dump, *number)?, *format, out)
        }
        LogCommand::Verify { file, json } => {
            let dump = source(file, Wanted::All)?;
            tell(json, &dump, &list(&dump, paint(&[json])))?;
            if is_sound(&dump) {
                Ok(())
            } else {
                Err(Failure::Check(format!("{file}: an episode is damaged")))
            }
        }
    }
}

fn wanted(number: Option<u32>) -> Wanted {
    number.map_or(Wanted::Newest, Wanted::Number)
}

/// The log in a file, or as much of a controller's as is wanted.
fn source(name: &str, wanted: Wanted) -> Result<Dump, Failure> {
    let Some(port) = Port::if_no_file(name) else {
        return Ok(read(name)?);
    };
    fetch(&port, wanted).map_err(|error| Failure::Target(format!("{port}: {error}")))
}

fn tell(json: &Option<String>, what: &impl serde::Serialize, text: &str) -> Result<(), Failure> {
    let mut out = open(json)?;
    if let Some(out) = &mut out {
        out.put(&pretty(what, out.name())?)?;
    }
    let files = commit([out, None, None])?;
    say(&[json], &(text.to_owned() + &files));
    Ok(())
}

fn pretty(what: &impl serde::Serialize, name: &str) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(what).map_err(io::Error::from);
    Ok(text.map_err(Failure::output(name))? + "\n")
}

fn chosen<'a>(file: &str, dump: &'a Dump, number: Option<u32>) -> Result<&'a Episode, Failure> {
    let mut all = dump.episodes.iter().rev();
    let found = match number {
        Some(number) => all.find(|it| it.sequence == number),
        None => all.next(),
    };
    found.ok_or_else(|| {
        let what = number.map_or("no episode".to_owned(), |it| format!("no episode {it}"));
        Failure::Usage(format!(
            "{file}: {what}; touchdown log list {file} shows what there is"
        ))
    })
}

fn export(episode: &Episode, format: ExportFormat, name: &str) -> Result<(), Failure> {
    let headless = || {
        let rule = "the episode has lost its header: neither rate nor scale are known";
        Failure::Usage(rule.to_owned())
    };
    let mut outputs = [None, None, None];
    match format {
        ExportFormat::Json => {
            let mut out = Output::create(name)?;
            out.put(&pretty(episode, name)?)?;
            outputs[0] = Some(out);
        }
        ExportFormat::Csv => {
            let mut out = Output::create(name)?;
            if !stream(episode, &mut out).map_err(Failure::output(name))? {
                return Err(headless());
            }
            outputs[0] = Some(out);
        }
        ExportFormat::Comtrade => {
            let texts = comtrade(episode).ok_or_else(headless)?;
            for ((place, ending), text) in outputs.iter_mut().zip(["cfg", "dat"]).zip(texts) {
                let path = Path::new(name).with_extension(ending);
                let mut out = Output::create(&path.display().to_string())?;
                out.put(&text)?;
                *place = Some(out);
            }
        }
    }
    let files = commit(outputs)?;
    say(&[&Some(name.to_owned())], &files);
    Ok(())
}
