//! Full spectra of the sensed motion, and how they change over time.

use super::Subject;
use super::chart::{Axis, Chart, Pen};
use super::window::Window;
use crate::outcome::Outcome;
use crate::spectrogram::Spectrogram;
use maud::{Markup, html};

const HEIGHT: f64 = 220.0;
/// Turns of the rotor, and Hz, up to which is shown at least.
const TURNS: f64 = 2.5;
const LEAST: f64 = 500.0;
/// Shades of the waterfall, each of so many dB, down from the greatest amplitude.
const SHADES: usize = 8;
const SHADE_DB: f64 = 6.0;
const MICRO: f64 = 1e6;

/// Amplitude against frequency before and after the release.
pub fn full(window: Window, subject: &Subject, outcome: &Outcome) -> Markup {
    let found = &outcome.spectrogram;
    let parts = [
        ("levitated", [f64::NEG_INFINITY, 0.0]),
        ("motion", [0.0, window.end]),
    ];
    let curves: Vec<(&str, Vec<f64>)> = (parts.into_iter())
        .filter_map(|(class, span)| Some((class, found.amplitudes(span)?)))
        .collect();
    let Some(most) = (curves.iter().flat_map(|it| it.1.iter().copied())).reduce(f64::max) else {
        return html! { p { "The run is shorter than a window of the spectrum." } };
    };
    let reach = reach(found, subject);
    let x = Axis::new(-reach, reach, "frequency, Hz (+: counter-clockwise)", 8.0);
    let most = (MICRO * most).max(1e-2);
    let y = Axis::decades(1e-4 * most, most, "amplitude, \u{b5}m", 5.0);
    let chart = Chart {
        title: "Full spectrum",
        description: "Amplitude of the sensed motion x + j y against frequency; backward whirl is \
                      on the side away from the spin.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let floor = 10f64.powf(y.lo);
    let drawn = html! {
        @for (class, amplitudes) in &curves {
            (line(chart.pen(), found, amplitudes, reach, floor).finish(class))
        }
    };
    let spin = subject.spin / std::f64::consts::TAU;
    let front = html! {
        @for at in [spin, -spin].into_iter().filter(|it| x.shows(*it)) {
            line.mark x1=(x.percent(at)) x2=(x.percent(at)) y1="0" y2=(HEIGHT) {}
        }
    };
    html! {
        (chart.draw(&html! {}, &drawn, &front))
        ul.legend {
            li { svg width="34" height="12" aria-hidden="true" { path.curve.motion d="M1 6H33" {} } "after the release" }
            @if curves.iter().any(|it| it.0 == "levitated") {
                li { svg width="34" height="12" aria-hidden="true" { path.curve.levitated d="M1 6H33" {} } "before it" }
            }
            li { svg width="34" height="12" aria-hidden="true" { line.mark x1="17" x2="17" y1="0" y2="12" {} } "speed of the rotor, and against it" }
        }
    }
}

fn line<'a>(
    mut pen: Pen<'a>,
    found: &Spectrogram,
    amplitudes: &[f64],
    reach: f64,
    floor: f64,
) -> Pen<'a> {
    for (index, amplitude) in amplitudes.iter().enumerate() {
        let frequency = found.frequency(index);
        if frequency.abs() <= reach {
            pen.line_to(frequency, (MICRO * amplitude).max(floor));
        }
    }
    pen
}

fn reach(found: &Spectrogram, subject: &Subject) -> f64 {
    let bins = found.spectra.first().map_or(0, |it| it.power.len());
    let turns = TURNS * subject.spin.abs() / std::f64::consts::TAU;
    turns.max(LEAST).min(found.frequency(bins.max(1) - 1))
}

/// The spectra one over the other, later ones higher, as shades.
pub fn waterfall(subject: &Subject, outcome: &Outcome) -> Markup {
    let found = &outcome.spectrogram;
    let [Some(first), Some(last)] = [found.spectra.first(), found.spectra.last()] else {
        return html! {};
    };
    let reach = reach(found, subject);
    let middle = |span: [f64; 2]| 0.5 * (span[0] + span[1]);
    let x = Axis::new(-reach, reach, "frequency, Hz (+: counter-clockwise)", 8.0);
    let y = Axis::new(first.span[0], last.span[1], "time since release, s", 6.0);
    let chart = Chart {
        title: "Waterfall of the full spectrum",
        description: "Amplitude of the sensed motion as shades over frequency and time; the darkest \
                      is within 6 dB of the greatest.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let shown = |index: usize| found.frequency(index).abs() <= reach;
    let bins: Vec<usize> = (0..first.power.len()).filter(|it| shown(*it)).collect();
    let powers = found
        .spectra
        .iter()
        .flat_map(|it| bins.iter().map(|bin| it.power[*bin]));
    let most = powers.fold(f64::MIN_POSITIVE, f64::max);
    let half = 0.5 * found.resolution;
    let mut shades: Vec<Pen> = (0..SHADES).map(|_| chart.pen()).collect();
    for (number, spectrum) in found.spectra.iter().enumerate() {
        let near = |at: Option<usize>, end: f64| {
            let other = at.and_then(|it| found.spectra.get(it));
            other.map_or(end, |it| 0.5 * (middle(it.span) + middle(spectrum.span)))
        };
        let low = near(number.checked_sub(1), spectrum.span[0]);
        let high = near(Some(number + 1), spectrum.span[1]);
        let shade = |bin: &usize| {
            let down = -10.0 * (spectrum.power[*bin] / most).log10();
            (down / SHADE_DB) as usize
        };
        for run in bins.chunk_by(|a, b| shade(a) == shade(b)) {
            let [Some(from), Some(to)] = [run.first(), run.last()] else {
                continue;
            };
            if let Some(pen) = shades.get_mut(shade(from)) {
                let ends = [found.frequency(*from) - half, found.frequency(*to) + half];
                pen.rectangle(ends.map(|it| it.clamp(-reach, reach)), [low, high]);
            }
        }
    }
    let drawn = html! {
        @for (number, pen) in shades.into_iter().enumerate() {
            g opacity=(format!("{:.2}", 1.0 - number as f64 / SHADES as f64)) { (pen.finish("shade")) }
        }
    };
    chart.draw(&html! {}, &drawn, &html! {})
}
