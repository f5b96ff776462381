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
    let progress = progress::bar(what, cases.len() as u64 * plan.seeds);
    let of_case = |(number, case)| {
        let seeded = (0..plan.seeds).into_par_iter().map(|index| {
            let mut random = ChaCha8Rng::seed_from_u64(plan.first_seed.wrapping_add(index));
            random.set_stream(number as u64);
            let done = job(case, random);
            progress.inc(1);
            done
        });
        seeded.collect()
    };
    cases.par_iter().enumerate().map(of_case).collect()
}
