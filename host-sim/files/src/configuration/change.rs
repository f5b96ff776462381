//! Another configuration for a controller: setting it, and waiting for it to be in force.

use std::thread;
use std::time::{Duration, Instant};

use touchdown_protocol::config_block::{self, Key, Settings};

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
        let mut client = match line.take() {
            Some(client) => Ok(client),
            None => port.open().map(Client::new),
        };
        let found = client.as_mut().map_err(|it| it.to_string());
        let found = found.and_then(|it| it.settings().map_err(|it| it.to_string()));
        let why = match found {
            Ok(it) if it == settings => return Ok(()),
            Ok(_) => {
                line = client.ok();
                "it still has the old one".to_owned()
            }
            Err(why) => why,
        };
        if Instant::now() > end {
            return Err(LinkError::Away(why));
        }
    }
}
