//! Cycles of the tick as the emulator's plugin (`xtask/cycles`) models them: no chip has counted them.

use std::fmt::{self, Write as _};
use std::fs;
use std::iter;
use std::path::{Path, PathBuf};
use std::thread;

use anyhow::{Context, ensure};
use serde::{Deserialize, Serialize};

use super::queue::{self, MainLoopTurn, Queue};
use super::stream::Stream;
use super::ticks::{self, Row, TYPICAL, Table};
use crate::firmware;

const CLOCK: u64 = 168_000_000;
/// Conversions of a sample, and rates of conversions, 1/s; the first is that of the firmware: `firmware/src/board/mod.rs`.
const CONVERSIONS: u64 = 2;
const RATES: [u64; 3] = [20_000, 25_000, 50_000];
const PERIOD: u64 = CONVERSIONS * CLOCK / RATES[0];
/// Samples that can wait: `firmware/src/intake.rs`.
const RING: usize = 31;
/// Samples in a row, then a turn of the main loop: `firmware/src/tick.rs`.
const IN_A_ROW: u32 = 32;
/// Samples in 10 ms.
const SPAN: usize = 100;
/// Entry and exit of the interrupt: 12 cycles and 18 words of the floating-point unit each way, as modelled a line of
/// flash each way. How far these could be checked: `docs/build/timing.md`.
const ENTRY_AND_EXIT: Cycles = Cycles {
    lower: 60,
    modelled: 72,
    upper: 150,
};
/// Parts in the order in which the image counts them, after a stream's whole ticks.
const PARTS: [&str; 10] = [
    // What the highest priority does with those that were read; with the last one of a sample it does most.
    "earlier conversions of a sample",
    "sampling and guard on top",
    "guard",
    "proof, alarms, touches",
    "sensing and health",
    "detector",
    "severity",
    "outputs",
    "recorder",
    "forecast slice",
];
const WINDOW_BYTES: usize = 16;

/// At the least, as modelled, at the most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cycles {
    lower: u64,
    modelled: u64,
    upper: u64,
}

impl Cycles {
    /// Each figure by itself.
    fn each(self, other: Self, with: impl Fn(u64, u64) -> u64) -> Self {
        Self {
            lower: with(self.lower, other.lower),
            modelled: with(self.modelled, other.modelled),
            upper: with(self.upper, other.upper),
        }
    }
}

/// Of all streams.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Modelled {
    /// Between two samples, at 20 000 conversions a second.
    period: u64,
    /// Of a sample.
    conversions: u64,
    /// Mean while the rotor floats on its orbit.
    typical: Cycles,
    /// Greatest of any tick, each figure by itself.
    worst: Cycles,
    /// Longest that the interrupt of highest priority holds the core, with entry and exit, and without the dozen registers
    /// that it reads.
    top_priority_worst: Cycles,
    /// Greatest mean over 10 ms.
    mean_10_ms_modelled: u64,
    /// At 20 000 conversions a second, with the ring.
    samples_lost_modelled: u64,
    streams: usize,
    /// Of them found by a search; the others are the image's own.
    streams_of_corpus: usize,
    /// Greatest of any tick in those of the corpus.
    corpus_instructions_worst: Option<u64>,
    ticks: usize,
    /// Mean and greatest of each part, as modelled.
    parts: Vec<PartModelled>,
    /// At each rate.
    queues: Vec<AtRate>,
}

impl Modelled {
    /// What has a limit, as modelled.
    pub fn limited(&self) -> [(&'static str, u64); 3] {
        [
            ("worst", self.worst.modelled),
            ("top_priority_worst", self.top_priority_worst.modelled),
            ("mean_10_ms", self.mean_10_ms_modelled),
        ]
    }

    #[cfg(test)]
    pub fn with_worst(modelled: u64) -> Self {
        let mut it = super::cycles::modelled(&[]);
        it.worst.modelled = modelled;
        it
    }

    /// The worst of a part, as modelled, and of any tick in the corpus, in instructions.
    #[cfg(test)]
    pub fn worst_of(&self, part: &str) -> (u64, u64) {
        let mut parts = self.parts.iter().filter(|it| it.part == part);
        let of_part = parts.next().map_or(0, |it| it.worst_modelled);
        (of_part, self.corpus_instructions_worst.unwrap_or(0))
    }
}

/// A part of the tick.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct PartModelled {
    part: String,
    typical_modelled: u64,
    worst_modelled: u64,
}

