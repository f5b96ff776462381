//! The whole controller over a machine of [`crate::plant`], told more or less wrong.

use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::{Notice, Notices};
use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_core::sensing::SensingConfig;
use touchdown_firmware::app::App;
use touchdown_firmware::board::Board;
use touchdown_protocol::config_block::{self, Block, Settings, Wiring};
use touchdown_protocol::controller::{Faults, Shown};

use crate::plant::{Chain, Machine, Phase, Plant, Rng, Truth};

/// Of the shaft at the retainer, m.
pub const ROTOR_RADIUS: f64 = 0.024;

/// What the controller is told, against what is.
pub struct Told {
    /// Told over true gap.
    pub gap: f64,
    /// Its sensors.
    pub chain: Chain,
}

impl Told {
    /// Each plane differently, all wrong by up to `part`; gain by up to two thirds of it.
    pub fn wrong(rng: &mut Rng, part: f64) -> Self {
        let mut chain = Chain::new(rng.next_u64(), 20_000.0);
        let gain = part.min(0.2);
        chain.gain_error = std::array::from_fn(|_| rng.uniform(-gain, gain));
        // In parts of the gap here; see `on`.
        chain.zero = std::array::from_fn(|_| {
            let (far, angle) = (
                rng.uniform(0.0, part),
                rng.uniform(0.0, std::f64::consts::TAU),
            );
            [far * angle.cos(), far * angle.sin()]
        });
        chain.noise = rng.uniform(0.3, 3.0);
        Self {
            gap: 1.0 + rng.uniform(-part, part),
            chain,
        }
    }

    /// All told right.
    pub fn right(rng: &mut Rng) -> Self {
        Self {
            gap: 1.0,
            chain: Chain::new(rng.next_u64(), 20_000.0),
        }
    }

    /// Zero errors in micrometres on this machine.
    fn on(&self, machine: &Machine) -> Chain {
        let mut chain = self.chain.clone();
        let micro = machine.gap * 1e6;
        chain.zero = chain.zero.map(|it| it.map(|part| part * micro));
        chain
    }
}

/// A controller over a run.
pub struct Run {
    /// The controller.
    pub app: App,
    board: Desk,
    /// Of plane b, where the planes move each by itself.
    plants: (Plant, Option<Plant>),
    /// Whether the signal "levitation on" is wired.
    pub has_signal: bool,
    /// The sensors.
    pub chain: Chain,
    /// Channels that tell the same count all the time.
    pub stuck: [Option<u16>; 4],
    rate: f64,
    told_gap: f64,
    /// Readings of the last sample, as parts of the told gap: of each plane, and of that farther out.
    pub readings: [f64; 2],
    /// Likewise.
    pub reading: f64,
    /// Of the last sample.
    pub counts: [u16; 4],
    /// Of the last sample.
    pub notices: Notices,
}

struct Desk(Block);

impl Board for Desk {
    fn report(&mut self, _: &Notice) {}
    fn drive(&mut self, _: Shown) {}
    fn config(&self) -> &[u8] {
        &self.0
    }

    fn feed(&mut self) {}
}

impl Run {
    /// Switched on with the first sample.
    pub fn new(machine: &Machine, phases: &[Phase], told: &Told, rate: f64) -> Self {
        let told_gap = machine.gap * told.gap;
        let config = config(machine, told_gap, rate);
        let settings = Settings {
            monitor: config,
            wiring: Wiring::default(),
            key: None,
        };
        let mut chain = told.on(machine);
        chain.rate = rate;
        Self {
            app: App::try_new(&config, Faults::NONE).expect("a valid configuration"),
            board: Desk(config_block::encode(&settings)),
            plants: (Plant::new(machine, phases), None),
            has_signal: false,
            chain,
            stuck: [None; 4],
            rate,
            told_gap,
            readings: [0.0; 2],
            reading: 0.0,
            counts: [0; 4],
            notices: Notices::new(),
        }
    }

    /// The same of a rotor whose end at plane b moves by itself, as that of `other` does.
    pub fn with_other_end(mut self, other: &Machine, phases: &[Phase]) -> Self {
        self.plants.1 = Some(Plant::new(other, phases));
        self
    }

    /// The next sample; the speed is measured, rad/s. Of ends that are apart what is true of either, and the place of
    /// that in contact or farther out.
    pub fn step(&mut self, spin: f64) -> Option<(Truth, Shown)> {
        let (a, b) = &mut self.plants;
        let mut truth = a.next_sample(self.rate)?;
        let mut places = [truth.place; 2];
        if let Some(b) = b {
            let other = b.next_sample(self.rate)?;
            places[1] = other.place;
            let far = |it: &Truth| it.place[0].hypot(it.place[1]);
            if other.in_contact && !truth.in_contact || far(&other) > far(&truth) {
                (truth.place, truth.velocity) = (other.place, other.velocity);
            }
            truth.in_contact |= other.in_contact;
            truth.afloat &= other.afloat;
        }
        let mut counts = self.chain.counts_of(places);
        for (count, stuck) in counts.iter_mut().zip(self.stuck) {
            *count = stuck.unwrap_or(*count);
        }
        self.counts = counts;
        let sample = Sample {
            counts,
            valid: 0b1111,
            spin: Some(spin as f32),
            levitated: self.has_signal.then_some(truth.amb_on),
            edges: [None; TACHOMETERS],
        };
        let place = |count: u16| (f64::from(count) - 2_048.0) * 2_000e-6 / 4_096.0;
        self.readings = [[counts[0], counts[1]], [counts[2], counts[3]]]
            .map(|[x, y]| place(x).hypot(place(y)) / self.told_gap);
        self.reading = self.readings[0].max(self.readings[1]);
        self.app
            .take(&mut self.board, &sample, false, 0, &mut self.notices);
        Some((truth, self.app.shown()))
    }
}

/// What a machine of this kind is told.
pub fn config(machine: &Machine, told_gap: f64, rate: f64) -> MonitorConfig {
    MonitorConfig {
        fitted: 0b1111,
        sensing: SensingConfig {
            resolution: 2_000e-6 / 4_096.0,
            zero_count: 2_048.0,
            full_scale: 4_095,
            mounting_angle: [0.0; 2],
            calibration: None,
            places: None,
        },
        tachometers: None,
        detector: DetectorConfig {
            sample_rate: rate as f32,
            machine: MachineConfig {
                mass: 3.0,
                clearance: told_gap as f32,
                gravity: machine.gravity as f32,
                rotor_radius: ROTOR_RADIUS as f32,
                inertia_ratio: 0.5,
                friction: machine.friction as f32,
                restitution: machine.restitution as f32,
                spin: machine.spin as f32,
            },
            tuning: Tuning::default(),
        },
        guard: GuardConfig::default(),
        commissioned: machine.gravity == 0.0,
    }
}
