//! The validity line: the contact pulse's band against the rotor's first elastic mode.

use touchdown_models::{Contact, HertzConfig, Materials};
use touchdown_rotor::RigidConfig;
use touchdown_scene::elastic::{Validity, Verdict};

fn rig() -> HertzConfig {
    HertzConfig {
        rigid: RigidConfig {
            mass: 3.42,
            radius: 0.024,
            polar_inertia: 0.5 * 3.42 * 0.024 * 0.024,
            clearance: 0.3e-3,
            friction: 0.1,
            restitution: 0.8,
            gravity: 9.81,
            speed: 1.0,
            step: 1e-5,
        },
        materials: Materials::steel(),
        contact: Contact::Point,
        fastest: 0.076_720_271,
    }
}

/// Half the mass at zeta 1. T_c = 4.53398 (m^2 (1 - r/R)/(V r E_r^2))^(1/5) by Hertz: 0.195 ms.
#[test]
fn the_rig_bends_in_its_contacts() {
    let (mass, radius, modulus, speed) = (1.71_f64, 0.024_f64, 3.625e11_f64, 0.076_720_271);
    let gap = 1.0 - radius / (radius + 0.3e-3);
    let time = 4.53398 * (mass * mass * gap / (speed * radius * modulus * modulus)).powf(0.2);
    let validity = Validity::try_new(&rig(), 1.0, 1520.0).expect("valid");
    println!("{validity}");
    // The contact modulus is printed to four digits.
    assert!((validity.band_hz * time - 1.0).abs() < 1e-4);
    assert!((time - 0.195e-3).abs() < 1e-6);
    assert_eq!(validity.verdict, Verdict::Bends);
    assert!((validity.ratio - 1.0 / (time * 1520.0)).abs() < 1e-3);
}

/// The mode rings by 4 x cos(pi x)/(4 x^2 - 1) after a half sine: summed here, a tenth is left at the verdict.
#[test]
fn a_rigid_verdict_leaves_a_tenth_of_ringing() {
    let left = |x: f64| {
        let (steps, mut c, mut s) = (200_000, 0.0, 0.0);
        let step = 1.0 / f64::from(steps);
        for k in 0..steps {
            let t = (f64::from(k) + 0.5) * step;
            let force = (std::f64::consts::PI * t).sin();
            let phase = std::f64::consts::TAU * x * t;
            c += force * phase.cos() * step;
            s += force * phase.sin() * step;
        }
        std::f64::consts::TAU * x * f64::hypot(c, s)
    };
    let worst = |from: u32| {
        (from..from + 200)
            .map(|k| left(f64::from(k) * 0.05))
            .fold(0.0, f64::max)
    };
    assert!(worst(200) <= 0.1005, "{}", worst(200));
    assert!(worst(100) > 0.1);
    let mode = |ratio: f64| {
        let band = Validity::try_new(&rig(), 0.5, 1.0).expect("valid").band_hz;
        Validity::try_new(&rig(), 0.5, band / ratio)
            .expect("valid")
            .verdict
    };
    assert_eq!(mode(0.099), Verdict::Rigid);
    assert_eq!(mode(0.101), Verdict::Rings);
    assert_eq!(mode(1.01), Verdict::Bends);
}

/// The farther out, the lighter: T_c ~ m^(2/5).
#[test]
fn an_end_is_lighter_than_the_middle() {
    let band = |zeta| {
        Validity::try_new(&rig(), zeta, 1520.0)
            .expect("valid")
            .band_hz
    };
    let ratio = band(2.0) / band(0.0);
    assert!((ratio - 5f64.powf(0.4)).abs() < 1e-9, "{ratio}");
}

#[test]
fn bad_values_are_refused_by_name() {
    let name = |zeta, mode| {
        Validity::try_new(&rig(), zeta, mode)
            .expect_err("refused")
            .parameter()
    };
    assert_eq!(name(0.0, 0.0), "mode_hz");
    assert_eq!(name(0.0, f64::NAN), "mode_hz");
    assert_eq!(name(f64::INFINITY, 1520.0), "zeta");
}
