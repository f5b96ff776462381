//! Free fall after levitation: how late it is declared, against the bound; what is missed; what is
//! declared before the release.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::EventKind;

use super::figure::{Curve, Figure, histogram};
use super::levitated::{Levitated, ORBIT};
use super::row::Row;
use super::watch::Drop;
use super::{Findings, Plan, bound, campaign};
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
/// Time to learn noise and place from; the monitor has to be armed within 0.15 s.
const LEAD: f64 = 0.2;
/// Likewise where there is an orbit: ten turns of the slowest.
const ORBIT_LEAD: f64 = 1.0;
/// Farthest that the rotor floats from the middle of the gap, m.
const OFF_CENTRE: f64 = 60e-6;

/// Amplitude of the runout, m.
const RUNOUT: f64 = 5e-6;
/// Change of speed where it sweeps, a second, up or down.
const SWEEP: f64 = 0.2;
/// Of a rotor that is thrown or drifts, m/s.
const THROW: f64 = 10e-3;

#[derive(Clone, Copy, Debug)]
struct Orbit {
    frequency: f64,
    harmonic: u32,
    sweeps: bool,
}

#[derive(Clone, Debug)]
struct Case {
    name: String,
    noise: f64,
    rate: f64,
    planes: u8,
    orbit: Option<Orbit>,
    speed: bool,
    gravity: f64,
    thrown: f64,
    target: f64,
}

impl Case {
    fn white(noise: f64, rate: f64, planes: u8) -> Self {
        let name = format!(
            "white noise {} um, {} kHz, {}",
            noise * 1e6,
            rate / 1e3,
            if planes == 1 {
                "one plane"
            } else {
                "two planes"
            }
        );
        Self {
            name,
            noise,
            rate,
            planes,
            orbit: None,
            speed: false,
            gravity: 9.81,
            thrown: 0.0,
            target: WHITE,
        }
    }

    fn usual() -> Self {
        Self::white(1e-6, 20e3, 2)
    }

    fn orbit(orbit: Orbit, speed: bool) -> Self {
        Self {
            name: format!(
                "orbit 30 um {} Hz, runout 5 um x {}, {}, {}",
                orbit.frequency,
                orbit.harmonic,
                if orbit.sweeps { "sweeping" } else { "steady" },
                if speed {
                    "speed known"
                } else {
                    "speed unknown"
                }
            ),
            orbit: Some(orbit),
            speed,
            target: DISTURBED,
            ..Self::usual()
        }
    }

    fn thrown(name: &str, gravity: f64) -> Self {
        Self {
            name: name.to_owned(),
            gravity,
            thrown: THROW,
            target: DISTURBED,
            ..Self::usual()
        }
    }

    fn drop(&self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let mut scene = Scene::load("rig")?;
        scene.run.sample_rate = self.rate;
        scene.run.seed = random.random();
        scene.run.duration = WATCHED;
        scene.run.gravity = self.gravity;
        scene.sensors.noise = self.noise;
        scene.sensors.planes = self.planes;
        scene.sensors.speed = self.speed;
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
        // Mean over the directions of the throw and over the place of the release between samples.
        let (directions, places) = (16, 16);
        let mut sum = 0.0;
        for number in 0..directions * places {
            let angle = TAU * f64::from(number / places) / f64::from(directions);
            let first = (f64::from(number % places) + 0.5) / f64::from(places);
            let (sin, cos) = angle.sin_cos();
            sum += bound::cusum(variance, self.rate, first, |t| {
                let fallen = 0.5 * self.gravity * t * t;
                f64::hypot(self.thrown * cos * t, self.thrown * sin * t - fallen)
            });
        }
        Ok(sum / f64::from(directions * places))
    }
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for planes in [1, 2] {
        for rate in [10e3, 20e3, 50e3] {
            for noise in [0.3e-6, 1e-6, 3e-6] {
                cases.push(Case::white(noise, rate, planes));
            }
        }
    }
    cases.push(Case::thrown("thrown at 10 mm/s, any direction", 9.81));
    cases.push(Case::thrown("no gravity, drifts at 10 mm/s", 0.0));
    for frequency in [10.0, 50.0, 100.0, 200.0, 500.0] {
        for harmonic in [1, 2, 3] {
            for sweeps in [false, true] {
                for speed in [false, true] {
                    let orbit = Orbit {
                        frequency,
                        harmonic,
                        sweeps,
                    };
                    cases.push(Case::orbit(orbit, speed));
                }
            }
        }
    }
    cases
}

