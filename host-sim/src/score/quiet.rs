//! Hours of levitation: what is declared where nothing happens, what is confirmed where the controller
//! catches what happens, and what it costs in latency to be trusted.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::monitor::Monitor;
use touchdown_core::sensing::PLANES;

use super::campaign;
use super::confirmation;
use super::disturbance::{Coloured, Held, Kick, Shift, Steps, hum, smooth};
use super::levitated::{Levitated, ORBIT};
use super::row::Row;
use super::watch::{Drop, refused};
use super::{Findings, Plan};
use crate::evenly::direction;
use crate::failure::Failure;
use crate::scene::Scene;
use crate::sensors::{Motion, Sensors};

/// Longest stretch that is run in one piece, s; each begins with arming.
const PIECE: f64 = 20.0;
/// Seconds an hour.
const HOUR: f64 = 3600.0;
/// -ln 0.05: upper end of the 95 % interval of a Poisson mean of which none was seen.
const NONE_SEEN: f64 = 2.995_732_273_553_991;

/// Amplitude of the runout, m.
const RUNOUT: f64 = 5e-6;
/// Lowest and highest frequency of the orbit, Hz.
const SPEEDS: [f64; 2] = [10.0, 500.0];

/// What the machine does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    White,
    Orbit,
    Offset,
    Resonance,
    Steps,
    Hum,
    Coloured,
    /// Orbit, runout, offset, sweep, steps and hum.
    Together,
    Load,
    Shock,
    Setpoint,
    Landing,
}

const CASES: [Case; 12] = [
    Case::White,
    Case::Orbit,
    Case::Offset,
    Case::Resonance,
    Case::Steps,
    Case::Hum,
    Case::Coloured,
    Case::Together,
    Case::Load,
    Case::Shock,
    Case::Setpoint,
    Case::Landing,
];

impl Case {
    /// For people.
    fn name(self) -> &'static str {
        match self {
            Self::White => "white noise 1 um",
            Self::Orbit => "orbit 30 um at 10 to 500 Hz, runout 5 um",
            Self::Offset => "offset of half the gap",
            Self::Resonance => "sweep through a resonance, up to 30 um",
            Self::Steps => "sensor steps of 1 LSB",
            Self::Hum => "mains hum 50 Hz, 2 um",
            Self::Coloured => "noise 1 um below 500 Hz",
            Self::Together => "orbit, runout, offset, sweep, steps and hum at once",
            Self::Load => "load steps up to 1 g, caught",
            Self::Shock => "base shocks up to 2 g, caught",
            Self::Setpoint => "setpoint changes of 50 um in 20 ms",
            Self::Landing => "controlled lift-off and landing",
        }
    }

    /// Whether something happens, so that a fall may be declared but not confirmed.
    fn is_disturbed(self) -> bool {
        use Case::{Landing, Load, Setpoint, Shock};
        matches!(self, Load | Shock | Setpoint | Landing)
    }
}

/// The motion of one stretch.
struct Stretch {
    case: Case,
    floats: Levitated,
    random: ChaCha8Rng,
    steps: Steps,
    coloured: Coloured,
    held: Held,
    /// Of the setpoint's next change.
    change: [f64; 2],
    clearance: f64,
    count: f64,
}

impl Stretch {
    fn new(case: Case, scene: &mut Scene, mut random: ChaCha8Rng) -> Self {
        let [low, high] = SPEEDS;
        let frequency = low * f64::powf(high / low, random.random_range(0.0..1.0));
        let mut floats = Levitated {
            spin: TAU * frequency,
            angle: random.random_range(0.0..TAU),
            ..Levitated::default()
        };
        if random.random() {
            floats.spin = -floats.spin;
        }
        match case {
            Case::Orbit => {
                floats.radius = ORBIT;
                scene.sensors.runout = RUNOUT;
                scene.sensors.runout_harmonic = random.random_range(1..=3);
            }
            Case::Offset => {
                let far = 0.5 * scene.retainer.clearance;
                floats.place = direction(&mut random).map(|part| far * part);
            }
            Case::Coloured => scene.sensors.noise = 0.3e-6,
            Case::Together => {
                scene.sensors.runout = RUNOUT;
                scene.sensors.runout_harmonic = random.random_range(1..=3);
                let far = 0.5 * scene.retainer.clearance;
                floats.place = direction(&mut random).map(|part| far * part);
            }
            _ => {}
        }
        scene.rotor.spin = floats.spin;
        Self {
            case,
            floats,
            steps: Steps::default(),
            coloured: Coloured::default(),
            held: Held::new(if case == Case::Load {
                Kick::Load
            } else {
                Kick::Shock
            }),
            change: direction(&mut random).map(|part| 50e-6 * part),
            clearance: scene.retainer.clearance,
            count: scene.sensors.resolution(),
            random,
        }
    }

