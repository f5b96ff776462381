//! What phases, regimes and channels are called in text.

use touchdown_core::sample::CHANNELS;

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
