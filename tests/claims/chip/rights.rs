//! Who may order what of the image, and inputs that are wrong: refused with the reason, and done with the right.
#![cfg(unix)]

use std::f32::consts::TAU;
use std::fs;
use std::io::{self, Sink};
use std::net::TcpStream;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use predicates::str::contains;
use tempfile::TempDir;
use touchdown_core::event::{Act, EventKind, Notice};
use touchdown_core::fault::SPEED;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::{Calibration, PlaneCalibration};
use touchdown_files::link::{Client, Line, LinkError};
use touchdown_firmware::board::{default_config, default_settings};
use touchdown_protocol::config_block;
use touchdown_protocol::controller::{Busy, Fault, Mode};
use touchdown_protocol::link::{Refusal, State};
use touchdown_run::drop;
use touchdown_run::emulator::Emulator;
use touchdown_run::monitor_run;
use touchdown_run::target::Target;
use touchdown_scene::Scene;
use touchdown_sim::rig::{Options, Order, Rig};
use touchdown_tests::binary::touchdown;

/// Far more than anything here takes.
const LONG: Duration = Duration::from_secs(120);

fn emulator() -> Emulator {
    Emulator::find(None).unwrap_or_else(|error| panic!("{error}"))
}

fn rig(folder: &Path) -> Rig {
    let options = Options {
        folder: folder.to_owned(),
        port: 0,
        noise: 0.0,
        fast: true,
    };
    let scene = Scene::load("rig").expect("built-in scene");
    Rig::start(scene, emulator(), options).expect("starts")
}

/// A line that remembers what was sent.
struct Tapped(TcpStream, Arc<Mutex<Vec<Vec<u8>>>>);

impl Line for Tapped {
    fn read(&mut self, bytes: &mut [u8], limit: Duration) -> io::Result<usize> {
        Line::read(&mut self.0, bytes, limit)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.1.lock().expect("frames").push(bytes.to_vec());
        Line::write(&mut self.0, bytes)
    }
}

fn tapped(rig: &Rig) -> (Client, Arc<Mutex<Vec<Vec<u8>>>>) {
    let line = TcpStream::connect(rig.address()).expect("the rig listens");
    line.set_nodelay(true).expect("a socket");
    let sent = Arc::default();
    (Client::patient(Box::new(Tapped(line, Arc::clone(&sent)))), sent)
}

fn state_when(talk: &mut Client, what: &str, holds: impl Fn(&State) -> bool) -> State {
    let start = Instant::now();
    loop {
        let state = talk.state().expect("answers");
        if holds(&state) {
            return state;
        }
        assert!(start.elapsed() < LONG, "not within {LONG:?}: {what}, {state:?}");
    }
}

fn refusal(result: Result<(), LinkError>) -> Refusal {
    match result {
        Err(LinkError::Refused(why)) => why,
        other => panic!("{other:?}"),
    }
}

