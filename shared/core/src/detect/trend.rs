//! Where a floating rotor is and goes: position and velocity, by an observer whose memory fades.
//!
//! Both of its poles are at 1/(1 + T/tau), with the period T and the memory tau. Of an acceleration a since t it leaves
//! a tau^2 (1 - (1 + t/tau) exp(-t/tau)) in its residuals: a t^2/2 at first.

/// Time constant, s: the position is then known to 1.25 T/tau of the noise's variance, 3 % of a fall's latency.
pub(crate) const MEMORY: f32 = 5e-3;
/// Samples over this number is the memory of an observer that has just begun.
const GROWTH: f32 = 2.5;
/// Samples that it begins with.
const FIRST: f32 = 8.0;

/// The estimate.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct TrendObserver {
    /// m.
    pub(crate) position: [f32; 2],
    /// m a sample.
    pub(crate) step: [f32; 2],
    /// Of the memory, in samples, one more.
    length: f32,
}

impl TrendObserver {
    /// At `position` (m), still.
    pub(crate) fn at(position: [f32; 2]) -> Self {
        Self {
            position,
            step: [0.0; 2],
            length: 1.0 + FIRST / GROWTH,
        }
    }

    /// Whether it has begun.
    pub(crate) fn is_known(&self) -> bool {
        self.length > 0.0
    }

    /// To the next sample.
    pub(crate) fn advance(&mut self) {
        for (position, step) in self.position.iter_mut().zip(self.step) {
            *position += step;
        }
    }

    /// Takes a residual (m), with a memory of so many samples at most.
    pub(crate) fn take(&mut self, residual: [f32; 2], memory: f32) {
        let gain = 1.0 / self.length;
        self.length = if self.length < memory {
            self.length + 1.0 / GROWTH
        } else {
            1.0 + memory
        };
        for ((position, step), r) in (self.position.iter_mut().zip(&mut self.step)).zip(residual) {
            *position += (2.0 - gain) * gain * r;
            *step += gain * gain * r;
        }
    }
}
