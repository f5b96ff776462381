//! `touchdown config`.

use std::path::Path;

use serde::Serialize;
use touchdown_protocol::config_block::Settings;

use super::args::ConfigArgs;
use super::order::client;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_base::input_error::{InputError, LARGEST_TOML};
use touchdown_base::plain::shown;
use touchdown_files::configuration::{Difference, Tables, differences, parse, put, text};
use touchdown_files::link::{LinkError, Port};
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
    let port = Port::of(&args.port);
    let mut client = client(&port, args.key_file.as_deref())?;
    let at = |it: LinkError| it.at(&port);
    let hello = client.hello().map_err(at)?;
    let firmware = shown(&hello.firmware).into_owned();
    let before = client.settings().map_err(at)?;
    // Or else it has the defaults, for want of a valid one.
    let is_own = !client.state().map_err(at)?.faults.lasting();
    let (config, changed, told) = match wanted {
        None => {
            let defaults = "\n# the defaults: not configured, no current";
            let state = if is_own { "" } else { defaults };
            let head = format!("# {port}, firmware {firmware}{state}\n\n");
            (before, Vec::new(), head + &text(&before))
        }
        Some(mut wanted) => {
            // The controller keeps its key, and the record of its commissioning check, where the file has none.
            wanted.key = wanted.key.or(before.key);
            if wanted.monitor.sensing.calibration.is_none() {
                let kept = &before.monitor;
                wanted.monitor.sensing.calibration = kept.sensing.calibration;
                wanted.monitor.commissioned = kept.commissioned;
            }
            let changed = differences(&before, &wanted);
            if wanted != before || !is_own {
                put(&port, client, &wanted).map_err(at)?;
            }
            let told = summary(&port, &changed);
            (wanted, changed, told)
        }
    };
    let all = Told {
        port: port.to_string(),
        firmware,
        config: Tables::from(&config),
        key: config.key.is_some(),
        changed,
    };
    out.json("--json", || json::text(&all))?;
    // What goes into a file of TOML stays TOML.
    let note = |line: &str| format!("# {line}\n");
    out.finish_with(|files| told + &files.lines().map(note).collect::<String>())
}

/// The settings of a file.
pub(super) fn load(name: &str) -> Result<Settings, Failure> {
    let text = InputError::read(Path::new(name), LARGEST_TOML)?;
    Ok(parse(name, &text)?)
}

/// For people.
fn summary(port: &Port, changed: &[Difference]) -> String {
    if changed.is_empty() {
        return format!("{port}: nothing to change, nothing sent\n");
    }
    let value = |it: &Option<String>| it.clone().unwrap_or_else(|| "none".to_owned());
    let mut text = format!("{port}: the controller has restarted with another configuration\n");
    for it in changed {
        text += &format!("  {}: {} -> {}\n", it.key, value(&it.from), value(&it.to));
    }
    text
}
