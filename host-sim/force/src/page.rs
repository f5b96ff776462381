//! What was measured, for people: a table, and a page.

use maud::{Markup, html};

use super::Measurement;
use super::calibration::Calibration;
use super::pulse::{Contact, Pulse};
use super::recording::Recording;
use super::spectrum::Transform;
use touchdown_base::plain::shown;
use touchdown_chart::plot::{Axis, Chart, key};
use touchdown_chart::shell::page as shell;
use touchdown_chart::table::table;
use touchdown_chart::text::{ms, or_dash, si, significant};

const HEIGHT: f64 = 280.0;
/// Contacts that are drawn one by one, strongest first.
const DRAWN: usize = 2;
/// Style of each axis' curve.
const CLASSES: [&str; 2] = ["motion", "impact"];
/// Lowest frequency of the drawing, Hz.
const LOWEST: f64 = 10.0;

/// The pulses as a table.
pub fn text(recording: &str, measurement: &Measurement) -> String {
    let [low, high] = measurement.band;
    let mut text = format!(
        "{}: {:.0} Hz; calibrated from {low:.0} to {high:.0} Hz",
        shown(recording),
        measurement.sample_rate
    );
    let calibrations = measurement.calibrations.iter();
    if let Some(least) = calibrations.filter_map(|it| it.coherence).reduce(f64::min) {
        text += &format!(", coherence {least:.4}");
    }
    text += &format!("; noise {:.1} N\n\n", measurement.force.noise);
    if measurement.contacts.is_empty() {
        return text + "No contact stands clear of the noise.\n";
    }
    text += "   time      peak  contact  impulse  direction\n";
    text += "     ms         N       us      N s   from the bottom\n";
    for pulse in measurement.pulses() {
        let contact = pulse.contact_time_s;
        let contact = contact.map_or("-".to_owned(), |time| format!("{:.1}", 1e6 * time));
        text += &format!(
            "{:>7.3}  {:>8.1}  {contact:>7}  {:>7.4}  {:>+9.2}\n",
            1e3 * pulse.time_s,
            pulse.peak_force_n,
            pulse.impulse_n_s,
            pulse.direction_deg
        );
    }
    text
}

/// Writes the page.
pub fn page(recording: &Recording, measurement: &Measurement) -> String {
    let [low, high] = measurement.band;
    let mut strongest: Vec<&Contact> = measurement.contacts.iter().collect();
    strongest.sort_by(|a, b| b.pulse.peak_force_n.total_cmp(&a.pulse.peak_force_n));
    strongest.truncate(DRAWN);
    let body = html! {
        header {
            p.kind { "Contact force" }
            h1 { (recording.file) }
            p.note {
                "Recovered from accelerations at " (si(measurement.sample_rate, "Hz"))
                " with a device calibrated from " (si(low, "Hz")) " to " (si(high, "Hz"))
                ". Noise of the force: " (si(measurement.force.noise, "N")) "."
            }
        }
        section {
            h2 { "Contacts" }
            (rows(measurement))
            p.note {
                "Force of the rotor on the retainer, friction included. Direction: from the bottom, \
                 counter-clockwise. Peak and contact time are those of the law of the contact, fitted to \
                 the recovered force; a dash: none fits. Outside the contacts the force is 0."
            }
        }
        section { h2 { "Force" } (whole(recording, measurement)) }
        @if !strongest.is_empty() {
            section {
                h2 { "Strongest contacts" }
                ul.legend { (key("pulse", "recovered")) (key("pulse run", "law of the contact, fitted")) }
                div.pair { @for contact in strongest { div { (one(contact)) } } }
            }
        }
        section {
            h2 { "Device" }
            ul.legend {
                li {
                    svg width="34" height="12" aria-hidden="true" {
                        rect class="band free-fall" x="1" y="1" width="32" height="10" {}
                    }
                    "band that is used"
                }
            }
            (device(measurement))
            p.note { "Acceleration over force, from the known hits." }
        }
    };
    let title = format!("{} \u{2013} contact force", recording.file);
    shell(&title, &body).into_string()
}

