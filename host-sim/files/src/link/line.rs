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
