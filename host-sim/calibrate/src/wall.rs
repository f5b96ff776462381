//! Which readings are of a rotor on the wall, where parts of the recording are not.
//!
//! The wall is the outermost curve that the readings show. A first curve comes from their convex hull, by consensus;
//! then fit and choice take turns. A rotor that leaves the wall goes inward for many samples: so means over windows tell
//! it, where single samples cannot.

use rand::SeedableRng as _;
use rand::seq::IndexedRandom as _;
use rand_chacha::ChaCha8Rng;
use touchdown_base::statistics::median;

use super::ellipse::{Ellipse, Fitted};

/// Samples that make a check, of all and of those on the wall.
const FEWEST: usize = 100;
/// Directions in which the outermost reading is looked for.
const DIRECTIONS: usize = 180;
/// Curves through five of them that are tried.
const TRIES: usize = 200;
/// Readings that a curve is tried on.
const TRIED_ON: usize = 1_000;
/// Most of the readings that may be outside the wall: spikes.
const OUTSIDE: f64 = 0.02;
/// Standard deviations beyond which a reading, or the mean of a window, is not of the wall.
const FAR: f64 = 4.5;
/// Times that the choice is made anew.
const ROUNDS: usize = 12;
/// Standard deviation of a normal distribution over its median distance from the middle.
const OF_MEDIAN: f64 = 1.4826;

/// The curve through the readings on the wall; why there is none.
pub fn find(readings: &[[f64; 2]], resolution: f64) -> Result<Fitted, String> {
    let enough = |count: usize, are: &str| {
        let few = || format!("only {count} samples{are}, {FEWEST} are the fewest");
        (count >= FEWEST).then_some(()).ok_or_else(few)
    };
    enough(readings.len(), "")?;
    let noise = noise(readings).max(resolution / 12_f64.sqrt());
    let mut ellipse = first(readings, noise).ok_or(
        "no ellipse bounds the readings: the rotor has not been led round the wall, or the \
         readings are cut off",
    )?;
    let (mut spread, mut chosen) = (2.0 * noise, Vec::new());
    let mut round = 0;
    loop {
        let windows = if round < 2 { &[][..] } else { &[256, 32] };
        let before = chosen;
        chosen = choose(&ellipse, readings, spread, windows);
        enough(chosen.len(), " are on the wall")?;
        let fitted = ellipse
            .fit(&chosen)
            .ok_or("the fit does not settle: too little of the wall, or too much noise")?;
        round += 1;
        if round == ROUNDS || round > 3 && chosen == before {
            return Ok(fitted);
        }
        spread = fitted.square.sqrt();
        ellipse = fitted.ellipse;
    }
}

/// Of a channel, m, from second differences: slow motion leaves none.
fn noise(readings: &[[f64; 2]]) -> f64 {
    let second = |[a, b, c]: &[[f64; 2]; 3]| [0, 1].map(|k| (a[k] - 2.0 * b[k] + c[k]).abs());
    let all: Vec<_> = readings.array_windows().flat_map(second).collect();
    OF_MEDIAN * median(&all) / 6_f64.sqrt()
}

/// The curve through outermost readings that most readings are on, and hardly any outside.
fn first(readings: &[[f64; 2]], noise: f64) -> Option<Ellipse> {
    // Medians have no spikes.
    let medians = |five: &[[f64; 2]; 5]| [0, 1].map(|k| median(&five.map(|it| it[k])));
    let readings: Vec<_> = readings.array_windows().map(medians).collect();
    let outermost = |direction: usize| {
        let angle = direction as f64 / DIRECTIONS as f64 * std::f64::consts::TAU;
        let (sin, cos) = angle.sin_cos();
        let out = |[u, v]: &[f64; 2]| cos * u + sin * v;
        readings.iter().max_by(|a, b| out(a).total_cmp(&out(b)))
    };
    let mut hull: Vec<_> = (0..DIRECTIONS).filter_map(outermost).collect();
    hull.dedup();
    let every = readings.len().div_ceil(TRIED_ON);
    let some: Vec<_> = readings.iter().step_by(every).collect();
    let score = |it: &Ellipse| {
        let distances = some.iter().map(|reading| it.foot(**reading).distance);
        let (outside, others): (Vec<_>, Vec<_>) = distances.partition(|it| *it > FAR * noise);
        let on = others.iter().filter(|it| **it >= -FAR * noise).count();
        (outside.len() as f64 <= OUTSIDE * some.len() as f64).then_some(on)
    };
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let five = |_| hull.choose_multiple_array(&mut rng);
    let tries = (0..TRIES).filter_map(five);
    let tries = tries.filter_map(|five| Ellipse::through(five.map(|it: &[f64; 2]| *it)));
    let scored = tries.filter_map(|it| Some((score(&it)?, it)));
    let best = scored.reduce(|best, it| if it.0 > best.0 { it } else { best });
    best.map(|(_, it)| it)
}

/// Readings within noise of the curve, in windows that are too. A window's mean may be off by what those outside the
/// curve are, as runout makes them.
fn choose(curve: &Ellipse, readings: &[[f64; 2]], spread: f64, windows: &[usize]) -> Vec<[f64; 2]> {
    let (mut of_wall, mut sum, mut sums) = (Vec::new(), 0.0, vec![0.0]);
    for reading in readings {
        let distance = curve.foot(*reading).distance;
        of_wall.push(distance.abs() <= FAR * spread);
        sum += distance.clamp(-3.0 * spread, 3.0 * spread);
        sums.push(sum);
    }
    for &most in windows {
        // Short recordings are led round faster.
        let half = (most / 2).min(readings.len() / (16 * most)).max(1);
        let around = |at: usize| at.saturating_sub(half)..(at + half + 1).min(readings.len());
        let mean = |at| {
            let window = around(at);
            (sums[window.end] - sums[window.start]) / window.len() as f64
        };
        let means: Vec<f64> = (0..readings.len()).map(mean).collect();
        let on_wall = means.iter().zip(&of_wall).filter(|(_, on)| **on);
        let outer: Vec<_> = on_wall.map(|it| *it.0).filter(|it| *it > 0.0).collect();
        let white = spread / (2.0 * half as f64 + 1.0).sqrt();
        let limit = -FAR * (OF_MEDIAN * median(&outer)).max(white);
        for (at, _) in means.iter().enumerate().filter(|(_, it)| **it < limit) {
            of_wall[around(at)].fill(false);
        }
    }
    let chosen = readings.iter().zip(of_wall).filter(|(_, on)| *on);
    chosen.map(|(it, _)| *it).collect()
}
