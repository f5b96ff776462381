//! The source paper, number by number: as printed, as right, as ours.
//!
//! M. Fumagalli, P. Varadi, G. Schweitzer, "Impact dynamics of high speed rotors in retainer bearings".
//! The printed numbers are those that its text and equations state; its drawings were not measured.

mod contact;
mod drops;
mod ending;
mod equations;
mod fall;
mod fig_3;
mod fig_4;
mod fig_7;
mod hertz;
mod page;
mod rig;
mod row;
mod straight;
mod table;
mod whirl;

pub use drops::{Condition, Tally};
pub use fig_4::Drawn;
pub use page::page;
pub use row::Row;
pub use table::table;

use maud::Markup;
use serde::Serialize;

use touchdown_base::failure::Failure;
use touchdown_chart::plot::Chart;
use touchdown_scene::Scene;

/// Random drops of a condition, unless fewer are asked for.
pub const DROPS: u32 = 1000;

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub struct Paper {
    /// The numbers.
    pub rows: Vec<Row>,
    /// The counts behind the rows on random drops.
    pub drops: Vec<Tally>,
    /// The curves of the drawings.
    pub figures: Vec<Curve>,
    /// The drops of Fig. 4.
    #[serde(skip)]
    pub falls: Vec<Drawn>,
    /// The rig.
    #[serde(skip)]
    pub base: Scene,
}

impl Paper {
    /// Whether every number of ours is right.
    pub fn agrees(&self) -> bool {
        self.rows.iter().all(|row| row.agrees != Some(false))
    }
}

/// A curve of a figure, in the units that it names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// Of the paper.
    pub figure: &'static str,
    /// What it shows.
    pub name: String,
    /// Quantity and unit of the first coordinate.
    pub x: &'static str,
    /// Of the second.
    pub y: &'static str,
    /// In order; null breaks the curve.
    pub points: Vec<Option<[f64; 2]>>,
    /// Style class.
    #[serde(skip)]
    pub class: &'static str,
}

impl Curve {
    /// Draws it in other units: both coordinates times a factor.
    pub fn draw(&self, chart: &Chart<'_>, [x, y]: [f64; 2]) -> Markup {
        let points = self.points.iter().map(|it| it.unwrap_or([f64::NAN; 2]));
        chart.curve(self.class, points.map(|it| (it[0] * x, it[1] * y)))
    }

    /// The greatest second coordinate, 0 or more.
    pub fn top(&self) -> f64 {
        self.values().fold(0.0, f64::max)
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.points.iter().flatten().map(|it| it[1])
    }
}

/// Works everything out, with so many random drops of a condition.
pub fn run(drops: u32) -> Result<Paper, Failure> {
    let base = rig::rig()?;
    let drops = drops::tally(&base, drops)?;
    let mut rows = equations::rows(&base)?;
    rows.extend(fall::rows(&base)?);
    rows.extend(whirl::rows(&base)?);
    rows.extend(drops::rows(&drops));
    rows.extend(contact::rows(&base)?);
    let falls = fig_4::drops()?;
    let mut figures = fig_3::curves(&base);
    figures.extend(falls.iter().map(fig_4::curve));
    figures.extend(fig_7::curves(&base)?);
    Ok(Paper {
        rows,
        drops,
        figures,
        falls,
        base,
    })
}
