//! The image at work, with its link on a socket.

use std::fs::File;
use std::io;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::{
    Emulator, EmulatorError, MACHINE, QEMU, START_LIMIT, TIME, decode_answer, failed, read,
};
use crate::controller_trace::MonitorOutput;
use touchdown_base::interrupt::{Registered, spawn};
use touchdown_files::link::Client;
use touchdown_protocol::wire::Switching;

/// Exit status of an image that has stored a configuration and would be reset now.
pub const RESTART: i32 = 7;
/// Names of the files in the session's folder: samples, what came of them, flash, stored configuration.
const FILES: &str = "enable=on,target=native,arg=replay,arg=answer,arg=log,arg=settings";
const LOOK: Duration = Duration::from_millis(2);

/// The image at work. It stays on its link when no samples are left, until it is cut off.
#[derive(Debug)]
pub struct Session {
    emulator: Emulator,
    folder: PathBuf,
    child: Child,
    /// The link; who talks over it takes it.
    pub line: Option<TcpStream>,
    _registered: Registered,
}

impl Emulator {
    /// Starts the image in `folder`, where there is a file or a pipe `replay`; `log` and `settings` are
    /// made where they are not there, and kept.
    pub fn open(&self, folder: &Path) -> Result<Session, EmulatorError> {
        let socket = TcpListener::bind("127.0.0.1:0").map_err(failed("open a socket"))?;
        let port = socket.local_addr().map_err(failed("open a socket"))?.port();
        let serial = format!("tcp:127.0.0.1:{port}");
        let [clock, rate] = TIME;
        let mut session = self.start(folder, &serial, &[FILES, clock, rate])?;
        session.line = Some(session.accept(&socket)?);
        Ok(session)
    }

    /// Runs the image in `folder`, where its files are, to its end; what it logged. `arguments` are QEMU's after
    /// `-semihosting-config`.
    pub fn execute(
        &self,
        folder: &Path,
        arguments: &[&str],
        limit: Duration,
    ) -> Result<Vec<String>, EmulatorError> {
        self.start(folder, "none", arguments)?.end(limit)
    }

    fn start(
        &self,
        folder: &Path,
        serial: &str,
        arguments: &[&str],
    ) -> Result<Session, EmulatorError> {
        let started = || {
            let mut command = Command::new(QEMU);
            command
                .args(["-M", MACHINE, "-nographic", "-monitor", "none"])
                .args(["-serial", serial, "-semihosting-config"])
                .args(arguments)
                .arg("-kernel")
                .arg(&self.image)
                .current_dir(folder)
                .stdin(Stdio::null())
                .stdout(File::create(folder.join("out"))?)
                .stderr(File::create(folder.join("err"))?);
            spawn(&mut command)
        };
        let (child, registered) = started().map_err(failed("start QEMU"))?;
        Ok(Session {
            emulator: self.clone(),
            folder: folder.to_owned(),
            child,
            line: None,
            _registered: registered,
        })
    }
}

impl Session {
    fn accept(&mut self, socket: &TcpListener) -> Result<TcpStream, EmulatorError> {
        let failed = failed("open the link");
        socket.set_nonblocking(true).map_err(failed)?;
        let start = Instant::now();
        loop {
            match socket.accept() {
                Ok((line, _)) => {
                    line.set_nonblocking(false).map_err(failed)?;
                    line.set_nodelay(true).map_err(failed)?;
                    return Ok(line);
                }
                Err(e) if e.kind() != io::ErrorKind::WouldBlock => return Err(failed(e)),
                Err(_) => self.look(start, START_LIMIT)?,
            }
        }
    }

    /// Waits a little for an image that works, up to `limit` from `start`; one that has ended, well or not, has failed.
    fn look(&mut self, start: Instant, limit: Duration) -> Result<(), EmulatorError> {
        if let Some(status) = self.ended()? {
            let log = self.log()?;
            let qemu = read(&self.folder.join("err"))?;
            let qemu = String::from_utf8_lossy(&qemu).trim().to_owned();
            return Err(EmulatorError::Failed { status, log, qemu });
        }
        if start.elapsed() > limit {
            return Err(EmulatorError::Timeout(limit));
        }
        thread::sleep(LOOK);
        Ok(())
    }

    /// Waits for its end, which is to be a good one; what it logged.
    fn end(mut self, limit: Duration) -> Result<Vec<String>, EmulatorError> {
        let start = Instant::now();
        loop {
            match self.look(start, limit) {
                Ok(()) => {}
                Err(EmulatorError::Failed { status, log, .. }) if status.success() => {
                    return Ok(log);
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// What the monitor said, and each change of what the controller showed, once all samples of a file are taken.
    pub fn answer(
        &mut self,
        limit: Duration,
    ) -> Result<(MonitorOutput, Vec<Switching>), EmulatorError> {
        let start = Instant::now();
        loop {
            // Made before the first sample is read, but after QEMU is up.
            let bytes = read(&self.folder.join("answer")).unwrap_or_default();
            if let Some(answer) = decode_answer(&bytes) {
                return Ok(answer);
            }
            self.look(start, limit)?;
        }
    }

    /// Talks over the link; once.
    pub fn client(&mut self) -> Result<Client, EmulatorError> {
        let gone = || failed("open the link")(io::ErrorKind::NotConnected.into());
        let line = self.line.take().ok_or_else(gone)?;
        Ok(Client::patient(Box::new(line)))
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Result<Option<ExitStatus>, EmulatorError> {
        self.child.try_wait().map_err(failed("wait for QEMU"))
    }

    /// Cuts its power; what it logged.
    pub fn cut(mut self) -> Result<Vec<String>, EmulatorError> {
        self.stop();
        self.log()
    }

    fn log(&self) -> Result<Vec<String>, EmulatorError> {
        (self.emulator).decode_log(&read(&self.folder.join("out"))?)
    }

    fn stop(&mut self) {
        // One that has ended is as good.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.stop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn process_that_hangs_is_ended_and_reported() {
        let (child, registered) = spawn(Command::new("sleep").arg("60")).unwrap();
        let session = Session {
            emulator: Emulator {
                image: PathBuf::new(),
            },
            folder: PathBuf::new(),
            child,
            line: None,
            _registered: registered,
        };
        let error = session.end(Duration::from_millis(20)).unwrap_err();
        assert!(matches!(error, EmulatorError::Timeout(_)));
    }
}
