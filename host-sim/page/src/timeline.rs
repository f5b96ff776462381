//! What the terminal shows: the true phases beside what the detector said, in 80 columns.

use touchdown_core::event::EventKind;

use crate::report::monitor::unsound;
use touchdown_base::history::{History, Impact, Phase, PhaseKind, Pulse};
use touchdown_base::paint::Paint;
use touchdown_base::plain::{listed, shown};
use touchdown_run::matching::{Match, Matches, match_events, regime_event};
use touchdown_run::outcome::{DetectedEvent, Detection, Forecast, Outcome};
use touchdown_run::timebase::Timebase;
use touchdown_scene::Scene;
use touchdown_scene::names::{phase_name, regime_name};
use touchdown_scene::scales::validity;

/// Phases and impacts that are listed before the rest is summed up.
const LISTED: usize = 12;
/// Events of a replay that are listed.
const REPLAYED: usize = 1000;
/// A phase begins with its event within this, s.
const SAME: f64 = 1e-12;

/// A drop.
pub fn drop(scene: &Scene, outcome: &Outcome, paint: Paint) -> String {
    let matches = match_events(&outcome.truth.whole, &outcome.detection);
    let mut text = heading(scene, paint);
    text += &phases(outcome, &matches, paint);
    text += &impacts(outcome, &matches, paint);
    text += &regime(outcome, &matches, paint);
    text.extend(accuracy(outcome).map(|line| line + "\n"));
    text += &forecasts(&outcome.detection, paint);
    text += &severity(&outcome.detection);
    text += &outcome.conduct.told(Timebase::of(scene)).text(paint);
    text += &extras(outcome, &matches, paint);
    if let Some(validity) = validity(scene) {
        text += &format!("{validity}\n");
    }
    text
}

fn heading(scene: &Scene, paint: Paint) -> String {
    let heading = shown(scene.heading());
    let mut lines: Vec<String> = Vec::new();
    for word in heading.split_whitespace() {
        let fits = |line: &&mut String| line.len() + 1 + word.len() <= 79;
        match lines.last_mut().filter(fits) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    let lines: Vec<_> = lines.iter().map(|line| paint.bold(line)).collect();
    format!(
        "{}\n{} kg, radius {} mm, {} rpm; gap {} mm, friction {}, restitution {}\n",
        lines.join("\n"),
        scene.rotor.mass,
        short(scene.rotor.radius * 1e3),
        short(scene.rotor.spin * 60.0 / std::f64::consts::TAU),
        short(scene.retainer.clearance * 1e3),
        scene.retainer.friction,
        scene.retainer.restitution,
    )
}

fn phases(outcome: &Outcome, matches: &Matches, paint: Paint) -> String {
    let head = "\nphase            from ms       to ms  detected       onset ms  latency ms";
    let line = |phase: &Phase| {
        let begins = |event: &&Match| (event.onset_s - phase.start_s).abs() <= SAME;
        let event = event_of(phase).and_then(|it| matches.of_kind(it).find(begins));
        let verdict = event.map(|it| verdict(it, &outcome.detection, paint));
        format!(
            "{:<12}{:>12}{:>12}{}\n",
            phase_name(phase.phase),
            millis(phase.start_s),
            millis(phase.end_s),
            verdict.unwrap_or_default()
        )
    };
    let phases = &outcome.truth.whole.phases;
    paint.bold(head) + "\n" + &listed(phases, LISTED, "phases", line)
}

/// The event that a phase begins with.
fn event_of(phase: &Phase) -> Option<EventKind> {
    match phase.phase {
        PhaseKind::Levitated => None,
        PhaseKind::FreeFall if phase.start_s > 0.0 => Some(EventKind::LiftOff),
        PhaseKind::FreeFall => Some(EventKind::FreeFall),
        PhaseKind::Impact => Some(EventKind::Impact),
        PhaseKind::Sliding => Some(EventKind::Sliding),
        PhaseKind::Rolling => Some(EventKind::Rolling),
    }
}

fn verdict(event: &Match, detection: &Detection, paint: Paint) -> String {
    let Some(index) = event.detected else {
        return format!("  {}", paint.bad("missed"));
    };
    let detected = &detection.events[index];
    format!(
        "  {}{:>13}{:>12}",
        paint.good(&format!("{:<10}", fate(detected).unwrap_or("declared"))),
        millis(detected.onset_s),
        optional(event.latency_s.map(millis)),
    )
}

/// What became of it after it was declared.
fn fate(event: &DetectedEvent) -> Option<&'static str> {
    let confirmed = event.confirmed_s.map(|_| "confirmed");
    confirmed.or(event.withdrawn_s.map(|_| "withdrawn"))
}

