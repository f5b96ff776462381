//! A rotor that floats, quiet or disturbed, and what the monitor says of it.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use touchdown_base::evenly::direction;
use touchdown_base::failure::Failure;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_core::sensing::PLANES;
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Motion, Sensors};

use super::disturbance::{Held, Kick, Shift, coloured, hum, smooth, steps};
use super::levitated::{Levitated, ORBIT, RUNOUT};
use super::watch::refused;

/// Lowest and highest frequency of the orbit, Hz.
const SPEEDS: [f64; 2] = [10.0, 500.0];

/// What the machine does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display, strum::VariantArray)]
pub enum Case {
    #[strum(serialize = "white noise 1 um")]
    White,
    #[strum(serialize = "orbit 30 um at 10 to 500 Hz, runout 5 um")]
    Orbit,
    #[strum(serialize = "offset of half the gap")]
    Offset,
    #[strum(serialize = "sweep through a resonance, up to 30 um")]
    Resonance,
    #[strum(serialize = "sensor steps of 1 LSB")]
    Steps,
    #[strum(serialize = "mains hum 50 Hz, 2 um")]
    Hum,
    #[strum(serialize = "noise 1 um below 500 Hz")]
    Coloured,
    #[strum(serialize = "orbit, runout, offset, sweep, steps and hum at once")]
    Together,
    #[strum(serialize = "load steps up to 1 g, caught")]
    Load,
    #[strum(serialize = "base shocks up to 2 g, caught")]
    Shock,
    #[strum(serialize = "setpoint changes of 50 um in 20 ms")]
    Setpoint,
    #[strum(serialize = "controlled lift-off and landing")]
    Landing,
}

impl Case {
    /// Whether something happens, so that a fall may be declared but not confirmed.
    pub fn is_disturbed(self) -> bool {
        use Case::{Landing, Load, Setpoint, Shock};
        matches!(self, Load | Shock | Setpoint | Landing)
    }
}

/// The motion of one stretch.
struct Stretch {
    case: Case,
    scene: Scene,
    floats: Levitated,
    random: ChaCha8Rng,
    /// Of the channels, by steps or by noise.
    shift: Shift,
    held: Held,
    /// Of the setpoint's next change.
    change: [f64; 2],
}

impl Stretch {
    fn new(case: Case, mut scene: Scene, mut random: ChaCha8Rng) -> Self {
        let [low, high] = SPEEDS;
        let frequency = low * f64::powf(high / low, random.random_range(0.0..1.0));
        let angle = random.random_range(0.0..TAU);
        let sign = if random.random() { -1.0 } else { 1.0 };
        let mut floats = Levitated {
            angle,
            spin: sign * TAU * frequency,
            ..Levitated::default()
        };
        match case {
            Case::Orbit => floats.radius = ORBIT,
            Case::Coloured => scene.sensors.noise = 0.3e-6,
            _ => {}
        }
        if matches!(case, Case::Orbit | Case::Together) {
            scene.sensors.runout = RUNOUT;
            scene.sensors.runout_harmonic = random.random_range(1..=3);
        }
        if matches!(case, Case::Offset | Case::Together) {
            let far = 0.5 * scene.retainer.clearance;
            floats.place = direction(&mut random).map(|part| far * part);
        }
        scene.rotor.spin = floats.spin;
        Self {
            case,
            scene,
            floats,
            shift: Shift::default(),
            held: Held::default(),
            change: direction(&mut random).map(|part| 50e-6 * part),
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
        let count = self.scene.sensors.resolution();
        match self.case {
            Case::White | Case::Orbit | Case::Offset => Shift::default(),
            Case::Resonance => [resonance(time); PLANES],
            Case::Steps => steps(&mut self.shift, &mut self.random, period, count),
            Case::Hum => hum(time),
            Case::Coloured => coloured(&mut self.shift, &mut self.random, period),
            Case::Together => {
                let steps = steps(&mut self.shift, &mut self.random, period, count);
                let ([x, y], hum) = (resonance(time), hum(time));
                [0, 1].map(|k| [x + steps[k][0] + hum[k][0], y + steps[k][1] + hum[k][1]])
            }
            Case::Load => self.held.next(Kick::Load, &mut self.random, period),
            Case::Shock => self.held.next(Kick::Shock, &mut self.random, period),
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
                [[0.0, -self.scene.retainer.clearance * (1.0 - part)]; PLANES]
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
    /// Whether the monitor ever was.
    pub armed: bool,
}

/// Runs `seconds` of `case` on the machine of `scene`.
pub fn listen(
    case: Case,
    scene: &Scene,
    seconds: f64,
    mut random: ChaCha8Rng,
) -> Result<Heard, Failure> {
    let seed = random.random();
    let mut stretch = Stretch::new(case, scene.clone(), random);
    let scene = &stretch.scene;
    let rate = scene.run.sample_rate;
    let sensors = Sensors::try_new(&scene.sensors, rate).map_err(refused)?;
    let monitor = Monitor::try_new(&scene.monitor_config()).map_err(refused)?;
    let (mut seen, mut state) = (sensors.start(seed), MonitorState::default());
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
                _ => {}
            }
        }
        heard.armed |= state.detector.is_armed();
    }
    Ok(heard)
}

#[cfg(test)]
mod tests {
    use super::*;

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
