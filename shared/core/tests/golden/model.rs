//! Drops of every rung in f64 and f32, as text.

use std::fmt::Write;

use touchdown_models::{
    Contact, Coupled, CoupledConfig, Hertz, HertzConfig, Materials, ModeConfig, Moreau,
    MountConfig, Placement, RaceConfig, Scheme, StopConfig, Whole,
};
use touchdown_rotor::real::{Micro32, Poly32, Real};
use touchdown_rotor::{
    Change, Kinematics, ModelEvent, Precision, Rigid, RigidConfig, Start, Stepper,
};

/// Changes of a drop that are told one by one.
const TOLD: usize = 10;
/// The rig's unit of speed, sqrt(g rho0), m/s, and its surface speed, in it.
const SPEED: f64 = 0.054_249_4;
const SPIN: f64 = -1_389.8;
/// Steps of the rungs that go by steps, 20 us, and how many.
const STEP: f64 = 2e-5;
const STEPS: u64 = 4_000;

/// The rig of the source paper, SI.
const RIG: RigidConfig<f64> = RigidConfig {
    mass: 3.42,
    radius: 0.024,
    polar_inertia: 9.849_6e-4,
    clearance: 3e-4,
    friction: 0.1,
    restitution: 0.8,
    gravity: 9.81,
    speed: 0.05,
    step: 1e-4,
};

/// A drop from beside the centre.
const DROP: Start<f64> = Start::Free {
    position: [0.066_7, 0.0],
    velocity: [0.0, 0.0],
};

/// A start at the bottom of the wall with this speed, V.
fn at_bottom(tangential: f64) -> Start<f64> {
    Start::Wall {
        sin: 0.0,
        cos: 1.0,
        tangential,
    }
}

/// Every drop.
pub fn text() -> String {
    let mut text = String::from("Units of the model; time in steps.\n");
    rigid(&mut text);
    by_steps(&mut text);
    rings(&mut text);
    text
}

fn rigid(text: &mut String) {
    let slow = RigidConfig {
        friction: 0.15,
        ..RIG
    };
    let weightless = RigidConfig {
        gravity: 0.0,
        step: 1e-2,
        ..RIG
    };
    let low = at_bottom(0.095 / SPEED);
    let cases = [
        ("drop", RIG, DROP, SPIN, 3_000),
        ("slow spin", slow, DROP, SPIN / 100.0, 8_000),
        ("slow spin the other way", slow, DROP, -SPIN / 100.0, 8_000),
        ("spin used up over whole periods", slow, DROP, SPIN, 300_000),
        ("whirl", RIG, at_bottom(1.853), SPIN, 600),
        ("swing with the spin", RIG, low, SPIN, 2_000),
        ("lift-off", RIG, low, -SPIN, 1_500),
        (
            "whirl without weight",
            weightless,
            at_bottom(30.0),
            SPIN,
            100,
        ),
    ];
    for (name, config, start, spin, steps) in cases {
        let model = Rigid::<f64>::try_new(&config).expect("a valid machine");
        run::<f64, _>(
            text,
            &format!("rigid, f64: {name}"),
            &model,
            &start,
            spin,
            steps,
        );
        run::<f32, _>(
            text,
            &format!("rigid, f32: {name}"),
            &model.rounded(),
            &start.rounded(),
            spin,
            steps,
        );
    }
    let model = Rigid::<f64>::try_new(&RIG).expect("a valid machine");
    let (poly, micro) = (model.rounded::<Poly32>(), model.rounded::<Micro32>());
    run(
        text,
        "rigid, polynomials: drop",
        &poly,
        &DROP.rounded(),
        SPIN,
        3_000,
    );
    run(
        text,
        "rigid, micromath: drop",
        &micro,
        &DROP.rounded(),
        SPIN,
        3_000,
    );
}

fn by_steps(text: &mut String) {
    let fine = RigidConfig { step: STEP, ..RIG };
    let moreau = Moreau::<f64>::try_new(&fine).expect("a valid machine");
    let slow = RigidConfig {
        friction: 0.15,
        ..fine
    };
    let rolling = Moreau::<f64>::try_new(&slow).expect("a valid machine");
    run::<f64, _>(text, "moreau, f64: drop", &moreau, &DROP, SPIN, STEPS);
    run::<f64, _>(
        text,
        "moreau, f64: whirl",
        &moreau,
        &at_bottom(1.9),
        SPIN,
        1_000,
    );
    run::<f64, _>(
        text,
        "moreau, f64: slow spin",
        &rolling,
        &DROP,
        SPIN / 100.0,
        20_000,
    );
    let config = HertzConfig {
        rigid: RigidConfig { step: 1e-6, ..RIG },
        materials: Materials::steel(),
        contact: Contact::Point,
        fastest: 0.2,
    };
    let hertz = Hertz::<f64>::try_new(&config, Scheme::Verlet).expect("a valid machine");
    run::<f64, _>(text, "hertz, verlet: drop", &hertz, &DROP, SPIN, 20_000);
    let hertz = Hertz::<f64>::try_new(&config, Scheme::Euler).expect("a valid machine");
    run::<f64, _>(text, "hertz, euler: drop", &hertz, &DROP, SPIN, 20_000);
}

/// The rig in rigid rings at these places, SI.
fn rotor<const N: usize>(places: [f64; N]) -> CoupledConfig<N> {
    CoupledConfig {
        transverse_inertia: 0.0308,
        ..CoupledConfig::of_plane(&RigidConfig { step: STEP, ..RIG }, places)
    }
}

