//! Free fall after levitation: how late it is declared, against the bound; what is missed; what is
//! declared before the release.

use std::f64::consts::TAU;

use itertools::iproduct;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::EventKind;

use super::figure::{Curve, Curves, Figure, histogram};
use super::levitated::{LEAD, Levitated, ORBIT, RUNOUT};
use super::watch::Watched;
use super::{Drop, Findings, Named, Plan, Row, bound, campaign, planes};
use touchdown_base::evenly::{direction, in_disc};
use touchdown_base::failure::Failure;
use touchdown_base::statistics::{median, quantile};
use touchdown_scene::Scene;

/// Of the latency's median to the bound, in white noise.
const WHITE: f64 = 1.15;
/// Likewise with an orbit and runout, or where the fall is none that gravity alone makes.
const DISTURBED: f64 = 1.5;

/// A fall from the middle of the gap of 0.3 mm reaches the wall after 7.8 ms; this is twice that.
const WATCHED: f64 = 15e-3;
/// Levitation where there is an orbit: ten turns of the slowest.
const ORBIT_LEAD: f64 = 1.0;
/// Farthest that the rotor floats from the middle of the gap, m.
const OFF_CENTRE: f64 = 60e-6;

/// Change of speed where it sweeps, a second, up or down.
const SWEEP: f64 = 0.2;
/// Of a rotor that is thrown or drifts, m/s.
const THROW: f64 = 10e-3;

/// Directions of a throw, and places of its release between samples, over which the bound is a mean.
const PLACES: u32 = 16;
/// Sample rates, Hz.
const RATES: [f64; 3] = [10e3, 20e3, 50e3];

#[derive(Clone, Copy, Debug)]
struct Orbit {
    frequency: f64,
    harmonic: u32,
    sweeps: bool,
    /// Whether the speed is known.
    is_told: bool,
}

#[derive(Clone, Copy, Debug)]
struct Case {
    noise: f64,
    rate: f64,
    planes: u8,
    orbit: Option<Orbit>,
    gravity: f64,
    thrown: f64,
}

const USUAL: Case = Case {
    noise: 1e-6,
    rate: 20e3,
    planes: 2,
    orbit: None,
    gravity: 9.81,
    thrown: 0.0,
};

impl Case {
    fn name(&self) -> String {
        if let Some(orbit) = self.orbit {
            let sweeps = if orbit.sweeps { "sweeping" } else { "steady" };
            let told = if orbit.is_told { "known" } else { "unknown" };
            return format!(
                "orbit 30 um {} Hz, runout 5 um x {}, {sweeps}, speed {told}",
                orbit.frequency, orbit.harmonic
            );
        }
        if self.gravity == 0.0 {
            return "no gravity, drifts at 10 mm/s".to_owned();
        }
        if self.thrown > 0.0 {
            return "thrown at 10 mm/s, any direction".to_owned();
        }
        let (um, khz) = (self.noise * 1e6, self.rate / 1e3);
        format!("white noise {um} um, {khz} kHz, {}", planes(self.planes))
    }

    /// Whether nothing but white noise disturbs a fall by gravity alone.
    fn is_plain(&self) -> bool {
        self.orbit.is_none() && self.thrown == 0.0
    }

    fn drop(&self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let mut scene = Scene::load("rig")?;
        scene.run.sample_rate = self.rate;
        scene.run.seed = random.random();
        scene.run.duration = WATCHED;
        scene.run.gravity = self.gravity;
        scene.sensors.noise = self.noise;
        scene.sensors.planes = self.planes;
        scene.sensors.speed = self.orbit.is_some_and(|it| it.is_told);
        let mut floats = Levitated {
            place: in_disc(random, OFF_CENTRE),
            spin: scene.rotor.spin,
            ..Levitated::default()
        };
        let sign = if random.random() { 1.0 } else { -1.0 };
        let angle = random.random_range(0.0..TAU);
        if let Some(orbit) = self.orbit {
            scene.sensors.runout = RUNOUT;
            scene.sensors.runout_harmonic = orbit.harmonic;
            floats.radius = ORBIT;
            floats.angle = angle;
            floats.spin = sign * TAU * orbit.frequency;
            floats.sweep = if orbit.sweeps { sign * SWEEP } else { 0.0 };
        }
        let thrown = direction(random).map(|part| self.thrown * part);
        let lead = self.orbit.map_or(LEAD, |_| ORBIT_LEAD);
        let first = random.random_range(0.0..1.0);
        Ok(Drop::released(plan, scene, floats, thrown, lead, first))
    }

    /// For the channels that there are, s.
    fn bound(&self) -> Result<f64, Failure> {
        let mut scene = Scene::load("rig")?;
        scene.sensors.noise = self.noise;
        scene.sensors.planes = self.planes;
        let variance = bound::variance(&scene.sensors);
        if self.thrown == 0.0 {
            return Ok(bound::fall(variance, self.gravity, self.rate));
        }
        let delays = iproduct!(0..PLACES, 0..PLACES).map(|(direction, place)| {
            let (sin, cos) = (TAU * f64::from(direction) / f64::from(PLACES)).sin_cos();
            let first = (f64::from(place) + 0.5) / f64::from(PLACES);
            bound::cusum(variance, self.rate, first, |t| {
                let fallen = 0.5 * self.gravity * t * t;
                f64::hypot(self.thrown * cos * t, self.thrown * sin * t - fallen)
            })
        });
        Ok(delays.sum::<f64>() / f64::from(PLACES * PLACES))
    }
}

