//! The rig's line: a socket for one desktop at a time, passed on to the image, with noise.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use std::time::Duration;

use super::noise::Noise;

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
            Ok(LineOrder::Noise(part)) => self.noise.set(part),
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
        let ready = stream
            .set_nonblocking(true)
            .and_then(|()| stream.set_nodelay(true));
        self.stream = ready.is_ok().then_some(stream);
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
