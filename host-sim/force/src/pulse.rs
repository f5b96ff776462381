//! The contacts in the recovered force, as numbers and curves.

use serde::Serialize;

use super::deconvolution::Force;
use super::recording::Recording;
use super::resolution::Resolution;
use super::shape;

/// A fitted pulse that leaves more, part of the peak, tells no contact time.
const LOOSE: f64 = 0.1;

/// The force of a contact on the retainer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pulse {
    /// Begin of the contact, in the recording's time.
    pub time_s: f64,
    /// Along `direction_deg`, of the fitted pulse; of the recovered force where none fits.
    pub peak_force_n: f64,
    /// Of the fitted pulse; none where none fits.
    pub contact_time_s: Option<f64>,
    /// Sum of the recovered force over time.
    pub impulse_n_s: f64,
    /// Of the impulse: from the bottom, counter-clockwise, -180 to 180. Friction is part of it.
    pub direction_deg: f64,
}

/// A contact.
#[derive(Clone, Debug, Serialize)]
pub struct Contact {
    /// Its numbers.
    #[serde(flatten)]
    pub pulse: Pulse,
    /// Recovered force along the direction: pairs of s, in the recording's time, and N.
    #[serde(skip)]
    pub recovered: Vec<(f64, f64)>,
    /// The fitted pulse likewise; empty where none fits.
    #[serde(skip)]
    pub fitted: Vec<(f64, f64)>,
}

/// The contacts of `force`.
pub fn contacts(recording: &Recording, force: &Force, resolution: &Resolution) -> Vec<Contact> {
    let rate = recording.rate;
    let each = force.contacts.iter().map(|contact| {
        let sum = |axis: usize| -> f64 {
            let axis = force.axes.get(axis).map(|it| &it[contact.clone()]);
            axis.unwrap_or_default().iter().sum::<f64>() / rate
        };
        let impulse = [sum(0), sum(1)];
        let size = impulse[0].hypot(impulse[1]);
        let along = |k: usize| {
            let parts = force.axes.iter().zip(impulse);
            parts.map(|(axis, part)| axis[k] * part / size).sum()
        };
        let along: Vec<f64> = contact.clone().map(along).collect();
        let fit = shape::fit(&along, rate, resolution);
        let fits = fit.misfit <= LOOSE;
        let highest = along.iter().copied().fold(0.0, f64::max);
        let begin = recording.start + contact.start as f64 / rate;
        let pulse = Pulse {
            time_s: begin + if fits { fit.start } else { 0.0 },
            peak_force_n: if fits { fit.peak } else { highest },
            contact_time_s: fits.then_some(fit.duration),
            impulse_n_s: size,
            direction_deg: impulse[0].atan2(-impulse[1]).to_degrees(),
        };
        let moved = |(time, force): (f64, f64)| (begin + time, force);
        let sampled = (along.iter().enumerate()).map(|(k, force)| (k as f64 / rate, *force));
        Contact {
            pulse,
            recovered: sampled.map(moved).collect(),
            fitted: (fit.curve.into_iter().filter(|_| fits))
                .map(moved)
                .collect(),
        }
    });
    each.collect()
}
