//! What phases, events and regimes are called in text.

use touchdown_core::detect::Phase;
use touchdown_core::event::EventKind;
use touchdown_core::sample::CHANNELS;
use touchdown_protocol::controller::{Fault, Mode};

use touchdown_base::history::{PhaseKind, Regime};

/// Name of a phase.
pub fn phase_name(phase: PhaseKind) -> &'static str {
    match phase {
        PhaseKind::Levitated => "levitated",
        PhaseKind::FreeFall => "free fall",
        PhaseKind::Impact => "impacts",
        PhaseKind::Sliding => "sliding",
        PhaseKind::Rolling => "rolling",
    }
}

/// Name of an event.
pub fn event_name(event: EventKind) -> &'static str {
    match event {
        EventKind::FreeFall => "free fall",
        EventKind::Impact => "impact",
        EventKind::Sliding => "sliding",
        EventKind::Rolling => "rolling",
        EventKind::Pendulum => "pendulum",
        EventKind::ForwardWhirl => "forward whirl",
        EventKind::BackwardWhirl => "backward whirl",
        EventKind::LiftOff => "lift-off",
        EventKind::Rest => "rest",
        EventKind::Levitated => "levitated",
        EventKind::SensorFault => "sensor fault",
    }
}

/// Name of a phase that the detector tells.
pub fn told_phase_name(phase: Phase) -> &'static str {
    match phase {
        Phase::Starting => "starting",
        Phase::Levitated => "levitated",
        Phase::FreeFall => "free fall",
        Phase::Impact => "impacts",
        Phase::Sliding => "sliding",
        Phase::Rolling => "rolling",
    }
}

/// Name of a mode of the controller.
pub fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::SelfTest => "self-test",
        Mode::Arming => "arming",
        Mode::Watching => "watching",
        Mode::Dropped => "dropped",
        Mode::Faulted => "faulted",
    }
}

/// Name of a fault of the controller.
pub fn fault_name(fault: Fault) -> &'static str {
    match fault {
        Fault::Overrun => "overrun",
        Fault::Overload => "overload",
        Fault::SensorsLost => "sensors lost",
        Fault::ConfigChanged => "configuration changed",
        Fault::ConfigDamaged => "configuration damaged",
        Fault::WatchdogReset => "watchdog reset",
        Fault::Crash => "crash",
    }
}

/// Name of a position channel.
pub fn channel_name(channel: u8) -> &'static str {
    const NAMES: [&str; CHANNELS] = ["ax", "ay", "bx", "by"];
    NAMES.get(usize::from(channel)).unwrap_or(&"?")
}

/// Name of a regime.
pub fn regime_name(regime: Regime) -> &'static str {
    match regime {
        Regime::Rest => "rest",
        Regime::Pendulum => "pendulum",
        Regime::ForwardWhirl => "forward whirl",
        Regime::BackwardWhirl => "backward whirl",
        Regime::Intermittent => "intermittent contact",
        Regime::Bouncing => "bouncing",
    }
}
