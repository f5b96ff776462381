//! The image at work, with its link on a socket.

use std::io;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus};
use std::thread;
use std::time::{Duration, Instant};

use super::{Answer, Emulator, EmulatorError, TIME, decode_answer, read};
use touchdown_base::interrupt::Registered;
use touchdown_files::link::Client;

/// Exit status of an image that has stored a configuration and would be reset now.
pub const RESTART: i32 = 7;
/// Names of the files in the session's folder: samples, what came of them, flash, stored configuration.
const FILES: &str = "enable=on,target=native,arg=replay,arg=answer,arg=log,arg=settings";
/// Longest time for QEMU to come up.
const START: Duration = Duration::from_secs(30);
const LOOK: Duration = Duration::from_millis(2);

/// The image at work. It stays on its link when no samples are left, until it is cut off.
#[derive(Debug)]
pub struct Session {
    emulator: Emulator,
    folder: PathBuf,
    child: Child,
    line: Option<TcpStream>,
    _registered: Registered,
}

impl Emulator {
    /// Starts the image in `folder`, where there is a file or a pipe `replay`; `log` and `settings` are
    /// made where they are not there, and kept.
    pub fn open(&self, folder: &Path) -> Result<Session, EmulatorError> {
        let failed = |what| move |e| EmulatorError::Io(what, e);
        let socket = TcpListener::bind("127.0.0.1:0").map_err(failed("open a socket"))?;
        let port = socket.local_addr().map_err(failed("open a socket"))?.port();
        let serial = format!("tcp:127.0.0.1:{port}");
        let (out, err) = (folder.join("out"), folder.join("err"));
        let [clock, rate] = TIME;
        let started = self.start(folder, &serial, &[FILES, clock, rate], &out, &err);
        let (child, registered) = started.map_err(failed("start QEMU"))?;
        let mut session = Session {
            emulator: self.clone(),
            folder: folder.to_owned(),
            child,
            line: None,
            _registered: registered,
        };
        session.line = Some(session.accept(&socket)?);
        Ok(session)
    }
}

impl Session {
    fn accept(&mut self, socket: &TcpListener) -> Result<TcpStream, EmulatorError> {
        let failed = |e| EmulatorError::Io("open the link", e);
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
                Err(_) => self.look(start, START)?,
            }
        }
    }

    /// Waits a little for an image that works, up to `limit` from `start`.
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

    /// Its answer and the changes of the outputs, once all samples of a file are taken.
    pub fn answer(&mut self, limit: Duration) -> Result<Answer, EmulatorError> {
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

    /// The link; once.
    pub fn line(&mut self) -> Option<TcpStream> {
        self.line.take()
    }

    /// Talks over the link; once.
    pub fn client(&mut self) -> Result<Client, EmulatorError> {
        let gone = || EmulatorError::Io("open the link", io::ErrorKind::NotConnected.into());
        let line = self.line().ok_or_else(gone)?;
        Ok(Client::patient(Box::new(line)))
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Result<Option<ExitStatus>, EmulatorError> {
        let status = self.child.try_wait();
        status.map_err(|e| EmulatorError::Io("wait for QEMU", e))
    }

    /// Cuts its power; what it logged.
    pub fn cut(mut self) -> Result<Vec<String>, EmulatorError> {
        self.stop();
        self.log()
    }

    fn log(&self) -> Result<Vec<String>, EmulatorError> {
        let elf = read(&self.emulator.image)?;
        self.emulator
            .decode_log(&elf, &read(&self.folder.join("out"))?)
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
