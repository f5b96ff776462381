//! What settings cost: cycles of a Cortex-M4F, as modelled. How they were measured: docs/build/timing.md.

/// Of a sample, greatest mean over 10 ms that was met, with up to [`MOST_INSTANTS`] and the interrupts of two conversions: a core
/// that has less is overloaded for as long as a drop lasts, and loses samples.
pub const BUSIEST: f32 = 16_800.0;

/// Most instants in the bank of the release and in that of impacts for which it was measured. More date an impact no better at
/// 20 kHz, a tenth of a sample at 50 kHz.
pub const MOST_INSTANTS: u8 = 16;
