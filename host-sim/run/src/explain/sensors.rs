//! The sensors' resolution and noise.

use super::Row;
use touchdown_scene::Scene;
use touchdown_scene::sensors::SensorsConfig;

pub(super) fn sensors(config: &SensorsConfig, scene: &Scene) -> Vec<Row> {
    let resolution = config.resolution();
    // A uniform error of one count has this standard deviation.
    let noise = config.noise.hypot(resolution / 12_f64.sqrt());
    let channels = f64::from(config.planes);
    let bandwidth = config.bandwidth.map_or_else(
        || "not modelled".to_owned(),
        |corner| format!("{corner} Hz"),
    );
    let mut rows = vec![
        ("planes", config.planes.to_string()),
        ("sample rate", format!("{} Hz", scene.run.sample_rate)),
        ("range", format!("+-{} um", short(config.range * 1e6))),
        (
            "one count",
            format!("{:.4} um ({} bits)", resolution * 1e6, config.bits),
        ),
        (
            "noise of a channel",
            format!("{:.4} um rms with rounding", noise * 1e6),
        ),
        (
            "noise of the mean position",
            format!("{:.4} um rms", noise * 1e6 / channels.sqrt()),
        ),
        ("bandwidth", bandwidth),
        ("speed signal", yes(config.speed)),
        ("levitation signal", yes(config.levitation_signal)),
    ];
    let distorts = config.runout > 0.0
        || config.nonlinearity != 0.0
        || config
            .offset
            .iter()
            .chain(&config.gain_error)
            .any(|value| *value != 0.0);
    let distortion = if distorts {
        "as the scene asks"
    } else {
        "none"
    };
    rows.push(("runout, gain, offset, curve", distortion.to_owned()));
    rows
}

fn short(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn yes(wired: bool) -> String {
    if wired { "yes" } else { "no" }.to_owned()
}
