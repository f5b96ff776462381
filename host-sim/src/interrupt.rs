//! What a signal must not leave behind: hidden files, temporary folders, the emulator.
//!
//! A thread waits for the signals that end a program. It undoes what is registered here, the newest first,
//! and then lets the signal end the program as if nobody had waited for it.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::process::Child;
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::TempDir;

type Undo = Box<dyn FnOnce() + Send>;

/// By the order in which they were registered.
static LEFT: Mutex<BTreeMap<u64, Undo>> = Mutex::new(BTreeMap::new());
/// Held while files take their names.
static COMMIT: Mutex<()> = Mutex::new(());

/// Something to undo, for as long as this lives.
pub struct Registered(u64);

impl std::fmt::Debug for Registered {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Registered({})", self.0)
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        locked(&LEFT).remove(&self.0);
    }
}

/// Undoes something where a signal ends the program.
pub fn on_signal(undo: impl FnOnce() + Send + 'static) -> io::Result<Registered> {
    #[cfg(unix)]
    unix::watch()?;
    let mut left = locked(&LEFT);
    let number = left.last_key_value().map_or(0, |(last, _)| last + 1);
    left.insert(number, Box::new(undo));
    Ok(Registered(number))
}

/// Ends a process where a signal ends the program.
#[cfg(unix)]
pub fn kill_on_signal(child: &Child) -> io::Result<Registered> {
    use rustix::process::{Pid, Signal, kill_process};
    let process = Pid::from_child(child);
    // One that has ended is as good.
    on_signal(move || _ = kill_process(process, Signal::KILL))
}

/// Nothing but the terminal sends signals here, and it sends them to both.
#[cfg(not(unix))]
pub fn kill_on_signal(_: &Child) -> io::Result<Registered> {
    on_signal(|| ())
}

/// No signal ends the program while what this returns lives.
pub fn hold() -> MutexGuard<'static, ()> {
    locked(&COMMIT)
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
        let folder = tempfile::tempdir()?;
        let path = folder.path().to_owned();
        Ok(Self {
            folder,
            _registered: on_signal(move || _ = std::fs::remove_dir_all(path))?,
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

    use super::{COMMIT, LEFT, Mutex, locked};

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
                let _commit = locked(&COMMIT);
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
