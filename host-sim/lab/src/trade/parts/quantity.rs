//! What people decide by.

use std::f64::consts::TAU;

use touchdown_base::history::{History, Regime};
use touchdown_run::model::ModelRun;
use touchdown_scene::Scene;

/// A quantity's name and unit, and whether it is a yes or no of each drop.
pub struct Quantity {
    pub name: &'static str,
    pub unit: &'static str,
    pub is_share: bool,
}

/// How many there are.
pub const COUNT: usize = 11;

/// One of each quantity, SI; `None` where a drop has no such thing.
pub type Values = [Option<f64>; COUNT];

/// In the order of [`Values`].
pub const QUANTITIES: [Quantity; COUNT] = [
    share("lands"),
    share("whirls"),
    number("first contact", "s"),
    number("fastest impact", "m/s"),
    number("greatest impulse", "N s"),
    number("greatest held force", "N"),
    number("time in contact", "s"),
    number("greatest radius", "m"),
    number("whirl frequency", "Hz"),
    number("inner ring's speed", "rad/s"),
    number("temperature rise", "K"),
];

const fn share(name: &'static str) -> Quantity {
    Quantity {
        name,
        unit: "",
        is_share: true,
    }
}

const fn number(name: &'static str, unit: &'static str) -> Quantity {
    Quantity {
        name,
        unit,
        is_share: false,
    }
}

/// What a run came to.
pub fn values(run: &ModelRun, scene: &Scene) -> Values {
    let history = &run.histories.whole;
    let whirls = matches!(history.regime, Regime::ForwardWhirl | Regime::BackwardWhirl);
    let impacts = || history.impacts.iter();
    let impact = impacts().next().map(|it| it.state.time);
    let first = least(
        impact
            .into_iter()
            .chain(history.contact_starts.first().copied()),
    );
    let rings = || run.ring.iter().chain(&run.seats);
    let races = || rings().filter_map(|it| it.race);
    [
        Some(f64::from(u8::from(first.is_some()))),
        Some(f64::from(u8::from(whirls))),
        first,
        greatest(impacts().map(|it| it.normal_speed)),
        greatest(impacts().map(|it| it.normal_impulse)),
        greatest(rings().map(|it| it.held_peak_force_n)),
        Some(in_contact(history, scene.run.duration)),
        greatest(rings().map(|it| it.peak_radius_m)),
        whirls.then(|| frequency(history)),
        greatest(races().map(|it| it.inner_ring_rad_s.abs())),
        greatest(races().map(|it| it.temperature_rise_k)),
    ]
}

fn greatest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.reduce(f64::max)
}

fn least(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.reduce(f64::min)
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
