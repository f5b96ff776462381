//! What people decide by.

use std::f64::consts::TAU;

use touchdown_base::history::{History, Regime};
use touchdown_run::model::ModelRun;
use touchdown_scene::Scene;

/// How many there are.
pub const COUNT: usize = 11;

/// One of each quantity, SI; `None` where a drop has no such thing.
pub type Values = [Option<f64>; COUNT];

/// Name and unit, in the order of [`Values`]. What has no unit is a yes or no of each drop.
pub const QUANTITIES: [(&str, &str); COUNT] = [
    ("lands", ""),
    ("whirls", ""),
    ("first contact", "s"),
    ("fastest impact", "m/s"),
    ("greatest impulse", "N s"),
    ("greatest held force", "N"),
    ("time in contact", "s"),
    ("greatest radius", "m"),
    ("whirl frequency", "Hz"),
    ("inner ring's speed", "rad/s"),
    ("temperature rise", "K"),
];

/// What a run came to.
pub fn values(run: &ModelRun, scene: &Scene) -> Values {
    let history = &run.histories.whole;
    let whirls = matches!(history.regime, Regime::ForwardWhirl | Regime::BackwardWhirl);
    let impacts = || history.impacts.iter();
    let impact = impacts().next().map(|it| it.state.time);
    let contact = history.contact_starts.first().copied();
    let first = impact.into_iter().chain(contact).reduce(f64::min);
    let rings = || run.ring.iter().chain(&run.seats);
    let races = || rings().filter_map(|it| it.race);
    [
        Some(f64::from(u8::from(first.is_some()))),
        Some(f64::from(u8::from(whirls))),
        first,
        impacts().map(|it| it.normal_speed).reduce(f64::max),
        impacts().map(|it| it.normal_impulse).reduce(f64::max),
        rings().map(|it| it.held_peak_force_n).reduce(f64::max),
        Some(in_contact(history, scene.run.duration)),
        rings().map(|it| it.peak_radius_m).reduce(f64::max),
        whirls.then(|| frequency(history)),
        races().map(|it| it.inner_ring_rad_s.abs()).reduce(f64::max),
        races().map(|it| it.temperature_rise_k).reduce(f64::max),
    ]
}

/// Of permanent contact, s.
fn in_contact(history: &History, end: f64) -> f64 {
    let ends = history.lift_offs.iter().copied().chain([end]);
    let spans = history.contact_starts.iter().zip(ends);
    spans.map(|(start, end)| end - start).sum()
}

/// Of the rotor round the bearing's centre at the end, 1/s.
fn frequency(history: &History) -> f64 {
    let ([x, y], [u, v]) = (history.end.position, history.end.velocity);
    (x * v - y * u).abs() / (x * x + y * y) / TAU
}
