//! A wall that gives way: the rotor goes on outward from where it met it, and is pushed back over many samples. All that is
//! one touch, with a begin and an end.

/// Standard deviations by which the rotor is clear of where it met the wall.
const CLEAR: f32 = 3.0;
/// Samples in a row in which it is beyond: no rigid wall lets it stay there.
const BEYOND: u8 = 4;
/// Times the distance that is clear which the rotor would have gone without the wall. On a spring that gives way by 1.6 times
/// that distance and more it is clear then: sin x > x/4 below x = 2.47.
const SHOWN: f32 = 4.0;
/// Part of the pressing that turns a rotor round in the mean, between its greatest speeds. One that has left the wall: 1. One
/// that lies on a spring and swings so far that it just does not leave it: 2/pi.
const SWINGS: f32 = 0.8;

/// A touch that has not ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenTouch {
    /// Where it began: direction and distance from the told centre, m.
    pub(crate) place: ([f32; 2], f32),
    /// How far in the wall may be from there if it gives way, m.
    pub(crate) slack: f32,
    /// Samples in a row in which the rotor was farther out.
    beyond: u8,
    /// Farthest out since it last went outward, m.
    pub(crate) give: f32,
    /// Fastest inward, as a speed outward, m/s, and samples since.
    inward: f32,
    samples: u16,
}

/// Where the rotor is in a touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TouchStage {
    /// At the wall, or inside of it, as after an impact on a rigid one.
    Open,
    /// The wall has begun to give way.
    GivesWay,
    /// It pushes the rotor, which has not left it.
    Pushed,
    /// The rotor goes outward again without having left the wall: it lies on it.
    Lies,
    /// It has left the wall.
    Left,
}

impl OpenTouch {
    /// It begins at `place`, or so far inside of it if the wall gives way, m.
    pub(crate) fn new(place: ([f32; 2], f32), slack: f32) -> Self {
        Self {
            place,
            slack,
            beyond: 0,
            give: 0.0,
            inward: 0.0,
            samples: 0,
        }
    }

    /// Whether the wall has given way.
    pub(crate) fn gives(&self) -> bool {
        self.beyond >= BEYOND
    }

    /// On a wall that has not given way: takes how much farther out than there the rotor is seen, known to `spread`, and how
    /// far it would have `gone` without the wall, m.
    pub(crate) fn look(&mut self, seen: f32, spread: f32, gone: f32) -> TouchStage {
        let clear = CLEAR * spread;
        let is_beyond = seen > clear;
        self.beyond = if is_beyond { self.beyond + 1 } else { 0 };
        match () {
            () if self.gives() => TouchStage::GivesWay,
            () if seen < -clear || !is_beyond && gone > SHOWN * clear => TouchStage::Left,
            () => TouchStage::Open,
        }
    }

    /// On a wall that gives way: takes how much farther out than there the rotor is (m), known to `spread`, and its speed
    /// outward (m/s), known to `speed_error`. A sample changes that by `pressing` where nothing but the pull acts.
    pub(crate) fn follow(
        &mut self,
        out: f32,
        spread: f32,
        (speed, speed_error): (f32, f32),
        pressing: f32,
    ) -> TouchStage {
        self.samples = self.samples.saturating_add(1);
        if speed < self.inward {
            self.inward = speed;
            self.samples = 0;
        }
        self.give = self.give.max(out);
        if out < -self.slack - CLEAR * spread {
            return TouchStage::Left;
        }
        let error = CLEAR * speed_error;
        if self.inward > -error || speed < error {
            return TouchStage::Pushed;
        }
        let falls = SWINGS * pressing * f32::from(self.samples);
        if speed - self.inward < falls {
            TouchStage::Lies
        } else {
            TouchStage::Left
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f32 = 5e-5;
    const NOISE: f32 = 0.7e-6;
    const G: f32 = 9.81;
    const SPEED: f32 = 0.05;

    /// A rotor that meets a spring with 50 mm/s, under its weight: when the wall is seen to give way, s, and what follows when.
    fn on_a_spring(angular_frequency: f32, damping: f32) -> (f32, TouchStage, f32) {
        let mut touch = OpenTouch::new(([0.0, -1.0], 3e-4), 0.0);
        let (mut out, mut speed) = (0.0, SPEED);
        let mut gives = 0.0;
        for k in 1..1_000_u16 {
            for _ in 0..100 {
                let pushed = angular_frequency * (angular_frequency * out + damping * speed);
                let push = if out > 0.0 { pushed.max(0.0) } else { 0.0 };
                speed += 0.01 * PERIOD * (G - push);
                out += 0.01 * PERIOD * speed;
            }
            let stage = if touch.gives() {
                touch.follow(out, NOISE, (speed, 1e-3), G * PERIOD)
            } else {
                touch.look(out, NOISE, SPEED * f32::from(k) * PERIOD)
            };
            let time = f32::from(k) * PERIOD;
            match stage {
                TouchStage::GivesWay => gives = time,
                TouchStage::Left | TouchStage::Lies => return (gives, stage, time),
                TouchStage::Open | TouchStage::Pushed => {}
            }
        }
        panic!("nothing follows");
    }

    #[test]
    fn a_soft_wall_is_left_after_one_touch() {
        // Half a period of the rotor on it: 2.6 ms.
        for damping in [0.05, 0.3] {
            let (gives, stage, time) = on_a_spring(1_200.0, damping);
            assert!(gives > 0.0 && gives < 0.5e-3, "{gives}");
            assert_eq!(stage, TouchStage::Left);
            assert!((2.3e-3..3.2e-3).contains(&time), "{time}");
        }
    }

    #[test]
    fn a_rotor_that_does_not_leave_a_soft_wall_lies_there() {
        let (gives, stage, time) = on_a_spring(300.0, 0.6);
        assert!(gives > 0.0 && gives < 0.5e-3, "{gives}");
        assert_eq!(stage, TouchStage::Lies);
        assert!(time < 30e-3, "{time}");
    }

    #[test]
    fn a_hard_wall_does_not_give_way() {
        let mut touch = OpenTouch::new(([0.0, -1.0], 3e-4), 0.0);
        // Seen inside of where the impact was, as restitution takes it.
        for k in 1..10_u16 {
            let time = f32::from(k) * PERIOD;
            let stage = touch.look(-0.02 * time, NOISE, SPEED * time);
            assert!(
                matches!(stage, TouchStage::Open | TouchStage::Left),
                "{stage:?}"
            );
        }
        // Nor where single samples are farther out than the noise goes.
        let mut touch = OpenTouch::new(([0.0, -1.0], 3e-4), 0.0);
        for k in 0..100 {
            let seen = if k % 4 == 3 { 0.0 } else { 4.0 * NOISE };
            assert_eq!(touch.look(seen, NOISE, 0.0), TouchStage::Open);
        }
    }

    #[test]
    fn a_wall_that_does_not_give_way_at_once_is_a_hard_one() {
        let mut touch = OpenTouch::new(([0.0, -1.0], 3e-4), 0.0);
        let gone = |k: u16| SPEED * f32::from(k) * PERIOD;
        assert_eq!(touch.look(0.0, NOISE, gone(3)), TouchStage::Open);
        assert_eq!(touch.look(0.0, NOISE, gone(4)), TouchStage::Left);
    }
}
