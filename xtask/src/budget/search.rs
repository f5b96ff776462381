//! Looks for streams whose worst tick takes most cycles, as modelled: at random, then from the worst ones on.

use std::cmp::Reverse;
use std::fs;
use std::process::Command;
use std::thread;

use anyhow::{Context, ensure};

use super::cycles::{Player, WorstTick};
use super::stream::{self, Chance, FILE, Stream};
use crate::firmware;
use crate::toolchain::output;
use crate::workspace;

/// Worst streams that are kept, each of another random one.
const KEPT: usize = 20;
/// Emulators at once, and streams that each plays.
const EMULATORS: usize = 2;
const PLAYED: usize = 20;

/// A stream that was played.
type Found = (WorstTick, Stream);

/// Searches `count` streams, or somewhat more, the second half of them by changing the worst of the first; writes the
/// worst ones to the corpus.
pub fn run(count: usize, seed: u64) -> anyhow::Result<()> {
    println!("Search: building");
    firmware::build_one("touchdown-count-tick", &[])?;
    let player = Player::new(&firmware::images().join("touchdown-count-tick"))?;
    let mut chance = Chance(seed);
    let rounds = count.div_ceil(2 * EMULATORS * PLAYED);
    let mut all: Vec<Found> = vec![];
    for _ in 0..rounds {
        let any = (0..EMULATORS * PLAYED).map(|_| Stream::any(&mut chance));
        all.extend(play(&player, any.collect())?);
        report(&all);
    }
    let mut kept = all.clone();
    kept.sort_by_key(|it| Reverse(it.0.modelled));
    kept.truncate(KEPT);
    let at_random = kept[0].0;
    for _ in 0..rounds {
        let near = (0..EMULATORS * PLAYED).map(|k| kept[k % KEPT].1.near(&mut chance));
        let found = play(&player, near.collect())?;
        for (k, it) in found.iter().enumerate() {
            if it.0.modelled > kept[k % KEPT].0.modelled {
                kept[k % KEPT] = *it;
            }
        }
        all.extend(found);
        report(&all);
        // As a search takes long, what it has is kept as it goes.
        let head = head(&all, count, seed, at_random)?;
        let mut sorted = kept.clone();
        sorted.sort_by_key(|it| Reverse(it.0.modelled));
        let remarked = sorted.iter().map(|it| (&it.1, it.0.to_string()));
        fs::write(workspace().join(FILE), stream::text(&head, remarked)).context(FILE)?;
    }
    Ok(())
}

/// The worst tick of each, in their order.
fn play(player: &Player, streams: Vec<Stream>) -> anyhow::Result<Vec<Found>> {
    let shares = streams.chunks(streams.len().div_ceil(EMULATORS));
    let worst = thread::scope(|scope| {
        let started: Vec<_> = shares
            .enumerate()
            .map(|(k, share)| scope.spawn(move || player.worst(&format!("search-{k}"), share)))
            .collect();
        let joined = started.into_iter().map(|it| it.join().expect("no panic"));
        joined.collect::<anyhow::Result<Vec<_>>>()
    })?;
    let worst: Vec<_> = worst.into_iter().flatten().collect();
    ensure!(worst.len() == streams.len(), "streams were not played");
    Ok(worst.into_iter().zip(streams).collect())
}

fn report(found: &[Found]) {
    let worst = found.iter().map(|it| it.0).max_by_key(|it| it.modelled);
    let worst = worst.map_or_else(String::new, |it| it.to_string());
    println!("  {} streams: {worst}", found.len());
}

/// What the corpus says of itself.
fn head(found: &[Found], count: usize, seed: u64, at_random: WorstTick) -> anyhow::Result<String> {
    let mut git = Command::new("git");
    git.args(["rev-parse", "--short", "HEAD"]);
    let commit = output(git.current_dir(workspace()))?;
    let date = output(Command::new("date").args(["-u", "+%F"]))?;
    let (commit, date, played) = (commit.trim(), date.trim(), found.len());
    Ok(format!(
        "The worst streams that were found for the tick, by its modelled cycles; each of another random stream.\n\
         Written by cargo xtask budget --search {count} --seed {seed} after {played} streams, {date} at {commit}.\n\
         What the numbers are: xtask/src/budget/stream.rs.\n\
         Worst of the random half: {at_random}."
    ))
}
