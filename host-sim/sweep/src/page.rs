//! Maps and points as one page.

use maud::html;

use super::columns::text;
use super::map;
use super::plan::Plan;
use super::summary::Point;
use super::table::short;
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;

/// Points in the page's table; all are in `points.csv`.
const SHOWN: usize = 1_000;

/// Writes the page.
pub(super) fn page(plan: &Plan, points: &[Point]) -> String {
    let head = html! {
        @for (key, _) in &plan.listed { th.number { (key) } }
        th.number { "Drops" }
        th.number { "Whirl, %" }
        th.number { "95 % interval" }
        th.number { "Backward, %" }
        th.number { "Starts after, ms" }
        th.number { "Impact, mm/s" }
        th.number { "Load at the end, N" }
    };
    let thousand = |value: Option<f64>| {
        value.map_or("\u{2013}".to_owned(), |value| format!("{:.1}", 1e3 * value))
    };
    let cells = |point: &Point| {
        html! {
            @for value in plan.values(point.point) { td.number { (short(&text(value))) } }
            td.number { (point.drops) }
            td.number { (format!("{:.2}", 100.0 * point.whirl_probability)) }
            td.number {
                (format!("{:.2} to {:.2}", 100.0 * point.whirl_low, 100.0 * point.whirl_high))
            }
            td.number { (format!("{:.2}", 100.0 * point.backward_probability)) }
            td.number { (thousand(point.whirl_start_median_s)) }
            td.number { (thousand(point.impact_speed_max_m_s)) }
            td.number { (point.end_load_max_n.map_or("\u{2013}".to_owned(), |it| format!("{it:.1}"))) }
        }
    };
    let start = match plan.start {
        Some(start) => format!(
            "Starts anywhere within {} of the clearance, with up to {} mm/s in any direction.",
            start.within,
            1e3 * start.speed
        ),
        None => "Starts as in the scene.".to_owned(),
    };
    let drawn: Vec<_> = plan.drawn.iter().map(|(key, _)| key.as_str()).collect();
    let body = html! {
        header {
            p.kind { "Sweep" }
            h1 { (plan.title) }
            p.note {
                (plan.size()) " drops, seed " (plan.seed) ". " (start)
                @if !drawn.is_empty() { " Drawn for each drop: " (drawn.join(", ")) "." }
                " Whirl: the rotor ends in a contact in which it has gone round the retainer, in either "
                "direction; its interval is Wilson's."
            }
        }
        section {
            h2 { "Whirl" }
            (map::drawn(plan, points))
        }
        section {
            h2 { "Points" }
            (table("Points of the grid", &head, points.iter().take(SHOWN).map(cells)))
            @if points.len() > SHOWN { p.note { "The others are in points.csv." } }
        }
    };
    shell(&format!("{} \u{2013} sweep", plan.title), &body).into_string()
}
