//! The check finds what is planted into images that are really built: the feature `plants` of the firmware.

use super::judge::{Limits, breaches};
use super::{Budget, image, ticks};
use crate::firmware::{PLANTED, images};

/// A clean image, and the same with plants.
fn pair(name: &str) -> [std::path::PathBuf; 2] {
    let planted = images().join(PLANTED).join(name);
    assert!(
        planted.is_file(),
        "{}: `cargo xtask test` builds it",
        planted.display()
    );
    [images().join(name), planted]
}

/// The limits in force, each at what the clean image takes: any more is a breach.
fn within(clean: &Budget) -> Limits {
    let file = crate::workspace().join("firmware/budget.toml");
    let mut limits = Limits::read(&file).expect("limits");
    limits.tick = clean.tick;
    let parts = clean.parts.iter();
    limits.parts = parts
        .map(|it| (it.part.clone(), it.instructions.instructions_worst))
        .collect();
    limits
}

fn budget(table: &ticks::Table, reached: &image::Reached) -> Budget {
    Budget {
        parts: table.parts(),
        tick: table.tick().expect("a whole tick"),
        flash_bytes: 0,
        ram_bytes: 0,
        stack_bytes: 0,
        panic_free: reached.panics.is_empty(),
        soft_float_symbols: reached.soft_float.len() as u64,
    }
}

#[test]
fn a_planted_panic_f64_and_slow_path_break_the_budget() {
    let reached = pair("touchdown-tick").map(|it| image::look(&it).expect("symbols"));
    let tables = pair("touchdown-count-tick").map(|it| ticks::count(&it).expect("counts"));
    let [clean, planted] = [0, 1].map(|it| budget(&tables[it], &reached[it]));
    let mut limits = within(&clean);
    limits.soft_float_symbols = clean.soft_float_symbols;
    assert_eq!(breaches(&clean, &limits), [""; 0]);

    let found = breaches(&planted, &limits);
    for name in ["panic_free", "soft_float_symbols", "tick_worst", "outputs"] {
        let is_found = found.iter().any(|it| it.starts_with(name));
        assert!(is_found, "{name} is not among {found:?}");
    }
    // Of the plant's 20 000 turns.
    let part = |budget: &Budget, name: &str| {
        let part = budget.parts.iter().find(|it| it.part == name);
        part.expect("a part").instructions.instructions_worst
    };
    assert!(part(&planted, "outputs") > part(&clean, "outputs") + 20_000);
    println!("{found:?}");
}
