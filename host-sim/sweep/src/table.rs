//! The points as text.

use super::parameter::{short, text};
use super::plan::{Plan, Until};
use super::summary::{Point, total};
use touchdown_base::paint::Paint;
use touchdown_base::plain::shown;

/// Points that are printed; all are in `points.csv`.
const SHOWN: usize = 40;

/// Of drops that end at their verdict.
pub(super) const NO_END: &str = "Each drop ends where its regime can no longer change: end_load_n and whirl_frequency_hz need until = \"end\".";

/// A line for each point.
pub fn table(plan: &Plan, points: &[Point], paint: Paint) -> String {
    let names: Vec<_> = (plan.listed.iter())
        .map(|(key, _)| key.rsplit('.').next().unwrap_or(key))
        .collect();
    let mut text = paint.bold(&format!(
        "{}: {} drops\n",
        shown(&plan.title),
        total(points)
    ));
    let mut head: String = names.iter().map(|name| format!("{name:>16}")).collect();
    head += "   whirl %     95 % interval  backward %  after ms  impact mm/s";
    text += &(paint.bold(&head) + "\n");
    for point in points.iter().take(SHOWN) {
        text += &line(plan, point);
    }
    if plan.until == Until::Verdict {
        text += &format!("{NO_END}\n");
    }
    if points.len() > SHOWN {
        text += &format!("... {} more points in points.csv\n", points.len() - SHOWN);
    }
    text
}

fn line(plan: &Plan, point: &Point) -> String {
    let values: String = (plan.values(point.point).into_iter())
        .map(|value| format!("{:>16}", shown(&short(&text(value)))))
        .collect();
    let thousand =
        |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{:.1}", 1e3 * value));
    format!(
        "{values}{:>10.2}   {:>6.2} to {:>6.2}{:>12.2}{:>10}{:>13}\n",
        100.0 * point.whirl_probability,
        100.0 * point.whirl_low,
        100.0 * point.whirl_high,
        100.0 * point.backward_probability,
        thousand(point.whirl_start_median_s),
        thousand(point.impact_speed_max_m_s),
    )
}
