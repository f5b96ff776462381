//! One channel: what its next value should be, and what it means that it is not.
//!
//! A critically damped alpha-beta-gamma filter foresees the next count; with the squares of its innovations
//! on average, a value that is off is off by the detector's own measure of certainty.

use crate::fault::{Condition, FaultKind, Found};
use crate::memory::Memory;
use touchdown_rotor::real::{ln, sqrt};

/// Part of an innovation that the filter keeps after a sample. Chosen: an orbit of 30 um at 500 Hz and
/// 20 kHz leaves it 1.5 um behind.
const DAMPING: f32 = 0.7;
const POSITION_GAIN: f32 = 1.0 - DAMPING * DAMPING * DAMPING;
const VELOCITY_GAIN: f32 = 1.5 * (1.0 - DAMPING) * (1.0 - DAMPING) * (1.0 + DAMPING);
const ACCELERATION_GAIN: f32 = (1.0 - DAMPING) * (1.0 - DAMPING) * (1.0 - DAMPING);
/// Variance of its innovation in white noise of variance 1, as the test below measures it.
const WHITE_INNOVATION: f32 = 1.96;
/// Samples that the variance of the innovations is learnt over, and before it is used.
const MEMORY: Memory = Memory::of(256);
const WARM_UP: u16 = 64;
/// A squared innovation counts at most this many variances.
const CLIP: f32 = 25.0;
/// Samples in a row that are filled in from the prediction. A fault that lasts longer is no spike.
pub(crate) const HELD: u16 = 4;
/// Part of the repeats that noise never gives which a count that stops moving at once, as by an impact, does not show: with
/// 1 um of noise and 12 bits over 2 mm that is 8. After half of them a quiet rotor that an impact stops is taken for a stuck channel.
const STOPS: u16 = 2;
/// Standard deviations of the innovations that it would have gone in that time.
const GONE: f32 = 6.0;
/// Samples in a row, all sound, after which a lost channel is used again.
const SOUND: u16 = 16;
/// Samples after a motion that was taken for a fault in which nothing is.
const BLIND: u16 = 16;
/// Standard deviation of the noise, in counts, below which the same count over a long time is nothing special: where
/// the position is within a count changes then how often it repeats.
const LEAST_NOISE: f32 = 0.56;
/// How far off a smooth continuation a sample of a turning motion can be, at most: square of it over the sum of
/// the squares of the last two steps. At three samples a turn it is 18.
const FASTEST: f32 = 18.0;
/// Counts from an end within which a channel is expected that runs into it.
const AT_END: f32 = 64.0;

/// Coefficients; lengths in counts, times in samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch {
    /// Log of the odds at which something is certain.
    threshold: f32,
    /// Square of the way off that impacts may be.
    reach: f32,
    full_scale: u16,
}

/// What is known of a channel.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct ChannelMonitorState {
    position: f32,
    velocity: f32,
    acceleration: f32,
    /// Of the innovations, and the least so far.
    variance: f32,
    quiet: f32,
    seen: u16,
    /// Of this sample, and how far it is from the prediction.
    value: f32,
    innovation: f32,
    /// Last count, how often it has come again, and how often noise does not let it.
    count: u16,
    repeats: u16,
    stuck_after: u16,
    /// Velocity and acceleration when it came for the first time.
    course: [f32; 2],
    /// Whether that is known no longer.
    stale: bool,
    /// The last values used.
    last: [f32; 3],
    /// Samples in a row that are no good, why, how far off the first of them was, and whether all are as far.
    bad: u16,
    cause: FaultKind,
    first: f32,
    is_still: bool,
    /// Samples in a row that are.
    sound: u16,
    blind: u16,
    /// Of a channel that has jumped and is all there is.
    shift: f32,
    pub(crate) condition: Condition,
    /// Whether the condition stays.
    latched: bool,
    /// Whether nothing is known against it, and it well enough to go on.
    ready: bool,
}

