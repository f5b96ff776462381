//! Any bytes are a dump of the drop log, whole or damaged; what is found in it can be shown and exported.

#![no_main]

use libfuzzer_sys::fuzz_target;
use touchdown_base::paint::Paint;
use touchdown_core::checksum::CRC;
use touchdown_files::drop_log::{Dump, comtrade, is_sound, list, show, stream};

/// Bytes of the lifetime counters, of one record of them, and of a block.
const HEAD: usize = 8192;
const RECORD: usize = 64;
const BLOCK: usize = 256;

/// Gives every record of `size` bytes its checksum.
fn seal(bytes: &mut [u8], size: usize) {
    for record in bytes.chunks_exact_mut(size) {
        let (body, end) = record.split_at_mut(size - 4);
        end.copy_from_slice(&CRC.checksum(body).to_le_bytes());
    }
}

fn look(bytes: &[u8]) {
    let dump = Dump::of(bytes);
    let _ = is_sound(&dump);
    let paint = Paint::PLAIN;
    assert!(!list(&dump, paint).is_empty());
    for episode in &dump.episodes {
        assert!(!show(episode, paint).is_empty());
        let _ = comtrade(episode);
        let _ = stream(episode, Vec::new());
    }
}

fuzz_target!(|bytes: &[u8]| {
    look(bytes);
    // Past the checksums: pages of an episode, and behind counters.
    let mut pages = bytes.to_vec();
    seal(&mut pages, BLOCK);
    look(&pages);
    let mut head = bytes[..bytes.len().min(HEAD)].to_vec();
    seal(&mut head, RECORD);
    head.resize(HEAD, 0xff);
    look(&[head, pages].concat());
});
