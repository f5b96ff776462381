//! Coefficients of the polynomials, from the constant term up, and what their arguments are reduced by.
//!
//! Minimax by Remez exchange in 50 digits, then rounded: docs/know/polynomials.py prints them. The error of each
//! function is the largest before the rounding, relative but for the cosine.

/// (sin x / x - 1)/x^2 in x^2; error to pi/4: 3.6e-9.
pub(super) const SIN: [f32; 3] = [-0.166_666_55, 0.008_332_178, -0.000_195_173];
/// (cos x - 1 + x^2/2)/x^4 in x^2; error to pi/4: 9.5e-11.
pub(super) const COS: [f32; 3] = [0.041_666_646, -0.001_388_736_8, 2.443_845_2e-5];
/// (atan x / x - 1)/x^2 in x^2; error to tan(pi/8): 2.0e-8.
pub(super) const ATAN: [f32; 4] = [-0.333_329_55, 0.199_779_26, -0.138_798_5, 0.080_603_085];
/// (2 artanh x / x - 2)/x^2 in x^2; error of the logarithm from 1/sqrt(2) to sqrt(2): 8.1e-10.
pub(super) const LN: [f32; 3] = [0.666_667_76, 0.399_775_4, 0.298_717_3];
/// pi/2 as a sum. The first two parts are short: exact times any number of quarter turns in `LONGEST_ANGLE`.
pub(super) const QUARTER_TURN: [f32; 3] = [1.570_312_5, 0.000_483_751_3, 7.549_79e-8];
/// Angle up to which `QUARTER_TURN` keeps all digits, rad.
pub(super) const LONGEST_ANGLE: f32 = 1e4;
/// ln 2 as a sum. The first part is short: exact times any exponent.
pub(super) const LN_2: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];
