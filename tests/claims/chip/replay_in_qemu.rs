//! The built-in scenes on the emulated target: the same events, outputs, drop log, answers of the link and
//! state as on the desktop.

use std::io::Sink;

use serde_json::Value;
use tempfile::TempDir;
use touchdown_core::event::EventKind;
use touchdown_core::sample::CHANNELS;
use touchdown_core::sensing::{Calibration, PLANES, PlaneCalibration};
use touchdown_protocol::controller::Fault;
use touchdown_protocol::log::reader::Verdict;
use touchdown_protocol::wire::Switching;
use touchdown_files::drop_log::Dump;
use touchdown_run::drop;
use touchdown_run::emulator::{Emulator, built};
use touchdown_run::outcome::{Detection, Outcome};
use touchdown_run::target::Target;
use touchdown_scene::{BUILT_IN, Scene};
use touchdown_tests::binary::touchdown;

fn outcome(name: &str, target: &Target) -> Outcome {
    let scene = Scene::load(name).expect("built-in scene");
    let (outcome, _) = drop::by_reference::<Sink>(&scene, target, None)
        .unwrap_or_else(|failure| panic!("{name}: {failure:?}"));
    outcome
}

fn qemu() -> Target {
    Target::Qemu(Emulator::find(None).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn every_built_in_scene_gives_the_same_bits() {
    assert!(BUILT_IN.len() >= 5);
    for scene in BUILT_IN {
        let desktop = outcome(scene.name, &Target::Host);
        let target = outcome(scene.name, &qemu());
        let (detection, conduct) = (&target.detection, &target.conduct);
        println!(
            "{}: {:08x}, outputs {:?}",
            scene.name, detection.summary.state_hash, conduct.outputs
        );
        assert_eq!(*detection, desktop.detection, "{}", scene.name);
        assert!(!detection.events.is_empty(), "{}", scene.name);
        assert_eq!(conduct.outputs, desktop.conduct.outputs, "{}", scene.name);
        assert_eq!(conduct.alarms, desktop.conduct.alarms, "{}", scene.name);
        assert_eq!(conduct.hello, desktop.conduct.hello, "{}", scene.name);
        assert_eq!(conduct.state, desktop.conduct.state, "{}", scene.name);
        // Not printed: 400 kB.
        assert!(conduct.flash == desktop.conduct.flash, "{}", scene.name);
        let log = Dump::of(&conduct.flash);
        assert_eq!(log.counters.expect("counters").boots, 1);
        assert_eq!(log.episodes.len(), 1, "{}", scene.name);
    }
}

#[test]
fn a_drop_trips_in_the_tick_that_confirms_it_and_is_recorded_whole() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    // 1 s without a notice ends an episode.
    scene.run.duration = 2.5;
    let (outcome, _) = drop::by_reference::<Sink>(&scene, &qemu(), None).expect("drops");
    let fall = &outcome.detection.events[0];
    assert_eq!(fall.event, EventKind::FreeFall);
    let confirmed = fall.confirmed_s.expect("confirmed") + 0.2;
    let bits = |it: &Switching| (it.sample, it.shown.outputs.bits());
    let [_, (_, arming), (_, watching), (_, ready), (tripped, safe), ..] =
        outcome.conduct.outputs.iter().map(bits).collect::<Vec<_>>()[..]
    else {
        panic!("{:?}", outcome.conduct.outputs);
    };
    assert_eq!([arming, watching, ready, safe], [0b0010, 0b0011, 0b1011, 0]);
    assert_eq!(tripped as f64, (confirmed * scene.run.sample_rate).round());
    let log = Dump::of(&outcome.conduct.flash);
    let episode = &log.episodes[0];
    assert_eq!(episode.verdict, Verdict::Whole);
    assert_eq!(episode.samples.iter().flatten().count(), 4_450);
    assert_eq!(log.counters.expect("counters").landings, 1);
    assert_eq!(outcome.conduct.state.sample + 1, outcome.detection.summary.samples);
}

#[test]
fn the_four_phases_are_declared_on_the_target() {
    let events = outcome("rolling", &qemu()).detection.events;
    let first = |kind: EventKind| {
        events
            .iter()
            .position(|event| event.event == kind)
            .unwrap_or_else(|| panic!("no {kind:?} in {events:?}"))
    };
    let order = [
        EventKind::FreeFall,
        EventKind::Impact,
        EventKind::Sliding,
        EventKind::Rolling,
    ]
    .map(first);
    assert!(order.is_sorted(), "{order:?}");
}

/// Both planes read 0.85 of the way, off centre and skewed.
#[test]
fn with_its_commissioning_check_a_drop_told_wrong_is_found_and_gives_the_same_bits() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    let plane = PlaneCalibration {
        zero: [20e-6, -12e-6],
        gain: [0.85, 0.85],
        skew: 0.07,
    };
    let sensors = &mut scene.sensors;
    sensors.gain_error = [-0.15; CHANNELS];
    sensors.offset = [20e-6, -12e-6, 20e-6, -12e-6];
    sensors.skew = [f64::from(plane.skew); PLANES];
    let run = |scene: &Scene, target: &Target| {
        let (outcome, _) = drop::by_reference::<Sink>(scene, target, None).expect("drops");
        (outcome.detection, outcome.conduct.outputs)
    };
    let told = run(&scene, &Target::Host);
    assert_eq!(run(&scene, &qemu()), told);
    let planes = [plane; PLANES];
    scene.sensors.calibration = Some(Calibration { date: 20_261_128, planes });
    let checked = run(&scene, &Target::Host);
    assert_eq!(run(&scene, &qemu()), checked);
    let right = run(&Scene::load("rig").expect("built-in scene"), &Target::Host);
    let speeds = |it: &Detection| -> Vec<f64> {
        let impacts = it.events.iter().filter(|it| it.event == EventKind::Impact);
        impacts.filter_map(|it| it.normal_speed_m_s).collect()
    };
    let [told, checked, right] = [&told, &checked, &right].map(|(it, _)| speeds(it));
    println!("first impacts, m/s: {:?} {:?} {:?}", &told[..3], &checked[..3], &right[..3]);
    assert!(checked.len().abs_diff(right.len()) <= 2, "{checked:?} {right:?}");
    for (it, right) in checked.iter().zip(&right).take(5) {
        assert!((it / right - 1.0).abs() < 0.03, "{it} for {right}");
    }
    assert!((told[0] / right[0] - 1.0).abs() > 0.1, "without it the sensors' gain is in the speeds");
}

