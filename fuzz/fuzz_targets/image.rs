//! Any bytes are an image that fits the chip, or are refused.

#![no_main]

use std::ops::Range;

use libfuzzer_sys::fuzz_target;

/// All that the files below need of their crate.
mod firmware {
    pub const FLASH: std::ops::Range<u64> = 0x0800_0000..0x0810_0000;
}

// xtask is a program; these two files of it are all that is taken.
#[path = "../../xtask/src/flash/chip.rs"]
#[allow(dead_code, reason = "the program uses the rest")]
mod chip;
#[path = "../../xtask/src/flash/image.rs"]
mod image;

use chip::Chip;

const FLASH: Range<u64> = 0x0800_0000..0x080e_0000;

fuzz_target!(|bytes: &[u8]| {
    let ram = 0x2000_0000..0x2002_0000;
    let chip = Chip { flash: FLASH, ram };
    if let Ok(layout) = image::check(bytes, &chip) {
        assert!(
            layout
                .programmed
                .iter()
                .any(|it| it.contains(&layout.start))
        );
        let inside = |it: &Range<u64>| FLASH.start <= it.start && it.end <= FLASH.end;
        assert!(layout.programmed.iter().all(inside));
    }
});
