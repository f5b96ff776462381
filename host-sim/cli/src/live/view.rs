//! The terminal's picture.

use ratatui::Frame;
use ratatui::layout::Constraint::{Fill, Length, Min, Percentage};
use ratatui::layout::{Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};
use touchdown_core::detect::Phase;
use touchdown_protocol::controller::Mode;
use touchdown_protocol::link::State;

use super::orbit::orbit;
use super::watched::{Link, Watched};
use touchdown_run::outcome::DetectedEvent;

const KEYS: &str = " q quit   space hold   p plane   x clear orbit";
/// Older than this, what is shown is marked, s.
const STALE: f64 = 1.0;

/// What a person has chosen.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// Plane of the orbit, 0 is a.
    pub plane: usize,
    /// Whether the picture stands still.
    pub held: bool,
    /// File that is recorded to.
    pub record: Option<String>,
    /// Whether to use colour.
    pub paint: bool,
}

/// Draws `watched` as it is at `now` (s).
pub fn draw(frame: &mut Frame<'_>, view: &View, watched: &Watched, now: f64) {
    let [head, body, foot] = Layout::vertical([Length(1), Min(0), Length(1)]).areas(frame.area());
    let [left, right] = Layout::horizontal([Percentage(46), Fill(1)]).areas(body);
    let [status, events, episodes] = Layout::vertical([Length(14), Fill(3), Fill(2)]).areas(right);
    frame.render_widget(Paragraph::new(headline(watched, now)), head);
    orbit(frame, left, watched, view.plane);
    list(frame, status, " now ", status_lines(watched, now));
    let title = " events: onset s, what, mm/s ";
    list(frame, events, title, watched.events().map(event_line));
    let title = " episodes: number, at s, trigger ";
    list(frame, episodes, title, episode_lines(watched));
    let mut keys = KEYS.to_owned();
    if view.held {
        keys += "   HELD";
    }
    if let Some(name) = &view.record {
        keys += &format!("   recording to {name}");
    }
    frame.render_widget(Paragraph::new(keys), foot);
    if !view.paint {
        // What colours say, the words say too.
        let all = frame.area();
        let plain = Style::default().fg(Color::Reset);
        frame.buffer_mut().set_style(all, plain);
    }
}

fn headline(watched: &Watched, now: f64) -> Line<'static> {
    let link = match &watched.link {
        Link::New => Span::raw("connecting"),
        Link::Up(since) => format!("connected for {:.0} s", now - since).green(),
        Link::Down(since, why) => format!("NOT CONNECTED for {:.0} s: {why}", now - since).red(),
    };
    let head = format!(" touchdown live {}  ", watched.port);
    Line::from(vec![head.bold(), link])
}

fn status_lines(watched: &Watched, now: f64) -> Vec<Line<'static>> {
    let Some(state) = watched.state() else {
        return vec![Line::raw("nothing heard yet")];
    };
    let (it, counters) = (state.outputs, &state.counters);
    let rate = watched.sample_rate();
    let rate = rate.map_or("-".to_owned(), |it| format!("{it:.0}"));
    let nominal = watched.hello.as_ref().map_or(0.0, |it| it.sample_rate);
    let frames = watched.frame_rate(now);
    let age = watched.age(now).unwrap_or(f64::INFINITY);
    let text = format!("{age:.2} s");
    let age = if age > STALE {
        (text + ", OLD").red()
    } else {
        Span::raw(text)
    };
    let restarts = match watched.restarts {
        0 => String::new(),
        count => format!("; restarts {count}"),
    };
    let (there, here) = (counters.damaged_frames, watched.damaged);
    let (samples, notices) = (counters.lost_samples, counters.lost_notices);
    let unusable = counters.unusable_values;
    let relays = [output("run", it.run), output("no brake", it.no_brake)];
    let others = [output("permit", it.permit), output("ready", it.ready)];
    let rates = format!("{rate} of {nominal:.0} samples/s, {frames:.0} frames/s");
    let damaged = format!("{there} frames there, {here} here{restarts}");
    let mut lines = vec![
        row("phase", [phase(state)]),
        row("mode", [mode(state)]),
        row("outputs", relays),
        row("", others),
        row("faults", [faults(state)]),
        row("rates", [rates]),
        row("data age", [age]),
        row("lost", [format!("{samples} samples, {notices} notices")]),
        row("unusable", [format!("{unusable} values")]),
        row("damaged", [damaged]),
    ];
    lines.extend(lifetime(watched));
    lines
}

