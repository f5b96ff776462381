#![no_std]
//! Square root by the floating-point unit of an Arm microcontroller, by libm elsewhere. Both are
//! correctly rounded, so both give the same bits: docs/decisions/0032-hardware-square-root.md.

/// Square root; NaN below 0. Of a NaN only that it is one is the same everywhere.
#[cfg(all(target_arch = "arm", target_os = "none", target_abi = "eabihf"))]
// SAFETY: this ABI passes and returns a single in s0, and only targets with the instruction have it.
#[unsafe(naked)]
pub extern "C" fn sqrt(x: f32) -> f32 {
    core::arch::naked_asm!(".fpu fpv4-sp-d16", "vsqrt.f32 s0, s0", "bx lr")
}

/// Square root; NaN below 0. Of a NaN only that it is one is the same everywhere.
#[cfg(not(all(target_arch = "arm", target_os = "none", target_abi = "eabihf")))]
#[inline]
pub fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}
