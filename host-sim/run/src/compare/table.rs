//! Two recordings for people.

use super::{By, Comparison, Pair, Tolerance};
use touchdown_base::paint::Paint;
use touchdown_base::plain::{listed, shown};

/// Events that are listed.
const LISTED: usize = 200;

/// How they were aligned, their events side by side, and the verdict.
pub fn table(comparison: &Comparison, paint: Paint) -> String {
    let [a, b] = comparison.files.each_ref().map(|it| shown(it));
    let aligned = &comparison.aligned;
    let mut text = format!("a: {a}\nb: {b}\n");
    text += &match aligned.aligned_by {
        By::Nothing => "not aligned: one of them has no drop\n".to_owned(),
        by => format!(
            "aligned by the first {}: b is {:.6} s later\n",
            if by == By::FreeFall { "fall" } else { "impact" },
            aligned.shift_s
        ),
    };
    let rms = aligned.waveform_rms_m.iter();
    let rms: Vec<_> = rms.map(|it| format!("{:.2}", it * 1e6)).collect();
    let rms = rms.join(", ");
    if !rms.is_empty() {
        text += &format!("waveforms about the drop differ by {rms} um rms\n");
    }
    let head = format!(
        "\n{:<15}{:>14}{:>14}{:>10}{:>10}{:>10}{:>9}",
        "event", "a at s", "b at s", "b - a ms", "a mm/s", "b mm/s", "b - a %"
    );
    text += &(paint.bold(&head) + "\n");
    let what = "events, with --json";
    text += &listed(&comparison.events, LISTED, what, |it| line(it, paint));
    let [one, other] = comparison.regimes.map(|it| it.map_or("none", <&str>::from));
    let not = if one == other { "" } else { "not " };
    text += &format!("\nregime: a {one}, b {other}: {not}the same\n");
    let [one, other] = comparison.severity.map(|it| it.velocity_index);
    text += &format!("velocity index: a {one:.3}, b {other:.3}\n");
    let verdict = verdict(comparison);
    text + &match comparison.beyond {
        0 => paint.good(&verdict),
        _ => paint.bad(&verdict),
    } + "\n"
}

/// One line.
pub fn verdict(comparison: &Comparison) -> String {
    let Tolerance { time_s, speed } = comparison.tolerance;
    let limits = format!("{} ms and {} %", time_s * 1e3, speed * 100.0);
    match comparison.beyond {
        0 => format!("all within {limits}"),
        1 => format!("1 difference beyond {limits}"),
        count => format!("{count} differences beyond {limits}"),
    }
}

fn line(pair: &Pair, paint: Paint) -> String {
    let or = |value: Option<f64>, scale: f64, decimals: usize| {
        value.map_or("-".to_owned(), |it| format!("{:.decimals$}", it * scale))
    };
    let text = format!(
        "{:<15}{:>14}{:>14}{:>10}{:>10}{:>10}{:>9}",
        <&str>::from(pair.event),
        or(pair.a_s, 1.0, 6),
        or(pair.b_s, 1.0, 6),
        or(pair.difference_s, 1e3, 4),
        or(pair.a_speed_m_s, 1e3, 2),
        or(pair.b_speed_m_s, 1e3, 2),
        or(pair.speed_difference, 100.0, 2),
    );
    match pair.within {
        Some(false) => paint.bad(&(text + "  beyond")) + "\n",
        Some(true) => text + "\n",
        None => text + "  not judged\n",
    }
}
