//! What the tests share: reference cases and their tolerances, and the counts of the emulated target.

pub mod accuracy_runs;
pub mod binary;
pub mod cases;
pub mod choice_runs;
pub mod close;
#[cfg(unix)]
pub mod controller;
pub mod counting;
pub mod drops;
pub mod episode;
pub mod even_rows;
pub mod fall_runs;
pub mod family;
#[cfg(unix)]
pub mod file_options;
pub mod growth;
pub mod guard_runs;
pub mod led_rounds;
pub mod machine_runs;
pub mod minimal_scene;
pub mod moment;
pub mod monitor_run;
pub mod mounted;
pub mod oversampled;
pub mod oversampling_runs;
pub mod plant;
pub mod record;
pub mod rig;
pub mod ring_scenes;
pub mod rotors;
pub mod sweep_runs;
pub mod told_machine;
pub mod touch_runs;
