//! What the counted ticks see: a rotor that floats and falls, by the rigid rung, with runout and noise.

use core::f32::consts::TAU;

use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::{CHANNELS, Edges, Sample, TACHOMETERS};
use touchdown_core::sensing::{Calibration, PLANES, PlaneCalibration};
use touchdown_core::tachometer::TachometersConfig;
use touchdown_rotor::real::{Poly32, Real};
use touchdown_rotor::{Rigid, RigidConfig, Start, Stepper};

use touchdown_firmware::board::default_config;

/// Sample at which no plane is released.
const NEVER: u32 = u32::MAX;
/// Numbers that describe a stream.
pub(super) const NUMBERS: usize = 24;
/// Samples of a described stream.
const DESCRIBED_SAMPLES: u32 = 4_500;

/// A stream of samples.
#[derive(Clone, Copy)]
pub(super) struct Scene {
    pub(super) name: &'static str,
    samples: u32,
    /// Amplitudes of orbit and runout of the third order, m.
    orbit: f32,
    runout: f32,
    speed_known: bool,
    levitation_known: bool,
    /// Sample at which each plane is released, and its velocity sideways, m/s.
    release: [u32; PLANES],
    kick: [f64; PLANES],
    friction: f64,
    /// Where not the machine's.
    restitution: Option<f64>,
    /// Clearance of each plane's ring, as a part of the machine's.
    clearance: [f64; PLANES],
    /// Standard deviation of the noise, m, and its seed.
    noise: f32,
    seed: u32,
    /// An inner ring that is watched.
    ring: bool,
    /// Instants of the banks of release and impact, where not the default.
    instants: Option<[u8; 2]>,
    /// rad/s, where not the default.
    spin: Option<f32>,
    /// Angle at which the sensors are mounted, rad, and what a commissioning check found of all channels.
    mounting_angle: f32,
    found: Option<PlaneCalibration>,
    /// Sensors that fail.
    fail: fn(u32, &mut Sample),
    fault: Option<Fault>,
}

/// A channel that fails for a while, again and again.
#[derive(Clone, Copy)]
struct Fault {
    /// 1 stuck, 2 invalid, 3 full scale, else drifting.
    kind: u32,
    channel: usize,
    from: u32,
    length: u32,
    every: u32,
}

impl Fault {
    fn apply(self, at: u32, sample: &mut Sample) {
        let Some(since) = at.checked_sub(self.from).map(|it| it % self.every) else {
            return;
        };
        let count = &mut sample.counts[self.channel];
        match self.kind {
            _ if since >= self.length => {}
            1 => *count = 4_096,
            2 => sample.valid &= !(1 << self.channel),
            3 => *count = 8_191,
            _ => *count = count.wrapping_add((since / 2) as u16).min(8_191),
        }
    }
}

const FLOATING: Scene = Scene {
    name: "levitated",
    samples: 5_000,
    orbit: 0.0,
    runout: 0.0,
    speed_known: false,
    levitation_known: false,
    release: [NEVER; PLANES],
    kick: [0.0; PLANES],
    friction: 0.1,
    restitution: None,
    clearance: [1.0; PLANES],
    noise: 1e-6,
    seed: 1,
    ring: false,
    instants: None,
    spin: None,
    mounting_angle: 0.0,
    found: None,
    fail: |_, _| {},
    fault: None,
};
const TURNING: Scene = Scene {
    name: "orbit, speed known",
    orbit: 20e-6,
    runout: 5e-6,
    speed_known: true,
    ..FLOATING
};
const DROP: Scene = Scene {
    name: "drop",
    samples: 12_000,
    release: [3_000; PLANES],
    ..TURNING
};