impl Default for ChannelMonitorState {
    fn default() -> Self {
        Self {
            position: 0.0,
            velocity: 0.0,
            acceleration: 0.0,
            variance: 0.0,
            quiet: f32::INFINITY,
            seen: 0,
            value: 0.0,
            innovation: 0.0,
            count: 0,
            repeats: 0,
            stuck_after: u16::MAX,
            course: [0.0; 2],
            stale: false,
            last: [0.0; 3],
            bad: 0,
            cause: FaultKind::Missing,
            first: 0.0,
            is_still: true,
            sound: 0,
            blind: 0,
            shift: 0.0,
            condition: Condition::Ok,
            latched: false,
            ready: false,
        }
    }
}

/// How the value of a sample looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// As foreseen, or nothing is foreseen.
    Calm,
    /// Not quite.
    Loud,
    /// Far off.
    Off,
    /// Far off, as others are: the rotor moves.
    Motion,
    /// There is none.
    Unusable(FaultKind),
}

impl Watch {
    /// `reach` is in counts.
    pub(crate) fn new(threshold: f32, reach: f32, full_scale: u16) -> Self {
        Self {
            threshold,
            reach: reach * reach,
            full_scale,
        }
    }

    /// The value of a sample that is as foreseen, or nearly, of a channel that is sound, and whether it is not
    /// quite: nothing has to be found out then. Else nothing is changed.
    #[inline]
    pub(crate) fn glance(
        &self,
        it: &mut ChannelMonitorState,
        count: u16,
        floats: bool,
    ) -> Option<(f32, bool)> {
        let repeats = if count == it.count {
            it.repeats
        } else {
            u16::MAX
        };
        let repeats = repeats.wrapping_add(1);
        let is_usable = it.ready && count > 0 && count < self.full_scale;
        if !is_usable || it.is_stuck(repeats, floats) {
            return None;
        }
        let value = f32::from(count) - it.shift;
        let position = it.position + (it.velocity + 0.5 * it.acceleration);
        let innovation = value - position;
        let square = innovation * innovation;
        let bound = self.bound(it, floats);
        if square > bound {
            return None;
        }
        if repeats == 0 {
            it.course = [it.velocity, it.acceleration];
        }
        it.count = count;
        it.repeats = repeats;
        it.position = position;
        it.velocity += it.acceleration;
        self.follow(it, innovation);
        let [a, b, _] = it.last;
        it.last = [value, a, b];
        Some((value, square > 0.25 * bound))
    }

    /// Foresees the sample and looks at it; `floats` while the rotor does.
    pub(crate) fn look(
        &self,
        it: &mut ChannelMonitorState,
        count: Option<u16>,
        floats: bool,
    ) -> Look {
        if it.condition != Condition::Lost {
            it.position += it.velocity + 0.5 * it.acceleration;
            it.velocity += it.acceleration;
        }
        let Some(count) = count else {
            it.repeats = 0;
            return Look::Unusable(FaultKind::Missing);
        };
        let value = f32::from(count);
        if count == 0 || count >= self.full_scale {
            let near = it.seen > 0 && (value - it.position - it.shift).abs() < AT_END;
            return Look::Unusable(match (near, count) {
                (true, _) => FaultKind::Saturated,
                (false, 0) => FaultKind::Short,
                (false, _) => FaultKind::Open,
            });
        }
        if count == it.count {
            it.repeats = it.repeats.saturating_add(1);
        } else {
            it.repeats = 0;
            it.course = [it.velocity, it.acceleration];
        }
        it.count = count;
        it.value = value - it.shift;
        it.innovation = it.value - it.position;
        // Where it was stuck is no place to judge it by: the rotor has moved since.
        let was_stuck = it.condition == Condition::Lost && it.cause == FaultKind::Stuck;
        if it.seen < WARM_UP || it.blind > 0 || was_stuck {
            return Look::Calm;
        }
        let square = it.innovation * it.innovation;
        let bound = self.bound(it, floats);
        if square > bound && (floats || it.leaps(bound)) {
            Look::Off
        } else if square > 0.25 * bound {
            Look::Loud
        } else {
            Look::Calm
        }
    }

