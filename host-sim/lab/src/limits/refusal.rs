//! Numbers that no machine has are refused, and by name.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Precision as Number, Rigid, RigidConfig, Start};

use crate::limits::row::Row;
use touchdown_scene::Precision;

/// NaN and infinities in each place, and a start outside the gap.
pub fn rows() -> Result<Vec<Row>, ConfigError> {
    let mut rows = in_numbers::<f64>(Precision::F64, [f64::NAN, f64::INFINITY, f64::NEG_INFINITY])?;
    rows.extend(in_numbers::<f32>(
        Precision::F32,
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY],
    )?);
    Ok(rows)
}

fn in_numbers<R: Number>(precision: Precision, bad: [R; 3]) -> Result<Vec<Row>, ConfigError> {
    let good = good::<R>();
    let model = Rigid::try_new(&good)?;
    let (mut configs, mut starts) = (0, 0);
    for value in bad {
        for set in numbers() {
            let mut config = good;
            set(&mut config, value);
            configs += u32::from(Rigid::try_new(&config).is_ok());
        }
        for start in bad_starts(value) {
            starts += u32::from(model.start(&start, R::ONE, |_| ()).is_ok());
        }
        let centre = free([R::ZERO; 2], [R::ZERO; 2]);
        starts += u32::from(model.start(&centre, value, |_| ()).is_ok());
    }
    let outside = free([R::ONE, R::ONE], [R::ZERO; 2]);
    let outside = u32::from(model.start(&outside, R::ONE, |_| ()).is_ok());
    let row = |extreme, accepted: u32| {
        Row::of(extreme, precision).at_most(f64::from(accepted), 0.0, "inputs")
    };
    let machine = "NaN and infinity in each number of the machine: accepted";
    let start = "NaN and infinity in each number of the start: accepted";
    Ok(vec![
        row(machine, configs),
        row(start, starts),
        row("start outside the gap: accepted", outside),
    ])
}

fn good<R: Number>() -> RigidConfig<R> {
    RigidConfig {
        mass: R::ONE,
        radius: R::ONE,
        polar_inertia: R::HALF,
        clearance: R::ONE,
        friction: R::HALF,
        restitution: R::HALF,
        gravity: R::ONE,
        speed: R::ONE,
        step: R::HALF,
    }
}

/// Sets each number of the machine in turn.
fn numbers<R: Number>() -> [fn(&mut RigidConfig<R>, R); 9] {
    [
        |it, value| it.mass = value,
        |it, value| it.radius = value,
        |it, value| it.polar_inertia = value,
        |it, value| it.clearance = value,
        |it, value| it.friction = value,
        |it, value| it.restitution = value,
        |it, value| it.gravity = value,
        |it, value| it.step = value,
        // Used where there is no gravity only.
        |it, value| (it.speed, it.gravity) = (value, R::ZERO),
    ]
}

fn bad_starts<R: Number>(value: R) -> [Start<R>; 7] {
    let wall = |sin, cos, tangential| Start::Wall {
        sin,
        cos,
        tangential,
    };
    [
        free([value, R::ZERO], [R::ZERO; 2]),
        free([R::ZERO, value], [R::ZERO; 2]),
        free([R::ZERO; 2], [value, R::ZERO]),
        free([R::ZERO; 2], [R::ZERO, value]),
        wall(value, R::ONE, R::ZERO),
        wall(R::ZERO, value, R::ZERO),
        wall(R::ZERO, R::ONE, value),
    ]
}

fn free<R>(position: [R; 2], velocity: [R; 2]) -> Start<R> {
    Start::Free { position, velocity }
}
