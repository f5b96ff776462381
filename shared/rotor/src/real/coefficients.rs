//! Coefficients of the polynomials, and what their arguments are reduced by.
//!
//! Minimax by Remez exchange in 50 digits, then rounded: docs/know/polynomials.py prints them. Before the
//! rounding the largest errors are, relative but for the cosine:
//!
//! | | f32 | f64 |
//! |---|---|---|
//! | sine, to pi/4 | 3.6e-9 | 3.4e-18 |
//! | cosine, to pi/4 | 9.5e-11 | 4.7e-20 |
//! | arc tangent, to tan(pi/8) | 2.0e-8 | 3.4e-17 |
//! | logarithm, 1/sqrt(2) to sqrt(2) | 8.1e-10 | 1.2e-18 |

/// For one precision; polynomials from the constant term up.
pub struct Coefficients<R: 'static> {
    /// (sin x / x - 1)/x^2 in x^2.
    pub(super) sin: &'static [R],
    /// (cos x - 1 + x^2/2)/x^4 in x^2.
    pub(super) cos: &'static [R],
    /// (atan x / x - 1)/x^2 in x^2.
    pub(super) atan: &'static [R],
    /// (2 artanh x / x - 2)/x^2 in x^2.
    pub(super) ln: &'static [R],
    /// pi/2 as a sum. The first two parts are short: exact times any number of quarter turns in
    /// `longest_angle`.
    pub(super) quarter_turn: [R; 3],
    /// Angle up to which `quarter_turn` keeps all digits, rad.
    pub(super) longest_angle: R,
    /// ln 2 as a sum. The first part is short: exact times any exponent.
    pub(super) ln_2: [R; 2],
}

/// Single precision.
pub(super) const SINGLE: Coefficients<f32> = Coefficients {
    sin: &[-0.166_666_55, 0.008_332_178, -0.000_195_173],
    cos: &[0.041_666_646, -0.001_388_736_8, 2.443_845_2e-5],
    atan: &[-0.333_329_55, 0.199_779_26, -0.138_798_5, 0.080_603_085],
    ln: &[0.666_667_76, 0.399_775_4, 0.298_717_3],
    quarter_turn: [1.570_312_5, 0.000_483_751_3, 7.549_79e-8],
    longest_angle: 1e4,
    ln_2: [0.693_145_75, 1.428_606_8e-6],
};

/// Double precision.
pub(super) const DOUBLE: Coefficients<f64> = Coefficients {
    sin: &[
        -0.166_666_666_666_666_32,
        0.008_333_333_333_322_425,
        -0.000_198_412_698_298_169_65,
        2.755_731_369_523_073_1e-6,
        -2.505_075_865_386_057e-8,
        1.589_682_795_976_043_3e-10,
    ],
    cos: &[
        0.041_666_666_666_666_6,
        -0.001_388_888_888_887_414,
        2.480_158_728_949_183_5e-5,
        -2.755_731_435_524_342e-7,
        2.087_572_368_460_035e-9,
        -1.135_966_987_490_187_9e-11,
    ],
    atan: &[
        -0.333_333_333_333_302_2,
        0.199_999_999_991_046_64,
        -0.142_857_141_965_265_47,
        0.111_111_067_035_461_05,
        -0.090_907_835_282_371_37,
        0.076_900_833_482_913_38,
        -0.066_412_461_876_741_98,
        0.056_931_644_865_597_984,
        -0.043_608_244_913_722_163,
        0.021_280_131_489_482_28,
    ],
    ln: &[
        0.666_666_666_666_673_4,
        0.399_999_999_994_146_8,
        0.285_714_287_423_876_34,
        0.222_221_985_731_799_56,
        0.181_835_643_264_554_5,
        0.153_140_505_420_423_27,
        0.147_959_498_104_820_27,
    ],
    quarter_turn: [
        1.570_796_326_734_125_6,
        6.077_100_506_303_966e-11,
        2.022_266_248_795_950_7e-21,
    ],
    longest_angle: 1e6,
    ln_2: [0.693_147_180_559_890_3, 5.497_923_018_708_371e-14],
};
