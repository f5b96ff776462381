//! The way of a rotor from sample to sample, and what its sensors make of it.

use touchdown_scene::Scene;
use touchdown_scene::sensors::{Faults, Motion, SensorFault, Sensors};
use touchdown_truth::{Moving, Truth};

use crate::stream::Stream;

type Planes = [[f64; 2]; 2];

/// A motion, stretch by stretch.
pub struct Path {
    scene: Scene,
    motions: Vec<Motion>,
    faults: Vec<SensorFault>,
}

impl Path {
    pub fn new(scene: &Scene) -> Self {
        Self {
            scene: scene.clone(),
            motions: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// For so long, s, at places (m) by the time (s) since the stretch began.
    pub fn moves(mut self, seconds: f64, places: impl Fn(f64) -> Planes) -> Self {
        let rate = self.scene.run.sample_rate;
        let samples = (seconds * rate).round() as u64;
        self.motions.extend((0..samples).map(|k| Motion {
            planes: places(k as f64 / rate),
            spin: self.scene.rotor.spin,
            levitated: true,
            bearing: self.scene.ball_bearing.map(|_| [0.0; 2]),
        }));
        self
    }

    /// Floats at the scene's start.
    pub fn floats(self, seconds: f64) -> Self {
        let start = self.held();
        self.moves(seconds, |_| start)
    }

    /// As the scene has it, from its release to its end.
    pub fn drops(mut self) -> Self {
        let scene = &self.scene;
        let mut truth = Truth::new(scene);
        let samples = (scene.run.duration * scene.run.sample_rate).round() as u64;
        let motions = (0..samples).map(|k| {
            let state = truth.advance(k as f64 / scene.run.sample_rate);
            let turned = match state.moving {
                Moving::Ring { race_angle, .. } => Some(race_angle),
                _ => None,
            };
            let bearing = turned.zip(scene.ball_bearing);
            Motion {
                planes: state.sensed,
                spin: state.rotor.spin,
                levitated: false,
                bearing: bearing.map(|(angle, it)| [angle, it.race.cage_ratio * angle]),
            }
        });
        let motions: Vec<_> = motions.collect();
        self.motions.extend(motions);
        self
    }

    /// Back to the scene's start, from where it is.
    pub fn lifted(self, seconds: f64) -> Self {
        let start = self.held();
        let last = self.motions.last().expect("a motion").planes;
        self.moves(seconds, |time| {
            let part = smooth(time / seconds);
            let way = |end: usize, axis: usize| {
                last[end][axis] + part * (start[end][axis] - last[end][axis])
            };
            [0, 1].map(|end| [0, 1].map(|axis| way(end, axis)))
        })
    }

    /// With a sensor that fails, at times (s) since the first sample.
    pub fn with(mut self, fault: SensorFault) -> Self {
        self.faults.push(fault);
        self
    }

    /// What the monitor is told, and sees.
    pub fn sensed(&self) -> Stream {
        let scene = &self.scene;
        let rate = scene.run.sample_rate;
        let sensors = Sensors::try_new(&scene.sensors, rate).expect("valid sensors");
        let mut state = sensors.start(scene.run.seed);
        let mut faults = Faults::new(&self.faults, &scene.sensors);
        let samples = self.motions.iter().enumerate().map(|(k, motion)| {
            let mut sample = sensors.read(&mut state, motion);
            faults.inject(&mut sample, k as f64 / rate);
            sample
        });
        Stream {
            config: scene.monitor_config(),
            samples: samples.collect(),
        }
    }

    /// Where each end is before the release, m.
    fn held(&self) -> Planes {
        Truth::new(&self.scene).advance(-1.0).sensed
    }
}

/// From 0 to 1 in unit time without a jump of the acceleration.
pub fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}
