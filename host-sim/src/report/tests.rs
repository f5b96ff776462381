//! Structure of the page.

use super::{Subject, fixture, render};
use crate::history::{Recorder, RotorState};
use crate::outcome::{Detection, Outcome};

/// Every element is closed by its own end tag, in order; `path` and the like must be, inside `svg`.
fn assert_closed(page: &str) {
    const VOID: [&str; 4] = ["meta", "br", "!DOCTYPE", "link"];
    let mut open: Vec<&str> = Vec::new();
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
        "http", "<script", "<link", "url(", "@import", "src=", "NaN", "inf\"", "inf ",
    ] {
        assert!(!page.contains(banned), "{banned} in the page");
    }
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
}

fn still(levitated: f64, duration: f64) -> Outcome {
    let end = RotorState {
        time: duration,
        ..RotorState::default()
    };
    let truth = Recorder::new(levitated).finish(end, 0.0);
    Outcome {
        model: truth.clone(),
        truth,
        trace: Vec::new(),
        detection: Detection {
            events: Vec::new(),
            samples: 0,
            faults: 0,
            state_hash: 0,
        },
    }
}

#[test]
fn a_drop_renders() {
    let subject = fixture::subject();
    let page = render(&subject, &fixture::outcome(&subject));
    assert_sound(&page);
    assert!(page.contains("76.72\u{a0}mm/s"));
    assert!(page.contains("1.300\u{a0}ms"), "latency of the free fall");
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/tmp");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("report.html"), page).unwrap();
}

#[test]
fn nothing_to_show_renders() {
    let subject = fixture::subject();
    for (levitated, duration) in [(0.2, 0.001), (0.0, 0.0), (0.2, 86_400.0)] {
        assert_sound(&render(&subject, &still(levitated, duration)));
    }
}

#[test]
fn without_gravity_renders() {
    let subject = Subject {
        gravity: 0.0,
        spin: 0.0,
        ..fixture::subject()
    };
    let falling = fixture::outcome(&fixture::subject());
    assert_sound(&render(&subject, &falling));
}

#[test]
fn unusable_points_are_left_out() {
    let subject = fixture::subject();
    let mut outcome = fixture::outcome(&subject);
    for point in outcome.trace.iter_mut().step_by(7) {
        point.state.position = [f64::NAN, f64::INFINITY];
    }
    assert_sound(&render(&subject, &outcome));
}

#[test]
fn titles_are_escaped() {
    let subject = Subject {
        title: "<b>5 & 6</b>".to_owned(),
        ..fixture::subject()
    };
    let page = render(&subject, &fixture::outcome(&subject));
    assert!(page.contains("&lt;b&gt;5 &amp; 6&lt;/b&gt;"));
    assert!(!page.contains("<b>"));
}