/// A rotor on an orbit of 60 um at 500 turns a second, whose speed is shown as `spin` says.
fn orbit(index: u64, spin: f32) -> Sample {
    let angle = TAU * 500.0 * index as f32 / 20_000.0;
    // The spin of the default configuration is clockwise.
    let axes = [angle.cos(), -angle.sin()].map(|it| (2_048.0 + 60.0 * it * 4.096 / 2.0).round() as u16);
    Sample {
        counts: [axes[0], axes[1], axes[0], axes[1]],
        valid: 0b1111,
        spin: Some(spin),
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

/// A period that is twice as long or half as long, and one of a pulse 1 us late, change nothing. A speed that stays is
/// believed, and told as a fault.
#[test]
fn a_wrong_period_of_the_speed_pulse_changes_nothing_on_desktop_and_target() {
    let right = -TAU * 500.0;
    let late = -TAU * 63e6 / 60.0;
    let run = |wrong: f32, samples: u64| {
        let stream = || {
            (0..16_000).map(move |index| {
                let is_wrong = (12_000..12_000 + samples).contains(&index);
                orbit(index, if is_wrong { wrong } else { right })
            })
        };
        let config = default_config();
        let desktop = monitor_run::run(&config, stream()).expect("a valid configuration");
        let target = emulator().run(&config, stream()).expect("runs");
        assert_eq!(target.notices, desktop.notices);
        assert_eq!(target.summary, desktop.summary);
        target.notices
    };
    let plain = run(right, 0);
    let is_fall = |it: &Notice| matches!(it, Notice::Declared(event) if event.kind == EventKind::FreeFall);
    assert!(!plain.iter().any(is_fall));
    let of_speed = |it: &&Notice| {
        matches!(it, Notice::Declared(event) if event.fault.is_some_and(|it| it.channel == SPEED))
    };
    // A period of the pulse is 40 samples.
    for (wrong, samples) in [(2.0 * right, 40), (0.5 * right, 80), (late, 1)] {
        let told = run(wrong, samples);
        let others: Vec<_> = told.iter().filter(|it| !of_speed(it)).copied().collect();
        assert_eq!(others, plain, "{wrong}");
    }
    let stays = run(2.0 * right, 4_000);
    assert!(stays.iter().any(|it| of_speed(&it)), "{stays:?}");
}

/// Clear, lock and erase by the program, on the image that falls, lies and floats; and frames that are said again.
#[test]
fn orders_take_a_right_and_a_recorded_one_is_none() {
    let folder = TempDir::new().expect("a folder");
    let rig = rig(folder.path());
    let port = format!("tcp:{}", rig.address());
    let run = |line: &str| touchdown(folder.path()).args(line.split(' ')).assert();
    let (mut talk, _) = tapped(&rig);
    rig.order(Order::Lift);
    state_when(&mut talk, "watching, and armed", |it| it.outputs.ready);
    drop(talk);
    run(&format!("clear {port}")).code(1).stderr(contains("its service input must be on"));
    rig.order(Order::Service(true));
    let (mut talk, sent) = tapped(&rig);
    let start = Instant::now();
    while talk.order(Act::Erase(1)) == Err(LinkError::Refused(Busy::Service.into())) {
        assert!(start.elapsed() < LONG, "the service input is not seen");
    }
    // While it runs nothing is erased and no configuration taken.
    assert_eq!(refusal(talk.order(Act::Erase(1))), Busy::Watching.into());
    rig.order(Order::Drop);
    state_when(&mut talk, "the drop", |it| it.mode == Mode::Dropped);
    state_when(&mut talk, "permit", |it| it.outputs.permit);
    sent.lock().expect("frames").clear();
    talk.order(Act::Clear).expect("it lies, and is cleared");
    let recorded = sent.lock().expect("frames").clone();
    let state = state_when(&mut talk, "arming", |it| it.mode == Mode::Arming);
    assert!(!state.outputs.run, "clear gives no right to run");
    rig.order(Order::Lift);
    state_when(&mut talk, "watching again", |it| it.outputs.ready);
    rig.order(Order::Drop);
    state_when(&mut talk, "permit", |it| it.mode == Mode::Dropped && it.outputs.permit);
    drop(talk);
    // The very frames that cleared it, twice.
    let mut line = TcpStream::connect(rig.address()).expect("the rig listens");
    for frame in recorded.iter().chain(&recorded) {
        Line::write(&mut line, frame).expect("is sent");
    }
    let mut talk = Client::patient(Box::new(line));
    for _ in 0..20 {
        assert_eq!(talk.state().expect("answers").mode, Mode::Dropped);
    }
    drop(talk);
    run(&format!("log list {port}")).success();
    run(&format!("log lock {port} 1")).success().stdout(contains("episode 1 is locked"));
    run(&format!("log erase {port} 1")).code(1).stderr(contains("the episode is locked"));
    run(&format!("log unlock {port} 1")).success();
    run(&format!("log erase {port} 1")).success().stdout(contains("episode 1 is erased"));
    run(&format!("clear {port}")).success().stdout(contains(": cleared"));
    rig.stop().expect("no failure");
}

/// One for another rate: never current, nor by an order.
#[test]
fn a_configuration_of_another_board_is_a_fault_that_no_order_clears() {
    let folder = TempDir::new().expect("a folder");
    let mut settings = default_settings();
    settings.monitor.detector.sample_rate = 10_000.0;
    fs::write(folder.path().join("settings"), config_block::encode(&settings)).expect("a file");
    let rig = rig(folder.path());
    let (mut talk, _) = tapped(&rig);
    let state = state_when(&mut talk, "6 000 samples", |it| {
        assert_eq!(it.outputs.bits(), 0);
        it.sample > 6_000 && it.sample != u64::MAX
    });
    assert_eq!(state.mode, Mode::Faulted);
    assert!(state.faults.contains(Fault::ConfigMisfit));
    rig.order(Order::Service(true));
    let start = Instant::now();
    while refusal(talk.order(Act::Clear)) != Busy::Configuration.into() {
        assert!(start.elapsed() < LONG, "the service input is not seen");
    }
    rig.stop().expect("no failure");
}

/// Zero, gain and skew of a commissioning check are in force on the target as on the desktop.
#[test]
fn a_check_on_record_gives_the_same_bits() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    let planes = [[1.2, 0.85], [0.9, 1.1]].map(|gain| PlaneCalibration {
        zero: [30e-6, -20e-6],
        gain,
        skew: 0.05,
    });
    let sensors = &mut scene.sensors;
    sensors.skew = planes.map(|it| f64::from(it.skew));
    for (channel, error) in sensors.gain_error.iter_mut().enumerate() {
        *error = f64::from(planes[channel / 2].gain[channel % 2]) - 1.0;
        sensors.offset[channel] = planes[channel / 2].zero[channel % 2].into();
    }
    let run = |scene: &Scene, target: Target| drop::run::<Sink>(scene, &target, None).expect("drops").0.detection;
    let without = run(&scene, Target::Host);
    scene.sensors.calibration = Some(Calibration { date: 20_261_124, planes });
    let desktop = run(&scene, Target::Host);
    assert_eq!(run(&scene, Target::Qemu(emulator())), desktop);
    let impacts = |it: &touchdown_run::outcome::Detection| {
        it.events.iter().filter(|it| it.event == EventKind::Impact).count()
    };
    println!("{} impacts with the record, {} without", impacts(&desktop), impacts(&without));
    assert!(impacts(&desktop) > impacts(&without));
}
