//! Impacts of drops at 1 um noise on two planes: how many are found, how well they are dated and
//! measured, how late they are declared against the bound for their velocity jump, and what is invented.

use std::f64::consts::TAU;

use itertools::iproduct;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::EventKind;

use super::figure::{Curve, Curves, Figure, histogram};
use super::levitated::{LEAD, Levitated, ORBIT};
use super::watch::Watched;
use super::{Drop, Findings, Named, Plan, Row, bound, campaign};
use touchdown_base::evenly::in_disc;
use touchdown_base::failure::Failure;
use touchdown_base::history::{History, Impact};
use touchdown_base::statistics::{median, quantile, share};
use touchdown_run::matching::match_events;
use touchdown_scene::Scene;

/// Velocity jump `(1 + e) v_n` from which an impact has to be found, m/s.
pub const JUMP: f64 = 18e-3;
/// Part of them.
const FOUND: f64 = 0.999;
/// Samples by which half of them, and 99.9 %, may be dated wrong.
const DATED: [f64; 2] = [1.0, 4.0];
/// Part by which 99 % of the speeds may be wrong.
const MEASURED: f64 = 0.1;
/// Of the latency's median to the bound.
const LATE: f64 = 1.3;

/// The bounce series of restitution 0.8 is over after 70 ms.
pub const WATCHED: f64 = 0.12;
/// Levitation where it orbits: 15 turns of the slowest.
pub const ORBIT_LEAD: f64 = 0.5;
/// Slowest and fastest orbit, Hz.
pub const TURNS: [f64; 2] = [30.0, 500.0];
const FRICTIONS: [f64; 3] = [0.05, 0.1, 0.2];
const SPINS: [f64; 2] = [1.0, -1.0];

#[derive(Clone, Copy, Debug)]
struct Case {
    rate: f64,
    restitution: f64,
    friction: f64,
    /// Sign.
    spin: f64,
    /// Whether it orbits before.
    orbits: bool,
}

impl Case {
    /// Of the cases that are judged together.
    fn name(self) -> String {
        let before = if self.orbits { ", out of an orbit" } else { "" };
        let khz = self.rate / 1e3;
        format!("{khz} kHz, restitution {}{before}", self.restitution)
    }

    fn drop(self, plan: &Plan, random: &mut ChaCha8Rng) -> Result<Drop, Failure> {
        let mut scene = Scene::load("rig")?;
        scene.run.sample_rate = self.rate;
        scene.run.duration = WATCHED;
        scene.retainer.restitution = self.restitution;
        scene.retainer.friction = self.friction;
        if self.orbits {
            return Ok(thrown(plan, scene, self.spin, random));
        }
        let spin = self.spin * scene.rotor.spin.abs();
        Ok(dropped(plan, scene, spin, random))
    }
}

/// Drops the rotor of `scene` from any place in the inner half of the gap.
pub fn dropped(plan: &Plan, mut scene: Scene, spin: f64, random: &mut ChaCha8Rng) -> Drop {
    scene.run.seed = random.random();
    let floats = Levitated {
        place: in_disc(random, 0.5 * scene.retainer.clearance),
        spin,
        ..Levitated::default()
    };
    let first = random.random_range(0.0..1.0);
    Drop::released(plan, scene, floats, [0.0; 2], LEAD, first)
}

/// Likewise out of an orbit of any speed, which throws it, with a spin of that speed and this sign.
pub fn thrown(plan: &Plan, mut scene: Scene, sign: f64, random: &mut ChaCha8Rng) -> Drop {
    scene.run.seed = random.random();
    let [slow, fast] = TURNS;
    let floats = Levitated {
        place: in_disc(random, 0.5 * scene.retainer.clearance),
        radius: ORBIT,
        angle: random.random_range(0.0..TAU),
        spin: sign * TAU * slow * (fast / slow).powf(random.random()),
        ..Levitated::default()
    };
    let first = random.random_range(0.0..1.0);
    Drop::released(plan, scene, floats, [0.0; 2], ORBIT_LEAD, first)
}

/// Cases whose drops are judged together.
const JUDGED: usize = FRICTIONS.len() * SPINS.len();

fn cases() -> Vec<Case> {
    let all = iproduct!(
        [false, true],
        [20e3, 50e3],
        [0.3, 0.5, 0.8],
        FRICTIONS,
        SPINS
    );
    let case = |(orbits, rate, restitution, friction, spin)| Case {
        rate,
        restitution,
        friction,
        spin,
        orbits,
    };
    all.map(case).collect()
}

pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Named, Failure> {
    let few = cases().into_iter().step_by(13);
    few.map(|case| Ok((case.name(), case.drop(plan, random)?)))
        .collect()
}

/// What was seen of a drop's impacts that have to be found.
#[derive(Clone, Debug, Default)]
pub struct Impacts {
    /// All of them.
    impacts: usize,
    /// Others with such a jump, which cannot be told from lying on the wall, and how many of these were found.
    hidden: [usize; 2],
    /// Distance in onset of those found, samples.
    dated: Vec<f64>,
    /// Relative, of their speeds.
    measured: Vec<f64>,
    /// Of the latency to the bound.
    late: Vec<f64>,
    /// Events after the release that the truth contradicts.
    invented: usize,
}