const MOUNT: MountConfig = MountConfig {
    mass: 0.5,
    stiffness: 2.6e6,
    damping: 320.0,
    vertical: None,
    friction: 0.0,
    stop: Some(StopConfig::rigid(5e-4)),
};
const RACE: RaceConfig = RaceConfig {
    inertia: 3e-5,
    dry_drag: 0.005,
    viscous_drag: 1e-5,
    cage_ratio: 0.44,
    heat_capacity: 50.0,
    heat_loss: 0.5,
};

/// Beside the centre, as [`DROP`].
const BESIDE: Placement<f64> = Placement {
    position: [0.066_7, 0.0],
    velocity: [0.0; 2],
    tilt: [0.0; 2],
    tilt_rate: [0.0; 2],
};

/// As [`at_bottom`].
fn low(tangential: f64) -> Placement<f64> {
    Placement {
        position: [0.0, -1.0],
        velocity: [tangential, 0.0],
        ..Placement::default()
    }
}

fn rings(text: &mut String) {
    let mut soft = rotor([0.0]);
    soft.rings[0].mount = Some(MOUNT);
    let mut drop = |name: &str, config: &CoupledConfig<1>, start, spin, steps| {
        let model = Coupled::<f64, 1, 1>::try_new(config).expect("a valid machine");
        run::<f64, _>(text, name, &Whole { model, start }, &DROP, spin, steps);
    };
    drop("support, sprung: drop", &soft, BESIDE, SPIN, STEPS);
    drop("support, sprung: whirl", &soft, low(2.2), SPIN, STEPS);
    let mut bearing = rotor([0.0]);
    bearing.rings[0].race = Some(RACE);
    let (slow, slower) = (SPIN / 10.0, SPIN / 200.0);
    drop("support, ball bearing: drop", &bearing, BESIDE, slow, STEPS);
    let spun_up = "support, ball bearing: spun up";
    drop(spun_up, &bearing, low(0.5), slower, 20_000);
    ends(text);
}

fn ends(text: &mut String) {
    let mut config = rotor([-0.12, 0.12]);
    config.unbalance.eccentricity = 3.2e-7;
    let model = Coupled::<f64, 2, 2>::try_new(&config).expect("a valid machine");
    let start = Placement {
        tilt: [0.0, 6e-4 / model.tilt_scale()],
        ..Placement::default()
    };
    let whole = Whole { model, start };
    run::<f64, _>(text, "two-plane: askew", &whole, &DROP, SPIN, STEPS);
    let whole = Whole {
        model: Coupled::<f32, 2, 2>::try_new(&config).expect("a valid machine"),
        start: start.rounded(),
    };
    let name = "two-plane, f32: askew";
    run::<f32, _>(text, name, &whole, &DROP.rounded(), SPIN, STEPS);
    for seat in &mut config.rings {
        (seat.mount, seat.race) = (Some(MOUNT), Some(RACE));
        seat.shape = [0.8, 0.0, 0.0];
    }
    config.modes[0] = Some(ModeConfig {
        speed: 600.0,
        damping_ratio: 0.01,
        mass: 1.5,
        centre: -0.6,
    });
    let model = Coupled::<f64, 2, 3>::try_new(&config).expect("a valid machine");
    let whole = Whole { model, start };
    run::<f64, _>(text, "coupled: askew", &whole, &DROP, SPIN, STEPS);
}

/// The first changes of motion, how many there were, and the end.
fn run<R: Precision, M: Stepper<R>>(
    text: &mut String,
    name: &str,
    model: &M,
    start: &Start<R>,
    spin: f64,
    steps: u64,
) {
    let (mut count, mut told) = (0, String::new());
    let mut sink = |happening: ModelEvent<R>| {
        count += 1;
        if count <= TOLD {
            writeln!(told, "  {}", line(&happening)).expect("a string");
        }
    };
    let state = model.start(start, R::lit(spin), &mut sink);
    let mut state = state.expect("a valid start");
    model.run(&mut state, steps, R::ZERO, &mut sink);
    let end = kinematics(&model.kinematics(&state));
    write!(text, "\n{name}\n{told}  {count} changes\n  end {end}\n").expect("a string");
}

fn line<R: Real>(happening: &ModelEvent<R>) -> String {
    let change = match &happening.change {
        Change::Impact { speed, .. } => format!("impact {}", number(*speed)),
        Change::Released(pulse) => format!(
            "released {} {} {}",
            number(pulse.peak_force),
            number(pulse.duration),
            number(pulse.impulse)
        ),
        other => format!("{other:?}"),
    };
    format!(
        "{}+{} {change} {}",
        happening.at.tick,
        number(happening.at.fraction),
        kinematics(&happening.after)
    )
}

fn kinematics<R: Real>(it: &Kinematics<R>) -> String {
    let ([x, y], [u, v]) = (it.position, it.velocity);
    let values = [x, y, u, v, it.spin].map(number).join(" ");
    format!(
        "{values} {:?} turns {} {}",
        it.touch,
        it.turns.0,
        number(it.turns.1)
    )
}

/// In as many digits as tell it from its neighbours.
fn number<R: Real>(value: R) -> String {
    if size_of::<R>() == size_of::<f32>() {
        (value.to_f64() as f32).to_string()
    } else {
        value.to_f64().to_string()
    }
}
