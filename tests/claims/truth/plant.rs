use touchdown_tests::plant::*;

fn radius(p: [f64; 2]) -> f64 {
    p[0].hypot(p[1])
}
fn run(m: &Machine, phases: &[Phase], rate: f64) -> Vec<Truth> {
    let mut p = Plant::new(m, phases);
    std::iter::from_fn(|| p.next_sample(rate)).collect()
}
fn float(time: f64) -> Phase {
    Phase::Float { time, disturbances: vec![] }
}

#[test]
fn rests_at_the_bottom() {
    for gap in [1e-4, 2.5e-4, 5e-4] {
        let m = Machine { gap, ..Machine::default() };
        for s in run(&m, &[Phase::Rest { time: 1.0 }], 10e3) {
            assert!(s.in_contact && s.beyond && !s.afloat && !s.amb_on && s.contacts == 0 && s.excursions == 0);
            assert!(s.place[0] == 0.0 && radius(s.place) > gap && radius(s.place) < 1.02 * gap);
        }
    }
}

#[test]
fn lies_at_the_friction_angle_when_spinning() {
    for spin in [3000.0, -3000.0] {
        let m = Machine { spin, friction: 0.2, ..Machine::default() };
        let s = *run(&m, &[Phase::Rest { time: 3.0 }], 10e3).last().unwrap();
        // Counter-clockwise spin rubs the bottom to the right, so the rotor climbs to the left.
        let angle = s.place[0].atan2(-s.place[1]);
        println!("spin {spin}: lies at {angle} rad");
        assert!((angle + spin.signum() * 0.2f64.atan()).abs() < 0.01);
    }
}

#[test]
fn lift_ends_afloat() {
    for gap in [1e-4, 5e-4] {
        for lift in [0.05, 0.1, 0.4] {
            for orbit in [0.0, 0.05] {
                for spin in [0.0, 300.0, 3000.0] {
                    let m = Machine { gap, orbit: orbit * gap, spin, friction: 0.1, ..Machine::default() };
                    let all = run(&m, &[Phase::Rest { time: 0.1 }, Phase::Lift { time: lift }, float(0.5)], 10e3);
                    let up = all.iter().position(|s| s.afloat).expect("afloat");
                    assert!(all[up].time < 0.1 + lift + 0.03, "late {}", all[up].time);
                    assert!(all[up..].iter().all(|s| s.afloat && !s.in_contact && !s.beyond));
                    assert!(radius(all.last().unwrap().place) < orbit * gap * 1.01 + 1e-8);
                }
            }
        }
    }
}

#[test]
fn fall_time() {
    for gap in [1e-4, 2.5e-4, 5e-4] {
        let m = Machine { gap, ..Machine::default() };
        let all = run(&m, &[Phase::Drop { time: 0.05 }], 100e3);
        let t = all.iter().find(|s| s.in_contact).unwrap().time;
        let want = (2.0 * gap / GRAVITY).sqrt();
        println!("gap {gap}: fall {t} s, want {want}, off {:.3} %", (t / want - 1.0) * 100.0);
        assert!((t / want - 1.0).abs() < 0.02);
    }
}

#[test]
fn restitution_and_depth() {
    let mut worst: f64 = 0.0;
    for gap in [1e-4, 2.5e-4, 5e-4] {
        for e in [0.3, 0.5, 0.8] {
            for v in [0.03, 0.044, 0.07, 0.099] {
                // Choose the height of fall for the speed of impact.
                let y = v * v / (2.0 * GRAVITY) - gap;
                if y > gap {
                    continue;
                }
                let m = Machine { gap, restitution: e, float_place: [0.0, y], ..Machine::default() };
                let all = run(&m, &[Phase::Drop { time: 0.1 }], 100e3);
                let hit = all.iter().position(|s| s.in_contact).unwrap();
                let fast = all[hit - 1].velocity[1];
                let away = all[hit..].iter().position(|s| !s.in_contact).unwrap() + hit;
                let got = -all[away].velocity[1] / fast;
                let depth = all[hit..away].iter().map(|s| radius(s.place)).fold(0.0, f64::max) / gap - 1.0;
                worst = worst.max((got / e - 1.0).abs());
                println!(
                    "gap {gap} v {v} ({fast:.4}) e {e}: {got:.4}, depth {:.2} % of gap, about {} us",
                    depth * 100.0,
                    (away - hit) * 10
                );
                assert!((got / e - 1.0).abs() < 0.10 && depth < 0.02);
            }
        }
    }
    println!("worst restitution error {:.2} %", worst * 100.0);
}

