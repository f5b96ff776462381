//! Whether an image fits the chip.

use std::ops::Range;

use anyhow::{Context, bail, ensure};
use object::LittleEndian;
use object::elf::{EM_ARM, FileHeader32, PF_X, PT_LOAD};
use object::read::elf::{FileHeader, ProgramHeader};

use super::chip::{Chip, shown};

/// What is programmed, and where it starts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Flash that is programmed, a range a segment.
    pub programmed: Vec<Range<u64>>,
    /// Of the reset handler.
    pub start: u64,
}

/// Checks the segments, the vector table and the entry of an ELF file against the chip.
pub fn check(elf: &[u8], chip: &Chip) -> anyhow::Result<Layout> {
    let header = FileHeader32::<LittleEndian>::parse(elf).context("not an ELF file of 32 bit")?;
    let endian = header.endian().context("not of a little-endian machine")?;
    ensure!(header.e_machine(endian) == EM_ARM, "not a program for Arm");
    let mut programmed: Vec<Range<u64>> = vec![];
    let (mut code, mut in_ram) = (vec![], vec![]);
    let mut vectors = None;
    for segment in header.program_headers(endian, elf)? {
        let (size, held) = (segment.p_memsz(endian), segment.p_filesz(endian));
        if segment.p_type(endian) != PT_LOAD || size == 0 {
            continue;
        }
        let run = range(segment.p_vaddr(endian), size);
        ensure!(
            within(&run, &chip.flash) || within(&run, &chip.ram),
            "a segment at {} is neither in the program's flash nor in RAM",
            shown(&run)
        );
        if within(&run, &chip.ram) {
            in_ram.push(run);
        }
        if held == 0 {
            continue;
        }
        let load = range(segment.p_paddr(endian), held);
        ensure!(
            within(&load, &chip.flash),
            "a segment is to be programmed at {}, outside the program's flash {}",
            shown(&load),
            shown(&chip.flash)
        );
        if let Some(other) = programmed.iter().find(|it| overlap(it, &load)) {
            bail!("two segments lie at {} and {}", shown(other), shown(&load));
        }
        let bytes = segment.data(endian, elf).ok();
        let bytes = bytes.context("a segment is longer than the file")?;
        if load.start == chip.flash.start {
            vectors = bytes.first_chunk::<8>();
        }
        if segment.p_flags(endian) & PF_X != 0 {
            code.push(load.clone());
        }
        programmed.push(load);
    }
    let vectors = vectors.context("nothing lies at the start of the flash: no vector table")?;
    let words = u64::from_le_bytes(*vectors);
    let (stack, reset) = (words & 0xffff_ffff, words >> 32);
    ensure!(
        stack % 8 == 0 && chip.ram.start < stack && stack <= chip.ram.end,
        "the stack begins at {stack:#010x}, which is not in RAM"
    );
    if let Some(data) = in_ram.iter().find(|it| it.start < stack) {
        bail!(
            "data lie at {}, below the stack, which could overflow into them unseen",
            shown(data)
        );
    }
    let starts = [
        ("entry", u64::from(header.e_entry(endian))),
        ("reset vector", reset),
    ];
    for (what, address) in starts {
        let is_thumb = address & 1 == 1;
        ensure!(
            is_thumb && code.iter().any(|it| it.contains(&(address & !1))),
            "the {what} {address:#010x} is not in the code that is programmed"
        );
    }
    Ok(Layout {
        programmed,
        start: reset & !1,
    })
}

fn range(start: u32, size: u32) -> Range<u64> {
    let start = u64::from(start);
    start..start + u64::from(size)
}

