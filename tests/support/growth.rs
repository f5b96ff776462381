//! How far two drops are apart, and how fast a small difference of their starts grows.

use touchdown_base::history::{History, Impact};
use touchdown_base::machine::Start;
use touchdown_scene::Scene;

/// Change of the start that shows how errors grow, parts of the clearance and of V.
const NUDGE: f64 = 1e-8;
/// Growth beyond which nothing is asked.
const CHAOS: f64 = 1e6;

/// V, m/s.
pub fn unit_speed(scene: &Scene) -> f64 {
    (scene.run.gravity * scene.retainer.clearance).sqrt()
}

/// Greatest difference of time (in T), position (in clearances), velocity and speed into the wall (in V).
pub fn apart(a: &Impact, b: &Impact, scene: &Scene) -> f64 {
    let length = scene.retainer.clearance;
    let speed = unit_speed(scene);
    let gap = |a: [f64; 2], b: [f64; 2]| f64::hypot(a[0] - b[0], a[1] - b[1]);
    let (p, q) = (&a.state, &b.state);
    ((p.time - q.time).abs() * speed / length)
        .max(gap(p.position, q.position) / length)
        .max(gap(p.velocity, q.velocity) / speed)
        .max((a.normal_speed - b.normal_speed).abs() / speed)
}

/// The reference's growth of a start error up to each of the first `most` impacts, as far as the nudged
/// drops have the same impacts and the growth is tame.
pub fn growth(scene: &Scene, truth: &History, most: usize) -> Vec<f64> {
    let mut growth = vec![1.0; truth.impacts.len().min(most)];
    for start in nudged(scene) {
        let other = touchdown_truth::simulate(&Scene {
            start,
            ..scene.clone()
        });
        growth.truncate(other.impacts.len());
        for (k, growth) in growth.iter_mut().enumerate() {
            let grown = apart(&other.impacts[k], &truth.impacts[k], scene) / NUDGE;
            *growth = f64::max(*growth, grown);
        }
    }
    let tame = growth.iter().take_while(|growth| **growth < CHAOS).count();
    growth.truncate(tame);
    growth
}

/// The start, with each of its numbers changed a little.
fn nudged(scene: &Scene) -> Vec<Start> {
    let (far, fast) = (NUDGE * scene.retainer.clearance, NUDGE * unit_speed(scene));
    match scene.start {
        Start::Free { position, velocity } => [[far, 0.0], [0.0, far]]
            .map(|[x, y]| Start::Free {
                position: [position[0] + x, position[1] + y],
                velocity,
            })
            .into_iter()
            .chain([[fast, 0.0], [0.0, fast]].map(|[u, v]| Start::Free {
                position,
                velocity: [velocity[0] + u, velocity[1] + v],
            }))
            .collect(),
        Start::Wall { angle, tangential } => vec![
            Start::Wall {
                angle: angle + NUDGE,
                tangential,
            },
            Start::Wall {
                angle,
                tangential: tangential + fast,
            },
        ],
    }
}
