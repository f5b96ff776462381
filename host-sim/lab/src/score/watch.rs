//! One drop: it floats, falls and bounces by the reference; sensors and monitor watch.

use touchdown_core::detect::Phase;
use touchdown_core::forecast::ForecastTask;
use touchdown_core::monitor::{Fingerprint, Monitor, MonitorConfig, MonitorState};
use touchdown_core::sample::Sample;
use touchdown_rotor::error::ConfigError;

use super::Plan;
use super::levitated::Levitated;
use touchdown_base::failure::Failure;
use touchdown_base::history::{History, Impact, PhaseKind};
use touchdown_run::controller_trace::MonitorOutput;
use touchdown_run::detection::detection;
use touchdown_run::outcome::Detection;
use touchdown_run::timebase::Timebase;
use touchdown_scene::sensors::{Faults, Motion, Sensors};
use touchdown_scene::{Scene, Start};
use touchdown_truth::{TrueState, Truth};

/// A drop and what the monitor is told of its machine.
#[derive(Clone, Debug)]
pub struct Drop {
    /// Of the machine, its sensors and its run.
    pub scene: Scene,
    /// What the monitor is told; it may be of another machine than the one that drops.
    pub monitor: MonitorConfig,
    floats: Option<Levitated>,
    /// Before the release.
    levitated: u64,
    /// From the release to the next sample, in sample periods.
    first: f64,
}

impl Drop {
    /// Floats for `lead` s as `floats`, then goes on with the position and velocity that it has at that
    /// moment, `thrown` (m/s) on top. `first` is the time from the release to the next sample, in
    /// sample periods.
    pub fn released(
        plan: &Plan,
        mut scene: Scene,
        floats: Levitated,
        thrown: [f64; 2],
        lead: f64,
        first: f64,
    ) -> Self {
        let [u, v] = floats.velocity(0.0);
        scene.start = Start::Free {
            position: floats.position(0.0),
            velocity: [u + thrown[0], v + thrown[1]],
        };
        scene.rotor.spin = floats.spin(0.0);
        Self {
            levitated: (lead * scene.run.sample_rate).ceil() as u64,
            first,
            floats: Some(floats),
            ..Self::of(plan, scene)
        }
    }

    /// From the start of `scene`, with nothing before.
    pub fn of(plan: &Plan, mut scene: Scene) -> Self {
        scene.tuning = plan.tuning;
        Self {
            levitated: 0,
            ..Self::told(scene.clone(), &scene)
        }
    }

    /// As `scene` has it, levitation and all. The monitor is told of `told`.
    pub fn told(scene: Scene, told: &Scene) -> Self {
        Self {
            monitor: told.monitor_config(),
            levitated: scene.levitated_samples(),
            scene,
            floats: None,
            first: 0.0,
        }
    }

    /// Whole sample periods up to the end.
    pub fn periods(&self) -> usize {
        let run = &self.scene.run;
        (self.levitated as f64 + run.duration * run.sample_rate) as usize
    }

    /// Of sample `number`, s since the release.
    fn time(&self, number: u64) -> f64 {
        (number as f64 - self.levitated as f64 + self.first) / self.scene.run.sample_rate
    }

    /// Ends the run where the whirl gets faster than 1000 turns/s, or than a turn in twenty samples: the rigid laws let it grow
    /// without bound.
    pub fn before_fast_whirl(mut self) -> Self {
        const FASTEST: f64 = 1e3;
        const SAMPLES: f64 = 20.0;
        const LOOK: f64 = 1e-3;
        let fastest = FASTEST.min(self.scene.run.sample_rate / SAMPLES);
        let scene = self.scene.clone();
        let mut truth = Truth::new(&scene);
        let (mut time, mut turns) = (0.0_f64, 0.0_f64);
        while time < scene.run.duration {
            let now = truth.advance(time).rotor.turns_in_contact;
            // A lift-off sets them back.
            if now.abs() - turns.abs() > fastest * LOOK {
                self.scene.run.duration = time;
                break;
            }
            (time, turns) = (time + LOOK, now);
        }
        self
    }