fn row<S: Into<Span<'static>>>(head: &str, what: impl IntoIterator<Item = S>) -> Line<'static> {
    let head = Span::raw(format!("{head:<10}"));
    let what = what.into_iter().map(Into::into);
    Line::from_iter(std::iter::once(head).chain(what))
}

/// In two lines: of an inspection, the landings are what counts.
fn lifetime(watched: &Watched) -> Vec<Line<'static>> {
    let Some(it) = &watched.lifetime else {
        return vec![row("lifetime", ["no log"])];
    };
    let cut = match it.unweighed {
        0 => String::new(),
        count => format!(", {count} cut off"),
    };
    let (landings, weight) = (it.landings, it.weight as f64 / 1e3);
    let (touches, boots, lost) = (it.touches, it.boots, it.lost);
    let landings = format!("{landings} landings, weight {weight:.3}{cut}");
    let times = format!("{touches} touches, {boots} times on, {lost} drops lost");
    vec![row("lifetime", [landings]), row("", [times])]
}

fn phase(state: &State) -> Span<'static> {
    let colour = match state.phase {
        Phase::Starting => Color::Reset,
        Phase::Levitated => Color::Green,
        Phase::FreeFall | Phase::Impact | Phase::Sliding | Phase::Rolling => Color::Red,
    };
    <&str>::from(state.phase).fg(colour)
}

fn mode(state: &State) -> Span<'static> {
    let colour = match state.mode {
        Mode::SelfTest | Mode::Arming => Color::Yellow,
        Mode::Watching => Color::Green,
        Mode::Dropped | Mode::Faulted => Color::Red,
    };
    let cause = state.cause.map(|it| format!(": {}", <&str>::from(it)));
    let cause = cause.unwrap_or_default();
    (<&str>::from(state.mode).to_owned() + &cause).fg(colour)
}

fn output(name: &str, on: bool) -> Span<'static> {
    if on {
        format!("{name} ON  ").green()
    } else {
        Span::raw(format!("{name} off  "))
    }
}

fn faults(state: &State) -> Span<'static> {
    let names: Vec<_> = state.faults.iter().map(<&str>::from).collect();
    if names.is_empty() {
        Span::raw("none")
    } else {
        names.join(", ").red()
    }
}

fn event_line(event: &DetectedEvent) -> Line<'static> {
    let fate = match (event.confirmed_s, event.withdrawn_s, &event.fault) {
        (_, Some(_), _) => " withdrawn".to_owned(),
        (Some(_), None, _) => " confirmed".to_owned(),
        (None, None, Some(fault)) => format!(" {} {}", fault.channel, fault.kind),
        (None, None, None) => String::new(),
    };
    let speed = event.normal_speed_m_s;
    let speed = speed.map_or(String::new(), |it| format!(" {:.1}", it * 1e3));
    let time = Span::raw(format!("{:>11.4}  ", event.onset_s));
    let name = <&str>::from(event.event).yellow();
    Line::from(vec![time, name, Span::raw(fate), Span::raw(speed)])
}

fn episode_lines(watched: &Watched) -> impl Iterator<Item = Line<'static>> {
    watched.episodes().map(|(number, header)| {
        let Some(it) = header else {
            return Line::raw(format!("{number:>5}  header lost"));
        };
        let at = it.trigger as f64 / f64::from(it.sample_rate);
        let trigger = <&str>::from(it.trigger_kind);
        let boot = it.boot;
        Line::raw(format!("{number:>5} {at:>11.3}  {trigger}, boot {boot}"))
    })
}

fn list(
    frame: &mut Frame<'_>,
    area: Rect,
    title: &'static str,
    lines: impl IntoIterator<Item = Line<'static>>,
) {
    let mut lines: Vec<_> = lines.into_iter().collect();
    if lines.is_empty() {
        lines.push(Line::raw("none"));
    }
    let block = Block::bordered().title(title);
    frame.render_widget(Paragraph::new(lines).block(block), area);
}
