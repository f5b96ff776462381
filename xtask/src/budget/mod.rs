//! What the firmware takes of the chip, against its limits: `firmware/budget.toml`.

mod calls;
mod cycles;
mod image;
mod judge;
mod kept;
mod modules;
#[cfg(test)]
mod planted;
mod queue;
pub mod search;
mod stream;
mod ticks;

use std::path::Path;

use anyhow::ensure;
use serde::{Deserialize, Serialize};

use crate::firmware::{self, STACK_SIZES};
use crate::workspace;

use self::cycles::Modelled;
pub use self::kept::FILE as MEASURED;

/// Measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Of the tick.
    parts: Vec<Part>,
    /// All of it.
    tick: Instructions,
    /// Of the image for silicon.
    flash_bytes: u64,
    /// Likewise, without the stack.
    ram_bytes: u64,
    /// Deepest chain of calls, an interrupt on top.
    stack_bytes: u64,
    /// No panic can be reached from the tick.
    panic_free: bool,
    /// Functions for f64 that can be reached from the tick.
    soft_float_symbols: u64,
    /// Code of the image for silicon, the largest module first.
    flash_by_module: Vec<Module>,
    /// That built the images.
    compiler: String,
    /// Of the tick; modelled, not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cycles: Option<Modelled>,
}

/// Code by where it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Module {
    pub module: String,
    pub bytes: u64,
}

/// Of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Instructions {
    /// Mean while the rotor floats on its orbit.
    instructions_typical: u64,
    /// Greatest that was met in any stream.
    instructions_worst: u64,
}

/// A part of the tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    part: String,
    #[serde(flatten)]
    instructions: Instructions,
}

/// Builds, counts and looks; writes `json` if given. Fails above a limit. The figures kept for the documents are
/// written anew if `keep`, else they have to be these.
pub fn run(json: Option<&Path>, keep: bool) -> anyhow::Result<()> {
    println!("Budget: building");
    let images = firmware::images();
    firmware::build_one("touchdown-count-tick", &[])?;
    firmware::build_one("touchdown-tick", STACK_SIZES)?;
    firmware::build_one("touchdown-firmware", STACK_SIZES)?;

    let (table, cycles) = cycles::count(&images.join("touchdown-count-tick"), &stream::read()?)?;
    print!("{}", table.by_scene());
    print!("{}", cycles::table(&cycles));
    let tick = image::look(&images.join("touchdown-tick"))?;
    for name in tick.panics.iter().chain(&tick.soft_float) {
        println!("  reachable from the tick: {name}");
    }
    let silicon = images.join("touchdown-firmware");
    let (flash_bytes, ram_bytes) = firmware::size(&silicon)?;
    let modules = modules::modules(&silicon)?;
    let known: u64 = modules.iter().map(|it| it.bytes).sum();
    println!("  flash by module:");
    for Module { module, bytes } in &modules {
        println!("    {bytes:7}  {module}");
    }
    let rest = flash_bytes.saturating_sub(known);
    println!("    {rest:7}  constants, and code of no line");
    let stack = image::stack(&silicon)?;
    println!("  stack: {stack}");

    let budget = Budget {
        parts: table.parts(),
        tick: table.tick()?,
        flash_bytes,
        ram_bytes,
        stack_bytes: stack.bytes(),
        panic_free: tick.panics.is_empty(),
        soft_float_symbols: tick.soft_float.len() as u64,
        flash_by_module: modules,
        compiler: table.compiler,
        cycles: Some(cycles),
    };
    if let Some(file) = json {
        kept::save(&budget, file)?;
    }
    if keep {
        println!("  kept in {MEASURED}; `cargo xtask figures` writes the documents");
        kept::save(&budget, &workspace().join(MEASURED))?;
    }
    let limits = judge::limits()?;
    print!("{}", judge::table(&budget, &limits));
    let breaches = judge::breaches(&budget, &limits);
    let lines = breaches.join("\n  ");
    ensure!(breaches.is_empty(), "over budget:\n  {lines}");
    kept::require(&kept::differences(&kept::read()?, &budget)?)
}
