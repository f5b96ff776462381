//! The firmware's drop log as a file, a dump of its flash or one episode, or over the link. Format: `docs/log.md`.

mod comtrade;
mod dump;
mod episode;
mod fetch;
mod text;

pub use comtrade::comtrade;
pub use dump::{Dump, read};
pub use episode::{Episode, Event};
pub use fetch::{Wanted, fetch};
pub use text::{list, show};

use std::io::Write;

use touchdown_core::sample::CHANNELS;

use crate::stream::{Columns, Row, StreamWriter};

/// Whether no episode of the log is damaged. One that was cut off is not.
pub fn is_sound(dump: &Dump) -> bool {
    use touchdown_core::log::reader::Verdict;
    dump.episodes
        .iter()
        .all(|it| it.verdict != Verdict::Damaged)
}

/// The episode as a stream; time 0 is the trigger. False where it has no header.
pub fn stream(episode: &Episode, out: impl Write) -> std::io::Result<bool> {
    let Some(header) = &episode.header else {
        return Ok(false);
    };
    let columns = Columns {
        planes: if header.fitted & 0b1100 == 0 { 1 } else { 2 },
        speed: false,
        levitated: false,
        edges: [false; 2],
    };
    let mut writer = StreamWriter::new(out, columns)?;
    for (number, counts) in episode.samples.iter().enumerate() {
        let mut positions = [f64::NAN; CHANNELS];
        for (channel, position) in positions.iter_mut().enumerate() {
            *position = episode
                .position(header, counts, channel)
                .unwrap_or(f64::NAN);
        }
        writer.write(&Row {
            time: episode.time(header, number),
            positions,
            spin: None,
            levitated: None,
            edges: [None; 2],
        })?;
    }
    writer.finish()?;
    Ok(true)
}
