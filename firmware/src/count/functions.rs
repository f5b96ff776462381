//! The functions of each kind of number, over fixed sets of arguments.

use core::f64::consts::{FRAC_PI_4, PI, TAU};
use core::hint::black_box;

use touchdown_core::real::{Micro32, Poly32, Poly64, Real};

use super::{Counter, Name, Table, Tally};

/// Arguments in a set.
const ARGUMENTS: i32 = 61;

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
    of_function(counter, table, name, "sqrt", sizes(), R::sqrt);
    of_function(counter, table, name, "ln", sizes(), R::ln);
    for (function, to) in [
        ("sin_cos to 1/8 turn", FRAC_PI_4),
        ("sin_cos to 1 turn", TAU),
        ("sin_cos to 10 000 rad", 1e4),
    ] {
        of_function(counter, table, name, function, angles(to), R::sin_cos);
    }
    let directions = angles(PI).map(|angle: R| R::lit(angle.to_f64()).sin_cos());
    of_function(counter, table, name, "atan2", directions, |(y, x)| {
        y.atan2(x)
    });
}

/// From 1e-6 to 1e6 by equal ratios.
fn sizes<R: Real>() -> impl Iterator<Item = R> {
    const RATIO: f64 = 1.584_893_192_461_113_5;
    let next = |x: &f64| Some(x * RATIO);
    core::iter::successors(Some(1e-6), next)
        .take(ARGUMENTS as usize)
        .map(R::lit)
}

/// From -`to` to `to` by equal steps.
fn angles<R: Real>(to: f64) -> impl Iterator<Item = R> {
    (0..ARGUMENTS).map(move |k| R::lit(to * (f64::from(2 * k) / f64::from(ARGUMENTS - 1) - 1.0)))
}

fn of_function<A, T>(
    counter: &Counter,
    table: &mut Table,
    Name { precision, math }: Name,
    function: &str,
    arguments: impl Iterator<Item = A>,
    call: impl Fn(A) -> T,
) {
    let mut tally = Tally::default();
    for argument in arguments {
        let (_, instructions) = counter.count(|| call(black_box(argument)));
        tally.add(instructions);
    }
    let Tally { calls, sum, worst } = tally;
    table.line(format_args!(
        "function,{precision},{math},{function},{calls},{sum},{worst}"
    ));
}