/// The streams, those that typical ticks are taken from first.
pub(super) const SCENES: [Scene; 14] = [
    FLOATING,
    TURNING,
    Scene {
        name: "orbit, speed unknown",
        speed_known: false,
        ..TURNING
    },
    DROP,
    Scene {
        name: "drop without orbit, speed unknown",
        speed_known: false,
        orbit: 0.0,
        ..DROP
    },
    Scene {
        name: "drop, 8 instants",
        instants: Some([8; 2]),
        ..DROP
    },
    Scene {
        name: "drop into whirl",
        friction: 0.4,
        kick: [-0.05; PLANES],
        ..DROP
    },
    Scene {
        name: "commanded drop",
        levitation_known: true,
        ..DROP
    },
    Scene {
        name: "at the wall from the start",
        release: [0; PLANES],
        ..DROP
    },
    Scene {
        name: "ball bearing",
        ring: true,
        ..DROP
    },
    Scene {
        name: "ends apart",
        release: [3_000, 3_030],
        kick: [0.03, -0.03],
        ..DROP
    },
    Scene {
        name: "ends apart, speed unknown",
        release: [3_000, 3_100],
        kick: [0.05, -0.01],
        speed_known: false,
        friction: 0.3,
        ..DROP
    },
    Scene {
        name: "sensors fail while floating",
        samples: 7_000,
        fail: |at, sample| match at {
            2_000..3_000 => sample.counts[0] = 4_096,
            3_500..3_750 => sample.valid &= 0b1101,
            4_000..4_500 => sample.counts[2] = 8_191,
            5_000..5_500 if at % 25 < 2 => sample.counts[3] = 7_000,
            6_000..6_500 => sample.counts[1] = sample.counts[1].wrapping_add((at / 2) as u16),
            _ => {}
        },
        ..TURNING
    },
    Scene {
        name: "sensors fail in a drop",
        fail: |at, sample| match at {
            2_950.. if at % 350 < 15 => sample.valid &= 0b1011,
            4_000.. => sample.counts[0] = 4_096,
            _ => {}
        },
        ..DROP
    },
];

impl Scene {
    /// Of these numbers, in the order of `xtask/src/budget/stream.rs`.
    pub(super) fn described(numbers: [f32; NUMBERS]) -> Self {
        #[rustfmt::skip]
        let [
            release, apart, kick_a, kick_b, friction, restitution, clearance_a, clearance_b, orbit, runout, noise, seed,
            speed_known, levitation_known, release_instants, impact_instants, spin, mounting_angle, gain, skew,
            kind, channel, from, length,
        ] = numbers;
        let (release, apart) = (release as u32, apart as i32);
        Self {
            name: "described",
            samples: DESCRIBED_SAMPLES,
            orbit,
            runout,
            speed_known: speed_known != 0.0,
            levitation_known: levitation_known != 0.0,
            release: [release, release.saturating_add_signed(apart)],
            kick: [kick_a, kick_b].map(f64::from),
            friction: friction.into(),
            restitution: Some(restitution.into()),
            clearance: [clearance_a, clearance_b].map(f64::from),
            noise,
            seed: seed as u32,
            instants: Some([release_instants, impact_instants].map(|it| it as u8)),
            spin: Some(spin),
            mounting_angle,
            found: (gain != 1.0 || skew != 0.0).then_some(PlaneCalibration {
                zero: [0.0; 2],
                gain: [gain; 2],
                skew,
            }),
            fault: (kind != 0.0).then_some(Fault {
                kind: kind as u32,
                channel: channel as usize % CHANNELS,
                from: from as u32,
                length: length as u32,
                every: 500,
            }),
            ..FLOATING
        }
    }

    /// The configuration of the monitor.
    pub(super) fn config(&self) -> MonitorConfig {
        let mut config = default_config();
        config.tachometers = self.ring.then_some(TachometersConfig {
            marks: [Some(12), None],
            cage_ratio: 0.4,
            bore_radius: 24e-3,
            edge_error: 0.01,
            window: 0.005,
        });
        if let Some([release, impact]) = self.instants {
            config.detector.tuning.release_instants = release;
            config.detector.tuning.impact_instants = impact;
        }
        config.detector.machine.spin = self.spin.unwrap_or(config.detector.machine.spin);
        config.sensing.mounting_angle = [self.mounting_angle; PLANES];
        config.sensing.calibration = self.found.map(|found| Calibration {
            date: 20_260_101,
            planes: [found; PLANES],
        });
        config
    }

