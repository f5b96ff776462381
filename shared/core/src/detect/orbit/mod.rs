//! Where a floating rotor is and goes: a trend and, where there is one, an orbit, a circle or ellipse at one frequency, by
//! unbalance, and its harmonics, by runout. The orbit is searched for until found, then followed, so that what is left is
//! noise.

mod follow;
mod search;

use self::follow::{Follow, Orbit};
use self::search::{Search, Searching};
use crate::config::DetectorConfig;
use crate::detect::pending::StraightWay;
use crate::detect::trend::{MEMORY, TrendObserver};
use crate::vector::{less, sum};

/// Parts of the arming time that an orbit is searched for and fitted in. The rest shows what is left of it.
const SEARCH: f32 = 0.35;
const FIT: f32 = 0.4;
/// Turns that a trial lasts at least: harmonics come from nothing.
const TRIAL: f32 = 6.0;
/// Seconds over which the variance of the residual is learnt, but for a turn where that is longer.
const RESIDUAL_TIME: f32 = 0.03;
/// Most of it that one value counts for: a fall is no other orbit.
const CLIP: f32 = 9.0;
/// Part of the variance that following an orbit may leave.
const MOST_LEFT: f32 = 0.5;
/// Radius from which on an orbit is the rotor's and ends with the levitation, m: sensors' runout, which goes
/// on, is smaller.
const RUNOUT: f32 = 8e-6;
/// Slowest orbit, rad/s, that is found and followed: slower ones are a trend.
const SLOWEST: f32 = 50.0;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orbiting {
    search: Search,
    follow: Follow,
    /// Samples of a search, and of a fit.
    search_samples: u32,
    fit_samples: u32,
    /// Samples of the residual's variance.
    samples: u32,
    /// Samples of the trend's memory.
    trend_memory: f32,
    /// Least angle in a sample of an orbit, rad.
    slowest: f32,
}

/// What is known of trend and orbit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OrbitState {
    pub(crate) learnt: LearntOrbit,
    searching: Searching,
}

/// The trend, and the orbit that is followed, if there is one.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct LearntOrbit {
    /// Alone, and beside the orbit.
    alone: TrendObserver,
    beside: TrendObserver,
    count: u32,
    orbit: Option<Orbit>,
    /// Whether the orbit has shown what it explains: it is on trial before.
    pub(crate) is_certain: bool,
    /// Of one axis about trend and orbit, m^2.
    variance: f32,
}

/// What trend and orbit do not explain of a position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residual {
    /// m.
    pub(crate) way: [f32; 2],
    /// Whether it is the first of its kind: residuals before it are not comparable.
    pub(crate) first: bool,
    /// The position without what goes on when the levitation ends, runout, and without the orbit as well, m.
    pub(crate) parts: [[f32; 2]; 2],
}

impl Orbiting {
    pub(crate) fn new(config: &DetectorConfig) -> Self {
        let (time, sample_rate) = (config.tuning.arming_time, config.sample_rate);
        Self {
            search: Search::new(sample_rate),
            follow: Follow::new(sample_rate),
            search_samples: (SEARCH * time * sample_rate) as u32,
            fit_samples: (FIT * time * sample_rate) as u32,
            samples: (RESIDUAL_TIME * sample_rate) as u32,
            trend_memory: MEMORY * sample_rate,
            slowest: SLOWEST / sample_rate,
        }
    }

    /// To the next sample, whatever the rotor does; `spin` as measured, rad/s.
    pub(crate) fn advance(&self, state: &mut OrbitState, spin: Option<f32>) {
        state.learnt.alone.advance();
        state.learnt.beside.advance();
        if let Some(orbit) = &mut state.learnt.orbit {
            self.follow.advance(orbit, spin);
        }
    }