/// A bit of a vector that is never used, and of the check itself.
#[test]
fn an_image_with_a_wrong_bit_never_gives_current() {
    let image = std::fs::read(built("touchdown-qemu")).expect("the image");
    // Behind the headers, which have these addresses too.
    let find = |bytes: &[u8]| {
        let place = image.windows(bytes.len()).rposition(|it| it == bytes);
        place.unwrap_or_else(|| panic!("{bytes:02x?} is not in the image"))
    };
    // The vector table begins with the first address of the stack (memory.x) and that of the first function, odd in Thumb code.
    let stack = 0x2000_6c00_u32.to_le_bytes();
    let is_vectors = |it: &[u8]| it[..4] == stack && it[7] == 0x08 && it[4] & 1 == 1;
    let vectors = image.windows(8).position(is_vectors).expect("a vector table");
    // It is the first section of the check, with its address and length.
    let check = find(&[0x0800_0000_u32.to_le_bytes(), 0x188_u32.to_le_bytes()].concat()) - 4;
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("image");
    let scene = Scene::load("rig").expect("built-in scene");
    for (at, bit) in [(vectors + 4 * 90, 3), (check, 0), (check + 12, 7), (check + 3, 5)] {
        let mut damaged = image.clone();
        damaged[at] ^= 1 << bit;
        std::fs::write(&path, damaged).expect("a file");
        let emulator = Emulator::find(Some(&path)).unwrap_or_else(|error| panic!("{error}"));
        let (outcome, _) = drop::by_reference::<Sink>(&scene, &Target::Qemu(emulator), None).expect("drops");
        let state = outcome.conduct.state;
        assert!(state.faults.contains(Fault::ImageDamaged), "{at:#x}");
        for switched in &outcome.conduct.outputs {
            assert_eq!(switched.shown.outputs.bits(), 0, "{at:#x}");
        }
    }
}

/// Switched on over a drop, ordered to clear while it falls and again where it lies: the same JSON.
#[test]
fn a_replay_from_power_on_with_orders_gives_the_same_bits() {
    let folder = TempDir::new().expect("a folder");
    let run = |arguments: &[&str]| {
        let run = touchdown(folder.path()).args(arguments).assert().success();
        run.get_output().stdout.clone()
    };
    run(&["drop", "rig", "--stream", "s.csv"]);
    let replay = ["replay", "s.csv", "--scene", "rig", "--power-on", "--clear-at", "0.004", "--clear-at", "0.28", "--json", "-"];
    let desktop = run(&replay);
    assert_eq!(run(&[&replay[..], &["--on", "qemu"]].concat()), desktop);
    let json: Value = serde_json::from_slice(&desktop).expect("JSON");
    let orders = json["controller"]["orders"].as_array().expect("orders");
    assert_eq!(orders.len(), 2);
}