    /// Calls `take` with every sample.
    pub(super) fn play(&self, mut take: impl FnMut(&Sample)) {
        let machine = self.config().detector.machine;
        let rate = default_config().detector.sample_rate;
        let models = self.clearance.map(|it| self.rotor(it));
        let rotors: [Rigid<Poly32>; PLANES] = [0, 1].map(|plane| models[plane].rounded());
        let mut planes = [const { None }; PLANES];
        let mut noise = Noise(self.seed);
        for at in 0..self.samples {
            let angle = machine.spin / rate * at as f32 % TAU;
            let place = around(self.orbit, angle);
            let runout = around(self.runout, 3.0 * angle);
            let mut counts = [0; CHANNELS];
            for (plane, pair) in counts.chunks_exact_mut(2).enumerate() {
                let (scales, fallen) = (models[plane].scales(), &rotors[plane]);
                if at == self.release[plane] {
                    let along = [-place[1], place[0]].map(|x| f64::from(x * machine.spin));
                    let start = Start::Free {
                        position: place.map(|x| f64::from(x) / scales.length),
                        velocity: [
                            (along[0] + self.kick[plane]) / scales.speed,
                            along[1] / scales.speed,
                        ],
                    };
                    let start = start.rounded();
                    let spin = Poly32::lit(f64::from(machine.spin) / scales.spin);
                    planes[plane] = Stepper::start(fallen, &start, spin, |_| ()).ok();
                }
                let seen = match &mut planes[plane] {
                    Some(state) => {
                        Stepper::step(fallen, state, |_| ());
                        let unit = scales.length;
                        let position = Stepper::kinematics(fallen, state).position;
                        position.map(|x| (x.to_f64() * unit) as f32)
                    }
                    None => place,
                };
                for ((count, seen), runout) in pair.iter_mut().zip(seen).zip(runout) {
                    let shown = seen + runout + self.noise * noise.next();
                    *count = (4_096.5 + shown * (8_192.0 / 2_000e-6)) as u16;
                }
            }
            let turned = (0.1 * at as f32) as u16;
            let edges = Edges {
                count: turned / 4,
                age: (turned % 4) as u8 * 64,
            };
            let mut sample = Sample {
                counts,
                valid: 0b1111,
                spin: self.speed_known.then_some(machine.spin),
                levitated: self.levitation_known.then_some(at < self.release[0]),
                edges: [self.ring.then_some(edges), None],
            };
            const { assert!(TACHOMETERS == 2) };
            (self.fail)(at, &mut sample);
            if let Some(fault) = self.fault {
                fault.apply(at, &mut sample);
            }
            take(&sample);
        }
    }

    fn rotor(&self, clearance: f64) -> Rigid<f64> {
        let machine = default_config().detector.machine;
        let radius = f64::from(machine.rotor_radius);
        let mass = f64::from(machine.mass);
        Rigid::try_new(&RigidConfig {
            mass,
            radius,
            polar_inertia: f64::from(machine.inertia_ratio) * mass * radius * radius,
            clearance: f64::from(machine.clearance) * clearance,
            friction: self.friction,
            restitution: self.restitution.unwrap_or(machine.restitution.into()),
            gravity: f64::from(machine.gravity),
            speed: 1.0,
            step: 1.0 / f64::from(default_config().detector.sample_rate),
        })
        .expect("a valid rotor")
    }
}

fn around(radius: f32, angle: f32) -> [f32; 2] {
    let (sin, cos) = Poly32::lit(f64::from(angle)).sin_cos();
    [cos, sin].map(|it| radius * it.to_f64() as f32)
}

/// Sum of four even numbers (linear congruence), variance 1.
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> f32 {
        let even = || {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) as f32 / 16_777_216.0 - 0.5
        };
        let sum: f32 = core::iter::repeat_with(even).take(4).sum();
        1.732_050_8 * sum
    }
}
