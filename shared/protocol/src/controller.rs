//! What the safety controller is doing: its mode, its faults and its outputs.

use serde::{Deserialize, Serialize};
use strum::{FromRepr, IntoStaticStr, VariantArray};

/// What the controller is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, FromRepr, VariantArray)]
#[repr(u8)]
#[derive(IntoStaticStr, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "kebab-case")]
pub enum Mode {
    /// Switched on; waits for sensors that deliver and for the first whole check of the configuration.
    #[default]
    SelfTest = 0,
    /// Levitation is not proven.
    Arming = 1,
    /// Levitation is proven: what the guard or the detector finds trips.
    Watching = 2,
    /// The guard or the detector tripped. Latched.
    Dropped = 3,
    /// A fault that trips is latched.
    Faulted = 4,
}

/// Why the outputs are as they are; a trip's stays until cleared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, FromRepr)]
#[repr(u8)]
#[derive(IntoStaticStr, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "lowercase")]
pub enum Cause {
    /// Levitation has not been proven.
    #[default]
    #[strum(serialize = "no proof of levitation")]
    NoProof = 0,
    /// A plane was beyond the danger limit.
    #[strum(serialize = "beyond the danger limit")]
    Danger = 1,
    /// The levitation signal was off.
    #[strum(serialize = "levitation off")]
    LevitationOff = 2,
    /// No plane delivered a position.
    #[strum(serialize = "positions lost")]
    PositionsLost = 3,
    /// The detector confirmed a fall.
    Fall = 4,
    /// The detector told whirl.
    Whirl = 5,
    /// The detector told an impact or permanent contact.
    Contact = 6,
    /// A fault of the controller.
    Fault = 7,
    /// An order: cleared.
    #[strum(serialize = "order to clear")]
    Order = 8,
}

impl Cause {
    /// In a byte: 0 for none, else one more than its code.
    pub fn byte_of(cause: Option<Self>) -> u8 {
        cause.map_or(0, |it| 1 + it as u8)
    }

    /// From that byte. A cause that is not known here is one all the same.
    pub fn of_byte(byte: u8) -> Option<Self> {
        Some(Self::from_repr(byte.checked_sub(1)?).unwrap_or(Self::Contact))
    }
}

/// What the controller shows: it is told at each change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// The outputs.
    pub outputs: Outputs,
    /// What it is doing.
    pub mode: Mode,
    /// Why; none while it watches.
    pub cause: Option<Cause>,
}

impl Shown {
    /// What waits for an order to clear: a drop by its cause, or a fault.
    pub fn latched(&self) -> Option<Cause> {
        match self.mode {
            Mode::Dropped => self.cause,
            Mode::Faulted => Some(Cause::Fault),
            Mode::SelfTest | Mode::Arming | Mode::Watching => None,
        }
    }
}

/// The outputs, each `true` where its coil or lamp has current. Without current all are safe, so loss
/// of power, reset and a trip look the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Outputs {
    /// Trip relay: with current, the machine may run.
    pub run: bool,
    /// Brake relay: with current, no braking is requested.
    pub no_brake: bool,
    /// Permit relay: with current, the magnetic bearings may lift the rotor.
    pub permit: bool,
    /// Ready lamp: watching, the detector is armed, and no fault latched.
    pub ready: bool,
}

impl Outputs {
    /// Without current: tripped, brake requested, no permit, lamp dark.
    pub const SAFE: Self = Self {
        run: false,
        no_brake: false,
        permit: false,
        ready: false,
    };

    /// Bit 0 `run`, 1 `no_brake`, 2 `permit`, 3 `ready`.
    pub const fn bits(self) -> u8 {
        self.run as u8
            | (self.no_brake as u8) << 1
            | (self.permit as u8) << 2
            | (self.ready as u8) << 3
    }

    /// From [`Self::bits`]; `None` where a bit beyond them is set.
    pub fn from_bits(bits: u8) -> Option<Self> {
        (bits >> 4 == 0).then_some(Self {
            run: bits & 1 != 0,
            no_brake: bits & 2 != 0,
            permit: bits & 4 != 0,
            ready: bits & 8 != 0,
        })
    }
}