    /// Takes a position, m, of a rotor that floats with this variance (m^2), of which `noise` is white. The orbit is
    /// learnt only while it `floats` for certain.
    pub(crate) fn take(
        &self,
        state: &mut OrbitState,
        position: [f32; 2],
        (variance, noise): (f32, f32),
        floats: bool,
    ) -> Residual {
        if !state.learnt.alone.is_known() {
            state.learnt.alone = TrendObserver::at(position);
        }
        let was_certain = state.learnt.is_certain;
        let alone = less(position, state.learnt.alone.position);
        state.learnt.alone.take(alone, self.trend_memory);
        let (mut way, mut parts) = (alone, [position; 2]);
        if let Some(orbit) = &mut state.learnt.orbit
            && orbit.is_fitted()
        {
            let waves = orbit.waves();
            let without = less(position, orbit.place(&waves));
            let beside = less(without, state.learnt.beside.position);
            if was_certain {
                way = beside;
                parts = [sum(without, orbit.fundamental()), without];
            }
            let memory = orbit.memory(self.trend_memory);
            state.learnt.beside.take(beside, memory);
            if floats {
                self.follow.learn(orbit, &waves, beside, memory);
                self.judge(state, beside, (variance, noise));
            }
        } else if floats {
            self.seek(state, position, noise);
        }
        Residual {
            way,
            first: state.learnt.is_certain != was_certain,
            parts,
        }
    }

    /// Time constant of the trend, s.
    pub(crate) fn memory(&self, state: &OrbitState) -> f32 {
        let memory = state.certain().map(|it| it.memory(self.trend_memory));
        memory.unwrap_or(self.trend_memory) / self.trend_memory * MEMORY
    }

    /// Searches for an orbit, and fits it.
    fn seek(&self, state: &mut OrbitState, position: [f32; 2], noise: f32) {
        state.learnt.count = state.learnt.count.saturating_add(1);
        if let Some(orbit) = &mut state.learnt.orbit {
            if let Some(centre) = self.follow.begin(orbit, position) {
                state.learnt.beside = TrendObserver::at(centre);
            }
            return;
        }
        self.search.take(&mut state.searching, position);
        if state.learnt.count >= self.search_samples {
            let rate = self.search.rate(&state.searching, noise);
            let rate = rate.filter(|rate| *rate > self.slowest);
            state.begin_anew();
            state.learnt.orbit =
                rate.map(|rate| self.follow.start(rate, state.learnt.alone.position));
        }
    }

    /// Whether the orbit explains enough of how the rotor moves.
    fn judge(&self, state: &mut OrbitState, [x, y]: [f32; 2], (variance, noise): (f32, f32)) {
        let learnt = &mut state.learnt;
        learnt.count = learnt.count.saturating_add(1);
        let turn = learnt.orbit.as_ref().map_or(0.0, Orbit::turn);
        let is_slow = (learnt.orbit.as_ref()).is_some_and(|it| it.rate < self.slowest);
        let trial = self.fit_samples.max((TRIAL * turn) as u32);
        let memory = self.samples.max(turn as u32);
        let gain = 1.0 / learnt.count.min(memory) as f32;
        let mut square = 0.5 * (x * x + y * y);
        if learnt.is_certain && square > CLIP * learnt.variance {
            square = CLIP * learnt.variance;
        }
        learnt.variance += gain * (square - learnt.variance);
        if learnt.count == trial / 2 {
            // What the fit did not know yet is no noise.
            learnt.variance = 0.0;
        }
        if learnt.is_certain || learnt.count >= trial {
            learnt.is_certain = !is_slow && learnt.variance <= MOST_LEFT * variance + noise;
            if !learnt.is_certain {
                state.begin_anew();
            }
        }
    }
}

impl OrbitState {
    /// Without a search under way: that begins anew.
    pub(crate) fn learnt(&self) -> LearntOrbit {
        if self.learnt.orbit.is_some() {
            return self.learnt;
        }
        LearntOrbit {
            alone: self.learnt.alone,
            ..LearntOrbit::default()
        }
    }

    /// The orbit, once it is certain.
    fn certain(&self) -> Option<&Orbit> {
        let learnt = &self.learnt;
        learnt.orbit.as_ref().filter(|_| learnt.is_certain)
    }

    fn trend(&self) -> &TrendObserver {
        if self.learnt.is_certain {
            &self.learnt.beside
        } else {
            &self.learnt.alone
        }
    }

