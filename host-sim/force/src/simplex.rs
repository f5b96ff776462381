//! The least of a function of four numbers.

/// Steps of the search.
const STEPS: usize = 250;

/// Where `cost` is least, about `start`: by the simplex of Nelder and Mead.
pub fn least(start: [f64; 4], spread: [f64; 4], cost: impl Fn([f64; 4]) -> f64) -> [f64; 4] {
    let mut corners = vec![(cost(start), start)];
    for axis in 0..4 {
        let mut at = start;
        at[axis] += spread[axis];
        corners.push((cost(at), at));
    }
    for _ in 0..STEPS {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let worst = corners[4];
        let mean = |i: usize| corners[..4].iter().map(|it| it.1[i]).sum::<f64>() / 4.0;
        let mean: [f64; 4] = std::array::from_fn(mean);
        let move_by = |factor: f64| {
            let at = std::array::from_fn(|i| mean[i] + factor * (worst.1[i] - mean[i]));
            (cost(at), at)
        };
        let mirrored = move_by(-1.0);
        corners[4] = if mirrored.0 < corners[0].0 {
            let farther = Some(move_by(-2.0));
            farther.filter(|it| it.0 < mirrored.0).unwrap_or(mirrored)
        } else if mirrored.0 < corners[3].0 {
            mirrored
        } else {
            let nearer = move_by(if mirrored.0 < worst.0 { -0.5 } else { 0.5 });
            if nearer.0 < worst.0.min(mirrored.0) {
                nearer
            } else {
                let best = corners[0].1;
                for corner in &mut corners[1..] {
                    let at = std::array::from_fn(|i| 0.5 * (best[i] + corner.1[i]));
                    *corner = (cost(at), at);
                }
                continue;
            }
        };
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners[0].1
}
