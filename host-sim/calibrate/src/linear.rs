//! Least squares of five unknowns.

use std::array::from_fn;

/// Of the unknowns, or of their factors in an equation.
pub type Vector = [f64; 5];

/// The unknowns that equations (factors and right side) of equal weight agree on best, and their covariance for right
/// sides of variance 1; `None` where the equations leave an unknown open.
///
/// Gauss and Jordan's elimination inverts the normal matrix.
pub fn least_squares(
    equations: impl IntoIterator<Item = (Vector, f64)>,
) -> Option<(Vector, [Vector; 5])> {
    // The normal matrix, and on its right the unit matrix, which becomes the inverse.
    let mut lines: [[f64; 10]; 5] = from_fn(|row| from_fn(|k| f64::from(k == row + 5)));
    let mut right = [0.0; 5];
    for (factors, value) in equations {
        for (row, factor) in factors.iter().enumerate() {
            let line = lines[row].iter_mut().zip(factors);
            line.for_each(|(it, other)| *it += factor * other);
            right[row] += factor * value;
        }
    }
    for column in 0..5 {
        let size = |row: &usize| lines[*row][column].abs();
        let pivot = (column..5).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        lines.swap(column, pivot);
        let scale = 1.0 / lines[column][column];
        if !scale.is_finite() {
            return None;
        }
        let pivot = lines[column].map(|it| it * scale);
        for line in &mut lines {
            let factor = line[column];
            let taken = line.iter_mut().zip(pivot);
            taken.for_each(|(it, pivot)| *it -= factor * pivot);
        }
        lines[column] = pivot;
    }
    let inverse = lines.map(|line| from_fn(|k| line[k + 5]));
    Some((inverse.map(|row| dot(&row, &right)), inverse))
}

/// Variance of what grows with the unknowns by `growth`, where they have this covariance.
pub fn variance(covariance: &[Vector; 5], growth: &Vector) -> f64 {
    dot(growth, &covariance.map(|row| dot(&row, growth)))
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
