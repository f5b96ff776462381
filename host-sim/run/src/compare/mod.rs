//! Two recordings through the same detector: what is the same, and what is not.

mod align;
pub mod table;

use std::path::Path;

use serde::Serialize;
use touchdown_core::event::EventKind;

pub use align::{Aligned, By};
pub use table::table;

use crate::matching::{nearest_pairs, within};
use crate::outcome::{DetectedEvent, Severity};
use crate::replay::{self, Excerpt, Replay};
use crate::target::Target;
use touchdown_base::failure::Failure;
use touchdown_files::recording::Reading;
use touchdown_scene::Scene;

/// Events of one kind that are farther apart are two, s; more where the tolerance is more.
const SAME: f64 = 5e-3;
/// Slower impacts are shown but not judged: noise hides some of them, m/s.
const SLOWEST: f64 = 0.02;

/// How far apart two recordings of one drop may be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerance {
    /// Of an onset, s.
    pub time_s: f64,
    /// Of the speed of an impact, part of the faster one.
    pub speed: f64,
}

/// An event that one or both have.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// What.
    pub event: EventKind,
    /// Onset in the first, s.
    pub a_s: Option<f64>,
    /// Onset in the second, on its own clock, s.
    pub b_s: Option<f64>,
    /// The second's less the first's once they are aligned, s.
    pub difference_s: Option<f64>,
    /// Of an impact in the first, m/s.
    pub a_speed_m_s: Option<f64>,
    /// Of an impact in the second, m/s.
    pub b_speed_m_s: Option<f64>,
    /// Their difference as part of the faster.
    pub speed_difference: Option<f64>,
    /// Whether it is within the tolerance; `None` where it is not judged.
    pub within: Option<bool>,
}

/// Two recordings side by side.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The files.
    pub files: [String; 2],
    /// What is held against each other.
    pub tolerance: Tolerance,
    /// How the second was laid over the first.
    #[serde(flatten)]
    pub aligned: Aligned,
    /// In the order of time.
    pub events: Vec<Pair>,
    /// The last regime that was told of each.
    pub regimes: [Option<EventKind>; 2],
    /// Of the last drop of each.
    pub severity: [Severity; 2],
    /// What is beyond the tolerance: events, and the regime.
    pub beyond: usize,
    /// Each about its drop.
    #[serde(skip)]
    pub excerpts: Option<[Excerpt; 2]>,
    /// Of either file.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Replays both recordings with `scene` and compares.
pub fn compare(
    files: [&Path; 2],
    readings: [&Reading; 2],
    scene: &Scene,
    tolerance: Tolerance,
) -> Result<Comparison, Failure> {
    let replayed = |index: usize| {
        let orders = replay::Orders::default();
        replay::recording(files[index], readings[index], scene, &Target::Host, &orders)
    };
    let replays = [replayed(0)?, replayed(1)?];
    let excerpt =
        |index: usize| replay::first_drop(files[index], readings[index], scene, &replays[index]);
    let excerpts = excerpt(0)?.zip(excerpt(1)?).map(|(a, b)| [a, b]);
    let aligned = align::align(&replays, excerpts.as_ref());
    let told = replays.each_ref().map(told);
    let events = pairs(&told, aligned.shift_s, tolerance);
    let regimes = told.each_ref().map(|events| {
        let mut regimes = events.iter().rev().map(|it| it.event);
        regimes.find(|it| is_regime(*it))
    });
    let beyond = events.iter().filter(|it| it.within == Some(false)).count();
    Ok(Comparison {
        files: files.map(|it| it.display().to_string()),
        tolerance,
        aligned,
        beyond: beyond + usize::from(regimes[0] != regimes[1]),
        events,
        regimes,
        severity: replays.each_ref().map(|it| it.detection.severity),
        excerpts,
        warnings: replays.into_iter().flat_map(|it| it.warnings).collect(),
    })
}

fn is_regime(event: EventKind) -> bool {
    use EventKind::{BackwardWhirl, ForwardWhirl, Pendulum, Rest};
    [Pendulum, ForwardWhirl, BackwardWhirl, Rest].contains(&event)
}

/// The events that are compared: not that it floats, nor what was taken back.
fn told(replay: &Replay) -> Vec<&DetectedEvent> {
    let events = replay.detection.events.iter();
    let stands = |it: &&DetectedEvent| it.event != EventKind::Levitated && it.withdrawn_s.is_none();
    events.filter(stands).collect()
}

/// Each event with the nearest of its kind, the nearest pairs first.
fn pairs(told: &[Vec<&DetectedEvent>; 2], shift: f64, tolerance: Tolerance) -> Vec<Pair> {
    let [a, b] = told;
    let reach = SAME.max(2.0 * tolerance.time_s);
    let mut in_time: Vec<usize> = (0..b.len()).collect();
    in_time.sort_by(|i, j| b[*i].onset_s.total_cmp(&b[*j].onset_s));
    let times: Vec<f64> = in_time.iter().map(|j| b[*j].onset_s - shift).collect();
    let mut near = Vec::new();
    for (i, one) in a.iter().enumerate() {
        for k in within(&times, one.onset_s, reach) {
            let (j, other) = (in_time[k], b[in_time[k]]);
            if other.event == one.event && other.fault == one.fault {
                near.push(((times[k] - one.onset_s).abs(), i, j));
            }
        }
    }
    let (of_a, has_one) = nearest_pairs(near, a.len(), b.len());
    let both = (0..a.len()).map(|i| (Some(a[i]), of_a[i].map(|j| b[j])));
    let alone = (0..b.len()).filter(|j| !has_one[*j]);
    let all = both.chain(alone.map(|j| (None, Some(b[j]))));
    let mut pairs: Vec<Pair> = all
        .filter_map(|(a, b)| pair(a, b, shift, tolerance))
        .collect();
    let time = |it: &Pair| it.a_s.or(it.b_s.map(|b| b - shift)).unwrap_or(0.0);
    pairs.sort_by(|one, other| time(one).total_cmp(&time(other)));
    pairs
}

fn pair(
    a: Option<&DetectedEvent>,
    b: Option<&DetectedEvent>,
    shift: f64,
    tolerance: Tolerance,
) -> Option<Pair> {
    let event = a.or(b)?.event;
    let difference = a.zip(b).map(|(a, b)| b.onset_s - shift - a.onset_s);
    let speeds = [a, b].map(|it| it?.normal_speed_m_s);
    let fastest = speeds.iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
    let speed = speeds[0].zip(speeds[1]).map(|(a, b)| (b - a) / fastest);
    let judged = event != EventKind::Impact || fastest >= SLOWEST;
    let in_time = difference.is_some_and(|it| it.abs() <= tolerance.time_s);
    let in_speed = speed.is_none_or(|it| it.abs() <= tolerance.speed);
    Some(Pair {
        event,
        a_s: a.map(|it| it.onset_s),
        b_s: b.map(|it| it.onset_s),
        difference_s: difference,
        a_speed_m_s: speeds[0],
        b_speed_m_s: speeds[1],
        speed_difference: speed,
        within: judged.then_some(in_time && in_speed),
    })
}
