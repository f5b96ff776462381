//! The check finds what is planted into images that are really built: the feature `plants` of the firmware. That
//! the clean ones keep to their limits is what `cargo xtask budget` requires.

use super::judge::{Limits, breaches};
use super::{Budget, cycles, image};
use crate::firmware::{PLANTED, images};

#[test]
fn a_planted_panic_f64_and_slow_path_break_the_budget() {
    let planted = |name: &str| {
        let file = images().join(PLANTED).join(name);
        let built = file.is_file();
        assert!(built, "{}: `cargo xtask test` builds it", file.display());
        file
    };
    let file = crate::workspace().join("firmware/budget.toml");
    let mut limits = Limits::read(&file).expect("limits");
    let clean = image::look(&images().join("touchdown-tick")).expect("symbols");
    assert_eq!(clean.panics, [""; 0]);
    limits.soft_float_symbols = clean.soft_float.len() as u64;

    let reached = image::look(&planted("touchdown-tick")).expect("symbols");
    let (table, cycles) = cycles::count(&planted("touchdown-count-tick"), &[]).expect("counts");
    // A loop of 20 000 turns is more cycles than instructions, and samples are lost meanwhile.
    assert!(cycles.shows_a_loop_of(20_000), "{cycles:?}");
    let budget = Budget {
        parts: table.parts(),
        tick: table.tick().expect("a whole tick"),
        flash_bytes: 0,
        ram_bytes: 0,
        stack_bytes: 0,
        panic_free: reached.panics.is_empty(),
        soft_float_symbols: reached.soft_float.len() as u64,
        flash_by_module: vec![],
        compiler: table.compiler,
        cycles: None,
    };
    let found = breaches(&budget, &limits);
    println!("{found:?}");
    for name in ["panic_free", "soft_float_symbols", "tick_worst", "outputs"] {
        let is_found = found.iter().any(|it| it.starts_with(name));
        assert!(is_found, "{name} is not among {found:?}");
    }
}
