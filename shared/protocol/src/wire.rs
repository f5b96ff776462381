//! The bytes of samples and notices, as they pass between desktop and target.
//!
//! A replay file is [`REPLAY_MAGIC`], the length of the [`ReplayHead`] (u32, little-endian), the head (postcard),
//! then one record of [`SAMPLE_BYTES`] a sample to the end of the file ([`encode_sample`]). The answer is
//! [`ANSWER_MAGIC`], then [`NOTICE_BYTES`] records: notices and changes of what the controller shows, then that of the
//! [`Severity`], and last the one of [`Summary`].

use serde::{Deserialize, Serialize};

use crate::controller::{Cause, Outputs, Shown};
use crate::layout::Offset;
use touchdown_core::event::{Alarm, Event, Moment, Notice, Onset, Ordered, Outlook, Touch};
use touchdown_core::fault::{Fault, FaultKind, SPEED};
use touchdown_core::monitor::MonitorConfig;
pub use touchdown_core::monitor::Summary;
use touchdown_core::sample::Sample;
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

/// A sample, and what comes with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Incoming {
    /// Of the sensors.
    pub sample: Sample,
    /// Whether an order to clear comes before it, as a replay may say.
    pub clear: bool,
    /// Whether the service input is on.
    pub service: bool,
}

impl From<Sample> for Incoming {
    fn from(sample: Sample) -> Self {
        Self {
            sample,
            clear: false,
            service: false,
        }
    }
}

/// What comes, and the byte that comes over the line in the sample's period, to the record of a replay.
pub fn encode_sample(incoming: &Incoming, line: Option<u8>) -> [u8; SAMPLE_BYTES] {
    let mut bytes = [0; SAMPLE_BYTES];
    // It has the room.
    let _ = postcard::to_slice(&(incoming, line), &mut bytes);
    bytes
}

/// The record of a replay to what comes; `None` where that is none.
pub fn decode_sample(bytes: &[u8; SAMPLE_BYTES]) -> Option<(Incoming, Option<u8>)> {
    postcard::from_bytes(bytes).ok()
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

/// Of each kind of record its tag, which is its first byte, which field stands at which byte, and the record; then what of the
/// one follows from the other. A number is little-endian and as wide as its type, an enum its code in a byte, `bool` 0 or
/// 1; all else is zero.
macro_rules! records {
    ($($tag:literal [$($field:ident $(: $type:ty)? = $offset:literal),+] { $($record:tt)+ }
        $(put { $($put:tt)+ } get { $($get:tt)+ })?)+) => {
        /// Record to bytes.
        pub fn encode_record(record: &Record) -> [u8; NOTICE_BYTES] {
            let mut bytes = [0; NOTICE_BYTES];
            match *record {
                $($($record)+ => {
                    $($($put)+)?
                    bytes[0] = $tag;
                    $(Offset::put($offset, &$field, &mut bytes);)+
                })+
            }
            bytes
        }

        /// Bytes to record; `None` for an unknown tag, kind, plane, motion, fault or condition.
        pub fn decode_record(bytes: &[u8; NOTICE_BYTES]) -> Option<Record> {
            Some(match bytes[0] {
                $($tag => {
                    $(let $field $(: $type)? = Offset::get($offset, bytes)?;)+
                    $($($get)+)?
                    $($record)+
                })+
                _ => return None,
            })
        }
    };
}

// `code` counts from 1, 0 is for none. `age` is from the estimate to the outlook, in 1/256 of a sample period; `length` from
// a touch's onset to its end, in samples, 0 where it has not ended. `order` is the act as over the link. Tag 10 was another
// record of an order.
records! {
    1 [kind = 1, plane = 2, motion = 3, number = 4, code = 6, channel = 7, at = 8, declared = 16, normal_speed = 24] {
        Record::Notice(Notice::Declared(Event {
            kind, plane, motion, number, fault, onset: Moment(at), declared, normal_speed,
        }))
    } put {
        let (code, channel) = fault.map_or((0, 0), |it| (1 + it.kind as u8, it.channel));
    } get {
        let fault = some_of(FaultKind::from_repr, code)?.map(|kind| Fault { channel, kind });
        if fault.is_some_and(|it| it.channel > SPEED) {
            return None;
        }
    }
    2 [number = 4, sample = 16] { Record::Notice(Notice::Confirmed { number, sample }) }
    3 [number = 4, sample = 16] { Record::Notice(Notice::Withdrawn { number, sample }) }
    4 [conditions = 4, samples = 8, faults = 16, state_hash = 24] {
        Record::Summary(Summary { conditions, samples, faults, state_hash })
    }
    5 [whirls: bool = 1, probability_forward = 4, probability_backward = 8, age: u32 = 12, made_at = 16, times = 24] {
        Record::Notice(Notice::Outlook(Outlook { from, made_at, probability_forward, probability_backward, onset }))
    } put {
        let age = Moment::of_sample(made_at).0.saturating_sub(from.0) as u32;
        let whirls = onset.is_some();
        let times = onset.map_or([0.0; 2], |it| [it.time_left, it.growth_time]);
    } get {
        let from = Moment(Moment::of_sample(made_at).0 - i64::from(age));
        let [time_left, growth_time] = times;
        let onset = whirls.then_some(Onset { time_left, growth_time });
    }
    6 [impacts = 2, impact_speed = 4, impulse = 8, total_impulse = 12, dwell = 16, velocity_index = 20,
        whirl_frequency = 24, whirl_load = 28] {
        Record::Severity(Severity {
            impacts, impact_speed, impulse, total_impulse, dwell, velocity_index, whirl_frequency, whirl_load,
        })
    }
    7 [bits = 1, mode = 2, code = 3, sample = 16] {
        Record::Switching(Switching { sample, shown: Shown { outputs, mode, cause } })
    } put {
        let (bits, code) = (outputs.bits(), Cause::byte_of(cause));
    } get {
        let (outputs, cause) = (Outputs::from_bits(bits)?, some_of(Cause::from_repr, code)?);
    }
    8 [level = 1, plane = 2, sample = 16, fraction = 24] {
        Record::Notice(Notice::Alarm(Alarm { level, plane, sample, fraction }))
    }
    9 [ended: bool = 1, plane = 2, number = 4, onset = 8, declared = 16, peak = 24, length: u32 = 28] {
        Record::Notice(Notice::Touch(Touch { plane, number, onset, declared, peak, end }))
    } put {
        let length = end.map_or(0, |end| end.saturating_sub(onset));
        let (ended, length) = (end.is_some(), u32::try_from(length).unwrap_or(u32::MAX));
    } get {
        let end = ended.then_some(u64::saturating_add(onset, u64::from(length)));
    }
    11 [refused = 1, order: [u8; 6] = 2, sample = 16] {
        Record::Notice(Notice::Ordered(Ordered { refused, act, sample }))
    } put {
        let mut order = [0; 6];
        // It has the room.
        let _ = postcard::to_slice(&act, &mut order);
    } get {
        let act = postcard::from_bytes(&order).ok()?;
    }
}

/// None for code 0, else the one of that place, from 1; nothing where there is none.
fn some_of<T>(of: impl Fn(u8) -> Option<T>, code: u8) -> Option<Option<T>> {
    match code.checked_sub(1) {
        None => Some(None),
        Some(code) => of(code).map(Some),
    }
}
