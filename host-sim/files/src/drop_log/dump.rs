//! A log: a dump of the flash, a file of one episode, or what is fetched from the controller over the link.

use std::ops::RangeInclusive;
use std::path::Path;

use embedded_storage::nor_flash::ReadNorFlash;
use serde::Serialize;
use touchdown_firmware::drop_log::{self, EPISODE_BYTES, Slot, bytes_of};
use touchdown_protocol::log::block::{BLOCK_BYTES, Page};
use touchdown_protocol::log::counters::Counters;

use super::episode::{Completeness, Episode};
use crate::link::{Client, LinkError, Port};
use crate::ram_nor::RamNor;
use touchdown_base::input_error::InputError;
use touchdown_base::progress::Progress;

/// Larger than any flash that the log is kept on, bytes.
const LARGEST: u64 = 256 << 20;
/// Episodes in it.
const MOST: u32 = 5_461;

/// All that a log holds.
#[derive(Clone, Debug, Serialize)]
pub struct Dump {
    /// Lifetime counters; none in a file of one episode, or where none are whole.
    pub counters: Option<Counters>,
    /// In the order of their numbers.
    pub episodes: Vec<Episode>,
}

/// Reads the log at `path`.
pub fn read(path: &str) -> Result<Dump, InputError> {
    let dump = Dump::of(&InputError::read_bytes(Path::new(path), LARGEST)?);
    if dump.counters.is_none() && dump.episodes.is_empty() {
        let rule = "has neither counters nor a block of an episode: it is no drop log";
        return Err(InputError::of_file(path, rule));
    }
    Ok(dump)
}

/// Numbers of episodes.
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
    // Some between may be gone; what is beyond the largest flash is never there.
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

impl Dump {
    /// From the bytes of a file.
    pub fn of(bytes: &[u8]) -> Self {
        // Where a dump has its counters, the pages of one episode are.
        let head = &bytes[..bytes.len().min(bytes_of(0))];
        if bytes.len() <= bytes_of(0) || is_block(head) {
            let episode = Some(Episode::of(bytes)).filter(|it| it.report.sequence.is_some());
            return Self {
                counters: newest(&mut flash(head, 0)),
                episodes: Vec::from_iter(episode),
            };
        }
        let slots = (bytes.len() - bytes_of(0)).div_ceil(bytes_of(1) - bytes_of(0));
        let mut flash = flash(bytes, slots);
        let counters = newest(&mut flash);
        let episodes = (0..slots).filter_map(|slot| held(&mut flash, slot));
        let mut episodes: Vec<_> = episodes.collect();
        episodes.sort_by_key(|it| it.sequence);
        mark_twins(&mut episodes);
        for it in &mut episodes {
            // At the next start an episode that was cut off is counted.
            let is_new = counters.is_none_or(|counters| counters.episodes < it.sequence);
            if it.complete == Completeness::CutOff && is_new {
                it.complete = Completeness::Open;
            }
        }
        Self { counters, episodes }
    }
}

/// The bytes as a flash of so many whole slots, erased where the file ends before.
fn flash(bytes: &[u8], slots: usize) -> RamNor {
    let mut bytes = bytes.to_vec();
    bytes.resize(bytes_of(slots), 0xff);
    RamNor(bytes)
}

fn is_block(bytes: &[u8]) -> bool {
    let (pages, _) = bytes.as_chunks::<BLOCK_BYTES>();
    let mut opened = pages.iter().map(Page::open);
    opened.any(|it| matches!(it, Page::Sealed(_)))
}

fn newest(flash: &mut RamNor) -> Option<Counters> {
    let counters = drop_log::counters(flash).expect("within the flash");
    (counters.generation > 0).then_some(counters)
}

/// The episode in a slot, if the store finds one there, or would but for damage.
fn held(flash: &mut RamNor, number: usize) -> Option<Episode> {
    let slot: Slot = drop_log::slot(flash, number).expect("within the flash");
    let mut pages = vec![0; EPISODE_BYTES];
    let address = bytes_of(number) as u32;
    flash.read(address, &mut pages).expect("within the flash");
    // An erasure goes from the first page to the last.
    let is_erased = pages[..BLOCK_BYTES].iter().all(|it| *it == 0xff);
    if slot.released || (slot.sequence == 0 && is_erased) {
        return None;
    }
    let mut episode = Episode::of(&pages);
    episode.report.sequence?;
    episode.slot = Some(number);
    episode.locked = slot.locked;
    if slot.sequence != episode.sequence {
        episode.flaw("its first pages are lost, so the controller does not know it".to_owned());
    }
    Some(episode)
}

/// Of episodes in the order of their numbers.
fn mark_twins(episodes: &mut [Episode]) {
    for twins in episodes.chunk_by_mut(|a, b| a.sequence == b.sequence) {
        let slots: Vec<_> = twins.iter().filter_map(|it| it.slot).collect();
        for it in twins {
            let own = it.slot;
            for slot in slots.iter().filter(|slot| own != Some(**slot)) {
                it.flaw(format!("slot {slot} has an episode of the same number"));
            }
        }
    }
}
