//! The chip's memory, from memory.x and the reference manual.

use std::ops::Range;

use anyhow::{Context, ensure};

use crate::firmware::FLASH;

/// Main flash of an STM32F405xG or F407xG: RM0090, flash module organization: 4 sectors of 16 Kbytes, one of
/// 64, 7 of 128.
const SECTOR_KIB: [u64; 12] = [16, 16, 16, 16, 64, 128, 128, 128, 128, 128, 128, 128];
/// SRAM1 and SRAM2: RM0090, embedded SRAM.
const RAM: Range<u64> = 0x2000_0000..0x2002_0000;

/// Where an image may lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chip {
    /// What memory.x gives to the program.
    pub flash: Range<u64>,
    /// Likewise, stack included.
    pub ram: Range<u64>,
}

impl Chip {
    /// From the text of memory.x, which must keep to the chip and leave whole sectors for the stored
    /// configuration.
    pub fn of(memory_x: &str) -> anyhow::Result<Self> {
        let flash = region(memory_x, "FLASH")?;
        let (stack, data) = (region(memory_x, "STACK")?, region(memory_x, "RAM")?);
        ensure!(
            stack.end == data.start,
            "memory.x: the stack does not end where the data begin"
        );
        let ram = stack.start..data.end;
        ensure!(
            flash.start == FLASH.start && sectors().any(|it| it.end == flash.end),
            "memory.x: FLASH {} is not a row of the chip's sectors",
            shown(&flash)
        );
        ensure!(
            RAM.start <= ram.start && ram.end <= RAM.end,
            "memory.x: {} is not in the chip's RAM",
            shown(&ram)
        );
        Ok(Self { flash, ram })
    }
}

/// The chip's sectors.
pub fn sectors() -> impl Iterator<Item = Range<u64>> {
    SECTOR_KIB.iter().scan(FLASH.start, |at, kib| {
        let start = *at;
        *at += kib << 10;
        Some(start..*at)
    })
}

/// A range of addresses, for people.
pub fn shown(range: &Range<u64>) -> String {
    format!("{:#010x}..{:#010x}", range.start, range.end)
}

/// `NAME : ORIGIN = 0x08000000, LENGTH = 896K`.
fn region(memory_x: &str, name: &str) -> anyhow::Result<Range<u64>> {
    let parse = || {
        let mut lines = memory_x.lines().map(str::trim);
        let rest = lines.find_map(|line| line.strip_prefix(name)?.trim().strip_prefix(':'))?;
        let (origin, length) = rest.split_once(',')?;
        let value = |text: &str| Some(text.split_once('=')?.1.trim().to_owned());
        let start = u64::from_str_radix(value(origin)?.strip_prefix("0x")?, 16).ok()?;
        let kib: u64 = value(length)?.strip_suffix('K')?.parse().ok()?;
        Some(start..start + (kib << 10))
    };
    parse().with_context(|| format!("memory.x has no region {name} with ORIGIN and LENGTH"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sectors_fill_a_mebibyte_and_the_last_is_that_of_the_configuration() {
        let all: Vec<_> = sectors().collect();
        assert_eq!(all.len(), 12);
        assert!(all.windows(2).all(|it| it[0].end == it[1].start));
        assert_eq!(all[11], 0x080e_0000..0x0810_0000);
    }

    #[test]
    fn the_map_in_force_is_the_chips() {
        let text = std::fs::read_to_string(crate::workspace().join("memory.x")).unwrap();
        let chip = Chip::of(&text).unwrap();
        assert_eq!(chip.flash, 0x0800_0000..0x080e_0000);
        assert_eq!(chip.ram, 0x2000_0000..0x2002_0000);
    }

    #[test]
    fn a_map_that_is_not_the_chips_is_refused() {
        let text = |flash: &str, ram: &str| {
            format!(
                "MEMORY {{\n  FLASH : ORIGIN = 0x08000000, LENGTH = {flash}\n  \
                 STACK : ORIGIN = 0x20000000, LENGTH = 32K\n  RAM : ORIGIN = 0x20008000, LENGTH = {ram}\n}}"
            )
        };
        assert!(Chip::of(&text("896K", "96K")).is_ok());
        // Half a sector; more RAM than there is; no region at all.
        assert!(Chip::of(&text("900K", "96K")).is_err());
        assert!(Chip::of(&text("896K", "128K")).is_err());
        assert!(Chip::of("MEMORY {}").is_err());
    }
}
