//! The controller's configuration as a file, and over the link.

mod file;
mod table;

use std::thread;
use std::time::{Duration, Instant};

use touchdown_protocol::config_block::{self, Key, Settings};

pub use file::{Difference, differences, parse, record_text, text};
pub use table::Tables;

use crate::link::{Client, LinkError, Port};

/// A restart takes a second, an emulator on a busy machine longer.
const RESTART: Duration = Duration::from_secs(30);
/// Between two looks.
const LOOK: Duration = Duration::from_millis(100);

/// Sets another configuration, and waits until the controller has restarted with it.
pub fn put(port: &Port, mut client: Client, settings: &Settings) -> Result<(), LinkError> {
    client.set_block(&config_block::encode(settings))?;
    // What is read back has no key.
    let settings = Settings {
        key: settings.key.map(|_| Key::HELD),
        ..*settings
    };
    let end = Instant::now() + RESTART;
    // Some lines outlast a restart, others are closed by it.
    let mut line = Some(client);
    loop {
        thread::sleep(LOOK);
        let client = line.take().map_or_else(|| port.open().map(Client::new), Ok);
        let found = client.and_then(|mut it| Ok((it.settings()?, it)));
        let why = match found {
            Ok((it, _)) if it == settings => return Ok(()),
            Ok((_, client)) => {
                line = Some(client);
                "it still has the old one".to_owned()
            }
            Err(why) => why.to_string(),
        };
        if Instant::now() > end {
            return Err(LinkError::Away(why));
        }
    }
}
