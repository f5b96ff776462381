//! The phase detector: motion estimate, hypotheses, phase machine.
//!
//! | file | says |
//! |---|---|
//! | `noise` | how large the sensors' white noise is, whatever the rotor does |
//! | `ring_planes` | where the rotor is at the rings, of what is seen elsewhere |
//! | `possible` | whether the rotor can be where a sample shows it |
//! | `levitation` | where the rotor floats, and whether the monitor is armed |
//! | `trend` | where it goes |
//! | `orbit` | in what orbit, and what of its motion is none |
//! | `release` | whether it still floats |
//! | `fall` | whether it falls |
//! | `track` | position and velocity in flight |
//! | `jump_test` | whether the velocity jumped |
//! | `flight` | the path in the air; `flight::impact`: which jump is an impact |
//! | `give` | whether the wall gives way, and how long a touch lasts |
//! | `series` | when the bounces will have died out |
//! | `retainer_wall` | where the wall is |
//! | `wall` | angle on the wall; sliding or rolling |
//! | `lift_off` | whether it has left the wall |
//! | `still` | whether it moves at all |
//! | `slip` | whether it moves against an inner ring that turns |
//! | `phase_machine` | which phase all this makes |
//! | `ends` | whether the two ends move as one, and what each does |
//! | `detector` | what is learnt, the release, and who follows from there |
//! | `signals` | what it is told besides the position |
//! | `pending` | the fall that is open |
//! | `event_writer` | the notices of a tick |

mod contact;
mod detector;
mod ends;
mod estimate;
mod event_writer;
mod fall;
mod flight;
mod give;
mod jump_test;
mod levitation;
mod lift_off;
mod measurement;
mod next_impact;
mod noise;
mod orbit;
mod pending;
mod phase_machine;
mod possible;
mod release;
mod retainer_wall;
mod ring_planes;
mod series;
mod signals;
mod slip;
mod still;
mod track;
mod trend;
mod wall;

pub use crate::config::{DetectorConfig, MachineConfig, Tuning};
pub use crate::phase::Phase;
pub(crate) use detector::Afloat;
pub(crate) use detector::bits;
pub use detector::{Detector, DetectorState};
pub(crate) use estimate::Exposure;
pub use estimate::{Estimate, Place};
#[cfg(test)]
pub(crate) use noise::white;
pub use signals::{Retainer, Signals};
pub use slip::Slip;
