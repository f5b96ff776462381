//! The application: the monitor's tick, what follows from it for the outputs, and what latches.

use touchdown_core::detect::Phase;
use touchdown_core::event::{Act, EventKind, Notice, Notices, Ordered};
use touchdown_core::forecast::ForecastInput;
use touchdown_core::learnt::Learnt;
use touchdown_core::monitor::{Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::Sample;
use touchdown_protocol::config_block::ConfigScrub;
use touchdown_protocol::controller::{Busy, Cause, Fault, Faults, Mode, Shown};
use touchdown_protocol::link::{Counters, Refusal, State};
use touchdown_rotor::error::ConfigError;

use crate::blind_timer::BlindTimer;
use crate::board::Board;
use crate::lift_interlock::LiftInterlock;
use crate::memory_scrub::MemoryScrub;
use crate::safety::{Findings, Safety};

/// The monitor, what is latched, and the outputs.
#[derive(Clone)]
pub struct App {
    monitor: Monitor,
    state: MonitorState,
    patrol: ConfigScrub,
    coefficients: MemoryScrub,
    blind: BlindTimer,
    permit: LiftInterlock,
    safety: Safety,
    faults: Faults,
    /// Whether the rotor lies still enough on the retainer to be lifted.
    lies_still: bool,
    /// What the self-test has seen: the whole configuration, and the rotor.
    config_tested: bool,
    sensors_tested: bool,
    /// What trips, of the notices since the last look.
    told: Option<Cause>,
    lost: u32,
}

impl App {
    /// Checks `config` and prepares the tick; `found` is what was wrong at power-on.
    pub fn try_new(config: &MonitorConfig, found: Faults) -> Result<Self, ConfigError> {
        Ok(Self::new(Monitor::try_new(config)?, config, found))
    }

    /// As if the rotor had been lifted before the first sample.
    pub fn assume_lift(&mut self) {
        self.state.guard.proof.assume_lift();
    }

    /// As if the monitor had `learnt` that of a rotor that had been lifted.
    pub fn resume(&mut self, learnt: &Learnt) {
        self.state = learnt.into();
        self.assume_lift();
    }

    /// As the log says after power-on: a `drop` that nobody has cleared is latched still.
    pub fn recall(&mut self, drop: Option<Cause>) {
        if let Some(cause) = drop {
            self.safety.recall(cause);
        }
    }

    /// Takes note of the coefficients where they lie: from now on a change of them is a fault. For who did not, the first
    /// pass does it.
    #[inline(never)]
    pub fn learn_memory(&mut self) {
        self.coefficients.learn(&self.monitor);
    }

    /// With the monitor of `config`, made in its place: the state's default would take 2.2 kB more of the stack.
    pub(crate) fn new(monitor: Monitor, config: &MonitorConfig, found: Faults) -> Self {
        let sample_rate = config.detector.sample_rate;
        Self {
            state: monitor.start(),
            monitor,
            patrol: ConfigScrub::default(),
            coefficients: MemoryScrub::default(),
            blind: BlindTimer::new(sample_rate),
            permit: LiftInterlock::new(&config.detector, config.fitted),
            safety: Safety::default(),
            faults: found,
            lies_still: false,
            config_tested: false,
            sensors_tested: false,
            told: None,
            lost: 0,
        }
    }

    /// One sample, before which `lost` were lost: every notice goes to the board, in order, then the
    /// outputs, and last of all the watchdog is fed. The notices are left for the recorder. One that was `missed` was never
    /// taken, and the next one that was does what follows. Returns what the outputs show after it.
    #[inline]
    pub fn take(
        &mut self,
        board: &mut impl Board,
        sample: &Sample,
        missed: bool,
        lost: u32,
        notices: &mut Notices,
    ) -> Shown {
        self.monitor.take(&mut self.state, sample, missed, notices);
        if missed {
            self.hear(board, notices);
            return self.shown();
        }
        let shown = self.follow(board, notices, lost);
        board.feed();
        shown
    }

    /// What the forecast below the tick needs; an estimate only where it `asks` for one.
    pub fn forecast_input(&self, wants_input: bool) -> ForecastInput {
        self.monitor.forecast_input(&self.state, wants_input)
    }

    /// What follows from the notices of a tick, after `lost` samples and one that was taken: returns what was driven.
    pub fn follow(&mut self, board: &mut impl Board, notices: &[Notice], lost: u32) -> Shown {
        self.hear(board, notices);
        let (places, phases) = (self.state.places(), self.state.detector.phases());
        // What was proven to float does not lie: how long it has lain counts from then on.
        let may_lie = places.filter(|_| !self.safety.is_proven());
        self.lies_still = self.permit.take(may_lie, phases);
        self.watch_itself(board.config(), places.is_some(), lost);
        let was_latched = self.safety.is_latched();
        self.safety.step(&Findings {
            guard: self.state.guard.verdict,
            told: self.told.take(),
            sees_all: !self.state.lacks,
            faulted: self.faults.trip(),
            tested: self.config_tested && self.sensors_tested,
            lies: self.state.detector.phase().is_contact(),
            lies_still: self.lies_still,
        });
        if self.safety.is_latched() && !was_latched {
            self.state.guard.proof.forget();
        }
        let shown = self.shown();
        board.drive(shown);
        shown
    }

    fn hear(&mut self, board: &mut impl Board, notices: &[Notice]) {
        for notice in notices {
            // Whirl weighs most: it takes the brake where nothing has been proven to float as well.
            if self.told != Some(Cause::Whirl) {
                self.told = trip_of(notice).or(self.told);
            }
            self.permit.hear(notice);
            board.report(notice);
        }
    }

    /// The monitor and its state, for who counts the parts of a tick or plants a fault.
    pub fn monitor(&mut self) -> (&Monitor, &mut MonitorState) {
        (&self.monitor, &mut self.state)
    }

    fn watch_itself(&mut self, block: &[u8], sees: bool, lost: u32) {
        if lost > 0 {
            self.lost = self.lost.saturating_add(lost);
            self.latch(Fault::Overrun);
        }
        if self.blind.miss(lost) {
            self.latch(Fault::Overload);
        }
        // Before the rotor has been proven to float, sensors may come late.
        let lost = self.state.guard.verdict.lost && self.safety.is_proven();
        let is_blind = self.blind.look(sees) || lost;
        if is_blind && (self.safety.is_proven() || self.safety.is_latched()) {
            self.latch(Fault::SensorsLost);
        }
        self.sensors_tested |= self.blind.has_seen();
        match self.patrol.step(block) {
            Some(true) => self.config_tested = true,
            Some(false) => self.latch(Fault::ConfigChanged),
            None => {}
        }
        if self.coefficients.step(&self.monitor) == Some(false) {
            self.latch(Fault::MemoryChanged);
        }
    }

    fn latch(&mut self, fault: Fault) {
        self.faults = self.faults.with(fault);
    }

    /// Clears what is latched. Refused while the rotor is neither floating nor lying still, while the sensors are gone,
    /// and without a configuration of its own; another fault whose cause lasts comes back.
    pub fn clear(&mut self) -> Result<(), Busy> {
        if self.faults.lasting() {
            return Err(Busy::Configuration);
        }
        if self.state.position().is_none() {
            return Err(Busy::Blind);
        }
        if self.drop_runs() {
            return Err(Busy::DropRuns);
        }
        self.state.forget_wall();
        let had = core::mem::replace(&mut self.faults, Faults::NONE);
        if self.shown().mode == Mode::Watching && !had.trip() {
            return Ok(());
        }
        self.safety.clear();
        self.state.guard.proof.restart();
        (self.config_tested, self.sensors_tested) = (false, false);
        self.blind.forget();
        Ok(())
    }

    /// Likewise, by an order that comes with a sample, as a replay may have it; what came of it.
    pub fn clear_as_ordered(&mut self) -> Notice {
        let refused = self.clear().err();
        Notice::Ordered(Ordered {
            act: Act::Clear,
            refused: refused.map_or(0, |it| Refusal::from(it).code()),
            sample: self.state.samples.wrapping_sub(1),
        })
    }

    /// Whether the controller may be reset to take another configuration.
    pub fn may_restart(&self) -> Result<(), Busy> {
        match self.shown().mode {
            _ if self.drop_runs() => Err(Busy::DropRuns),
            Mode::Watching => Err(Busy::Watching),
            Mode::Dropped => Err(Busy::Latched),
            Mode::SelfTest | Mode::Arming | Mode::Faulted => Ok(()),
        }
    }

    /// Whether the rotor falls, bounces, slides or whirls.
    pub fn drop_runs(&self) -> bool {
        self.state.detector.phase() >= Phase::FreeFall && !self.lies_still
    }

    /// With its next tick it trips by `cause`, if levitation is proven: the guard on top has tripped.
    pub fn trip(&mut self, cause: Cause) {
        self.told = Some(cause);
    }

    /// What goes on, for the link; the last tick was `age_us` ago.
    pub fn report(&self, age_us: u32, lost_notices: u32) -> State {
        let shown = self.shown();
        State {
            sample: self.state.samples.wrapping_sub(1),
            age_us,
            phase: self.state.detector.phase(),
            mode: shown.mode,
            cause: shown.cause,
            touches: self.state.touch.count,
            outputs: shown.outputs,
            faults: self.faults,
            counters: Counters {
                lost_samples: self.lost,
                unusable_values: self.state.faults,
                lost_notices,
                damaged_frames: 0,
            },
        }
    }

    /// The monitor's state after the last tick.
    pub fn state(&self) -> &MonitorState {
        &self.state
    }

    /// The latched faults, after the last tick.
    pub fn faults(&self) -> Faults {
        self.faults
    }

    /// Outputs, mode and cause after the last tick.
    pub fn shown(&self) -> Shown {
        let armed = self.state.detector.is_armed();
        self.safety.shown(self.faults, self.lies_still, armed)
    }
}

/// What of a notice trips.
fn trip_of(notice: &Notice) -> Option<Cause> {
    match notice {
        Notice::Confirmed { .. } => Some(Cause::Fall),
        Notice::Declared(event) => match event.kind {
            EventKind::ForwardWhirl | EventKind::BackwardWhirl => Some(Cause::Whirl),
            EventKind::Impact | EventKind::Sliding | EventKind::Rolling => Some(Cause::Contact),
            _ => None,
        },
        _ => None,
    }
}
