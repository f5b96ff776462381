//! Orders to a controller: `touchdown clear`, `log lock`, `log unlock`, `log erase`.

use serde::Serialize;
use touchdown_core::event::Act;
use touchdown_protocol::config_block::Key;

use super::args::OrderArgs;
use crate::gate::{Gate, note};
use touchdown_base::failure::Failure;
use touchdown_files::link::{Client, LinkError, Port, load_key, why};
use touchdown_page::json;
use touchdown_scene::names::act_name;

/// What the command tells.
#[derive(Serialize)]
struct Told {
    port: String,
    order: &'static str,
    episode: Option<u32>,
    done: bool,
    why: Option<String>,
}

/// Orders, and says what came of it.
pub(super) fn order(act: Act, args: &OrderArgs) -> Result<(), Failure> {
    let gate = Gate::new().reads("--key-file", &args.key_file);
    let mut out = gate.writes("--json", &args.json).open()?;
    let key = key_of(args.key_file.as_deref())?;
    let port = Port::of(&args.port);
    let silent = |error: LinkError| Failure::Target(format!("{port}: {error}"));
    let mut client = Client::new(port.open().map_err(silent)?);
    client.key = key;
    let why = match client.order(act) {
        Ok(()) => None,
        Err(LinkError::Refused(refusal)) => Some(why(&refusal)),
        Err(error) => return Err(silent(error)),
    };
    let (episode, done) = match act {
        Act::Clear | Act::Commit(_) => (None, "cleared".to_owned()),
        Act::Erase(it) => (Some(it), format!("episode {it} is erased")),
        Act::Lock(it) => (Some(it), format!("episode {it} is locked")),
        Act::Unlock(it) => (Some(it), format!("episode {it} is no longer locked")),
    };
    let told = Told {
        port: port.to_string(),
        order: act_name(act),
        episode,
        done: why.is_none(),
        why,
    };
    out.json("--json", || json::text(&told))?;
    let Some(why) = told.why else {
        return out.finish(&format!("{port}: {done}\n"));
    };
    out.finish(&format!("{port}: nothing is done\n"))?;
    Err(Failure::Check(format!(
        "{port}: the controller refuses: {why}"
    )))
}

/// The key in a file, with a warning where others may read it.
pub(super) fn key_of(file: Option<&str>) -> Result<Option<Key>, Failure> {
    let Some((key, warning)) = file.map(load_key).transpose()? else {
        return Ok(None);
    };
    if let Some(warning) = warning {
        note(&format!("warning: {warning}\n"));
    }
    Ok(Some(key))
}
