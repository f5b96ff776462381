//! The contact force from accelerations, as the source paper measures it.
//!
//! A device with known answer to a force: calibrated with known hits, its acceleration in a touchdown is
//! turned back into the force. The device is also simulated ([`instrument`]), so that the whole way can be
//! held against a known force.

pub mod calibration;
pub mod deconvolution;
pub mod example;
pub mod instrument;
mod inverse;
mod law;
mod page;
pub mod pulse;
mod quiet;
pub mod read;
pub mod recording;
pub mod rehearsal;
pub mod resolution;
mod shape;
mod simplex;
pub mod spectrum;
pub mod write;

pub use page::{page, text};

use serde::Serialize;

use calibration::Calibration;
use deconvolution::Force;
use pulse::{Contact, Pulse};
use recording::{Axis, Hits, Recording};
use resolution::Resolution;

use touchdown_base::input_error::InputError;

/// A recording with its force.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    /// In order.
    #[serde(rename = "pulses")]
    pub contacts: Vec<Contact>,
    /// Lowest and highest frequency that all axes are calibrated at, Hz.
    #[serde(rename = "band_hz")]
    pub band: [f64; 2],
    /// Of the recording, Hz.
    #[serde(rename = "sample_rate_hz")]
    pub sample_rate: f64,
    /// Of each axis of the recording.
    #[serde(skip)]
    pub calibrations: Vec<Calibration>,
    /// Recovered.
    #[serde(skip)]
    pub force: Force,
}

impl Measurement {
    /// The numbers of the contacts.
    pub fn pulses(&self) -> impl Iterator<Item = &Pulse> {
        self.contacts.iter().map(|it| &it.pulse)
    }
}

/// Finds the force in `recording`. Hits along one axis stand for both; of two sets, each has its own.
pub fn measure(recording: &Recording, hits: &[Hits]) -> Result<Measurement, InputError> {
    if let [first, second] = hits
        && first.axis == second.axis
    {
        let rule = format!("is for the same axis as {}", first.file);
        return Err(InputError::at_line(&second.file, 1, rule));
    }
    let mut calibrations = Vec::new();
    for (axis, _) in [Axis::X, Axis::Y].iter().zip(&recording.acceleration) {
        let own = hits.iter().find(|it| it.axis == *axis).or(hits.first());
        let Some(own) = own else {
            let rule = "there is no calibration for it";
            return Err(InputError::of_file(&recording.file, rule));
        };
        read::same_rate(recording, own)?;
        calibrations.push(Calibration::new(own)?);
    }
    let band = calibrations.iter().map(|it| &it.band);
    let band = [
        band.clone().map(|it| *it.start()).fold(0.0, f64::max),
        band.map(|it| *it.end()).fold(f64::INFINITY, f64::min),
    ];
    let resolution = Resolution { highest: band[1] };
    let quiet = recording::quiet(recording)?;
    let force = deconvolution::deconvolve(recording, &quiet, &calibrations, &resolution);
    Ok(Measurement {
        contacts: pulse::contacts(recording, &force, &resolution),
        band,
        sample_rate: recording.rate,
        calibrations,
        force,
    })
}
