//! Speed of a retainer ball bearing's inner ring, from optical pulses of the ring or of its cage.
//!
//! The sensors do not tell the way of turning: the ring is taken to turn as the rotor does, which
//! drives it.

mod channel;
pub(crate) mod learnt;

use crate::event::Moment;
use crate::sample::{Edges, TACHOMETERS};
use crate::tachometer::channel::{Channel, ChannelState};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::scales::{not_negative, positive};

/// The sensors and what they look at; SI.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TachometersConfig {
    /// Edges in a turn of the inner ring and of the cage, 1 or more; `None` where that sensor is not
    /// fitted.
    pub marks: [Option<u16>; TACHOMETERS],
    /// Cage speed over inner ring speed, above 0 and below 0.5: (1 - d/D)/2 for balls of diameter d on
    /// a pitch circle of diameter D.
    pub cage_ratio: f32,
    /// Radius at which the ring touches the rotor, m.
    pub bore_radius: f32,
    /// Most that an edge can be off its place, rad; below half of the way between marks.
    pub edge_error: f32,
    /// Time back that a speed is measured over, s, to 0.1. Where two edges take longer, so does it.
    pub window: f32,
}

/// A speed and the most that it is wrong by where it changes evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// Without the way of turning, 0 or more, rad/s.
    pub rate: f32,
    /// rad/s.
    pub error: f32,
}

/// Speed of the inner ring's bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bore {
    /// Along the wall, counter-clockwise positive, m/s.
    pub speed: f32,
    /// Most that it is wrong by, m/s.
    pub error: f32,
}

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Tachometers {
    channels: [Option<Channel>; TACHOMETERS],
    /// Inner ring's speed over that of each sensor's target.
    scale: [f32; TACHOMETERS],
    bore_radius: f32,
}

/// What the sensors carry from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct TachometersState([ChannelState; TACHOMETERS]);

impl TachometersConfig {
    /// Names the first parameter that breaks its rule.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let fitted = || self.marks.into_iter().flatten();
        if fitted().next().is_none() {
            return Err(ConfigError::OutOfRange(
                "marks",
                "given for the inner ring, the cage or both",
            ));
        }
        if fitted().any(|marks| marks == 0) {
            return Err(ConfigError::OutOfRange("marks", "1 or more"));
        }
        positive("cage_ratio", self.cage_ratio)?;
        if self.cage_ratio >= 0.5 {
            return Err(ConfigError::OutOfRange(
                "cage_ratio",
                "above 0 and below 0.5",
            ));
        }
        positive("bore_radius", self.bore_radius)?;
        not_negative("edge_error", self.edge_error)?;
        let half_pitch = |marks| core::f32::consts::PI / f32::from(marks);
        if fitted().any(|marks| self.edge_error >= half_pitch(marks)) {
            return Err(ConfigError::Inconsistent(
                "edge_error",
                "must be below half of the way between marks",
            ));
        }
        positive("window", self.window)?;
        if self.window > 0.1 {
            return Err(ConfigError::OutOfRange("window", "0.1 s or less"));
        }
        Ok(())
    }
}

impl Tachometers {
    /// Checks `config` and prepares for `sample_rate` (Hz).
    pub fn try_new(config: &TachometersConfig, sample_rate: f32) -> Result<Self, ConfigError> {
        config.validate()?;
        let channel = |marks| Channel::new(marks, config.edge_error, config.window, sample_rate);
        Ok(Self {
            channels: config.marks.map(|marks| marks.map(channel)),
            scale: [1.0, 1.0 / config.cage_ratio],
            bore_radius: config.bore_radius,
        })
    }

    /// Takes the edges of sample number `sample`; the inner ring's speed, from its own sensor where
    /// that knows, else from the cage.
    pub fn update(
        &self,
        state: &mut TachometersState,
        sample: u64,
        edges: &[Option<Edges>; TACHOMETERS],
    ) -> Option<Speed> {
        let now = Moment::of_sample(sample);
        let mut found = None;
        let channels = self.channels.iter().zip(&mut state.0);
        for ((channel, state), (edges, scale)) in channels.zip(edges.iter().zip(self.scale)) {
            let speed = channel
                .as_ref()
                .and_then(|channel| channel.update(state, now, *edges));
            found = found.or(speed.map(|speed| Speed {
                rate: speed.rate * scale,
                error: speed.error * scale,
            }));
        }
        found
    }

    /// Speed of the bore of a ring that turns with `speed`, driven by a rotor with this spin (rad/s).
    pub fn bore(&self, speed: Speed, spin: f32) -> Bore {
        let rate = if spin < 0.0 { -speed.rate } else { speed.rate };
        Bore {
            speed: self.bore_radius * rate,
            error: self.bore_radius * speed.error,
        }
    }
}
