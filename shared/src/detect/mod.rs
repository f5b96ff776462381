//! The phase detector: motion estimate, hypotheses, phase ladder.
//!
//! | file | says |
//! |---|---|
//! | `noise` | how large the sensors' white noise is, whatever the rotor does |
//! | `levitation` | where the rotor floats, and whether the monitor is armed |
//! | `release` | whether it still floats |
//! | `track` | position and velocity in flight |
//! | `jump` | whether the velocity jumped |
//! | `series` | when the bounces will have died out |
//! | `wall` | angle on the wall; sliding or rolling |
//! | `lift_off` | whether it has left the wall |
//! | `still` | whether it moves at all |
//! | `ladder` | which phase all this makes |
//! | `teller` | the notices of a tick |

mod config;
mod contact;
mod flight;
mod jump;
mod ladder;
mod levitation;
mod lift_off;
mod noise;
mod release;
mod series;
mod still;
mod teller;
mod track;
mod wall;

pub use config::{DetectorConfig, MachineConfig, Tuning};
pub use ladder::{Detector, DetectorState, Phase};