    /// Where the rotor would be without this acceleration (m/s^2), of which the trend has taken so much since (place, s^2,
    /// and step, s): with the orbit ended in its tangent so many samples ago, and without it.
    pub(crate) fn paths(
        &self,
        age: f32,
        acceleration: [f32; 2],
        taken: [f32; 2],
    ) -> [StraightWay; 2] {
        let TrendObserver { position, step, .. } = *self.trend();
        let path = StraightWay {
            position: less(position, acceleration.map(|it| taken[0] * it)),
            step: less(step, acceleration.map(|it| taken[1] * it)),
        };
        let orbit = self.certain();
        let (place, way) = orbit.map_or(Default::default(), |it| it.before(age));
        let tangent = StraightWay {
            position: sum(path.position, sum(place, way.map(|it| it * age))),
            step: sum(path.step, way),
        };
        [tangent, path]
    }

    /// What is measured has moved by `way`, m: a search begins again.
    pub(crate) fn shift(&mut self, way: [f32; 2]) {
        self.learnt.alone.position = sum(self.learnt.alone.position, way);
        self.learnt.beside.position = sum(self.learnt.beside.position, way);
        match &mut self.learnt.orbit {
            Some(orbit) => orbit.shift(way),
            None => self.begin_anew(),
        }
    }

    /// Looks for an orbit anew.
    fn begin_anew(&mut self) {
        self.learnt.count = 0;
        self.searching.forget();
        self.learnt.orbit = None;
        self.learnt.is_certain = false;
        self.learnt.variance = 0.0;
    }

    /// Forgets all.
    pub(crate) fn forget(&mut self) {
        self.begin_anew();
        self.learnt.alone = TrendObserver::default();
    }

    /// Whether there is no orbit on trial.
    pub(crate) fn is_settled(&self) -> bool {
        self.learnt.orbit.is_none() || self.learnt.is_certain
    }

    /// What of the present position ends with the levitation, m.
    pub(crate) fn ending(&self) -> [f32; 2] {
        let orbit = self.certain();
        let orbit = orbit.filter(|it| it.square() > RUNOUT * RUNOUT);
        orbit.map_or([0.0; 2], |orbit| orbit.fundamental())
    }

    /// Variance of one axis that ends with the levitation, m^2: that of an orbit beyond what runout may be.
    pub(crate) fn ending_variance(&self) -> f32 {
        let beyond = |orbit: &Orbit| orbit.square() - RUNOUT * RUNOUT;
        0.5 * self.certain().map_or(0.0, beyond).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{MachineConfig, Tuning};
    use crate::detect::noise::white;
    use core::f32::consts::TAU;
    use touchdown_rotor::real::sqrt;

    fn orbiting(sample_rate: f32) -> Orbiting {
        Orbiting::new(&DetectorConfig {
            sample_rate,
            machine: MachineConfig {
                mass: 3.0,
                clearance: 0.3e-3,
                gravity: 9.81,
                rotor_radius: 24e-3,
                inertia_ratio: 0.5,
                friction: 0.1,
                restitution: 0.5,
                spin: 1_000.0,
            },
            tuning: Tuning::default(),
        })
    }

    /// Root mean square of what is left of one axis of an orbit of 30 um with runout of 5 um in so many waves and noise of
    /// 1 um, from 0.85 s on, in um, and how often the residual became another.
    fn left(hz: f64, sample_rate: f32, wave: f64) -> (f32, u32) {
        let radius = 30e-6;
        let orbiting = orbiting(sample_rate);
        let (mut state, mut seed) = (OrbitState::default(), 1);
        let (mut sum, mut count, mut firsts) = (0.0, 0.0, 0);
        for k in 0..sample_rate as u32 {
            let time = f64::from(k) / f64::from(sample_rate);
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * hz * time + 1.0);
            let [x, y] = [white(&mut seed), white(&mut seed)].map(|it| 1e-6 * it);
            let runout = 5e-6 * libm::cos(wave * (core::f64::consts::TAU * hz * time)) as f32;
            let position = [
                radius * cos as f32 + x + 5e-5 + runout,
                radius * sin as f32 + y,
            ];
            orbiting.advance(&mut state, None);
            let variance = 0.5 * radius * radius + 1e-12;
            let residual = orbiting.take(&mut state, position, (variance, 1e-12), true);
            firsts += u32::from(residual.first);
            if time > 0.85 {
                let [x, y] = residual.way;
                sum += 0.5 * (x * x + y * y);
                count += 1.0;
            }
        }
        (1e6 * sqrt(sum / count), firsts)
    }

