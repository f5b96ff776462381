//! Episodes as the firmware writes them.

use touchdown_core::event::{Event, EventKind, Moment, Motion, Notice, Plane};
use touchdown_protocol::log::block::{BLOCK_BYTES, Block, Kind};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::ending::{Closing, Ending};
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::waveform::Waveform;
use touchdown_protocol::wire::{Record, encode_record};

const SLOT: usize = 49_152;
/// Samples of an episode.
pub const SAMPLES: usize = 300;
/// Tick of the trigger.
pub const TRIGGER: u64 = 100_000;

/// Of every episode.
pub fn header() -> Header {
    Header {
        firmware: *b"touchdown 0.1.0\0",
        config_hash: 0xdead_beef,
        boot: 7,
        sample_rate: 20_000.0,
        decimation: 1,
        fitted: 0x0f,
        trigger_kind: EventKind::FreeFall,
        trigger: TRIGGER,
        first: TRIGGER - 100,
        planned: SAMPLES as u32,
        resolution: 0.5e-6,
        zero_count: 2047.5,
        full_scale: 4095,
        pulsed: 0,
        mounting_angle: [0.0; 2],
        calibration: None,
    }
}

/// A fall declared 0.75 ms after it began; counts that go up by one a sample.
pub fn episode(sequence: u32) -> Vec<[u8; BLOCK_BYTES]> {
    sealed(sequence, &header())
}

/// The same with a header of its own.
pub fn sealed(sequence: u32, header: &Header) -> Vec<[u8; BLOCK_BYTES]> {
    let mut blocks = vec![Block::of(Kind::Header, &header.encode()); 2];
    let mut done = 0;
    while done < SAMPLES {
        let left = (done..SAMPLES).map(|k| [2048 + k as u16, 2047, 2048, 2000]);
        let (block, taken) = Waveform::block(done as u32, left);
        blocks.push(block);
        done += taken;
    }
    let notice = Notice::Declared(Event {
        number: 0,
        kind: EventKind::FreeFall,
        onset: Moment::of_sample(TRIGGER).later(-15.0),
        declared: TRIGGER,
        plane: Plane::Both,
        normal_speed: 0.0,
        motion: Motion::Cylindrical,
        fault: None,
    });
    blocks.push(Block::of(
        Kind::Events,
        &encode_record(&Record::Notice(notice)),
    ));
    let ending = Ending {
        closing: Closing::Quiet,
        landing: true,
        blocks: blocks.len() as u16 + 2,
        samples: SAMPLES as u32,
        notices: 1,
        notices_lost: 0,
        index: 0.99,
        last: TRIGGER + 20_000,
        latched: None,
    };
    blocks.extend([Block::of(Kind::Ending, &ending.encode()); 2]);
    let sealed = blocks.iter().enumerate();
    sealed
        .map(|(index, block)| block.seal(sequence, index as u16))
        .collect()
}

/// Of a log with some past.
pub const COUNTERS: Counters = Counters {
    generation: 3,
    boots: 7,
    episodes: 2,
    landings: 5,
    uncleared: None,
    unweighed: 1,
    touches: 5,
    lost: 3,
    weight: 4_321,
};

/// Counters, then a slot for each of the episodes.
pub fn dump(episodes: &[Vec<[u8; BLOCK_BYTES]>]) -> Vec<u8> {
    let mut bytes = vec![0xff; 8192 + SLOT * episodes.len()];
    bytes[128..192].copy_from_slice(&COUNTERS.encode());
    for (slot, pages) in episodes.iter().enumerate() {
        let at = 8192 + SLOT * slot;
        bytes[at..at + BLOCK_BYTES * pages.len()].copy_from_slice(pages.as_flattened());
    }
    bytes
}
