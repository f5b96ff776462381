//! The drop as an ordinary differential equation, by `ode_solvers`: Kelvin-Voigt contact without
//! tension, regularised friction.
//!
//! Arguments: variant, stiffness (N/m), damping (N s/m), method (`rk4`, `dopri5`), its step (s) or
//! relative tolerance, duration (s), interval of the samples (s), file for them, repeats.

use std::env;

use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dopri5, Rk4, SVector, System};
use serde_json::json;
use touchdown_peers::{Sample, answer, contact, median_time, write_samples};

/// kg.
const MASS: f64 = 3.42;
/// m.
const RADIUS: f64 = 0.024;
/// m.
const CLEARANCE: f64 = 3e-4;
/// m/s^2.
const GRAVITY: f64 = 9.81;
/// rad/s.
const SPIN: f64 = 3141.6;
/// Slip at which friction has reached 76 % of its value, m/s.
const FRICTION_SPEED: f64 = 0.05;
/// Absolute tolerance over the relative one: the size of the smallest motions that matter, m and m/s.
const ABSOLUTE: f64 = 1e-4;

/// x, y, vx, vy, spin.
type State = SVector<f64, 5>;

#[derive(Clone, Copy)]
struct Rotor {
    friction: f64,
    stiffness: f64,
    damping: f64,
}

impl System<f64, State> for Rotor {
    fn system(&self, _: f64, s: &State, rate: &mut State) {
        let (mut ax, mut ay, mut spin_up) = (0.0, -GRAVITY, 0.0);
        let distance = s[0].hypot(s[1]);
        if distance > CLEARANCE {
            let (nx, ny) = (s[0] / distance, s[1] / distance);
            let into = s[2] * nx + s[3] * ny;
            let force = (self.stiffness * (distance - CLEARANCE) + self.damping * into).max(0.0);
            let slip = s[3] * nx - s[2] * ny + RADIUS * s[4];
            let rub = -self.friction * force * (slip / FRICTION_SPEED).tanh();
            ax -= (force * nx + rub * ny) / MASS;
            ay -= (force * ny - rub * nx) / MASS;
            spin_up = rub * RADIUS / (0.5 * MASS * RADIUS * RADIUS);
        }
        *rate = State::from([s[2], s[3], ax, ay, spin_up]);
    }
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [
        variant,
        stiffness,
        damping,
        method,
        setting,
        duration,
        every,
        file,
        repeats,
    ] = arguments.as_slice()
    else {
        panic!("nine arguments");
    };
    let number = |text: &String| -> f64 { text.parse().expect("a number") };
    let rotor = Rotor {
        friction: contact(variant).0,
        stiffness: number(stiffness),
        damping: number(damping),
    };
    let start = State::from([0.0, 0.0, 0.0, 0.0, SPIN]);
    let (setting, duration, every) = (number(setting), number(duration), number(every));
    let repeats: usize = repeats.parse().expect("a count");
    let dopri5 = |every: f64, output| {
        let (rtol, atol) = (setting, setting * ABSOLUTE);
        Dopri5::from_param(
            rotor,
            0.0,
            duration,
            every,
            start,
            rtol,
            atol,
            0.9,
            0.04,
            0.2,
            10.0,
            1e-3,
            0.0,
            u32::MAX,
            1000,
            output,
        )
    };
    let (times, states, steps, time);
    match method.as_str() {
        "rk4" => {
            let solver = || Rk4::new(rotor, 0.0, start, duration, setting);
            let mut seen = solver();
            steps = seen.integrate().expect("integrates").accepted_steps;
            (times, states) = (seen.x_out().clone(), seen.y_out().clone());
            time = median_time(repeats, || {
                solver().integrate().expect("integrates");
            });
        }
        "dopri5" => {
            let mut seen = dopri5(every, OutputType::Dense);
            let stats = seen.integrate().expect("integrates");
            steps = stats.accepted_steps + stats.rejected_steps;
            (times, states) = (seen.x_out().clone(), seen.y_out().clone());
            time = median_time(repeats, || {
                let mut solver = dopri5(every, OutputType::Sparse);
                solver.integrate().expect("integrates");
            });
        }
        _ => panic!("unknown method {method}"),
    }
    let samples: Vec<Sample> = times
        .iter()
        .zip(&states)
        .map(|(&t, s)| [t, s[0], s[1], s[2], s[3]])
        .collect();
    write_samples(file, &samples).expect("a file");
    answer(&json!({ "cpu_s": time, "steps": steps }));
}
