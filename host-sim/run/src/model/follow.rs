//! A drop as its model has it, followed from sample to sample.

use super::seen::ModelRun;
use touchdown_truth::TrueState;

/// A drop of a model, followed from its release.
pub trait FollowedDrop {
    /// The machine at `time` (s since the release; times must not decrease). Before the release it is held at the start.
    /// Between two steps it is where a shorter step leads; the run itself keeps its steps.
    fn advance(&mut self, time: f64) -> TrueState;

    /// When it was given up, s: it would take too long. It stays there.
    fn given_up(&self) -> Option<f64>;

    /// Goes on to the end of the run, or to where it is given up.
    fn finish(self: Box<Self>) -> ModelRun;
}
