//! The functions of each kind of number, over fixed sets of arguments.

use core::f64::consts::{FRAC_PI_4, PI, TAU};
use core::hint::black_box;

use touchdown_rotor::real::Real;

use touchdown_counter::{Counter, Name, Table, Tally};

/// Arguments in a set.
const ARGUMENTS: usize = 61;

/// For comparison only: no number uses it.
pub(super) fn own_sqrt(counter: &Counter, table: &mut Table) {
    let name = Name {
        precision: "f32",
        math: "micromath",
    };
    let own_sqrt = |x: f32| micromath::F32(x).sqrt().0;
    let one = |x: f32, y| [x, 0.0, y, 0.0];
    of_function(counter, table, name, "own sqrt", sizes(), own_sqrt, one);
}

/// All functions of one kind of number.
pub(super) fn of_number<R: Real>(counter: &Counter, table: &mut Table, name: Name) {
    let one = |x: R, y: R| [x, R::ZERO, y, R::ZERO];
    // What handing over argument and result takes is part of every row.
    of_function(counter, table, name, "identity", sizes(), |x| x, one);
    of_function(counter, table, name, "sqrt", sizes(), R::sqrt, one);
    of_function(counter, table, name, "ln", sizes(), R::ln, one);
    for (function, to) in [
        ("sin_cos to 1/8 turn", FRAC_PI_4),
        ("sin_cos to 1 turn", TAU),
        ("sin_cos to 10 000 rad", 1e4),
    ] {
        let two = |x: R, (sin, cos)| [x, R::ZERO, sin, cos];
        of_function(counter, table, name, function, angles(to), R::sin_cos, two);
    }
    let directions = angles(PI).map(R::sin_cos);
    let atan2 = |(y, x): (R, R)| y.atan2(x);
    let of_two = |(y, x), angle| [y, x, angle, R::ZERO];
    of_function(counter, table, name, "atan2", directions, atan2, of_two);
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

/// Counts `call`, and writes what it gives: its arguments and results, as `show` puts them.
fn of_function<A: Copy, T: Copy, R: Real>(
    counter: &Counter,
    table: &mut Table,
    Name { precision, math }: Name,
    function: &str,
    arguments: [A; ARGUMENTS],
    call: impl Fn(A) -> T,
    show: impl Fn(A, T) -> [R; 4],
) {
    let mut tally = Tally::default();
    // All is ready before the first count and kept until after the last: what makes the arguments
    // and shows the results could be moved between otherwise.
    let arguments = black_box(arguments);
    let results = arguments.map(|argument| {
        let (result, instructions) = counter.count(|| called(&call, black_box(argument)));
        tally.add(instructions);
        result
    });
    for (argument, result) in core::iter::zip(black_box(arguments), black_box(results)) {
        let [a, b, c, d] = show(argument, result).map(|x| x.to_f64().to_bits());
        table.line(format_args!(
            "value,{precision},{math},{function},{a:x},{b:x},{c:x},{d:x}"
        ));
    }
    let Tally { calls, sum, worst } = tally;
    table.line(format_args!(
        "function,{precision},{math},{function},{calls},{sum},{worst}"
    ));
}

/// A call of its own: inlined, some of the function would move out of the loop, and out of the count.
#[inline(never)]
fn called<A, T>(call: &impl Fn(A) -> T, argument: A) -> T {
    call(argument)
}