fn impacts(outcome: &Outcome, matches: &Matches, paint: Paint) -> String {
    let truth = &outcome.truth.whole.impacts;
    if truth.is_empty() {
        return String::new();
    }
    let off = ["accurate to", "model off by"][usize::from(outcome.by_reference)];
    let head =
        format!("\nimpact         at ms      mm/s{off:>13} onset error ms seen mm/s  latency ms");
    let line = |&(index, impact, event): &(usize, &Impact, &Match)| {
        let off = if outcome.by_reference {
            let model = outcome.model.histories.whole.impacts.get(index);
            model.map(|model| seconds(model.state.time - impact.state.time))
        } else {
            let known = outcome.accuracy.as_ref().map(|it| it.impacts[index]);
            known.map(|it| it.map_or("not certain".to_owned(), |it| seconds(it.time_s)))
        };
        let seen = event.detected.map(|index| &outcome.detection.events[index]);
        let seen = match seen {
            Some(seen) => format!(
                "{:>15}{:>10}{:>12}",
                optional(event.onset_error_s.map(millis)),
                optional(seen.normal_speed_m_s.map(|v| format!("{:.2}", v * 1e3))),
                optional(event.latency_s.map(millis)),
            ),
            None => format!("{:>9}{}", "", paint.bad("missed")),
        };
        format!(
            "{:<8}{:>12}{:>10.2}{:>13}{seen}\n",
            index,
            millis(impact.state.time),
            impact.normal_speed * 1e3,
            optional(off),
        )
    };
    let found = truth.iter().zip(matches.of_kind(EventKind::Impact));
    let rows: Vec<_> = (0..)
        .zip(found)
        .map(|(index, (it, event))| (index, it, event))
        .collect();
    let listed = listed(&rows, LISTED, "impacts", line);
    paint.bold(&head) + "\n" + &listed + &forces(&outcome.model.histories.whole)
}

/// The contact forces of the model's impacts, where it has any.
fn forces(model: &History) -> String {
    let by_force = |a: &Pulse, b: &Pulse| a.peak_force.total_cmp(&b.peak_force);
    let Some(hardest) = model.pulses().max_by(by_force) else {
        return String::new();
    };
    let longest = model.pulses().map(|it| it.duration).fold(0.0, f64::max);
    format!(
        "model's contact force up to {:.0} N, within {} ms; longest contact {} ms\n",
        hardest.peak_force,
        millis(hardest.duration),
        millis(longest)
    )
}

fn regime(outcome: &Outcome, matches: &Matches, paint: Paint) -> String {
    let truth = outcome.truth.whole.regime;
    let mut text = format!("\n{} {}", paint.bold("regime"), regime_name(truth));
    let Some(kind) = regime_event(truth) else {
        return text + "\n";
    };
    let found = matches.of_kind(kind).find_map(|event| event.detected);
    let declared = found.map(|index| outcome.detection.events[index].declared_s);
    text += &match declared {
        Some(time) => paint.good(&format!("; declared at {} ms", millis(time))),
        None => paint.bad("; not declared"),
    };
    text + "\n"
}

/// What was foretold, once anything was.
fn forecasts(detection: &Detection, paint: Paint) -> String {
    let all = &detection.forecasts;
    if all.is_empty() {
        return String::new();
    }
    let head = "\npredicted        forward    backward whirls from ms";
    let line = |forecast: &Forecast| {
        format!(
            "{:<12}{:>12.2}{:>12.2}{:>15}\n",
            millis(forecast.made_s),
            forecast.probability_forward,
            forecast.probability_backward,
            optional(forecast.begins_s.map(millis)),
        )
    };
    paint.bold(head) + "\n" + &listed(all, LISTED, "forecasts", line)
}

fn severity(detection: &Detection) -> String {
    let it = &detection.severity;
    let mut text = format!(
        "severity: {} impacts seen, up to {:.2} mm/s and {:.4} N s\n\
         {} ms in contact; velocity index {:.2}\n",
        it.impacts,
        it.impact_speed_m_s * 1e3,
        it.impulse_n_s,
        millis(it.dwell_s),
        it.velocity_index,
    );
    if it.whirl_load_n > 0.0 {
        let (frequency, load) = (it.whirl_frequency_hz, it.whirl_load_n);
        text += &format!("whirl up to {frequency:.0} Hz, {load:.0} N\n");
    }
    text
}

