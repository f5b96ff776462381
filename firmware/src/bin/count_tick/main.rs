#![no_std]
#![no_main]
//! How many instructions a tick and its parts take: an image for the emulator that writes a table of
//! counts to the file `tick.csv` of the desktop.
//!
//! Each stream is played twice: once for the whole ticks, once part by part. The parts add up to a
//! little more or less than the whole, which the compiler optimises as one. Where there is a file `streams.bin`, the
//! streams that it describes are played in their place, once.

mod scenes;

use core::hint::black_box;
use core::mem::MaybeUninit;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use defmt_semihosting as _;
use panic_probe as _;
use semihosting::fs::File;
use semihosting::io::Read as _;
use semihosting::process;
use stm32f4 as _;

use touchdown_core::event::{Notice, Notices};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::oversampling::{ConverterConfig, Oversampling};
use touchdown_core::sample::Sample;
use touchdown_protocol::config_block::{self, Block};
use touchdown_protocol::controller::{Faults, Shown};

use scenes::{NUMBERS, SCENES, Scene};
use touchdown_counter::{Counter, Table, Tally};
use touchdown_firmware::app::App;
use touchdown_firmware::board::{Board, CONVERSION_RATE_HZ};
use touchdown_firmware::intake::Ring;
use touchdown_firmware::memory;
use touchdown_firmware::recorder::{self, Recorder};
use touchdown_firmware::tick::tick;

/// All but the forecast, which is below the tick, are parts of it.
const PARTS: [&str; 10] = [
    "earlier conversions of a sample",
    "sampling and guard on top",
    "guard",
    "proof, alarms, touches",
    "sensing and health",
    "detector",
    "forecast slice",
    "severity",
    "recorder",
    "outputs",
];

/// What the stack has no room for: samples and application.
type Memory = (recorder::Memory, MaybeUninit<App>);

/// Counts everything and exits the emulator.
#[entry]
fn main() -> ! {
    static mut MEMORY: Memory = (recorder::Memory::EMPTY, MaybeUninit::uninit());
    let counter = Counter::take();
    let mut table = Table::create(c"tick.csv");
    if let Ok(mut file) = File::open(c"streams.bin") {
        let mut bytes = [[0; 4]; NUMBERS];
        for k in 0_u32.. {
            if file.read_exact(bytes.as_flattened_mut()).is_err() {
                break;
            }
            let scene = Scene::described(bytes.map(f32::from_le_bytes));
            let (Tally { calls, sum, worst }, notices) = whole(&counter, &scene, MEMORY);
            table.line(format_args!("tick|stream {k}|{calls}|{sum}|{worst}"));
            table.line(format_args!("notices|stream {k}|{notices}"));
        }
        process::exit(0)
    }
    for scene in SCENES.iter().filter(|it| is_played(it.name)) {
        let name = scene.name;
        let mut write = |part, tally: Tally| {
            let Tally { calls, sum, worst } = tally;
            table.line(format_args!("{part}|{name}|{calls}|{sum}|{worst}"));
        };
        let (whole, notices) = whole(&counter, scene, MEMORY);
        write("tick", whole);
        let parts = parts(&counter, scene, MEMORY);
        for (part, tally) in PARTS.into_iter().zip(parts) {
            write(part, tally);
        }
        table.line(format_args!("notices|{name}|{notices}"));
    }
    process::exit(0)
}

// The runtime asks for an unsafe function; there is nothing unsafe in it.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    process::abort()
}

// Frames of their own, here and below: the recorders of both do not fit the stack at once.
#[inline(never)]
fn whole(counter: &Counter, scene: &Scene, memory: &mut Memory) -> (Tally, u32) {
    let (samples, app) = memory;
    let app = application(scene, app);
    let mut recorder = recorder(scene, samples);
    let mut board = board(scene);
    let mut notices = Notices::new();
    let mut tally = Tally::default();
    let mut told = 0;
    scene.play(|sample| {
        let sample = black_box(sample);
        let ((), instructions) =
            counter.count(|| tick(app, &mut recorder, &mut board, sample, 0, &mut notices));
        told += notices.len() as u32;
        tally.add(instructions);
        // What the loop below the tick does.
        recorder.fetch();
    });
    (tally, told)
}

