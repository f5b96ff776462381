//! Numbers and figures as one page.

use maud::{Markup, html};

use super::table::cell;
use super::{Paper, Row, fig_3, fig_4, fig_7};
use touchdown_chart::plot::minus;
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;

/// Writes the page.
pub fn page(paper: &Paper) -> String {
    let body = html! {
        header {
            p.kind { "Source paper: as printed, as right, as ours" }
            h1 { "Impact dynamics of high speed rotors in retainer bearings" }
            p.note {
                "M. Fumagalli, P. Varadi, G. Schweitzer. Rig: 3.42 kg, radius 24 mm, 30 000 rpm clockwise, friction 0.1, \
                 restitution 0.8. The printed numbers are those that text and equations state; the paper's drawings \
                 were not measured, so the figures here show what its laws give, not how its curves ran."
            }
        }
        (verdict(paper))
        section { h2 { "Fig. 3: phase plane at the wall" } (fig_3(paper)) }
        section {
            h2 { "Fig. 4: a drop that whirls, a drop that swings" }
            div.pair {
                @for (drawn, title) in paper.falls.iter().zip(["4a: whirl", "4b: swing"]) {
                    div { h3 { (title) } (fig_4::drawing(drawn, &fig_4::curve(drawn))) }
                }
            }
            p.note {
                "4a starts at the bottom 0.1 % above the least speed for whirl that keeps contact; 4b is released \
                 0.02 mm beside the centre. The paper's own starts are not known. Colours as in the drop's report: \
                 blue flight, orange bounces, yellow sliding. \u{3b8}\u{2032} is drawn beyond 80 % of the clearance: at the \
                 centre it has no bound."
            }
        }
        section {
            h2 { "Fig. 7: contact force" }
            (fig_7::drawing(&paper.figures))
            p.note {
                "Without loss, half the rotor on each of two bearings, after a fall through the gap: in colour the \
                 closed form, dotted over it the run of rung hertz in 1000 steps. The paper measured a contact of 0.2 ms in a window of 0.6 ms, 32.8 to 33.4 ms \
                 after the release. A sphere in a sphere, as in (8) and (9); a cylinder in a ring touches along a line."
            }
        }
        section { h2 { "Numbers" } (numbers(&paper.rows)) }
    };
    shell("The source paper \u{2013} touchdown", &body).into_string()
}

fn verdict(paper: &Paper) -> Markup {
    let count = |is: fn(&&Row) -> bool| paper.rows.iter().filter(is).count();
    let measured = count(|row| row.agrees.is_some());
    let wrong = count(|row| row.agrees == Some(false));
    let off = count(|row| row.is_misprinted());
    let printed = count(|row| row.printed.is_some());
    html! {
        div.verdict.alarm[wrong > 0] {
            "Of " (measured) " numbers measured on the model, " (wrong) " differ from what is right. Of " (printed)
            " printed ones, " (off) " do so by more than 1 %."
        }
    }
}

fn fig_3(paper: &Paper) -> Markup {
    html! {
        (fig_3::drawing(&paper.base, &paper.figures))
        ul.legend {
            li { "A: whirl, contact is kept for ever" }
            li { "B: swing, contact is kept for ever" }
            li { "C: the wall cannot hold the rotor" }
            li { "blank: in contact, but it will lift off" }
        }
        p.note {
            "Friction 0.1, gap 0.3 mm; friction drives towards +\u{3b8} all the time, as with much spin clockwise. Thick: \
             boundaries in closed form. Dashed: no force between rotor and wall. Thin: motions, to the right above \
             0 and to the left below, until the rotor lifts off or reaches the top."
        }
    }
}

fn numbers(rows: &[Row]) -> Markup {
    table("Numbers", rows)
        .words("Number", |it| it.item.clone())
        .number("Printed", |it| number(it.printed))
        .number("Right", |it| number(Some(it.right)))
        .number("Ours", |it| number(it.ours))
        .words("Unit", |it| it.unit)
        .marked("Agrees", agreement)
        .marked("Note", |it| ("note", it.note.clone()))
        .draw()
}

fn number(value: Option<f64>) -> String {
    value.map_or("\u{2013}".to_owned(), |_| minus(&cell(value)))
}

/// With its style class.
fn agreement(row: &Row) -> (&'static str, &'static str) {
    match row.agrees {
        Some(true) => ("", "yes"),
        Some(false) => ("missed", "no"),
        None => ("", "\u{2013}"),
    }
}
