//! Five equations.

/// Of five numbers.
pub type Vector = [f64; 5];
/// Of five rows.
pub type Matrix = [Vector; 5];

/// The inverse, by Gauss and Jordan; `None` where there is none.
pub fn inverse(mut matrix: Matrix) -> Option<Matrix> {
    let unit = |row: usize| std::array::from_fn(|k| f64::from(u8::from(k == row)));
    let mut inverse: Matrix = std::array::from_fn(unit);
    for column in 0..5 {
        let size = |row: &usize| matrix[*row][column].abs();
        let pivot = (column..5).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        let scale = 1.0 / matrix[column][column];
        if !scale.is_finite() {
            return None;
        }
        for k in 0..5 {
            matrix[column][k] *= scale;
            inverse[column][k] *= scale;
        }
        for row in (0..5).filter(|row| *row != column) {
            let factor = matrix[row][column];
            for k in 0..5 {
                matrix[row][k] -= factor * matrix[column][k];
                inverse[row][k] -= factor * inverse[column][k];
            }
        }
    }
    Some(inverse)
}

/// Matrix times vector.
pub fn times(matrix: &Matrix, vector: &Vector) -> Vector {
    matrix.map(|row| dot(&row, vector))
}

/// Product of two vectors.
pub fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds `row` times itself to `matrix`, and `row` times `right` to `sum`.
pub fn add(matrix: &mut Matrix, sum: &mut Vector, row: &Vector, right: f64) {
    for (line, a) in matrix.iter_mut().zip(row) {
        line.iter_mut().zip(row).for_each(|(it, b)| *it += a * b);
    }
    sum.iter_mut().zip(row).for_each(|(it, a)| *it += a * right);
}