#[inline(never)]
fn parts(counter: &Counter, scene: &Scene, memory: &mut Memory) -> [Tally; PARTS.len()] {
    let (samples, app) = memory;
    let app = application(scene, app);
    let mut recorder = recorder(scene, samples);
    let mut board = board(scene);
    let mut forecast_task = memory::forecast_task(&scene.config()).expect("a valid configuration");
    let mut notices = Notices::new();
    let mut tallies = [Tally::default(); PARTS.len()];
    let mut ring = Ring::empty();
    let oversampling = oversampling(&scene.config());
    let (mut intake, mut waiting) =
        (ring.split(&scene.config(), oversampling)).expect("a valid configuration");
    scene.play(|sample| {
        let sample = black_box(sample);
        let counts = sample.counts.map(|it| it / oversampling.conversions());
        let conversion = Sample { counts, ..*sample };
        let conversion = black_box(&conversion);
        let ((), earlier) = counter.count(|| {
            for _ in 1..oversampling.conversions() {
                black_box(intake.take((*conversion).into(), 0));
            }
        });
        // The last one puts the sample into the ring.
        let (_, on_top) = counter.count(|| intake.take((*conversion).into(), 0));
        black_box(waiting.pop());
        let (monitor, state) = app.monitor();
        let (places, guard) = counter.count(|| monitor.guard(state, sample));
        let places = black_box(&places);
        let ((), told) = counter.count(|| monitor.tell(state, places, sample, &mut notices));
        let (seen, sensing) = counter.count(|| monitor.sense(state, sample));
        let seen = black_box(&seen);
        let ((), detector) = counter.count(|| monitor.detect(state, seen, &mut notices));
        let ((), severity) = counter.count(|| monitor.update_severity(state, &notices));
        let (shown, outputs) = counter.count(|| app.follow(&mut board, &notices, 0));
        let ((), recording) = counter.count(|| {
            recorder.set_severity(&app.state().severity.so_far);
            recorder.set_phase(app.state().detector.phase(), shown);
            recorder.take(sample, &notices);
        });
        let (outlook, forecast) =
            counter.count(|| forecast_task.work(&app.forecast_input(forecast_task.wants_input())));
        if let Some(outlook) = outlook {
            recorder.hear(&outlook);
        }
        let counts = [
            earlier, on_top, guard, told, sensing, detector, forecast, severity, recording, outputs,
        ];
        tallies
            .iter_mut()
            .zip(counts)
            .for_each(|(tally, it)| tally.add(it));
        recorder.fetch();
    });
    tallies
}

fn application<'a>(scene: &Scene, place: &'a mut MaybeUninit<App>) -> &'a mut App {
    let app = memory::application(place, &scene.config(), Faults::NONE);
    let app = app.expect("a valid configuration");
    // A rotor that floats has been lifted.
    app.assume_lift();
    app
}

#[inline(never)]
fn recorder<'m>(scene: &Scene, samples: &'m mut recorder::Memory) -> Recorder<'m> {
    Recorder::new(samples, &scene.config(), &[], 0)
}

/// That of the chip.
fn oversampling(config: &MonitorConfig) -> Oversampling {
    let converter = ConverterConfig {
        rate: CONVERSION_RATE_HZ as f32,
        full_scale: 4_095,
    };
    Oversampling::try_new(converter, config.detector.sample_rate).expect("a power of two")
}

#[inline(never)]
fn board(scene: &Scene) -> Idle {
    Idle(config_block::encode(&scene.config().into()))
}

/// A board whose registers take nothing.
struct Idle(Block);

impl Board for Idle {
    fn report(&mut self, notice: &Notice) {
        #[cfg(feature = "plants")]
        plants::without_end(notice);
        black_box(notice);
    }

    fn drive(&mut self, shown: Shown) {
        #[cfg(feature = "plants")]
        plants::divisions(shown);
        black_box(shown);
    }

    fn config(&self) -> &[u8] {
        &self.0
    }
}

/// All streams; with plants the one that typical ticks are taken from is enough.
fn is_played(name: &str) -> bool {
    !cfg!(feature = "plants") || name == "orbit, speed known"
}

/// Slow paths, for the tests of the check.
#[cfg(feature = "plants")]
mod plants {
    use super::{Notice, Shown, black_box};

    /// A division in a loop, only where nothing may run: here the self-test.
    #[inline(never)]
    pub fn divisions(shown: Shown) {
        if shown.outputs.bits() == 0 {
            black_box((0..5_000).fold(1.0, |sum: f32, it| sum / black_box(it as f32)));
        }
    }

    /// A loop without a bound of its own, on data that the image's own stream does not have: where the rotor touches.
    #[inline(never)]
    pub fn without_end(notice: &Notice) {
        let mut left = match notice {
            Notice::Touch(_) => black_box(100_000),
            _ => 0,
        };
        while left > 0 {
            left = black_box(left - 1);
        }
    }
}
