//! Rung `hertz`: force, duration and restitution of a contact against closed forms, the limit of
//! stability, and the built-in scenes.

use proptest::prelude::*;
use touchdown_base::history::Regime;
use touchdown_models::{
    Compliance, Contact, Hertz, HertzConfig, Materials, Scheme as ContactScheme, Shape,
};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Precision, Pulse, RigidConfig, Start, Stepper};
use touchdown_run::model::simulate;
use touchdown_scene::scales::compliance;
use touchdown_scene::{Fidelity, Scene, Scheme};
use touchdown_truth::reference::press::{Press, PressShape};
use touchdown_truth::reference::pulse::Meeting;

/// Speed after a fall through the gap of the rig, m/s.
const FALL: f64 = 0.076_720_271;
const MASS: f64 = 3.42;
const GAP: f64 = 0.3e-3;

/// The rig of the paper without gravity.
fn config(contact: Contact, restitution: f64, step: f64) -> HertzConfig {
    HertzConfig {
        rigid: RigidConfig {
            mass: MASS,
            radius: 0.024,
            polar_inertia: 0.5 * MASS * 0.024 * 0.024,
            clearance: GAP,
            friction: 0.0,
            restitution,
            gravity: 0.0,
            speed: FALL,
            step,
        },
        materials: Materials::steel(),
        contact,
        fastest: FALL,
    }
}

/// A straight impact, SI.
#[derive(Clone, Copy, Debug)]
struct Hit {
    restitution: f64,
    peak_force: f64,
    duration: f64,
    impulse: f64,
    exceeded: u32,
}

/// The first impact at `speed` (in units of the fastest), released a part of a step away from the
/// wall.
fn hit<R: Precision>(config: &HertzConfig, scheme: ContactScheme, speed: f64, phase: f64) -> Hit {
    let (_, scales) = config.rigid.scaled().expect("valid configuration");
    let model = Hertz::<R>::try_new(config, scheme).expect("valid configuration");
    let step = config.rigid.step / scales.time;
    let path = step * speed;
    let whole = (1.0 / path).floor().min(20.0);
    let start = Start::Free {
        position: [R::ZERO, R::lit(-1.0 + (phase + whole) * path)],
        velocity: [R::ZERO, R::lit(-speed)],
    };
    let mut state = model.start(&start, R::ZERO, |_| {}).expect("valid start");
    let mut pulse: Option<(Pulse<R>, f64)> = None;
    let mut entry = 0.0;
    for _ in 0..10_000_000 {
        model.step(&mut state, |h| match h.change {
            Change::Impact { speed: normal, .. } => entry = normal.to_f64(),
            Change::Released(p) => pulse = Some((p, h.after.velocity[1].to_f64())),
            _ => panic!("{:?}", h.change),
        });
        if pulse.is_some() {
            break;
        }
    }
    let (pulse, launch) = pulse.expect("leaves the wall");
    Hit {
        restitution: launch / entry,
        peak_force: pulse.peak_force.to_f64() * config.rigid.mass * scales.speed / scales.time,
        duration: pulse.duration.to_f64() * scales.time,
        impulse: pulse.impulse.to_f64() * config.rigid.mass * scales.speed,
        exceeded: state.exceeded(),
    }
}

fn near(name: &str, found: f64, want: f64, tolerance: f64) {
    let off = found / want - 1.0;
    println!("{name}: {found:.6e}, {off:+.1e} of {want:.6e}");
    assert!(off.abs() <= tolerance, "{name}: {found:e}, not {want:e}");
}

