//! `touchdown config`.

use std::path::Path;

use serde::Serialize;
use touchdown_protocol::config_block::Settings;

use super::args::ConfigArgs;
use super::order::key_of;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_base::input_error::{InputError, LARGEST_TOML};
use touchdown_files::configuration::{
    ChangeError, Difference, Tables, differences, in_force, parse, put, text,
};
use touchdown_files::link::{Client, LinkError, Port};
use touchdown_page::json;

/// What the command tells.
#[derive(Serialize)]
struct Told {
    port: String,
    firmware: String,
    /// In force now.
    config: Tables,
    /// Whether it has a key.
    key: bool,
    /// By this command.
    changed: Vec<Difference>,
}

/// Shows the configuration in force, or puts that of a file in force.
pub(super) fn config(args: &ConfigArgs) -> Result<(), Failure> {
    let mut out = Gate::new()
        .reads("--set", &args.set)
        .reads("--key-file", &args.key_file)
        .writes("--json", &args.json)
        .open()?;
    // What is wrong with the file is said whether or not there is a controller.
    let wanted = args.set.as_deref().map(load).transpose()?;
    let key = key_of(args.key_file.as_deref())?;
    let port = Port::of(&args.port);
    let silent = |error: LinkError| Failure::Target(format!("{port}: {error}"));
    let mut client = Client::new(port.open().map_err(silent)?);
    client.key = key;
    let before = in_force(&mut client).map_err(silent)?;
    let (config, changed, shown) = match wanted {
        None => {
            let state = if before.is_own {
                ""
            } else {
                "\n# the defaults: not configured, no current"
            };
            let head = format!("# {port}, firmware {}{state}\n\n", before.firmware);
            (before.settings, Vec::new(), head + &text(&before.settings))
        }
        Some(mut wanted) => {
            // The controller keeps its key, and the record of its commissioning check, where the file has none.
            wanted.key = wanted.key.or(before.settings.key);
            if wanted.monitor.sensing.calibration.is_none() {
                let kept = &before.settings.monitor;
                wanted.monitor.sensing.calibration = kept.sensing.calibration;
                wanted.monitor.commissioned = kept.commissioned;
            }
            let changed = differences(&before.settings, &wanted);
            if wanted != before.settings || !before.is_own {
                put(&port, client, &wanted).map_err(|error| refused(&port, &error))?;
            }
            let shown = summary(&port, &changed);
            (wanted, changed, shown)
        }
    };
    let told = Told {
        port: port.to_string(),
        firmware: before.firmware,
        config: Tables::from(&config),
        key: config.key.is_some(),
        changed,
    };
    out.json("--json", || json::text(&told))?;
    // What goes into a file of TOML stays TOML.
    let note = |line: &str| format!("# {line}\n");
    out.finish_with(|files| shown + &files.lines().map(note).collect::<String>())
}

/// The settings of a file.
pub(super) fn load(name: &str) -> Result<Settings, Failure> {
    Ok(parse(
        name,
        &InputError::read(Path::new(name), LARGEST_TOML)?,
    )?)
}

/// A refusal is the controller's answer; all else is none.
fn refused(port: &Port, error: &ChangeError) -> Failure {
    let text = format!("{port}: {error}");
    match error {
        ChangeError::Link(LinkError::Refused(_)) => Failure::Check(text),
        _ => Failure::Target(text),
    }
}

/// For people.
fn summary(port: &Port, changed: &[Difference]) -> String {
    if changed.is_empty() {
        return format!("{port}: nothing to change, nothing sent\n");
    }
    let value = |it: &Option<String>| it.clone().unwrap_or_else(|| "none".to_owned());
    let lines = changed
        .iter()
        .map(|it| format!("  {}: {} -> {}\n", it.key, value(&it.from), value(&it.to)));
    format!(
        "{port}: the controller has restarted with another configuration\n{}",
        lines.collect::<String>()
    )
}
