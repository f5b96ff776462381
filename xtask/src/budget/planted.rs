//! The check finds what is planted into images that are really built: the feature `plants` of the firmware. That
//! the clean ones keep to their limits is what `cargo xtask budget` requires. No symbol tells of a loop without end: it is found
//! where a stream of the corpus enters it.

use super::judge::{breaches, limits};
use super::{Budget, cycles, image, stream};
use crate::firmware::{PLANTED, images};

#[test]
fn planted_panics_f64_divisions_and_a_loop_without_end_break_the_budget() {
    let planted = |name: &str| {
        let file = images().join(PLANTED).join(name);
        let built = file.is_file();
        assert!(built, "{}: `cargo xtask test` builds it", file.display());
        file
    };
    let mut limits = limits().expect("limits");
    let clean = image::look(&images().join("touchdown-tick")).expect("symbols");
    assert_eq!(clean.panics, [""; 0]);
    limits.soft_float_symbols = clean.soft_float.len() as u64;

    let reached = image::look(&planted("touchdown-tick")).expect("symbols");
    for place in ["in_tick", "behind_link", "in_flash"] {
        let is_named = reached.panics.iter().any(|it| it.contains(place));
        assert!(is_named, "{place} is not among {:?}", reached.panics);
    }
    let corpus = stream::read().expect("a corpus");
    let image = planted("touchdown-count-tick");
    let (table, cycles) = cycles::count(&image, &corpus[..1]).expect("counts");
    // 5 000 divisions of 14 cycles each: Cortex-M4 Technical Reference Manual, table 7-1.
    let (divisions, without_end) = cycles.worst_of("outputs");
    assert!(divisions > 5_000 * 14, "{divisions}");
    // A loop without end shows where the corpus has what enters it: here it ends after 100 000 turns.
    let tick = table.tick().expect("a whole tick");
    assert!(without_end > 200_000, "{without_end}");
    assert!(tick.instructions_worst < 100_000, "{tick:?}");
    let budget = Budget {
        parts: table.parts(),
        tick,
        flash_bytes: 0,
        ram_bytes: 0,
        stack_bytes: 0,
        panic_free: reached.panics.is_empty(),
        soft_float_symbols: reached.soft_float.len() as u64,
        flash_by_module: vec![],
        compiler: table.compiler,
        cycles: Some(cycles),
    };
    let found = breaches(&budget, &limits);
    println!("{found:?}");
    for name in [
        "panic_free",
        "soft_float_symbols",
        "tick_worst",
        "outputs",
        "cycles_worst",
    ] {
        let is_found = found.iter().any(|it| it.starts_with(name));
        assert!(is_found, "{name} is not among {found:?}");
    }
}
