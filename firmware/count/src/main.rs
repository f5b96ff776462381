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
use touchdown_counter::{Counter, Name, Table};
use touchdown_rotor::real::{Micro32, Poly32};
use touchdown_rotor::{Precision, Rigid};

use drop::{Run, STEPS, WHOLE, config};

#[entry]
fn main() -> ! {
    let counter = Counter::take();
    let mut table = Table::create(c"counts.csv");
    let (of, to) = (&counter, &mut table);
    let name = |precision, math| Name { precision, math };
    of_number::<f32>(of, to, name("f32", "libm"));
    of_number::<Poly32>(of, to, name("f32", "polynomial"));
    of_number::<Micro32>(of, to, name("f32", "micromath"));
    of_number::<f64>(of, to, name("f64", "libm"));
    models::in_rings::<f32>(of, to, name("f32", "libm"));
    models::in_rings::<Poly32>(of, to, name("f32", "polynomial"));
    models::in_rings::<f64>(of, to, name("f64", "libm"));
    functions::own_sqrt(of, to);
    process::exit(0)
}

/// The functions, and every model in the plane, in one kind of number.
fn of_number<R: Precision>(counter: &Counter, table: &mut Table, name: Name) {
    functions::of_number::<R>(counter, table, name);
    for step in STEPS {
        let run = Run {
            counter,
            name,
            step,
            duration: WHOLE,
        };
        let rigid = Rigid::try_new(&config(step)).expect("a valid configuration");
        run.of_model::<R, _>(&rigid.rounded())
            .write(table, "rigid", "launch", &run);
    }
    models::in_plane::<R>(counter, table, name);
}

// The runtime asks for an unsafe function; there is nothing unsafe in it.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    process::abort()
}
