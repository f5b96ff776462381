//! Orders to a controller: `touchdown clear`, `log lock`, `log unlock`, `log erase`.

use serde_json::json;
use touchdown_core::event::Act;

use super::args::OrderArgs;
use super::warn;
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_files::link::{Client, LinkError, Port, load_key, why};
use touchdown_page::json;

/// Orders, and says what came of it.
pub(super) fn order(act: Act, args: &OrderArgs) -> Result<(), Failure> {
    let gate = Gate::new().reads("--key-file", &args.key_file);
    let mut out = gate.writes("--json", &args.json).open()?;
    let port = Port::of(&args.port);
    let ordered = client(&port, args.key_file.as_deref())?.order(act);
    let why = match &ordered {
        Ok(()) => None,
        Err(LinkError::Refused(refusal)) => Some(why(refusal)),
        Err(error) => return Err(error.at(&port)),
    };
    let done = match act {
        _ if why.is_some() => "nothing is done".to_owned(),
        Act::Clear | Act::Commit(_) => "cleared".to_owned(),
        Act::Erase(it) => format!("episode {it} is erased"),
        Act::Lock(it) => format!("episode {it} is locked"),
        Act::Unlock(it) => format!("episode {it} is no longer locked"),
    };
    let (order, episode): (&str, _) = (act.into(), act.episode());
    let told = json!({
        "port": port.to_string(), "order": order, "episode": episode, "done": why.is_none(), "why": why,
    });
    out.json("--json", || json::text(&told))?;
    out.finish(|_| format!("{port}: {done}\n"))?;
    ordered.map_err(|it| it.at(&port))
}

/// Over the port, with the key in a file, and a warning where others may read that.
pub(super) fn client(port: &Port, key_file: Option<&str>) -> Result<Client, Failure> {
    let (key, warning) = key_file.map(load_key).transpose()?.unzip();
    warn(warning.flatten().as_slice());
    let mut client = Client::new(port.open().map_err(|it| it.at(port))?);
    client.key = key;
    Ok(client)
}
