//! The front: what is not beaten in both cost and accuracy.

use super::row::Row;

/// Marks the rows that no other row beats: none is at least as quick here and as close at the impacts,
/// and better in one of them.
pub(super) fn mark(rows: &mut [Row]) {
    let points: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.pace.seconds_per_simulated_second, row.accuracy.worst])
        .collect();
    for (row, &point) in rows.iter_mut().zip(&points) {
        row.pareto = point[1].is_finite() && !points.iter().any(|&other| beats(other, point));
    }
}

fn beats(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] <= b[0] && a[1] <= b[1] && a != b
}

#[cfg(test)]
mod tests {
    use super::beats;

    #[test]
    fn a_point_is_beaten_by_what_is_no_worse_and_somewhere_better() {
        assert!(beats([1.0, 1.0], [1.0, 2.0]));
        assert!(beats([1.0, 1.0], [2.0, 2.0]));
        assert!(!beats([1.0, 1.0], [1.0, 1.0]));
        assert!(!beats([1.0, 3.0], [2.0, 2.0]));
    }
}
