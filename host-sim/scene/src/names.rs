//! What phases, events and regimes are called in text.

use touchdown_core::detect::Phase;
use touchdown_core::event::{Act, EventKind, Plane};
use touchdown_core::sample::CHANNELS;
use touchdown_protocol::controller::{Busy, Cause, Fault, Mode};

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

/// Name of the cause of what the outputs are.
pub fn cause_name(cause: Cause) -> &'static str {
    match cause {
        Cause::NoProof => "no proof of levitation",
        Cause::Danger => "beyond the danger limit",
        Cause::LevitationOff => "levitation off",
        Cause::PositionsLost => "positions lost",
        Cause::Fall => "fall",
        Cause::Whirl => "whirl",
        Cause::Contact => "contact",
        Cause::Fault => "fault",
        Cause::Order => "order to clear",
    }
}

/// Name of an order.
pub fn act_name(act: Act) -> &'static str {
    match act {
        Act::Clear => "clear",
        Act::Commit(_) => "set configuration",
        Act::Erase(_) => "erase",
        Act::Lock(_) => "lock",
        Act::Unlock(_) => "unlock",
    }
}

/// Why an order is refused.
pub fn busy_name(busy: Busy) -> &'static str {
    match busy {
        Busy::DropRuns => "a drop runs",
        Busy::Blind => "no plane gives a position",
        Busy::Watching => "it watches, so the machine may run",
        Busy::Latched => "a drop is latched",
        Busy::NoRight => "no right: it takes the key of its configuration (--key-file), within 5 s",
        Busy::Service => "no right: it has no key, so its service input must be on",
        Busy::Locked => "the episode is locked",
        Busy::Last => "the episode is the newest one",
        Busy::Configuration => "the configuration is missing, damaged, or of another board: set it",
    }
}

/// Name of a sensor plane.
pub fn plane_name(plane: Plane) -> &'static str {
    match plane {
        Plane::A => "a",
        Plane::B => "b",
        Plane::Both => "both",
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
        Fault::Unconfigured => "not configured",
        Fault::ConfigMisfit => "configuration of another board",
        Fault::MemoryChanged => "memory changed",
        Fault::ImageDamaged => "image damaged",
    }
}

/// Name of a position channel, or of that of the speed.
pub fn channel_name(channel: u8) -> &'static str {
    const NAMES: [&str; CHANNELS + 1] = ["ax", "ay", "bx", "by", "speed"];
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
