//! A controller that is none: the real server of the link behind a socket, over a machine that does as it is
//! told.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpListener;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use touchdown_core::detect::{DetectorConfig, MachineConfig, Phase, Tuning};
use touchdown_core::event::{Event, EventKind, Moment, Motion, Notice, Plane};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sensing::SensingConfig;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{Block, Key, Settings, Wiring};
use touchdown_protocol::controller::{Busy, Cause, Faults, Mode, Outputs};
use touchdown_protocol::link::{Chunk, Device, Log, Recent, Refusal, Server, State};
use touchdown_protocol::log::counters::Counters;

/// Samples per second, Hz.
pub const SAMPLE_RATE: f32 = 20_000.0;
/// m.
pub const CLEARANCE: f32 = 0.3e-3;
/// A state is told by itself so often.
const EVERY: Duration = Duration::from_millis(50);

/// What it was configured with.
pub fn settings() -> Settings {
    Settings {
        monitor: MonitorConfig {
            fitted: 0b1111,
            sensing: SensingConfig {
                resolution: 0.5e-6,
                zero_count: 2_048.0,
                full_scale: 4_095,
                mounting_angle: [0.0; 2],
                calibration: None,
                places: None,
            },
            tachometers: None,
            detector: DetectorConfig {
                sample_rate: SAMPLE_RATE,
                machine: MachineConfig {
                    mass: 3.42,
                    clearance: CLEARANCE,
                    gravity: 9.81,
                    rotor_radius: 24e-3,
                    inertia_ratio: 0.5,
                    friction: 0.1,
                    restitution: 0.8,
                    spin: -3_141.6,
                },
                tuning: Tuning::default(),
            },
            guard: touchdown_core::guard::GuardConfig::default(),
            commissioned: false,
        },
        wiring: Wiring::default(),
        key: None,
    }
}

/// Levitated, watching, all outputs with current but `permit`.
pub fn state() -> State {
    State {
        sample: 0,
        phase: Phase::Levitated,
        mode: Mode::Watching,
        outputs: Outputs {
            run: true,
            no_brake: true,
            permit: false,
            ready: true,
        },
        faults: Faults::NONE,
        cause: Some(Cause::NoProof),
        ..State::default()
    }
}

/// A declared event, on sample `sample`.
pub fn event(number: u16, kind: EventKind, sample: u64) -> Notice {
    Notice::Declared(Event {
        number,
        kind,
        onset: Moment::of_sample(sample).later(-15.0),
        declared: sample,
        plane: Plane::Both,
        normal_speed: if kind == EventKind::Impact {
            0.0765
        } else {
            0.0
        },
        motion: Motion::Cylindrical,
        fault: None,
    })
}

/// 32 samples of a circle in plane a, of a point in plane b, where only x is there in every fourth.
pub fn circle(sample: u64, step: u16) -> Recent {
    let place = |number: u16| {
        let angle = f64::from(number) * std::f64::consts::TAU / 32.0;
        let count = |it: f64| (2_048.0 + 400.0 * it).round() as u16;
        let by = if number.is_multiple_of(4) {
            u16::MAX
        } else {
            2_048
        };
        [count(angle.cos()), count(angle.sin()), 2_048, by]
    };
    Recent::new(sample, u32::from(step), (0..32).map(place))
}

/// The machine.
pub struct Machine {
    /// Told every 50 ms; its sample counts up.
    pub state: State,
    /// To be told.
    pub notices: Vec<Notice>,
    /// Bytes that go out before anything else.
    pub noise: Vec<u8>,
    /// The log.
    pub episodes: BTreeMap<u32, Vec<u8>>,
    /// What is counted over its life.
    pub lifetime: Option<Counters>,
    /// What it says of its firmware.
    pub firmware: &'static str,
    /// Whether its service input is on.
    pub service: bool,
    /// Of its configuration.
    pub key: Option<Key>,
    /// Episodes that are locked.
    pub locked: BTreeSet<u32>,
    block: Block,
}

impl Device for Machine {
    fn state(&mut self) -> State {
        self.state
    }

    fn config(&mut self) -> Block {
        self.block.clone()
    }

    fn service(&mut self) -> bool {
        self.service
    }

    fn ordered(&mut self, notice: &Notice) {
        self.notices.push(*notice);
    }

    fn set_config(&mut self, _: &[u8], _: &Settings) -> Result<(), Refusal> {
        Err(Refusal::NoStore)
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        Ok(())
    }

    fn recent(&mut self, step: u16) -> Recent {
        circle(self.state.sample, step)
    }

    fn log(&mut self) -> Option<&mut impl Log> {
        Some(self)
    }
}

impl Log for Machine {
    fn episodes(&mut self) -> Option<(u32, u32)> {
        let (first, last) = (self.episodes.keys().next()?, self.episodes.keys().last()?);
        Some((*first, *last))
    }

    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal> {
        let bytes = self.episodes.get(&episode).ok_or(Refusal::NoEpisode)?;
        let rest = bytes.get(offset as usize..).unwrap_or_default();
        let _ = chunk.extend_from_slice(&rest[..rest.len().min(chunk.capacity())]);
        Ok(bytes.len() as u32)
    }

