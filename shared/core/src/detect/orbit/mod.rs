//! The orbit of a floating rotor: a circle or ellipse at one frequency, by unbalance, and its harmonics,
//! by runout. Searched for until found, then followed, so that what is left is noise.

mod follow;
#[cfg(feature = "serde")]
mod learnt;
mod search;

use self::follow::{Follow, Orbit};
#[cfg(feature = "serde")]
pub(crate) use self::learnt::Followed;
use self::search::{Search, Searching};

/// Parts of the arming time that an orbit is searched for and fitted in. The rest shows what is left of it.
const SEARCH: f32 = 0.35;
const FIT: f32 = 0.4;
/// Seconds over which the variance of the residual is learnt.
const RESIDUAL_TIME: f32 = 0.03;
/// Part of the variance that following an orbit may leave.
const MOST_LEFT: f32 = 0.5;
/// Radius from which on an orbit is the rotor's and ends with the levitation, m: sensors' runout, which goes
/// on, is smaller.
const RUNOUT: f32 = 8e-6;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orbiting {
    search: Search,
    follow: Follow,
    /// Samples of a search, and of a fit.
    search_samples: u32,
    fit_samples: u32,
    memory: f32,
}

/// What is known of the orbit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OrbitState {
    count: u32,
    searching: Searching,
    orbit: Option<Orbit>,
    /// Of one axis about the orbit, m^2.
    variance: f32,
}

/// What an orbit does not explain of a position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residual {
    /// m.
    pub(crate) way: [f32; 2],
    /// Of one axis, m^2.
    pub(crate) variance: f32,
    /// Whether it is the first of its kind: residuals before it are not comparable.
    pub(crate) first: bool,
}

impl Orbiting {
    /// `time` is that of arming, s.
    pub(crate) fn new(time: f32, sample_rate: f32) -> Self {
        Self {
            search: Search::new(sample_rate),
            follow: Follow::new(sample_rate),
            search_samples: (SEARCH * time * sample_rate) as u32,
            fit_samples: (FIT * time * sample_rate) as u32,
            memory: (RESIDUAL_TIME * sample_rate).max(1.0),
        }
    }

    /// To the next sample, whatever the rotor does; `spin` as measured, rad/s.
    pub(crate) fn advance(&self, state: &mut OrbitState, spin: Option<f32>) {
        if let Some(orbit) = &mut state.orbit {
            self.follow.advance(orbit, spin);
        }
    }

    /// Takes a position, m, of a rotor that floats about `mean` with this variance (m^2), of which
    /// `noise` is white.
    pub(crate) fn take(
        &self,
        state: &mut OrbitState,
        position: [f32; 2],
        (mean, variance): ([f32; 2], f32),
        noise: f32,
    ) -> Residual {
        state.count = state.count.saturating_add(1);
        let mut residual = Residual {
            way: [position[0] - mean[0], position[1] - mean[1]],
            variance: variance.max(noise),
            first: false,
        };
        let Some(orbit) = &mut state.orbit else {
            self.search.take(&mut state.searching, position);
            if state.count >= self.search_samples {
                let rate = self.search.rate(&state.searching, noise);
                state.forget();
                state.orbit = rate.map(|rate| self.follow.start(rate, mean));
            }
            return residual;
        };
        let way @ [x, y] = self.follow.learn(orbit, position);
        let gain = 1.0 / (state.count as f32).min(self.memory);
        state.variance += gain * (0.5 * (x * x + y * y) - state.variance);
        if state.count == self.fit_samples / 2 {
            // What the fit did not know yet is no noise.
            state.variance = 0.0;
        }
        let fitted = state.count >= self.fit_samples;
        if fitted && state.variance > MOST_LEFT * variance + noise {
            state.forget();
            residual.first = true;
        } else if fitted {
            residual = Residual {
                way,
                variance: state.variance.max(noise),
                first: state.count == self.fit_samples,
            };
        }
        residual
    }
}

impl OrbitState {
    /// What is measured has moved by `way`, m: a search begins again.
    pub(crate) fn shift(&mut self, way: [f32; 2]) {
        match &mut self.orbit {
            Some(orbit) => orbit.shift(way),
            None => self.forget(),
        }
    }

    /// Forgets all.
    pub(crate) fn forget(&mut self) {
        self.count = 0;
        self.searching.forget();
        self.orbit = None;
        self.variance = 0.0;
    }

    /// Whether there is no orbit to be fitted first.
    pub(crate) fn is_fitted(&self, orbiting: &Orbiting) -> bool {
        self.orbit.is_none() || self.count >= orbiting.fit_samples
    }

    /// What of the present position ends with the levitation, m.
    pub(crate) fn ending(&self) -> [f32; 2] {
        let orbit = self.orbit.as_ref();
        let orbit = orbit.filter(|it| it.square() > RUNOUT * RUNOUT);
        orbit.map_or([0.0; 2], |orbit| orbit.fundamental())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::noise::white;

    #[test]
    fn an_orbit_is_found_fitted_and_taken_off() {
        for hz in [10.0, 20.0, 50.0, 100.0, 200.0, 500.0] {
            let orbiting = Orbiting::new(0.14, 20_000.0);
            let (mut state, mut seed) = (OrbitState::default(), 1);
            let (mut sum, mut firsts) = (0.0, 0);
            for k in 0..8_000 {
                let angle = core::f64::consts::TAU * hz * f64::from(k) / 20_000.0 + 1.0;
                let (sin, cos) = libm::sincos(angle);
                let [x, y] = [white(&mut seed), white(&mut seed)].map(|it| 1e-6 * it);
                let position = [30e-6 * cos as f32 + x, 30e-6 * sin as f32 + y];
                orbiting.advance(&mut state, None);
                let floats = ([0.0; 2], 450e-12);
                let residual = orbiting.take(&mut state, position, floats, 1e-12);
                firsts += u32::from(residual.first);
                if k >= 2_800 {
                    let [x, y] = residual.way;
                    sum += 0.5 * (x * x + y * y) / 5_200.0;
                }
            }
            assert_eq!(firsts, 1, "{hz} Hz");
            assert!(sum < 1.1e-12, "{hz} Hz: {sum} m^2");
        }
    }

    #[test]
    fn without_an_orbit_the_residual_is_that_of_the_mean() {
        let orbiting = Orbiting::new(0.14, 20_000.0);
        let (mut state, mut seed) = (OrbitState::default(), 1);
        for _ in 0..20_000 {
            let position = [1e-6 * white(&mut seed), 1e-6 * white(&mut seed)];
            orbiting.advance(&mut state, None);
            let residual = orbiting.take(&mut state, position, ([1e-6, 0.0], 1e-12), 1e-12);
            assert_eq!(residual.way, [position[0] - 1e-6, position[1]]);
            assert!(state.is_fitted(&orbiting) && !residual.first);
        }
    }
}