fn cases() -> Vec<Case> {
    let white = iproduct!([1, 2], RATES, [0.3e-6, 1e-6, 3e-6]);
    let white = white.map(|(planes, rate, noise)| Case {
        noise,
        rate,
        planes,
        ..USUAL
    });
    let thrown = [9.81, 0.0].map(|gravity| Case {
        gravity,
        thrown: THROW,
        ..USUAL
    });
    let frequencies = [10.0, 50.0, 100.0, 200.0, 500.0];
    let orbits = iproduct!(frequencies, [1, 2, 3], [false, true], [false, true]);
    let orbits = orbits.map(|(frequency, harmonic, sweeps, is_told)| Case {
        orbit: Some(Orbit {
            frequency,
            harmonic,
            sweeps,
            is_told,
        }),
        ..USUAL
    });
    white.chain(thrown).chain(orbits).collect()
}

pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let few = cases().into_iter().step_by(13);
    few.map(|case| Ok((case.name(), case.drop(plan, random)?)))
        .collect()
}

/// What became of one drop.
#[derive(Clone, Copy, Debug)]
pub struct Fall {
    /// Declared minus release, s; infinite if missed or withdrawn.
    pub latency: f64,
    /// Likewise confirmed.
    pub confirmed: f64,
    /// Declared before the release.
    pub early: usize,
}

/// Of a drop that was watched.
pub fn fall(watched: &Watched) -> Fall {
    let events = watched.detection.events.iter();
    let falls = events.filter(|it| it.event == EventKind::FreeFall);
    let (early, late): (Vec<_>, Vec<_>) = falls.partition(|it| it.declared_s < 0.0);
    let found = late.iter().find(|it| it.withdrawn_s.is_none());
    let confirmed = found.and_then(|it| it.confirmed_s);
    Fall {
        latency: found.map_or(f64::INFINITY, |it| it.declared_s),
        confirmed: confirmed.unwrap_or(f64::INFINITY),
        early: early.len(),
    }
}

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let falls = campaign::map(plan, "fall", &cases, |case, mut random| {
        Ok(fall(&case.drop(plan, &mut random)?.watch()?))
    })?;
    let mut rows = Vec::new();
    for (case, falls) in cases.iter().zip(&falls) {
        rows.push(judged(case, falls)?);
    }
    let figures = vec![against_noise(&cases, &rows), spread(&cases, &falls)?];
    Ok(Findings { rows, figures })
}

fn judged(case: &Case, falls: &[Fall]) -> Result<Row, Failure> {
    let bound = case.bound()?;
    let latencies: Vec<f64> = falls.iter().map(|it| it.latency).collect();
    let confirmed: Vec<f64> = falls.iter().map(|it| it.confirmed).collect();
    let found = latencies.iter().filter(|it| it.is_finite()).count();
    let early: usize = falls.iter().map(|it| it.early).sum();
    let (middle, late) = (median(&latencies), quantile(&latencies, 0.99));
    let missed = falls.len() - found;
    let ratios: Vec<f64> = latencies.iter().map(|it| it / bound).collect();
    let target = if case.is_plain() { WHITE } else { DISTURBED };
    let row = Row::quantile_at_most(case.name(), "ratio", &ratios, 0.5, target)
        .and(missed == 0 && early == 0)
        .with("drops", falls.len())
        .with("found", found)
        .with("missed", missed)
        .with("false_falls", early)
        .with("latency_median_s", middle)
        .with("latency_p99_s", late)
        .with("confirmed_median_s", median(&confirmed))
        .with("bound_s", bound)
        .with("noise_m", case.noise)
        .with("sample_rate_hz", case.rate)
        .with("planes", case.planes);
    Ok(row.noted(format!(
        "median {:.3} ms, 99 % {:.3} ms, bound {:.3} ms; {missed} missed, {early} false",
        middle * 1e3,
        late * 1e3,
        bound * 1e3
    )))
}

/// Latency of two planes over noise, with the bound.
fn against_noise(cases: &[Case], rows: &[Row]) -> Figure {
    let mut curves = Vec::new();
    for rate in RATES {
        let is_chosen = |it: &Case| it.rate == rate && it.planes == 2 && it.is_plain();
        let points = |name| {
            let chosen = cases.iter().zip(rows).filter(|it| is_chosen(it.0));
            let values = chosen.filter_map(|(case, row)| {
                let value = row.values.get(name)?.as_f64()?;
                Some([case.noise * 1e6, value * 1e3])
            });
            values.collect()
        };
        let khz = rate / 1e3;
        curves.push(Curve::new(format!("{khz} kHz"), points("latency_median_s")));
        curves.push(Curve::limit(format!("bound, {khz} kHz"), points("bound_s")));
    }
    Figure::Curves(Curves {
        title: "Latency of a fall against noise, two planes",
        x: "noise, um",
        y: "latency, median, ms",
        decades: true,
        curves,
    })
}

/// How latencies over their bounds are spread.
fn spread(cases: &[Case], falls: &[Vec<Fall>]) -> Result<Figure, Failure> {
    let mut ratios = [Vec::new(), Vec::new()];
    let by_gravity = |case: &Case| case.thrown == 0.0;
    for (case, falls) in cases.iter().zip(falls).filter(|it| by_gravity(it.0)) {
        let bound = case.bound()?;
        let of = &mut ratios[usize::from(case.orbit.is_some())];
        of.extend(falls.iter().map(|it| it.latency / bound));
    }
    let curves = ["white noise", "orbit and runout"].into_iter().zip(&ratios);
    let curves = curves.map(|(name, ratios)| Curve::new(name, histogram(ratios, 0.05, 5.0)));
    Ok(Figure::Curves(Curves {
        title: "Latency of a fall over its bound",
        x: "latency / bound",
        y: "share of drops in a step of 0.05",
        decades: false,
        curves: curves.collect(),
    }))
}
