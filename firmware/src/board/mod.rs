//! What the application asks of a board, and the boards: the only place with registers.

#[cfg(all(target_os = "none", feature = "f405"))]
pub mod f405;
#[cfg(all(target_os = "none", feature = "g474"))]
pub mod g474;
#[cfg(all(target_os = "none", feature = "f405"))]
pub mod qemu;
#[cfg(target_os = "none")]
pub mod silicon;

use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::Notice;
use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::oversampling::{ConverterConfig, Oversampling};
use touchdown_core::sensing::SensingConfig;
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::controller::Shown;
use touchdown_rotor::error::ConfigError;

use crate::cost;

/// A board, as a tick sees it. No call may block.
pub trait Board {
    /// Passes a notice on, where the board has who wants it.
    fn report(&mut self, _notice: &Notice) {}

    /// Drives the outputs, and may tell why; called every tick.
    fn drive(&mut self, shown: Shown);

    /// The configuration block in force, where it is kept.
    fn config(&self) -> &[u8];

    /// Feeds the watchdog, where there is one; the last call of a tick that ran to its end.
    fn feed(&mut self) {}
}

/// What a board can do, which a configuration has to fit.
#[derive(Clone, Copy, Debug)]
pub struct Abilities {
    /// Of its sensors.
    pub converter: ConverterConfig,
    /// Of the core between two conversions; any number where samples wait for it.
    pub cycles: f32,
    /// Whether it takes the pulses of ring and cage.
    pub tachometers: bool,
}

impl Abilities {
    /// The first parameter of `config` that does not fit.
    pub fn misfit(&self, config: &MonitorConfig) -> Option<&'static str> {
        let tuning = &config.detector.tuning;
        let Ok(oversampling) = self.oversampling(config) else {
            return Some("sample_rate");
        };
        if f32::from(oversampling.conversions()) * self.cycles < cost::LEAST {
            Some("sample_rate")
        } else if config.sensing.full_scale != oversampling.full_scale() {
            Some("full_scale")
        } else if config.tachometers.is_some() && !self.tachometers {
            Some("marks")
        } else if self.cycles.is_infinite() {
            None
        } else if tuning.release_instants > cost::MOST_INSTANTS {
            Some("release_instants")
        } else if tuning.impact_instants > cost::MOST_INSTANTS {
            Some("impact_instants")
        } else {
            None
        }
    }

    /// How its conversions become the samples that `config` asks for.
    pub fn oversampling(&self, config: &MonitorConfig) -> Result<Oversampling, ConfigError> {
        Oversampling::try_new(self.converter, config.detector.sample_rate)
    }
}

/// Samples that a controller without a chip takes between two turns of log and link.
pub const BLOCK_SAMPLES: usize = 256;
/// Episodes of its drop log.
pub const EMULATED_SLOTS: usize = 8;

/// Conversions per second of the silicon images, Hz.
pub const CONVERSION_RATE_HZ: u32 = 20_000;
/// Samples per second where nothing else is configured, Hz: each is the sum of two conversions.
pub const SAMPLE_RATE_HZ: u32 = 10_000;

/// Speed of the link, baud.
#[cfg(target_os = "none")]
const BAUD: u32 = 115_200;

/// Settings of a board on which none are stored: the default configuration, and neither speed nor levitation wired.
pub fn default_settings() -> Settings {
    default_config().into()
}

/// Default configuration: the rig of the source paper, four channels of 13 bit over +-1000 um, as two conversions of 12 bit
/// give them.
pub fn default_config() -> MonitorConfig {
    MonitorConfig {
        fitted: 0b1111,
        sensing: SensingConfig {
            resolution: 2_000e-6 / 8_192.0,
            zero_count: 4_096.0,
            full_scale: 8_191,
            mounting_angle: [0.0; 2],
            calibration: None,
            places: None,
        },
        tachometers: None,
        detector: DetectorConfig {
            sample_rate: SAMPLE_RATE_HZ as f32,
            machine: MachineConfig {
                mass: 3.42,
                clearance: 0.3e-3,
                gravity: 9.81,
                rotor_radius: 24e-3,
                inertia_ratio: 0.5,
                friction: 0.1,
                restitution: 0.8,
                // 30 000 rpm, clockwise.
                spin: -3_141.592_7,
            },
            tuning: Tuning::default(),
        },
        guard: GuardConfig::default(),
        commissioned: false,
    }
}
