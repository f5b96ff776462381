//! `cargo xtask`: set-up, firmware build, counts of instructions, budget, tests and what they find.

mod budget;
mod faults;
mod figures;
mod files;
mod firmware;
mod flash;
mod golden;
mod house;
mod image_check;
mod machine;
mod setup;
mod tally;
mod test;
mod toolchain;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread;

use clap::{Parser, Subcommand};

/// What cargo alone cannot do.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Install what the firmware and its emulator need, where it is missing
    Setup {
        /// Do not ask
        #[arg(long)]
        yes: bool,
    },
    /// Build the images, for silicon and for the emulator
    Firmware {
        /// That one alone
        #[arg(value_name = "IMAGE")]
        only: Option<String>,
    },
    /// Build the images, count the model's instructions in the emulator, write the tables
    Instructions,
    /// Measure what the firmware takes of the chip; fails above the limits of firmware/budget.toml, and where
    /// firmware/measured.json is not what it measures
    Budget {
        /// Write the figures to this file
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Keep the figures in firmware/measured.json, which the documents follow (`cargo xtask figures`)
        #[arg(long)]
        keep: bool,
        /// In place of all that: search so many streams for the most cycles, and keep the worst in firmware/corpus.toml
        #[arg(long, value_name = "N", conflicts_with_all = ["json", "keep"])]
        search: Option<usize>,
        /// The search's seed
        #[arg(long, default_value_t = 1, requires = "search")]
        seed: u64,
    },
    /// Write the measured tables of README.md and docs/ from what was measured
    #[command(after_help = figures::HELP)]
    Figures {
        /// Write nothing; fail where a table is not what was measured, or says not where its figures come from
        #[arg(long)]
        check: bool,
        /// The program whose output is taken, in place of that of the tests, which is built
        #[arg(long, value_name = "FILE")]
        program: Option<PathBuf>,
    },
    /// Measure size, layers, structure and names of the crates; fails above the limits of house.toml
    House {
        /// Also measure how long a build takes after one changed line; minutes the first time
        #[arg(long)]
        rebuild: bool,
    },
    /// Check that the image fits the chip, then program and start it by probe-rs
    Flash {
        /// Image, in place of the one for silicon that `cargo xtask firmware` builds
        #[arg(long, value_name = "FILE")]
        image: Option<PathBuf>,
        /// Name of the chip, as probe-rs has it
        #[arg(long, default_value = "STM32F405RGTx")]
        chip: String,
        /// Check only: no probe is needed
        #[arg(long)]
        dry_run: bool,
    },
    /// Write anew what the golden tests hold; `git diff` shows the change
    Golden {
        /// Make the recorded streams anew as well
        #[arg(long)]
        streams: bool,
    },
    /// Plant faults in a copy of the sources, and run the tests that should find them
    Faults {
        /// Those alone whose area and name, as printed, contain this
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// Set up what is missing, build the images, run every test, and try some planted faults
    Test {
        /// Do not ask
        #[arg(long)]
        yes: bool,
    },
}

/// Builds both at once: linking an image keeps one core busy.
fn images_and_tests() -> anyhow::Result<()> {
    thread::scope(|scope| {
        let tests = scope.spawn(test::build);
        // These first: the others take their names.
        let images = firmware::build_planted().and_then(|()| firmware::build(None));
        images.and(tests.join().expect("it does not panic"))
    })
}

fn main() -> ExitCode {
    let done = match Arguments::parse().task {
        Task::Setup { yes } => setup::run(yes),
        Task::Firmware { only } => firmware::build(only.as_deref()),
        Task::Instructions => firmware::build(None).and_then(|()| golden::instructions()),
        Task::Budget {
            json,
            keep,
            search,
            seed,
        } => match search {
            Some(count) => budget::search::run(count, seed),
            None => budget::run(json.as_deref(), keep),
        },
        Task::Figures { check, program } => figures::run(check, program),
        Task::House { rebuild } => house::run(rebuild),
        Task::Flash {
            image,
            chip,
            dry_run,
        } => flash::run(image, &chip, dry_run),
        Task::Golden { streams } => golden::run(streams),
        Task::Faults { only } => faults::run(only.as_deref()),
        Task::Test { yes } => setup::run(yes)
            .and_then(|()| images_and_tests())
            .and_then(|()| test::run())
            .and_then(|()| faults::sample()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("this package is a folder of the workspace")
}
