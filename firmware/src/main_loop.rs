//! The main loop below the tick, the same on every board: link, forecast, log.

use touchdown_core::event::Notice;
use touchdown_core::forecast::ForecastTask;
use touchdown_protocol::config_block::{Block, Settings};
use touchdown_protocol::controller::{Faults, Shown};
use touchdown_protocol::link::{Device, Log, Recent, Refusal, Server, State};

use crate::platform::{JournalEntry, LogStore, Platform};
use crate::tick::TickTask;

/// Samples between two states that the link sends unasked.
const STATE_SAMPLES: u64 = 1_000;

/// What it keeps from turn to turn.
pub struct MainLoop {
    server: Server,
    forecast: ForecastTask,
    told: (Shown, Faults),
    /// Samples at the last slice of the forecast, at the next state and at the next round of the log.
    sliced: u64,
    state_due: u64,
    log_due: u64,
    link: Link,
}

/// Of the link.
#[derive(Default)]
struct Link {
    lost_notices: u32,
    /// A configuration was stored, and waits for a start.
    wants_reset: bool,
}

impl MainLoop {
    /// Obeys who has the key of `settings`.
    pub fn new(settings: &Settings, forecast: ForecastTask) -> Self {
        let rate = settings.monitor.detector.sample_rate;
        Self {
            server: Server::new(env!("CARGO_PKG_VERSION"), rate, settings.key),
            forecast,
            told: (Shown::default(), Faults::NONE),
            sliced: 0,
            state_due: STATE_SAMPLES,
            log_due: 0,
            link: Link::default(),
        }
    }

    /// For ever.
    pub fn run<P: Platform>(&mut self, platform: &mut P) -> ! {
        loop {
            self.turn(platform);
        }
    }

    /// One turn. The samples that were taken as it began are done at its end, unless the log is not.
    pub fn turn<P: Platform>(&mut self, platform: &mut P) {
        let samples = platform.hold(TickTask::begin_turn);
        // The number of this power-on is in the log by then: what was recorded before gives no right any more.
        if self.log_due > 0 {
            self.answer(platform);
        }
        if samples != self.sliced {
            self.sliced = samples;
            self.look_ahead(platform);
        }
        let is_stored = self.store(platform, samples);
        self.tell(platform, samples);
        if self.link.wants_reset && platform.is_sent() {
            platform.reset();
        }
        if is_stored {
            platform.done(samples);
        }
    }

    /// Answers what came over the line.
    fn answer<P: Platform>(&mut self, platform: &mut P) {
        while let Some(byte) = platform.receive() {
            let link = &mut self.link;
            let answer = self.server.take(byte, &mut Remote { platform, link });
            if let Some(frame) = answer {
                // An answer without room is asked for again.
                let _ = platform.send(&frame);
            }
        }
    }

    /// A slice of the forecast.
    fn look_ahead<P: Platform>(&mut self, platform: &mut P) {
        let wants_input = self.forecast.wants_input();
        let input = platform.hold(|tick| tick.app.forecast_input(wants_input));
        if let Some(outlook) = self.forecast.work(&input) {
            platform.hold(|tick| tick.hear(&outlook));
        }
        platform.after_slice(&self.forecast);
    }

    /// The log's next thing, in a round that goes on until nothing is left to do; whether none goes on.
    fn store<P: Platform>(&mut self, platform: &mut P, samples: u64) -> bool {
        if samples < self.log_due && !platform.is_over() {
            return true;
        }
        let (counted, latched) =
            platform.hold(|tick| (tick.recorder.counted, tick.app.shown().latched()));
        let Some(mut log) = platform.log().take() else {
            self.log_due = u64::MAX;
            return true;
        };
        let has_more = log.work(counted, latched, || {
            platform.hold(|tick| tick.recorder.fetch())
        });
        *platform.log() = Some(log);
        if !has_more {
            self.log_due = (samples / P::LOG_SAMPLES + 1) * P::LOG_SAMPLES;
        }
        !has_more
    }

    /// Tells journal and link what is new. Where the line is busy a notice waits: an answer always has room behind one.
    fn tell<P: Platform>(&mut self, platform: &mut P, samples: u64) {
        if platform.is_idle()
            && let Some(notice) = platform.hold(|tick| tick.desk.outbox.pop_front())
        {
            platform.write_down(&JournalEntry::Notice(&notice));
            let frame = self.server.notice(&notice);
            let is_lost = frame.is_some_and(|it| !platform.send(&it));
            self.link.lost_notices += u32::from(is_lost);
        }
        let (shown, faults) = platform.hold(|tick| (tick.app.shown(), tick.app.faults()));
        if shown != self.told.0 {
            platform.write_down(&JournalEntry::Shown(shown));
        }
        if faults != self.told.1 {
            platform.write_down(&JournalEntry::Faults(faults));
        }
        self.told = (shown, faults);
        if samples >= self.state_due && platform.is_idle() {
            self.state_due = samples + STATE_SAMPLES;
            let link = &mut self.link;
            if let Some(frame) = self.server.state(&mut Remote { platform, link }) {
                // The next one tells more.
                let _ = platform.send(&frame);
            }
        }
    }
}

/// The controller, as the link sees it.
struct Remote<'a, P> {
    platform: &'a mut P,
    link: &'a mut Link,
}

impl<P: Platform> Device for Remote<'_, P> {
    fn state(&mut self) -> State {
        let (age, lost) = (self.platform.age_us(), self.link.lost_notices);
        self.platform.hold(|tick| {
            tick.app
                .report(age, tick.desk.lost_notices.saturating_add(lost))
        })
    }

    fn config(&mut self) -> Block {
        use crate::board::Board;
        self.platform
            .hold(|tick| Block::from_slice(tick.desk.config()).unwrap_or_default())
    }

    fn service(&mut self) -> bool {
        self.platform.hold(|tick| tick.desk.service)
    }

    fn unknown(&mut self) -> u64 {
        self.platform.unknown()
    }

    fn ordered(&mut self, notice: &Notice) {
        self.platform.hold(|tick| tick.hear(notice));
    }

    fn set_config(&mut self, block: &[u8], settings: &Settings) -> Result<(), Refusal> {
        if let Some(parameter) = self.platform.abilities().misfit(&settings.monitor) {
            return Err(Refusal::parameter(parameter));
        }
        self.platform.hold(|tick| tick.app.may_restart())?;
        self.platform.store(block)?;
        self.link.wants_reset = true;
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        self.platform.hold(|tick| tick.app.clear())?;
        self.platform.forget_reset();
        Ok(())
    }

    fn recent(&mut self, step: u16) -> Recent {
        self.platform.hold(|tick| tick.recorder.recent(step))
    }

    fn log(&mut self) -> Option<&mut impl Log> {
        self.platform.log().as_mut()
    }
}