    /// Square of what an innovation may be.
    fn bound(&self, it: &ChannelMonitorState, floats: bool) -> f32 {
        let noise = 2.0 * self.threshold * it.variance;
        if floats || noise > self.reach {
            noise
        } else {
            self.reach
        }
    }

    /// Takes the sample as it looks, other channels seen; the value to use, in counts, and what is new. `spare`
    /// where the other plane is sound.
    pub(crate) fn take(
        &self,
        it: &mut ChannelMonitorState,
        look: Look,
        floats: bool,
        spare: bool,
    ) -> (Option<f32>, Option<Found>) {
        let taken = self.judge(it, look, floats, spare);
        if let (Some(value), _) = taken {
            let [a, b, _] = it.last;
            it.last = [value, a, b];
        }
        it.ready = it.is_ready();
        taken
    }

    fn judge(
        &self,
        it: &mut ChannelMonitorState,
        look: Look,
        floats: bool,
        spare: bool,
    ) -> (Option<f32>, Option<Found>) {
        it.blind = it.blind.saturating_sub(1);
        let cause = match look {
            Look::Unusable(kind) => kind,
            Look::Off => FaultKind::Spike,
            Look::Motion if it.bad > 0 && it.condition != Condition::Lost => {
                it.restart();
                return (Some(it.value), None);
            }
            Look::Calm | Look::Loud | Look::Motion => return self.sound(it, floats),
        };
        it.sound = 0;
        let value = it.value;
        if it.bad == 0 {
            it.cause = cause;
            it.first = it.innovation;
            it.is_still = true;
        } else if it.cause != cause {
            // It bounces about.
            it.is_still = false;
            if it.cause == FaultKind::Spike {
                it.cause = cause;
            }
        }
        it.bad = it.bad.saturating_add(1);
        if cause == FaultKind::Spike {
            // A motion would grow.
            let more = it.innovation - it.first;
            it.is_still &= more * more <= self.bound(it, floats);
        }
        if it.condition == Condition::Lost {
            return (None, None);
        }
        if it.bad <= HELD {
            // No more than the velocity is worth going on with.
            it.acceleration = 0.0;
            return ((it.seen >= WARM_UP).then_some(it.position), None);
        }
        if it.cause != FaultKind::Spike {
            it.condition = Condition::Lost;
            return (None, found(it.cause, HELD));
        }
        if !it.is_still {
            // It was motion.
            it.restart();
            return (Some(value), None);
        }
        it.latched = true;
        if spare {
            it.condition = Condition::Lost;
            return (None, found(FaultKind::Shift, HELD));
        }
        it.condition = it.condition.max(Condition::Suspect);
        it.shift += value - it.position;
        it.bad = 0;
        (Some(it.position), found(FaultKind::Shift, HELD))
    }

    fn sound(&self, it: &mut ChannelMonitorState, floats: bool) -> (Option<f32>, Option<Found>) {
        let value = it.value;
        if it.is_stuck(it.repeats, floats) {
            it.sound = 0;
            it.bad = 0;
            if it.condition == Condition::Lost {
                return (None, None);
            }
            (it.condition, it.cause) = (Condition::Lost, FaultKind::Stuck);
            return (None, found(FaultKind::Stuck, it.repeats));
        }
        if it.condition == Condition::Lost {
            it.sound = it.sound.saturating_add(u16::from(it.repeats == 0));
            if it.latched || it.sound < SOUND {
                return (None, None);
            }
            it.condition = Condition::Ok;
            it.restart();
            return (Some(value), None);
        }
        let mut ended = None;
        if it.bad > 0 {
            let kind = match it.cause {
                FaultKind::Missing => FaultKind::Dropped,
                FaultKind::Saturated => FaultKind::Saturated,
                _ => FaultKind::Spike,
            };
            ended = found(kind, it.bad).filter(|_| it.seen >= WARM_UP);
            it.bad = 0;
        }
        if it.seen == 0 {
            it.restart();
        }
        self.follow(it, it.innovation);
        (Some(value), ended)
    }