#[test]
fn energy_does_not_grow() {
    for gap in [1e-4, 5e-4] {
        for x in [0.0, 0.3, 0.7] {
            for mu in [0.0, 0.05, 0.3] {
                let m = Machine { gap, restitution: 0.8, friction: mu, float_place: [x * gap, 0.0], ..Machine::default() };
                let w = wall_frequency(gap);
                let mut least = f64::MAX;
                let mut worst: f64 = 0.0;
                for s in run(&m, &[Phase::Drop { time: 1.0 }], 200e3) {
                    let deep = (radius(s.place) - gap).max(0.0);
                    let e = 0.5 * radius(s.velocity).powi(2) + GRAVITY * s.place[1] + 0.5 * (w * deep).powi(2);
                    worst = worst.max((e - least) / (GRAVITY * gap));
                    least = least.min(e);
                }
                println!("gap {gap} x {x} mu {mu}: largest rise {worst:.2e} g gap, end {:.4}", least / GRAVITY / gap);
                assert!(worst < 2e-3);
            }
        }
    }
}

#[test]
fn orbit_amplitude() {
    for (gap, part) in [(1e-4, 0.02), (1e-4, 0.2), (5e-4, 0.1)] {
        for spin in [50.0, 600.0, -3000.0, 5000.0] {
            let m = Machine { gap, orbit: part * gap, spin, ..Machine::default() };
            let all = run(&m, &[Phase::Lift { time: 0.1 }, float(0.5)], 20e3);
            let tail = &all[4000..];
            let most = tail.iter().map(|s| radius(s.place)).fold(0.0, f64::max) / m.orbit;
            let least = tail.iter().map(|s| radius(s.place)).fold(1.0, f64::min) / m.orbit;
            println!("gap {gap} orbit {part} spin {spin}: {least:.4} to {most:.4} of asked");
            assert!(most < 1.1 && least > 0.9);
        }
    }
}

#[test]
fn control_loop_is_second_order() {
    // Overshoot and time of the first peak of the answer to a load step.
    for (hz, z) in [(60.0, 0.4), (120.0, 0.8)] {
        let m = Machine { gap: 5e-4, natural_hz: hz, damping: z, ..Machine::default() };
        let d = vec![Disturbance::Step { at: 0.0, acceleration: [3.0, 0.0] }];
        let all = run(&m, &[Phase::Float { time: 0.2, disturbances: d }], 100e3);
        let peak = all.iter().max_by(|a, b| a.place[0].total_cmp(&b.place[0])).unwrap();
        let (w, root) = (std::f64::consts::TAU * hz, (1.0f64 - z * z).sqrt());
        let over = peak.place[0] * w * w / 3.0 - 1.0;
        let (want, time) = ((-std::f64::consts::PI * z / root).exp(), std::f64::consts::PI / w / root);
        println!("{hz} Hz, {z}: overshoot {over:.4} want {want:.4}, at {:.5} s want {time:.5} s", peak.time);
        assert!((over - want).abs() < 0.003 && (peak.time / time - 1.0).abs() < 0.02);
    }
}

#[test]
fn a_far_smaller_step_gives_the_same() {
    for (gap, spin, time) in [(1e-4, 0.0, 0.03), (1e-4, 3000.0, 0.03), (5e-4, -3000.0, 0.06)] {
        let m = Machine { gap, spin, float_place: [0.1 * gap, 0.0], ..Machine::default() };
        let mut a = Plant::new(&m, &[Phase::Drop { time }]);
        let mut b = a.clone();
        b.step = 1e-7;
        let mut worst: f64 = 0.0;
        while let (Some(a), Some(b)) = (a.next_sample(10e3), b.next_sample(10e3)) {
            worst = worst.max(radius([a.place[0] - b.place[0], a.place[1] - b.place[1]]) / gap);
        }
        println!("gap {gap} spin {spin}: largest difference {:.3} % of gap", worst * 100.0);
        assert!(worst < 0.02);
    }
}

