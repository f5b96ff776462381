//! The conclusions of docs/use/design-guide.md, from its own plans with fewer drops.

use std::fs;
use std::path::Path;

use serde_json::Value;
use touchdown_tests::binary::touchdown;

/// Points of a plan, run with so many drops and some of its values left out.
struct Swept(Vec<Value>);

fn swept(plan: &str, drops: u32, changes: &[(&str, &str)]) -> Swept {
    let plans = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/use/design");
    let text = fs::read_to_string(plans.join(plan)).expect("a plan of the guide");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut change = |from: &str, to: String| {
        let line = lines.iter_mut().find(|line| line.starts_with(from));
        *line.expect("a line to change") = to;
    };
    change("drops = ", format!("drops = {drops}"));
    for (from, to) in changes {
        change(from, (*to).to_owned());
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("plan.toml"), lines.join("\n")).expect("a plan");
    touchdown(folder.path())
        .args(["sweep", "plan.toml", "--out", "out", "--json", "sweep.json"])
        .assert()
        .success();
    let json = fs::read_to_string(folder.path().join("sweep.json")).expect("points");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    Swept(json["points"].as_array().expect("points").clone())
}

impl Swept {
    /// Whirls and drops over all points at which `key` is within these ends.
    fn count(&self, keys: &[(&str, f64, f64)]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for point in &self.0 {
            let within = |(key, low, high): &(&str, f64, f64)| {
                let value = point["values"][key].as_f64().expect("a number");
                (*low..=*high).contains(&value)
            };
            if keys.iter().all(within) {
                let drops = point["drops"].as_f64().expect("a number");
                let share = point["whirl_probability"].as_f64().expect("a number");
                sum = [sum[0] + share * drops, sum[1] + drops];
            }
        }
        assert!(sum[1] > 0.0, "no point at {keys:?}");
        println!("{keys:?}: {} of {}", sum[0].round(), sum[1]);
        sum
    }
}

fn share([whirls, drops]: [f64; 2]) -> f64 {
    whirls / drops
}

/// Standard errors between two shares.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    let all = share([a[0] + b[0], a[1] + b[1]]);
    (share(a) - share(b)) / (all * (1.0 - all) * (1.0 / a[1] + 1.0 / b[1])).sqrt()
}

const FRICTION: &str = "retainer.friction";
const RESTITUTION: &str = "retainer.restitution";

#[test]
fn friction_decides_and_restitution_near_1_makes_it_worse() {
    let swept = swept("friction.toml", 100, &[]);
    let at = |friction: f64, low: f64, high: f64| {
        swept.count(&[(FRICTION, friction, friction), (RESTITUTION, low, high)])
    };
    assert!(share(at(0.05, 0.0, 0.8)) < 0.02);
    assert!(share(at(0.3, 0.0, 0.8)) > 5.0 * share(at(0.1, 0.0, 0.8)));
    assert!(apart(at(0.3, 0.8, 0.95), at(0.3, 0.2, 0.7)) > 4.0);
}

#[test]
fn a_larger_gap_does_not_help() {
    let friction = ("values = [0.1, 0.2, 0.3]", "values = [0.3]");
    let swept = swept("gap.toml", 500, &[friction]);
    let gap = |low, high| swept.count(&[("retainer.clearance_mm", low, high)]);
    // The guide has 1000 drops a point; here a difference of 10 % would show.
    assert!(apart(gap(0.2, 0.3), gap(0.5, 0.8)).abs() < 3.0);
}

#[test]
fn whirl_does_not_ask_for_the_speed() {
    let friction = ("values = [0.1, 0.2, 0.3]", "values = [0.3]");
    let swept = swept("speed.toml", 300, &[friction]);
    let speed = |low, high| swept.count(&[("rotor.speed_rpm", low, high)]);
    assert!(apart(speed(-1000.0, -300.0), speed(-30_000.0, -3000.0)).abs() < 3.0);
    assert!(apart(speed(-30_000.0, -300.0), speed(-100.0, -100.0)) > 4.0);
}

#[test]
fn a_support_that_gives_and_damps_helps() {
    let friction = ("values = [0.1, 0.2, 0.3]", "values = [0.3]");
    let swept = swept("support.toml", 60, &[friction]);
    let support = |damping: [f64; 2], stiffness: f64| {
        swept.count(&[
            ("support.damping_n_s_m", damping[0], damping[1]),
            ("support.stiffness_n_m", stiffness, stiffness),
        ])
    };
    let good = support([1600.0, 6400.0], 1e6);
    let poor = support([160.0, 320.0], 1e7);
    assert!(share(good) < 0.2, "{good:?}");
    assert!(apart(poor, good) > 3.0);
}
