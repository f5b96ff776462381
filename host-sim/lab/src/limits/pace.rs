//! How long a drop of 1 s takes: model, truth, sensors and detector over random machines.

use std::fs;
use std::io;
use std::time::Instant;

use rayon::prelude::*;

use super::machines::text;
use super::row::Row;
use touchdown_base::failure::Failure;
use touchdown_base::progress::Progress;
use touchdown_run::drop;
use touchdown_run::target::Target;
use touchdown_scene::{Precision, Scene};

/// Of the drop, s.
const DURATION: f64 = 1.0;
/// Processor time that it may take on one core, s.
const MOST: f64 = 8.0;
/// Machines that are told of.
const SLOWEST: usize = 5;

/// Drops the first `machines` random machines and times each: the slowest, and how often the truth was given up.
pub fn rows(machines: u64) -> Result<Vec<Row>, Failure> {
    let mut progress = Progress::of_jobs("limits", machines);
    let mut all: Vec<(u64, f64, bool)> = Vec::new();
    let seeds: Vec<u64> = (0..machines).collect();
    for some in seeds.chunks(64) {
        let timed = some.par_iter().map(|seed| timed(*seed));
        all.extend(timed.collect::<Result<Vec<_>, Failure>>()?);
        some.iter().for_each(|_| progress.advance());
    }
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    let given_up = all.iter().filter(|it| it.2).count();
    let name = format!("drop of 1 s: {machines} machines, truth given up in {given_up}");
    let row = |(seed, taken, _): &(u64, f64, bool)| {
        let row = Row::of(format!("{name}: machine {seed}"), Precision::F64);
        row.at_most(*taken, MOST, "s of processor")
    };
    Ok(all.iter().take(SLOWEST).map(row).collect())
}

/// A machine, the processor time of its drop, and whether its truth was given up.
fn timed(seed: u64) -> Result<(u64, f64, bool), Failure> {
    let mut scene = Scene::parse(&format!("machine {seed}"), &text(seed))?;
    scene.run.duration = DURATION;
    let (begun, before) = (Instant::now(), processor_time());
    let (outcome, _) = drop::run(&scene, &Target::Host, None::<io::Sink>)?;
    let wall = begun.elapsed().as_secs_f64();
    let own = before.zip(processor_time()).map(|(from, to)| to - from);
    Ok((seed, own.unwrap_or(wall), outcome.given_up.is_some()))
}

/// Of this thread, s, where the system tells it.
fn processor_time() -> Option<f64> {
    let told = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = told.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
