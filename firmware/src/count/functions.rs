//! The functions of each kind of number, over fixed sets of arguments.

use core::f64::consts::{FRAC_PI_4, PI, TAU};
use core::hint::black_box;

use touchdown_core::real::{Micro32, Poly32, Poly64, Real};

use super::{Counter, Name, Table, Tally};

/// Arguments in a set.
const ARGUMENTS: usize = 61;

pub(super) fn count(counter: &Counter, table: &mut Table) {
    let name = |precision, math| Name { precision, math };
    of_number::<f32>(counter, table, name("f32", "libm"));
    of_number::<Poly32>(counter, table, name("f32", "polynomial"));
    of_number::<Micro32>(counter, table, name("f32", "micromath"));
    of_number::<f64>(counter, table, name("f64", "libm"));
    of_number::<Poly64>(counter, table, name("f64", "polynomial"));
    // For comparison only: no number uses it.
    let name = name("f32", "micromath");
    of_function(counter, table, name, "own sqrt", sizes(), |x: f32| {
        micromath::F32(x).sqrt().0
    });
}

fn of_number<R: Real>(counter: &Counter, table: &mut Table, name: Name) {
    // What handing over argument and result takes is part of every row.
    of_function(counter, table, name, "identity", sizes(), |x: R| x);
    of_function(counter, table, name, "sqrt", sizes(), R::sqrt);
    of_function(counter, table, name, "ln", sizes(), R::ln);
    for (function, to) in [
        ("sin_cos to 1/8 turn", FRAC_PI_4),
        ("sin_cos to 1 turn", TAU),
        ("sin_cos to 10 000 rad", 1e4),
    ] {
        of_function(counter, table, name, function, angles(to), R::sin_cos);
    }
    let directions = angles(PI).map(R::sin_cos);
    of_function(counter, table, name, "atan2", directions, |(y, x)| {
        y.atan2(x)
    });
}

/// From 1e-6 to 1e6 by equal ratios.
fn sizes<R: Real>() -> [R; ARGUMENTS] {
    const RATIO: f64 = 1.584_893_192_461_113_5;
    let mut size = 1e-6;
    core::array::from_fn(|_| {
        let this = R::lit(size);
        size *= RATIO;
        this
    })
}

/// From -`to` to `to` by equal steps.
fn angles<R: Real>(to: f64) -> [R; ARGUMENTS] {
    core::array::from_fn(|k| R::lit(to * (2.0 * k as f64 / (ARGUMENTS - 1) as f64 - 1.0)))
}

fn of_function<A: Copy, T>(
    counter: &Counter,
    table: &mut Table,
    Name { precision, math }: Name,
    function: &str,
    arguments: [A; ARGUMENTS],
    call: impl Fn(A) -> T,
) {
    let mut tally = Tally::default();
    // Ready before the first count: what makes the arguments could be moved into it otherwise.
    for argument in black_box(arguments) {
        let (_, instructions) = counter.count(|| call(black_box(argument)));
        tally.add(instructions);
    }
    let Tally { calls, sum, worst } = tally;
    table.line(format_args!(
        "function,{precision},{math},{function},{calls},{sum},{worst}"
    ));
}
