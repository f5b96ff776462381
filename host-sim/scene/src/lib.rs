//! A scene: the machine, how it starts, how long it runs, what is modelled and what is measured.

mod base;
mod builtin;
pub mod calibration;
pub mod check;
pub mod diagnostic;
pub mod elastic;
mod faults;
pub mod file;
pub mod limits;
pub mod machine;
mod magnet;
mod materials;
mod mode;
mod model;
pub mod names;
mod outputs;
pub mod parts;
pub mod rule;
pub mod scales;
pub mod sensors;
mod support;
mod two_plane;

pub use base::Base;
pub use builtin::{BUILT_IN, BuiltIn};
pub use magnet::Magnet;
pub use materials::{CompliantWall, Contact, Materials};
pub use mode::{MODES, Mode, Shape};
pub use model::{Fidelity, LeftOut, Math, Model, Precision, Removable, Scheme};
pub use outputs::{Auto, Fixed, Output, Request};
pub use support::{BallBearing, Race, Stop, Support};
pub use two_plane::{RINGS, Ring, TwoPlane, Unbalance};

use std::borrow::Cow;
use std::path::Path;

use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::guard::GuardConfig;
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sensing::SensingConfig;

use crate::scales::compliance;
use crate::sensors::{SensorFault, SensorsConfig, Tachometers};
use touchdown_base::input_error::{InputError, LARGEST_TOML};
use touchdown_base::machine::Machine;
pub use touchdown_base::machine::Start;

/// A valid scene; SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The file, or the name of a built-in scene.
    pub name: String,
    /// One line.
    pub title: Option<String>,
    /// Where the numbers come from.
    pub source: Option<String>,
    /// The rotor.
    pub rotor: Rotor,
    /// The retainer bearing.
    pub retainer: Retainer,
    /// Radial gap of what the rotor must not reach, m.
    pub stator_gap: Option<f64>,
    /// What the retainer ring stands on, where that gives way.
    pub support: Option<Support>,
    /// The retainer as a ball bearing, where its inner ring turns.
    pub ball_bearing: Option<BallBearing>,
    /// The rotor's two ends, where it tilts.
    pub two_plane: Option<TwoPlane>,
    /// How it starts.
    pub start: Start,
    /// How long, and how often it is sampled.
    pub run: Run,
    /// What is modelled.
    pub model: Model,
    /// Where the model is to be chosen: what is asked of it.
    pub auto: Option<Auto>,
    /// What rotor and retainer are made of.
    pub materials: Materials,
    /// The sensor chain.
    pub sensors: SensorsConfig,
    /// Which of them fail.
    pub faults: Vec<SensorFault>,
    /// The detector's thresholds and times.
    pub tuning: Tuning,
    /// The guard's limits.
    pub guard: GuardConfig,
    /// Distance, as a part of the clearance, up to which the zones A, B and C reach; D is beyond. Not checked against
    /// ISO 14839-2.
    pub zones: [f64; 3],
}

/// The rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// kg.
    pub mass: f64,
    /// At the retainer, m.
    pub radius: f64,
    /// kg m^2.
    pub polar_inertia: f64,
    /// At the start, counter-clockwise positive, rad/s.
    pub spin: f64,
}

/// The retainer bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retainer {
    /// Radial, m.
    pub clearance: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// 0 to 1.
    pub restitution: f64,
}

/// How long, and how often it is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// From the release, s.
    pub duration: f64,
    /// Across the rotor's axis: downwards, m/s^2.
    pub gravity: f64,
    /// Of the sensors, Hz.
    pub sample_rate: f64,
    /// Of everything random.
    pub seed: u64,
}

/// Time held by the magnetic bearings before the release of a free start, s.
pub const LEVITATED_BEFORE: f64 = 0.2;

impl Scene {
    /// Reads the scene file at `name`, or else takes the built-in scene of that name.
    pub fn load(name: &str) -> Result<Self, InputError> {
        Self::parse(name, &Self::text(name)?)
    }

