//! Any bytes are a dump of the drop log, whole or damaged; what is found in it can be shown and exported.

#![no_main]

use libfuzzer_sys::fuzz_target;
use touchdown_sim::drop_log::{Dump, comtrade, is_sound, list, show, stream};
use touchdown_sim::paint::Paint;

fuzz_target!(|bytes: &[u8]| {
    let dump = Dump::of(bytes);
    let _ = is_sound(&dump);
    let paint = Paint::for_stdout();
    assert!(!list(&dump, paint).is_empty());
    for episode in &dump.episodes {
        assert!(!show(episode, paint).is_empty());
        let _ = comtrade(episode);
        let _ = stream(episode, Vec::new());
    }
});
