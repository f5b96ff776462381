//! The functions of the micromath crate: few instructions, three digits.

use ::micromath::F32;

use super::newtype::number;

number!(
    /// Single precision with the sine, cosine, arc tangent and logarithm of micromath 2.1.
    ///
    /// Its square root is not used: off by 6 %, and dearer than the exact one in hardware
    /// (docs/build/timing.md).
    Micro32(f32), sqrt: touchdown_fpu::sqrt, sin_cos: sin_cos, atan2: atan2, ln: ln
);

fn sin_cos(angle: f32) -> (f32, f32) {
    let (sin, cos) = F32(angle).sin_cos();
    (sin.0, cos.0)
}

fn atan2(y: f32, x: f32) -> f32 {
    F32(y).atan2(F32(x)).0
}

fn ln(x: f32) -> f32 {
    F32(x).ln().0
}
