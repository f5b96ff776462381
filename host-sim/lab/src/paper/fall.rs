//! The drop from the centre: speeds at the wall and jumps of theta'.

use super::equations::{jump_without_cap, kappa};
use super::rig::{self, WIDE_GAP, from_centre, rate, run, turning};
use super::row::Row;
use touchdown_base::failure::Failure;
use touchdown_base::history::{History, Impact};
use touchdown_scene::Scene;

/// Until the rotor is in permanent contact, s.
const LONG_ENOUGH: f64 = 0.1;
/// Tolerance of angular speeds, rad/s.
const CLOSE: f64 = 1e-9;

pub fn rows(base: &Scene) -> Result<Vec<Row>, Failure> {
    let scene = from_centre(base, LONG_ENOUGH);
    let (ours, right) = (run(&scene)?, touchdown_truth::simulate(&scene));
    let mut wide = scene.clone();
    wide.retainer.clearance = WIDE_GAP;
    let (first, second) = (Jump::of(&ours, 0, base), Jump::of(&ours, 1, base));
    let second_right = Jump::of(&right, 1, base);
    let reference = "right: reference";
    Ok(vec![
        Row::new("kappa", "1/m", kappa(base))
            .printed(600.0)
            .ours(first.size() / first.normal, 1e-9)
            .note("mu (1 + eps)/rho0; ours: first jump over speed into the wall"),
        Row::new("speed after the fall, 0.3 mm", "m/s", rig::fall_speed(&scene))
            .printed(0.1)
            .ours(first.normal, 1e-12)
            .note("sqrt(2 g rho0), printed as about 0.1"),
        Row::new("speed after the fall, 0.75 mm", "m/s", rig::fall_speed(&wide))
            .ours(Jump::of(&run(&wide)?, 0, &wide).normal, 1e-12)
            .note("sqrt(2 g rho0)"),
        Row::new("first jump of theta'", "rad/s", jump_without_cap(base))
            .printed(60.0)
            .ours(first.size(), CLOSE)
            .note("kappa sqrt(2 g rho0)"),
        Row::new("theta' before the second impact", "rad/s", second_right.before)
            .ours(second.before, CLOSE)
            .note(reference)
            .note("in print the jumps are added, as if it were still that after the first; the curved wall turns the velocity"),
        Row::new("second jump of theta'", "rad/s", second_right.size())
            .printed(48.0)
            .ours(second.size(), CLOSE)
            .note(reference),
        Row::new("theta' after the second impact", "rad/s", second_right.after)
            .ours(second.after, CLOSE)
            .note(reference),
        Row::new("largest |theta'| at an impact", "rad/s", largest(&right, base))
            .ours(largest(&ours, base), CLOSE)
            .note("right: reference; over the whole drop, just before or after"),
    ])
}

/// What an impact does to the motion along the wall.
struct Jump {
    /// theta' before, rad/s.
    before: f64,
    /// theta' after, rad/s.
    after: f64,
    /// Into the wall, before, m/s.
    normal: f64,
}

impl Jump {
    /// At impact `index` of a drop from rest in the centre. Not a number where there is none.
    fn of(history: &History, index: usize, scene: &Scene) -> Self {
        let Some(impact) = history.impacts.get(index) else {
            let none = f64::NAN;
            return Self {
                before: none,
                after: none,
                normal: none,
            };
        };
        let launch = index.checked_sub(1).map(|before| &history.impacts[before]);
        Self {
            before: turning(impact.state.position, arrival(launch, impact, scene)),
            after: rate(&impact.state),
            normal: impact.normal_speed,
        }
    }

    fn size(&self) -> f64 {
        self.after - self.before
    }
}

/// Velocity just before an impact: that of its launch, or rest, and what gravity has added.
fn arrival(launch: Option<&Impact>, impact: &Impact, scene: &Scene) -> [f64; 2] {
    let ([vx, vy], from) = launch.map_or(([0.0; 2], 0.0), |it| (it.state.velocity, it.state.time));
    [vx, vy - scene.run.gravity * (impact.state.time - from)]
}

fn largest(history: &History, scene: &Scene) -> f64 {
    (0..history.impacts.len())
        .map(|index| Jump::of(history, index, scene))
        .flat_map(|jump| [jump.before.abs(), jump.after.abs()])
        .fold(0.0, f64::max)
}
