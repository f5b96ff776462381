//! One pulse channel: from edges and their times to a speed and the most that it can be wrong by.
//!
//! Three edges, the last one and two earlier ones about half a window and a window before it, give two
//! mean speeds. Each is the speed at the middle of its stretch where the speed changes evenly, and so
//! their trend gives the speed now.

use core::f32::consts::TAU;

use crate::event::Moment;
use crate::sample::Edges;
use crate::tachometer::Speed;

/// Earlier edges that are kept.
pub(super) const KEPT: usize = 16;
/// Relative error that the roundings of f32 leave in a mean speed.
const ROUNDING: f32 = 5e-7;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    period: f32,
    /// From mark to mark, rad.
    pitch: f32,
    edge_error: f32,
    /// Samples.
    window: f32,
    /// Least distance of kept edges, samples.
    stride: f32,
}

/// An edge.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edge {
    pub(super) count: u16,
    pub(super) at: Moment,
}

/// Two mean speeds.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Trend {
    /// In the latest stretch, rad/s.
    rate: f32,
    /// Above that of the stretch before, rad/s.
    gain: f32,
    /// Length of the latest stretch, and way between the middles of both, samples.
    length: f32,
    apart: f32,
    /// Of `rate`, and of `gain`, rad/s.
    error: f32,
    gain_error: f32,
}

/// What a channel carries from sample to sample.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ChannelState {
    /// The last edge; before any, the first sample.
    pub(super) last: Option<Edge>,
    pub(super) kept: [Edge; KEPT],
    pub(super) filled: usize,
    pub(super) newest: usize,
    pub(super) trend: Option<Trend>,
}

impl Channel {
    pub(crate) fn new(marks: u16, edge_error: f32, window: f32, sample_rate: f32) -> Self {
        let window = window * sample_rate;
        Self {
            period: 1.0 / sample_rate,
            pitch: TAU / f32::from(marks),
            edge_error,
            window,
            stride: window / (KEPT - 1) as f32,
        }
    }

    /// Takes what the timer showed at the sample `now`. `None` while nothing is known, and where the
    /// sample is missing; then all begins again.
    pub(crate) fn update(
        &self,
        state: &mut ChannelState,
        now: Moment,
        edges: Option<Edges>,
    ) -> Option<Speed> {
        let Some(edges) = edges else {
            *state = ChannelState::default();
            return None;
        };
        let count = edges.count;
        let last = *state.last.get_or_insert(Edge { count, at: now });
        if count != last.count {
            let at = Moment(now.0 - i64::from(edges.age));
            self.take(state, Edge { count, at });
        }
        self.speed(state, now)
    }

    fn take(&self, state: &mut ChannelState, edge: Edge) {
        state.last = Some(edge);
        state.trend = self.trend(state, edge);
        let due = |newest: &Edge| edge.at.since(newest.at) >= self.stride;
        if state.filled == 0 || state.back(0).as_ref().is_some_and(due) {
            state.newest = (state.newest + 1) % KEPT;
            state.filled = (state.filled + 1).min(KEPT);
            if let Some(slot) = state.kept.get_mut(state.newest) {
                *slot = edge;
            }
        }
    }

    fn trend(&self, state: &ChannelState, edge: Edge) -> Option<Trend> {
        let (mut half, mut whole) = (None, state.filled.checked_sub(1)?);
        for index in 0..state.filled {
            let span = edge.at.since(state.back(index)?.at);
            if half.is_none() && span >= 0.5 * self.window {
                half = Some(index);
            }
            if index > 0 && span >= self.window {
                whole = index;
                break;
            }
        }
        // Before a window is full, half of what there is.
        let half = half.unwrap_or(whole / 2).min(whole.checked_sub(1)?);
        let (middle, oldest) = (state.back(half)?, state.back(whole)?);
        let (late, late_error, length) = self.mean(middle, edge)?;
        let (early, early_error, before) = self.mean(oldest, middle)?;
        Some(Trend {
            rate: late,
            gain: late - early,
            length,
            apart: 0.5 * (length + before),
            error: late_error,
            gain_error: late_error + early_error,
        })
    }

    /// Mean speed and its error, rad/s, and length, samples, of a stretch.
    fn mean(&self, from: Edge, to: Edge) -> Option<(f32, f32, f32)> {
        let length = to.at.since(from.at);
        if length <= 0.0 {
            return None;
        }
        let turned = self.pitch * f32::from(to.count.wrapping_sub(from.count));
        let rate = turned / (length * self.period);
        // Each edge is off by its own place, both together by less than a tick.
        let misplaced = 2.0 * self.edge_error / (length * self.period);
        let mistimed = rate / (256.0 * length);
        Some((rate, misplaced + mistimed + ROUNDING * rate, length))
    }

    fn speed(&self, state: &mut ChannelState, now: Moment) -> Option<Speed> {
        let waited = now.since(state.last?.at);
        // Faster, there would have been another edge.
        let most = (self.pitch + 2.0 * self.edge_error) / (waited * self.period);
        let stopped = Speed {
            rate: 0.0,
            error: most,
        };
        let Some(trend) = &state.trend else {
            return (waited >= self.window).then_some(stopped);
        };
        if most < 0.5 * trend.rate && waited >= self.window {
            state.trend = None;
            state.filled = 0;
            return Some(stopped);
        }
        let ahead = (waited + 0.5 * trend.length) / trend.apart;
        let rate = (trend.rate + trend.gain * ahead).max(0.0);
        let error = trend.error + trend.gain_error * ahead;
        Some(Speed {
            rate: rate.min(most),
            error: error + (rate - most).max(0.0),
        })
    }
}

impl ChannelState {
    /// The kept edge that is `steps` before the newest one.
    pub(super) fn back(&self, steps: usize) -> Option<Edge> {
        if steps >= self.filled {
            return None;
        }
        let index = (self.newest + KEPT - steps) % KEPT;
        self.kept.get(index).copied()
    }
}
