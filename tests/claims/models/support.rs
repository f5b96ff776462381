//! Rung `support`: a ring on a spring and damper, and one that turns, against closed forms and the reference.

use touchdown_run::model::run;
use touchdown_run::model::coupled::watch;
use touchdown_scene::{Precision, Removable, Scene, Start, Support};

fn scene(name: &str, precision: Precision, step: f64) -> Scene {
    let mut scene = Scene::load(name).expect("built-in scene");
    scene.model.precision = precision;
    scene.model.step = step;
    scene
}

/// At rest at the bottom, without spin, on a support that is let go.
fn resting(step: f64) -> Scene {
    let mut scene = scene("soft-support", Precision::F64, step);
    scene.rotor.spin = 0.0;
    scene.start = Start::Wall {
        angle: 0.0,
        tangential: 0.0,
    };
    scene
}

/// x'' + 2 d x' + w^2 x = 0 from the rest place of the unloaded ring, w^2 = k/(m + m_s), around the sag m g/k.
#[test]
fn rotor_and_ring_swing_and_decay_together() {
    let mut errors = Vec::new();
    for step in [2e-5, 1e-5] {
        let mut worst = 0.0_f64;
        for periods in [0.25, 1.0, 3.3, 7.0] {
            let mut scene = resting(step);
            let Support {
                mass,
                stiffness,
                damping,
                ..
            } = scene.support.expect("a support");
            let moved = scene.rotor.mass + mass;
            let rate = (stiffness / moved).sqrt();
            let decay = 0.5 * damping / moved;
            let swing = (rate * rate - decay * decay).sqrt();
            let time = periods * std::f64::consts::TAU / swing;
            scene.run.duration = time;
            let sag = scene.rotor.mass * scene.run.gravity / stiffness;
            let left = (swing * time).cos() + decay / swing * (swing * time).sin();
            let expected = -sag * (1.0 - (-decay * time).exp() * left);
            let ring = run(&scene).unwrap().ring.expect("a ring").y_m;
            worst = worst.max((ring - expected).abs() / sag);
        }
        errors.push(worst);
    }
    // Second order: (w h)^2/24 of phase a radian is 1.5e-4 after seven periods at 20 us.
    assert!(errors[0] < 2e-3, "{errors:?}");
    assert!(errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn drops_follow_the_reference() {
    for name in ["soft-support", "ball-bearing"] {
        for (precision, times) in [(Precision::F64, 1e-5), (Precision::F32, 2e-5)] {
            let mut scene = scene(name, precision, 1e-5);
            scene.run.duration = 0.05;
            let (ours, truth) = (run(&scene).unwrap(), touchdown_truth::simulate(&scene));
            let pairs = ours.histories.whole.impacts.iter().zip(&truth.impacts);
            let mut compared = 0;
            for (a, b) in pairs.take(6) {
                let late = (a.state.time - b.state.time).abs();
                assert!(late < times, "{name}: {late} s");
                compared += 1;
            }
            assert_eq!(compared, 6, "{name}");
        }
    }
}

/// Backward whirl on the support settles; radius, speed and load are those of the reference.
#[test]
fn whirl_settles_at_the_support() {
    let mut scene = scene("soft-support", Precision::F64, 1e-5);
    scene.run.duration = 0.3;
    let ours = run(&scene).unwrap().histories.whole;
    let truth = touchdown_truth::simulate(&scene);
    assert_eq!(ours.regime, truth.regime);
    let polar = |history: &touchdown_base::history::History| {
        let ([x, y], [u, v]) = (history.end.position, history.end.velocity);
        let radius = x.hypot(y);
        (radius, (x * v - y * u) / (radius * radius))
    };
    let ((radius, rate), (true_radius, true_rate)) = (polar(&ours), polar(&truth));
    assert!(
        (radius / true_radius - 1.0).abs() < 0.01,
        "{radius} {true_radius}"
    );
    assert!((rate / true_rate - 1.0).abs() < 0.01, "{rate} {true_rate}");
    // 50 to 300 Hz is what machines show.
    assert!(
        (50.0..300.0).contains(&(rate.abs() / std::f64::consts::TAU)),
        "{rate}"
    );
}

/// Where slip has ended; the rotor still swings in the ring, at a phase of its own.
#[test]
fn the_inner_ring_spins_up_as_in_the_reference() {
    for precision in Precision::ALL {
        let scene = scene("ball-bearing", precision, 2e-5);
        let ours = run(&scene).unwrap();
        let race = ours.ring.and_then(|ring| ring.race).expect("a race");
        let (inner, cage) = (race.inner_ring_rad_s, race.cage_rad_s);
        let (ours, truth) = (ours.histories.whole, touchdown_truth::simulate(&scene));
        let [a, b] = [&ours, &truth].map(|history| history.rolling_starts[0]);
        assert!((a - b).abs() < 1e-3, "{a} {b}");
        assert!((ours.end.spin / truth.end.spin - 1.0).abs() < 1e-3);
        assert!((cage / inner - 0.44).abs() < 1e-6);
        let ([x, y], [u, v]) = (ours.end.position, ours.end.velocity);
        let along = (x * v - y * u) / x.hypot(y);
        let radius = scene.rotor.radius;
        let slip = along + radius * ours.end.spin - (radius + scene.retainer.clearance) * inner;
        assert!(slip.abs() < 1e-4, "{slip} m/s");
    }
}

/// Without loss to the surroundings all friction and drag is in the bearing.
#[test]
fn heat_is_what_friction_and_drag_took() {
    let mut scene = scene("ball-bearing", Precision::F64, 1e-5);
    let race = &mut scene.ball_bearing.as_mut().expect("a ball bearing").race;
    race.heat_loss = 0.0;
    let capacity = race.heat_capacity;
    let ours = run(&scene).unwrap();
    let race = ours.ring.and_then(|ring| ring.race).expect("a race");
    let rise = race.temperature_rise_k;
    let ledger = ours.ledger.expect("a ledger");
    let taken = |name| {
        ledger
            .gone
            .iter()
            .find(|it| it.name == name)
            .expect(name)
            .energy_j
    };
    let heat = taken("friction heat") + taken("drag");
    assert!((rise * capacity / heat - 1.0).abs() < 1e-9, "{rise} {heat}");
}

#[test]
fn the_ledger_closes() {
    for name in ["soft-support", "ball-bearing"] {
        for (precision, limit) in [(Precision::F64, 1e-12), (Precision::F32, 1e-5)] {
            let scene = scene(name, precision, 2e-5);
            let (mut start, mut worst) = (None, 0.0_f64);
            watch(&scene, &mut |sight| {
                let total = sight.energy.total();
                let start = *start.get_or_insert(total);
                worst = worst.max((total / start - 1.0).abs());
            })
            .unwrap();
            assert!(worst < limit, "{name} {precision:?}: {worst}");
        }
    }
}

/// A stiff, heavy ring is a fixed one: the rig's drop.
#[test]
fn a_rigid_support_is_none() {
    let rig = Scene::load("rig").expect("built-in scene");
    let truth = touchdown_truth::simulate(&rig);
    let mut scene = scene("soft-support", Precision::F64, 1e-5);
    scene.start = rig.start;
    scene.support = Some(Support {
        mass: 1e6,
        stiffness: 1e12,
        damping: 0.0,
        vertical: None,
        friction: 0.0,
        stop: None,
    });
    let ours = run(&scene).unwrap().histories.whole;
    for (a, b) in ours.impacts.iter().zip(&truth.impacts).take(20) {
        assert!((a.state.time - b.state.time).abs() < 1e-6, "{a:?} {b:?}");
    }
    assert!(ours.impacts.len() > 20);
    assert_eq!(ours.regime, truth.regime);
}

/// A scene with the tables `more`.
fn on(more: &str) -> Scene {
    let text = format!(
        "[rotor]\nmass_kg = 5\nradius_mm = 20\nspeed_rpm = 12000\n\
         [retainer]\nclearance_mm = 0.25\nfriction = 0.2\nrestitution = 0.5\n\
         [start]\nx_mm = 0.02\n[model]\nstep_us = 10\n[run]\nduration_s = 0.1\n{more}"
    );
    Scene::parse("scene", &text).expect("valid")
}

fn seat(support: [f64; 3], inertia: f64, drag: f64, capacity: f64) -> String {
    let [mass, stiffness, damping] = support;
    format!(
        "[support]\nmass_kg = {mass}\nstiffness_n_m = {stiffness}\ndamping_n_s_m = {damping}\n\
         travel_mm = 0.2\n[ball_bearing]\ninner_ring_inertia_kg_m2 = {inertia}\n\
         dry_drag_n_m = {drag}\nheat_capacity_j_k = {capacity}\n"
    )
}

/// The mounts and bearings of all rings act together, whether the rings have them or the scene.
#[test]
fn a_rotor_that_does_not_tilt_stands_on_all_mounts() {
    let ends = "[two_plane]\nrotor_length_mm = 300\n[[ring]]\nz_mm = -100\n[[ring]]\nz_mm = 100\n";
    let one = seat([0.25, 4e6, 256.0], 2e-5, 0.01, 50.0);
    let softer = "support = { mass_kg = 0.125, stiffness_n_m = 1e6, damping_n_s_m = 64, travel_mm = 0.3 }\n";
    let both = seat([0.5, 8e6, 512.0], 4e-5, 0.02, 100.0);
    let unlike = seat([0.375, 5e6, 320.0], 4e-5, 0.02, 100.0);
    for (rings, together) in [
        (format!("{one}{ends}"), both),
        (format!("{one}{ends}{softer}"), unlike),
    ] {
        let mut level = on(&rings);
        level.model = level.model.without(Removable::Tilt);
        let [level, together, alone] =
            [level, on(&together), on(&one)].map(|it| run(&it).expect("possible"));
        assert!(together.histories.whole.impacts.len() > 3);
        assert_eq!(level.histories, together.histories);
        assert_eq!(level.ring, together.ring);
        // One end's mount would do something else.
        assert_ne!(level.histories, alone.histories);
    }
}
