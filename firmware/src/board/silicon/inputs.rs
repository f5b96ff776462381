//! What comes with the positions, as far as it is wired: the speed pulse, "levitation on" and the service input.

use touchdown_protocol::config_block::Settings;

use crate::speed::{Speed, pulses_a_capture};

/// Registers of these inputs.
pub trait InputRegisters {
    /// The edge that was captured since the last call, unless another was lost on it, and the timer now. Reading the
    /// capture clears its flag; before the timer, or it could be ahead of it.
    fn capture(&mut self) -> (Option<u16>, u16);

    /// Whether levitation is on.
    fn levitated(&self) -> bool;

    /// Whether the service input is on.
    fn service(&self) -> bool;
}

/// The inputs.
pub struct Inputs<R> {
    registers: R,
    speed: Option<Speed>,
    levitation: bool,
}

impl<R: InputRegisters> Inputs<R> {
    /// Of what `settings` say is wired. `set_up` gives registers that capture every 2^n-th edge, of this n, by a timer of
    /// `hz`.
    pub fn new(settings: &Settings, hz: u32, set_up: impl FnOnce(u8) -> R) -> Self {
        let Settings {
            monitor, wiring, ..
        } = settings;
        let (spin, rate) = (monitor.detector.machine.spin, monitor.detector.sample_rate);
        let captured = wiring
            .pulses_per_turn
            .map(|it| (it, pulses_a_capture(it, spin, rate)));
        let every = captured.map_or(1, |(_, every)| every);
        Self {
            registers: set_up(every.trailing_zeros() as u8),
            speed: captured.map(|(pulses, every)| {
                let turns = f32::from(every) / f32::from(pulses.max(1));
                Speed::new(turns, spin >= 0.0, hz as f32)
            }),
            levitation: wiring.levitation,
        }
    }

    /// Spin, rad/s, where it is known.
    pub fn spin(&mut self) -> Option<f32> {
        let speed = self.speed.as_mut()?;
        let (captured, now) = self.registers.capture();
        speed.take(now, captured)
    }

    /// Whether levitation is commanded on, where that is wired.
    pub fn levitated(&self) -> Option<bool> {
        let is_on = self.registers.levitated();
        self.levitation.then_some(is_on)
    }

    /// Whether the service input is on.
    pub fn service(&self) -> bool {
        self.registers.service()
    }
}