/// What can be wrong with the controller; latched until cleared.
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray, IntoStaticStr, Serialize)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "lowercase")]
pub enum Fault {
    /// A tick came too late and lost a sample.
    Overrun = 0,
    /// Samples were lost for so long that the monitor was as good as blind.
    Overload = 1,
    /// No plane delivered a position.
    #[strum(serialize = "sensors lost")]
    SensorsLost = 2,
    /// The configuration in memory changed by itself.
    #[strum(serialize = "configuration changed")]
    ConfigChanged = 3,
    /// The stored configuration was damaged at power-on: the defaults are in force.
    #[strum(serialize = "configuration damaged")]
    ConfigDamaged = 4,
    /// The watchdog reset the core.
    #[strum(serialize = "watchdog reset")]
    WatchdogReset = 5,
    /// The program stopped by a panic or a fault of the core, and left a record.
    Crash = 6,
    /// No configuration is stored: the defaults are in force.
    #[strum(serialize = "not configured")]
    Unconfigured = 7,
    /// The stored configuration is none of this board's: the defaults are in force.
    #[strum(serialize = "configuration of another board")]
    ConfigMisfit = 8,
    /// Coefficients in memory, which follow from the configuration, changed by themselves.
    #[strum(serialize = "memory changed")]
    MemoryChanged = 9,
    /// The image in flash is not what was built.
    #[strum(serialize = "image damaged")]
    ImageDamaged = 10,
}

/// A set of faults; bit i is the fault of code i.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Faults(pub u16);

impl Faults {
    /// None.
    pub const NONE: Self = Self(0);

    /// The others only put out the ready lamp.
    const TRIPPING: u16 = !Self::NONE.with(Fault::Overrun).0;
    const LASTING: u16 = Self::NONE
        .with(Fault::ConfigDamaged)
        .with(Fault::Unconfigured)
        .with(Fault::ConfigMisfit)
        .with(Fault::ImageDamaged)
        .0;

    /// These and `fault`.
    #[must_use]
    pub const fn with(self, fault: Fault) -> Self {
        Self(self.0 | 1 << fault as u8)
    }

    /// Whether `fault` is among them.
    pub const fn contains(self, fault: Fault) -> bool {
        self.0 & (1 << fault as u8) != 0
    }

    /// Each, in the order of their codes.
    pub fn iter(self) -> impl Iterator<Item = Fault> {
        let all = Fault::VARIANTS.iter().copied();
        all.filter(move |it| self.contains(*it))
    }

    /// Whether one of them trips.
    pub const fn trip(self) -> bool {
        self.0 & Self::TRIPPING != 0
    }

    /// Whether one of them takes another configuration or image to go away.
    pub const fn lasting(self) -> bool {
        self.0 & Self::LASTING != 0
    }
}

/// Why the controller does not do what it was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, FromRepr)]
#[repr(u8)]
pub enum Busy {
    /// The rotor falls, bounces, slides or whirls.
    DropRuns,
    /// No plane delivers a position.
    Blind,
    /// It watches: the machine may be running.
    Watching,
    /// A drop is latched, to be cleared first.
    Latched,
    /// No nonce, a wrong answer to it, or one that came too late.
    NoRight,
    /// There is no key, and the service input is off.
    Service,
    /// The episode is locked.
    Locked,
    /// The episode is the newest one.
    Last,
    /// There is no configuration, a damaged one, or one of another board; or the image is damaged.
    Configuration,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_their_bits() {
        for bits in 0..16 {
            assert_eq!(Outputs::from_bits(bits).map(Outputs::bits), Some(bits));
        }
        assert_eq!(Outputs::from_bits(16), None);
    }

    #[test]
    fn codes_are_the_order() {
        for (code, &fault) in Fault::VARIANTS.iter().enumerate() {
            assert_eq!(fault as usize, code);
            assert_eq!(Faults::NONE.with(fault).0, 1 << code);
            assert_eq!(Faults::NONE.with(fault).trip(), fault != Fault::Overrun);
        }
        let causes = (0..).map_while(Cause::from_repr);
        assert!(causes.map(|it| it as usize).eq(0..9));
        let modes = Mode::VARIANTS.iter();
        assert!(modes.map(|it| *it as usize).eq(0..5));
    }
}
