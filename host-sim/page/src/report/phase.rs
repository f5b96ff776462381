//! The phases of a drop, and how the page marks them.

use touchdown_base::history::PhaseKind;

/// All phases, in the order of the legend.
pub const PHASES: [PhaseKind; 5] = [
    PhaseKind::Levitated,
    PhaseKind::FreeFall,
    PhaseKind::Impact,
    PhaseKind::Sliding,
    PhaseKind::Rolling,
];

/// Style class of a phase.
pub fn phase_class(phase: PhaseKind) -> &'static str {
    match phase {
        PhaseKind::Levitated => "levitated",
        PhaseKind::FreeFall => "free-fall",
        PhaseKind::Impact => "impact",
        PhaseKind::Sliding => "sliding",
        PhaseKind::Rolling => "rolling",
    }
}
