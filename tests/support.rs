//! Rung `support` against closed forms and the reference.
use touchdown_core::model::Change;
use touchdown_tests::supports::Fall;

#[test]
fn whirl() {
    let (m, k, c, mu) = (1.0, 1e6, 600.0, 0.15);
    for step in [2e-4, 1e-4, 5e-5, 2e-5, 1e-5] {
        let mut fall = Fall::new(step).mounted(m, k, c).at_bottom(0.05);
        fall.rigid.gravity = 0.0;
        fall.rigid.polar_inertia *= 1e6;
        fall.spin = -3000.0;
        let (mut n, mut lo, mut hi, mut t0, mut a0) = (0, f64::MAX, 0.0f64, 0.0, 0.0);
        let (mut t1, mut a1) = (0.0, 0.0);
        let mut swing = 0.0f64;
        let told = fall.follow::<f64>(3.0, |x| {
            if x.time > 2.0 {
                n += 1;
                lo = lo.min(x.load.normal);
                hi = hi.max(x.load.normal);
                if t0 == 0.0 {
                    (t0, a0) = (x.time, x.turns);
                }
                (t1, a1) = (x.time, x.turns);
                let w: f64 = (0..2)
                    .map(|i| x.displacement[i] / 3e-4 * (x.velocity[i] - x.ring_velocity[i]))
                    .sum();
                swing = swing.max(w.abs());
            }
        });
        println!(
            "{step:e} freq {} load {lo} {hi} told {told:?} swing {swing:e}",
            (a1 - a0) / (t1 - t0),
        );
    }
    // closed form
    let f = |w: f64| {
        let a = (c * w).atan2(k - 6.0 * w * w) - (c * w).atan2(k - m * w * w);
        a - f64::atan(mu)
    };
    let (mut a, mut b) = (1.0, (k / 6.0f64).sqrt());
    for _ in 0..100 {
        let x = 0.5 * (a + b);
        if f(x) < 0.0 { a = x } else { b = x }
    }
    let w = a;
    let (d, e) = (k - m * w * w, c * w);
    // (1 - i mu) (1/(m w2) - 1/D)
    let (x, y) = (
        1.0 / (5.0 * w * w) - d / (d * d + e * e),
        e / (d * d + e * e),
    );
    let n = 3e-4 / (x + mu * y);
    println!("closed {} Hz N {n}", w / std::f64::consts::TAU);
}

#[test]
fn explore() {
    for (m, k, c) in [(1.0, 1e7, 500.0)] {
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
        }
    }
}

fn summary(fall: &Fall, time: f64) {
    let first = std::cell::Cell::new(None);
    let (mut worst, mut gap, mut up, mut over, mut last) = (0.0f64, 0.0f64, 0.0f64, 0.0f64, None);
    let mut bad = false;
    let told = fall.follow::<f64>(time, |x| {
        let e0 = first.get().unwrap_or(x.ledger.total());
        first.set(Some(e0));
        let size = x
            .ledger
            .motion
            .max(x.ledger.spin)
            .max(x.ledger.height.abs())
            + e0.abs()
            + x.ledger.heat.abs();
        worst = worst.max((x.ledger.total() - e0).abs() / size);
        gap = gap.max(x.displacement[0].hypot(x.displacement[1]) / fall.rigid.clearance - 1.0);
        if x.touch != touchdown_core::model::Touch::None {
            gap = gap.max(1.0 - x.displacement[0].hypot(x.displacement[1]) / fall.rigid.clearance);
        }
        up = up.max((x.ledger.stored() - e0) / size);
        over = over.max(
            fall.mount
                .and_then(|m| m.travel)
                .map_or(0.0, |t| x.ring[0].hypot(x.ring[1]) / t - 1.0),
        );
        bad |= !(x.position[0].is_finite()
            && x.velocity[1].is_finite()
            && x.spin.is_finite()
            && x.ring_velocity[0].is_finite());
        last = Some(*x);
    });
    let x = last.unwrap();
    if !bad
        && worst < 1e-12
        && gap < 1e-9
        && up < 1e-9
        && over < 1e-9
        && x.shortened == 0
        && [x.ledger.lost, x.ledger.damped, x.ledger.stop]
            .iter()
            .all(|d| *d > -1e-6)
    {
        return;
    }
    println!(
        "  m_s {:e} k {:e} c {:e} J {:e} step {:e}: bad {bad} ledger {worst:.1e} gap {gap:.1e} up {up:.1e} over {over:.1e} short {} told {} end {:?} {:?} u {:?} stopped {} lost {:.1e} damped {:.1e} stop {:.1e} heat {:.1e} drag {:.1e} peak {:.1e}",
        fall.mount.map_or(0.0, |m| m.mass),
        fall.mount.map_or(0.0, |m| m.stiffness),
        fall.mount.map_or(0.0, |m| m.damping),
        fall.race.map_or(0.0, |r| r.inertia),
        fall.rigid.step,
        x.shortened,
        told.len(),
        x.touch,
        x.displacement,
        x.ring,
        x.stopped,
        x.ledger.lost,
        x.ledger.damped,
        x.ledger.stop,
        x.ledger.heat,
        x.ledger.drag,
        x.load.held_peak
    );
}

#[test]
fn extremes() {
    for k in [1e2, 1e4, 1e6, 1e8, 1e10, 1e12] {
        for m in [1e-6, 1e-2, 1.0, 1e3] {
            for c in [0.0, 500.0] {
                for step in [1e-6, 1e-5, 1e-4, 1e-3] {
                    let mut fall = Fall::new(step).mounted(m, k, c);
                    fall.spin = 300.0;
                    summary(&fall, 0.05);
                }
            }
        }
    }
}

