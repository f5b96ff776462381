//! The bytes of samples and notices, as they pass between desktop and target.
//!
//! A replay file is [`REPLAY_MAGIC`], the length of the [`ReplayHead`] (u32, little-endian), the head (postcard),
//! then one record of [`SAMPLE_BYTES`] a [`Played`] sample to the end of the file. The answer is
//! [`ANSWER_MAGIC`], then [`NOTICE_BYTES`] records: notices and changes of what the controller shows, then that of the
//! [`Severity`], and last the one of [`Summary`].

use serde::{Deserialize, Serialize};

use crate::controller::{Cause, Mode, Outputs, Shown};
use touchdown_core::event::{
    Alarm, Event, EventKind, Level, Moment, Motion, Notice, Onset, Ordered, Outlook, Plane, Touch,
};
use touchdown_core::fault::{Condition, Fault, FaultKind, SPEED};
use touchdown_core::monitor::MonitorConfig;
pub use touchdown_core::monitor::Summary;
use touchdown_core::sample::{CHANNELS, Sample};
use touchdown_core::severity::Severity;

/// First bytes of a replay file; the last is the version.
pub const REPLAY_MAGIC: [u8; 4] = *b"TDR\x07";
/// First bytes of an answer; the last is the version.
pub const ANSWER_MAGIC: [u8; 4] = *b"TDA\x06";
/// Bytes of a sample's record, as many as the longest takes; zeros behind another.
pub const SAMPLE_BYTES: usize = 34;
/// Bytes of a notice record.
pub const NOTICE_BYTES: usize = 32;

/// What comes before the samples of a replay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplayHead {
    /// In force where none is stored.
    pub config: MonitorConfig,
    /// Whether the controller is switched on with the first sample; else a lift was seen before.
    pub powers_on: bool,
    /// Whether samples come at their rate, whatever becomes of them; else each waits for the one before it.
    pub in_real_time: bool,
    /// Whether `config` counts as configured; else it is as on a chip in which none is stored.
    pub is_configured: bool,
}

impl ReplayHead {
    /// Of a controller that is configured, and whose samples wait for each other.
    pub const fn new(config: MonitorConfig, powers_on: bool) -> Self {
        Self {
            config,
            powers_on,
            in_real_time: false,
            is_configured: true,
        }
    }
}

/// A sample of a replay, and what comes with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Played {
    /// The sample.
    pub sample: Sample,
    /// Whether an order to clear comes before it.
    pub clear: bool,
    /// Whether the service input is on at it.
    pub service: bool,
    /// The byte that comes over the line in its period.
    pub line: Option<u8>,
}

impl From<Sample> for Played {
    fn from(sample: Sample) -> Self {
        Self {
            sample,
            clear: false,
            service: false,
            line: None,
        }
    }
}

impl Played {
    /// As a record.
    pub fn encode(&self) -> [u8; SAMPLE_BYTES] {
        let mut bytes = [0; SAMPLE_BYTES];
        // It has the room.
        let _ = postcard::to_slice(self, &mut bytes);
        bytes
    }

    /// From a record; `None` where that is none.
    pub fn decode(bytes: &[u8; SAMPLE_BYTES]) -> Option<Self> {
        postcard::from_bytes(bytes).ok()
    }
}

/// A change of what the controller shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switching {
    /// Number of the sample whose tick made it, from 0.
    pub sample: u64,
    /// From then on.
    pub shown: Shown,
}

/// A record of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Record {
    /// A notice, as it was given.
    Notice(Notice),
    /// After the notices of its tick.
    Switching(Switching),
    /// The last record but one: of the last drop.
    Severity(Severity),
    /// The last record.
    Summary(Summary),
}

const DECLARED: u8 = 1;
const CONFIRMED: u8 = 2;
const WITHDRAWN: u8 = 3;
const SUMMARY: u8 = 4;
const OUTLOOK: u8 = 5;
const SEVERITY: u8 = 6;
const SWITCHING: u8 = 7;
const ALARM: u8 = 8;
const TOUCH: u8 = 9;
const ORDERED: u8 = 11;

