//! The end of a permanent contact: a CUSUM on the distance from the wall.

use crate::event::Moment;
use crate::memory::Memory;
use crate::vector::square;
use touchdown_rotor::real::{root, sqrt};

/// Samples that the wall's place is learnt from before it is trusted.
const WARM_UP: u16 = 16;
/// Samples that the wall's learnt place remembers.
pub(crate) const MEMORY: Memory = Memory::of(256);
/// Samples that show how far the sensors waver on the wall: a turn of the rotor, or so much of it as the wall's
/// learnt place does not follow.
const LEARNT: u16 = 128;
/// Distance that the test is tuned to, in standard deviations: above what noise and the waves of a
/// sensor's error do, below what a flight soon reaches.
const SHIFT: f32 = 4.0;
/// Most that one sample can say, in standard deviations: a spike alone is no lift-off.
const MAX_INWARD_SIGMA: f32 = SHIFT;

/// Part of the way from lift-off to detection at which the crossing is placed at the latest: nearer to
/// detection the samples since say nothing of when it began.
const LATEST_CROSSING: f32 = 0.75;

/// The test.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LiftOff {
    /// Radius at which the wall has lately been, m.
    pub(crate) lately: f32,
    /// Distance of the last sample from the wall, inward, m.
    pub(crate) gap: f32,
    count: u16,
    /// Mean square of that distance on the wall, m^2.
    square: f32,
    /// The same at least, on a wall that gives way; 0 on one that does not.
    give: f32,
    sum: f32,
    age: u16,
    /// Where the rotor was last at the wall, and its distance from it, inward, m.
    left: [f32; 2],
    left_gap: f32,
}

/// A rotor that seems to have left the wall, until it meets it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lifted {
    since: Moment,
    /// Acceleration with which it pressed there, m/s^2.
    pressing: f32,
    /// How far inside of the wall it has been at most, m, and when.
    pub(crate) depth: f32,
    deepest: Moment,
}

impl Lifted {
    /// From a wall that pressed with that acceleration, m/s^2.
    pub(crate) fn new(since: Moment, pressing: f32) -> Self {
        Self {
            since,
            pressing,
            depth: 0.0,
            deepest: since,
        }
    }

    /// It is so far inside of the wall, m.
    pub(crate) fn take(&mut self, depth: f32, now: Moment) {
        if depth > self.depth {
            (self.depth, self.deepest) = (depth, now);
        }
    }

    /// Whether it has been less deep than that `part` of what a flight goes: a t^2/2 up to where it is deepest.
    pub(crate) fn is_nearer_than(&self, part: f32, period: f32) -> bool {
        let time = self.deepest.since(self.since) * period;
        self.depth < part * 0.5 * self.pressing * time * time
    }
}

impl LiftOff {
    /// On a wall that gives way by so much, m.
    pub(crate) fn on(give: f32) -> Self {
        Self {
            give: 0.25 * give * give,
            ..Self::default()
        }
    }

    /// Whether the last sample was at the wall.
    pub(crate) fn is_at_wall(&self) -> bool {
        self.age == 0
    }

    /// Mean square of the distance by which the sensors waver about the wall, m^2, once it is known.
    pub(crate) fn wavering(&self) -> Option<f32> {
        (self.count >= LEARNT).then_some(self.square)
    }

    /// Whether the wall has been learnt for as long as is remembered.
    pub(crate) fn is_settled(&self) -> bool {
        u32::from(self.count) >= MEMORY.samples
    }

    /// At one end alone, where the wall is `farther` (m). Which end has left it, the next samples decide.
    pub(crate) fn at_one_end(&self, farther: f32) -> Self {
        Self {
            lately: self.lately + farther,
            sum: 0.5 * self.sum,
            ..*self
        }
    }

