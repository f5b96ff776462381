//! What each stream is of.

use std::f64::consts::TAU;

use touchdown_scene::Scene;
use touchdown_scene::sensors::{Failing, SensorFault};

use crate::path::{Path, smooth};

const AY: usize = 1;
const BX: usize = 2;
const BY: usize = 3;
/// Gap of the rig, m.
const GAP: f64 = 0.3e-3;
/// Time after which a controller catches a load, s.
const CAUGHT: f64 = 2.4e-3;

/// Every stream by its name.
pub fn all() -> Vec<(&'static str, Path)> {
    let mut all = regimes();
    all.extend(machines());
    all.extend(floating());
    all.extend(failing());
    all
}

/// A built-in scene, with lines of it in other words.
fn scene(name: &str, changes: &[(&str, &str)], more: &str) -> Scene {
    let mut text = Scene::text(name).expect("a built-in scene").into_owned();
    for (old, new) in changes {
        assert_eq!(text.matches(old).count(), 1, "{name}: {old}");
        text = text.replace(old, new);
    }
    Scene::parse(name, &(text + more)).expect("a valid scene")
}

fn rig(more: &str) -> Scene {
    scene("rig", &[], more)
}

/// The rig without spin, that hardly bounces and comes to rest.
fn still(more: &str) -> Scene {
    let changes = [
        ("speed_rpm = -30000.0 ", "speed_rpm = 0.0 "),
        ("restitution = 0.8", "restitution = 0.3"),
        ("x_mm = 0.02", "x_mm = 0.0"),
    ];
    scene("rig", &changes, more)
}

fn regimes() -> Vec<(&'static str, Path)> {
    let drop = |scene: &Scene| Path::new(scene).floats(0.2).drops();
    let cold = |scene: &Scene| Path::new(scene).drops();
    vec![
        ("pendulum", drop(&rig(""))),
        (
            "rolling",
            drop(&scene(
                "rolling",
                &[(
                    "duration_s = 0.8",
                    "duration_s = 0.7\nsample_rate_hz = 10000",
                )],
                "[sensors]\nspeed = true\nlevitation_signal = true\n",
            )),
        ),
        ("rest", drop(&still(""))),
        (
            "bouncing",
            drop(&scene(
                "rig-wide-gap",
                &[
                    ("restitution = 0.8", "restitution = 0.95"),
                    (
                        "duration_s = 0.5",
                        "duration_s = 0.4\nsample_rate_hz = 10000",
                    ),
                ],
                "",
            )),
        ),
        (
            "backward_whirl",
            cold(&scene("backward-whirl", &[("= 0.045", "= 0.15")], "")),
        ),
        (
            "forward_whirl",
            cold(&scene(
                "backward-whirl",
                &[
                    ("= 0.045", "= 0.2"),
                    ("speed_rpm = -30000.0", "speed_rpm = 3000.0"),
                    ("friction = 0.1", "friction = 0.02"),
                    ("100.47681387", "180.0"),
                ],
                "[sensors]\nspeed = true\n",
            )),
        ),
        ("lift_off", cold(&scene("lift-off", &[], ""))),
        (
            "cold_pendulum",
            cold(&scene(
                "rolling",
                &[
                    ("x_mm = 0.02", "angle_deg = 25.0\ntangential_mm_s = 0.0"),
                    ("speed_rpm = -300.0", "speed_rpm = 0.0"),
                    (
                        "duration_s = 0.8",
                        "duration_s = 0.25\nsample_rate_hz = 50000",
                    ),
                ],
                "[sensors]\nbits = 16\nnoise_um = 3.0\nmounting_deg = [45.0, 30.0]\n",
            )),
        ),
    ]
}

fn machines() -> Vec<(&'static str, Path)> {
    let two_plane = scene("two-plane", &[], "");
    let bearing = scene(
        "ball-bearing",
        &[(
            "duration_s = 0.6",
            "duration_s = 0.6\nsample_rate_hz = 10000",
        )],
        "",
    );
    let one_plane = scene(
        "rig",
        &[(
            "duration_s = 0.3",
            "duration_s = 0.5\nsample_rate_hz = 5000",
        )],
        "[sensors]\nplanes = 1\nspeed = true\n",
    );
    vec![
        ("ends_apart", Path::new(&two_plane).floats(0.2).drops()),
        ("ball_bearing", Path::new(&bearing).floats(0.2).drops()),
        ("one_plane", Path::new(&one_plane).floats(0.3).drops()),
        (
            "vertical",
            Path::new(&scene("vertical", &[], "")).floats(0.2).drops(),
        ),
        (
            "one_end_lifts",
            // Both lie; then one is lifted by 0.2 mm in 20 ms, and put down again.
            Path::new(&rig("")).moves(0.6, |time| {
                let part = ((time - 0.3) / 0.02).clamp(0.0, 1.0);
                let lifted = part * part * part * (1.0 - smooth((time - 0.33) / 0.05));
                [[0.0, -GAP + 0.2e-3 * lifted], [0.0, -GAP]]
            }),
        ),
    ]
}

