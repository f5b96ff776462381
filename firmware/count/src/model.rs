//! What the functions below the model and its drops take.

use touchdown_firmware::board::qemu::Counter;
use touchdown_rotor::real::{Micro32, Poly32, Poly64};
use touchdown_rotor::{Precision, Rigid};

use crate::drop::{Run, STEPS, WHOLE, config};
use crate::table::{Name, Table};
use crate::{functions, models};

/// Counts everything and exits the emulator.
pub fn main() -> ! {
    let counter = Counter::take();
    let mut table = Table::create(c"counts.csv");
    table.line(format_args!("compiler,{}", env!("COMPILER")));
    functions::count(&counter, &mut table);
    drops(&counter, &mut table);
    semihosting::process::exit(0)
}

fn drops(counter: &Counter, table: &mut Table) {
    let name = |precision, math| Name { precision, math };
    of_number::<f32>(counter, table, name("f32", "libm"));
    of_number::<Poly32>(counter, table, name("f32", "polynomial"));
    of_number::<Micro32>(counter, table, name("f32", "micromath"));
    of_number::<f64>(counter, table, name("f64", "libm"));
    of_number::<Poly64>(counter, table, name("f64", "polynomial"));
}

/// Every model in one kind of number.
fn of_number<R: Precision>(counter: &Counter, table: &mut Table, name: Name) {
    for step in STEPS {
        let run = Run {
            counter,
            name,
            step,
            duration: WHOLE,
        };
        let rigid = Rigid::try_new(&config(step)).expect("a valid configuration");
        run.of_model::<R, _>(&rigid.rounded(), rigid.scales())
            .write(table, "rigid", "launch", &run);
    }
    models::count::<R>(counter, table, name);
}