/// Record to bytes: tag, kind, plane, motion, number (u16), what is wrong (from 1) with which channel, then
/// three 8-byte fields. The summary has the conditions of the channels at 4. Of an
/// outlook: tag, whether it has an onset, two zero bytes, then numbers of four bytes around the sample. Of
/// the severity: tag, a zero byte, the impacts (u16), then the other fields in their order (f32). Of a
/// change of what is shown: tag, the outputs' bits, mode, cause (from 1), and its sample at 16. Of an alarm: tag,
/// level, plane, and at 24 the fraction (f32). Of a touch: tag, whether it has ended, plane, number, onset, the sample
/// that told it, peak (f32), and the samples from its onset to its end (u32). Of an order: tag,
/// why not, and the act as over the link. Tag 10 was another record of an order.
pub fn encode_record(record: &Record) -> [u8; NOTICE_BYTES] {
    let mut bytes = [0; NOTICE_BYTES];
    // Without a path to a panic, which the tick may not have.
    let mut put = |at: usize, field: &[u8]| {
        if let Some(place) = bytes.get_mut(at..at + field.len()) {
            place.copy_from_slice(field);
        }
    };
    match *record {
        Record::Notice(Notice::Declared(event)) => {
            let (kind, plane) = (event.kind as u8, event.plane as u8);
            put(0, &[DECLARED, kind, plane, event.motion as u8]);
            put(4, &event.number.to_le_bytes());
            put(8, &event.onset.0.to_le_bytes());
            put(16, &event.declared.to_le_bytes());
            put(24, &event.normal_speed.to_le_bytes());
            if let Some(Fault { channel, kind }) = event.fault {
                put(6, &[1 + kind as u8, channel]);
            }
        }
        Record::Notice(Notice::Confirmed { number, sample }) => {
            put(0, &[CONFIRMED]);
            put(4, &number.to_le_bytes());
            put(16, &sample.to_le_bytes());
        }
        Record::Notice(Notice::Withdrawn { number, sample }) => {
            put(0, &[WITHDRAWN]);
            put(4, &number.to_le_bytes());
            put(16, &sample.to_le_bytes());
        }
        Record::Notice(Notice::Outlook(outlook)) => {
            let onset = outlook
                .onset
                .map_or([0.0; 2], |it| [it.time_left, it.growth_time]);
            let made_at = Moment::of_sample(outlook.made_at);
            let age = made_at.0.saturating_sub(outlook.from.0) as u32;
            put(0, &[OUTLOOK, u8::from(outlook.onset.is_some())]);
            put(4, &outlook.probability_forward.to_le_bytes());
            put(8, &outlook.probability_backward.to_le_bytes());
            put(12, &age.to_le_bytes());
            put(16, &outlook.made_at.to_le_bytes());
            put(24, &onset[0].to_le_bytes());
            put(28, &onset[1].to_le_bytes());
        }
        Record::Notice(Notice::Alarm(alarm)) => {
            put(0, &[ALARM, alarm.level as u8, alarm.plane as u8]);
            put(16, &alarm.sample.to_le_bytes());
            put(24, &alarm.fraction.to_le_bytes());
        }
        Record::Notice(Notice::Touch(touch)) => {
            let length = touch.end.map_or(0, |end| end.saturating_sub(touch.onset));
            let length = u32::try_from(length).unwrap_or(u32::MAX);
            put(0, &[TOUCH, touch.end.is_some() as u8, touch.plane as u8]);
            put(4, &touch.number.to_le_bytes());
            put(8, &touch.onset.to_le_bytes());
            put(16, &touch.declared.to_le_bytes());
            put(24, &touch.peak.to_le_bytes());
            put(28, &length.to_le_bytes());
        }
        Record::Notice(Notice::Ordered(ordered)) => {
            let mut act = [0; 6];
            // It has the room.
            let _ = postcard::to_slice(&ordered.act, &mut act);
            put(0, &[ORDERED, ordered.refused]);
            put(2, &act);
            put(16, &ordered.sample.to_le_bytes());
        }
        Record::Switching(Switching { sample, shown }) => {
            let (outputs, cause) = (shown.outputs.bits(), Cause::byte_of(shown.cause));
            put(0, &[SWITCHING, outputs, shown.mode as u8, cause]);
            put(16, &sample.to_le_bytes());
        }
        Record::Severity(it) => {
            put(0, &[SEVERITY]);
            put(2, &it.impacts.to_le_bytes());
            let fields = [
                it.impact_speed,
                it.impulse,
                it.total_impulse,
                it.dwell,
                it.velocity_index,
                it.whirl_frequency,
                it.whirl_load,
            ];
            for (at, field) in (4..).step_by(4).zip(fields) {
                put(at, &field.to_le_bytes());
            }
        }
        Record::Summary(summary) => {
            put(0, &[SUMMARY]);
            put(4, &summary.conditions.map(|it| it as u8));
            put(8, &summary.samples.to_le_bytes());
            put(16, &summary.faults.to_le_bytes());
            put(24, &summary.state_hash.to_le_bytes());
        }
    }
    bytes
}

