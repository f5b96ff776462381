//! Drops that are alike but for what nobody knows: where the rotor is when it falls, and numbers that are estimates.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use touchdown_base::machine::Start;
use touchdown_scene::{Retainer, Scene, Support};

/// Of the clearance: starts are spread over a disc of this radius.
const WITHIN: f64 = 0.5;
/// Fastest start, m/s.
const FASTEST: f64 = 0.02;
/// Friction, stiffness and damping of the mounts are known to this factor.
const FACTOR: f64 = 2.0;
/// Restitution is known to this.
const RESTITUTION: f64 = 0.1;

/// Drop `number` of the scene's ensemble. The same number gives the same start and the same numbers.
pub fn varied(scene: &Scene, number: u64) -> Scene {
    let mut random = ChaCha8Rng::seed_from_u64(scene.run.seed);
    random.set_stream(number);
    let mut unit = || random.random::<f64>();
    let mut scene = scene.clone();
    let (radius, angle) = (WITHIN * unit().sqrt(), TAU * unit());
    let (speed, course) = (FASTEST * unit(), TAU * unit());
    if let Start::Free { .. } = scene.start {
        let clearance = scene.retainer.clearance;
        scene.start = Start::Free {
            position: [angle.cos(), angle.sin()].map(|it| it * radius * clearance),
            velocity: [course.cos(), course.sin()].map(|it| it * speed),
        };
    }
    let mut factor = || FACTOR.powf(2.0 * unit() - 1.0);
    let [friction, stiffness, damping] = [factor(), factor(), factor()];
    let more = RESTITUTION * (2.0 * unit() - 1.0);
    let law = |it: &mut Retainer| {
        it.friction *= friction;
        it.restitution = (it.restitution + more).clamp(0.0, 1.0);
    };
    let mount = |it: &mut Support| {
        it.stiffness *= stiffness;
        it.damping *= damping;
        if let Some([spring, damper]) = &mut it.vertical {
            *spring *= stiffness;
            *damper *= damping;
        }
    };
    law(&mut scene.retainer);
    scene.support.iter_mut().for_each(mount);
    for ring in scene.two_plane.iter_mut().flat_map(|it| &mut it.rings) {
        law(&mut ring.retainer);
        ring.support.iter_mut().for_each(mount);
    }
    scene
}