#[test]
fn whole_script() {
    let (mut lifted, mut count) = (0, 0);
    for gap in [1e-4, 5e-4] {
        for spin in [0.0, 3000.0, -3000.0] {
            for mu in [0.05, 0.1, 0.2, 0.3] {
                for (after, restitution) in [(Orbit::Ends, 0.5), (Orbit::Ends, 0.8), (Orbit::GoesOn, 0.5)] {
                    let m = Machine { gap, restitution, spin, friction: mu, orbit: 0.03 * gap, after, ..Machine::default() };
                    let script = [
                        Phase::Rest { time: 0.2 },
                        Phase::Lift { time: 0.2 },
                        float(0.3),
                        Phase::Drop { time: 0.5 },
                        Phase::Lift { time: 0.3 },
                        float(0.3),
                    ];
                    let all = run(&m, &script, 10e3);
                    assert_eq!(all.len(), 18000);
                    assert!(all.iter().all(|s| radius(s.place) < 1.1 * gap));
                    let at = |t: f64| &all[(t * 1e4) as usize - 1];
                    let whirl = all[7000..12000].windows(2).map(|w| {
                        let (a, b) = (w[0].place, w[1].place);
                        (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
                    });
                    let turns = whirl.sum::<f64>() / std::f64::consts::TAU;
                    println!(
                        "gap {gap} spin {spin} mu {mu} e {restitution} orbit {after:?}: first {} second {} turns in drop {turns:.1} contacts {} excursions {}",
                        at(0.7).afloat, at(1.8).afloat, all[17999].contacts, all[17999].excursions
                    );
                    if after == Orbit::Ends {
                        assert!(at(0.7).afloat);
                        assert!(spin != 0.0 && turns.abs() > 2.0 || at(1.8).afloat);
                        count += 1;
                        lifted += at(1.8).afloat as u32;
                    }
                }
            }
        }
    }
    println!("second lift: {lifted} of {count}");
}

#[test]
fn disturbances_do_what_they_say() {
    let m = Machine { gap: 3e-4, ..Machine::default() };
    let with = |d: Vec<Disturbance>| run(&m, &[Phase::Float { time: 1.0, disturbances: d }, float(0.5)], 20e3);
    let all = with(vec![Disturbance::Move { at: 0.2, time: 0.1, by: [1e-4, -5e-5] }]);
    assert!(all[0].afloat && radius(all[3000].place) < 1e-9);
    for s in [&all[19000], &all[29999]] {
        assert!(s.afloat && (s.place[0] - 1e-4).abs() < 1e-8 && (s.place[1] + 5e-5).abs() < 1e-8);
    }
    let all = with(vec![Disturbance::Step { at: 0.5, acceleration: [3.0, 0.0] }]);
    let w = std::f64::consts::TAU * 90.0;
    assert!((all[19000].place[0] - 3.0 / (w * w)).abs() < 1e-8 && all[29999].place[0].abs() < 1e-8);
    let all = with(vec![Disturbance::Wander { hz: 1.0, amplitude: [1e-4, 0.0] }]);
    let most = all[..20000].iter().map(|s| s.place[0]).fold(0.0, f64::max);
    assert!((most - 1e-4).abs() < 2e-6, "{most}");
    let all = with(vec![Disturbance::SlowRoll { hz: 5.0, amplitude: 5e-5 }]);
    assert!(all[3000..20000].iter().all(|s| (radius(s.place) - 5e-5).abs() < 2e-6));
    let all = with(vec![Disturbance::Shock { at: 0.3, duration: 0.01, acceleration: [60.0, 0.0] }]);
    let hit = &all[6000..];
    assert!(hit.iter().any(|s| s.in_contact) && all[29999].afloat && all[29999].contacts > 0);
    assert!(all[29999].excursions > 0 && all[5990].excursions == 0);
    let all = run(&m, &[Phase::Shaken { time: 0.5, disturbances: vec![Disturbance::Shake { at: 0.1, hz: 50.0, acceleration: [0.0, 15.0] }] }], 20e3);
    assert!(all[1900].contacts == 0 && all[9999].contacts > 5);
}

#[test]
fn chain_and_rng() {
    let mut c = Chain::new(1, 10e3);
    assert_eq!(c.counts([0.0, 0.0]), [2048; 4]);
    assert_eq!(c.counts([2.0, -2.0]), [4095, 0, 4095, 0]);
    c.gain_error = [0.1, 0.0];
    c.zero = [[0.0, 0.0], [50.0, -50.0]];
    assert_eq!(c.counts([1e-4, 0.0]), [2273, 2048, 2355, 1946]);
    let mut c = Chain::new(7, 10e3);
    (c.noise, c.burst, c.burst_time) = (2.0, 0.2, [0.5, 1.0]);
    let all: Vec<_> = (0..20000).map(|_| c.counts([0.0, 0.0])).collect();
    let far = |s: &[[u16; 4]]| s.iter().flatten().filter(|n| n.abs_diff(2048) > 40).count();
    assert_eq!(far(&all[..4998]) + far(&all[10000..]), 0);
    let part = far(&all[5000..9999]) as f64 / 20000.0;
    assert!((part - 0.2).abs() < 0.02, "{part}");
    let mut again = Chain::new(7, 10e3);
    (again.noise, again.burst, again.burst_time) = (2.0, 0.2, [0.5, 1.0]);
    assert!(all.iter().all(|a| *a == again.counts([0.0, 0.0])));
    let mut r = Rng(3);
    let n: Vec<f64> = (0..100000).map(|_| r.normal()).collect();
    let mean = n.iter().sum::<f64>() / 1e5;
    let var = n.iter().map(|a| a * a).sum::<f64>() / 1e5;
    assert!(mean.abs() < 0.02 && (var - 1.0).abs() < 0.02);
    // The published first output of splitmix64 for seed 0.
    assert_eq!(Rng(0).next_u64(), 0xe220a8397b1dcdaf);
}