/// What the samples meet.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct AtRate {
    conversions_per_s: u64,
    places: usize,
    samples_lost: u64,
    /// From a sample to the end of its tick.
    latency_worst_us: u64,
}

/// A stretch between two readings of the counter.
#[derive(Clone, Copy, Debug)]
struct CountedWindow {
    instructions: u64,
    cycles: Cycles,
}

/// The ticks of a stream.
struct PlayedStream<'a> {
    is_typical: bool,
    ticks: &'a [CountedWindow],
    /// As many as `PARTS` for each tick, or none.
    parts: &'a [CountedWindow],
}

/// The counting image with the plugin.
pub struct Player {
    image: PathBuf,
    /// Its file, and the image's code.
    plugin: String,
}

/// The worst tick of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorstTick {
    instructions: u64,
    pub modelled: u64,
}

impl fmt::Display for WorstTick {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} cycles as modelled", self.modelled)?;
        write!(f, ", {} instructions", self.instructions)
    }
}

impl Player {
    pub fn new(image: &Path) -> anyhow::Result<Self> {
        let code = ticks::folder(image, "run")?.join("code.bin");
        fs::write(&code, firmware::flash_content(image)?)
            .context("cannot write the image's code")?;
        let plugin = firmware::build_plugin()?;
        Ok(Self {
            image: image.into(),
            plugin: format!("{},code={}", plugin.display(), code.display()),
        })
    }

    /// The image's own table and the plugin's windows, of these streams, or of the image's own where there are none.
    fn play(
        &self,
        name: &str,
        described: &[Stream],
    ) -> anyhow::Result<(Table, Vec<CountedWindow>)> {
        let folder = ticks::folder(&self.image, name)?;
        if !described.is_empty() {
            let bytes: Vec<u8> = described.iter().flat_map(Stream::bytes).collect();
            fs::write(folder.join("streams.bin"), bytes).context("cannot write the streams")?;
        }
        let out = folder.join("windows.bin");
        let plugin = format!("{},out={}", self.plugin, out.display());
        let table = ticks::count_in(&folder, &self.image, Some(&plugin))?;
        let bytes = fs::read(&out).context("the plugin wrote nothing")?;
        let (windows, _) = bytes.as_chunks();
        Ok((table, windows.iter().map(window).collect()))
    }

    /// Of each stream.
    pub fn worst(&self, name: &str, described: &[Stream]) -> anyhow::Result<Vec<WorstTick>> {
        let (table, windows) = self.play(name, described)?;
        let streams = streams(&table, &windows)?;
        let modelled = |it: &PlayedStream| worst(it.ticks.iter().map(|it| it.cycles)).modelled;
        let worst = |((row, _), stream): ((&Row, _), _)| WorstTick {
            instructions: row.worst,
            modelled: modelled(stream),
        };
        Ok(table.streams().zip(&streams).map(worst).collect())
    }
}

/// Runs the counting image under the plugin, over its own streams and the `corpus` at once: the table of its own, and
/// the cycles of all.
pub fn count(image: &Path, corpus: &[Stream]) -> anyhow::Result<(Table, Modelled)> {
    let player = Player::new(image)?;
    let (own, found) = thread::scope(|scope| {
        let found = scope.spawn(|| player.play("corpus", corpus));
        (player.play("run", &[]), found.join().expect("no panic"))
    });
    let ((table, windows), (of_corpus, windows_of_corpus)) = (own?, found?);
    let mut all = streams(&table, &windows)?;
    all.extend(streams(&of_corpus, &windows_of_corpus)?);
    let mut modelled = modelled(&all);
    modelled.corpus_instructions_worst = of_corpus.streams().map(|it| it.0.worst).max();
    modelled.streams_of_corpus = corpus.len();
    Ok((table, modelled))
}

fn window(bytes: &[u8; WINDOW_BYTES]) -> CountedWindow {
    let number = |k: usize| u64::from(u32::from_le_bytes(bytes.as_chunks().0[k]));
    let [instructions, lower, modelled, upper] = [0, 1, 2, 3].map(number);
    CountedWindow {
        instructions,
        cycles: Cycles {
            lower,
            modelled,
            upper,
        },
    }
}

