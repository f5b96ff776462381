//! The functions of each kind of number, over fixed sets of arguments.

use core::f64::consts::{FRAC_PI_4, PI, TAU};
use core::hint::black_box;

use touchdown_rotor::real::Real;

use super::CountingRun;
use touchdown_counter::Tally;

/// Arguments in a set.
const ARGUMENTS: usize = 61;

impl CountingRun {
    /// For comparison only: no number uses it.
    pub(super) fn own_sqrt(&mut self, number: &'static str) {
        self.number = number;
        let own_sqrt = |x: f32| micromath::F32(x).sqrt().0;
        self.function("own sqrt", sizes(), own_sqrt, |x, y| [x, 0.0, y, 0.0]);
    }

    /// All functions of one kind of number.
    pub(super) fn functions<R: Real>(&mut self) {
        let one = |x: R, y: R| [x, R::ZERO, y, R::ZERO];
        // What handing over argument and result takes is part of every row.
        self.function("identity", sizes(), |x| x, one);
        self.function("sqrt", sizes(), R::sqrt, one);
        self.function("ln", sizes(), R::ln, one);
        for (name, to) in [
            ("sin_cos to 1/8 turn", FRAC_PI_4),
            ("sin_cos to 1 turn", TAU),
            ("sin_cos to 10 000 rad", 1e4),
        ] {
            let two = |x: R, (sin, cos)| [x, R::ZERO, sin, cos];
            self.function(name, angles(to), R::sin_cos, two);
        }
        let directions = angles(PI).map(R::sin_cos);
        let atan2 = |(y, x): (R, R)| y.atan2(x);
        let of_two = |(y, x), angle| [y, x, angle, R::ZERO];
        self.function("atan2", directions, atan2, of_two);
    }

    /// Counts `call`, and writes what it gives: its arguments and results, as `show` puts them.
    fn function<A: Copy, T: Copy, R: Real>(
        &mut self,
        name: &str,
        arguments: [A; ARGUMENTS],
        call: impl Fn(A) -> T,
        show: impl Fn(A, T) -> [R; 4],
    ) {
        let mut tally = Tally::default();
        // All is ready before the first count and kept until after the last: what makes the arguments
        // and shows the results could be moved between otherwise.
        let arguments = black_box(arguments);
        let results = arguments.map(|argument| {
            let counted = || called(&call, black_box(argument));
            let (result, instructions) = self.counter.count(counted);
            tally.add(instructions);
            result
        });
        let (number, Tally { calls, sum, worst }) = (self.number, tally);
        for (argument, result) in core::iter::zip(black_box(arguments), black_box(results)) {
            let [a, b, c, d] = show(argument, result).map(|x| x.to_f64().to_bits());
            self.table.line(format_args!(
                "value,{number},{name},{a:x},{b:x},{c:x},{d:x}"
            ));
        }
        self.table.line(format_args!(
            "function,{number},{name},{calls},{sum},{worst}"
        ));
    }
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

/// A call of its own: inlined, some of the function would move out of the loop, and out of the count.
#[inline(never)]
fn called<A, T>(call: &impl Fn(A) -> T, argument: A) -> T {
    call(argument)
}
