//! What the detector reports.

use crate::fault::Fault;

/// A moment on the sample clock, in 1/256 of a sample period; sample 0 is the first one seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Moment(pub i64);

impl Moment {
    /// The moment of a whole sample.
    pub const fn of_sample(sample: u64) -> Self {
        Self((sample as i64) << 8)
    }

    /// So many samples (not whole) later; earlier where negative.
    pub const fn later(self, samples: f32) -> Self {
        // In two parts, as the target converts to 32 bits in one instruction.
        let whole = samples as i32;
        let part = ((samples - whole as f32) * 256.0) as i32;
        Self(self.0.saturating_add(((whole as i64) << 8) + part as i64))
    }

    /// Samples from `earlier` to here.
    #[inline(never)] // else the image is larger
    pub fn since(self, earlier: Self) -> f32 {
        // Spans of more than a few hours of samples saturate; none is compared that is so long.
        let span = self.0.saturating_sub(earlier.0);
        let bound = i64::from(i32::MAX);
        span.clamp(-bound, bound) as i32 as f32 / 256.0
    }

    /// Samples and their fraction since sample 0.
    pub fn samples(self) -> f64 {
        self.0 as f64 / 256.0
    }
}

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr, strum::IntoStaticStr)]
#[repr(u8)]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "kebab-case")]
pub enum EventKind {
    /// The rotor is unsupported.
    #[strum(serialize = "free fall")]
    FreeFall = 0,
    /// It hit the retainer.
    Impact = 1,
    /// Permanent contact, with slip.
    Sliding = 2,
    /// Permanent contact, without slip.
    Rolling = 3,
    /// It swings at the bottom of the retainer.
    Pendulum = 4,
    /// It goes round the retainer with the spin: a full turn, or bound to.
    #[strum(serialize = "forward whirl")]
    ForwardWhirl = 5,
    /// It goes round the retainer against the spin: a full turn, or bound to.
    #[strum(serialize = "backward whirl")]
    BackwardWhirl = 6,
    /// Permanent contact ended.
    LiftOff = 7,
    /// In contact and still.
    Rest = 8,
    /// Floating, under control.
    Levitated = 9,
    /// A channel is not to be trusted; the event says why.
    #[strum(serialize = "sensor fault")]
    SensorFault = 10,
}

/// Where it happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr, strum::IntoStaticStr)]
#[repr(u8)]
#[strum(serialize_all = "lowercase")]
pub enum Plane {
    /// Sensor plane a.
    A = 0,
    /// Sensor plane b.
    B = 1,
    /// Judged from both planes together.
    Both = 2,
}

/// How the rotor moved, as far as both planes show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::FromRepr, strum::IntoStaticStr)]
#[repr(u8)]
#[strum(serialize_all = "lowercase")]
pub enum Motion {
    /// Its ends went the same way; also where only one is seen.
    #[default]
    Cylindrical = 0,
    /// Its ends went against each other.
    Conical = 1,
}

/// One event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Counts up from 0 within a run.
    pub number: u16,
    /// What happened.
    pub kind: EventKind,
    /// Estimated physical instant.
    pub onset: Moment,
    /// The sample whose tick declared it.
    pub declared: u64,
    /// Where.
    pub plane: Plane,
    /// Speed into the wall just before an impact, m/s; 0 for other kinds.
    pub normal_speed: f32,
    /// How the rotor moved when it was declared.
    pub motion: Motion,
    /// What is wrong with which channel, of a sensor fault.
    pub fault: Option<Fault>,
}

/// What a tick says: a new event, or the fate of an earlier free fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Notice {
    /// Statistically certain.
    Declared(Event),
    /// No disturbance within the configured limits explains event `number`.
    Confirmed {
        /// The event's number.
        number: u16,
        /// The sample whose tick confirmed it.
        sample: u64,
    },
    /// The rotor was caught: event `number` was a disturbance.
    Withdrawn {
        /// The event's number.
        number: u16,
        /// The sample whose tick withdrew it.
        sample: u64,
    },
    /// What lies ahead, where that is news.
    Outlook(Outlook),
    /// A plane rose through a limit of the guard.
    Alarm(Alarm),
    /// The rotor came to the wall, or left it.
    Touch(Touch),
    /// An order came over the link.
    Ordered(Ordered),
}

/// What can be ordered over the link. The order of variants and fields is its format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
#[derive(serde::Serialize, serde::Deserialize)]
pub enum Act {
    /// Clear what is latched.
    Clear,
    /// Store the configuration that was staged, with this checksum, and start with it.
    #[strum(serialize = "set configuration")]
    Commit(u32),
    /// Erase this episode.
    Erase(u32),
    /// Keep this episode.
    Lock(u32),
    /// Give this episode free to be overwritten.
    Unlock(u32),
}

impl Act {
    /// The episode that it is about.
    pub const fn episode(self) -> Option<u32> {
        match self {
            Self::Clear | Self::Commit(_) => None,
            Self::Erase(number) | Self::Lock(number) | Self::Unlock(number) => Some(number),
        }
    }
}

/// What came of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ordered {
    /// What was ordered.
    pub act: Act,
    /// Why it was not done, a code of the link from 1; 0 where it was.
    pub refused: u8,
    /// The last sample before it.
    pub sample: u64,
}

/// When a whirl begins, and how it grows; s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// From the sample that the outlook was made at to the start of the contact that whirls; negative where it has begun.
    pub time_left: f32,
    /// From the beginning to unbounded growth without gravity, t* = rho0/(mu |v_t|) with v_t along the
    /// wall at the beginning; infinite without friction.
    pub growth_time: f32,
}

/// What lies ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlook {
    /// Sample of the estimate.
    pub from: Moment,
    /// Sample after which it was ready.
    pub made_at: u64,
    /// Of whirl with the spin, 0 to 1.
    pub probability_forward: f32,
    /// Of whirl against the spin, 0 to 1.
    pub probability_backward: f32,
    /// Mean over the runs that whirl, where any does.
    pub onset: Option<Onset>,
}

/// Which limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr, strum::IntoStaticStr)]
#[repr(u8)]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "lowercase")]
pub enum Level {
    /// The lower one, which is told.
    Alert = 0,
    /// The higher one, which trips.
    Danger = 1,
}

/// A plane rose through a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alarm {
    /// A or B.
    pub plane: Plane,
    /// Which limit.
    pub level: Level,
    /// Distance from the told centre in this sample, as a part of the told clearance.
    pub fraction: f32,
    /// The sample whose tick told it.
    pub sample: u64,
}

/// The rotor is at the wall; told when it comes, and again when it has left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Counts up from 0.
    pub number: u16,
    /// Where.
    pub plane: Plane,
    /// First sample at the wall.
    pub onset: u64,
    /// The sample whose tick told it.
    pub declared: u64,
    /// Last sample at the wall, once it has left.
    pub end: Option<u64>,
    /// Greatest distance from the told centre so far, as a part of the told clearance.
    pub peak: f32,
}

/// Most notices that one tick can give: an alarm, a touch, ten of the detector.
pub const NOTICES_PER_TICK: usize = 12;

/// The notices of one tick.
pub type Notices = heapless::Vec<Notice, NOTICES_PER_TICK>;
