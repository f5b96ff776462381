//! The coupled model against the reference, which shares no code with it: random machines of every
//! combination of parts, in their bounces.

use rayon::prelude::*;
use touchdown_base::history::{History, Impact};
use touchdown_lab::limits::machine;
use touchdown_run::model;
use touchdown_scene::{Ring, Scene, Stop};
use touchdown_tests::growth::{apart, growth, unit_speed};

/// Of the model, s.
const STEP: f64 = 1e-6;
/// Impacts of each machine that are looked at.
const FIRST: usize = 5;
/// Growth of a change at the start, up to which an impact is well-conditioned; in fine steps.
const TAME: f64 = 100.0;
const TAMEST: f64 = 10.0;
/// What goes round turns by so much in a fine step, rad.
const FINE: f64 = 4e-4;
/// Least fine step, s.
const FINEST: f64 = 5e-9;

fn scene(text: &str) -> Option<Scene> {
    let mut scene = Scene::parse("machine", text).ok()?;
    scene.model.step = STEP;
    scene.run.duration = 0.02;
    Some(scene)
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
    let travels = rings.filter_map(|it| Some(it.support?.stop?.travel));
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

/// Rate of the fastest contact of walls that give way, rad/s: a light ring swings between rotor and stop.
fn pressing(scene: &Scene) -> f64 {
    let rate = |ring: &Ring| {
        let own = std::f64::consts::PI / ring.wall?.contact_time;
        let light = ring.support.filter(|it| it.stop.is_some_and(|stop| stop.stiffness.is_some()));
        let times = light.map_or(1.0, |it| (scene.rotor.mass / it.mass).sqrt());
        Some(own * times.max(1.0))
    };
    scene.rings().iter().filter_map(rate).fold(0.0, f64::max)
}

/// What dry friction takes from a ring's speed in a step, V: when it stops the ring is known to a part of a step.
fn rubbed(scene: &Scene) -> f64 {
    let mounts = scene.rings().iter().filter_map(|it| it.support);
    let most = mounts.fold(0.0, |most, it| f64::max(most, it.friction / it.mass));
    STEP * most / unit_speed(scene)
}

/// Of impacts of model and reference.
#[derive(Default)]
struct Compared {
    seen: usize,
    /// Within 1e-6.
    closest: usize,
    /// On walls that give way, and with balls behind them.
    pressed: [usize; 2],
    /// Off, in parts of what is allowed.
    worst: f64,
    /// How much farther off those in steps twice as long are.
    halved: Vec<f64>,
}

impl Compared {
    /// A step of the midpoint rule turns what goes round at W late by (W h)^2/12.
    fn compare(&mut self, number: u64, mut scene: Scene) {
        let before = cut(&mut scene);
        let fastest = scene.two_plane.as_ref().expect("two ends").fastest(scene.rotor.spin);
        if before == 0 {
            return;
        }
        let truth = touchdown_truth::simulate(&scene);
        let turned = STEP * fastest.max(round(&scene, &truth)).max(pressing(&scene));
        let rubbed = rubbed(&scene);
        if turned > 0.05 || rubbed > 0.05 {
            return;
        }
        let walls = || scene.rings().iter().filter_map(|it| it.wall);
        let pressed = [walls().next().is_some(), walls().any(|it| it.law.balls.is_some())];
        let fine = model::run(&scene).expect("a valid scene").histories.whole;
        scene.model.step = 2.0 * STEP;
        let coarse = model::run(&scene).expect("a valid scene").histories.whole;
        let grown = growth(&scene, &truth, before);
        for (k, growth) in grown.into_iter().enumerate().filter(|it| it.1 <= TAME) {
            let off = apart(&told(&fine.impacts[k], &scene), &told(&truth.impacts[k], &scene), &scene);
            let limit = growth * (1e-8 + turned * turned + rubbed);
            println!("{number} {k}: {off:.1e} of {limit:.1e}, growth {growth:.1}, {pressed:?}");
            assert!(off <= limit, "machine {number}, impact {k}: {off} {limit}");
            self.worst = self.worst.max(off / limit);
            self.seen += 1;
            self.closest += usize::from(off <= 1e-6);
            for (count, is) in self.pressed.iter_mut().zip(pressed) {
                *count += usize::from(is);
            }
            if let Some(coarse) = coarse.impacts.get(k).filter(|_| off > 1e-9) {
                let coarse = told(coarse, &scene);
                self.halved.push(apart(&coarse, &told(&truth.impacts[k], &scene), &scene) / off);
            }
        }
    }

    /// The median of how much farther off those in steps twice as long are.
    fn order(&mut self) -> f64 {
        self.halved.sort_by(f64::total_cmp);
        let median = self.halved[self.halved.len() / 2];
        let Self { seen, closest, pressed: [walls, balls], worst, .. } = self;
        println!(
            "{seen} impacts, {walls} on walls that give way, {balls} with balls; {closest} to 1e-6, worst {worst:.2} of its limit; in steps twice as long {median:.2} times as far off"
        );
        median
    }
}

#[test]
fn well_conditioned_impacts_are_the_references() {
    let mut compared = Compared::default();
    for number in 0..96 {
        compared.compare(number, scene(&machine(number)).expect("a valid scene"));
    }
    let median = compared.order();
    assert!(compared.seen > 120 && compared.closest > 75, "{} {}", compared.seen, compared.closest);
    assert!((3.5..4.5).contains(&median), "{median}");
}

/// Of a machine in steps that resolve it: its well-conditioned impacts, and how far the farthest is off.
fn in_fine_steps(number: u64) -> Option<(usize, f64)> {
    let mut scene = scene(&machine(number)).expect("a valid scene");
    let before = cut(&mut scene);
    let fastest = scene.two_plane.as_ref().expect("two ends").fastest(scene.rotor.spin);
    let truth = touchdown_truth::simulate(&scene);
    let rate = fastest.max(round(&scene, &truth)).max(pressing(&scene));
    scene.model.step = STEP.min(FINE / rate);
    // Dry friction is of first order.
    if before == 0 || rubbed(&scene) > 0.0 || scene.model.step < FINEST {
        return None;
    }
    let fine = model::run(&scene).expect("a valid scene").histories.whole;
    let grown = growth(&scene, &truth, before);
    let tame = grown.into_iter().take_while(|it| *it <= TAMEST).count();
    let off = |k: usize| {
        let (fine, truth) = (told(&fine.impacts[k], &scene), told(&truth.impacts[k], &scene));
        apart(&fine, &truth, &scene)
    };
    let worst = (0..tame).map(off).fold(0.0, f64::max);
    println!("{number}: {tame} impacts, step {:.1e} s, {worst:.1e} off", scene.model.step);
    Some((tame, worst))
}

#[test]
#[ignore = "minutes"]
fn in_fine_steps_they_are_to_1e_6() {
    let compared: Vec<_> = (0..96).into_par_iter().filter_map(in_fine_steps).collect();
    let impacts: usize = compared.iter().map(|it| it.0).sum();
    let worst = compared.iter().map(|it| it.1).fold(0.0, f64::max);
    println!("{} machines, {impacts} impacts, {worst:.1e} off at most", compared.len());
    assert!(impacts > 100 && worst <= 1e-6, "{impacts} {worst}");
}

/// Of a material that a step of 1 us resolves.
const LINE: &str = "[materials]\ncontact = \"line\"\nlength_mm = 20\nrotor_modulus_gpa = 2\nretainer_modulus_gpa = 2\n";

/// Machines with walls that give way.
fn pressed(numbers: std::ops::Range<u64>, more: &str, with: impl Fn(&Scene) -> bool) -> Compared {
    let mut compared = Compared::default();
    let (mut tried, mut refused) = (0, 0);
    for number in numbers {
        let text = machine(number);
        if !text.contains("\"compliant\"") {
            continue;
        }
        tried += 1;
        match scene(&(text + more)) {
            Some(scene) if with(&scene) => compared.compare(number, scene),
            Some(_) => {}
            None => refused += 1,
        }
    }
    println!("{tried} machines, {refused} too soft for their line");
    compared
}

/// All rings have a stop that is near and gives way; the drops without it are others.
#[test]
fn those_in_stops_that_give_way_are_too() {
    let mut compared = Compared::default();
    let (mut drops, mut others) = (0, 0);
    for number in 0..130 {
        let Some(mut scene) = scene(&machine(number)).filter(|it| it.rings().iter().any(|ring| ring.support.is_some())) else {
            continue;
        };
        let stops = |scene: &mut Scene, has: bool| {
            for ring in scene.two_plane.iter_mut().flat_map(|it| &mut it.rings) {
                let travel = 0.03 * ring.retainer.clearance;
                if let Some(mount) = &mut ring.support {
                    let stiffness = Some(3.0 * mount.stiffness);
                    mount.stop = has.then_some(Stop { travel, stiffness });
                }
            }
        };
        let (seen, halved) = (compared.seen, compared.halved.len());
        stops(&mut scene, true);
        let with = model::run(&scene).expect("a valid scene").histories.whole.impacts;
        compared.compare(number, scene.clone());
        stops(&mut scene, false);
        let without = model::run(&scene).expect("a valid scene").histories.whole.impacts;
        let pairs = with.iter().zip(&without).take(compared.seen - seen);
        let off = pairs.map(|(a, b)| apart(a, b, &scene)).fold(0.0, f64::max);
        drops += usize::from(compared.seen > seen);
        others += usize::from(off > 1e-3);
        // The order is that of the step in the stop.
        if off <= 1e-3 {
            compared.halved.truncate(halved);
        }
    }
    let median = compared.order();
    println!("{others} of {drops} drops are others without their stops");
    assert!(compared.seen > 60 && others > 8, "{} {others}", compared.seen);
    assert!((3.5..4.5).contains(&median), "{median}");
}

#[test]
fn those_on_lines_are_too() {
    let mut compared = pressed(0..96, LINE, |_| true);
    let median = compared.order();
    assert!(compared.seen > 20, "{}", compared.seen);
    assert!((3.5..4.5).contains(&median), "{median}");
}

#[test]
fn those_with_balls_are_too() {
    for (more, least) in [("", 25), (LINE, 15)] {
        let balls = |scene: &Scene| scene.rings().iter().any(|it| it.wall.is_some_and(|wall| wall.law.balls.is_some()));
        let mut compared = pressed(0..288, more, balls);
        let median = compared.order();
        assert!(compared.seen > least, "{}", compared.seen);
        assert!((3.5..4.5).contains(&median), "{median}");
    }
}
