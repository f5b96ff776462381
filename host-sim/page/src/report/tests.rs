//! Structure of the page.

use super::{fixture, render};
use std::path::Path;
use touchdown_base::history::{Recorder, RotorState};
use touchdown_base::machine::Start;
use touchdown_chart::text::si;
use touchdown_run::model::ModelRun;
use touchdown_run::outcome::{Detection, Outcome};

/// Every element is closed by its own end tag, in order; `path` and the like must be, inside `svg`.
fn assert_closed(page: &str) {
    const VOID: [&str; 4] = ["meta", "br", "!DOCTYPE", "link"];
    let mut open: Vec<&str> = Vec::new();
    let page = page.replace(touchdown_chart::shell::SCRIPT, "");
    for part in page.split('<').skip(1) {
        let tag = part.split('>').next().unwrap();
        let name = tag.split([' ', '\n']).next().unwrap();
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert_eq!(open, Vec::<&str>::new());
}

fn assert_sound(page: &str) {
    assert_closed(page);
    for banned in [
        "http", "<link", "url(", "@import", "src=", "NaN", "inf\"", "inf ", "fetch(",
    ] {
        assert!(!page.contains(banned), "{banned} in the page");
    }
    assert_eq!(page.matches("<script").count(), 1);
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
}

fn still(levitated: f64, duration: f64) -> Outcome {
    let end = RotorState {
        time: duration,
        ..RotorState::default()
    };
    let truth = Recorder::new(levitated).finish(end, 0.0);
    Outcome {
        accuracy: None,
        by_reference: true,
        given_up: None,
        model: ModelRun::of_rotor(truth.clone()),
        truth: ModelRun::of_rotor(truth).histories,
        trace: Vec::new(),
        spectrogram: Default::default(),
        detection: Detection::default(),
        conduct: fixture::conduct(),
    }
}

/// Leaves the page where it can be looked at.
fn keep(name: &str, page: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/tmp");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(format!("report-{name}.html")), page).unwrap();
}

#[test]
fn the_drop_of_the_paper() {
    let scene = fixture::scene();
    let page = render(&scene, &fixture::outcome(&scene, &fixture::start()));
    keep("paper", &page);
    assert_sound(&page);
    assert!(page.contains("No whirl at the end: the rotor swings"));
    assert!(page.contains("1.300\u{a0}ms"), "latency of the free fall");
}

#[test]
fn slow_spin_ends_in_rolling() {
    let mut scene = fixture::scene();
    scene.retainer.friction = 0.15;
    scene.rotor.spin = -31.415_926_535_897_93;
    scene.run.duration = 0.8;
    let page = render(&scene, &fixture::outcome(&scene, &fixture::start()));
    keep("rolling", &page);
    assert_sound(&page);
    assert!(page.contains("Rolling, first, ms"));
}

#[test]
fn lift_offs_from_the_wall() {
    let mut scene = fixture::scene();
    scene.rotor.spin = 3141.592653589793;
    scene.run.duration = 0.1437;
    let start = Start::Wall {
        angle: 0.2,
        tangential: 0.09,
    };
    let page = render(&scene, &fixture::outcome(&scene, &start));
    keep("lift-off", &page);
    assert_sound(&page);
    assert!(page.contains("starts on the retainer"));
}

#[test]
fn backward_whirl_grows_without_bound() {
    let start = Start::Wall {
        angle: 0.0,
        tangential: 0.10047681387,
    };
    for (name, duration) in [("whirl", 0.04498), ("fast-whirl", 0.2)] {
        let mut scene = fixture::scene();
        scene.run.duration = duration;
        let page = render(&scene, &fixture::outcome(&scene, &start));
        keep(name, &page);
        assert_sound(&page);
        assert!(page.contains("driven into backward whirl"));
    }
}

#[test]
fn minutes_of_bouncing_stay_small() {
    let mut scene = fixture::scene();
    (scene.retainer.friction, scene.retainer.restitution) = (0.0, 1.0);
    scene.run.duration = 600.0;
    let page = render(&scene, &fixture::outcome(&scene, &fixture::start()));
    keep("bouncing", &page);
    assert_sound(&page);
    assert!(page.contains("in the JSON output only"));
}

#[test]
fn nothing_to_show_renders() {
    let scene = fixture::scene();
    for (levitated, duration) in [(0.2, 0.001), (0.0, 0.0), (0.2, 86_400.0)] {
        assert_sound(&render(&scene, &still(levitated, duration)));
    }
}

#[test]
fn without_gravity_renders() {
    let falling = fixture::outcome(&fixture::scene(), &fixture::start());
    let mut scene = fixture::scene();
    (scene.run.gravity, scene.rotor.spin) = (0.0, 0.0);
    assert_sound(&render(&scene, &falling));
}

#[test]
fn unusable_points_are_left_out() {
    let scene = fixture::scene();
    let mut outcome = fixture::outcome(&scene, &fixture::start());
    for point in outcome.trace.iter_mut().step_by(7) {
        point.state.position = [f64::NAN, f64::INFINITY];
    }
    assert_sound(&render(&scene, &outcome));
}

#[test]
fn titles_are_escaped() {
    let mut scene = fixture::scene();
    scene.title = Some("<b>5 & 6</b>".to_owned());
    let page = render(&scene, &fixture::outcome(&scene, &fixture::start()));
    assert!(page.contains("&lt;b&gt;5 &amp; 6&lt;/b&gt;"));
    assert!(!page.contains("<b>"));
}

#[test]
fn force_is_drawn_where_the_materials_are_known() {
    let rigid = fixture::scene();
    let outcome = fixture::outcome(&rigid, &fixture::start());
    let page = render(&rigid, &outcome);
    assert!(page.contains("has no table [materials]"));
    assert!(!page.contains("Force of the first impact"));

    // Point contact, steel on steel.
    let mut steel = fixture::scene();
    steel.materials.given = true;
    let page = render(&steel, &outcome);
    assert_sound(&page);
    assert!(page.contains("Force of the first impact"));
    let first = &outcome.truth.whole.impacts[0];
    let impulse = si(first.normal_impulse, "N s");
    assert!(page.contains(&impulse), "{impulse}");
}
