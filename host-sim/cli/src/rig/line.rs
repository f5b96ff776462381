//! The rig's line: a socket for one desktop at a time, passed on to the image, with noise: bytes flipped,
//! lost and invented.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use std::time::Duration;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Between two looks where nothing comes.
const LOOK: Duration = Duration::from_micros(500);
/// Kept for an end that does not read; more than that is lost, as on a line.
const KEPT: usize = 1 << 16;

/// What the line is told.
pub enum LineOrder {
    /// The image has another socket: it was started anew.
    Device(TcpStream),
    /// Part of the bytes that are spoilt.
    Noise(f64),
}

/// Opens a socket on `port`, any for 0, and passes on what comes until the sender is gone.
pub fn open(port: u16, noise: f64, seed: u64) -> io::Result<(SocketAddr, Sender<LineOrder>)> {
    let socket = TcpListener::bind(("127.0.0.1", port))?;
    socket.set_nonblocking(true)?;
    let address = socket.local_addr()?;
    let (sender, orders) = channel();
    let mut line = Line {
        socket,
        orders,
        desktop: End::default(),
        device: End::default(),
        noise: Noise::new(noise, seed),
    };
    thread::spawn(move || while line.turn() {});
    Ok((address, sender))
}

struct Line {
    socket: TcpListener,
    orders: Receiver<LineOrder>,
    desktop: End,
    device: End,
    noise: Noise,
}

impl Line {
    /// Whether there is still somebody who gives orders.
    fn turn(&mut self) -> bool {
        match self.orders.try_recv() {
            Ok(LineOrder::Device(stream)) => self.device.connect(stream),
            Ok(LineOrder::Noise(part)) => self.noise.part = part,
            Err(TryRecvError::Disconnected) => return false,
            Err(TryRecvError::Empty) => {}
        }
        if let Ok((stream, _)) = self.socket.accept() {
            self.desktop.connect(stream);
        }
        let (asked, said) = (self.desktop.read(), self.device.read());
        if asked.is_empty() && said.is_empty() {
            thread::sleep(LOOK);
        }
        self.device.write(&self.noise.inject(&asked));
        self.desktop.write(&self.noise.inject(&said));
        true
    }
}

/// An end of the line, where somebody is.
#[derive(Default)]
struct End {
    stream: Option<TcpStream>,
    waiting: Vec<u8>,
}

impl End {
    fn connect(&mut self, stream: TcpStream) {
        let is_ready = stream.set_nonblocking(true).is_ok() && stream.set_nodelay(true).is_ok();
        self.stream = is_ready.then_some(stream);
        self.waiting.clear();
    }

    fn read(&mut self) -> Vec<u8> {
        let mut bytes = [0; 4096];
        match self.stream.as_mut().map(|it| it.read(&mut bytes)) {
            Some(Ok(read)) if read > 0 => return bytes[..read].to_vec(),
            Some(Err(e)) if e.kind() == ErrorKind::WouldBlock => {}
            Some(_) => self.stream = None,
            None => {}
        }
        Vec::new()
    }

    fn write(&mut self, bytes: &[u8]) {
        let Some(stream) = &mut self.stream else {
            return;
        };
        let room = KEPT - self.waiting.len();
        self.waiting.extend(bytes.iter().take(room));
        if self.waiting.is_empty() {
            return;
        }
        match stream.write(&self.waiting) {
            Ok(written) => drop(self.waiting.drain(..written)),
            Err(e) if e.kind() == ErrorKind::WouldBlock => {}
            Err(_) => self.stream = None,
        }
    }
}

struct Noise {
    random: ChaCha8Rng,
    /// Probability that a byte is spoilt.
    part: f64,
}

impl Noise {
    fn new(part: f64, seed: u64) -> Self {
        let random = ChaCha8Rng::seed_from_u64(seed);
        Self { random, part }
    }

    /// What comes out at the other end.
    fn inject(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut out = Vec::with_capacity(bytes.len());
        let spoilt = (self.part.clamp(0.0, 1.0) * 2_f64.powi(32)) as u64;
        for &byte in bytes {
            let is_spoilt = u64::from(self.random.next_u32()) < spoilt;
            let random = self.random.next_u32();
            match random % 3 {
                _ if !is_spoilt => out.push(byte),
                0 => out.push(byte ^ 1 << (random >> 8 & 7)),
                1 => {}
                _ => out.extend([byte, (random >> 8) as u8]),
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_bytes_are_spoilt_as_was_asked() {
        let bytes = [0x55; 30_000];
        assert_eq!(Noise::new(0.0, 1).inject(&bytes), bytes);
        let spoilt = Noise::new(0.01, 1).inject(&bytes);
        let changed = spoilt.iter().filter(|it| **it != 0x55).count();
        // Flipped and invented ones, two thirds of 300: within 4 standard deviations of 14.
        assert!((144..=256).contains(&changed), "{changed}");
        assert!(Noise::new(1.0, 1).inject(&bytes) != bytes);
    }
}