    #[inline]
    fn follow(&self, it: &mut ChannelMonitorState, innovation: f32) {
        it.position += POSITION_GAIN * innovation;
        it.velocity += VELOCITY_GAIN * innovation;
        it.acceleration += ACCELERATION_GAIN * innovation;
        let mut square = innovation * innovation;
        if it.seen >= WARM_UP && square > CLIP * it.variance {
            square = CLIP * it.variance;
        }
        it.seen += 1;
        it.variance += MEMORY.gain(it.seen.into()) * (square - it.variance);
        if u32::from(it.seen) >= 4 * MEMORY.samples {
            it.seen = 3 * MEMORY.samples as u16;
            if it.variance < it.quiet {
                it.quiet = it.variance;
                it.stale = true;
            }
        }
    }

    /// What follows slowly from the noise.
    #[inline]
    pub(crate) fn refine(&self, it: &mut ChannelMonitorState) {
        if it.stale {
            it.stale = false;
            it.stuck_after = stuck_after(it.quiet, self.threshold);
        }
    }
}

impl ChannelMonitorState {
    /// Whether a count that has come again so often is no measurement: noise does not let it, nor, once the rotor does not
    /// float, the way that the channel was going.
    #[inline]
    fn is_stuck(&self, repeats: u16, floats: bool) -> bool {
        if repeats < self.stuck_after / STOPS || self.stuck_after == u16::MAX {
            return false;
        }
        if repeats >= self.stuck_after {
            return true;
        }
        // At the end of a fast swing the filter is late, and takes the channel to be still under way.
        let (time, [velocity, acceleration]) = (f32::from(repeats), self.course);
        let way = time * velocity;
        let turning = way + 0.5 * time * time * acceleration;
        let gone = GONE * GONE * self.quiet;
        !floats && way * way > gone && turning * turning > gone
    }

    /// Whether its value is no smooth continuation of the last either: where the rotor whirls, the filter lags.
    fn leaps(&self, bound: f32) -> bool {
        let [a, b, c] = self.last;
        let leap = self.value - 3.0 * (a - b) - c;
        let steps = (a - b) * (a - b) + (b - c) * (b - c);
        leap * leap > bound.max(FASTEST * steps)
    }

    /// From a place that has not been foreseen.
    fn restart(&mut self) {
        self.position = self.value;
        self.innovation = 0.0;
        self.velocity = 0.0;
        self.acceleration = 0.0;
        self.bad = 0;
        self.blind = BLIND;
    }

    /// Another test has found a fault that stays. Whether that is new.
    pub(crate) fn condemn(&mut self, condition: Condition) -> bool {
        let is_new = condition > self.condition;
        self.condition = self.condition.max(condition);
        self.latched |= is_new;
        self.ready = self.is_ready();
        is_new
    }

    fn is_ready(&self) -> bool {
        self.is_own() && self.blind == 0 && self.seen >= WARM_UP
    }

    /// Whether its value is its own.
    pub(crate) fn is_own(&self) -> bool {
        self.bad == 0 && self.condition != Condition::Lost
    }

    /// What the next tick goes on from.
    pub(crate) fn words(&self) -> [f32; 4] {
        [self.position, self.velocity, self.variance, self.shift]
    }
}

fn found(kind: FaultKind, samples: u16) -> Option<Found> {
    let age = u32::from(samples);
    Some(Found { kind, age })
}

/// Repeats of a count that noise does not give: the likeliest count of noise s has the probability
/// q = erf(1/(2 sqrt(2) s)), n repeats of it q^n.
fn stuck_after(innovations: f32, threshold: f32) -> u16 {
    let noise = innovations / WHITE_INNOVATION - 1.0 / 12.0;
    if noise < LEAST_NOISE * LEAST_NOISE {
        return u16::MAX;
    }
    let likeliest = erf(0.353_553_4 / sqrt(noise)).max(1e-3);
    // A short run is also what slow motion in a coarse count gives.
    (threshold / -ln(likeliest)).max(6.0) as u16 + 1
}

