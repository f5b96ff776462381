//! Any configuration is refused, or gives a model that stays finite and in the gap, gains no energy, and
//! takes a bounded number of changes a step. Scaled numbers, so that nothing is out of reach.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use touchdown_rotor::{Kinematics, Precision, Rigid, RigidConfig, Start};

/// Steps of each input.
const STEPS: u32 = 8;
/// Most happenings a step: of each impact itself and the contact that may follow, and of each stretch
/// of contact its end.
const MOST_HAPPENINGS: u32 = 2 * 768 + 256;

/// Most energy gained by each happening of a step, and one more, in parts of all energy and in units of
/// epsilon.
const MOST_GAINED: f64 = 64.0;
/// The same by all stretches of contact of a step: a digit each.
const STRETCHES: f64 = 256.0;

/// A number of the range of a scene file: a logarithm and a sign, or one of the ends.
#[derive(Arbitrary, Clone, Copy, Debug)]
struct Number {
    exponent: u16,
    shape: u8,
}

impl Number {
    /// Logarithmic between `low` and `high`.
    fn between(self, low: f64, high: f64) -> f64 {
        let part = f64::from(self.exponent) / f64::from(u16::MAX);
        match self.shape % 8 {
            0 => low,
            1 => high,
            _ => (low.ln() + part * (high / low).ln()).exp().clamp(low, high),
        }
    }

    /// Either sign, or 0.
    fn signed(self, low: f64, high: f64) -> f64 {
        match self.shape / 8 % 4 {
            0 => 0.0,
            1 => -self.between(low, high),
            _ => self.between(low, high),
        }
    }

    /// 0, 1, or between them, close to either end as well.
    fn part(self) -> f64 {
        match self.shape / 32 {
            0 => 0.0,
            1 => 1.0,
            2 | 3 => 1.0 - self.between(1e-9, 1.0),
            _ => self.between(1e-9, 1.0),
        }
    }
}

#[derive(Arbitrary, Debug)]
struct Input {
    inertia: Number,
    friction: Number,
    restitution: Number,
    weightless: bool,
    step: Number,
    spin: Number,
    on_wall: bool,
    distance: Number,
    angle: f32,
    velocity: [Number; 2],
}

impl Input {
    fn config<R: Precision>(&self) -> RigidConfig<R> {
        RigidConfig {
            mass: R::ONE,
            radius: R::ONE,
            polar_inertia: R::lit(self.inertia.between(5e-4, 500.0)),
            clearance: R::ONE,
            friction: R::lit(self.friction.signed(1e-9, 100.0).abs()),
            restitution: R::lit(self.restitution.part()),
            gravity: if self.weightless { R::ZERO } else { R::ONE },
            speed: R::ONE,
            step: R::lit(self.step.between(1e-7, 1e3)),
        }
    }

    fn start<R: Precision>(&self) -> Start<R> {
        let (sin, cos) = f64::from(self.angle % 7.0).sin_cos();
        let [u, v] = self.velocity.map(|speed| speed.signed(1e-12, 1e6));
        if self.on_wall {
            return Start::Wall {
                sin: R::lit(sin),
                cos: R::lit(cos),
                tangential: R::lit(u),
            };
        }
        let distance = self.distance.part();
        Start::Free {
            position: [R::lit(distance * sin), R::lit(-distance * cos)],
            velocity: [R::lit(u), R::lit(v)],
        }
    }

    /// Translation, spin and height; and the sum of their sizes.
    fn energy<R: Precision>(&self, k: &Kinematics<R>, inertia: f64) -> [f64; 2] {
        let [u, v] = k.velocity.map(R::to_f64);
        let spin = k.spin.to_f64();
        let height = if self.weightless {
            0.0
        } else {
            k.position[1].to_f64()
        };
        let moving = 0.5 * (u * u + v * v) + 0.5 * inertia * spin * spin;
        [moving + height, moving + 1.0]
    }

    fn run<R: Precision>(&self) {
        let config = self.config::<R>();
        let (Ok(model), false) = (Rigid::try_new(&config), self.angle.is_nan()) else {
            return;
        };
        let spin = R::lit(self.spin.signed(1e-12, 1e12));
        let Ok(mut state) = model.start(&self.start(), spin, |_| ()) else {
            return;
        };
        let inertia = config.polar_inertia.to_f64();
        let epsilon = R::EPSILON.to_f64();
        let mut last = self.energy(&model.kinematics(&state), inertia)[0];
        for _ in 0..STEPS {
            let mut happenings = 0;
            model.step(&mut state, |happening| {
                happenings += 1;
                assert!(is_finite(&happening.after), "{happening:?}");
            });
            let k = model.kinematics(&state);
            assert!(is_finite(&k), "{k:?}");
            let outside = f64::hypot(k.position[0].to_f64(), k.position[1].to_f64()) - 1.0;
            assert!(outside <= 64.0 * epsilon, "{outside:e} outside: {k:?}");
            let [now, size] = self.energy(&k, inertia);
            let gain = (now - last) / size;
            let limit = epsilon * (MOST_GAINED * f64::from(1 + happenings) + STRETCHES);
            assert!(gain <= limit, "gained {gain:e} of {size:e}: {k:?}");
            assert!(happenings <= MOST_HAPPENINGS, "{happenings} happenings");
            last = now;
        }
    }
}

fn is_finite<R: Precision>(k: &Kinematics<R>) -> bool {
    let mut all = k
        .position
        .iter()
        .chain(&k.velocity)
        .chain([&k.spin, &k.turns.1]);
    all.all(|x| x.is_finite())
}

fuzz_target!(|input: Input| {
    input.run::<f64>();
    input.run::<f32>();
});