/// Of a model or a truth that would take too long, or that leaves something out.
pub fn left_out(outcome: &Outcome) -> impl Iterator<Item = String> {
    let model = &outcome.model;
    let times = [model.jammed, model.given_up, outcome.given_up];
    let [jammed, model, truth] = times.map(|at| at.map(millis));
    let too = [", sensors and detector too", ""][usize::from(outcome.by_reference)];
    let end = millis(outcome.model.histories.whole.end.time);
    [
        jammed.map(|at| format!("model leaves friction out where walls jam, from {at} ms on")),
        model.map(|at| format!("model given up at {at} ms{too}: it would take too long")),
        truth.map(|at| format!("truth given up at {at} ms: it would take too long. Sensors and detector end there, the model at {end} ms")),
    ]
    .into_iter()
    .flatten()
}

/// How far to trust the model's numbers.
pub fn accuracy(outcome: &Outcome) -> impl Iterator<Item = String> {
    let lines = outcome.accuracy.iter().flat_map(|it| {
        let worst = it.worst().map(|it| {
            let (time, speed) = (it.time_s, it.normal_speed_m_s * 1e3);
            format!("times of impacts to {time:.0e} s, speeds to {speed:.0e} mm/s")
        });
        let end = match it.uncertain_from {
            Some(index) => format!("from impact {index} on not certain: read statistics"),
            None => format!("place at the end to {:.0e} mm", it.end.position_m * 1e3),
        };
        let uncertain = !it.regime_is_certain;
        let regime = uncertain.then(|| "the regime is not certain".to_owned());
        [worst, Some(end), regime].into_iter().flatten()
    });
    lines.map(|line| format!("accuracy: {line}"))
}

fn extras(outcome: &Outcome, matches: &Matches, paint: Paint) -> String {
    let mut lines: Vec<String> = left_out(outcome).collect();
    let regime = outcome.model.histories.whole.regime;
    if regime != outcome.truth.whole.regime {
        lines.push(format!("the model ends as {}", regime_name(regime)));
    }
    if !matches.false_events.is_empty() {
        let count = matches.false_events.len();
        lines.push(format!("{count} events that did not happen"));
    }
    let mut text: String = lines.iter().map(|it| paint.bad(it) + "\n").collect();
    let told = outcome.detection.events.iter().filter_map(|event| {
        let (fault, at) = (event.fault?, millis(event.declared_s));
        let sensor = format!("sensor {}: {}", fault.channel, fault.kind);
        Some(format!("{sensor}, told at {at} ms\n"))
    });
    let told: Vec<_> = told.collect();
    text += &listed(&told, LISTED, "sensor faults", |line| paint.bad(line));
    text + &samples_line(&outcome.detection)
}

/// What the detector was fed, and the fingerprint by which two machines are compared.
fn samples_line(detection: &Detection) -> String {
    let bad = unsound(detection).map(|(channel, it)| format!("; channel {channel} {it}"));
    let bad: String = bad.collect();
    format!(
        "{} samples, {} unusable channel values{bad}; detector state {:08x}\n",
        detection.summary.samples, detection.summary.faults, detection.summary.state_hash
    )
}

/// A replay: the events as they were declared.
pub fn replay(stream: &str, detection: &Detection) -> String {
    let mut text = format!(
        "{}: {} events\n{}",
        shown(stream),
        detection.events.len(),
        samples_line(detection)
    );
    if !detection.events.is_empty() {
        text +=
            "\nevent                   onset s      declared s              plane  speed mm/s\n";
    }
    let line = |event: &DetectedEvent| {
        let speed = event.normal_speed_m_s.map(|v| format!("{:.2}", v * 1e3));
        let fault = (event.fault).map(|it| format!("  {} {}", it.channel, it.kind));
        let line = format!(
            "{:<15}{:>16.7}{:>16.7}{:>12}{:>7}{:>12}{}",
            <&str>::from(event.event),
            event.onset_s,
            event.declared_s,
            fate(event).unwrap_or_default(),
            event.plane,
            speed.unwrap_or_default(),
            fault.unwrap_or_default(),
        );
        format!("{}\n", line.trim_end())
    };
    let what = "events, with --json";
    text += &listed(&detection.events, REPLAYED, what, line);
    if detection.left_out > 0 {
        let left_out = detection.left_out;
        text += &format!("{left_out} further messages of the detector were counted, not kept\n");
    }
    text
}

fn millis(seconds: f64) -> String {
    format!("{:.4}", seconds * 1e3)
}

/// To six decimals, without trailing zeros.
fn short(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn seconds(difference: f64) -> String {
    match difference.abs() {
        0.0 => "0 s".to_owned(),
        apart => format!("{apart:.0e} s"),
    }
}

fn optional(text: Option<String>) -> String {
    text.unwrap_or_else(|| "-".to_owned())
}
