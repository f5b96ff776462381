//! How hard a drop was, as the monitor adds it up, and by the reference.

use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_core::severity::Severity;
use touchdown_rotor::error::ConfigError;

use touchdown_base::history::PhaseKind;
use touchdown_scene::Scene;
use touchdown_scene::sensors::Sensors;
use touchdown_truth::Truth;

/// Angle of whirl in a sample, rad, beyond which the load is left out: the core's own limit.
const FOLLOWED: f64 = 0.3;

/// A drop, up to its end, or to where whirl is too fast to be followed.
#[derive(Clone, Debug)]
pub struct Strained {
    /// By the monitor.
    pub seen: Severity,
    /// Of the impacts, along the normal, N s.
    pub impulses: Vec<f64>,
    /// Of the impacts, into the wall, m/s.
    pub speeds: Vec<f64>,
    /// In permanent contact, s.
    pub dwell: f64,
    /// Starts and ends of a contact up to the end.
    pub changes: usize,
    /// Greatest speed of the centre, m/s.
    pub speed: f64,
    /// Greatest force in contact, once it has gone round, N.
    pub whirl_load: Option<f64>,
}

/// Drops the rotor of `scene`; the monitor is told of `told`.
pub fn watch(scene: &Scene, told: &Scene) -> Result<Strained, ConfigError> {
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate)?;
    let mut chain = sensors.start(scene.run.seed);
    let monitor = Monitor::try_new(&told.monitor_config())?;
    let mut state = MonitorState::default();
    let mut truth = Truth::new(scene);
    let levitated = scene.levitated_samples() as f64;
    let (mut speed, mut load, mut whirl_load, mut end) = (0.0_f64, 0.0_f64, None, 0.0);
    for k in 0..(levitated + scene.run.duration * rate) as u64 {
        let time = (k as f64 - levitated) / rate;
        let at = truth.advance(time);
        let ([x, y], [u, v]) = (at.rotor.position, at.rotor.velocity);
        let radius = f64::hypot(x, y);
        let turn_rate = if radius > 0.0 {
            (x * v - y * u) / (radius * radius)
        } else {
            0.0
        };
        let turns = at.rotor.turns_in_contact.abs();
        if turns == 0.0 {
            load = 0.0;
        } else if turn_rate.abs() > FOLLOWED * rate {
            break;
        } else {
            let (mass, gravity) = (scene.rotor.mass, scene.run.gravity);
            // As at the bottom, where the weight adds to it.
            load = load.max(mass * (radius * turn_rate * turn_rate + gravity));
        }
        if turns >= 1.0 {
            whirl_load = Some(load);
        }
        speed = speed.max(f64::hypot(u, v));
        end = time;
        let motion = at.motion(time < 0.0);
        monitor.update(&mut state, &sensors.read(&mut chain, &motion));
    }
    let history = truth.finish().whole;
    let impacts = || history.impacts.iter().filter(|it| it.state.time <= end);
    let contact = [PhaseKind::Sliding, PhaseKind::Rolling];
    let phases = history.phases.iter();
    let contacts = phases.filter(|it| contact.contains(&it.phase));
    Ok(Strained {
        seen: state.severity.so_far,
        impulses: impacts().map(|it| it.normal_impulse).collect(),
        speeds: impacts().map(|it| it.normal_speed).collect(),
        dwell: contacts
            .map(|it| (it.end_s.min(end) - it.start_s).max(0.0))
            .sum(),
        changes: history
            .contact_starts
            .iter()
            .chain(&history.lift_offs)
            .filter(|it| **it <= end)
            .count(),
        speed,
        whirl_load,
    })
}
