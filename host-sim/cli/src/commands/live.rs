//! `touchdown live`.

use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, KeyCode, KeyModifiers};
#[cfg(unix)]
use signal_hook::consts::signal::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};

use super::args::LiveArgs;
use crate::gate::Gate;
use crate::live::{Link, Said, Update, View, Watched, Watcher, draw, line, open_record};
use touchdown_base::failure::{Failure, STDOUT};
use touchdown_base::paint::Paint;
use touchdown_files::link::Port;

/// Between two pictures.
const PICTURE: Duration = Duration::from_millis(50);
/// Between two looks at the clock while nothing comes.
const LOOK: Duration = Duration::from_millis(100);

/// Watches a controller until `q`, the end of the time, or of who reads the lines.
pub(super) fn live(args: &LiveArgs) -> Result<(), Failure> {
    if args.seconds.is_some_and(|it| it.is_nan() || it <= 0.0) {
        return Err(Failure::Usage("--seconds must be above 0".to_owned()));
    }
    let port = Port::of(&args.port);
    let file = args.json.as_deref().filter(|it| *it != STDOUT);
    Gate::new().claims("--json", file).open()?;
    let record = file.map(open_record).transpose()?;
    let on_terminal = io::stdout().is_terminal() && io::stdin().is_terminal();
    let lines = args.json.as_deref() == Some(STDOUT) || !on_terminal;
    let mut session = Session {
        watched: Watched::new(port.to_string()),
        watcher: Watcher::start(port),
        record: record.zip(file),
        end: args.seconds.unwrap_or(f64::INFINITY),
        heard: false,
    };
    if lines {
        session.lines()?;
    } else {
        let view = View {
            record: file.map(str::to_owned),
            paint: Paint::wanted(),
            ..View::default()
        };
        let fail = Failure::output("the terminal");
        let stop = stop().map_err(&fail)?;
        let mut terminal = ratatui::try_init().map_err(&fail)?;
        let ended = session.show(&mut terminal, view, &stop);
        ratatui::restore();
        ended?;
    }
    if session.heard || session.watcher.now() < session.end {
        return Ok(());
    }
    let why = match &session.watched.link {
        Link::Down(_, why) => why,
        Link::New | Link::Up(_) => "no answer in that time",
    };
    let port = &session.watched.port;
    Err(Failure::Target(format!("{port}: {why}")))
}

/// True once the process is to end: killed in between, it would leave the terminal raw.
fn stop() -> io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    for signal in [SIGTERM, SIGHUP, SIGINT, SIGQUIT] {
        signal_hook::flag::register(signal, stop.clone())?;
    }
    Ok(stop)
}

struct Session<'a> {
    watched: Watched,
    watcher: Watcher,
    record: Option<(File, &'a str)>,
    /// s.
    end: f64,
    heard: bool,
}

impl Session<'_> {
    /// Takes an update in and records it; the line, unless it says nothing new.
    fn take(&mut self, update: &Update) -> Result<Option<String>, Failure> {
        let known = self.watched.link.clone();
        self.watched.take(update);
        self.heard |= matches!(update.said, Said::Connected(..));
        if self.watched.link == known && matches!(update.said, Said::Lost(_)) {
            return Ok(None);
        }
        let line = line(update, &self.watched) + "\n";
        if let Some((file, name)) = &mut self.record {
            let written = file.write_all(line.as_bytes());
            written.map_err(Failure::output(name))?;
        }
        Ok(Some(line))
    }

    fn lines(&mut self) -> Result<(), Failure> {
        let mut out = io::stdout();
        while self.watcher.now() < self.end {
            let update = self.watcher.next(LOOK);
            let line = update.map(|it| self.take(&it)).transpose()?;
            let Some(line) = line.flatten() else {
                continue;
            };
            match out.write_all(line.as_bytes()) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
                written => written.map_err(Failure::output(STDOUT))?,
            }
        }
        Ok(())
    }

    fn show(
        &mut self,
        terminal: &mut DefaultTerminal,
        mut view: View,
        stop: &AtomicBool,
    ) -> Result<(), Failure> {
        let fail = Failure::output("the terminal");
        let mut held: Option<(Watched, f64)> = None;
        while self.watcher.now() < self.end && !stop.load(Relaxed) {
            let updates: Vec<_> = self.watcher.updates().collect();
            for update in &updates {
                self.take(update)?;
            }
            let now = self.watcher.now();
            let (watched, at) = match &held {
                Some((watched, at)) => (watched, *at),
                None => (&self.watched, now),
            };
            let drawn = terminal.draw(|frame| draw(frame, &view, watched, at));
            drawn.map_err(&fail)?;
            if !event::poll(PICTURE).map_err(&fail)? {
                continue;
            }
            let event = event::read().map_err(&fail)?;
            let Some(key) = event.as_key_press_event() else {
                continue;
            };
            // The terminal passes an interrupt on as a key.
            let is_interrupt = key.modifiers.contains(KeyModifiers::CONTROL);
            match key.code {
                KeyCode::Char('q') | KeyCode::Esc => return Ok(()),
                KeyCode::Char('c') if is_interrupt => return Ok(()),
                KeyCode::Char(' ') => {
                    held = held.is_none().then(|| (self.watched.clone(), now));
                    view.held = held.is_some();
                }
                KeyCode::Char('p') => view.plane = 1 - view.plane,
                KeyCode::Char('x') => self.watched.forget_trail(),
                _ => {}
            }
        }
        Ok(())
    }
}