    /// Takes the place and its distances from the centre and from the wall's shape, inward (m), known to `variance` (m^2). Where
    /// the rotor has left both the shape and where the wall has lately been: samples since. A shape that has just been learnt
    /// may go on wrongly. A free rotor leaves a whirl on a straight line at most, which is farther inside in its middle: a way c
    /// is a chord, c^2/(8 R) from the wall. One that was clearly nearer is on a wall,
    /// which is there.
    pub(crate) fn take(
        &mut self,
        place: [f32; 2],
        radius: f32,
        gap: f32,
        variance: f32,
        threshold: f32,
    ) -> Option<f32> {
        let sigma = sqrt(variance.max(self.give));
        self.gap = gap.min(self.lately - radius);
        let inward = self.gap / sigma;
        self.sum = (self.sum + SHIFT * (inward.min(MAX_INWARD_SIGMA) - 0.5 * SHIFT)).max(0.0);
        let gone = self.gap - self.left_gap + SHIFT * sigma;
        let is_curved = gone * 8.0 * radius < square(place, self.left);
        if is_curved && self.age > 0 {
            self.lately = radius;
        }
        if is_curved || self.count < WARM_UP {
            self.sum = 0.0;
        }
        if self.sum <= 0.0 {
            self.age = 0;
            self.left = place;
            self.left_gap = self.gap;
            self.count = self.count.saturating_add(1);
            let gain = MEMORY.gain(self.count.into());
            self.lately += gain * (radius - self.lately);
            if self.count > 1 {
                self.square += gain * (gap * gap - self.square);
            }
            return None;
        }
        self.age = self.age.saturating_add(1);
        if self.sum <= threshold {
            return None;
        }
        // The gap grows with the third power of time: where it crossed half the shift tells when it
        // began.
        let crossed = root::<3>((0.5 * SHIFT / inward).clamp(0.0, 1.0)).min(LATEST_CROSSING);
        Some(f32::from(self.age) / (1.0 - crossed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_is_found_and_dated() {
        let mut test = LiftOff::default();
        for k in 0..1_000 {
            let noise = if k % 2 == 0 { 1e-6 } else { -1e-6 };
            assert_eq!(
                test.take([0.0, -300e-6], 300e-6 + noise, -noise, 1e-12, 25.0),
                None
            );
        }
        // A spike, and a pair of them.
        for k in 0..200 {
            let gap = if k % 50 < 2 { 40e-6 } else { 0.0 };
            assert_eq!(
                test.take([0.0, -300e-6], 300e-6 - gap, gap, 1e-12, 25.0),
                None
            );
        }
        // 20 um after 40 samples, growing with the cube.
        let found = (1..200).find_map(|k| {
            let gap = 20e-6 * (k as f32 / 40.0).powi(3);
            test.take([0.0, -300e-6], 300e-6 - gap, gap, 1e-12, 25.0)
                .map(|age| (k as f32, age))
        });
        let (now, age) = found.expect("found");
        assert!(now < 40.0 && (now - age).abs() < 8.0, "{now} {age}");
    }

    /// A flight of 8 ms under 9.81 m/s^2 goes 78 um inside, a sag of the wall a few.
    #[test]
    fn a_sag_is_no_flight() {
        for (height, is_held) in [(78.5e-6, false), (60e-6, false), (12e-6, true)] {
            let mut lifted = Lifted::new(Moment::default(), 9.81);
            for k in 0..=160_u16 {
                let part = f32::from(k) / 160.0;
                let at = Moment::of_sample(u64::from(k));
                lifted.take(4.0 * height * part * (1.0 - part), at);
            }
            assert_eq!(lifted.is_nearer_than(0.5, 5e-5), is_held, "{height}");
        }
    }

    /// What the wall gives way by is no lift-off, what goes beyond that is one.
    #[test]
    fn a_wall_that_gives_way_holds_the_rotor() {
        let told = |give: f32, depth: f32| {
            let mut test = LiftOff::on(give);
            (0..1_000_u16).any(|k| {
                let gap = depth * f32::from(k.max(500) - 500) / 500.0;
                let found = test.take([0.0, -300e-6], 300e-6 - gap, gap, 1e-12, 25.0);
                found.is_some()
            })
        };
        assert!(told(0.0, 12e-6) && !told(12e-6, 11e-6) && told(12e-6, 30e-6));
    }

    /// Sensors of finite bandwidth show a whirl farther inside than where the wall was learnt; no rotor flies along a circle.
    #[test]
    fn a_whirl_is_no_flight() {
        let radius = 300e-6;
        for gap in [0.0, 3e-6, 10e-6] {
            let mut test = LiftOff::default();
            for k in 0..1_000_u16 {
                let (sin, cos) = libm::sincosf(0.1 * f32::from(k));
                let inside = gap * (f32::from(k.max(500) - 500) / 200.0).min(1.0);
                let seen = radius - inside;
                let found = test.take([seen * sin, -seen * cos], seen, inside, 1e-12, 25.0);
                assert_eq!(found, None, "{gap} {k}");
            }
        }
    }
}