/// F0 = 0.81145 (V^6 m^3 r E_r^2/(1 - r/R))^(1/5), T_c = 4.53398 (m^2 (1 - r/R)/(V r E_r^2))^(1/5).
#[test]
fn a_point_contact_has_the_force_and_duration_of_hertz() {
    let (radius, modulus) = (0.024_f64, 3.625e11_f64);
    let gap = 1.0 - radius / (radius + GAP);
    for speed in [1.0, 0.3, 0.01] {
        let v = speed * FALL;
        let force = (v.powi(6) * MASS.powi(3) * radius * modulus * modulus / gap).powf(0.2);
        let force = 0.81145 * force;
        let time = 4.53398 * (MASS * MASS * gap / (v * radius * modulus * modulus)).powf(0.2);
        let config = config(Contact::Point, 1.0, 0.26e-3 / 2000.0);
        let both = [
            (
                "euler",
                hit::<f64>(&config, ContactScheme::Euler, speed, 0.5),
            ),
            (
                "verlet",
                hit::<f64>(&config, ContactScheme::Verlet, speed, 0.5),
            ),
            (
                "euler, f32",
                hit::<f32>(&config, ContactScheme::Euler, speed, 0.5),
            ),
            (
                "verlet, f32",
                hit::<f32>(&config, ContactScheme::Verlet, speed, 0.5),
            ),
        ];
        for (name, hit) in both {
            println!("{name} at {v:.4} m/s");
            near("force, N", hit.peak_force, force, 2e-4);
            near("contact time, s", hit.duration, time, 2e-4);
            near("impulse, N s", hit.impulse, 2.0 * MASS * v, 2e-5);
            let product = hit.peak_force * hit.duration / (MASS * v);
            near("F0 T_c/(m V)", product, 3.6791, 2e-4);
        }
    }
    let compliance = config(Contact::Point, 1.0, 1e-6).compliance().expect("valid");
    near("its own force, N", compliance.peak_force, 3741.0, 1e-3);
}

/// Half a period of a spring: pi sqrt(m/K), and V sqrt(K m).
#[test]
fn a_line_contact_by_the_power_law_is_a_spring() {
    let shape = Contact::LinePower { length: 0.02 };
    let stiffness = config(shape, 1.0, 1e-6)
        .compliance()
        .expect("valid")
        .stiffness;
    let time = std::f64::consts::PI * (MASS / stiffness).sqrt();
    for speed in [1.0, 0.1] {
        let config = config(shape, 1.0, time / 2000.0);
        for hit in [
            hit::<f64>(&config, ContactScheme::Euler, speed, 0.5),
            hit::<f64>(&config, ContactScheme::Verlet, speed, 0.5),
            hit::<f32>(&config, ContactScheme::Euler, speed, 0.5),
            hit::<f32>(&config, ContactScheme::Verlet, speed, 0.5),
        ] {
            let force = speed * FALL * (stiffness * MASS).sqrt();
            near("force, N", hit.peak_force, force, 2e-4);
            near("contact time, s", hit.duration, time, 2e-4);
        }
    }
}

/// pi E* L of 20 mm, steel on steel, N/m.
const PLANE: f64 = std::f64::consts::PI * 210e9 / (2.0 * 0.91) * 0.02;

/// Johnson's, at the force f in N, m.
fn approach(f: f64) -> f64 {
    f / PLANE * ((4.0 * PLANE * GAP / f).ln() - 1.0)
}

#[test]
fn a_line_contact_inverts_the_logarithm() {
    let most = 4.0 * PLANE * GAP * (-2.0_f64).exp();
    for part in [1e-12, 1e-9, 1e-6, 1e-3, 0.03, 0.3, 0.9, 0.999] {
        let force = part * most;
        let depth = approach(force) / GAP;
        let [double, single] = [Shape::Line.power(depth, 1.0), f64::from(Shape::Line.power(depth as f32, 1.0))].map(|it| it * PLANE * GAP);
        println!("{part}: {:.1e}, {:.1e}", double / force - 1.0, single / force - 1.0);
        // The depth hardly rises near the end of the law: its digits give few of the force.
        let steep = 1.0 / (depth * PLANE * GAP / force - 1.0);
        near("f64", double, force, 4.0 * (1.0 + steep) * f64::EPSILON);
        near("f32", single, force, 4.0 * (1.0 + steep) * f64::from(f32::EPSILON));
        near("and back", Shape::Line.depth(double / PLANE, GAP), depth * GAP, 1e-14);
    }
    assert_eq!([Shape::Line.power(0.0, 1.0), Shape::Line.power(0.9, 1.0)], [0.0, 0.9]);
}