fn rows(measurement: &Measurement) -> Markup {
    let pulses: Vec<&Pulse> = measurement.pulses().collect();
    table("Contacts", &pulses)
        .number("Time\nms", |it| ms(it.time_s))
        .number("Peak\nN", |it| significant(it.peak_force_n, 4))
        .number("Contact\nms", |it| or_dash(it.contact_time_s, ms))
        .number("Impulse\nN s", |it| significant(it.impulse_n_s, 4))
        .number("Direction\ndegree", |it| significant(it.direction_deg, 4))
        .draw()
}

/// Both axes over the whole recording.
fn whole(recording: &Recording, measurement: &Measurement) -> Markup {
    let axes = &measurement.force.axes;
    let samples = axes.first().map_or(0, Vec::len);
    let time = |k: usize| recording.start + k as f64 / recording.rate;
    let values = || axes.iter().flatten().copied();
    let chart = Chart {
        title: "Recovered force",
        description: "Force on the retainer along each axis over the recording.",
        x: &Axis::scaled(1e3, time(0), time(samples), "time, ms", 8.0),
        y: &force_axis(values().fold(0.0, f64::min), values().fold(0.0, f64::max)),
        height: HEIGHT,
    };
    let drawn = html! {
        @for (axis, class) in axes.iter().zip(CLASSES) {
            (chart.curve(class, axis.iter().enumerate().map(|(k, force)| (time(k), *force))))
        }
    };
    html! {
        ul.legend { @for ((_, class), name) in axes.iter().zip(CLASSES).zip(["to the right", "up"]) { (key(class, name)) } }
        (chart.plain(&drawn))
    }
}

fn one(contact: &Contact) -> Markup {
    let points = &contact.recovered;
    let forces = || points.iter().map(|it| it.1);
    let [first, last] = [points.first(), points.last()].map(|it| it.map_or(0.0, |it| it.0));
    let top = forces().fold(contact.pulse.peak_force_n, f64::max);
    let chart = Chart {
        title: "Contact",
        description: "Recovered force of a contact, and the law of the contact fitted to it.",
        x: &Axis::scaled(1e3, first, last, "time, ms", 5.0),
        y: &force_axis(forces().fold(0.0, f64::min), top),
        height: HEIGHT,
    };
    chart.plain(&html! {
        (chart.curve("pulse", points.iter().copied()))
        (chart.curve("pulse run", contact.fitted.iter().copied()))
    })
}

/// Size of H over frequency, and the band.
fn device(measurement: &Measurement) -> Markup {
    let curve = |calibration: &Calibration| {
        let transform = Transform::holding(calibration.longest());
        let step = calibration.rate / transform.length as f64;
        let response = calibration.response(&transform);
        let sizes = response.h.iter().enumerate();
        let points = sizes.map(|(k, h)| (k as f64 * step, h.norm()));
        let class = CLASSES[calibration.axis as usize];
        (class, points.filter(|it| it.0 >= LOWEST).collect())
    };
    let curves: Vec<(_, Vec<_>)> = measurement.calibrations.iter().map(curve).collect();
    let sizes = || curves.iter().flat_map(|it| &it.1).map(|it| it.1);
    let [low, high] = measurement.band;
    let x = Axis::decades(LOWEST, 0.5 * measurement.sample_rate, "frequency, Hz", 6.0);
    let most = sizes().fold(0.0, f64::max).max(1e-9);
    let least = sizes().fold(most, f64::min).max(1e-4 * most);
    let y = Axis::decades(least, most, "acceleration over force, 1/kg", 6.0);
    let chart = Chart {
        title: "Device",
        description: "Size of acceleration over force against frequency, both logarithmic.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let width = 100.0 * (x.fraction(high) - x.fraction(low));
    let behind = html! {
        rect class="band free-fall" x=(x.percent(low)) width=(format!("{width:.2}%")) y="0" height=(HEIGHT) {}
    };
    let drawn = html! { @for (class, points) in curves { (chart.curve(class, points)) } };
    chart.draw(&behind, &drawn, &html! {})
}

/// For forces in N.
fn force_axis(low: f64, high: f64) -> Axis {
    let margin = 0.05 * (high - low).max(1e-3);
    Axis::scaled(1e-3, low - margin, high + margin, "force, kN", 5.0)
}
