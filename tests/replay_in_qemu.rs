//! The built-in scenes on the emulated target: the same events and the same state as on the desktop.

use std::io::Sink;

use touchdown_core::event::EventKind;
use touchdown_sim::drop;
use touchdown_sim::emulator::Emulator;
use touchdown_sim::outcome::Detection;
use touchdown_sim::scene::{BUILT_IN, Scene};
use touchdown_sim::target::Target;

fn detection(name: &str, target: &Target) -> Detection {
    let scene = Scene::load(name).expect("built-in scene");
    let (outcome, _) = drop::run::<Sink>(&scene, target, None)
        .unwrap_or_else(|failure| panic!("{name}: {failure:?}"));
    outcome.detection
}

fn qemu() -> Target {
    Target::Qemu(Emulator::find(None).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn every_built_in_scene_gives_the_same_bits() {
    assert!(BUILT_IN.len() >= 5);
    for scene in BUILT_IN {
        let desktop = detection(scene.name, &Target::Host);
        let target = detection(scene.name, &qemu());
        println!("{}: {:08x}", scene.name, target.state_hash);
        assert_eq!(target, desktop, "{}", scene.name);
        assert!(!target.events.is_empty(), "{}", scene.name);
    }
}

#[test]
fn the_four_phases_are_declared_on_the_target() {
    let events = detection("rolling", &qemu()).events;
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