/// Its peak has the energy F^2/(2 K) (ln(4 K c/F) - 3/2) = m V^2/2, its duration is that of the reference's pulse.
#[test]
fn a_line_contact_stops_the_rotor_by_the_logarithm() {
    for speed in [1.0, 0.076_720_271, 0.005] {
        let energy = |f: f64| 0.5 * f * f / PLANE * ((4.0 * PLANE * GAP / f).ln() - 1.5);
        let (mut low, mut high) = (0.0, 0.3 * PLANE * GAP);
        for _ in 0..100 {
            let f = 0.5 * (low + high);
            *(if energy(f) < 0.5 * MASS * speed * speed { &mut low } else { &mut high }) = f;
        }
        let press = Press { shape: PressShape::Line { clearance: GAP }, stiffness: PLANE, balls: None, slowest: 0.0 };
        let pulse = Meeting { mass: MASS, speed, restitution: 1.0, press, gravity: 0.0 }.pulse();
        near("the reference's force, N", pulse.peak_force, high, 1e-6);
        let shape = Contact::Line { length: 0.02 };
        let of = |step| HertzConfig { fastest: speed, ..config(shape, 1.0, step) };
        let compliance = of(1e-6).compliance().expect("valid");
        near("peak force, N", compliance.peak_force, high, 1e-12);
        near("duration, s", compliance.contact_time, pulse.duration, 1e-5);
        let fine = of(compliance.contact_time / 2000.0);
        for hit in [
            hit::<f64>(&fine, ContactScheme::Euler, speed / FALL, 0.5),
            hit::<f64>(&fine, ContactScheme::Verlet, speed / FALL, 0.5),
            hit::<f32>(&fine, ContactScheme::Verlet, speed / FALL, 0.5),
        ] {
            near("force, N", hit.peak_force, high, 2e-4);
            near("contact time, s", hit.duration, pulse.duration, 2e-4);
        }
        let secant = config(Contact::LinePower { length: 0.02 }, 1.0, 1e-6).compliance().expect("valid");
        let spring = speed * (secant.stiffness * MASS).sqrt();
        println!("{speed} m/s: a spring, secant at {FALL:.4} m/s, has {:+.1} %", 1e2 * (spring / high - 1.0));
    }
}

/// The secant agrees with Johnson's logarithm at the peak force, and is stiffer below it.
#[test]
fn the_power_law_of_a_line_is_the_secant_of_the_logarithm() {
    let shape = Contact::LinePower { length: 0.02 };
    let compliance = config(shape, 1.0, 1e-6).compliance().expect("valid");
    let peak = compliance.peak_force;
    near("depth, m", compliance.deepest, approach(peak), 1e-9);
    let below = approach(0.1 * peak) / (0.1 * peak / compliance.stiffness);
    near("log over linear at a tenth of the force", below, 1.36, 0.02);
    let short = config(Contact::Line { length: 1e-7 }, 1.0, 1e-6).compliance();
    assert!(
        matches!(short, Err(ConfigError::OutOfRange("length", _))),
        "{short:?}"
    );
}

