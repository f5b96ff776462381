//! Maps and points as one page.

use maud::html;

use super::find::Found;
use super::map;
use super::parameter::{short, text};
use super::plan::{Plan, Until};
use super::summary::{Point, total};
use super::table::NO_END;
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;

/// Points in the page's table; all are in `points.csv`.
const SHOWN: usize = 1_000;

pub(super) fn page(plan: &Plan, points: &[Point], found: Option<&Found>) -> String {
    let tenth = |value: Option<f64>| value.map_or("\u{2013}".to_owned(), |it| format!("{it:.1}"));
    let percent = |share: f64| format!("{:.2}", 100.0 * share);
    let thousand = |value: Option<f64>| tenth(value.map(|it| 1e3 * it));
    let mut table = table("Points of the grid", &points[..points.len().min(SHOWN)]);
    for (index, (key, _)) in plan.listed.iter().enumerate() {
        table = table.number(key, move |it| short(&text(plan.values(it.point)[index])));
    }
    let table = table
        .number("Drops", |it| it.drops)
        .number("Whirl, %", |it| percent(it.whirl_probability))
        .number("95 % interval", |it| {
            percent(it.whirl_low) + " to " + &percent(it.whirl_high)
        })
        .number("Backward, %", |it| percent(it.backward_probability))
        .number("Starts after, ms", |it| thousand(it.whirl_start_median_s))
        .number("Impact, mm/s", |it| thousand(it.impact_speed_max_m_s))
        .number("Load at the end, N", |it| tenth(it.end_load_max_n));
    let start = match plan.start {
        Some(start) => format!(
            "Starts anywhere within {} of the clearance, with up to {} mm/s in any direction.",
            start.within, start.speed_mm_s
        ),
        None => "Starts as in the scene.".to_owned(),
    };
    let drawn: Vec<_> = plan.drawn.iter().map(|(key, _)| key.as_str()).collect();
    let body = html! {
        header {
            p.kind { "Sweep" }
            h1 { (plan.title) }
            p.note {
                (total(points)) " drops, seed " (plan.seed) ". " (start)
                @if !drawn.is_empty() { " Drawn for each drop: " (drawn.join(", ")) "." }
                " Whirl: the rotor ends in a contact in which it has gone round the retainer, in either "
                "direction; its interval is "
                (if found.is_some() { "that of the sequential test." } else { "Wilson's." })
                @if plan.until == Until::Verdict { " " (NO_END) }
            }
            @if let Some(found) = found { p { (found.told()) } }
        }
        section {
            h2 { "Whirl" }
            (map::drawn(plan, points))
        }
        section {
            h2 { "Points" }
            (table.draw())
            @if points.len() > SHOWN { p.note { "The others are in points.csv." } }
        }
    };
    shell(&format!("{} \u{2013} sweep", plan.title), &body).into_string()
}
