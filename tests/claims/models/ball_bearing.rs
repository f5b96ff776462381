//! The inner ring of a ball bearing under a rotor, against closed forms: spin-up, drag, heat.

use touchdown_rotor::{Change, Touch};
use touchdown_tests::moment::Moment;
use touchdown_tests::ring_scenes::Fall;

const INERTIA: f64 = 2e-5;
const SPIN: f64 = 500.0;

/// A rotor in a fixed ring where friction and weight balance: it slides without moving, at a constant
/// force.
fn balanced(step: f64) -> (Fall, f64) {
    let fall = Fall::new(step).turning(INERTIA).spinning(SPIN);
    let lean = fall.rigid.friction.atan();
    let force = fall.rigid.mass * fall.rigid.gravity * lean.cos();
    (fall.on_wall(-lean, 0.0), force)
}

/// Slip at the start, and its rate (both of surfaces).
fn slip(fall: &Fall, force: f64) -> (f64, f64) {
    let (rotor, bore) = (&fall.rigid, fall.bore());
    let (inner, outer) = (rotor.radius, bore);
    let rate = inner * inner / rotor.polar_inertia + outer * outer / INERTIA;
    (inner * fall.spin, rotor.friction * force * rate)
}

/// W_i = mu N R t/J_i, the rotor loses mu N r t/J, and the slip ends after s0/(mu N (r^2/J + R^2/J_i)).
#[test]
fn the_inner_ring_spins_up_by_a_constant_force_until_the_slip_ends() {
    let (fall, force) = balanced(1e-5);
    let friction = fall.rigid.friction * force;
    let (start, rate) = slip(&fall, force);
    let until = start / rate;
    let (mut worst, mut common) = (0.0_f64, None);
    let told = fall.follow::<f64>(1.001 * until, |now| {
        if now.time < until {
            let race = friction * fall.bore() * now.time / INERTIA;
            let lost = friction * fall.rigid.radius * now.time / fall.rigid.polar_inertia;
            worst = worst.max((now.race[0] - race).abs() / SPIN);
            worst = worst.max((now.spin - (SPIN - lost)).abs() / SPIN);
            assert!((now.race[1] - 0.4 * now.race[0]).abs() < 1e-12, "the cage");
            common = Some(*now);
        }
    });
    let common: Moment = common.expect("the start");
    println!("spin-up: {until:.4} s, error {worst:.1e} of the spin");
    assert!(worst < 1e-11, "{worst}");
    let rolls = told.iter().find(|t| t.1 == Change::RollingStarts);
    let late = rolls.expect("the end of the slip").0 - until;
    assert!((0.0..=1e-5).contains(&late), "{late}");
    let surfaces = [
        fall.rigid.radius * common.spin,
        fall.bore() * common.race[0],
    ];
    assert!(
        (surfaces[0] / surfaces[1] - 1.0).abs() < 1e-3,
        "{surfaces:?}"
    );
}

/// mu N (s0 t - s' t^2/2) is the heat, and over the heat capacity the temperature. Of second order in
/// the drag's time, which there is none of: exact but for rounding.
#[test]
fn friction_heats_the_bearing() {
    let (fall, force) = balanced(1e-5);
    let (start, rate) = slip(&fall, force);
    let time = 0.8 * start / rate;
    let (end, _) = fall.end::<f64>(time);
    let heat = fall.rigid.friction * force * end.time * (start - 0.5 * rate * end.time);
    let capacity = fall.race.expect("a bearing").heat_capacity;
    println!("{heat:.3} J, {:.4} K", end.race[2]);
    assert!((end.energy.heat / heat - 1.0).abs() < 1e-10, "{end:?}");
    assert!(
        (end.race[2] * capacity / heat - 1.0).abs() < 1e-10,
        "{end:?}"
    );
}

