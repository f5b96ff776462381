//! A plugin of QEMU that models the cycles of a Cortex-M4F between two readings of SysTick.
//!
//! Arguments: `code=FILE`, the flash from its first address on; `out=FILE`, which takes four 32-bit numbers for each
//! window between two readings: instructions, and cycles at the least, as modelled and at the most. These are no
//! measured cycles: `docs/build/timing.md`.

mod cost;
mod decode;
mod flash;
// A test binary has no emulator to link with.
#[cfg(not(test))]
mod plugin;

/// Where the flash begins.
const FLASH: u32 = 0x0800_0000;
