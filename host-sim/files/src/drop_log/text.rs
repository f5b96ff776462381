//! The log for people.

use strum::VariantArray;
use touchdown_protocol::log::ending::{Closing, Ending};
use touchdown_protocol::log::reader::DamageKind;

use super::dump::Dump;
use super::episode::{Completeness, Episode};
use crate::controller::table;
use touchdown_base::paint::Paint;

/// A line for each episode, then the counters.
pub fn list(dump: &Dump, paint: Paint) -> String {
    let head = format!(
        "{:>6} {:<11}{:<15}{:>5}{:>12}{:>9}{:>9}{:>8}",
        "number", "state", "trigger", "boot", "at s", "samples", "events", "index"
    );
    let mut text = paint.bold(&head) + "\n";
    for episode in &dump.episodes {
        text += &line(episode, paint);
    }
    match &dump.counters {
        Some(it) => {
            let (boots, landings, cut_off) = (it.boots, it.landings, it.unweighed);
            let (weight, lost, touches) = (it.weight as f64 / 1e3, it.lost, it.touches);
            text += &format!(
                "switched on {boots} times; {landings} landings, {cut_off} of them cut off, weight {weight:.3}; \
                 {lost} drops not recorded; {touches} touches\n"
            );
            if let Some(cause) = it.uncleared {
                text += &format!("a drop is not cleared: {}\n", <&str>::from(cause));
            }
        }
        None => text += "no counters\n",
    }
    text
}

fn line(episode: &Episode, paint: Paint) -> String {
    let header = episode.header.as_ref();
    let state = format!("{:<11}", <&str>::from(episode.complete));
    let state = match (episode.damaged, episode.complete) {
        (true, _) => paint.bad(&state),
        (false, Completeness::Yes) => paint.good(&state),
        (false, _) => state,
    };
    let at = header.map(|it| it.trigger as f64 / f64::from(it.sample_rate));
    let or = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    format!(
        "{:>6} {state}{:<15}{:>5}{:>12}{:>9}{:>9}{:>8}{}{}\n",
        episode.sequence,
        header.map_or("-", |it| it.trigger_kind.into()),
        or(header.map(|it| it.boot.to_string())),
        or(at.map(|it| format!("{it:.3}"))),
        episode.samples.iter().flatten().count(),
        episode.events.len(),
        or(episode.ending.map(|it| format!("{:.2}", it.index))),
        if episode.locked { "  locked" } else { "" },
        damage(episode),
    )
}

/// Nothing, or what is damaged.
fn damage(episode: &Episode) -> String {
    if !episode.damaged {
        return String::new();
    }
    let mut parts = Vec::new();
    for kind in DamageKind::VARIANTS {
        let pages = episode.damage.iter().filter(|it| it.what == *kind);
        let pages: Vec<_> = pages.map(|it| it.page.to_string()).collect();
        let word = match pages.len() {
            0 => continue,
            1 => "page",
            _ => "pages",
        };
        let name = <&str>::from(kind);
        parts.push(format!("{word} {} {name}", pages.join(", ")));
    }
    parts.extend(episode.flaws.iter().cloned());
    let rest = episode.report.rest;
    if rest > 0 {
        parts.push(format!("{rest} bytes behind the last page"));
    }
    format!("  damaged: {}", parts.join("; "))
}

/// One episode.
pub fn show(episode: &Episode, paint: Paint) -> String {
    let mut text = paint.bold(&format!("Episode {}: ", episode.sequence));
    text += episode.complete.into();
    text += &damage(episode);
    text.push('\n');
    if let Some(header) = &episode.header {
        let name = String::from_utf8_lossy(&header.firmware);
        text += &format!(
            "{}, configuration {:08x}, boot {}; {} at tick {}, {:.3} s after reset\n\
             {} Hz, every {}. tick; {} of {} samples, {:.4} um a count\n",
            name.trim_end_matches('\0'),
            header.config_hash,
            header.boot,
            <&str>::from(header.trigger_kind),
            header.trigger,
            header.trigger as f64 / f64::from(header.sample_rate),
            header.sample_rate,
            header.decimation,
            episode.samples.iter().flatten().count(),
            header.planned,
            header.resolution * 1e6,
        );
    }
    if let Some(known) = episode.samples_with_pulses
        && known < episode.samples.len()
    {
        let all = episode.samples.len();
        text += &format!("pulses incomplete: known of {known} of {all} samples\n");
    }
    if let Some(ending) = &episode.ending {
        text += &ended(ending);
    }
    if !episode.events.is_empty() {
        text += &paint.bold(&format!(
            "\n{:<16}{:>12}{:>14}{:>10}\n",
            "event", "onset ms", "declared ms", "mm/s"
        ));
    }
    for event in &episode.events {
        let speed = match event.normal_speed_m_s {
            it if it > 0.0 => format!("{:.2}", it * 1e3),
            _ => "-".to_owned(),
        };
        let fault = event.fault;
        let fault = fault.map_or(String::new(), |it| format!("  {} {}", it.channel, it.kind));
        let (onset, declared) = (event.onset_s * 1e3, event.declared_s * 1e3);
        let name = <&str>::from(event.event);
        text += &format!("{name:<16}{onset:>12.4}{declared:>14.4}{speed:>10}{fault}\n");
    }
    if !episode.outputs.is_empty() {
        text += &table(&episode.outputs, paint);
    }
    for it in &episode.alarms {
        let (level, plane, fraction) = (<&str>::from(it.level), it.plane, it.fraction);
        let at = format!(
            "at {fraction:.2} of the clearance, at {:.4} ms",
            it.time_s * 1e3
        );
        text += &format!("alarm: {level}, plane {plane} {at}\n");
    }
    for it in &episode.orders {
        text += &format!("order: {it}\n");
    }
    text
}

fn ended(ending: &Ending) -> String {
    let why = match ending.closing {
        Closing::Levitated => "floats again",
        Closing::Withdrawn => "the fall was withdrawn",
        Closing::Quiet => "nothing more happened",
        Closing::Longest => "as long as an episode may be",
    };
    let off = match ending.latched {
        Some(cause) => format!("outputs off: {}", <&str>::from(cause)),
        None => "nothing latched".to_owned(),
    };
    format!("ended: {why}; velocity index {:.2}; {off}\n", ending.index)
}
