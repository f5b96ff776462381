//! The firmware's drop log as a file, a dump of its flash or one episode, or over the link. Format:
//! `docs/formats/log.md`.

mod comtrade;
mod dump;
mod episode;
mod text;

pub use comtrade::comtrade;
pub use dump::{Dump, EpisodeRange, fetch, read};
pub use episode::{ChannelFault, Completeness, Episode, Event};
pub use text::{list, show};

use std::io::Write;

use touchdown_core::learnt::Learnt;

use crate::stream::{Columns, Pulses, Row, StreamWriter, of_field};

/// Whether no episode of the log is damaged. One that was cut off is not.
pub fn is_sound(dump: &Dump) -> bool {
    !dump.episodes.iter().any(|it| it.damaged)
}

/// The episode as a stream, with spin and levitation signal as they were before it and the pulses that are known; time 0 is the trigger. False where it has no header, or an impossible one.
pub fn stream(episode: &Episode, out: impl Write) -> std::io::Result<bool> {
    let Some(header) = episode.scale() else {
        return Ok(false);
    };
    let learnt = episode.learnt.as_deref().and_then(of_field);
    let spin = learnt.as_ref().and_then(Learnt::spin).map(f64::from);
    let levitated = learnt.as_ref().and_then(Learnt::levitated);
    let columns = Columns {
        planes: if header.fitted & 0b1100 == 0 { 1 } else { 2 },
        speed: spin.is_some(),
        levitated: levitated.is_some(),
        edges: std::array::from_fn(|channel| {
            header.pulsed & (1 << channel) != 0 && !episode.pulses.is_empty()
        }),
    };
    let rate = f64::from(header.sample_rate);
    let mut writer = StreamWriter::new(out, columns, episode.learnt.clone())?;
    for (number, counts) in episode.samples.iter().enumerate() {
        let edges = episode.pulses.get(number).copied().flatten();
        let edges = edges.unwrap_or_default();
        writer.write(&Row {
            time: episode.time(header, number),
            positions: episode.positions(header, counts),
            spin,
            levitated,
            edges: edges.map(|it| it.map(|it| Pulses::of(it, rate))),
        })?;
    }
    writer.finish()?;
    Ok(true)
}
