//! Any bytes are the journal of a sweep or an error, and so are any bytes after a whole header.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;
use touchdown_sim::scene::Scene;
use touchdown_sim::sweep::{Part, Plan, journal_of, journals, run, write};

const PLAN: &str = "scene = 'rig'\ndrops = 2\nseed = 1\n[start]\nwithin = 0.5\n[[parameter]]\nkey = 'retainer.friction'\nvalues = [0.1]\n";
const PART: Part = Part { part: 1, parts: 1 };

/// A folder, and the bytes of a whole journal.
static WHOLE: LazyLock<(TempDir, Vec<u8>)> = LazyLock::new(|| {
    let folder = TempDir::new().expect("a folder");
    let scene = Scene::text("rig").expect("built-in scene");
    let plan = Plan::of_texts("plan", PLAN, &scene).expect("a plan");
    run(&plan, PART, folder.path()).expect("a sweep");
    let bytes = std::fs::read(journal_of(PART, folder.path())).expect("a journal");
    (folder, bytes)
});

fuzz_target!(|bytes: &[u8]| {
    let (folder, whole) = &*WHOLE;
    let path = journal_of(PART, folder.path());
    let kept = bytes
        .first()
        .map_or(0, |it| whole.len() * usize::from(*it) / 255);
    for journal in [
        bytes,
        &[&whole[..kept], bytes.get(1..).unwrap_or(&[])].concat(),
    ] {
        std::fs::write(&path, journal).expect("a journal");
        if let Ok((plan, paths)) = journals(&[folder.path().display().to_string()])
            && plan.size() < 1000
        {
            let _ = write(&plan, &paths, folder.path());
        }
    }
});
