#![no_std]
//! Square root by the floating-point unit of an Arm microcontroller, by libm elsewhere. Both are
//! correctly rounded, so both give the same bits: docs/decisions/0032-hardware-square-root.md.

/// Square root; NaN below 0. Of a NaN only that it is one is the same everywhere.
#[cfg(all(target_arch = "arm", target_os = "none", target_abi = "eabihf"))]
#[inline]
pub fn sqrt(x: f32) -> f32 {
    let root: f32;
    // SAFETY: reads and writes the named registers only; targets of this ABI have the instruction.
    unsafe {
        core::arch::asm!(
            "vsqrt.f32 {root}, {x}",
            root = lateout(sreg) root,
            x = in(sreg) x,
            options(pure, nomem, nostack, preserves_flags),
        );
    }
    root
}

/// Square root; NaN below 0. Of a NaN only that it is one is the same everywhere.
#[cfg(not(all(target_arch = "arm", target_os = "none", target_abi = "eabihf")))]
#[inline]
pub fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}
