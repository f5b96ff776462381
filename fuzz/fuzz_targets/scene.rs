//! Any text is a scene or an error, never a panic; what is a scene can be explained.

#![no_main]

use libfuzzer_sys::fuzz_target;
use touchdown_run::explain::explain;
use touchdown_scene::Scene;

fuzz_target!(|text: &str| {
    if let Ok(scene) = Scene::parse("fuzz", text) {
        assert!(!explain(&scene).is_empty());
        let _ = scene.warnings();
    }
});