fn floating() -> Vec<(&'static str, Path)> {
    let orbiting = scene(
        "rig",
        &[("x_mm = 0.02", "x_mm = 0.03\nvy_mm_s = -18.85")],
        "[sensors]\nrunout_um = 5.0\nrunout_harmonic = 2\n",
    );
    // 30 um at 100 Hz, clockwise as the spin, at the start's place and speed on its release.
    let orbit = |time: f64| {
        let (sin, cos) = (TAU * 100.0 * (time - 0.4)).sin_cos();
        [[30e-6 * cos, -30e-6 * sin]; 2]
    };
    // A load that the controller catches, then another setpoint.
    let disturbed = |time: f64| {
        let fallen = (time - 0.25).max(0.0);
        let y = if fallen < CAUGHT {
            -0.5 * 9.81 * fallen * fallen
        } else {
            let deepest = 0.5 * 9.81 * CAUGHT * CAUGHT;
            -deepest * (1.0 - smooth((fallen - CAUGHT) / 6e-3))
        };
        [[20e-6 * smooth((time - 0.35) / 0.02), y]; 2]
    };
    let again = scene("rig", &[("duration_s = 0.3", "duration_s = 0.12")], "");
    vec![
        ("orbit", Path::new(&orbiting).moves(0.4, orbit).drops()),
        ("disturbance", Path::new(&rig("")).moves(0.5, disturbed)),
        (
            "recovery",
            Path::new(&again)
                .floats(0.2)
                .drops()
                .lifted(0.04)
                .floats(0.4)
                .drops(),
        ),
    ]
}

fn failing() -> Vec<(&'static str, Path)> {
    let slow = |rate: &str, more: &str| {
        let rate = format!("duration_s = 0.2\nsample_rate_hz = {rate}");
        scene("rig", &[("duration_s = 0.3", rate.as_str())], more)
    };
    let fault = |channel, failing, start: f64, length: f64| SensorFault {
        channel,
        failing,
        start: start - 2e-5,
        end: start + length - 2e-5,
    };
    let forever = f64::INFINITY;
    let whirling = |time: f64| {
        let (sin, cos) = (TAU * 50.0 * time).sin_cos();
        [[20e-6 * cos, -20e-6 * sin]; 2]
    };
    vec![
        (
            "sensors_fail",
            Path::new(&rig(""))
                .floats(0.2)
                .drops()
                .with(fault(0, Failing::Off(80e-6), 0.16, 5e-5))
                .with(fault(BY, Failing::Dropped, 0.17, 1.5e-4))
                .with(fault(BX, Failing::Stuck, 0.18, 5e-3))
                .with(fault(BY, Failing::Stuck, 0.206, 2e-3))
                .with(fault(AY, Failing::Off(-60e-6), 0.2149, 5e-5))
                .with(fault(AY, Failing::Open, 0.3, 0.02))
                .with(fault(BX, Failing::Short, 0.4, forever)),
        ),
        (
            "sensors_drift",
            Path::new(&slow("5000", "")).floats(1.4).drops().with(fault(
                BX,
                Failing::Drift(-120e-6),
                0.6,
                forever,
            )),
        ),
        (
            "drift_of_a",
            Path::new(&slow("5000", "")).floats(1.6).with(fault(
                0,
                Failing::Drift(-120e-6),
                0.6,
                forever,
            )),
        ),
        (
            "sensors_shift",
            Path::new(&slow("5000", "")).floats(0.5).drops().with(fault(
                AY,
                Failing::Off(15e-6),
                0.3,
                forever,
            )),
        ),
        (
            "sensors_lie",
            Path::new(&still("")).floats(0.2).drops().with(fault(
                AY,
                Failing::Gain(0.4),
                0.0,
                forever,
            )),
        ),
        (
            "reversed",
            Path::new(&still("[sensors]\nplanes = 1\n"))
                .floats(0.2)
                .drops()
                .with(fault(AY, Failing::Reversed, 0.0, forever)),
        ),
        (
            "mirrored",
            Path::new(&slow("10000", "[sensors]\nspeed = true\n"))
                .moves(0.6, whirling)
                .with(fault(BX, Failing::Reversed, 0.0, forever)),
        ),
    ]
}
