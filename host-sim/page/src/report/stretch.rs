//! Stretches of the trace that can be drawn in one go.

use touchdown_run::outcome::TracePoint;

/// Way between two points from which they are not joined, in clearances.
const FAR: f64 = 0.7;

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
