//! The functions of each kind of number on the emulated target: the same bits as on the desktop.

use touchdown_rotor::real::{Micro32, Poly32, Real};
use touchdown_tests::counting::COUNTS;

/// Bits of the results as f64.
fn desktop<R: Real>(function: &str, arguments: [f64; 2]) -> [u64; 2] {
    let [a, b] = arguments.map(R::lit);
    let (first, second) = match function.split(' ').next() {
        Some("identity") => (a, R::ZERO),
        Some("sqrt") => (a.sqrt(), R::ZERO),
        Some("ln") => (a.ln(), R::ZERO),
        Some("sin_cos") => a.sin_cos(),
        Some("atan2") => (a.atan2(b), R::ZERO),
        _ => panic!("unknown function {function}"),
    };
    [first, second].map(|x| x.to_f64().to_bits())
}

#[test]
fn every_function_gives_the_same_bits() {
    let mut compared = 0;
    for line in COUNTS.lines() {
        let fields: Vec<&str> = line.split(',').collect();
        let ["value", precision, math, function, values @ ..] = &fields[..] else {
            continue;
        };
        if *function == "own sqrt" {
            continue;
        }
        let values: Vec<_> = values
            .iter()
            .map(|bits| u64::from_str_radix(bits, 16).expect(line))
            .collect();
        let [a, b, target @ ..] = &values[..] else {
            panic!("{line}");
        };
        let arguments = [*a, *b].map(f64::from_bits);
        let desktop = match (*precision, *math) {
            ("f32", "libm") => desktop::<f32>(function, arguments),
            ("f32", "polynomial") => desktop::<Poly32>(function, arguments),
            ("f32", "micromath") => desktop::<Micro32>(function, arguments),
            ("f64", "libm") => desktop::<f64>(function, arguments),
            _ => panic!("{line}"),
        };
        assert_eq!(target, desktop, "{line}");
        compared += 1;
    }
    assert!(compared >= 4 * 7 * 61, "{compared}");
}
