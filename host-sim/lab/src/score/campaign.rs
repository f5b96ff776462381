//! Cases times seeds, on all cores, in order.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use super::Plan;
use touchdown_base::failure::Failure;
use touchdown_base::progress;

/// What `job` makes of each seed of each case. Its random numbers depend on seed and case alone.
pub fn map<C: Sync, T: Send>(
    plan: &Plan,
    what: &'static str,
    cases: &[C],
    job: impl Fn(&C, ChaCha8Rng) -> Result<T, Failure> + Sync,
) -> Result<Vec<Vec<T>>, Failure> {
    map_of(plan.first_seed, plan.seeds, what, cases, job)
}

/// Likewise, of so many seeds.
pub fn map_of<C: Sync, T: Send>(
    first_seed: u64,
    seeds: u64,
    what: &'static str,
    cases: &[C],
    job: impl Fn(&C, ChaCha8Rng) -> Result<T, Failure> + Sync,
) -> Result<Vec<Vec<T>>, Failure> {
    let progress = progress::bar(what, cases.len() as u64 * seeds);
    let done = cases.par_iter().enumerate().map(|(number, case)| {
        let seeded = (0..seeds).into_par_iter().map(|index| {
            let done = job(case, random(first_seed.wrapping_add(index), number));
            progress.inc(1);
            done
        });
        seeded.collect::<Result<Vec<T>, Failure>>()
    });
    let done = done.collect();
    progress.finish_and_clear();
    done
}

/// Random numbers of a seed of a case.
pub fn random(seed: u64, case: usize) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(case as u64);
    random
}