    fn next(&mut self, time: f64, period: f64) -> Motion {
        let shift = self.shift(time, period);
        let [x, y] = self.floats.position(time);
        let spin = match self.case {
            Case::Together => TAU * swept(time).0,
            _ => self.floats.spin,
        };
        Motion {
            planes: shift.map(|[u, v]| [x + u, y + v]),
            spin,
            levitated: true,
            bearing: None,
        }
    }

    fn shift(&mut self, time: f64, period: f64) -> Shift {
        match self.case {
            Case::White | Case::Orbit | Case::Offset => Shift::default(),
            Case::Resonance => [resonance(time); PLANES],
            Case::Steps => self.steps.next(&mut self.random, period, self.count),
            Case::Hum => hum(time, 2e-6),
            Case::Coloured => self.coloured.next(&mut self.random, period, 1e-6, 500.0),
            Case::Together => {
                let [x, y] = resonance(time);
                let steps = self.steps.next(&mut self.random, period, self.count);
                let hum = hum(time, 2e-6);
                [0, 1].map(|k| [x + steps[k][0] + hum[k][0], y + steps[k][1] + hum[k][1]])
            }
            Case::Load | Case::Shock => self.held.next(&mut self.random, period),
            Case::Setpoint => {
                // There for half a second, and back.
                let within = time % 1.0;
                let part = smooth((within - 0.25) / 0.02) - smooth((within - 0.75) / 0.02);
                [self.change.map(|way| part * way); PLANES]
            }
            Case::Landing => {
                // On the bottom, lifted, afloat, put down: 4 s each.
                let within = time % 4.0;
                let part = smooth((within - 0.5) / 0.2) - smooth((within - 3.2) / 0.3);
                [[0.0, -self.clearance * (1.0 - part)]; PLANES]
            }
        }
    }
}

/// A speed that goes from 20 to 200 Hz in 10 s and back: Hz, and turns.
fn swept(time: f64) -> (f64, f64) {
    let (low, high, half) = (20.0, 200.0, 10.0);
    let within = time % (2.0 * half);
    let slope = (high - low) / half;
    if within < half {
        let turns = low * within + 0.5 * slope * within * within;
        (low + slope * within, turns)
    } else {
        let left = 2.0 * half - within;
        // As many turns as on the way up, less those still to come.
        let turns = half * (low + high) - low * left - 0.5 * slope * left * left;
        (low + slope * left, turns)
    }
}

/// Orbit at that speed; resonance at 100 Hz with a tenth of critical damping, 30 um there, the response of a
/// steady speed.
fn resonance(time: f64) -> [f64; 2] {
    let (frequency, turns) = swept(time);
    let ratio = frequency / 100.0;
    let (stiff, damped) = (1.0 - ratio * ratio, 0.2 * ratio);
    let radius = 6e-6 * ratio * ratio / f64::hypot(stiff, damped);
    let (sin, cos) = (TAU * turns - damped.atan2(stiff)).sin_cos();
    [radius * cos, radius * sin]
}

/// What a stretch brought.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heard {
    /// Events, of any kind where nothing happens, else falls.
    pub declared: u32,
    /// Falls.
    pub confirmed: u32,
    /// Samples from the first until the monitor was armed.
    armed: Option<u64>,
}

/// Runs `seconds` of `case` on the machine of `scene`.
pub fn listen(
    case: Case,
    scene: &Scene,
    seconds: f64,
    mut random: ChaCha8Rng,
) -> Result<Heard, Failure> {
    let mut scene = scene.clone();
    let seed = random.random();
    let mut stretch = Stretch::new(case, &mut scene, random);
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate).map_err(refused)?;
    let monitor = Monitor::try_new(&scene.monitor_config()).map_err(refused)?;
    let (mut seen, mut state) = (sensors.start(seed), monitor.start());
    let mut heard = Heard::default();
    for number in 0..(seconds * rate) as u64 {
        let motion = stretch.next(number as f64 / rate, 1.0 / rate);
        let sample = sensors.read(&mut seen, &motion);
        for notice in monitor.update(&mut state, &sample) {
            match notice {
                Notice::Declared(event) => {
                    let counts = !case.is_disturbed() || event.kind == EventKind::FreeFall;
                    heard.declared += u32::from(counts);
                }
                Notice::Confirmed { .. } => heard.confirmed += 1,
                Notice::Withdrawn { .. } | Notice::Outlook(_) => {}
            }
        }
        if heard.armed.is_none() && state.is_armed() {
            heard.armed = Some(number);
        }
    }
    Ok(heard)
}

