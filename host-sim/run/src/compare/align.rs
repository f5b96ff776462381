//! The second recording laid over the first.

use serde::Serialize;
use touchdown_core::event::EventKind;
use touchdown_core::sample::CHANNELS;

use crate::replay::{Excerpt, Replay};

/// Before and after the onset, where waveforms are fitted: the fall and the first hit, s.
const FITTED: [f64; 2] = [0.005, 0.015];
/// Most that the waveforms move the shift that the events give, s.
const FARTHEST: f64 = 2e-3;

/// What the recordings were aligned by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// The first fall.
    FreeFall,
    /// The first impact.
    Impact,
    /// Nothing: one of them has neither.
    Nothing,
}

/// How the second recording was laid over the first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Aligned {
    /// By which event, and then by the waveforms about it.
    pub aligned_by: By,
    /// Time in the second less that in the first, s.
    pub shift_s: f64,
    /// Of their difference about the first drop, by channel, rms, m; none where they do not overlap.
    pub waveform_rms_m: Vec<f64>,
}

/// Aligns by the first fall or impact, then by the waveforms.
pub fn align(replays: &[Replay; 2], excerpts: Option<&[Excerpt; 2]>) -> Aligned {
    let first = |kind: EventKind| {
        let onset = |replay: &Replay| {
            let mut events = replay.detection.events.iter();
            let first = events.find(|it| it.event == kind && it.withdrawn_s.is_none());
            first.map(|it| it.onset_s)
        };
        onset(&replays[0]).zip(onset(&replays[1]))
    };
    let fall = first(EventKind::FreeFall).map(|it| (By::FreeFall, it));
    let found = fall.or(first(EventKind::Impact).map(|it| (By::Impact, it)));
    let Some((aligned_by, (a, b))) = found else {
        return Aligned {
            aligned_by: By::Nothing,
            shift_s: 0.0,
            waveform_rms_m: Vec::new(),
        };
    };
    let [planes, others] = replays.each_ref().map(|it| it.envelope.planes);
    let channels = 2 * usize::from(planes.min(others));
    let mut shift = b - a;
    let mut rms = Vec::new();
    if let Some(excerpts) = excerpts {
        shift = fit(excerpts, a, shift, channels);
        let squares = squares(excerpts, shift, [f64::NEG_INFINITY, f64::INFINITY]);
        rms.extend(squares.iter().take(channels).flatten().map(|it| it.sqrt()));
    }
    Aligned {
        aligned_by,
        shift_s: shift,
        waveform_rms_m: rms,
    }
}

/// The shift near `shift` at which the waveforms about `onset` differ least, s.
fn fit(excerpts: &[Excerpt; 2], onset: f64, shift: f64, channels: usize) -> f64 {
    let period = 1.0 / excerpts[0].rate;
    let window = [onset - FITTED[0], onset + FITTED[1]];
    let error = |shift: f64| -> Option<f64> {
        let squares = squares(excerpts, shift, window);
        squares[..channels].iter().copied().sum()
    };
    let steps = (FARTHEST / period).ceil() as i32;
    let tried = (-steps..=steps).filter_map(|step| {
        let at = shift + f64::from(step) * period;
        error(at).map(|it| (it, at))
    });
    let Some((least, at)) = tried.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return shift;
    };
    if least == 0.0 {
        return at;
    }
    // Between samples: the lowest point of the parabola through it and its neighbours.
    let (Some(before), Some(after)) = (error(at - period), error(at + period)) else {
        return at;
    };
    let bend = before - 2.0 * least + after;
    if bend <= 0.0 {
        return at;
    }
    at + (0.5 * (before - after) / bend).clamp(-0.5, 0.5) * period
}

/// Mean square of the difference of the channels within `window` (s of the first), m^2; `None` where a
/// channel is nowhere in both.
fn squares([a, b]: &[Excerpt; 2], shift: f64, [from, to]: [f64; 2]) -> [Option<f64>; CHANNELS] {
    let (mut sums, mut counts) = ([0.0; CHANNELS], [0_u32; CHANNELS]);
    for (index, here) in a.positions.iter().enumerate() {
        let time = a.time(index);
        if !(from..=to).contains(&time) {
            continue;
        }
        let Some(there) = b.at(time + shift) else {
            continue;
        };
        for channel in 0..CHANNELS {
            let difference = here[channel] - there[channel];
            if !difference.is_nan() {
                sums[channel] += difference * difference;
                counts[channel] += 1;
            }
        }
    }
    std::array::from_fn(|it| (counts[it] > 0).then(|| sums[it] / f64::from(counts[it])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_of_parts_of_a_sample_is_found() {
        // Two rates, one fall: y = -g (t - t0)^2 / 2.
        let fall = |rate: f64, t0: f64| Excerpt {
            start: 0.0,
            rate,
            positions: (0..(0.05 * rate) as usize)
                .map(|k| {
                    let t = (k as f64 / rate - t0).max(0.0);
                    [1e-5, -4.905 * t * t, f64::NAN, f64::NAN]
                })
                .collect(),
        };
        let excerpts = [fall(20e3, 0.02), fall(12.5e3, 0.021_234)];
        let shift = fit(&excerpts, 0.02, 0.000_9, 2);
        // A tenth of the coarser period: what is linear between samples bends by that.
        assert!((shift - 0.001_234).abs() < 8e-6, "{shift}");
    }
}