    #[test]
    fn an_orbit_is_found_fitted_and_taken_off() {
        for sample_rate in [10_000.0, 20_000.0, 50_000.0] {
            for (hz, most) in [(10.0, 1.5), (30.0, 1.1), (100.0, 1.1), (500.0, 1.1)] {
                for wave in [1.0, 2.0, 3.0] {
                    let (left, firsts) = left(hz, sample_rate, wave);
                    let case = (hz, sample_rate, wave);
                    assert!(left < most && firsts == 1, "{case:?}: {left} um, {firsts}");
                }
            }
        }
    }

    #[test]
    fn of_an_orbit_ends_with_the_levitation_what_no_runout_reaches() {
        for (radius, ends) in [(30e-6, 418e-12), (12e-6, 40e-12), (5e-6, 0.0)] {
            let (orbiting, mut state, mut seed) = (orbiting(20_000.0), OrbitState::default(), 1);
            for k in 0..10_000_u16 {
                let (sin, cos) = libm::sincosf(TAU * 150.0 / 20_000.0 * f32::from(k));
                let [x, y] = [white(&mut seed), white(&mut seed)].map(|it| 1e-6 * it);
                orbiting.advance(&mut state, None);
                let variance = 0.5 * radius * radius + 1e-12;
                let position = [radius * cos + x, radius * sin + y];
                orbiting.take(&mut state, position, (variance, 1e-12), true);
            }
            assert!(state.learnt.is_certain, "{radius}");
            let found = state.ending_variance();
            assert!(
                (found - ends).abs() < 0.1 * ends + 1e-15,
                "{radius}: {found}"
            );
        }
    }

    #[test]
    fn a_slow_orbit_is_a_trend() {
        for (hz, most) in [(0.0, 1.1), (2.0, 1.1), (5.0, 1.3)] {
            let (left, firsts) = left(hz, 20_000.0, 0.0);
            assert!(left < most && firsts == 0, "{hz} Hz: {left} um, {firsts}");
        }
    }

    /// Whatever its speed does, also before its trial would be over at the new one.
    #[test]
    fn no_orbit_is_followed_below_the_slowest() {
        for (from, time) in [(30.0, 0.5), (30.0, 0.2), (60.0, 0.3), (100.0, 0.2)] {
            let sample_rate = 20_000.0;
            let orbiting = orbiting(sample_rate);
            let (mut state, mut seed) = (OrbitState::default(), 1);
            let (mut angle, mut found, mut slow) = (0.0, 0, 0);
            for k in 0..(1.5 * sample_rate) as u32 {
                let after = f64::from(k) / f64::from(sample_rate) - 0.6;
                let hz: f64 = from * (1.0 - after / time).clamp(0.0, 1.0);
                angle += core::f64::consts::TAU * hz / f64::from(sample_rate);
                let (sin, cos) = libm::sincos(angle);
                let [x, y] = [white(&mut seed), white(&mut seed)].map(|it| 1e-6 * it);
                let position = [3e-5 * cos as f32 + x, 3e-5 * sin as f32 + y];
                orbiting.advance(&mut state, None);
                orbiting.take(&mut state, position, (4.5e-10, 1e-12), true);
                let certain = state.certain();
                found += u32::from(certain.is_some());
                slow += u32::from(certain.is_some_and(|it| it.rate < orbiting.slowest));
            }
            assert!(
                found > 0 && slow == 0,
                "{from} Hz, {time} s: {found}, {slow}"
            );
        }
    }
}
