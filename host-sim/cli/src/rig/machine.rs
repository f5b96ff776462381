//! The machine of an emulated rig, sample by sample: it lies, is lifted, floats, and falls when told.

use std::mem;

use touchdown_core::sample::Sample;
use touchdown_core::sensing::PLANES;
use touchdown_rotor::error::ConfigError;

use touchdown_run::drop::bearing;
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Failing, Faults, Motion, SensorFault, Sensors, SensorsState};
use touchdown_truth::{Moving, Truth};

/// Time in which it is lifted, or rolls to the bottom after the scene's drop or where that is given up, s.
const LIFT: f64 = 0.2;

type Places = [[f64; 2]; PLANES];

/// What the rotor does.
enum Stage<'a> {
    Lies,
    /// From there, for so many samples, to where it floats or lies.
    Moves {
        from: Places,
        samples: u64,
        up: bool,
    },
    Floats,
    /// For so many samples.
    Falls(Box<Truth<'a>>, u64),
}

/// The machine. Samples without end.
pub struct Machine<'a> {
    scene: &'a Scene,
    sensors: Sensors,
    seen: SensorsState,
    /// Of the scene, by the time of its drop.
    scenes_faults: Faults,
    /// Ordered, for good.
    ordered: Vec<SensorFault>,
    faults: Faults,
    stage: Stage<'a>,
    floating: Places,
    lying: Places,
    place: Places,
    given_up: Option<f64>,
}

impl<'a> Machine<'a> {
    /// Lying at the bottom.
    pub fn try_new(scene: &'a Scene) -> Result<Self, ConfigError> {
        let sensors = Sensors::try_new(&scene.sensors, scene.run.sample_rate)?;
        let lying = [[0.0, -scene.retainer.clearance]; PLANES];
        Ok(Self {
            seen: sensors.start(scene.run.seed),
            sensors,
            scenes_faults: Faults::new(&scene.faults, &scene.sensors),
            ordered: Vec::new(),
            faults: Faults::new(&[], &scene.sensors),
            stage: Stage::Lies,
            floating: Truth::new(scene).advance(-1.0).sensed,
            lying,
            place: lying,
            given_up: None,
            scene,
        })
    }

    /// When its last drop was given up, s since the release: it would have taken too long. Told once.
    pub fn given_up(&mut self) -> Option<f64> {
        self.given_up.take()
    }

    /// Lifts it from wherever it is.
    pub fn lift(&mut self) {
        self.go(true);
    }

    /// Lets it go: the scene's drop, with its faults of sensors.
    pub fn let_go(&mut self) {
        self.scenes_faults = Faults::new(&self.scene.faults, &self.scene.sensors);
        self.stage = Stage::Falls(Box::new(Truth::new(self.scene)), 0);
    }

    /// Makes a channel fail from now on.
    pub fn inject(&mut self, channel: usize, failing: Failing) {
        self.ordered.push(SensorFault {
            channel,
            failing,
            start: 0.0,
            end: f64::INFINITY,
        });
        self.faults = Faults::new(&self.ordered, &self.scene.sensors);
    }

    /// Repairs all channels.
    pub fn repair(&mut self) {
        self.ordered.clear();
        self.faults = Faults::new(&[], &self.scene.sensors);
    }

    fn go(&mut self, up: bool) {
        self.stage = Stage::Moves {
            from: self.place,
            samples: 0,
            up,
        };
    }

    /// Where it is in the next sample; spin, time since the release and angles of the bearing where it falls.
    fn step(&mut self) -> (f64, f64, Moving) {
        let rate = self.scene.run.sample_rate;
        match mem::replace(&mut self.stage, Stage::Lies) {
            Stage::Lies => {}
            Stage::Floats => {
                self.stage = Stage::Floats;
                self.place = self.floating;
            }
            Stage::Moves { from, samples, up } => {
                let part = samples as f64 / (LIFT * rate);
                let to = if up { self.floating } else { self.lying };
                for (place, (from, to)) in self.place.iter_mut().zip(from.iter().zip(to)) {
                    *place = [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
                }
                let samples = samples + 1;
                self.stage = match up {
                    _ if part < 1.0 => Stage::Moves { from, samples, up },
                    true => Stage::Floats,
                    false => Stage::Lies,
                };
            }
            Stage::Falls(mut truth, samples) => {
                let time = samples as f64 / rate;
                let state = truth.advance(time);
                self.place = state.sensed;
                self.given_up = truth.given_up();
                if time < self.scene.run.duration && self.given_up.is_none() {
                    self.stage = Stage::Falls(truth, samples + 1);
                } else {
                    self.go(false);
                }
                return (state.rotor.spin, time, state.moving);
            }
        }
        (self.scene.rotor.spin, 0.0, Moving::Nothing)
    }
}

impl Iterator for Machine<'_> {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        let falls = matches!(self.stage, Stage::Falls(..));
        let levitated = matches!(self.stage, Stage::Floats | Stage::Moves { up: true, .. });
        let (spin, time, moving) = self.step();
        let motion = Motion {
            planes: self.place,
            spin,
            levitated,
            bearing: bearing(self.scene, moving),
        };
        let mut sample = self.sensors.read(&mut self.seen, &motion);
        if falls {
            self.scenes_faults.inject(&mut sample, time);
        }
        self.faults.inject(&mut sample, time);
        Some(sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_lab::limits;

    /// A random machine whose rotor whirls too fast.
    #[test]
    fn a_drop_that_is_given_up_is_told_once_and_the_rotor_rolls_to_the_bottom() {
        let mut scene = Scene::parse("machine", &limits::machine(1)).expect("valid");
        scene.run.duration = 1.0;
        let rate = scene.run.sample_rate;
        let mut machine = Machine::try_new(&scene).expect("valid");
        machine.let_go();
        let at = (0..(0.5 * rate) as usize).find_map(|_| {
            machine.next();
            machine.given_up()
        });
        assert!(at.is_some_and(|it| it > 0.0 && it < 0.5), "{at:?}");
        assert_ne!(machine.place, machine.lying);
        machine.by_ref().nth((LIFT * rate) as usize);
        assert_eq!((machine.place, machine.given_up()), (machine.lying, None));
    }
}
