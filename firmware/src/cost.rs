//! What settings cost: cycles of a Cortex-M4F, as modelled. How they were measured: docs/build/timing.md.

/// Of a sample, with up to [`MOST_INSTANTS`]: with so many no stream of the budget loses a sample, as the ring takes what the
/// ticks of a drop take longer for a while.
pub const LEAST: f32 = 16_800.0;

/// Most instants in the bank of the release and in that of impacts for which it was measured. More date an impact no better at
/// 20 kHz, a tenth of a sample at 50 kHz.
pub const MOST_INSTANTS: u8 = 16;
