//! What a person types for a port, and the line that it opens: bytes to and from the controller.

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::Duration;

use super::error::LinkError;

/// Speed of a serial device; sockets have none.
const BAUD: u32 = 115_200;
/// Longest wait for a connection, and for bytes to go out.
const LIMIT: Duration = Duration::from_secs(2);

const TCP: &str = "tcp:";
const UNIX: &str = "unix:";

/// A limit of zero would wait for ever.
const SHORTEST: Duration = Duration::from_millis(1);

/// Where a controller is: a serial device, `tcp:HOST:PORT` or `unix:PATH`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port(String);

impl Port {
    /// By its name.
    pub fn of(name: &str) -> Self {
        Self(name.to_owned())
    }

    /// Where a file may be meant as well: only what cannot be one.
    pub fn if_no_file(name: &str) -> Option<Self> {
        let is_port = name.starts_with(TCP) || name.starts_with(UNIX) || is_device(name);
        is_port.then(|| Self::of(name))
    }

    /// Opens it.
    pub fn open(&self) -> Result<Box<dyn Line>, LinkError> {
        if let Some(address) = self.0.strip_prefix(TCP) {
            let mut connected = Err(io::Error::other("no such host"));
            for address in address.to_socket_addrs()? {
                connected = TcpStream::connect_timeout(&address, LIMIT);
                if connected.is_ok() {
                    break;
                }
            }
            let stream = connected?;
            stream.set_nodelay(true)?;
            stream.set_write_timeout(Some(LIMIT))?;
            return Ok(Box::new(stream));
        }
        if let Some(path) = self.0.strip_prefix(UNIX) {
            return unix(path);
        }
        let port = serialport::new(&self.0, BAUD).timeout(LIMIT);
        Ok(Box::new(port.open().map_err(io::Error::from)?))
    }
}

#[cfg(unix)]
fn unix(path: &str) -> Result<Box<dyn Line>, LinkError> {
    let stream = std::os::unix::net::UnixStream::connect(path)?;
    stream.set_write_timeout(Some(LIMIT))?;
    Ok(Box::new(stream))
}

#[cfg(not(unix))]
fn unix(_: &str) -> Result<Box<dyn Line>, LinkError> {
    Err(io::Error::from(io::ErrorKind::Unsupported).into())
}

/// Also one that is unplugged.
fn is_device(name: &str) -> bool {
    let com = name.strip_prefix("COM");
    let is_com = com.is_some_and(|it| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit()));
    is_com || Path::new(name).starts_with("/dev/")
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A line that is open. It ends with an error.
pub trait Line: Send {
    /// How many bytes have come, after at most `limit`: 0 where none have.
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize>;

    /// Sends all of `bytes`.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()>;
}

macro_rules! line {
    ($line:ty, $set_limit:ident) => {
        impl Line for $line {
            fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize> {
                self.$set_limit(limit.max(SHORTEST).into())?;
                come(Read::read(self, bytes))
            }

            fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
                self.write_all(bytes)
            }
        }
    };
}

line!(TcpStream, set_read_timeout);
#[cfg(unix)]
line!(std::os::unix::net::UnixStream, set_read_timeout);
line!(Box<dyn serialport::SerialPort>, set_timeout);

/// Nothing in time is no error; an end is one.
fn come(read: io::Result<usize>) -> io::Result<usize> {
    match read {
        Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
        Err(error) => match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => Ok(0),
            _ => Err(error),
        },
        come => come,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_told_from_files() {
        for device in [
            "/dev/ttyACM0",
            "COM3",
            "tcp:localhost:4000",
            "unix:/tmp/rig",
        ] {
            assert!(Port::if_no_file(device).is_some(), "{device}");
        }
        for file in ["flash.bin", "COM", "COMPORT", "dev/tty", "./tcp:x"] {
            assert_eq!(Port::if_no_file(file), None, "{file}");
        }
    }
}
