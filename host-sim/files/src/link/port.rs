//! What a person types for a port.

use std::fmt;
use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::Duration;

use super::error::LinkError;
use super::line::Line;

/// Speed of a serial device; sockets have none.
const BAUD: u32 = 115_200;
/// Longest wait for a connection, and for bytes to go out.
const LIMIT: Duration = Duration::from_secs(2);

/// Where a controller is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Port {
    /// A serial device.
    Serial(String),
    /// `tcp:HOST:PORT`
    Tcp(String),
    /// `unix:PATH`
    Unix(String),
}

impl Port {
    /// A serial device unless it begins with `tcp:` or `unix:`.
    pub fn of(name: &str) -> Self {
        if let Some(address) = name.strip_prefix("tcp:") {
            Self::Tcp(address.to_owned())
        } else if let Some(path) = name.strip_prefix("unix:") {
            Self::Unix(path.to_owned())
        } else {
            Self::Serial(name.to_owned())
        }
    }

    /// Where a file may be meant as well: only what cannot be one.
    pub fn if_no_file(name: &str) -> Option<Self> {
        let port = Self::of(name);
        let is_port = match &port {
            Self::Serial(name) => is_device(name),
            Self::Tcp(_) | Self::Unix(_) => true,
        };
        is_port.then_some(port)
    }

    /// Opens it.
    pub fn open(&self) -> Result<Box<dyn Line>, LinkError> {
        match self {
            Self::Serial(name) => {
                let port = serialport::new(name, BAUD).timeout(LIMIT);
                Ok(Box::new(port.open().map_err(io::Error::from)?))
            }
            Self::Tcp(address) => {
                let mut failure = io::Error::other("no such host");
                for address in address.to_socket_addrs()? {
                    match TcpStream::connect_timeout(&address, LIMIT) {
                        Ok(stream) => {
                            stream.set_nodelay(true)?;
                            stream.set_write_timeout(Some(LIMIT))?;
                            return Ok(Box::new(stream));
                        }
                        Err(error) => failure = error,
                    }
                }
                Err(failure.into())
            }
            #[cfg(unix)]
            Self::Unix(path) => {
                let stream = std::os::unix::net::UnixStream::connect(path)?;
                stream.set_write_timeout(Some(LIMIT))?;
                Ok(Box::new(stream))
            }
            #[cfg(not(unix))]
            Self::Unix(_) => Err(io::Error::from(io::ErrorKind::Unsupported).into()),
        }
    }
}

/// Also one that is unplugged.
fn is_device(name: &str) -> bool {
    let com = name.strip_prefix("COM");
    let is_com = com.is_some_and(|it| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit()));
    is_com || Path::new(name).starts_with("/dev/")
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial(name) => f.write_str(name),
            Self::Tcp(address) => write!(f, "tcp:{address}"),
            Self::Unix(path) => write!(f, "unix:{path}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_told_from_files() {
        let unix = Port::Unix("/tmp/rig".to_owned());
        assert_eq!(Port::if_no_file("unix:/tmp/rig"), Some(unix.clone()));
        assert_eq!(Port::of(&unix.to_string()), unix);
        for device in ["/dev/ttyACM0", "COM3", "tcp:localhost:4000"] {
            assert!(Port::if_no_file(device).is_some(), "{device}");
        }
        for file in ["flash.bin", "COM", "COMPORT", "dev/tty", "./tcp:x"] {
            assert_eq!(Port::if_no_file(file), None, "{file}");
        }
    }
}
