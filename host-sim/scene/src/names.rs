//! What phases, regimes, channels and refusals are called in text.

use touchdown_core::sample::CHANNELS;
use touchdown_protocol::controller::Busy;

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
