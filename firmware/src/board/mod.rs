//! What the application asks of a board, and the boards: the only place with registers.

#[cfg(target_os = "none")]
pub mod f405;
#[cfg(target_os = "none")]
pub mod qemu;

use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::Notice;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sensing::SensingConfig;

/// The trip output: fail-safe, so loss of power, reset and trip look the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TripOutput {
    /// Watching, and nothing found.
    Energised,
    /// De-energised.
    Tripped,
}

/// A board, as a tick sees it. Neither call may block.
pub trait Board {
    /// Passes a notice on.
    fn report(&mut self, notice: &Notice);

    /// Drives the trip output; called every tick.
    fn drive(&mut self, output: TripOutput);
}

/// Samples per second of the silicon image, Hz.
pub const SAMPLE_RATE_HZ: u32 = 20_000;

/// Configuration of the silicon image: the rig of the source paper, four channels of 12 bit over
/// +-1000 um.
pub fn default_config() -> MonitorConfig {
    MonitorConfig {
        fitted: 0b1111,
        sensing: SensingConfig {
            resolution: 2_000e-6 / 4_096.0,
            zero_count: 2_048.0,
            full_scale: 4_095,
            mounting_angle: [0.0; 2],
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
    }
}
