//! All that is known of the controller by now.

use std::collections::{BTreeMap, VecDeque};

use touchdown_core::event::Notice;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::{PLANES, Sensing};
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::link::{Hello, Recent, State};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::header::Header;
use touchdown_protocol::log::waveform::NO_VALUE;

use super::watcher::{Said, Update};
use touchdown_run::detection;
use touchdown_run::outcome::DetectedEvent;
use touchdown_run::timebase::Timebase;

/// Positions of a plane that are shown.
const TRAIL: usize = 640;
/// Events that are kept.
const EVENTS: usize = 100;
/// Over which rates are measured, s.
const WINDOW: f64 = 2.0;

/// The line's state, since when (s), and why it is not open.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Link {
    /// Nothing was tried yet.
    #[default]
    New,
    /// A controller answers.
    Up(f64),
    /// It does not.
    Down(f64, String),
}

/// All that is known of a controller.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    /// The port's name.
    pub port: String,
    /// The line.
    pub link: Link,
    /// Who answered last.
    pub hello: Option<Hello>,
    /// Its configuration.
    pub settings: Option<Settings>,
    sensing: Option<Sensing>,
    /// With the time at which it was heard.
    state: Option<(f64, State)>,
    /// Time and sample of the last states; time of the last frames.
    states: VecDeque<(f64, u64)>,
    frames: VecDeque<f64>,
    trails: [VecDeque<[f64; 2]>; PLANES],
    newest: usize,
    events: Vec<DetectedEvent>,
    episodes: BTreeMap<u32, Option<Header>>,
    /// What was counted over the monitor's life.
    pub lifetime: Option<Counters>,
    /// Frames that came damaged.
    pub damaged: u32,
    /// How often the controller began again.
    pub restarts: u32,
}

impl Watched {
    /// Of the controller at `port`, of which nothing is known.
    pub fn new(port: String) -> Self {
        Self {
            port,
            ..Self::default()
        }
    }

    /// Takes in what was heard.
    pub fn take(&mut self, update: &Update) {
        let at = update.at;
        if !matches!(update.said, Said::Lost(_) | Said::Damaged(_)) {
            self.frames.push_back(at);
            self.frames.retain(|it| *it >= at - WINDOW);
        }
        match &update.said {
            Said::Connected(hello, settings) => {
                self.sensing = Sensing::try_new(&settings.monitor.sensing).ok();
                self.hello = Some(hello.clone());
                self.settings = Some(*settings);
                self.link = Link::Up(at);
                self.states.clear();
            }
            Said::Lost(why) => match &mut self.link {
                Link::Down(_, known) => known.clone_from(why),
                _ => self.link = Link::Down(at, why.clone()),
            },
            Said::State(state) => self.go_on(at, state),
            Said::Notice(notice) => self.note(notice),
            Said::Recent(recent) => self.follow(recent),
            Said::Episode(number, header) => {
                self.episodes.insert(*number, *header);
            }
            Said::Lifetime(counters) => self.lifetime = Some(*counters),
            Said::Damaged(count) => self.damaged = *count,
        }
    }

    fn go_on(&mut self, at: f64, state: &State) {
        let before = self.state.map_or(u64::MAX, |(_, it)| it.sample);
        if before != u64::MAX && state.sample < before {
            // Its clock began again: what was told is of another time.
            self.restarts += 1;
            self.states.clear();
            self.events.clear();
        }
        self.state = Some((at, *state));
        self.states.push_back((at, state.sample));
        self.states.retain(|it| it.0 >= at - WINDOW);
    }

    fn note(&mut self, notice: &Notice) {
        let timebase = self.timebase();
        detection::take(&mut self.events, notice, timebase);
        let old = self.events.len().saturating_sub(EVENTS);
        self.events.drain(..old);
    }

    fn follow(&mut self, recent: &Recent) {
        self.newest = 0;
        for planes in self.positions(recent) {
            for (trail, place) in self.trails.iter_mut().zip(planes) {
                trail.extend(place);
            }
            self.newest += 1;
        }
        for trail in &mut self.trails {
            trail.drain(..trail.len().saturating_sub(TRAIL));
        }
    }

    /// Displacement in each plane, m, oldest first.
    pub fn positions(&self, recent: &Recent) -> Vec<[Option<[f64; 2]>; PLANES]> {
        let (Some(sensing), Some(settings)) = (&self.sensing, &self.settings) else {
            return Vec::new();
        };
        let fitted = settings.monitor.fitted;
        let position = |counts: [u16; 4]| {
            let there = (0..).zip(counts).filter(|(_, it)| *it != NO_VALUE);
            let valid = there.fold(0, |bits, (channel, _)| bits | 1 << channel);
            let sample = Sample {
                counts,
                valid: valid & fitted,
                spin: None,
                levitated: None,
                edges: [None; TACHOMETERS],
            };
            let planes = sensing.planes(&sample);
            planes.map(|place| place.map(|it| it.map(f64::from)))
        };
        recent.counts().map(position).collect()
    }

    /// Forgets where the rotor has been.
    pub fn forget_trail(&mut self) {
        self.trails.iter_mut().for_each(VecDeque::clear);
    }

    /// What goes on, as it was told last.
    pub fn state(&self) -> Option<&State> {
        self.state.as_ref().map(|it| &it.1)
    }

    /// How old that is at `now`, s: since it was told, and what it said of its own age.
    pub fn age(&self, now: f64) -> Option<f64> {
        let (at, state) = self.state.as_ref()?;
        Some(now - at + 1e-6 * f64::from(state.age_us))
    }

    /// Samples per second that the controller takes, measured; `None` until that can be told.
    pub fn sample_rate(&self) -> Option<f64> {
        let (first, last) = (self.states.front()?, self.states.back()?);
        let time = last.0 - first.0;
        (time > 0.5 * WINDOW).then(|| last.1.saturating_sub(first.1) as f64 / time)
    }

    /// Frames per second that come at `now`.
    pub fn frame_rate(&self, now: f64) -> f64 {
        let window = WINDOW.min(now).max(1e-3);
        let last = self.frames.iter().filter(|it| **it > now - window);
        last.count() as f64 / window
    }

    /// Where a plane's rotor end has been, oldest first, m, and how many of the last are the newest.
    pub fn trail(&self, plane: usize) -> (impl Iterator<Item = [f64; 2]> + '_, usize) {
        let trail = self.trails.get(plane);
        (trail.into_iter().flatten().copied(), self.newest)
    }

    /// What happened, newest first; times on the controller's clock.
    pub fn events(&self) -> impl Iterator<Item = &DetectedEvent> {
        self.events.iter().rev()
    }

    /// Episodes that were seen in the log, newest first.
    pub fn episodes(&self) -> impl Iterator<Item = (u32, Option<&Header>)> {
        self.episodes.iter().rev().map(|it| (*it.0, it.1.as_ref()))
    }

    /// Samples to seconds since the controller's start.
    pub fn timebase(&self) -> Timebase {
        let rate = self.hello.as_ref().map_or(1.0, |it| it.sample_rate);
        Timebase::new(0.0, f64::from(rate))
    }
}
