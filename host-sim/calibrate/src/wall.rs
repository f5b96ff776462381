//! Which readings are of a rotor on the wall, where parts of the recording are not.
//!
//! The wall is the outermost curve that the readings show. A first curve comes from their convex hull, by consensus;
//! then fit and choice take turns. A rotor that leaves the wall goes inward for many samples: so means over windows tell
//! it, where single samples cannot.

use super::ellipse::{Ellipse, Fitted};

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

/// The readings on the wall (index of each) and the curve through them; why there is none.
pub fn find(readings: &[[f64; 2]], resolution: f64) -> Result<(Vec<usize>, Fitted), String> {
    if readings.len() < 100 {
        let count = readings.len();
        return Err(format!("only {count} samples, 100 are the fewest"));
    }
    let smooth = medians(readings);
    let noise = noise(readings).max(resolution / 12_f64.sqrt());
    let mut ellipse = first(&smooth, noise).ok_or(
        "no ellipse bounds the readings: the rotor has not been led round the wall, or the \
         readings are cut off",
    )?;
    let mut spread = 2.0 * noise;
    let mut chosen = Vec::new();
    for round in 0..ROUNDS {
        let windows = if round < 2 { &[][..] } else { &[256, 32] };
        let of_wall = choose(&ellipse, readings, spread, windows);
        let points: Vec<_> = of_wall.iter().map(|&it| readings[it]).collect();
        if points.len() < 100 {
            return Err(format!(
                "only {} samples are on the wall, 100 are the fewest",
                points.len()
            ));
        }
        let fitted = ellipse.fit(&points);
        let fitted =
            fitted.ok_or("the fit does not settle: too little of the wall, or too much noise")?;
        let squares: f64 = fitted.residuals.iter().map(|it| it * it).sum();
        spread = (squares / points.len() as f64).sqrt();
        ellipse = fitted.ellipse;
        let is_same = round > 2 && of_wall == chosen;
        chosen = of_wall;
        if is_same || round + 1 == ROUNDS {
            return Ok((chosen, fitted));
        }
    }
    Err("the choice of samples does not settle".to_owned())
}

/// Median of five neighbours, by channel: no spikes.
fn medians(readings: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let of = |five: &[[f64; 2]], k: usize| median(five.iter().map(|it| it[k]).collect());
    let windows = readings.windows(5);
    windows.map(|it| [of(it, 0), of(it, 1)]).collect()
}

/// Of a channel, m, from second differences: slow motion leaves none.
fn noise(readings: &[[f64; 2]]) -> f64 {
    let second = |it: &[[f64; 2]], k: usize| (it[0][k] - 2.0 * it[1][k] + it[2][k]).abs();
    let both = readings
        .windows(3)
        .flat_map(|it| [second(it, 0), second(it, 1)]);
    1.4826 * median(both.collect()) / 6_f64.sqrt()
}

fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The curve through outermost readings that most readings are on, and hardly any outside.
fn first(readings: &[[f64; 2]], noise: f64) -> Option<Ellipse> {
    let mut hull: Vec<usize> = (0..DIRECTIONS)
        .filter_map(|it| {
            let angle = it as f64 / DIRECTIONS as f64 * std::f64::consts::TAU;
            let (sin, cos) = angle.sin_cos();
            let out = |it: &[f64; 2]| cos * it[0] + sin * it[1];
            (0..readings.len()).max_by(|&i, &j| out(&readings[i]).total_cmp(&out(&readings[j])))
        })
        .collect();
    hull.dedup();
    let every = readings.len().div_ceil(TRIED_ON).max(1);
    let some: Vec<_> = readings.iter().step_by(every).collect();
    let score = |it: &Ellipse| {
        let distances = some.iter().map(|reading| it.foot(**reading).distance);
        let (mut on, mut outside) = (0, 0);
        for distance in distances {
            on += usize::from(distance.abs() <= FAR * noise);
            outside += usize::from(distance > FAR * noise);
        }
        (outside as f64 <= OUTSIDE * some.len() as f64).then_some(on)
    };
    // Any sequence that visits all choices alike.
    let mut state = 1_u64;
    let mut pick = |most: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % most
    };
    let mut best = None;
    for _ in 0..TRIES {
        let five: [[f64; 2]; 5] = std::array::from_fn(|_| readings[hull[pick(hull.len())]]);
        let curve = Ellipse::through(&five).and_then(Ellipse::sound);
        let scored = curve.and_then(|it| Some((score(&it)?, it)));
        if let Some((on, it)) = scored
            && best.is_none_or(|(most, _)| on > most)
        {
            best = Some((on, it));
        }
    }
    best.map(|(_, it)| it)
}

/// Readings within noise of the curve, in windows that are too. A window's mean may be off by what those outside the
/// curve are, as runout makes them.
fn choose(ellipse: &Ellipse, readings: &[[f64; 2]], spread: f64, windows: &[usize]) -> Vec<usize> {
    let distances: Vec<f64> = readings
        .iter()
        .map(|it| ellipse.foot(*it).distance)
        .collect();
    let mut is_wall: Vec<bool> = distances
        .iter()
        .map(|it| it.abs() <= FAR * spread)
        .collect();
    let mut sums = vec![0.0];
    for distance in &distances {
        let held = distance.clamp(-3.0 * spread, 3.0 * spread);
        sums.push(sums[sums.len() - 1] + held);
    }
    for &most in windows {
        // Short recordings are led round faster.
        let half = (most / 2).min(readings.len() / (16 * most)).max(1);
        let mean = |at: usize| {
            let (from, to) = (at.saturating_sub(half), (at + half + 1).min(readings.len()));
            (sums[to] - sums[from]) / (to - from) as f64
        };
        let means: Vec<f64> = (0..readings.len()).map(mean).collect();
        let outer = means
            .iter()
            .zip(&is_wall)
            .filter(|(it, on)| **on && **it > 0.0);
        let outer = 1.4826 * median(outer.map(|(it, _)| *it).collect());
        let white = spread / (2.0 * half as f64 + 1.0).sqrt();
        let limit = -FAR * outer.max(white);
        for (at, _) in means.iter().enumerate().filter(|(_, it)| **it < limit) {
            let (from, to) = (at.saturating_sub(half), (at + half + 1).min(readings.len()));
            is_wall[from..to].fill(false);
        }
    }
    (0..readings.len()).filter(|&it| is_wall[it]).collect()
}
