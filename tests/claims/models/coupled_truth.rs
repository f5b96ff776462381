//! The coupled model against the reference, which shares no code with it: random machines of every
//! combination of parts, in their bounces.

use touchdown_base::history::{History, Impact};
use touchdown_lab::limits::machine;
use touchdown_run::model;
use touchdown_scene::Scene;
use touchdown_tests::growth::{apart, growth, unit_speed};

/// Of the model, s.
const STEP: f64 = 1e-6;
/// Impacts of each machine that are looked at.
const FIRST: usize = 5;
/// Growth of a change at the start, up to which an impact is well-conditioned.
const TAME: f64 = 100.0;

fn scene(number: u64) -> Scene {
    let mut scene = Scene::parse("machine", &machine(number)).expect("a valid scene");
    scene.model.step = STEP;
    scene.run.duration = 0.02;
    scene
}

/// Until the fifth impact, or the first contact: a step ends a series of bounces that are shorter.
fn cut(scene: &mut Scene) -> usize {
    let history = model::run(scene).expect("a valid scene").histories;
    let starts = history.rings.iter().flat_map(|it| &it.contact_starts);
    let contact = starts.copied().fold(f64::INFINITY, f64::min);
    let impacts = history.whole.impacts.iter();
    let before = impacts.take_while(|it| it.state.time < contact).count().min(FIRST);
    if before > 0 {
        scene.run.duration = history.whole.impacts[before - 1].state.time + STEP;
    }
    before
}

/// Rate at which the rotor that strikes a ring on its stop drives it round there, rad/s.
fn round(scene: &Scene, history: &History) -> f64 {
    let rings = scene.two_plane.iter().flat_map(|it| &it.rings);
    let travels = rings.filter_map(|it| it.support?.travel);
    let speeds = history.impacts.iter().map(|it| it.normal_speed);
    speeds.fold(0.0, f64::max) / travels.fold(f64::INFINITY, f64::min)
}

/// What the model and the reference tell of the same moment: of a wall that gives way the model has the state at the end.
fn told(impact: &Impact, scene: &Scene) -> Impact {
    let mut told = *impact;
    if scene.rings().iter().any(|it| it.wall.is_some()) {
        (told.state.position, told.state.velocity) = ([0.0; 2], [0.0; 2]);
    }
    told
}

/// Rate of the fastest contact of walls that give way, rad/s.
fn pressing(scene: &Scene) -> f64 {
    let walls = scene.rings().iter().filter_map(|it| it.wall);
    walls.fold(0.0, |most, it| f64::max(most, std::f64::consts::PI / it.contact_time))
}

/// What dry friction takes from a ring's speed in a step, V: when it stops the ring is known to a part of a step.
fn rubbed(scene: &Scene) -> f64 {
    let mounts = scene.rings().iter().filter_map(|it| it.support);
    let most = mounts.fold(0.0, |most, it| f64::max(most, it.friction / it.mass));
    STEP * most / unit_speed(scene)
}

/// A step of the midpoint rule turns what goes round at W late by (W h)^2/12.
#[test]
fn well_conditioned_impacts_are_the_references() {
    let (mut seen, mut closest) = (0, 0);
    let (mut worst, mut halved) = (0.0_f64, Vec::new());
    for number in 0..96 {
        let mut scene = scene(number);
        // The reference has no balls behind a wall.
        let mut walls = scene.rings().iter().filter_map(|it| it.wall);
        if walls.any(|it| it.balls.is_some()) {
            continue;
        }
        let before = cut(&mut scene);
        let fastest = scene.two_plane.as_ref().expect("two ends").fastest(scene.rotor.spin);
        if before == 0 {
            continue;
        }
        let truth = touchdown_truth::simulate(&scene);
        let turned = STEP * fastest.max(round(&scene, &truth)).max(pressing(&scene));
        let rubbed = rubbed(&scene);
        if turned > 0.05 || rubbed > 0.05 {
            continue;
        }
        let fine = model::run(&scene).expect("a valid scene").histories.whole;
        scene.model.step = 2.0 * STEP;
        let coarse = model::run(&scene).expect("a valid scene").histories.whole;
        let grown = growth(&scene, &truth, before);
        for (k, growth) in grown.into_iter().enumerate().filter(|it| it.1 <= TAME) {
            let off = apart(&told(&fine.impacts[k], &scene), &told(&truth.impacts[k], &scene), &scene);
            let limit = growth * (1e-8 + turned * turned + rubbed);
            println!("{number} {k}: {off:.1e} of {limit:.1e}, growth {growth:.1}");
            assert!(off <= limit, "machine {number}, impact {k}: {off} {limit}");
            worst = worst.max(off / limit);
            seen += 1;
            closest += u32::from(off <= 1e-6);
            if let Some(coarse) = coarse.impacts.get(k).filter(|_| off > 1e-9) {
                let coarse = told(coarse, &scene);
                halved.push(apart(&coarse, &told(&truth.impacts[k], &scene), &scene) / off);
            }
        }
    }
    halved.sort_by(f64::total_cmp);
    let median = halved[halved.len() / 2];
    println!("{seen} impacts, {closest} to 1e-6, worst {worst:.2} of its limit; in steps twice as long {median:.2} times as far off");
    assert!(seen > 120 && closest > 75, "{seen} {closest}");
    assert!((3.5..4.5).contains(&median), "{median}");
}
