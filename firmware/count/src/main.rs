#![no_std]
#![no_main]
//! How many instructions the models and the functions below them take on the target: an image for the emulator that writes
//! a table of counts to the file `counts.csv` of the desktop, by semihosting.
//!
//! One count a line; the desktop makes means of them (`tests/claims/chip/instructions.rs`). "Worst" is the worst
//! that was met. The functions' arguments and results are there as well, as the bits of an f64.

mod drop;
mod functions;
mod models;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use defmt_semihosting as _;
use panic_probe as _;
use semihosting::process;
use touchdown_counter::{Counter, Table};
use touchdown_rotor::real::{Micro32, Poly32};
use touchdown_rotor::{Precision, Rigid};

use drop::{STEPS, WHOLE, config};

/// Who counts, and the kind of number that is counted: its format and whose functions, as a scene names them.
struct CountingRun {
    counter: Counter,
    table: Table,
    number: &'static str,
}

#[entry]
fn main() -> ! {
    let mut run = CountingRun {
        counter: Counter::take(),
        table: Table::create(c"counts.csv"),
        number: "",
    };
    run.of_number::<f32>("f32,libm");
    run.of_number::<Poly32>("f32,polynomial");
    run.of_number::<Micro32>("f32,micromath");
    run.of_number::<f64>("f64,libm");
    run.in_rings::<f32>("f32,libm");
    run.in_rings::<Poly32>("f32,polynomial");
    run.in_rings::<f64>("f64,libm");
    run.own_sqrt("f32,micromath");
    process::exit(0)
}

impl CountingRun {
    /// The functions, and every model in the plane, in one kind of number.
    fn of_number<R: Precision>(&mut self, number: &'static str) {
        self.number = number;
        self.functions::<R>();
        for step in STEPS {
            let rigid = Rigid::try_new(&config(step)).expect("a valid configuration");
            let (model, scales) = (rigid.rounded(), rigid.scales());
            self.drop::<R, _>(&model, scales, "rigid,launch", step, WHOLE);
        }
        self.in_plane::<R>();
    }
}

// The runtime asks for an unsafe function; there is nothing unsafe in it.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    process::abort()
}
