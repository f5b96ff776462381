//! The shortest number that a setting reads back from.

/// Digits that tell every f32 from its neighbours.
const DIGITS: usize = 9;

/// The number with the fewest digits which, times `scale` (SI in a unit of the file), is `value` again.
pub(super) fn shortest(value: f32, scale: f64) -> f64 {
    let exact = f64::from(value) / scale;
    let rounded = |digits: usize| {
        let text = format!("{exact:.digits$e}");
        text.parse::<f64>().unwrap_or(exact)
    };
    let reads_back = |it: &f64| (it * scale) as f32 == value;
    let mut tries = (0..DIGITS).map(rounded);
    tries.find(reads_back).unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_a_person_would_write_them() {
        assert_eq!(shortest(0.3e-3, 1e-3), 0.3);
        assert_eq!(
            shortest(-3_141.592_7, std::f64::consts::TAU / 60.0),
            -30_000.0
        );
        assert_eq!(shortest(0.0, 1e-3), 0.0);
        assert_eq!(shortest(2_000e-6 / 4_096.0, 1e-6), 0.488_281_3);
    }
}
