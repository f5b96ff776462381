//! Small linear systems.

/// Pivots below this part of their diagonal are none: the unknown is superfluous.
const SUPERFLUOUS: f64 = 1e-10;

/// What times the right side gives the unknowns, by elimination; an unknown that the others already determine
/// is 0.
pub fn inverse(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let size = matrix.len();
    let scale: Vec<f64> = (0..size).map(|k| matrix[k][k].abs()).collect();
    let unit = |row: usize| {
        (0..size)
            .map(|k| if k == row { 1.0 } else { 0.0 })
            .collect()
    };
    let mut right: Vec<Vec<f64>> = (0..size).map(unit).collect();
    let mut row_of = vec![None; size];
    for column in 0..size {
        let weight = |row: usize| matrix[row][column].abs() / scale[row];
        let pivot = (0..size)
            .filter(|row| !row_of.contains(&Some(*row)))
            .max_by(|a, b| weight(*a).total_cmp(&weight(*b)))
            .filter(|row| weight(*row) > SUPERFLUOUS);
        row_of[column] = pivot;
        let Some(pivot) = pivot else { continue };
        let (line, known) = (matrix[pivot].clone(), right[pivot].clone());
        for row in (0..size).filter(|row| *row != pivot) {
            let factor = matrix[row][column] / line[column];
            let take = |from: &mut [f64], what: &[f64]| {
                for (entry, taken) in from.iter_mut().zip(what) {
                    *entry -= factor * taken;
                }
            };
            take(&mut matrix[row][column..], &line[column..]);
            take(&mut right[row], &known);
        }
    }
    let unknown = |column: usize| match row_of[column] {
        Some(row) => right[row].iter().map(|x| x / matrix[row][column]).collect(),
        None => vec![0.0; size],
    };
    (0..size).map(unknown).collect()
}

/// Solves a linear system; an unknown that the others already determine is 0.
pub fn solve(matrix: Vec<Vec<f64>>, right: &[f64]) -> Vec<f64> {
    times(&inverse(matrix), right)
}

/// A matrix times a vector.
pub fn times(matrix: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    let line = |line: &Vec<f64>| line.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.iter().map(line).collect()
}
