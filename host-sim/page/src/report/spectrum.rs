//! Full spectra of the sensed motion, and how they change over time.

use maud::{Markup, html};
use std::f64::consts::TAU;
use touchdown_base::spectrogram::Spectrogram;
use touchdown_chart::plot::{Axis, Chart, Pen, key};

const HEIGHT: f64 = 220.0;
/// Turns of the rotor, and Hz, up to which is shown at least.
const TURNS: f64 = 2.5;
const LEAST: f64 = 500.0;
/// Shades of the waterfall, each of so many dB, down from the greatest amplitude.
const SHADES: usize = 8;
const SHADE_DB: f64 = 6.0;
const MICRO: f64 = 1e6;

/// A curve: class, name, and the stretch of time that it is the mean of, s.
type MeanSpectrum = (&'static str, &'static str, [f64; 2]);

/// Full spectrum and waterfall of x + j y. The rotor's spin is counter-clockwise positive, rad/s; `time` names the time
/// axis, in s.
pub fn spectra(found: &Spectrogram, spin: f64, parts: &[MeanSpectrum], time: &str) -> Markup {
    let bins = found.spectra.first().map_or(0, |it| it.power.len());
    let reach = (TURNS * spin.abs() / TAU).max(LEAST);
    let reach = reach.min(found.frequency(bins.max(1) - 1));
    html! {
        (full(found, spin, parts, reach))
        h3 { "Waterfall" }
        (waterfall(found, time, reach))
        p.note { "Of what the sensors of plane a give, x + j y, without its mean; Hann windows. Each shade of the waterfall is 6 dB." }
    }
}

/// Amplitude against frequency.
fn full(found: &Spectrogram, spin: f64, parts: &[MeanSpectrum], reach: f64) -> Markup {
    let curves: Vec<(&str, &str, Vec<f64>)> = (parts.iter())
        .filter_map(|(class, name, span)| Some((*class, *name, found.amplitudes(*span)?)))
        .collect();
    let Some(most) = (curves.iter().flat_map(|it| it.2.iter().copied())).reduce(f64::max) else {
        return html! { p { "The run is shorter than a window of the spectrum." } };
    };
    let x = frequencies(reach);
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
    let points = |amplitudes: &[f64]| -> Vec<(f64, f64)> {
        let all = amplitudes.iter().enumerate();
        let all = all.map(|(index, it)| (found.frequency(index), (MICRO * it).max(floor)));
        all.filter(|it| it.0.abs() <= reach).collect()
    };
    let drawn = html! {
        @for (class, _, amplitudes) in &curves { (chart.curve(class, points(amplitudes))) }
    };
    let spin = spin / TAU;
    let front = html! {
        @for at in [spin, -spin].into_iter().filter(|it| x.shows(*it)) {
            line.mark x1=(x.percent(at)) x2=(x.percent(at)) y1="0" y2=(HEIGHT) {}
        }
    };
    html! {
        (chart.draw(&html! {}, &drawn, &front))
        ul.legend {
            @for (class, name, _) in curves.iter().rev() { (key(class, name)) }
            li { svg width="34" height="12" aria-hidden="true" { line.mark x1="17" x2="17" y1="0" y2="12" {} } "speed of the rotor, and against it" }
        }
    }
}

fn frequencies(reach: f64) -> Axis {
    Axis::new(-reach, reach, "frequency, Hz (+: counter-clockwise)", 8.0)
}

/// The spectra one over the other, later ones higher, as shades.
fn waterfall(found: &Spectrogram, time: &str, reach: f64) -> Markup {
    let [Some(first), Some(last)] = [found.spectra.first(), found.spectra.last()] else {
        return html! {};
    };
    let middle = |span: [f64; 2]| 0.5 * (span[0] + span[1]);
    let chart = Chart {
        title: "Waterfall of the full spectrum",
        description: "Amplitude of the sensed motion as shades over frequency and time; the darkest \
                      is within 6 dB of the greatest.",
        x: &frequencies(reach),
        y: &Axis::new(first.span[0], last.span[1], time, 6.0),
        height: HEIGHT,
    };
    let shown = |index: usize| found.frequency(index).abs() <= reach;
    let bins: Vec<usize> = (0..first.power.len()).filter(|it| shown(*it)).collect();
    let spectra = found.spectra.iter();
    let powers = spectra.flat_map(|it| bins.iter().map(|bin| it.power[*bin]));
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
    chart.plain(&drawn)
}
