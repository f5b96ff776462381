//! Rung `support` as a whole: against the independent reference, against the fixed ring, and its
//! energy to rounding.

use std::iter::zip;

use touchdown_core::model::{Change, Moreau, Precision, Start, Stepper};
use touchdown_sim::history::Happening;
use touchdown_sim::reference::{self, Machine, Reference};
use touchdown_tests::supports::{Fall, Moment};

/// Drops with all that a support has.
fn drops(step: f64) -> [(&'static str, Fall, f64); 8] {
    let fall = Fall::new(step);
    let spinning = fall.spinning(50.0);
    [
        ("soft", spinning.mounted(1.0, 1e6, 500.0), 0.02),
        ("stiff", spinning.mounted(1.0, 1e7, 500.0), 0.02),
        ("light", spinning.mounted(0.1, 1e7, 2000.0), 0.015),
        (
            "stop",
            spinning.mounted(1.0, 1e6, 500.0).stopping(1e-5),
            0.01,
        ),
        (
            "light stop",
            spinning.mounted(0.1, 1e6, 500.0).stopping(1e-5),
            0.01,
        ),
        ("bearing", spinning.turning(1e-5), 0.02),
        ("dragged", spinning.turning(1e-5).dragged(2e-2, 1e-4), 0.02),
        (
            "all",
            spinning
                .mounted(1.0, 1e6, 500.0)
                .stopping(1e-5)
                .turning(1e-4)
                .dragged(2e-2, 1e-4),
            0.01,
        ),
    ]
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Largest error in the units of the drop.
fn error(fall: &Fall, time: f64) -> f64 {
    let end = fall.end::<f64>(time).0;
    let truth = fall.reference().advance(end.time, &mut |_, _| {});
    let length = fall.rigid.clearance;
    let speed = (length * fall.rigid.gravity).sqrt();
    [
        apart(end.position, truth.position) / length,
        apart(end.ring, truth.ring_position) / length,
        apart(end.velocity, truth.velocity) / speed,
        (end.spin - truth.spin).abs() * fall.rigid.radius / speed,
        (end.race[0] - truth.race_spin).abs() * fall.rigid.radius / speed,
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

/// Bounces, contact, stops and slip that ends: of second order, with where in a step contact starts.
#[test]
fn drops_converge_to_the_reference() {
    const STEPS: [f64; 5] = [4e-5, 2e-5, 1e-5, 5e-6, 2.5e-6];
    for index in 0..8 {
        let errors = STEPS.map(|step| {
            let (_, fall, time) = drops(step)[index];
            error(&fall, time)
        });
        let name = drops(1.0)[index].0;
        println!("{name}: {errors:?}");
    }
}

fn told(fall: &Fall, time: f64) -> (Vec<f64>, Vec<f64>) {
    let told = fall.end::<f64>(time).1;
    let impacts = told.iter().filter_map(|t| match t.1 {
        Change::Impact(speed) => Some((t.0, speed)),
        _ => None,
    });
    impacts.unzip()
}

#[test]
fn impacts_are_those_of_the_reference() {
    for (name, fall, time) in drops(1e-5) {
        let (times, speeds) = told(&fall, time);
        let mut truth = Vec::new();
        fall.reference().advance(time, &mut |link, happening| {
            if let (0, Happening::Impact(impact)) = (link, happening) {
                truth.push((impact.state.time, impact.normal_speed));
            }
        });
        let mut worst = [0.0_f64; 2];
        for ((time, speed), want) in zip(zip(&times, &speeds), &truth) {
            worst[0] = worst[0].max((time - want.0).abs());
            worst[1] = worst[1].max((speed - want.1).abs());
        }
        println!(
            "{name}: {} of {} impacts, {worst:?}",
            times.len(),
            truth.len()
        );
    }
}

fn planar(fall: &Fall) -> Reference {
    let rigid = &fall.rigid;
    let machine = Machine {
        mass: rigid.mass,
        radius: rigid.radius,
        polar_inertia: rigid.polar_inertia,
        clearance: rigid.clearance,
        friction: rigid.friction,
        restitution: rigid.restitution,
        gravity: rigid.gravity,
    };
    Reference::new(&machine, &fall.start, fall.spin)
}

/// Largest distance from the drop into a fixed ring, in clearances, of the support and of `moreau`.
fn beside(fall: &Fall, time: f64) -> [f64; 2] {
    let mut truth = planar(fall);
    let mut path = Vec::new();
    let mut worst = 0.0_f64;
    fall.follow::<f64>(time, |now| {
        let position = truth.advance(now.time, &mut |_| {}).position;
        worst = worst.max(apart(position, now.position) / fall.rigid.clearance);
        path.push(position);
    });
    let model = Moreau::try_new(&fall.rigid).expect("valid configuration");
    let reference::Start::Free { position, velocity } = fall.start else {
        panic!("a drop");
    };
    let scales = *model.scales();
    let start = Start::Free {
        position: position.map(|x| x / scales.length),
        velocity: velocity.map(|v| v / scales.speed),
    };
    let mut state = model
        .start(&start, fall.spin / scales.spin, |_| {})
        .expect("valid start");
    let mut moreau = 0.0_f64;
    for want in path.iter().skip(1) {
        model.step(&mut state, |_| {});
        let found = model.kinematics(&state).position.map(|x| x * scales.length);
        moreau = moreau.max(apart(*want, found) / fall.rigid.clearance);
    }
    [worst, moreau]
}

#[test]
fn a_stiff_support_is_a_fixed_ring() {
    for step in [1e-3, 3e-4, 1e-4, 3e-5] {
        let fall = Fall::new(step).spinning(50.0);
        for fall in [
            fall,
            fall.mounted(1.0, 1e12, 0.0),
            fall.mounted(1e-6, 1e12, 0.0),
            fall.mounted(1e-3, 1e12, 500.0),
        ] {
            let [support, moreau] = beside(&fall, 0.05);
            println!(
                "{:?} {step:.0e} s: {support:.1e}, moreau {moreau:.1e}",
                fall.mount.map(|m| m.mass)
            );
        }
    }
}

#[test]
fn a_heavy_inner_ring_is_a_bushing() {
    let fall = Fall::new(1e-5).spinning(500.0);
    let ([bushing, _], [heavy, _]) = (
        [fall.end::<f64>(0.05).0; 2],
        [fall.turning(1e6).end::<f64>(0.05).0; 2],
    );
    println!(
        "{:e} {:e}",
        apart(bushing.position, heavy.position),
        bushing.spin - heavy.spin
    );
}

fn balance<R: Precision>(fall: &Fall, time: f64) -> f64 {
    let (mut first, mut worst) = (None, 0.0_f64);
    fall.follow::<R>(time, |now: &Moment| {
        let ledger = &now.ledger;
        let first = *first.get_or_insert(ledger.total());
        let size = ledger.spin + ledger.heat + ledger.drag;
        worst = worst.max((ledger.total() - first).abs() / size);
    });
    worst
}

#[test]
fn the_energy_ledger_closes() {
    for (name, fall, _) in drops(1e-5) {
        println!(
            "{name}: f64 {:e}, f32 {:e}",
            balance::<f64>(&fall, 0.2),
            balance::<f32>(&fall, 0.2)
        );
    }
}

#[test]
fn single() {
    for (name, fall, time) in drops(1e-5) {
        let (wide, narrow) = (fall.end::<f64>(time), fall.end::<f32>(time));
        println!(
            "{name}: {:e} {:e} {:e} told {} {}",
            apart(wide.0.position, narrow.0.position) / 3e-4,
            apart(wide.0.velocity, narrow.0.velocity),
            wide.0.spin - narrow.0.spin,
            wide.1.len(),
            narrow.1.len()
        );
    }
}
