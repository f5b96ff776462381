//! Odd roots in f32, which libm has in f64 or by logarithms.

/// Newton's steps: the first guess is right to a few per cent, and each doubles the digits.
const STEPS: usize = 3;

/// The `N`th root, N 3 or 5, to 3e-7 of it; of a number above 0 and finite.
pub fn root<const N: u16>(x: f32) -> f32 {
    let part = 1.0 / f32::from(N);
    // A number's bits are nearly its logarithm.
    let one = 1.0_f32.to_bits();
    let from_one = (x.to_bits() as i32).wrapping_sub(one as i32) / i32::from(N);
    let mut root = f32::from_bits((one as i32).wrapping_add(from_one) as u32);
    for _ in 0..STEPS {
        let square = root * root;
        let power = if N == 3 { square } else { square * square };
        root += part * (x / power - root);
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_libm_has_them() {
        let mut x = 1e-30_f32;
        while x < 1e30 {
            let cube = root::<3>(x) / libm::cbrtf(x) - 1.0;
            let fifth = root::<5>(x) / libm::powf(x, 0.2) - 1.0;
            assert!(
                cube.abs() < 3e-7 && fifth.abs() < 3e-7,
                "{x}: {cube}, {fifth}"
            );
            x *= 1.37;
        }
    }
}