impl Impacts {
    /// Of a drop.
    pub fn of(drop: &Drop, watched: &Watched) -> Self {
        let rate = drop.scene.run.sample_rate;
        let (truth, events) = (&watched.truth, &watched.detection.events);
        let matches = match_events(truth, &watched.detection);
        let false_events = matches.false_events.iter();
        let variance = bound::variance(&drop.scene.sensors);
        let mut seen = Self {
            invented: false_events
                .filter(|it| events[**it].declared_s >= 0.0)
                .count(),
            ..Self::default()
        };
        for (impact, found) in truth.impacts.iter().zip(matches.of_kind(EventKind::Impact)) {
            let jump = drop.jump(impact);
            if jump < JUMP {
                continue;
            }
            if !bound::is_told(variance, rate, &flights(truth, impact, jump)) {
                seen.hidden[0] += 1;
                seen.hidden[1] += usize::from(found.detected.is_some());
                continue;
            }
            seen.impacts += 1;
            let (Some(index), Some(latency)) = (found.detected, found.latency_s) else {
                continue;
            };
            let onset = impact.state.time;
            seen.dated
                .push((events[index].onset_s - onset).abs() * rate);
            let speed = events[index].normal_speed_m_s.unwrap_or(f64::NAN);
            seen.measured
                .push((speed / impact.normal_speed - 1.0).abs());
            let next = watched.instants.iter().find(|it| it.time >= onset);
            let first = next.map_or(0.0, |it| (it.time - onset) * rate);
            let bound = bound::cusum(variance, rate, first, |t| jump * t);
            seen.late.push(latency / bound);
        }
        seen
    }

    /// The rows of a case, of all its drops.
    pub fn rows(name: &str, seen: &[Self]) -> [Row; 6] {
        let sum = |of: fn(&Self) -> usize| seen.iter().map(of).sum::<usize>();
        let [impacts, invented] = [sum(|it| it.impacts), sum(|it| it.invented)];
        let [hidden, others] = [sum(|it| it.hidden[0]), sum(|it| it.hidden[1])];
        let [dated, measured] = [all(seen, |it| &it.dated), all(seen, |it| &it.measured)];
        let late = all(seen, |it| &it.late);
        let (found, drops) = (dated.len(), seen.len());
        let mut note = format!("{found} of {impacts} in {drops} drops");
        if hidden > 0 {
            note += &format!("; {others} of {hidden} that noise hides");
        }
        let quantiles = |quantity, values: &[f64], p, target| {
            Row::quantile_at_most(name, quantity, values, p, target)
        };
        [
            Row::at_least(name, "found_share", share(found, impacts), FOUND)
                .of(impacts)
                .with("drops", drops)
                .with("impacts", impacts)
                .with("found", found)
                .with("hidden", hidden)
                .with("hidden_found", others)
                .noted(note),
            quantiles("onset_error_median_samples", &dated, 0.5, DATED[0]),
            quantiles("onset_error_p999_samples", &dated, 0.999, DATED[1]),
            quantiles("speed_error_p99", &measured, 0.99, MEASURED)
                .with("speed_error_median", median(&measured)),
            quantiles("ratio", &late, 0.5, LATE).with("ratio_p99", quantile(&late, 0.99)),
            Row::at_most(name, "invented", invented as f64, 0.0).with("drops", drops),
        ]
    }
}

/// The flights before and after an impact that takes off the speed `jump`: with which speed they meet and leave the
/// wall, m/s, and how long they are, s.
fn flights(truth: &History, impact: &Impact, jump: f64) -> [[f64; 2]; 2] {
    let time = impact.state.time;
    let others = truth.impacts.iter().map(|it| it.state.time);
    let contacts = truth.contact_starts.iter().chain(&truth.lift_offs);
    let (mut last, mut next) = (0.0, truth.end.time);
    for touch in others.chain(contacts.copied()) {
        if touch < time {
            last = f64::max(last, touch);
        } else if touch > time {
            next = f64::min(next, touch);
        }
    }
    let leaves = jump - impact.normal_speed;
    [[impact.normal_speed, time - last], [leaves, next - time]]
}

pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let cases = cases();
    let drops = campaign::map(plan, "impact", &cases, |case, mut random| {
        let drop = case.drop(plan, &mut random)?;
        Ok(Impacts::of(&drop, &drop.watch()?))
    })?;
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for (cases, drops) in cases.chunks(JUDGED).zip(drops.chunks(JUDGED)) {
        let (name, seen) = (cases[0].name(), drops.concat());
        rows.extend(Impacts::rows(&name, &seen));
        curves.push(Curve::new(
            name,
            histogram(&all(&seen, |it| &it.late), 0.1, 5.0),
        ));
    }
    let figures = vec![Figure::Curves(Curves {
        title: "Latency of an impact over the bound for its jump",
        x: "latency / bound",
        y: "share of impacts in a step of 0.1",
        decades: false,
        curves,
    })];
    Ok(Findings { rows, figures })
}

/// Of all drops.
fn all(seen: &[Impacts], of: fn(&Impacts) -> &Vec<f64>) -> Vec<f64> {
    seen.iter().flat_map(of).copied().collect()
}