#[test]
fn restitution_is_what_was_asked_for() {
    let time = |c: Result<Compliance, _>| c.expect("valid").contact_time;
    let (point, line) = (
        time(config(Contact::Point, 1.0, 1e-6).compliance()),
        time(config(Contact::Line { length: 0.02 }, 1.0, 1e-6).compliance()),
    );
    for (parts, tolerance) in [(1000.0, 1e-4), (100.0, 1e-3), (25.0, 5e-3)] {
        let mut worst = 0.0_f64;
        for asked in [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 0.99] {
            for speed in [1.0, 0.3, 0.1, 0.01] {
                for phase in [0.05, 0.5, 0.8] {
                    let a = config(Contact::Point, asked, point / parts);
                    let b = config(Contact::Line { length: 0.02 }, asked, line / parts);
                    for hit in [
                        hit::<f64>(&a, ContactScheme::Euler, speed, phase),
                        hit::<f64>(&a, ContactScheme::Verlet, speed, phase),
                        hit::<f32>(&a, ContactScheme::Euler, speed, phase),
                        hit::<f64>(&b, ContactScheme::Euler, speed, phase),
                        hit::<f64>(&b, ContactScheme::Verlet, speed, phase),
                    ] {
                        worst = worst.max((hit.restitution / asked - 1.0).abs());
                        assert_eq!(hit.exceeded, 0);
                    }
                }
            }
        }
        println!("T_c/{parts}: {worst:.1e} of {tolerance:.0e}");
        assert!(worst <= tolerance, "T_c/{parts}: {worst:e}");
    }
    // Below the floor the rotor creeps out at the floor.
    let hit = hit::<f64>(&config(Contact::Point, 0.0, 1e-7), ContactScheme::Euler, 1.0, 0.5);
    near("restitution for 0", hit.restitution, 0.02, 5e-3);
}

/// The plain scheme at `step`, without the model's guard: launch speed over entry speed, worst of
/// many phases.
fn unguarded(compliance: &Compliance, step: f64) -> f64 {
    (0..200).fold(0.0, |worst, phase| {
        let mut depth = f64::from(phase) / 200.0 * step * FALL;
        let mut speed = FALL;
        while depth > 0.0 {
            speed -= step * compliance.stiffness * depth * depth.sqrt() / MASS;
            depth += step * speed;
            if depth == 0.0 {
                break;
            }
        }
        f64::max(worst, -speed / FALL)
    })
}

#[test]
fn a_step_above_the_limit_is_refused_and_would_blow_up() {
    let compliance = config(Contact::Point, 1.0, 1e-6).compliance().expect("valid");
    let limit = compliance.longest_step();
    near("limit, s", limit, 128e-6, 2e-3);
    let build = |step| Hertz::<f64>::try_new(&config(Contact::Point, 1.0, step), ContactScheme::Euler);
    assert!(build(0.999 * limit).is_ok());
    assert!(matches!(
        build(1.001 * limit),
        Err(ConfigError::OutOfRange("step", _))
    ));
    let gain = |factor: f64| unguarded(&compliance, factor * limit);
    for factor in [0.08, 0.5, 1.0, 1.2, 1.5, 2.0] {
        println!("{factor} of the limit: {:.3} of the speed", gain(factor));
    }
    assert!(
        gain(0.08) < 1.01 && gain(1.5) > 1.5,
        "{} {}",
        gain(0.08),
        gain(1.5)
    );
}

/// Faster than the fastest impact expected: the impact law takes over where the step is too long.
#[test]
fn an_impact_beyond_expectation_gains_nothing() {
    for restitution in [1.0, 0.8, 0.2] {
        let config = config(Contact::Point, restitution, 0.9 * 128e-6);
        let mut exceeded = 0;
        for speed in [3.0, 10.0, 30.0] {
            for phase in [0.1, 0.4, 0.7] {
                let hit = hit::<f64>(&config, ContactScheme::Euler, speed, phase);
                assert!(hit.restitution <= 1.1 && hit.restitution > 0.0, "{hit:?}");
                exceeded += hit.exceeded;
            }
        }
        assert!(exceeded > 0);
    }
}

