//! Stretches of a run: what a chart shows, where a trace should have all its points; what can be drawn in one go.

use touchdown_base::history::{History, PhaseKind};
use touchdown_chart::plot::Axis;
use touchdown_run::outcome::TracePoint;

/// Longest default stretch, in natural times `sqrt(clearance/g)`: bounce series up to a restitution of
/// 0.95 fit.
const LONGEST: f64 = 100.0;

/// Way between two points from which they are not joined, in clearances.
const FAR: f64 = 0.7;

/// A stretch of time, s since release.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// s.
    pub start: f64,
    /// s.
    pub end: f64,
}

impl Window {
    /// The whole run, levitated lead included.
    pub fn whole(truth: &History) -> Self {
        let start = truth.phases.first().map_or(0.0, |first| first.start_s);
        Self {
            start,
            end: truth.end.time.max(start),
        }
    }

    /// From the release to shortly after permanent contact; for a start on the wall, to shortly after
    /// the last change of contact. The whole run where that is not much longer. Clearance in m, gravity
    /// in m/s2.
    pub fn interesting(truth: &History, clearance: f64, gravity: f64) -> Self {
        let whole = Self::whole(truth);
        let first = truth.contact_starts.first().copied();
        let settled = first.filter(|&time| time > 0.0).or_else(|| {
            let starts = truth.phases.iter().skip(1).map(|phase| phase.start_s);
            let last_impact = truth.impacts.last().map(|impact| impact.state.time);
            starts.chain(last_impact).reduce(f64::max)
        });
        let Some(settled) = settled.filter(|&time| time > 0.0) else {
            return whole;
        };
        let natural = (clearance / gravity).sqrt();
        // Infinite without gravity; `min` leaves out what is no number.
        let length = (1.3 * settled).min(LONGEST * natural);
        let lead = truth.phases.first().map(|first| first.phase) == Some(PhaseKind::Levitated);
        let start = if lead { -0.08 * length } else { 0.0 };
        let window = Self {
            start: start.max(whole.start),
            end: length.min(whole.end),
        };
        let is_most = whole.end - whole.start < 1.5 * (window.end - window.start);
        if is_most { whole } else { window }
    }

    /// Its time axis, for s.
    pub fn axis(self) -> Axis {
        let (scale, label) = match self.end - self.start > 2.0 {
            true => (1.0, "time since release, s"),
            false => (1e3, "time since release, ms"),
        };
        Axis::scaled(scale, self.start, self.end, label, 6.0)
    }
}

/// The stretches of one phase, each from the last point of the one before.
pub fn runs(trace: &[TracePoint]) -> impl Iterator<Item = &[TracePoint]> {
    let mut end = 0;
    trace.chunk_by(|a, b| a.phase == b.phase).map(move |run| {
        let start = end;
        end += run.len();
        &trace[usize::saturating_sub(start, 1)..end]
    })
}

/// Whether the rotor may have gone elsewhere between two points, so that a line would mislead.
pub fn far(from: &TracePoint, to: &TracePoint, clearance: f64) -> bool {
    let speed = |point: &TracePoint| f64::hypot(point.state.velocity[0], point.state.velocity[1]);
    let time = to.state.time - from.state.time;
    speed(from).max(speed(to)) * time > FAR * clearance
}