/// Drops to compare two targets with.
pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Vec<(String, Drop)>, Failure> {
    let all = cases();
    let few = all.iter().step_by(13);
    few.map(|case| Ok((case.name.clone(), case.drop(plan, random)?)))
        .collect()
}

/// What became of one drop.
#[derive(Clone, Copy, Debug)]
struct Fall {
    /// Declared minus release, s; infinite if missed.
    latency: f64,
    /// Likewise confirmed.
    confirmed: f64,
    /// Declared before the release.
    early: usize,
}

/// Watches one drop.
fn fall(drop: &Drop) -> Result<Fall, Failure> {
    let watched = drop.watch()?;
    let events = watched.detection.events.iter();
    let falls = events.filter(|it| it.event == EventKind::FreeFall);
    let (early, late): (Vec<_>, Vec<_>) = falls.partition(|it| it.declared_s < 0.0);
    let found = late.iter().find(|it| it.withdrawn_s.is_none());
    let confirmed = found.and_then(|it| it.confirmed_s);
    Ok(Fall {
        latency: found.map_or(f64::INFINITY, |it| it.declared_s),
        confirmed: confirmed.unwrap_or(f64::INFINITY),
        early: early.len(),
    })
}

/// Runs the group.
pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let falls = campaign::map(plan, "fall", &cases, |case, mut random| {
        fall(&case.drop(plan, &mut random)?)
    })?;
    let mut rows = Vec::new();
    for (case, falls) in cases.iter().zip(&falls) {
        rows.push(judged(case, falls)?);
    }
    let figures = vec![against_noise(&cases, &rows), spread(&cases, &falls, &rows)];
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
    let row = Row::quantile_at_most(&case.name, "ratio", &ratios, 0.5, case.target)
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
    for rate in [10e3, 20e3, 50e3] {
        let white = |case: &Case| {
            case.rate == rate && case.planes == 2 && case.orbit.is_none() && case.thrown == 0.0
        };
        let chosen = || cases.iter().zip(rows).filter(|it| white(it.0));
        let points = |name: &'static str| {
            let values = chosen().filter_map(|(case, row)| {
                let value = row.values.get(name)?.as_f64()?;
                Some([case.noise * 1e6, value * 1e3])
            });
            values.collect()
        };
        let khz = rate / 1e3;
        curves.push(Curve::new(format!("{khz} kHz"), points("latency_median_s")));
        curves.push(Curve::limit(format!("bound, {khz} kHz"), points("bound_s")));
    }
    Figure::Curves {
        title: "Latency of a fall against noise, two planes",
        x: "noise, um",
        y: "latency, median, ms",
        decades: true,
        curves,
    }
}

/// How latencies over their bounds are spread.
fn spread(cases: &[Case], falls: &[Vec<Fall>], rows: &[Row]) -> Figure {
    let of = |orbit: bool| {
        let mut ratios = Vec::new();
        for ((case, falls), row) in cases.iter().zip(falls).zip(rows) {
            let bound = row.values.get("bound_s").and_then(|it| it.as_f64());
            if case.orbit.is_some() == orbit && case.thrown == 0.0 {
                ratios.extend(
                    falls
                        .iter()
                        .map(|it| it.latency / bound.unwrap_or(f64::NAN)),
                );
            }
        }
        ratios
    };
    Figure::Curves {
        title: "Latency of a fall over its bound",
        x: "latency / bound",
        y: "share of drops in a step of 0.05",
        decades: false,
        curves: vec![
            Curve::new("white noise".to_owned(), histogram(&of(false), 0.05, 5.0)),
            Curve::new(
                "orbit and runout".to_owned(),
                histogram(&of(true), 0.05, 5.0),
            ),
        ],
    }
}
