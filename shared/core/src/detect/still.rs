//! Stillness: whether the rotor keeps its place over a stretch of time.

use crate::vector::{length, less, square, sum};

/// Collects blocks of samples.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Still {
    count: u32,
    origin: [f32; 2],
    sum: [f32; 2],
    square: f32,
    last: Option<[f32; 2]>,
    /// Square of the largest distance from the centre in this block, and in the one before, m^2.
    farthest: [f32; 2],
}

/// A finished block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    /// m.
    pub(crate) mean: [f32; 2],
    /// Of one axis, m^2.
    pub(crate) variance: f32,
    /// Way from the mean of the block before, m; infinite for the first.
    pub(crate) moved: f32,
    /// Square of the largest distance from the centre in it and the one before, m^2; infinite for the first.
    pub(crate) farthest: f32,
}

impl Still {
    /// Takes a position, m; a block has so many `samples`.
    pub(crate) fn take(&mut self, position: [f32; 2], samples: u32) -> Option<Block> {
        if self.count == 0 {
            self.origin = position;
            self.sum = [0.0; 2];
            self.square = 0.0;
            self.farthest[0] = 0.0;
        }
        self.farthest[0] = self.farthest[0].max(square(position, [0.0; 2]));
        self.sum = sum(self.sum, less(position, self.origin));
        self.square += square(position, self.origin);
        self.count += 1;
        if self.count < samples {
            return None;
        }
        let scale = 1.0 / self.count as f32;
        let [mx, my] = self.sum.map(|sum| sum * scale);
        let mean = sum(self.origin, [mx, my]);
        let way = self.last.map(|last| length(less(mean, last)));
        let [now, before] = self.farthest;
        let farthest = if self.last.is_some() {
            now.max(before)
        } else {
            f32::INFINITY
        };
        self.farthest[1] = now;
        self.last = Some(mean);
        self.count = 0;
        Some(Block {
            mean,
            variance: (0.5 * (self.square * scale - mx * mx - my * my)).max(0.0),
            moved: way.unwrap_or(f32::INFINITY),
            farthest,
        })
    }
}