#[test]
fn built_in_scenes_end_as_with_the_rigid_rung() {
    for (name, regime) in [
        ("rig", Regime::Pendulum),
        ("rig-wide-gap", Regime::Pendulum),
        ("backward-whirl", Regime::BackwardWhirl),
        ("rolling", Regime::Pendulum),
        ("lift-off", Regime::BackwardWhirl),
    ] {
        let rigid = simulate(&Scene::load(name).expect("built in")).expect("valid");
        for scheme in [Scheme::Euler, Scheme::Verlet] {
            for precision in [
                touchdown_scene::Precision::F64,
                touchdown_scene::Precision::F32,
            ] {
                let mut scene = Scene::load(name).expect("built in");
                scene.model.rung = Fidelity::Hertz;
                scene.model.scheme = scheme;
                scene.model.precision = precision;
                scene.model.step = compliance(&scene).expect("valid").contact_time / 50.0;
                let found = simulate(&scene).expect("valid");
                assert_eq!(found.regime, regime, "{name}");
                assert_eq!(found.lift_offs.len(), rigid.lift_offs.len(), "{name}");
                let released = found.impacts.iter().filter(|impact| impact.pulse.is_some());
                println!(
                    "{name} {scheme:?}: {} impacts, {} of {} permanent",
                    found.impacts.len(),
                    released.count(),
                    found.contact_starts.len()
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None,
                                        rng_seed: prop::test_runner::RngSeed::Fixed(1),
                                        ..ProptestConfig::default() })]

    /// Friction to 100, spin to 1e6 rpm either way, whirl far beyond the fastest impact expected.
    #[test]
    fn everything_stays_finite(
        friction in prop_oneof![Just(0.0), 0.0..2.0_f64, 0.0..100.0_f64],
        restitution in prop_oneof![Just(0.0), Just(1.0), Just(0.99), 0.0..1.0_f64],
        spin in prop_oneof![Just(0.0), -1e4..1e4_f64, -5e4..5e4_f64],
        gravity in prop::bool::weighted(0.8),
        part in prop_oneof![Just(0.08), Just(0.5), Just(0.999)],
        angle in 0.0..std::f64::consts::TAU,
        speed in -50.0..50.0_f64,
        wall in any::<bool>(),
    ) {
        let motion = (friction, spin, if gravity { 9.81 } else { 0.0 });
        finite(config(Contact::Point, restitution, 1e-6), motion, part, angle, speed, wall)?;
        finite(config(Contact::Line { length: 0.02 }, restitution, 1e-6), motion, part, angle, speed, wall)?;
    }
}

fn finite(
    mut config: HertzConfig,
    (friction, spin, gravity): (f64, f64, f64),
    part: f64,
    angle: f64,
    speed: f64,
    wall: bool,
) -> Result<(), TestCaseError> {
    config.rigid.friction = friction;
    config.rigid.gravity = gravity;
    config.rigid.step = part * config.compliance().expect("valid").longest_step();
    let model = Hertz::<f32>::try_new(&config, ContactScheme::Euler).expect("valid");
    let (sin, cos) = (angle.sin() as f32, angle.cos() as f32);
    let start = if wall {
        Start::Wall { sin, cos, tangential: speed as f32 }
    } else {
        Start::Free { position: [0.9 * sin, -0.9 * cos], velocity: [speed as f32, 0.0] }
    };
    let mut state = model.start(&start, spin as f32, |_| {}).expect("valid");
    let mut changes = 0;
    for _ in 0..5000 {
        model.step(&mut state, |_| changes += 1);
        let k = model.kinematics(&state);
        let [x, y] = k.position;
        let [u, v] = k.velocity;
        prop_assert!(x.is_finite() && y.is_finite() && u.is_finite() && v.is_finite());
        // Spin can be turned into whirl of a third of its surface speed.
        let most = 1e3 + speed.abs() + spin.abs();
        prop_assert!(f64::from(u.hypot(v)) <= most, "{u} {v}");
        prop_assert!(f64::from(x.hypot(y)) <= 2.0 + most, "{x} {y}");
    }
    prop_assert!(changes <= 15_000, "{changes}");
    Ok(())
}