    fn erase(&mut self, episode: u32) -> Result<(), Refusal> {
        if self.locked.contains(&episode) {
            return Err(Busy::Locked.into());
        }
        let erased = self.episodes.remove(&episode);
        erased.map(|_| ()).ok_or(Refusal::NoEpisode)
    }

    fn set_locked(&mut self, episode: u32, locked: bool) -> Result<(), Refusal> {
        if !self.episodes.contains_key(&episode) {
            return Err(Refusal::NoEpisode);
        }
        if locked {
            self.locked.insert(episode);
        } else {
            self.locked.remove(&episode);
        }
        Ok(())
    }

    fn lifetime(&mut self) -> Option<Counters> {
        self.lifetime
    }
}

impl Default for Machine {
    fn default() -> Self {
        Self {
            state: state(),
            notices: Vec::new(),
            noise: Vec::new(),
            episodes: BTreeMap::new(),
            lifetime: None,
            firmware: "0.1.0",
            service: false,
            key: None,
            locked: BTreeSet::new(),
            block: config_block::encode(&settings()),
        }
    }
}

/// A stream of either kind.
trait Stream: Read + Write + Send {}
impl<T: Read + Write + Send> Stream for T {}

/// The machine on a socket. Unplugged when dropped.
pub struct Controller {
    machine: Arc<Mutex<Machine>>,
    plugged: Arc<Mutex<bool>>,
    server: Option<JoinHandle<()>>,
}

impl Controller {
    /// On a Unix socket.
    pub fn at_path(path: &Path, machine: Arc<Mutex<Machine>>) -> Self {
        let _ = std::fs::remove_file(path);
        let listener = UnixListener::bind(path).expect("a socket");
        listener.set_nonblocking(true).expect("a socket");
        Self::serve(machine, move || {
            let (stream, _) = listener.accept().ok()?;
            stream.set_nonblocking(true).expect("a stream");
            Some(Box::new(stream))
        })
    }

    /// On a TCP socket, and its port's name.
    pub fn at_tcp(machine: Arc<Mutex<Machine>>) -> (Self, String) {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a socket");
        listener.set_nonblocking(true).expect("a socket");
        let name = format!("tcp:{}", listener.local_addr().expect("an address"));
        let controller = Self::serve(machine, move || {
            let (stream, _) = listener.accept().ok()?;
            stream.set_nonblocking(true).expect("a stream");
            Some(Box::new(stream))
        });
        (controller, name)
    }

    /// The machine.
    pub fn machine(&self) -> MutexGuard<'_, Machine> {
        self.machine.lock().expect("a machine")
    }

    fn serve(
        machine: Arc<Mutex<Machine>>,
        mut accept: impl FnMut() -> Option<Box<dyn Stream>> + Send + 'static,
    ) -> Self {
        let plugged = Arc::new(Mutex::new(true));
        let (of_server, is_plugged) = (machine.clone(), plugged.clone());
        let server = thread::spawn(move || {
            while *is_plugged.lock().expect("a flag") {
                match accept() {
                    Some(stream) => session(stream, &of_server, &is_plugged),
                    None => thread::sleep(Duration::from_millis(2)),
                }
            }
        });
        Self {
            machine,
            plugged,
            server: Some(server),
        }
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        *self.plugged.lock().expect("a flag") = false;
        self.server.take().map(JoinHandle::join);
    }
}

/// Until one of the ends is gone.
fn session(mut stream: Box<dyn Stream>, machine: &Mutex<Machine>, plugged: &Mutex<bool>) {
    let (firmware, key) = {
        let machine = machine.lock().expect("a machine");
        (machine.firmware, machine.key)
    };
    let mut server = Server::new(firmware, SAMPLE_RATE, key);
    let mut told = Instant::now();
    let mut bytes = [0; 512];
    while *plugged.lock().expect("a flag") {
        let came = match stream.read(&mut bytes) {
            Ok(0) => return,
            Ok(came) => came,
            Err(error) if error.kind() == ErrorKind::WouldBlock => 0,
            Err(_) => return,
        };
        let mut machine = machine.lock().expect("a machine");
        let mut out = std::mem::take(&mut machine.noise);
        for notice in std::mem::take(&mut machine.notices) {
            out.extend(server.notice(&notice).expect("a frame"));
        }
        for byte in &bytes[..came] {
            out.extend(server.take(*byte, &mut *machine).into_iter().flatten());
        }
        if told.elapsed() > EVERY {
            told = Instant::now();
            machine.state.sample += 1_000;
            out.extend(server.state(&mut *machine).expect("a frame"));
        }
        drop(machine);
        // What does not fit in the socket's buffer at once does not happen here.
        if stream.write_all(&out).is_err() {
            return;
        }
        if came == 0 {
            thread::sleep(Duration::from_millis(1));
        }
    }
}