    /// The text of the scene file at `name`, or else of the built-in scene of that name, which a folder does not hide.
    pub fn text(name: &str) -> Result<Cow<'static, str>, InputError> {
        let (path, built_in) = (Path::new(name), BUILT_IN.iter().find(|it| it.name == name));
        if path.exists() && !(path.is_dir() && built_in.is_some()) {
            return InputError::read(path, LARGEST_TOML).map(Cow::Owned);
        }
        built_in
            .map(|scene| Cow::Borrowed(scene.text))
            .ok_or_else(|| {
                let names: Vec<_> = BUILT_IN.iter().map(|scene| scene.name).collect();
                let names = names.join(", ");
                let rule =
                    format!("no such file, and no built-in scene of this name; built in: {names}");
                InputError::of_file(name, rule)
            })
    }

    /// Reads the scene `text`; errors name it `name`.
    pub fn parse(name: &str, text: &str) -> Result<Self, InputError> {
        let file = file::read(name, text, limits::of_scene)?;
        check::scene(name, file)
            .map_err(|flaw| InputError::at_span(name, text, flaw.span(text), flaw.rule))
    }

    /// What is valid but worth knowing.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.retainer.clearance > self.sensors.range {
            let (clearance, range) = (self.retainer.clearance * 1e3, self.sensors.range * 1e6);
            warnings.push(format!(
                "clearance_mm is {clearance}, beyond the sensors' range of {range} um: they saturate before the rotor touches"
            ));
        }
        for part in parts::parts(self) {
            if part.asked && !part.modelled {
                let (name, reason, rung) = (part.name, part.reason, self.model.rung);
                warnings.push(format!("{name}: {reason}, the scene has rung {rung}"));
            }
        }
        warnings.extend(self.two_plane.as_ref().and_then(TwoPlane::tilt_warning));
        warnings.extend(self.step_warning());
        let told = warnings.iter().map(|it| format!("{}: {it}", self.name));
        told.collect()
    }

    /// The longest step that follows all that the model moves, s, what sets it, and what comes of longer ones; none where
    /// any step does.
    fn longest_step(&self) -> Option<(f64, &'static str, &'static str)> {
        let in_contact = |limit| (limit, "T_c/25", "forces and contact times are inaccurate");
        match self.model.rung {
            Fidelity::Hertz => Some(in_contact(compliance(self).ok()?.accurate_step())),
            Fidelity::Coupled => {
                let fastest = self.two_plane.as_ref()?.fastest(self.rotor.spin);
                let limit = 5.0 * limits::ANGLE_OF_STEP / fastest;
                let accurate = scales::accurate_step(self);
                let of = "half a radian of the fastest motion";
                let followed = (limit, of, "it is not followed");
                Some(if accurate < limit {
                    in_contact(accurate)
                } else {
                    followed
                })
            }
            _ => None,
        }
    }

    /// Whether the model's step follows all that it moves.
    pub fn step_is_short(&self) -> bool {
        let longest = self.longest_step();
        longest.is_none_or(|(longest, ..)| self.model.step <= longest)
    }

    fn step_warning(&self) -> Option<String> {
        let step = self.model.step;
        let (longest, of, then) = self.longest_step()?;
        let (given, longest_us) = ((step * 1e12).round() * 1e-6, longest * 1e6);
        let rule = format!("step_us is {given}, above {of} = {longest_us:.4} us: {then}");
        (step > longest).then_some(rule)
    }

    /// What the monitor is told of this scene.
    pub fn monitor_config(&self) -> MonitorConfig {
        MonitorConfig {
            fitted: self.sensors.fitted(),
            sensing: SensingConfig {
                places: self.two_plane.as_ref().and_then(TwoPlane::places),
                ..self.sensors.sensing()
            },
            tachometers: self.sensors.tachometers.as_ref().map(Tachometers::config),
            detector: DetectorConfig {
                sample_rate: self.run.sample_rate as f32,
                machine: machine_config(&self.rotor, &self.retainer, self.run.gravity),
                tuning: self.tuning,
            },
            guard: self.guard,
            // A scene is its own record.
            commissioned: true,
        }
    }

    /// The retainer rings of a rotor that tilts; of another none.
    pub fn rings(&self) -> &[Ring] {
        self.two_plane.as_ref().map_or(&[], |it| &it.rings)
    }

    /// Samples before the release.
    pub fn levitated_samples(&self) -> u64 {
        match self.start {
            Start::Free { .. } => (LEVITATED_BEFORE * self.run.sample_rate).round() as u64,
            Start::Wall { .. } => 0,
        }
    }

    /// Rotor and retainer bearing, for a model.
    pub fn machine(&self) -> Machine {
        Machine {
            mass: self.rotor.mass,
            radius: self.rotor.radius,
            polar_inertia: self.rotor.polar_inertia,
            clearance: self.retainer.clearance,
            friction: self.retainer.friction,
            restitution: self.retainer.restitution,
            gravity: self.run.gravity,
        }
    }

    /// Time of the first sample, s since the release.
    pub fn first_sample_time(&self) -> f64 {
        -(self.levitated_samples() as f64) / self.run.sample_rate
    }

    /// The title, or else the name.
    pub fn heading(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.name)
    }
}

/// What the monitor is told of a machine; gravity across the rotor's axis, m/s^2.
pub fn machine_config(rotor: &Rotor, retainer: &Retainer, gravity: f64) -> MachineConfig {
    MachineConfig {
        mass: rotor.mass as f32,
        clearance: retainer.clearance as f32,
        gravity: gravity as f32,
        rotor_radius: rotor.radius as f32,
        inertia_ratio: (rotor.polar_inertia / (rotor.mass * rotor.radius * rotor.radius)) as f32,
        friction: retainer.friction as f32,
        restitution: retainer.restitution as f32,
        spin: rotor.spin as f32,
    }
}
