//! What the report is told of a scene.

use touchdown_page::report::{RingSubject, Subject};
use touchdown_run::fidelity::force::press;
use touchdown_scene::parts::parts;
use touchdown_scene::scales::validity;
use touchdown_scene::{Fidelity, Ring, Scene};

pub(super) fn subject(scene: &Scene) -> Subject {
    let rings = scene.two_plane.iter().flat_map(|it| &it.rings);
    let ring = |ring: &Ring| RingSubject {
        name: ring.name.clone(),
        clearance: ring.retainer.clearance,
        place: ring.place,
        restitution: ring.retainer.restitution,
    };
    // Rung `hertz` takes steel for what the scene does not give.
    let known = scene.materials.given || scene.model.rung == Fidelity::Hertz;
    Subject {
        title: scene.heading().to_owned(),
        source: scene.source.clone().unwrap_or_else(|| scene.name.clone()),
        machine: scene.machine(),
        spin: scene.rotor.spin,
        duration: scene.run.duration,
        sample_rate: scene.run.sample_rate,
        precision: scene.model.precision.to_string(),
        step: scene.model.step,
        seed: scene.run.seed,
        noise: scene.sensors.noise,
        rings: rings.map(ring).collect(),
        cage_ratio: scene.ball_bearing.map(|bearing| bearing.cage_ratio),
        parts: parts(scene),
        validity: validity(scene).map(|it| it.to_string()),
        press: known.then(|| press(scene)).flatten(),
        versions: vec![("touchdown".to_owned(), env!("CARGO_PKG_VERSION").to_owned())],
    }
}
