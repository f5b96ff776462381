//! Bytes to and from the controller.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// A line that is open. It ends with an error.
pub trait Line: Send {
    /// How many bytes have come, after at most `limit`: 0 where none have.
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize>;

    /// Sends all of `bytes`.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()>;
}

/// A limit of zero would wait for ever.
const SHORTEST: Duration = Duration::from_millis(1);

impl Line for TcpStream {
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize> {
        self.set_read_timeout(Some(limit.max(SHORTEST)))?;
        come(Read::read(self, bytes))
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }
}

#[cfg(unix)]
impl Line for std::os::unix::net::UnixStream {
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize> {
        self.set_read_timeout(Some(limit.max(SHORTEST)))?;
        come(Read::read(self, bytes))
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }
}

impl Line for Box<dyn serialport::SerialPort> {
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize> {
        self.set_timeout(limit.max(SHORTEST))?;
        come(Read::read(self, bytes))
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }
}

/// Nothing in time is no error; an end is one.
fn come(read: io::Result<usize>) -> io::Result<usize> {
    match read {
        Ok(0) => Err(io::Error::new(
            ErrorKind::UnexpectedEof,
            "the line was closed",
        )),
        Err(error) => match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => Ok(0),
            _ => Err(error),
        },
        come => come,
    }
}
