//! The emulated rig: the image in QEMU at the pace of its samples, a machine that falls when told, and a
//! socket for the link. Faults can be put in while it runs.

mod line;
mod machine;
mod pipe;

use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use touchdown_firmware::board::BLOCK_SAMPLES;
use touchdown_protocol::wire::{Incoming, ReplayHead, encode_sample};

use crate::gate::print;
use touchdown_base::failure::Failure;
use touchdown_run::emulator::{Emulator, EmulatorError, RESTART, Session};
use touchdown_scene::Scene;
use touchdown_scene::sensors::Failing;

use self::line::LineOrder;
use self::machine::Machine;
use self::pipe::Pipe;

/// A block that is later than that is not made up for.
const LATEST: Duration = Duration::from_millis(100);

/// How a rig is started.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where `log`, the flash, and `settings`, the stored configuration, are and stay.
    pub folder: PathBuf,
    /// Of the socket; 0 for any that is free.
    pub port: u16,
    /// Part of the link's bytes that are spoilt.
    pub noise: f64,
    /// As fast as the emulator can, not at the pace of the samples.
    pub fast: bool,
}

/// What can be ordered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Lift the rotor.
    Lift,
    /// Let it go: the scene's drop.
    Drop,
    /// Make a channel fail.
    Spoil(usize, Failing),
    /// Repair all channels.
    Repair,
    /// Spoil this part of the link's bytes.
    Noise(f64),
    /// Cut the controller's power, and give it back.
    Cut,
    /// Switch its service input on or off.
    Service(bool),
}

/// A rig at work; it stops when this is dropped.
#[derive(Debug)]
pub struct Rig {
    /// Socket of the link.
    pub address: SocketAddr,
    orders: Option<Sender<Order>>,
    starts: Arc<AtomicU32>,
    worker: Option<JoinHandle<Result<(), Failure>>>,
}

impl Rig {
    /// Starts the image over the machine of `scene`, which lies still.
    pub fn start(scene: Scene, emulator: Emulator, options: Options) -> Result<Self, Failure> {
        let socket = |e: io::Error| Failure::Target(format!("cannot open a socket: {e}"));
        let seed = scene.run.seed;
        let (address, line) = line::open(options.port, options.noise, seed).map_err(socket)?;
        let (orders, inbox) = channel();
        let starts = Arc::new(AtomicU32::new(0));
        let supply = Supply {
            emulator,
            scene,
            options,
            line,
            starts: Arc::clone(&starts),
        };
        let worker = thread::spawn(move || run(&supply, &inbox));
        Ok(Self {
            address,
            orders: Some(orders),
            starts,
            worker: Some(worker),
        })
    }

    /// Times that the controller was switched on.
    pub fn starts(&self) -> u32 {
        self.starts.load(Ordering::Acquire)
    }

    /// Orders; whether there is still a rig.
    pub fn order(&self, order: Order) -> bool {
        let orders = self.orders.as_ref();
        orders.is_some_and(|it| it.send(order).is_ok())
    }

    /// Whether it has stopped by itself, which is a failure.
    pub fn has_stopped(&self) -> bool {
        self.worker.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Stops it; why it failed, if it did.
    pub fn stop(mut self) -> Result<(), Failure> {
        self.end().unwrap_or(Ok(()))
    }

    fn end(&mut self) -> Option<Result<(), Failure>> {
        self.orders = None;
        let worker = self.worker.take()?;
        let gone = || Err(Failure::Target("the rig has stopped".to_owned()));
        Some(worker.join().unwrap_or_else(|_| gone()))
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        self.end();
    }
}

/// What the controller is switched on with.
struct Supply {
    emulator: Emulator,
    scene: Scene,
    options: Options,
    line: Sender<LineOrder>,
    starts: Arc<AtomicU32>,
}

impl Supply {
    /// Switches the controller on.
    fn on(&self) -> Result<(Session, Pipe), EmulatorError> {
        let folder: &Path = &self.options.folder;
        let head = ReplayHead::new(self.scene.monitor_config(), true);
        let head = touchdown_run::emulator::replay_head(&head);
        let pipe = head.and_then(|head| Pipe::make(&folder.join("replay"), head));
        let pipe = pipe.map_err(|e| EmulatorError::Io("make a pipe", e))?;
        let mut session = self.emulator.open(folder)?;
        if let Some(socket) = session.line.take() {
            // Without a line the rig ends with its next order.
            let _ = self.line.send(LineOrder::Device(socket));
        }
        self.starts.fetch_add(1, Ordering::AcqRel);
        Ok((session, pipe))
    }
}

/// Until nobody orders any more.
fn run(supply: &Supply, orders: &Receiver<Order>) -> Result<(), Failure> {
    let refused = |e| Failure::Usage(format!("{}: {e}", supply.scene.name));
    let mut machine = Machine::try_new(&supply.scene).map_err(refused)?;
    let (mut session, mut pipe) = supply.on()?;
    let block = Duration::from_secs_f64(BLOCK_SAMPLES as f64 / supply.scene.run.sample_rate);
    let mut due = Instant::now();
    let mut service = false;
    loop {
        let mut cut = false;
        match orders.try_recv() {
            Ok(Order::Lift) => machine.lift(),
            Ok(Order::Drop) => machine.let_go(),
            Ok(Order::Spoil(channel, failing)) => machine.inject(channel, failing),
            Ok(Order::Repair) => machine.repair(),
            // The line lives as long as this.
            Ok(Order::Noise(part)) => drop(supply.line.send(LineOrder::Noise(part))),
            Ok(Order::Cut) => cut = true,
            Ok(Order::Service(on)) => service = on,
            Err(TryRecvError::Disconnected) => return Ok(()),
            Err(TryRecvError::Empty) => {}
        }
        let status = session.ended()?;
        if let Some(status) = status.filter(|it| it.code() != Some(RESTART)) {
            let log = session.cut()?.join("; ");
            let why = format!("the image ended ({status}): {log}");
            return Err(Failure::Target(why));
        }
        if cut || status.is_some() {
            // The old one must be gone before the new one uses its files.
            session.cut()?;
            (session, pipe) = supply.on()?;
        }
        if pipe.is_free() {
            let samples = machine.by_ref().take(BLOCK_SAMPLES);
            let incoming = samples.map(|sample| Incoming {
                service,
                ..sample.into()
            });
            pipe.put(incoming.flat_map(|it| encode_sample(&it, None)));
            if let Some(at) = machine.given_up() {
                print(&format!(
                    "truth given up at {:.4} ms: it would take too long. The rotor rolls to the bottom from there\n",
                    1e3 * at
                ))?;
            }
        }
        if !pipe.push() {
            thread::sleep(Duration::from_micros(500));
        } else if !supply.options.fast {
            due += block;
            let now = Instant::now();
            thread::sleep(due.saturating_duration_since(now));
            due = due.max(now.checked_sub(LATEST).unwrap_or(now));
        }
    }
}
