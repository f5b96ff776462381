//! Two planes of one rotor: the mean of both moves when one is lost or comes back, the rotor does not.

use crate::sensing::{AxialPlaces, PLANES};

/// Samples that half the difference of the planes is learnt over. Chosen: eight times as long as a stuck
/// channel goes unnoticed.
const MEMORY: f32 = 128.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneOffset {
    /// Half difference, m, beyond which the ends of a rotor that does not float are apart.
    tolerance: f32,
    /// Where the mean of both is, in half differences from the middle towards plane A: that of the rings.
    both: f32,
}

/// What is known of the two.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct PlaneOffsetState {
    /// Half the difference, a - b, m.
    pub(crate) half: [f32; 2],
    seen: [bool; PLANES],
}

impl PlaneOffset {
    /// `places` must be valid.
    pub(crate) fn new(tolerance: f32, places: Option<&AxialPlaces>) -> Self {
        Self {
            tolerance,
            both: places.map_or(0.0, AxialPlaces::ring_mean),
        }
    }

    /// Takes the planes, m, both with values of their own where `own`; how far their mean, that of the rings where both are
    /// seen, has moved because others are seen than before, m. Ends that are apart each go their own way: no move.
    pub(crate) fn take(
        &self,
        pairing: &mut PlaneOffsetState,
        planes: &[Option<[f32; 2]>; PLANES],
        own: bool,
        floats: bool,
    ) -> [f32; 2] {
        let before = pairing.seen;
        let seen = planes.map(|plane| plane.is_some());
        if seen == [false; PLANES] {
            return [0.0; 2];
        }
        pairing.seen = seen;
        if let [Some(a), Some(b)] = planes {
            let now = [0.5 * (a[0] - b[0]), 0.5 * (a[1] - b[1])];
            // One sample says less of a rotor that floats than what was learnt of it.
            if before == [false; PLANES] || (before != seen && !floats) {
                pairing.half = now;
            } else if own && before == seen {
                for (half, now) in pairing.half.iter_mut().zip(now) {
                    *half += (now - *half) / MEMORY;
                }
            }
        }
        let [x, y] = pairing.half;
        let apart = x * x + y * y > self.tolerance * self.tolerance;
        if before == seen || before == [false; PLANES] || (apart && !floats) {
            return [0.0; 2];
        }
        let way = self.side(seen) - self.side(before);
        [way * x, way * y]
    }

    /// Where the mean is, in half differences from the middle.
    fn side(&self, seen: [bool; PLANES]) -> f32 {
        match seen {
            [true, true] => self.both,
            [true, false] => 1.0,
            [false, true] => -1.0,
            [false, false] => 0.0,
        }
    }
}

impl PlaneOffsetState {
    /// Along which the planes are farther apart, 0 or 1.
    pub(crate) fn axis(&self) -> usize {
        let [x, y] = self.half;
        usize::from(y.abs() > x.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [f32; 2] = [30e-6, 0.0];
    const B: [f32; 2] = [10e-6, 4e-6];

    #[test]
    fn the_mean_moves_by_what_it_is_told() {
        // The middle between the rings is half a distance of the sensors beyond A.
        let places = AxialPlaces {
            sensors: [0.0, 1.0],
            rings: [-2.0, 1.0],
        };
        told_how_far_it_moves(None, [0.5, 0.5]);
        told_how_far_it_moves(Some(&places), [1.5, -0.5]);
    }

    fn told_how_far_it_moves(places: Option<&AxialPlaces>, weights: [f32; PLANES]) {
        let pair = PlaneOffset::new(20e-6, places);
        let mut pairing = PlaneOffsetState::default();
        let mut mean = None;
        for planes in [
            [Some(A), Some(B)],
            [Some(A), None],
            [None, Some(B)],
            [Some(A), Some(B)],
            [None, Some(B)],
        ] {
            let moved = pair.take(&mut pairing, &planes, true, true);
            let now = match planes {
                [Some(a), Some(b)] => [0, 1].map(|k| weights[0] * a[k] + weights[1] * b[k]),
                [one, other] => one.or(other).expect("one is seen"),
            };
            for k in 0..2 {
                let way = mean.map_or(0.0, |mean: [f32; 2]| now[k] - mean[k]);
                assert!((moved[k] - way).abs() < 1e-12, "{planes:?}: {moved:?}");
            }
            mean = Some(now);
        }
    }

    #[test]
    fn ends_that_are_apart_do_not_move_each_other() {
        let (pair, mut pairing) = (PlaneOffset::new(5e-6, None), PlaneOffsetState::default());
        pair.take(&mut pairing, &[Some(A), Some(B)], true, false);
        let moved = pair.take(&mut pairing, &[Some(A), None], true, false);
        assert_eq!(moved, [0.0; 2]);
    }
}
