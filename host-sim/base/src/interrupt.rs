//! What a signal must not leave behind: hidden files, temporary folders, the emulator.
//!
//! A thread waits for the signals that end a program. It undoes what is registered here, the newest first,
//! and then lets the signal end the program as if nobody had waited for it.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::process::{Child, Command};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::TempDir;

type Undo = Box<dyn FnOnce() + Send>;

/// By the order in which they were registered.
static LEFT: Mutex<BTreeMap<u64, Undo>> = Mutex::new(BTreeMap::new());
/// Held while something is made and registered, and while files take their names.
static HELD: Mutex<()> = Mutex::new(());

/// Something to undo, for as long as this lives.
#[derive(Debug)]
pub struct Registered(u64);

impl Drop for Registered {
    fn drop(&mut self) {
        locked(&LEFT).remove(&self.0);
    }
}

/// No signal ends the program while what this returns lives.
pub fn hold() -> io::Result<MutexGuard<'static, ()>> {
    #[cfg(unix)]
    unix::watch()?;
    Ok(locked(&HELD))
}

/// Makes something that is undone where a signal ends the program.
pub fn make<T, U: FnOnce() + Send + 'static>(
    make: impl FnOnce() -> io::Result<(T, U)>,
) -> io::Result<(T, Registered)> {
    let _whole = hold()?;
    let (made, undo) = make()?;
    let mut left = locked(&LEFT);
    let number = left.last_key_value().map_or(0, |(last, _)| last + 1);
    left.insert(number, Box::new(undo));
    Ok((made, Registered(number)))
}

/// Starts a process that ends where a signal ends the program.
pub fn spawn(command: &mut Command) -> io::Result<(Child, Registered)> {
    make(|| {
        let child = command.spawn()?;
        #[cfg(unix)]
        let process = rustix::process::Pid::from_child(&child);
        let end = move || {
            // One that has ended is as good. Elsewhere the terminal ends both.
            #[cfg(unix)]
            let _ = rustix::process::kill_process(process, rustix::process::Signal::KILL);
        };
        Ok((child, end))
    })
}

/// A panic elsewhere is no reason to leave anything behind.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A folder that goes with this, or with a signal.
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: TempDir,
    _registered: Registered,
}

impl TemporaryFolder {
    /// A new one.
    pub fn new() -> io::Result<Self> {
        let (folder, registered) = make(|| {
            let folder = tempfile::tempdir()?;
            let path = folder.path().to_owned();
            Ok((folder, move || _ = std::fs::remove_dir_all(path)))
        })?;
        Ok(Self {
            folder,
            _registered: registered,
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

#[cfg(unix)]
mod unix {
    use std::io;
    use std::thread;

    use signal_hook::consts::signal::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    use super::{HELD, LEFT, Mutex, locked};

    static WATCHED: Mutex<bool> = Mutex::new(false);

    /// Starts the thread, once.
    pub(super) fn watch() -> io::Result<()> {
        let mut watched = locked(&WATCHED);
        if *watched {
            return Ok(());
        }
        let ignored = ignored();
        let ends = [SIGHUP, SIGINT, SIGTERM];
        let mut signals = Signals::new(ends.iter().filter(|it| ignored & 1 << (**it - 1) == 0))?;
        thread::Builder::new().spawn(move || {
            for signal in signals.forever() {
                // Never given back: the program ends here.
                let _whole = locked(&HELD);
                let mut left = locked(&LEFT);
                while let Some((_, undo)) = left.pop_last() {
                    undo();
                }
                let _ = emulate_default_handler(signal);
            }
        })?;
        *watched = true;
        Ok(())
    }

    /// The signals, a bit each, that whoever started the program wants ignored, as `nohup` does. Only Linux
    /// tells.
    fn ignored() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|it| it.strip_prefix("SigIgn:"));
        mask.and_then(|it| u64::from_str_radix(it.trim(), 16).ok())
            .unwrap_or(0)
    }
}