fn within(inner: &Range<u64>, outer: &Range<u64>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

fn overlap(a: &Range<u64>, b: &Range<u64>) -> bool {
    a.start < b.end && b.start < a.end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware;

    const CHIP: Chip = Chip {
        flash: 0x0800_0000..0x080e_0000,
        ram: 0x2000_0000..0x2002_0000,
    };
    const CODE: u32 = 5;
    const DATA: u32 = 6;

    /// A segment: address to run at, address to be programmed at, bytes, size in memory, flags.
    type Segment<'a> = (u32, u32, &'a [u8], u32, u32);

    /// An ELF file of these segments.
    fn elf(entry: u32, segments: &[Segment<'_>]) -> Vec<u8> {
        let mut file = b"\x7fELF\x01\x01\x01".to_vec();
        file.resize(16, 0);
        let half = |file: &mut Vec<u8>, it: u16| file.extend(it.to_le_bytes());
        let word = |file: &mut Vec<u8>, it: u32| file.extend(it.to_le_bytes());
        half(&mut file, 2);
        half(&mut file, EM_ARM);
        for it in [1, entry, 52, 0, 0] {
            word(&mut file, it);
        }
        for it in [52, 32, segments.len() as u16, 40, 0, 0] {
            half(&mut file, it);
        }
        let mut at = 52 + 32 * segments.len() as u32;
        for (run, load, bytes, size, flags) in segments {
            let held = bytes.len() as u32;
            for it in [PT_LOAD, at, *run, *load, held, *size, *flags, 4] {
                word(&mut file, it);
            }
            at += held;
        }
        segments.iter().for_each(|it| file.extend(it.2));
        file
    }

    fn vectors(stack: u32, reset: u32) -> Vec<u8> {
        let mut bytes = [stack.to_le_bytes(), reset.to_le_bytes()].concat();
        bytes.resize(64, 0);
        bytes
    }

    /// Vector table and code at the start of the flash.
    fn with(stack: u32, reset: u32, entry: u32, more: &[Segment<'_>]) -> anyhow::Result<Layout> {
        let table = vectors(stack, reset);
        let first: Segment<'_> = (0x0800_0000, 0x0800_0000, &table, 64, CODE);
        check(&elf(entry, &[&[first], more].concat()), &CHIP)
    }

    const STACK: u32 = 0x2000_8000;
    const RESET: u32 = 0x0800_0021;

    fn reason(outcome: anyhow::Result<Layout>) -> String {
        outcome.expect_err("must be refused").to_string()
    }

    #[test]
    fn a_small_image_fits() {
        let layout = with(STACK, RESET, RESET, &[]).unwrap();
        assert_eq!(layout.programmed.len(), 1);
        assert_eq!(layout.programmed[0], 0x0800_0000..0x0800_0040);
        assert_eq!(layout.start, 0x0800_0020);
        // Data run in RAM and are programmed into the flash; what is zero at first is only in RAM.
        let data: Segment<'_> = (0x2000_8000, 0x0800_0040, &[7; 16], 16, DATA);
        let zero: Segment<'_> = (0x2000_8010, 0x2000_8010, &[], 4096, DATA);
        assert_eq!(
            with(STACK, RESET, RESET, &[data, zero])
                .unwrap()
                .programmed
                .len(),
            2
        );
    }

    #[test]
    fn an_image_that_does_not_fit_is_refused() {
        let refused = |segment: Segment<'_>| reason(with(STACK, RESET, RESET, &[segment]));
        // The sector of the stored configuration, across its border, beyond the chip, in core-coupled RAM.
        let bytes: &[u8] = &[0; 32];
        for place in [
            0x080e_0000,
            0x080d_fff0,
            0x0810_0000,
            0x1000_0000,
            0x0000_0000,
        ] {
            let why = refused((place, place, bytes, 32, DATA));
            assert!(why.contains("flash"), "{why}");
        }
        // Programmed into RAM, where it is gone with the power.
        let why = refused((0x2001_0000, 0x2001_0000, bytes, 32, DATA));
        assert!(why.contains("outside the program's flash"), "{why}");
        let why = refused((0x2001_ff00, 0, &[], 512, DATA));
        assert!(why.contains("nor in RAM"), "{why}");
        let why = refused((0x0800_0020, 0x0800_0020, bytes, 32, DATA));
        assert!(why.contains("two segments"), "{why}");
        // At the very end of the 32 bit, which must not wrap round.
        let why = refused((0xffff_fff0, 0xffff_fff0, bytes, 32, DATA));
        assert!(why.contains("nor in RAM"), "{why}");
    }

    #[test]
    fn data_below_the_stack_are_refused() {
        let zero: Segment<'_> = (0x2000_0000, 0x2000_0000, &[], 4096, DATA);
        let why = reason(with(STACK, RESET, RESET, &[zero]));
        assert!(why.contains("below the stack"), "{why}");
        // As without memory.x's own order: data at the bottom, the stack at the top.
        let why = reason(with(0x2002_0000, RESET, RESET, &[zero]));
        assert!(why.contains("below the stack"), "{why}");
    }

    #[test]
    fn a_start_outside_the_code_is_refused() {
        for entry in [0, 0x0800_0020, 0x0800_0041, 0x2000_0001, 0x080e_0001] {
            let why = reason(with(STACK, RESET, entry, &[]));
            assert!(why.contains("entry"), "{why}");
            let why = reason(with(STACK, entry, RESET, &[]));
            assert!(why.contains("reset vector"), "{why}");
        }
        let data: Segment<'_> = (0x0800_0040, 0x0800_0040, &[0; 32], 32, DATA);
        let why = reason(with(STACK, RESET, 0x0800_0051, &[data]));
        assert!(why.contains("entry"), "data is no code: {why}");
        for stack in [0, 0x2000_0000, 0x2002_0008, 0x2000_8004, 0x1000_8000] {
            let why = reason(with(stack, RESET, RESET, &[]));
            assert!(why.contains("stack"), "{why}");
        }
        let code = vectors(STACK, RESET);
        let elsewhere = elf(RESET, &[(0x0800_4000, 0x0800_4000, &code, 64, CODE)]);
        let why = reason(check(&elsewhere, &CHIP));
        assert!(why.contains("no vector table"), "{why}");
    }

    #[test]
    fn what_is_no_image_at_all_is_refused() {
        let good = elf(
            RESET,
            &[(0x0800_0000, 0x0800_0000, &vectors(STACK, RESET), 64, CODE)],
        );
        assert!(check(&good, &CHIP).is_ok());
        for length in 0..good.len() {
            assert!(
                check(&good[..length], &CHIP).is_err(),
                "cut to {length} bytes"
            );
        }
        let mut of_x86 = good.clone();
        of_x86[18..20].copy_from_slice(&62_u16.to_le_bytes());
        assert!(reason(check(&of_x86, &CHIP)).contains("Arm"));
    }

    #[test]
    fn the_built_image_fits_and_its_stack_lies_below_all_data() {
        for name in ["touchdown-firmware", "touchdown-qemu"] {
            let image = firmware::images().join(name);
            let elf = std::fs::read(&image).unwrap_or_else(|error| {
                panic!(
                    "{}: {error}; `cargo xtask firmware` builds it",
                    image.display()
                )
            });
            let layout = check(&elf, &CHIP).unwrap();
            assert_eq!(layout.programmed[0].start, 0x0800_0000);
            // memory.x: 27 KiB of stack at the bottom of RAM, as flip-link would have it.
            let vectors = FileHeader32::<LittleEndian>::parse(&elf[..]).unwrap();
            let segments = vectors.program_headers(LittleEndian, &elf[..]).unwrap();
            let first = segments
                .iter()
                .find(|it| it.p_paddr(LittleEndian) == 0x0800_0000);
            let table = first.unwrap().data(LittleEndian, &elf[..]).unwrap();
            assert_eq!(table[..4], 0x2000_6c00_u32.to_le_bytes());
            let (_, ram) = firmware::size(&image).unwrap();
            // Of the 101 KiB of memory.x, 3 KiB are to spare.
            assert!(ram <= 98 << 10, "{name}: {ram}");
        }
    }
}
