//! The true motion, thinned: every sample of the first part after the release, then fewer.

use crate::outcome::TracePoint;

/// Points kept of the time before the release, of the first part after it, and of the rest.
const BEFORE: usize = 500;
const FIRST: usize = 6000;
const REST: usize = 4000;

/// Keeps a bounded number of points of a run of any length.
#[derive(Debug, Default)]
pub struct Trace {
    before: Thinned,
    first: Vec<TracePoint>,
    rest: Thinned,
}

/// Keeps every point at first; each time it is full, every second one goes.
#[derive(Debug, Default)]
struct Thinned {
    points: Vec<TracePoint>,
    /// How often it was full.
    halvings: u32,
    seen: u64,
}

impl Thinned {
    fn push(&mut self, point: TracePoint, most: usize) {
        if self.is_kept() && self.points.len() >= most {
            let mut keep = false;
            self.points.retain(|_| {
                keep = !keep;
                keep
            });
            self.halvings += 1;
        }
        if self.is_kept() {
            self.points.push(point);
        }
        self.seen += 1;
    }

    fn is_kept(&self) -> bool {
        self.seen.is_multiple_of(1 << self.halvings)
    }
}

impl Trace {
    /// Takes the next point.
    pub fn push(&mut self, point: TracePoint) {
        if point.state.time < 0.0 {
            self.before.push(point, BEFORE);
        } else if self.first.len() < FIRST {
            self.first.push(point);
        } else {
            self.rest.push(point, REST);
        }
    }

    /// The points kept, in the order of time.
    pub fn finish(self) -> Vec<TracePoint> {
        let mut points = self.before.points;
        points.extend(self.first);
        points.extend(self.rest.points);
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_base::history::{PhaseKind, RotorState};

    #[test]
    fn a_long_run_keeps_its_start_and_stays_small() {
        let mut trace = Trace::default();
        for k in -4000..1_000_000 {
            let state = RotorState {
                time: f64::from(k),
                ..RotorState::default()
            };
            trace.push(TracePoint {
                moving: touchdown_truth::Moving::Nothing,
                state,
                phase: PhaseKind::FreeFall,
                sensed: None,
            });
        }
        let times: Vec<_> = trace.finish().iter().map(|p| p.state.time).collect();
        assert!(times.len() <= BEFORE + FIRST + REST);
        assert!(times.is_sorted_by(|a, b| a < b));
        let zero = times.iter().position(|t| *t == 0.0).unwrap();
        assert_eq!(times[zero + FIRST - 1], FIRST as f64 - 1.0);
        assert!(*times.last().unwrap() > 999_000.0);
    }
}
