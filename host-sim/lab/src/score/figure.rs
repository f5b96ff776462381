//! What is drawn of a group; drawn in `page`.

use serde::Serialize;

/// A picture's numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Figure {
    /// Curves over two axes.
    Curves {
        /// Heading.
        title: &'static str,
        /// Quantity and unit along x.
        x: &'static str,
        /// Along y.
        y: &'static str,
        /// Whether both axes are logarithmic.
        decades: bool,
        /// All.
        curves: Vec<Curve>,
    },
    /// How often what is true (rows) was told as what (columns).
    Confusion {
        /// Heading.
        title: &'static str,
        /// What is counted.
        unit: &'static str,
        /// Names of the rows.
        truth: Vec<&'static str>,
        /// Names of the columns.
        told: Vec<&'static str>,
        /// By row, then column.
        counts: Vec<Vec<u64>>,
    },
}

/// One curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// For the legend.
    pub name: String,
    /// Whether it is a limit and not measured.
    pub limit: bool,
    /// x and y.
    pub points: Vec<[f64; 2]>,
}

impl Curve {
    /// Measured.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            limit: false,
            points,
        }
    }

    /// What it is held against.
    pub fn limit(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            limit: true,
            ..Self::new(name, points)
        }
    }
}

/// Share of `values` in steps of `width` from 0 on, as a staircase. What is beyond `most` counts but is
/// not drawn.
pub fn histogram(values: &[f64], width: f64, most: f64) -> Vec<[f64; 2]> {
    let bins = (most / width).round() as usize;
    let mut counts = vec![0_u32; bins];
    for value in values {
        let bin = (value / width).floor();
        if let Some(count) = (bin >= 0.0).then(|| counts.get_mut(bin as usize)).flatten() {
            *count += 1;
        }
    }
    let whole = values.len().max(1) as f64;
    let steps = counts.iter().enumerate().flat_map(|(bin, count)| {
        let share = f64::from(*count) / whole;
        let left = bin as f64 * width;
        [[left, share], [left + width, share]]
    });
    steps.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_histogram_counts_what_it_does_not_draw() {
        let steps = histogram(&[0.1, 0.3, 0.3, f64::INFINITY], 0.25, 0.5);
        assert_eq!(steps, [[0.0, 0.25], [0.25, 0.25], [0.25, 0.5], [0.5, 0.5]]);
    }
}
