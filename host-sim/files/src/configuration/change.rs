//! The configuration of a controller: reading it, setting it, and waiting for it to be in force.

use std::thread;
use std::time::{Duration, Instant};

use touchdown_protocol::config_block::{Key, Settings};

use crate::link::{Client, LinkError, Port};
use touchdown_base::plain::shown;

/// A restart takes a second, an emulator on a busy machine longer.
const RESTART: Duration = Duration::from_secs(30);
/// Between two looks.
const LOOK: Duration = Duration::from_millis(100);

/// What a controller has in force.
#[derive(Clone, Debug, PartialEq)]
pub struct InForce {
    /// Version of the firmware.
    pub firmware: String,
    /// The configuration.
    pub settings: Settings,
    /// Whether it was set, and not the defaults for want of a valid one.
    pub is_own: bool,
}

/// Why another configuration is not in force.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    /// It was not taken.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// It was taken, and the controller has not been heard with it since.
    #[error("the configuration was taken, but the controller has not come back with it: {0}")]
    Away(String),
}

/// What is in force.
pub fn in_force(client: &mut Client) -> Result<InForce, LinkError> {
    let firmware = shown(&client.hello()?.firmware).into_owned();
    let settings = client.settings()?;
    let is_own = !client.state()?.faults.lasting();
    Ok(InForce {
        firmware,
        settings,
        is_own,
    })
}

/// Sets another configuration, and waits until the controller has restarted with it.
pub fn put(port: &Port, mut client: Client, settings: &Settings) -> Result<(), ChangeError> {
    client.set_settings(settings)?;
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
        let found = client.as_mut().map(Client::settings);
        let why = match found {
            Ok(Ok(it)) if it == settings => return Ok(()),
            Ok(Ok(_)) => {
                line = client.ok();
                "it still has the old one".to_owned()
            }
            Ok(Err(error)) => error.to_string(),
            Err(error) => error.to_string(),
        };
        if Instant::now() > end {
            return Err(ChangeError::Away(why));
        }
    }
}
