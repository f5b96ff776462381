//! Whether the image in flash is the one that was built.

use core::ptr::addr_of;

use touchdown_core::checksum::CRC;

/// Of the flash of every board here.
const START: usize = 0x0800_0000;
/// Sections that are checked at most.
const RANGES: usize = 5;

/// CRC-32, then first address and length of each section, bytes: the checksum is of these numbers and then of the
/// sections. `cargo xtask firmware` writes it; an image without it is not whole.
#[used]
#[unsafe(link_section = ".image_check")]
static CHECK: [u32; 1 + 2 * RANGES] = [u32::MAX; 1 + 2 * RANGES];

/// Reads the whole image, which ends before `limit`; 8 instructions a byte.
pub fn is_whole(limit: usize) -> bool {
    // SAFETY: of a static. Volatile, as it is written once the compiler is done.
    let [checksum, numbers @ ..] = unsafe { addr_of!(CHECK).read_volatile() };
    let mut digest = CRC.digest();
    for number in numbers {
        digest.update(&number.to_le_bytes());
    }
    for [start, length] in numbers.as_chunks().0 {
        let (start, length) = (*start as usize, *length as usize);
        let end = start.saturating_add(length);
        if length > 0 && (start < START || end > limit) {
            return false;
        }
        if length > 0 {
            // SAFETY: flash, which nobody writes.
            digest.update(unsafe { core::slice::from_raw_parts(start as *const u8, length) });
        }
    }
    digest.finalize() == checksum
}
