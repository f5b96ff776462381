//! The terminal's picture.

use ratatui::Frame;
use ratatui::layout::Constraint::{Fill, Length, Min, Percentage};
use ratatui::layout::{Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
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
    let pen = Pen(view.paint);
    frame.render_widget(Paragraph::new(headline(watched, now, pen)), head);
    orbit(frame, left, watched, view.plane, view.paint);
    list(frame, status, " now ", status_lines(watched, now, pen));
    let (title, lines) = (" events: onset s, what, mm/s ", watched.events());
    list(frame, events, title, lines.map(|it| event_line(it, pen)));
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
}

/// Colours, where they are wanted; what they say, the words say too.
#[derive(Clone, Copy)]
struct Pen(bool);

impl Pen {
    fn of(self, colour: Color, text: String) -> Span<'static> {
        let colour = if self.0 { colour } else { Color::Reset };
        Span::styled(text, Style::default().fg(colour))
    }

    fn bold(text: String) -> Span<'static> {
        Span::styled(text, Style::default().add_modifier(Modifier::BOLD))
    }
}

fn headline(watched: &Watched, now: f64, pen: Pen) -> Line<'static> {
    let link = match &watched.link {
        Link::New => Span::raw("connecting"),
        Link::Up(since) => pen.of(Color::Green, format!("connected for {:.0} s", now - since)),
        Link::Down(since, why) => pen.of(
            Color::Red,
            format!("NOT CONNECTED for {:.0} s: {why}", now - since),
        ),
    };
    let head = format!(" touchdown live {}  ", watched.port);
    Line::from(vec![Pen::bold(head), link])
}

fn status_lines(watched: &Watched, now: f64, pen: Pen) -> Vec<Line<'static>> {
    let Some(state) = watched.state() else {
        return vec![Line::raw("nothing heard yet")];
    };
    let (it, counters) = (state.outputs, &state.counters);
    let rate = watched
        .sample_rate()
        .map_or("-".to_owned(), |it| format!("{it:.0}"));
    let nominal = watched.hello.as_ref().map_or(0.0, |it| it.sample_rate);
    let frames = watched.frame_rate(now);
    let age = watched.age(now).unwrap_or(f64::INFINITY);
    let text = format!("{age:.2} s");
    let age = if age > STALE {
        pen.of(Color::Red, text + ", OLD")
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
    let pair = |pair: [(&str, bool); 2]| pair.map(|it| output(it, pen));
    let relays = pair([("run", it.run), ("no brake", it.no_brake)]);
    let rates = format!("{rate} of {nominal:.0} samples/s, {frames:.0} frames/s");
    let damaged = format!("{there} frames there, {here} here{restarts}");
    let mut lines = vec![
        row("phase", [phase(state, pen)]),
        row("mode", [mode(state, pen)]),
        row("outputs", relays),
        row("", pair([("permit", it.permit), ("ready", it.ready)])),
        row("faults", [faults(state, pen)]),
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

fn phase(state: &State, pen: Pen) -> Span<'static> {
    let colour = match state.phase {
        Phase::Starting => Color::Reset,
        Phase::Levitated => Color::Green,
        Phase::FreeFall | Phase::Impact | Phase::Sliding | Phase::Rolling => Color::Red,
    };
    pen.of(colour, <&str>::from(state.phase).to_owned())
}

fn mode(state: &State, pen: Pen) -> Span<'static> {
    let colour = match state.mode {
        Mode::SelfTest | Mode::Arming => Color::Yellow,
        Mode::Watching => Color::Green,
        Mode::Dropped | Mode::Faulted => Color::Red,
    };
    let cause = state
        .cause
        .map_or(String::new(), |it| format!(": {}", <&str>::from(it)));
    pen.of(colour, <&str>::from(state.mode).to_owned() + &cause)
}

fn output((name, on): (&str, bool), pen: Pen) -> Span<'static> {
    if on {
        pen.of(Color::Green, format!("{name} ON  "))
    } else {
        Span::raw(format!("{name} off  "))
    }
}

fn faults(state: &State, pen: Pen) -> Span<'static> {
    let names: Vec<_> = state.faults.iter().map(<&str>::from).collect();
    if names.is_empty() {
        Span::raw("none")
    } else {
        pen.of(Color::Red, names.join(", "))
    }
}

fn event_line(event: &DetectedEvent, pen: Pen) -> Line<'static> {
    let fate = match (event.confirmed_s, event.withdrawn_s, &event.fault) {
        (_, Some(_), _) => " withdrawn".to_owned(),
        (Some(_), None, _) => " confirmed".to_owned(),
        (None, None, Some(fault)) => format!(" {} {}", fault.channel, fault.kind),
        (None, None, None) => String::new(),
    };
    let speed = event
        .normal_speed_m_s
        .map_or(String::new(), |it| format!(" {:.1}", it * 1e3));
    let time = Span::raw(format!("{:>11.4}  ", event.onset_s));
    let name = pen.of(Color::Yellow, <&str>::from(event.event).to_owned());
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
