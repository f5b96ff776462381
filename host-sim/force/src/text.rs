//! What the command says: for people, and as JSON.

use serde::Serialize;

use super::Measurement;
use super::pulse::Pulse;
use touchdown_base::plain::shown;

#[derive(Serialize)]
struct ForceJson<'a> {
    pulses: Vec<&'a Pulse>,
    band_hz: [f64; 2],
    sample_rate_hz: f64,
}

/// `force --json`; SI, full precision, unknown values null.
pub fn json(measurement: &Measurement) -> serde_json::Result<String> {
    let value = ForceJson {
        pulses: measurement.pulses().collect(),
        band_hz: measurement.band,
        sample_rate_hz: measurement.sample_rate,
    };
    serde_json::to_string_pretty(&value).map(|json| json + "\n")
}

/// The pulses as a table.
pub fn table(recording: &str, measurement: &Measurement) -> String {
    let [low, high] = measurement.band;
    let mut text = format!(
        "{}: {:.0} Hz; calibrated from {low:.0} to {high:.0} Hz",
        shown(recording),
        measurement.sample_rate
    );
    let coherence = measurement
        .calibrations
        .iter()
        .filter_map(|it| it.coherence);
    if let Some(least) = coherence.reduce(f64::min) {
        text += &format!(", coherence {least:.4}");
    }
    text += &format!("; noise {:.1} N\n\n", measurement.force.noise);
    if measurement.contacts.is_empty() {
        return text + "No contact stands clear of the noise.\n";
    }
    text += "   time      peak  contact  impulse  direction\n";
    text += "     ms         N       us      N s   from the bottom\n";
    for pulse in measurement.pulses() {
        let contact = pulse
            .contact_time_s
            .map_or("-".to_owned(), |time| format!("{:.1}", 1e6 * time));
        text += &format!(
            "{:>7.3}  {:>8.1}  {contact:>7}  {:>7.4}  {:>+9.2}\n",
            1e3 * pulse.time_s,
            pulse.peak_force_n,
            pulse.impulse_n_s,
            pulse.direction_deg
        );
    }
    text
}
