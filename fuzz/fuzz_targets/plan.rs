//! Any text is a plan of a sweep or an error; of a plan its size is known.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use touchdown_scene::Scene;
use touchdown_sweep::Plan;

static RIG: LazyLock<String> = LazyLock::new(|| Scene::text("rig").expect("built-in").into_owned());

fuzz_target!(|text: &str| {
    match Plan::of_texts("fuzz", text, &RIG) {
        Ok(plan) => assert!(plan.size() >= plan.points()),
        Err(error) => assert!(error.to_string().starts_with("fuzz")),
    }
});