#[test]
fn extremes_race() {
    for j in [1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e6] {
        for drag in [(0.0, 0.0), (1e-2, 1e-5), (10.0, 1.0)] {
            for step in [1e-6, 1e-4, 1e-3] {
                let mut fall = Fall::new(step)
                    .mounted(1.0, 1e7, 500.0)
                    .turning(j)
                    .dragged(drag.0, drag.1);
                fall.spin = 300.0;
                summary(&fall, 0.05);
            }
        }
    }
}

#[test]
fn stop() {
    for k in [1e2, 1e4, 1e6, 1e8] {
        for m in [1e-6, 1e-2, 1.0, 1e3] {
            for travel in [1e-7, 1e-5, 1e-4] {
                for step in [1e-6, 1e-4, 1e-3] {
                    let mut fall = Fall::new(step).mounted(m, k, 500.0).stopping(travel);
                    fall.spin = 300.0;
                    summary(&fall, 0.05);
                }
            }
        }
    }
}

#[test]
fn one() {
    let get = |n: &str, d: f64| {
        std::env::var(n)
            .ok()
            .and_then(|x| x.parse().ok())
            .unwrap_or(d)
    };
    let mut fall = Fall::new(get("H", 1e-4))
        .mounted(get("M", 1e-6), get("K", 1e2), get("C", 500.0))
        .stopping(get("L", 1e-7));
    fall.spin = 300.0;
    let mut n = 0;
    let mut last = (0.0, 0.0, 0.0);
    let told = fall.follow::<f64>(0.05, |x| {
        let now = (x.ledger.lost, x.ledger.stop, x.ledger.heat);
        if now.0 - last.0 < -1e-7 || now.1 - last.1 < -1e-7 || now.2 - last.2 < -1e-7 {
            n += 1;
            if n < 5 {
            println!("{:.6} {:?} gap {:.2e} q {:.3e} {:.3e} u {:.3e} {:.3e} |u|/L-1 {:.1e} v {:.2e} {:.2e} du {:.2e} {:.2e} stop {} lost {:.2e} damped {:.2e} stop {:.2e} heat {:.2e} stored {:.3e} load {:.2e} short {} changes {:.2e} {:.2e} {:.2e}",
            x.time, x.touch, x.displacement[0].hypot(x.displacement[1]) / 3e-4 - 1.0, x.displacement[0],x.displacement[1], x.ring[0], x.ring[1], x.ring[0].hypot(x.ring[1]) / 1e-7 - 1.0,  x.velocity[0], x.velocity[1], x.ring_velocity[0], x.ring_velocity[1], x.stopped, x.ledger.lost, x.ledger.damped, x.ledger.stop, x.ledger.heat, x.ledger.stored(), x.load.normal, x.shortened, now.0 - last.0, now.1-last.1, now.2-last.2);
            }
        }
        last = now;
    });
    for t in told.iter().take(10) {
        println!("{t:?}");
    }
}

#[test]
fn stop_reference() {
    for (m, k, travel) in [(1.0, 1e6, 1e-5), (0.1, 1e6, 1e-5), (1e-2, 1e6, 1e-5)] {
        for step in [4e-5, 2e-5, 1e-5, 5e-6, 2.5e-6] {
            let mut fall = Fall::new(step).mounted(m, k, 500.0).stopping(travel);
            fall.spin = 50.0;
            let time = 0.01;
            let (end, told) = fall.end::<f64>(time);
            let mut impacts = 0;
            let mut r = fall.reference();
            let truth = r.advance(time, &mut |w, h| {
                impacts += 1;
                if step == 2.5e-99 && impacts < 30 {
                    if let touchdown_sim::history::Happening::Impact(i) = h {
                        println!(
                            "   {w} {} v {:?} at {:?} normal {} I {}",
                            i.state.time,
                            i.state.velocity,
                            i.state.position,
                            i.normal_speed,
                            i.normal_impulse
                        )
                    } else {
                        println!("   {w} {h:?}");
                    }
                }
            });
            if step == 2.5e-99 {
                for t in told.iter().take(20) {
                    println!("  model {t:?}")
                }
            }
            let e = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) / 3e-4;
            println!(
                "{m:e} {k:e} {step:e}: p {:.2e} u {:.2e} v {:.2e} spin {:.2e} told {} truth {impacts} short {} {:?} {:?}",
                e(end.position, truth.position),
                e(end.ring, truth.ring_position),
                e(end.velocity, truth.velocity),
                end.spin - truth.spin,
                told.len(),
                end.shortened,
                end.ring,
                truth.ring_position
            );
        }
    }
}

#[test]
fn swing() {
    for calm in [0] {
        for h in [1e-3, 1e-4] {
            let mut fall = Fall::new(h).at_bottom(0.05);
            fall.rigid.gravity = 0.0;
            fall.rigid.polar_inertia *= 1e6;
            fall.spin = -3000.0;
            let mut worst = 0.0f64;
            let mut w2 = 0.0f64;
            let (end, _) = fall.end::<f64>(0.03);
            fall.follow::<f64>(0.03, |x| {
                let w: f64 = (0..2)
                    .map(|i| x.displacement[i] / 3e-4 * x.velocity[i])
                    .sum();
                worst = worst.max(w.abs() / x.velocity[0].hypot(x.velocity[1]));
                w2 = w.abs() / x.velocity[0].hypot(x.velocity[1]);
            });
            // v = v0/(1 - mu v0 t/rho0)
            let v = 0.05 / (1.0 - 0.15 * 0.05 * 0.03 / 3e-4);
            println!(
                "{calm} {h:e} v {} true {v} lost {:e} swing {worst:e} {w2:e} turns {} ",
                end.velocity[0].hypot(end.velocity[1]),
                end.ledger.lost / end.ledger.motion,
                end.turns
            );
        }
    }
}
