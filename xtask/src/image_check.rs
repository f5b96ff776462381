//! Writes into an image what it checks itself by at power-on: `firmware/src/board/silicon/image.rs`.

use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};
use crc::{CRC_32_ISO_HDLC, Crc};
use object::elf::{PT_LOAD, SHF_ALLOC};
use object::read::elf::{ElfFile32, ProgramHeader};
use object::{LittleEndian, Object, ObjectSection, SectionFlags};

use crate::files;

/// Where the image keeps it.
const SECTION: &str = ".image_check";
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Writes it, where the image has a place for it.
pub fn write(image: &Path) -> anyhow::Result<()> {
    let mut elf = files::bytes(image)?;
    let file = ElfFile32::<LittleEndian>::parse(&*elf)?;
    let Some(section) = file.section_by_name(SECTION) else {
        return Ok(());
    };
    let (at, size) = section.file_range().context("the check has no bytes")?;
    let (mut numbers, mut contents) = (vec![], vec![]);
    let others = file.sections().filter(|it| it.name() != Ok(SECTION));
    for section in others.filter(is_loaded) {
        let held = section.file_range().filter(|&(_, size)| size > 0);
        let Some((offset, size)) = held else { continue };
        let start = programmed_at(&file, offset)?;
        numbers.extend([start, u32::try_from(size)?].map(u32::to_le_bytes).concat());
        contents.extend(section.data()?);
    }
    let room = usize::try_from(size)? - 4;
    ensure!(numbers.len() <= room, "it has no room for all sections");
    numbers.resize(room, 0);
    let checksum = CRC.checksum(&[&numbers[..], &contents].concat());
    let check = [&checksum.to_le_bytes()[..], &numbers].concat();
    let at = usize::try_from(at)?;
    elf[at..at + check.len()].copy_from_slice(&check);
    fs::write(image, elf).with_context(|| format!("cannot write {}", image.display()))
}

/// Whether it has a place in the chip's memory.
pub fn is_loaded<'a>(section: &impl ObjectSection<'a>) -> bool {
    let allocated = u64::from(SHF_ALLOC);
    matches!(section.flags(), SectionFlags::Elf { sh_flags } if sh_flags & allocated != 0)
}

/// Address in flash of what the file has at `offset`.
fn programmed_at(file: &ElfFile32<'_, LittleEndian>, offset: u64) -> anyhow::Result<u32> {
    let (endian, offset) = (file.endian(), u32::try_from(offset)?);
    let segments = file.elf_program_headers().iter();
    let mut loaded = segments.filter(|it| it.p_type(endian) == PT_LOAD);
    let at = loaded.find_map(|it| {
        let into = offset.checked_sub(it.p_offset(endian))?;
        (into < it.p_filesz(endian)).then(|| it.p_paddr(endian) + into)
    });
    at.context("a section is in no segment")
}
