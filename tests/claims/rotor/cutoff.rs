//! The trade of a bounce series' cut-off: impacts left out against the error of what follows.

use touchdown_base::history::History;
use touchdown_run::model::simulate;
use touchdown_scene::Scene;

/// Cut-offs, m/s.
const CUTOFFS: [f64; 3] = [1e-6, 1e-5, 1e-4];

fn dropped(cutoff: f64) -> (Scene, History) {
    let mut scene = Scene::load("rig").expect("built-in scene");
    scene.model.cutoff = cutoff;
    let history = simulate(&scene).expect("the rig drops");
    (scene, history)
}

#[test]
fn impacts_above_the_cutoff_stay_as_they_are() {
    let (_, all) = dropped(0.0);
    for cutoff in CUTOFFS {
        let (scene, some) = dropped(cutoff);
        let above = |history: &History| {
            let launched = |speed: f64| scene.retainer.restitution * speed > cutoff;
            let impacts = history.impacts.iter().map(|impact| impact.normal_speed);
            impacts.filter(|speed| launched(*speed)).count()
        };
        let kept = above(&all);
        assert_eq!(above(&some), kept);
        assert_eq!(some.impacts[..kept], all.impacts[..kept], "bit for bit");
        assert!(some.impacts.len() < all.impacts.len());
    }
}

#[test]
fn the_contact_after_it_is_off_by_the_square() {
    let truth = touchdown_truth::simulate(&dropped(0.0).0);
    let mut last = f64::INFINITY;
    for cutoff in CUTOFFS.into_iter().rev() {
        let (scene, history) = dropped(cutoff);
        let time = (scene.retainer.clearance / scene.run.gravity).sqrt();
        let speed = (scene.retainer.clearance * scene.run.gravity).sqrt();
        let off = (history.contact_starts[0] - truth.contact_starts[0]).abs() / time;
        let limit = 2.0 * (cutoff / speed).powi(2);
        println!("{cutoff:e} m/s: contact {off:.2e} T late or early, limit {limit:.2e}");
        assert!(off <= limit);
        assert!(off < last);
        last = off;
    }
}