/// Bytes to record; `None` for an unknown tag, kind, plane, motion, fault or condition.
pub fn decode_record(bytes: &[u8; NOTICE_BYTES]) -> Option<Record> {
    let eight = |at: usize| {
        let mut field = [0; 8];
        field.copy_from_slice(&bytes[at..at + 8]);
        field
    };
    let four = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    let real = |at: usize| f32::from_le_bytes(four(at));
    let number = u16::from_le_bytes([bytes[4], bytes[5]]);
    let sample = u64::from_le_bytes(eight(16));
    Some(match bytes[0] {
        DECLARED => Record::Notice(Notice::Declared(Event {
            number,
            kind: EventKind::from_repr(bytes[1])?,
            onset: Moment(i64::from_le_bytes(eight(8))),
            declared: sample,
            plane: Plane::from_repr(bytes[2])?,
            normal_speed: real(24),
            motion: Motion::from_repr(bytes[3])?,
            fault: fault(bytes[6], bytes[7])?,
        })),
        CONFIRMED => Record::Notice(Notice::Confirmed { number, sample }),
        WITHDRAWN => Record::Notice(Notice::Withdrawn { number, sample }),
        OUTLOOK => Record::Notice(Notice::Outlook(Outlook {
            from: Moment(Moment::of_sample(sample).0 - i64::from(u32::from_le_bytes(four(12)))),
            made_at: sample,
            probability_forward: real(4),
            probability_backward: real(8),
            onset: (bytes[1] != 0).then(|| Onset {
                time_left: real(24),
                growth_time: real(28),
            }),
        })),
        ALARM => Record::Notice(Notice::Alarm(Alarm {
            plane: Plane::from_repr(bytes[2])?,
            level: Level::from_repr(bytes[1])?,
            fraction: real(24),
            sample,
        })),
        TOUCH => {
            let onset = u64::from_le_bytes(eight(8));
            let length = u64::from(u32::from_le_bytes(four(28)));
            Record::Notice(Notice::Touch(Touch {
                number,
                plane: Plane::from_repr(bytes[2])?,
                onset,
                declared: sample,
                end: (bytes[1] != 0).then_some(onset.saturating_add(length)),
                peak: real(24),
            }))
        }
        ORDERED => Record::Notice(Notice::Ordered(Ordered {
            act: postcard::from_bytes(&bytes[2..8]).ok()?,
            refused: bytes[1],
            sample,
        })),
        SWITCHING => Record::Switching(Switching {
            sample,
            shown: Shown {
                outputs: Outputs::from_bits(bytes[1])?,
                mode: Mode::from_repr(bytes[2])?,
                cause: some_of(Cause::from_repr, bytes[3])?,
            },
        }),
        SEVERITY => Record::Severity(Severity {
            impacts: u16::from_le_bytes([bytes[2], bytes[3]]),
            impact_speed: real(4),
            impulse: real(8),
            total_impulse: real(12),
            dwell: real(16),
            velocity_index: real(20),
            whirl_frequency: real(24),
            whirl_load: real(28),
        }),
        SUMMARY => Record::Summary(Summary {
            samples: u64::from_le_bytes(eight(8)),
            faults: sample,
            conditions: conditions([bytes[4], bytes[5], bytes[6], bytes[7]])?,
            state_hash: u32::from_le_bytes(four(24)),
        }),
        _ => return None,
    })
}

/// None for code 0, else the one of that place, from 1; nothing where there is none.
fn some_of<T>(of: impl Fn(u8) -> Option<T>, code: u8) -> Option<Option<T>> {
    match code.checked_sub(1) {
        None => Some(None),
        Some(code) => of(code).map(Some),
    }
}

fn fault(code: u8, channel: u8) -> Option<Option<Fault>> {
    let kind = some_of(FaultKind::from_repr, code)?;
    (kind.is_none() || channel <= SPEED).then_some(kind.map(|kind| Fault { channel, kind }))
}

fn conditions(codes: [u8; CHANNELS]) -> Option<[Condition; CHANNELS]> {
    let [a, b, c, d] = codes.map(Condition::from_repr);
    Some([a?, b?, c?, d?])
}
