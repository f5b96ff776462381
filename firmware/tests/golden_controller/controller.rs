//! The whole controller over a stream, as text.

use std::fmt::Write;

use touchdown_core::checksum::CRC;
use touchdown_core::event::Notices;
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::MonitorConfig;
use touchdown_firmware::app::App;
use touchdown_firmware::board::BLOCK_SAMPLES;
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::recorder::{Memory, Recorder};
use touchdown_firmware::tick::tick;
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::config_block;
use touchdown_protocol::controller::Faults;
use touchdown_protocol::link::Log;
use touchdown_protocol::log::block::BLOCK_BYTES;
use touchdown_protocol::log::reader::{Item, Reader};

use crate::common::chip::{Bus, Chip, NoDelay, flash};
use crate::common::desk::Desk;
use crate::common::rig::episode;
use crate::stream::Stream;

type Episodes = DropLog<W25q<Bus, NoDelay>, 4>;

/// Of the simulated chip, the logarithm of its bytes.
const CAPACITY: u8 = 20;
/// Time after a stream without anything new, in which its last drop ends, s.
const QUIET: f32 = 1.1;

/// Every change of the outputs and what is in the log; then, switched on again with its first episode erased, once more.
pub fn text(stream: &Stream) -> String {
    let (mut log, bus) = mount(Chip::new(CAPACITY));
    let mut text = String::from("Sample, mode, cause, outputs, faults\n");
    run(stream, &mut log, &mut text);
    tell(&mut log, &mut text);
    let chip = bus.0.borrow().clone();
    let (mut log, bus) = mount(chip);
    text += "\nSwitched on again, the first episode erased\n";
    if let Some((first, _)) = log.episodes() {
        log.erase(first).expect("it is there");
    }
    run(stream, &mut log, &mut text);
    tell(&mut log, &mut text);
    assert_eq!(bus.0.borrow().set_bits, 0);
    text
}

fn mount(chip: Chip) -> (Episodes, Bus) {
    let (flash, bus) = flash(chip);
    let Ok(log) = Episodes::mount(flash) else {
        panic!("the chip has room for the slots");
    };
    (log, bus)
}

fn run(stream: &Stream, log: &mut Episodes, text: &mut String) {
    let config: &MonitorConfig = &stream.config;
    let mut desk = Desk(config_block::encode(&(*config).into()));
    let mut memory = Box::new(Memory::EMPTY);
    let mut recorder = Recorder::new(&mut memory, config, &desk.0, log.counters().boots);
    let mut app = App::try_new(config, Faults::NONE).expect("a valid configuration");
    app.assume_lift();
    let mut forecast_task = ForecastTask::try_new(&config.detector).expect("a valid configuration");
    let mut notices = Notices::new();
    let mut last = None;
    for (number, sample) in (0_usize..).zip(&stream.samples) {
        tick(&mut app, &mut recorder, &mut desk, sample, 0, &mut notices);
        if let Some(outlook) = forecast_task.work(&app.forecast_input(forecast_task.wants_input()))
        {
            recorder.hear(&outlook);
        }
        let now = (app.shown(), app.faults());
        if last.replace(now) != Some(now) {
            let (shown, Faults(faults)) = now;
            let (mode, outputs) = (shown.mode, shown.outputs.bits());
            let why = shown.cause.map_or(String::new(), |it| format!(" {it:?}"));
            writeln!(text, "{number:6}  {mode:?}{why} {outputs:04b} {faults:07b}")
                .expect("a string");
        }
        if number % BLOCK_SAMPLES == 0 {
            while log.work(recorder.counted, app.shown().latched(), || recorder.fetch()) == Ok(true)
            {
            }
        }
    }
    writeln!(text, "Clear at the end: {:?}", app.clear()).expect("a string");
    let quiet = (QUIET * config.detector.sample_rate) as usize;
    for sample in stream.samples.last().into_iter().cycle().take(quiet) {
        recorder.take(sample, &[]);
    }
    while log.work(recorder.counted, app.shown().latched(), || recorder.fetch()) == Ok(true) {}
}

fn tell(log: &mut Episodes, text: &mut String) {
    writeln!(text, "\n{:?}", log.lifetime().expect("counters")).expect("a string");
    let range = log.episodes();
    writeln!(text, "episodes {range:?}").expect("a string");
    for number in range.into_iter().flat_map(|(first, last)| first..=last) {
        let bytes = episode(log, number);
        // Without each page's own checksum, after which any page would give the same.
        let mut digest = CRC.digest();
        for page in bytes.chunks_exact(BLOCK_BYTES) {
            digest.update(&page[..BLOCK_BYTES - 4]);
        }
        let checksum = digest.finalize();
        writeln!(text, "\nepisode {number}, checksum {checksum:08x}").expect("a string");
        let mut reader = Reader::new(&bytes);
        for item in &mut reader {
            match item {
                Item::Header(header) => writeln!(text, "{header:?}"),
                Item::Ending(ending) => writeln!(text, "{ending:?}"),
                _ => Ok(()),
            }
            .expect("a string");
        }
        writeln!(text, "{:?}", reader.finish(|_| ())).expect("a string");
    }
}