/// Drops to compare two targets with: a start from an orbit that is only followed until the release.
pub fn drops(plan: &Plan, random: &mut ChaCha8Rng) -> Result<Vec<(String, Drop)>, Failure> {
    let mut scene = Scene::load("rig")?;
    scene.run.duration = 1e-3;
    scene.run.seed = random.random();
    scene.sensors.runout = RUNOUT;
    let floats = Levitated {
        radius: ORBIT,
        spin: TAU * 100.0,
        ..Levitated::default()
    };
    let drop = Drop::released(plan, scene, floats, [0.0; 2], 1.0, 0.0);
    Ok(vec![(Case::Orbit.name().to_owned(), drop)])
}

/// Runs the group.
pub fn run(plan: &Plan) -> Result<Findings, Failure> {
    let mut scene = Scene::load("rig")?;
    scene.tuning = plan.tuning;
    let pieces = (plan.seconds / PIECE).ceil();
    let piece = plan.seconds / pieces;
    let heard = campaign::map_of(
        plan.first_seed,
        pieces as u64,
        "quiet",
        &CASES,
        |case, random| listen(*case, &scene, piece, random),
    )?;
    let judged = CASES.iter().zip(&heard);
    Ok(Findings {
        rows: judged
            .map(|(case, heard)| row(*case, heard, plan))
            .collect(),
        figures: vec![confirmation::figure(plan)?],
    })
}

fn row(case: Case, heard: &[Heard], plan: &Plan) -> Row {
    let declared: u32 = heard.iter().map(|it| it.declared).sum();
    let confirmed: u32 = heard.iter().map(|it| it.confirmed).sum();
    let hours = plan.seconds / HOUR;
    let (name, count) = if case.is_disturbed() {
        ("confirmed_per_hour", confirmed)
    } else {
        ("declared_per_hour", declared)
    };
    // A monitor that never listens declares nothing either.
    let deaf = heard.iter().filter(|it| it.armed.is_none()).count();
    let at_most = upper(count) / hours;
    Row::at_most(case.name(), name, f64::from(count) / hours, 0.0)
        .and(deaf == 0)
        .with("hours", hours)
        .with("declared", declared)
        .with("confirmed", confirmed)
        .with("never_armed", deaf)
        .with("upper_95_per_hour", at_most)
        .noted(format!(
            "{declared} declared, {confirmed} confirmed in {} s; 95 %: below {at_most:.1}/h{}",
            plan.seconds,
            if deaf > 0 { "; NEVER ARMED" } else { "" }
        ))
}

/// Upper end of the one-sided 95 % interval of a Poisson mean (Garwood): where `count` or fewer have a
/// probability of 0.05.
fn upper(count: u32) -> f64 {
    if count == 0 {
        return NONE_SEEN;
    }
    let below = |mean: f64| {
        let mut term = (-mean).exp();
        let mut sum = term;
        for number in 1..=count {
            term *= mean / f64::from(number);
            sum += term;
        }
        sum
    };
    // Beyond this the exponential is 0 and the normal limit good to a percent.
    if count > 500 {
        return f64::from(count) + 1.645 * f64::from(count).sqrt() + 2.0;
    }
    let (mut low, mut high) = (f64::from(count), 2.0 * f64::from(count) + 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if below(middle) > 0.05 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables of the Poisson distribution.
    #[test]
    fn the_95_percent_bound() {
        for (count, bound) in [(0, 2.996), (1, 4.744), (5, 10.513), (100, 118.08)] {
            let found = upper(count);
            assert!((found / bound - 1.0).abs() < 1e-3, "{count}: {found}");
        }
        assert!((upper(501) / upper(500) - 1.0).abs() < 0.01);
    }

    #[test]
    fn the_sweep_has_no_jump() {
        let mut last = resonance(0.0);
        for k in 1..450_000 {
            let now = resonance(f64::from(k) * 5e-5);
            let way = f64::hypot(now[0] - last[0], now[1] - last[1]);
            assert!(way < 3e-6, "{k}: {way}");
            last = now;
        }
    }
}
