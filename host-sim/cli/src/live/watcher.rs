//! Holds the line on a thread of its own: asks, listens, and opens the line again when it is gone.

use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use touchdown_core::event::Notice;
use touchdown_protocol::config_block::Settings;
use touchdown_protocol::link::{Hello, Recent, State};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::log::header::Header;

use touchdown_files::drop_log::Episode;
use touchdown_files::link::{Client, LinkError, Port, Told};

/// Between two attempts to open the line.
const RETRY: Duration = Duration::from_millis(500);
/// Between two questions for positions: a fifth of what the line can carry.
const RECENT: Duration = Duration::from_millis(125);
/// Between two looks at the log.
const LOG: Duration = Duration::from_secs(2);
/// Without a word for so long, the controller is asked whether it is there.
const SILENCE: Duration = Duration::from_secs(1);
/// How long a time an answer with positions should span, s: a turn at 80 Hz and more.
const SPAN: f32 = 12.5e-3;
/// Positions in an answer.
const POSITIONS: f32 = 32.0;
/// Episodes whose headers are read.
const EPISODES: u32 = 6;

/// Something that was heard, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// Since the watcher's start, s.
    pub at: f64,
    /// What.
    pub said: Said,
}

/// What was heard.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    /// The line is open, and a controller answers; it has this configuration.
    Connected(Hello, Settings),
    /// The line is not open any more, or cannot be opened, and why.
    Lost(String),
    /// What goes on.
    State(State),
    /// What happened.
    Notice(Notice),
    /// Where the rotor has been.
    Recent(Recent),
    /// An episode is in the log; its header, where that is whole.
    Episode(u32, Option<Header>),
    /// What was counted over the monitor's life, at first and where it has changed.
    Lifetime(Counters),
    /// So many frames came damaged on this line so far.
    Damaged(u32),
}

/// The thread's other end. It stops when this is dropped.
pub struct Watcher {
    updates: Receiver<Update>,
    start: Instant,
}

impl Watcher {
    /// Begins to watch.
    pub fn start(port: Port) -> Self {
        let (to, updates) = channel();
        let start = Instant::now();
        let mut tell = move |said| {
            let at = start.elapsed().as_secs_f64();
            to.send(Update { at, said }).map_err(|_| None)
        };
        thread::spawn(move || {
            while let Err(Some(error)) = session(&port, &mut tell) {
                if tell(Said::Lost(error.to_string())).is_err() {
                    break;
                }
                thread::sleep(RETRY);
            }
        });
        Self { updates, start }
    }

    /// Since the start, s.
    pub fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// What is there now.
    pub fn updates(&self) -> impl Iterator<Item = Update> {
        self.updates.try_iter()
    }

    /// The next update, after at most `limit`.
    pub fn next(&self, limit: Duration) -> Option<Update> {
        self.updates.recv_timeout(limit).ok()
    }
}

/// Tells whoever listens; no error in its place where nobody does any more.
type Tell<'a> = &'a mut dyn FnMut(Said) -> Result<(), Option<LinkError>>;

/// From the opening of the line to its end; no error where nobody listens any more.
fn session(port: &Port, tell: Tell<'_>) -> Result<(), Option<LinkError>> {
    let mut client = Client::new(port.open()?);
    let hello = client.hello()?;
    let step = (SPAN * hello.sample_rate / POSITIONS).clamp(1.0, 1e4) as u16;
    tell(Said::Connected(hello, client.settings()?))?;
    let mut heard = Instant::now();
    let (mut positions_due, mut log_due) = (heard, heard);
    let (mut known, mut lifetime) = (None, None);
    let mut damaged = 0;
    loop {
        while let Some(told) = client.listen(Duration::from_millis(20))? {
            heard = Instant::now();
            tell(match told {
                Told::State(state) => Said::State(state),
                Told::Notice(notice) => Said::Notice(notice),
            })?;
            if positions_due.min(log_due) <= heard {
                break;
            }
        }
        let now = Instant::now();
        if positions_due <= now {
            positions_due = now + RECENT;
            tell(Said::Recent(client.recent(step)?))?;
        }
        if log_due <= now {
            log_due = now + LOG;
            known = look(&mut client, known, tell)?;
            let counters = client.lifetime()?;
            if counters != lifetime {
                lifetime = counters;
                counters.map_or(Ok(()), |it| tell(Said::Lifetime(it)))?;
            }
        }
        if heard.elapsed() > SILENCE {
            client.hello()?;
            heard = Instant::now();
        }
        if client.damaged != damaged {
            damaged = client.damaged;
            tell(Said::Damaged(damaged))?;
        }
    }
}

/// Tells the headers of the last episodes that come after `known`; the last that was told.
fn look(
    client: &mut Client,
    known: Option<u32>,
    tell: Tell<'_>,
) -> Result<Option<u32>, Option<LinkError>> {
    let Some((first, last)) = client.episodes()? else {
        return Ok(None);
    };
    let first = first.max(last.saturating_sub(EPISODES - 1));
    // One that is being written is refused, and asked for again.
    let mut told = known.filter(|it| *it <= last);
    let first = told.map_or(first, |it| first.max(it.saturating_add(1)));
    for number in first..=last {
        if let Some((_, page)) = client.chunk(number, 0)? {
            tell(Said::Episode(number, Episode::of(&page).header))?;
            told = Some(number);
        }
    }
    Ok(told)
}