    /// Change of the velocity into the wall by an impact, m/s.
    pub fn jump(&self, impact: &Impact) -> f64 {
        (1.0 + self.scene.retainer.restitution) * impact.normal_speed
    }

    /// Each sample, its time since the release (s), and what is true then; in an orbit, nothing before the release.
    pub fn feed(
        &self,
        truth: &mut Truth<'_>,
    ) -> Result<impl Iterator<Item = (Sample, f64, Option<TrueState>)>, Failure> {
        let scene = &self.scene;
        let sensors = Sensors::try_new(&scene.sensors, scene.run.sample_rate).map_err(refused)?;
        let mut seen = sensors.start(scene.run.seed);
        let mut faults = Faults::new(&scene.faults, &scene.sensors);
        let times = (0..).map(|number| self.time(number));
        let times = times.take_while(|time| *time <= scene.run.duration);
        Ok(times.map(move |time| {
            let (motion, fallen) = match self.floats {
                Some(floats) if time < 0.0 => (held(&floats, time), None),
                _ => {
                    let state = truth.advance(time);
                    (state.motion(time < 0.0), Some(state))
                }
            };
            let mut sample = sensors.read(&mut seen, &motion);
            faults.inject(&mut sample, time);
            (sample, time, fallen)
        }))
    }

    /// What the sensors deliver.
    pub fn samples(&self) -> Result<Vec<Sample>, Failure> {
        let mut truth = Truth::new(&self.scene);
        Ok(self.feed(&mut truth)?.map(|it| it.0).collect())
    }

    /// Runs it.
    pub fn watch(&self) -> Result<Watched, Failure> {
        let monitor = Monitor::try_new(&self.monitor).map_err(refused)?;
        let mut state = MonitorState::default();
        let mut forecast_task = ForecastTask::try_new(&self.monitor.detector).map_err(refused)?;
        let mut truth = Truth::new(&self.scene);
        let (mut notices, mut instants) = (Vec::new(), Vec::new());
        for (sample, time, fallen) in self.feed(&mut truth)? {
            notices.extend(monitor.update(&mut state, &sample));
            notices.extend(monitor.look(&state, &mut forecast_task));
            instants.extend(fallen.map(|TrueState { phase, rotor, .. }| Instant {
                time,
                phase,
                told: state.detector.phase(),
                turns: rotor.turns_in_contact * rotor.spin.signum(),
                position: rotor.position,
            }));
        }
        let answer = MonitorOutput {
            notices,
            severity: state.severity.so_far,
            summary: Fingerprint::default().summary(&state),
            ..MonitorOutput::default()
        };
        let timebase = Timebase::new(self.time(0), self.scene.run.sample_rate);
        Ok(Watched {
            truth: truth.finish().whole,
            detection: detection(&answer, timebase),
            instants,
        })
    }
}

/// What happened and what was seen of it.
#[derive(Clone, Debug)]
pub struct Watched {
    /// By the reference.
    pub truth: History,
    /// By the monitor. Its fingerprint is left out.
    pub detection: Detection,
    /// One a sample from the release on.
    pub instants: Vec<Instant>,
}

/// A sample after the release.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// s since the release.
    pub time: f64,
    /// True phase.
    pub phase: PhaseKind,
    /// The monitor's.
    pub told: Phase,
    /// Turns in the present contact, positive with the spin.
    pub turns: f64,
    /// m.
    pub position: [f64; 2],
}

fn held(floats: &Levitated, time: f64) -> Motion {
    Motion {
        planes: [floats.position(time); 2],
        spin: floats.spin(time),
        levitated: true,
        bearing: None,
    }
}

/// For `map_err`.
pub fn refused(error: ConfigError) -> Failure {
    Failure::Usage(format!("score: {error}"))
}