/// Error function up to 0.65, to 1e-6: the first terms of its series.
fn erf(x: f32) -> f32 {
    let q = x * x;
    let series =
        1.0 - q * (1.0 / 3.0 - q * (0.1 - q * (1.0 / 42.0 - q * (1.0 / 216.0 - q / 1_320.0))));
    core::f32::consts::FRAC_2_SQRT_PI * x * series
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::white;

    /// The first value is not foreseen: it must not count as noise.
    #[test]
    fn noise_is_known_once_it_is_used() {
        let watch = Watch::new(25.3, 80.0, 4095);
        let mut it = ChannelMonitorState::default();
        for k in 0..WARM_UP {
            let count = 2_048 + 2 * (k % 2);
            let look = watch.look(&mut it, Some(count), true);
            watch.take(&mut it, look, true, false);
        }
        assert!(it.variance < 10.0, "{}", it.variance);
    }

    #[test]
    fn error_function_as_libm_has_it() {
        for k in 1..=65 {
            let x = 0.01 * k as f32;
            assert!((erf(x) / libm::erff(x) - 1.0).abs() < 1e-6, "{x}");
        }
    }

    /// 1 um at 12 bit over 2 mm: the likeliest count has the probability 0.19.
    #[test]
    fn repeats_are_as_rare_as_a_false_alarm() {
        let innovations = |noise: f32| WHITE_INNOVATION * (noise * noise + 1.0 / 12.0);
        assert_eq!(stuck_after(innovations(2.048), 25.3), 16);
        assert_eq!(stuck_after(innovations(20.0), 25.3), 7);
        assert_eq!(stuck_after(innovations(0.5), 25.3), u16::MAX);
    }

    /// A rotor that is kicked goes 30 counts a sample: once that is known for motion, the filter has to catch up with it.
    #[test]
    fn what_was_motion_is_followed_before_it_is_judged() {
        let watch = Watch::new(25.3, 80.0, 4095);
        let (mut it, mut seed) = (ChannelMonitorState::default(), 1);
        for k in 0..1_040_u16 {
            let way = f32::from(30 * k.saturating_sub(1_000));
            let count = (2_048.0 + way + 2.0 * white(&mut seed)) as u16;
            let look = watch.look(&mut it, Some(count), true);
            let taken = watch.take(&mut it, look, true, true);
            if k > 1_000 + HELD {
                assert_eq!(taken, (Some(f32::from(count)), None), "{k}");
            }
        }
    }

    #[test]
    fn a_channel_that_was_stuck_is_used_again_wherever_the_rotor_is() {
        let watch = Watch::new(25.3, 80.0, 4095);
        let (mut it, mut seed) = (ChannelMonitorState::default(), 1);
        let mut lost = 0;
        for k in 0..2_100_u16 {
            let way = f32::from(k.saturating_sub(1_998));
            let noisy = (2_048.0 + way + 2.0 * white(&mut seed)) as u16;
            let count = if (2_000..2_050).contains(&k) {
                2_048
            } else {
                noisy
            };
            let look = watch.look(&mut it, Some(count), true);
            watch.take(&mut it, look, true, true);
            watch.refine(&mut it);
            lost += u16::from(it.condition == Condition::Lost);
        }
        assert_eq!(it.condition, Condition::Ok);
        assert!((20..70).contains(&lost), "{lost}");
    }

    /// Its count of sound samples once ran over, after 65 536 of them.
    #[test]
    fn a_channel_that_is_latched_stays_lost_for_good() {
        let watch = Watch::new(25.3, 80.0, 4095);
        let mut it = ChannelMonitorState::default();
        it.condemn(Condition::Lost);
        for k in 0..70_000_u32 {
            let look = watch.look(&mut it, Some(2_048 + (k % 2) as u16), true);
            let (position, _) = watch.take(&mut it, look, true, false);
            assert_eq!((position, it.condition), (None, Condition::Lost), "{k}");
        }
    }
}