/// Windows by stream; fails where their instructions are not those that the image counted itself.
fn streams<'a>(
    table: &Table,
    windows: &'a [CountedWindow],
) -> anyhow::Result<Vec<PlayedStream<'a>>> {
    // The first is empty: the image measures by it what two readings take, and by its clock that is one more.
    let (empty, mut rest) = windows.split_first().context("the plugin saw no window")?;
    let readings = empty.instructions + 1;
    let mut streams = vec![];
    for (row, parts) in table.streams() {
        let (scene, ticks, counted) = (&row.scene, row.calls as usize, row.worst);
        let all = ticks * (1 + parts);
        ensure!(rest.len() >= all, "the plugin's windows end in {scene}");
        let (these, after) = rest.split_at(all);
        let (ticks, parts) = these.split_at(ticks);
        let worst = ticks.iter().map(|it| it.instructions).max();
        let worst = worst.map_or(0, |it| it.saturating_sub(readings));
        ensure!(
            worst == counted,
            "{scene}: {worst} instructions by the plugin, {counted} by the image"
        );
        streams.push(PlayedStream {
            is_typical: scene == TYPICAL,
            ticks,
            parts,
        });
        rest = after;
    }
    let left = rest.len();
    ensure!(left == 0, "the plugin saw {left} windows too many");
    Ok(streams)
}

fn mean(cycles: impl Iterator<Item = Cycles>) -> Cycles {
    let (mut sum, mut count) = (Cycles::default(), 0);
    for it in cycles {
        sum = sum.each(it, |a, b| a + b);
        count += 1;
    }
    sum.each(sum, |it, _| it / count.max(1))
}

fn worst(cycles: impl Iterator<Item = Cycles>) -> Cycles {
    cycles.fold(Cycles::default(), |a, b| a.each(b, u64::max))
}

fn modelled(streams: &[PlayedStream]) -> Modelled {
    let typical = || streams.iter().filter(|it| it.is_typical);
    let ticks = || streams.iter().flat_map(|it| it.ticks);
    let longest = worst(ticks().map(|it| it.cycles));
    let [earlier, on_top] = [0, 1].map(|k| worst(streams.iter().flat_map(|it| it.part(k))));
    let on_top = on_top.each(ENTRY_AND_EXIT, |a, b| a + b);
    let entries = (CONVERSIONS - 1) * ENTRY_AND_EXIT.modelled;
    let of_sample = on_top.modelled + earlier.modelled + entries;
    let interrupts = |it: &PlayedStream| it.interrupts(of_sample);
    let interrupts: Vec<Vec<u64>> = streams.iter().map(interrupts).collect();
    let part = |(k, part): (usize, &&str)| PartModelled {
        part: (*part).into(),
        typical_modelled: mean(typical().flat_map(|it| it.part(k))).modelled,
        worst_modelled: worst(streams.iter().flat_map(|it| it.part(k))).modelled,
    };
    // A slice of the forecast is the longest thing that the main loop does.
    let slices = streams.iter().flat_map(|it| it.part(PARTS.len() - 1));
    let turn = MainLoopTurn {
        in_a_row: IN_A_ROW,
        cycles: worst(slices).modelled,
    };
    let queues: Vec<_> = RATES.map(|rate| at_rate(&interrupts, rate, turn)).into();
    let spans = interrupts.iter().flat_map(|it| it.windows(SPAN));
    let mean_10_ms = spans.map(|it| it.iter().sum::<u64>() / SPAN as u64).max();
    Modelled {
        period: PERIOD,
        conversions: CONVERSIONS,
        typical: mean(typical().flat_map(|it| it.ticks).map(|it| it.cycles)),
        worst: longest,
        top_priority_worst: on_top,
        mean_10_ms_modelled: mean_10_ms.unwrap_or(0),
        samples_lost_modelled: queues[0].samples_lost,
        streams: streams.len(),
        streams_of_corpus: 0,
        corpus_instructions_worst: None,
        ticks: ticks().count(),
        parts: iter::zip(0.., &PARTS).map(part).collect(),
        queues,
    }
}

impl PlayedStream<'_> {
    /// What each sample takes of the core, as modelled: so much `on_top` for its conversions, and its tick.
    fn interrupts(&self, on_top: u64) -> Vec<u64> {
        let of = |it: &CountedWindow| on_top + it.cycles.modelled + ENTRY_AND_EXIT.modelled;
        self.ticks.iter().map(of).collect()
    }

    fn part(&self, k: usize) -> impl Iterator<Item = Cycles> {
        let every = self.parts.iter().skip(k).step_by(PARTS.len());
        every.map(|it| it.cycles)
    }
}