/// J w/r + J_i W_i/R, through impacts, sliding and rolling alike.
#[test]
fn angular_momentum_by_the_radii_is_kept_without_drag() {
    let mut fall = Fall::new(2e-5).mounted(1.0, 1e7, 500.0).turning(INERTIA);
    fall.rigid.restitution = 0.4;
    let fall = fall.spinning(SPIN);
    let momentum = |now: &Moment| {
        let rotor = fall.rigid.polar_inertia * now.spin / fall.rigid.radius;
        rotor + INERTIA * now.race[0] / fall.bore()
    };
    let (mut first, mut worst, mut rolled) = (None, 0.0_f64, false);
    fall.follow::<f64>(0.1, |now| {
        let first = *first.get_or_insert(momentum(now));
        worst = worst.max((momentum(now) / first - 1.0).abs());
        rolled |= now.touch == Touch::Rolling;
    });
    assert!(rolled);
    assert!(worst < 1e-14, "{worst}");
}

/// A rotor that hits once and leaves slowly: the inner ring turns alone, from when it does.
fn alone(step: f64, dry: f64, viscous: f64, cooling: f64) -> Vec<Moment> {
    let mut fall = Fall::new(step).turning(INERTIA).dragged(dry, viscous);
    fall.rigid.gravity = 0.0;
    fall.rigid.restitution = 0.01;
    fall.rigid.friction = 2e-3;
    fall.race = fall.race.map(|mut race| {
        race.heat_capacity = 1.0;
        race.heat_loss = cooling;
        race
    });
    let fall = fall.free([0.0; 2], [0.0, -0.05]).spinning(SPIN);
    let mut moments = Vec::new();
    let told = fall.follow::<f64>(0.2, |now| moments.push(*now));
    assert_eq!(told.len(), 1, "{told:?}");
    let hit = told[0].0;
    moments.retain(|now| now.time > hit + step);
    moments
}

/// W = (W_0 + c_0/c_1) exp(-c_1 t/J_i) - c_0/c_1 until it stops, and rests.
#[test]
fn drag_slows_the_inner_ring_as_its_closed_form() {
    for (dry, viscous) in [(0.0, 1e-3), (2e-4, 0.0), (2e-4, 1e-3)] {
        let errors = [4e-4, 2e-4].map(|step| {
            let moments = alone(step, dry, viscous, 0.0);
            let (begin, first) = (moments[0].time, moments[0].race[0]);
            let mut worst = 0.0_f64;
            for now in &moments {
                let time = now.time - begin;
                let speed = if viscous > 0.0 {
                    let rest = dry / viscous;
                    (first + rest) * (-viscous * time / INERTIA).exp() - rest
                } else {
                    first - dry * time / INERTIA
                };
                worst = worst.max((now.race[0] - speed.max(0.0)).abs() / first);
            }
            let drag: f64 = moments.last().expect("some").energy.drag - moments[0].energy.drag;
            let energy = 0.5 * INERTIA * first * first;
            let left = moments.last().expect("some").race[0] / first;
            assert!(
                (drag / energy - (1.0 - left * left)).abs() < 1e-12,
                "{drag}"
            );
            if dry > 0.0 {
                assert_eq!(left, 0.0);
            }
            worst
        });
        println!("{dry} N m, {viscous} N m s: {errors:?}");
        // Of second order; without viscous drag the speed falls in a line but for the step it stops in.
        assert!(errors[1] < 1e-5, "{errors:?}");
        if dry == 0.0 {
            assert!((errors[0] / errors[1] - 4.0).abs() < 0.3, "{errors:?}");
        }
    }
}

#[test]
fn the_bearing_cools_exponentially() {
    let errors = [4e-4, 2e-4].map(|step| {
        let moments = alone(step, 0.0, 0.0, 10.0);
        let (begin, first) = (moments[0].time, moments[0].race[2]);
        assert!(first > 0.0);
        let errors = moments.iter().map(|now| {
            let left = (-10.0 * (now.time - begin)).exp();
            (now.race[2] / first - left).abs()
        });
        errors.fold(0.0, f64::max)
    });
    println!("cooling: {errors:?}");
    assert!(errors[1] < 3e-7, "{errors:?}");
    assert!((errors[0] / errors[1] - 4.0).abs() < 0.3, "{errors:?}");
}
