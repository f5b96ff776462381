//! What becomes of a sample as it comes, above everything else: the guard sees it, and it waits for its tick in a ring.
//!
//! Some conversions make a sample: the guard sees each conversion, the tick each sample.
//!
//! A tick that takes long makes those behind it late. Only a full ring loses samples, and their numbers tell which.

use core::mem;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use heapless::spsc::{Consumer, Producer, Queue};
use touchdown_core::guard::{Guard, GuardState};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::oversampling::{Oversampling, OversamplingState};
use touchdown_core::sample::Sample;
use touchdown_core::sensing::Sensing;
use touchdown_protocol::controller::Outputs;
use touchdown_protocol::wire::Incoming;
use touchdown_rotor::error::ConfigError;

/// Samples that can wait, and one: 3.1 ms at 10 kHz. With 15 places the busiest drops that were found lose samples as modelled.
pub const RING: usize = 32;

/// What came and its sample's number, from 0, modulo 2^32; those that were lost have numbers too.
pub type Numbered = (Incoming, u32);

/// Between sampling and tick: the samples that wait, and what the guard on top has taken back.
pub struct Ring {
    waiting: Queue<Numbered, RING>,
    gate: TripGate,
}

impl Ring {
    /// Nothing waits.
    pub const fn empty() -> Self {
        Self {
            waiting: Queue::new(),
            gate: TripGate::open(),
        }
    }

    /// Its two ends, where conversions become samples by `oversampling`; the monitor of `config` must be valid.
    pub fn split<'m>(
        &'m mut self,
        config: &MonitorConfig,
        oversampling: Oversampling,
    ) -> Result<(Intake<'m>, Waiting<'m>), ConfigError> {
        let (samples, waiting) = self.waiting.split();
        let gate = &self.gate;
        // The guard sees conversions.
        let sensing = Sensing::try_new(&oversampling.of_conversions(&config.sensing))?;
        let mut detector = config.detector;
        detector.sample_rate *= f32::from(oversampling.conversions());
        let intake = Intake {
            sensing,
            guard: Guard::try_new(&config.guard, &detector, config.fitted, config.commissioned)?,
            state: GuardState::default(),
            oversampling,
            sample: OversamplingState::default(),
            clear: false,
            samples,
            gate,
        };
        Ok((intake, Waiting { waiting, gate }))
    }
}

/// The end of the highest priority.
pub struct Intake<'m> {
    sensing: Sensing,
    guard: Guard,
    state: GuardState,
    oversampling: Oversampling,
    sample: OversamplingState,
    /// Whether an order to clear came with a conversion of the sample.
    clear: bool,
    samples: Producer<'m, Numbered>,
    gate: &'m TripGate,
}

impl Intake<'_> {
    /// Conversions of a sample.
    pub fn conversions(&self) -> u32 {
        self.oversampling.conversions().into()
    }

    /// Takes a conversion, before which so many were lost. Whether the outputs must be safe now: the guard trips,
    /// and they are not.
    #[inline]
    #[must_use]
    pub fn take(&mut self, arrival: Incoming, lost: u32) -> bool {
        let places = self.sensing.planes(&arrival.sample);
        let levitated = arrival.sample.levitated;
        self.guard.update(&mut self.state, places, levitated);
        self.clear |= arrival.clear;
        let whole = (self.oversampling).take(&mut self.sample, &arrival.sample, lost);
        let number = self.sample.number;
        // Where there is no room it is lost, and the number of the next that has room tells it. The length is looked at so
        // that the compiler knows it is not 0, by which the queue divides.
        if let Some((counts, valid)) = whole
            && self.samples.capacity() < RING
        {
            let sample = Sample {
                counts,
                valid,
                ..arrival.sample
            };
            let clear = mem::take(&mut self.clear);
            let arrival = Incoming {
                sample,
                clear,
                ..arrival
            };
            let _ = self.samples.enqueue((arrival, number));
        }
        let verdict = self.state.verdict;
        (verdict.danger || verdict.lost || verdict.off) && self.gate.trip(number)
    }
}

/// The end of the tick.
pub struct Waiting<'m> {
    waiting: Consumer<'m, Numbered>,
    /// Before the outputs.
    pub gate: &'m TripGate,
}

impl Waiting<'_> {
    /// The oldest that waits.
    #[inline]
    pub fn pop(&mut self) -> Option<Numbered> {
        if self.waiting.capacity() < RING {
            self.waiting.dequeue()
        } else {
            None
        }
    }
}

/// Takes `run` back before the tick gets to the sample that trips.
pub struct TripGate {
    /// What the last tick asked for.
    runs: AtomicBool,
    tripped: AtomicBool,
    /// The sample's number.
    at: AtomicU32,
}

impl TripGate {
    const fn open() -> Self {
        Self {
            runs: AtomicBool::new(false),
            tripped: AtomicBool::new(false),
            at: AtomicU32::new(0),
        }
    }

    /// The guard on top trips; whether there is anything to take back.
    fn trip(&self, number: u32) -> bool {
        if !self.runs.load(Ordering::Relaxed) || self.is_tripped() {
            return false;
        }
        self.at.store(number, Ordering::Relaxed);
        self.tripped.store(true, Ordering::Release);
        true
    }

    /// Whether it holds the outputs safe.
    pub fn is_tripped(&self) -> bool {
        self.tripped.load(Ordering::Acquire)
    }

    /// Whether the tick of the sample that trips is over, and its outputs run all the same.
    pub fn is_overruled(&self, number: u32) -> bool {
        let past = number.wrapping_sub(self.at.load(Ordering::Relaxed));
        self.is_tripped() && past != 0 && past < 1 << 31
    }

    /// What of the outputs after the tick of sample `number` reaches the pins. Once the tick has tripped too its word
    /// counts.
    pub fn pass(&self, outputs: Outputs, number: u32) -> Outputs {
        self.runs.store(outputs.run, Ordering::Relaxed);
        if !self.is_tripped() {
            return outputs;
        }
        let past = number.wrapping_sub(self.at.load(Ordering::Relaxed));
        if outputs.run || past >= 1 << 31 {
            return Outputs::SAFE;
        }
        self.tripped.store(false, Ordering::Release);
        outputs
    }
}
