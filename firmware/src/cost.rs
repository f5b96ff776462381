//! What settings cost: cycles of a Cortex-M4F, as modelled. How they were measured: docs/build/timing.md.

use touchdown_core::detect::DetectorConfig;

/// Of a tick, mean, of a rotor that floats on a known orbit, seen by two planes: with no instants in the bank of the release,
/// for each instant, and for each whose level a tick learns.
const FLOATING: [f32; 3] = [6_590.6, 58.94, 135.05];

/// Most instants in the bank of impacts: a tick of a drop takes more than a period with these, and further ones date impacts no
/// better at 20 kHz, a tenth of a sample at 50 kHz.
pub const IMPACT_INSTANTS: u8 = 16;

/// Cycles that a tick of a floating rotor takes on average. Above those of a sample period the core is overloaded for good. A fall
/// or a whirl takes more, for a while: 15 samples wait, further ones are lost.
pub fn floating(config: &DetectorConfig) -> f32 {
    let tuning = &config.tuning;
    let instants = f32::from(tuning.release_instants);
    // Samples from one instant to the next, at which the levels are learnt.
    let stride = (tuning.release_horizon * config.sample_rate / instants).max(1.0) as u16;
    let [tick, instant, learnt] = FLOATING;
    tick + instants * (instant + learnt / f32::from(stride))
}
