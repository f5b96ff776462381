//! What each part is worth, as a picture: how far each quantity changes without it, with the interval of the change.

use maud::{Markup, html};

use super::{Effect, Omission, Worth};
use touchdown_chart::plot::{Axis, columns};

/// Height of a quantity, px, and the line's place in it.
const ROW: f64 = 40.0;
const LINE: f64 = 28.0;

/// A picture for each part.
pub fn drawing(worth: &Worth) -> Markup {
    html! {
        @for it in &worth.without {
            h3 { "Without: " (it.part) }
            (part(it))
        }
    }
}

fn part(omission: &Omission) -> Markup {
    let seen: Vec<&Effect> = omission.changes.iter().filter(|it| it.is_seen()).collect();
    let x = Axis::new(
        -100.0,
        100.0,
        "change, % of the greater mean; of shares, their difference",
        8.0,
    );
    let height = seen.len() as f64 * ROW;
    html! {
        @if seen.is_empty() { p.note { "No change was seen." } } @else {
            div.chart {
                svg role="img" width="100%" height=(height + 40.0) {
                    title { "Changes without " (omission.part) }
                    (columns(&x, height))
                    @for (index, change) in seen.iter().enumerate() { (row(change, &x, index as f64 * ROW)) }
                }
            }
        }
    }
}

fn row(change: &Effect, x: &Axis, top: f64) -> Markup {
    let percent = |value: f64| x.percent(100.0 * change.relative(value));
    let [low, high] = change.interval.map(percent);
    let y = top + LINE;
    html! {
        text.label x="0" y=(top + 16.0) {
            (change.quantity) ": " (change.shown(change.whole)) " \u{2192} " (change.shown(change.without))
        }
        line.whisker x1=(low) x2=(high) y1=(y) y2=(y) {}
        circle.mean cx=(percent(change.without - change.whole)) cy=(y) r="4" {}
    }
}
