//! The log, fetched from the controller over the link.

use std::ops::RangeInclusive;

use super::dump::Dump;
use super::episode::Episode;
use crate::link::{Client, LinkError, Port};
use touchdown_base::progress::Progress;

/// EpisodeRange of episodes.
pub type EpisodeRange = RangeInclusive<u32>;

/// Fetches those of all episodes that are wanted and there, of which one takes 5 s at 115 200 baud, and the lifetime
/// counters.
pub fn fetch(
    port: &Port,
    wanted: impl FnOnce(EpisodeRange) -> EpisodeRange,
) -> Result<Dump, LinkError> {
    let mut client = Client::new(port.open()?);
    client.hello()?;
    let counters = client.lifetime()?;
    let mut episodes = Vec::new();
    let Some((first, last)) = client.episodes()? else {
        return Ok(Dump { counters, episodes });
    };
    // EpisodeRange between may be gone; what is beyond the largest flash is never there.
    for number in wanted(first.max(last.saturating_sub(MOST - 1))..=last) {
        let mut progress = None;
        let bytes = client.episode(number, |done, total| {
            progress
                .get_or_insert_with(|| Progress::of_jobs("fetching", total.into()))
                .at(done.into());
        })?;
        let episode = bytes.map(|bytes| Episode::of(&bytes));
        episodes.extend(episode.filter(|it| it.report.sequence.is_some()));
    }
    Ok(Dump { counters, episodes })
}

/// Episodes in the largest flash that a log is kept on.
const MOST: u32 = 5_461;
