//! Rung `support` at the ends of every parameter, and beyond what makes sense: numbers stay finite, the
//! rotor in its gap, the ring before its stop, and energy only goes.

use touchdown_rotor::{Precision, Touch};
use touchdown_run::model::coupled::watch;
use touchdown_scene::Scene;
use touchdown_tests::ring_scenes::Fall;

/// What rounding may do: to the ledger and to the energy (of all that there is), of the gap, and of the way to the stop.
struct Limits {
    balance: f64,
    growth: f64,
    gap: f64,
    stop: f64,
}

const WIDE: Limits = Limits {
    balance: 1e-12,
    growth: 1e-12,
    gap: 1e-10,
    stop: 1e-10,
};
const NARROW: Limits = Limits {
    balance: 3e-5,
    growth: 3e-5,
    gap: 3e-4,
    stop: 3e-3,
};

/// Steps that hit the bound on their stretches; what was broken and by how much.
fn check<R: Precision>(fall: &Fall, time: f64, limits: &Limits) -> Result<u32, String> {
    let (mut first, mut shortened, mut finite) = (None, 0, true);
    let mut worst = [0.0_f64; 4];
    fall.follow::<R>(time, |now| {
        let (energy, place) = (&now.energy, now.displacement);
        let first: f64 = *first.get_or_insert(energy.total());
        let travel = fall.mount.and_then(|mount| mount.stop).map(|stop| stop.travel);
        let distance = place[0].hypot(place[1]) / fall.rigid.clearance - 1.0;
        let stop = travel.map_or(0.0, |travel| now.ring[0].hypot(now.ring[1]) / travel - 1.0);
        let held = now.touch != Touch::None;
        let moved = energy.stored().abs() + (energy.total() - energy.stored()).abs();
        let size = first.abs() + moved + f64::MIN_POSITIVE;
        let broken = [
            (energy.total() - first).abs() / (limits.balance * size),
            (energy.stored() - first) / (limits.growth * size),
            if held { distance.abs() } else { distance } / limits.gap,
            stop / limits.stop,
        ];
        for (worst, broken) in worst.iter_mut().zip(broken) {
            finite &= broken.is_finite();
            *worst = worst.max(broken);
        }
        finite &= now.race.iter().all(|number| number.is_finite());
        shortened = now.shortened;
    });
    if finite && worst.iter().all(|worst| *worst <= 1.0) {
        return Ok(shortened);
    }
    let [total, stored, gap, stop] = worst;
    Err(format!(
        "of the limits: ledger {total}, energy {stored}, gap {gap}, stop {stop}; finite {finite}; {fall:?}"
    ))
}

fn both(fall: &Fall, time: f64) -> u32 {
    let wide = check::<f64>(fall, time, &WIDE).unwrap_or_else(|wrong| panic!("f64 {wrong}"));
    let narrow = check::<f32>(fall, time, &NARROW).unwrap_or_else(|wrong| panic!("f32 {wrong}"));
    wide.max(narrow)
}

#[test]
fn any_spring_and_any_ring() {
    for stiffness in [1e2, 1e4, 1e6, 1e8, 1e10, 1e12] {
        for mass in [1e-6, 1e-2, 1.0, 1e3] {
            for damping in [0.0, 500.0, 1e6] {
                for step in [1e-6, 1e-5, 1e-4, 1e-3] {
                    let fall = Fall::new(step).mounted(mass, stiffness, damping);
                    assert_eq!(both(&fall.spinning(300.0), 0.03), 0, "{fall:?}");
                }
            }
        }
    }
}

#[test]
fn any_inner_ring() {
    for inertia in [1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e6] {
        for (dry, viscous) in [(0.0, 0.0), (1e-2, 1e-5), (10.0, 1.0), (0.0, 1e3)] {
            for step in [1e-6, 1e-4, 1e-3] {
                let fall = Fall::new(step).turning(inertia).dragged(dry, viscous);
                assert_eq!(both(&fall.spinning(300.0), 0.03), 0, "{fall:?}");
                let fall = fall.mounted(1.0, 1e7, 500.0);
                assert_eq!(both(&fall.spinning(300.0), 0.03), 0, "{fall:?}");
            }
        }
    }
}

/// A ring of a millionth of the rotor, thrown against a stop 0.1 um away.
#[test]
fn any_stop() {
    let mut shortened = 0;
    for stiffness in [1e2, 1e4, 1e6, 1e8] {
        for mass in [1e-6, 1e-2, 1.0, 1e3] {
            for travel in [1e-7, 1e-5, 1e-4] {
                for step in [1e-6, 1e-4, 1e-3] {
                    let fall = Fall::new(step).mounted(mass, stiffness, 500.0);
                    let fall = fall.stopping(travel).spinning(300.0);
                    shortened += both(&fall, 0.03);
                }
            }
        }
    }
    println!("{shortened} steps left out in part");
    assert!(shortened < 20, "{shortened}");
}

/// Whirl on a fixed ring grows by 1/(1 - mu v t): beyond any number of stretches in a step.
#[test]
fn whirl_without_bound() {
    for step in [1e-5, 1e-3] {
        let mut fall = Fall::new(step)
            .spinning(-1e5)
            .turning(1e3)
            .on_wall(0.0, 10.0);
        fall.rigid.friction = 0.5;
        fall.rigid.polar_inertia *= 1e3;
        both(&fall, 0.02);
        both(&fall.mounted(1.0, 1e8, 0.0), 0.02);
    }
}

/// Painleve's paradox, for 1 s: rotor and stop push the ring that friction wedges between them.
#[test]
fn a_ring_that_wedges_makes_no_energy() {
    let soft = Scene::load("soft-support").expect("built-in scene");
    for (precision, limit) in [
        (touchdown_scene::Precision::F64, WIDE.growth),
        (touchdown_scene::Precision::F32, NARROW.growth),
    ] {
        for step in [1e-5, 1e-4] {
            let mut scene = Scene::load("rig").expect("built-in scene");
            scene.model = soft.model;
            scene.model.precision = precision;
            scene.model.step = step;
            scene.support = soft.support;
            scene.retainer.friction = 2.0;
            scene.run.duration = 1.0;
            let (mut least, mut gained, mut stopped) = (f64::INFINITY, 0.0_f64, false);
            watch(&scene, &mut |sight| {
                let stored = sight.energy.stored();
                least = least.min(stored);
                gained = gained.max((stored - least) / sight.energy.total().abs());
                stopped |= sight.energy.stops > 0.0;
            })
            .expect("valid scene");
            println!("{precision:?} {step}: {gained:.1e} of all energy");
            assert!(stopped, "the ring never met its stop");
            assert!(gained < limit, "{precision:?} {step}: {gained}");
        }
    }
}
