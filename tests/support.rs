//! Rung `support` against closed forms and the reference.
use touchdown_core::model::Change;
use touchdown_tests::supports::Fall;

#[test]
fn explore() {
    for (m, k, c) in [(1.0, 1e7, 500.0), (1.0, 1e6, 500.0), (0.2, 1e8, 2000.0)] {
        for step in [4e-5, 2e-5, 1e-5, 5e-6, 2.5e-6] {
            let mut fall = Fall::new(step).mounted(m, k, c);
            fall.spin = 50.0;
            let time = 0.02;
            let (end, told) = fall.end::<f64>(time);
            let mut impacts = Vec::new();
            let mut r = fall.reference();
            let truth = r.advance(time, &mut |w, h| impacts.push((w, h)));
            let e = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) / 3e-4;
            println!(
                "{k:e} {step:e}: q {:.2e} u {:.2e} v {:.2e} spin {:.2e} told {} truth {}  {:?} ledger {:?}",
                e(end.position, truth.position),
                e(end.ring, truth.ring_position),
                e(end.velocity, truth.velocity),
                end.spin - truth.spin,
                told.len(),
                impacts.len(),
                told.iter()
                    .filter(|t| t.1 == Change::ContactStarts)
                    .collect::<Vec<_>>(),
                end.ledger.total()
            );
            if step == 2.5e-6 {
                for (i, t) in told.iter().enumerate().take(14) {
                    println!("  {t:?}  | {:?}", impacts.get(i));
                }
            }
        }
    }
}