/// Each stream by itself.
fn at_rate(streams: &[Vec<u64>], rate: u64, turn: MainLoopTurn) -> AtRate {
    let period = CONVERSIONS * CLOCK / rate;
    let queues = streams
        .iter()
        .map(|it| queue::simulate(it, period, RING, turn));
    let all = queues.fold(Queue::default(), |a, b| Queue {
        lost: a.lost + b.lost,
        latency_worst: a.latency_worst.max(b.latency_worst),
    });
    AtRate {
        conversions_per_s: rate,
        places: RING,
        samples_lost: all.lost,
        latency_worst_us: all.latency_worst.div_ceil(CLOCK / 1_000_000),
    }
}

pub fn table(it: &Modelled) -> String {
    let mut text = format!(
        "  cycles, modelled and not measured, {} streams, {} ticks; period {}\n    {:24} {:>7} {:>8} {:>7}\n",
        it.streams, it.ticks, it.period, "", "lower", "modelled", "upper"
    );
    for (name, cycles) in [
        ("typical", it.typical),
        ("worst", it.worst),
        ("on top at worst", it.top_priority_worst),
    ] {
        let [lower, modelled, upper] = [cycles.lower, cycles.modelled, cycles.upper];
        let _ = writeln!(text, "    {name:24} {lower:7} {modelled:8} {upper:7}");
    }
    if let Some(worst) = it.corpus_instructions_worst {
        let streams = it.streams_of_corpus;
        let _ = writeln!(
            text,
            "    {streams} of the streams are of the corpus; {worst} instructions at worst there"
        );
    }
    let mean = it.mean_10_ms_modelled;
    let _ = writeln!(text, "    {:24} {:7} {mean:8}", "worst mean of 10 ms", "");
    for part in &it.parts {
        let (name, typical, worst) = (&part.part, part.typical_modelled, part.worst_modelled);
        let _ = writeln!(text, "    {name:24} typical {typical}, worst {worst}");
    }
    for at in &it.queues {
        let _ = writeln!(
            text,
            "    {} conversions/s, {} waiting at most: {} lost, {} us at most to the end of a tick",
            at.conversions_per_s, at.places, at.samples_lost, at.latency_worst_us
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window_of(modelled: u64) -> CountedWindow {
        CountedWindow {
            instructions: modelled,
            cycles: Cycles {
                lower: modelled - 1,
                modelled,
                upper: 2 * modelled,
            },
        }
    }

    #[test]
    fn figures_are_of_the_streams_and_the_interrupts_add_entry_and_exit() {
        let orbit = [window_of(5_000), window_of(7_000)];
        let mut drop = [window_of(10); SPAN];
        drop[0] = window_of(30_000);
        let parts: Vec<_> = (1..=10).map(|k| window_of(100 * k)).collect();
        let stream = |is_typical, ticks| PlayedStream {
            is_typical,
            ticks,
            parts: &parts,
        };
        let it = modelled(&[stream(true, &orbit), stream(false, &drop)]);
        assert_eq!((it.typical.lower, it.typical.modelled), (5_999, 6_000));
        assert_eq!((it.worst.modelled, it.worst.upper), (30_000, 60_000));
        assert_eq!(it.top_priority_worst.modelled, 272);
        assert_eq!(it.parts[4].worst_modelled, 500);
        // Besides the ticks each sample takes 272 on top, 172 of the earlier conversion and 72 of its tick's interrupt.
        assert_eq!(it.mean_10_ms_modelled, (30_000 + 99 * 10) / 100 + 516);
        // The first sample takes 1.8 periods, and the next ones wait.
        assert_eq!(it.samples_lost_modelled, 0);
        assert_eq!((it.streams, it.ticks), (2, 102));
    }

    #[test]
    fn windows_that_are_not_those_of_the_image_are_refused() {
        let mut text = "compiler,rustc\ntick|drop|1|90|90\n".to_owned();
        for part in PARTS {
            let _ = writeln!(text, "{part}|drop|1|2|2");
        }
        let table = Table::parse(&text).unwrap();
        let mut windows = vec![window_of(1); 2 + PARTS.len()];
        windows[1] = window_of(92);
        assert_eq!(streams(&table, &windows).unwrap().len(), 1);
        windows[1] = window_of(93);
        assert!(streams(&table, &windows).is_err());
        assert!(streams(&table, &windows[..windows.len() - 1]).is_err());
    }
}
