//! Force measurement: the simulated device and its calibration against the closed form, and the recovered
//! force against the reference's.

use std::f64::consts::TAU;
use std::fs;

use predicates::prelude::*;
use predicates::str::contains;
use rustfft::num_complex::Complex64;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_force::calibration::Calibration;
use touchdown_force::instrument::{Instrument, Mode};
use touchdown_force::pulse::Pulse;
use touchdown_force::recording::{Axis, Hits, Recording};
use touchdown_force::rehearsal;
use touchdown_force::rehearsal::{Blow, half_sine};
use touchdown_force::resolution::Resolution;
use touchdown_force::spectrum::Transform;
use touchdown_force::{Measurement, measure, write};
use touchdown_tests::binary::touchdown;
use touchdown_truth::reference::press::{Press, PressShape};
use touchdown_truth::reference::pulse::Meeting;

/// Of the issue: impulse and contact time at the paper's 50 kHz.
const IMPULSE: f64 = 0.02;
const CONTACT_TIME: f64 = 0.1;
/// Of a blow: between two samples, s.
const BEGIN: f64 = 20.003e-3;
/// Down and to the right.
const DIRECTION: [f64; 2] = [0.6, -0.8];

/// The rig's rotor in its ring, steel on steel; with half its mass on this bearing or the whole.
fn meeting(mass: f64, speed: f64, restitution: f64) -> Meeting {
    let (radius, clearance) = (0.024_f64, 0.3e-3);
    let curvature = radius * (radius + clearance) / clearance;
    Meeting {
        mass,
        speed,
        restitution,
        press: Press {
            shape: PressShape::Power { exponent: 1.5 },
            stiffness: 4.0 / (3.0 * std::f64::consts::PI) * 3.625e11 * curvature.sqrt(),
            balls: None,
            slowest: 0.0,
        },
        gravity: 0.0,
    }
}

fn device(noise: f64) -> Instrument {
    Instrument {
        noise,
        ..Instrument::default()
    }
}

fn hits(device: &Instrument) -> Hits {
    rehearsal::hits(device, Axis::X, 7)
}

/// The record of one force.
fn strike(device: &Instrument, force: Vec<(f64, f64)>, seed: u64) -> Recording {
    let blow = Blow {
        time: BEGIN,
        direction: DIRECTION,
        force,
    };
    rehearsal::recording(device, &[blow], 0.1, seed)
}

fn only(found: &Measurement) -> Pulse {
    let pulses: Vec<_> = found.pulses().collect();
    assert_eq!(pulses.len(), 1, "{pulses:?}");
    *pulses[0]
}

fn area(force: &[(f64, f64)]) -> f64 {
    let part = |it: &[(f64, f64)]| 0.5 * (it[0].1 + it[1].1) * (it[1].0 - it[0].0);
    force.windows(2).map(part).sum()
}

/// Part by which a pulse is off in impulse, peak and contact time, and degrees in direction.
fn off(pulse: &Pulse, impulse: f64, peak: f64, duration: f64) -> [f64; 4] {
    let direction = DIRECTION[0].atan2(-DIRECTION[1]).to_degrees();
    [
        pulse.impulse_n_s / impulse - 1.0,
        pulse.peak_force_n / peak - 1.0,
        pulse.contact_time_s.expect("fits") / duration - 1.0,
        pulse.direction_deg - direction,
    ]
}

fn worst_of(worst: &mut [f64; 4], off: [f64; 4]) {
    for (worst, off) in worst.iter_mut().zip(off) {
        *worst = worst.max(off.abs());
    }
}

/// Acceleration over force, 1/kg, at a frequency (Hz), before the filter.
fn accelerance(device: &Instrument, frequency: f64) -> Complex64 {
    let s = Complex64::new(0.0, TAU * frequency);
    let of = |mode: &Mode| {
        let w = TAU * mode.frequency;
        s * s / (mode.mass * (s * s + 2.0 * mode.damping * w * s + w * w))
    };
    device.modes.iter().map(of).sum()
}

/// H is off by as much as its stated variance says, at most by a tenth in the band's worst, and near the
/// closed form where it is flat.
#[test]
fn calibration_finds_the_transfer_function() {
    for noise in [0.1, 0.5, 2.0] {
        let device = device(noise);
        let calibration = Calibration::new(&hits(&device)).expect("calibrates");
        let transform = Transform::holding(calibration.longest());
        let response = calibration.response(&transform);
        let (mut flat, mut squares, mut stated, mut count) = (0.0_f64, 0.0, 0.0, 0.0);
        for (k, h) in response.h.iter().enumerate() {
            let frequency = k as f64 * calibration.rate / transform.length as f64;
            if !calibration.band.contains(&frequency) {
                continue;
            }
            let right = accelerance(&device, frequency);
            let off = (h - right).norm_sqr();
            squares += off / right.norm_sqr();
            stated += off / response.variance[k];
            count += 1.0;
            if (1000.0..6000.0).contains(&frequency) {
                flat = flat.max((off / right.norm_sqr()).sqrt());
            }
        }
        let (rms, stated) = (f64::sqrt(squares / count), f64::sqrt(stated / count));
        println!(
            "noise {noise} m/s^2: band {:.0?} Hz; off by {flat:.1e} at most from 1 to 6 kHz, by {rms:.1e} rms \
             in the band, {stated:.2} of what is stated; coherence {:.5}",
            calibration.band,
            calibration.coherence.expect("several hits")
        );
        // The variance stated is the greater of two estimates.
        assert!((0.8..1.1).contains(&stated), "{noise}: {stated}");
        assert!(flat <= 0.1 && rms <= 0.05, "{noise}: {flat} {rms}");
        assert!(*calibration.band.start() < 300.0 && *calibration.band.end() > 7000.0);
    }
}

/// 0.02 to 0.5 m/s, half the rotor and all of it. A noise of 5 m/s^2 is too much for the targets.
#[test]
fn contacts_of_the_rig_come_back() {
    for (noise, impulse_tolerance, time_tolerance) in [
        (0.05, IMPULSE, CONTACT_TIME),
        (0.5, IMPULSE, CONTACT_TIME),
        (2.0, IMPULSE, CONTACT_TIME),
        (5.0, 0.05, 0.2),
    ] {
        let device = device(noise);
        let hits = [hits(&device)];
        let mut worst = [0.0; 4];
        for mass in [1.71, 3.42] {
            for speed in [0.02, 0.0767, 0.2, 0.5] {
                for restitution in [0.8, 1.0] {
                    let meeting = meeting(mass, speed, restitution);
                    let truth = meeting.pulse();
                    let seed = (1e4 * speed * mass) as u64;
                    let recording = strike(&device, meeting.history(), seed);
                    let pulse = only(&measure(&recording, &hits).expect("measures"));
                    let impulse = (1.0 + restitution) * mass * speed;
                    let off = off(&pulse, impulse, truth.peak_force, truth.duration);
                    worst_of(&mut worst, off);
                    // The anti-alias filter's delay is part of the record.
                    let late = pulse.time_s - BEGIN;
                    assert!((10e-6..70e-6).contains(&late), "{late:e}");
                }
            }
        }
        let [impulse, peak, time, angle] = worst;
        println!(
            "noise {noise} m/s^2: impulse {impulse:.2e}, peak {peak:.2e}, contact time {time:.2e} off, \
             direction {angle:.2} degrees"
        );
        assert!(
            impulse <= impulse_tolerance && time <= time_tolerance && peak <= 0.05,
            "{worst:?}"
        );
        assert!(angle <= 2.0, "{angle}");
    }
}

/// Cases that nothing was chosen by: other devices, speeds, places between the samples, directions and seeds,
/// spread evenly by multiples of irrational numbers.
#[test]
fn contacts_on_other_devices_come_back() {
    let spread = |k: u32, step: f64| (f64::from(k) * step).fract();
    let mut worst = [0.0; 4];
    for k in 1..=30 {
        let mut device = Instrument::default();
        let [mount, elastic] = &mut device.modes;
        mount.frequency = 350.0 + 300.0 * spread(k, 0.618_034);
        mount.mass = 2.0 + 3.0 * spread(k, 0.414_214);
        mount.damping = 0.02 + 0.08 * spread(k, 0.732_051);
        elastic.frequency = 7000.0 + 3000.0 * spread(k, 0.236_068);
        elastic.mass = mount.mass * (6.0 + 8.0 * spread(k, 0.645_751));
        elastic.damping = 0.005 + 0.02 * spread(k, 0.316_625);
        let hits = [rehearsal::hits(&device, Axis::X, u64::from(100 + k))];
        let speed = 0.02 * 25_f64.powf(spread(k, 0.605_551));
        let restitution = 0.75 + 0.25 * spread(k, 0.123_106);
        let meeting = meeting(1.71, speed, restitution);
        let angle = std::f64::consts::TAU * spread(k, 0.358_899);
        let blow = Blow {
            time: 15e-3 + 20e-6 * spread(k, 0.795_832),
            direction: [angle.sin(), -angle.cos()],
            force: meeting.history(),
        };
        let recording = rehearsal::recording(&device, &[blow], 0.1, u64::from(200 + k));
        let pulse = only(&measure(&recording, &hits).expect("measures"));
        let truth = meeting.pulse();
        let impulse = (1.0 + restitution) * 1.71 * speed;
        let mut off = off(&pulse, impulse, truth.peak_force, truth.duration);
        let turned = (pulse.direction_deg.to_radians() - angle)
            .sin()
            .asin()
            .to_degrees();
        off[3] = turned;
        println!(
            "{k}: {speed:.3} m/s, {restitution:.2}, {:.0} us: {off:.4?}",
            1e6 * truth.duration
        );
        worst_of(&mut worst, off);
    }
    println!("other devices: worst {worst:.4?}");
    assert!(worst[0] <= IMPULSE && worst[1] <= 0.05 && worst[2] <= CONTACT_TIME && worst[3] <= 1.0);
}

/// Much loss leaves a tail with hardly a force: impulse and peak come back, contact time less and less. A line
/// contact likewise, by a spring of 0.15 ms.
#[test]
fn contacts_with_much_loss_come_back() {
    let device = device(0.5);
    let hits = [hits(&device)];
    let line = 1.71 * (std::f64::consts::PI / 0.15e-3).powi(2);
    for (restitution, tolerance) in [(0.8, CONTACT_TIME), (0.5, CONTACT_TIME), (0.3, 0.25)] {
        let mut worst = [0.0; 4];
        for speed in [0.02, 0.0767, 0.2, 0.5] {
            let point = meeting(1.71, speed, restitution);
            let line = Meeting {
                press: Press { shape: PressShape::Power { exponent: 1.0 }, stiffness: line, balls: None, slowest: 0.0 },
                ..point
            };
            for meeting in [point, line] {
                let truth = meeting.pulse();
                let force = meeting.history();
                let impulse = area(&force);
                let pulse = only(&measure(&strike(&device, force, 9), &hits).expect("measures"));
                let off = off(&pulse, impulse, truth.peak_force, truth.duration);
                println!(
                    "{restitution} at {speed} m/s, {:.0} us: {off:.4?}",
                    1e6 * truth.duration
                );
                worst_of(&mut worst, off);
            }
        }
        println!("restitution {restitution}: worst {worst:.4?}");
        assert!(worst[0] <= IMPULSE && worst[1] <= 0.05 && worst[2] <= tolerance);
    }
}

/// Shapes that the fitted law does not have.
#[test]
fn pulses_of_another_shape_come_back() {
    let device = device(0.5);
    let hits = [hits(&device)];
    let shape = |of: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        let at = |k: i32| f64::from(k) / 400.0;
        (0..=400)
            .map(|k| (0.2e-3 * at(k), 2000.0 * of(at(k))))
            .collect()
    };
    let sine = |u: f64| (std::f64::consts::PI * u).sin();
    for (name, tolerance, force) in [
        ("half a sine", 0.1, shape(&sine)),
        ("late half sine", 0.1, shape(&|u| sine(u.powf(1.3)))),
        ("triangle", 0.1, shape(&|u| 1.0 - (2.0 * u - 1.0).abs())),
        // It has hardly a force at its edges.
        ("square of a sine", 0.1, shape(&|u| sine(u).powi(2))),
    ] {
        let impulse = area(&force);
        let pulse = only(&measure(&strike(&device, force, 3), &hits).expect("measures"));
        let off = off(&pulse, impulse, 2000.0, 0.2e-3);
        println!(
            "{name}: impulse {:+.2e}, peak {:+.2e}, contact time {:+.2e}",
            off[0], off[1], off[2]
        );
        assert!(
            off[0].abs() <= IMPULSE && off[2].abs() <= tolerance,
            "{name}: {off:?}"
        );
    }
}

/// Too short for the band: the impulse is right, the force is what the band shows of an impulse, and the
/// contact time is no more than that it was short.
#[test]
fn an_impulse_comes_back_as_what_the_band_shows_of_it() {
    let device = device(0.5);
    let hits = [hits(&device)];
    let period = 1.0 / 13.8e3;
    for duration in [10e-6, 30e-6, 60e-6, 100e-6] {
        let force = half_sine(0.2 / duration, duration);
        let impulse = area(&force);
        let found = measure(&strike(&device, force, 3), &hits).expect("measures");
        let pulse = only(&found);
        let recovered = found.contacts[0]
            .recovered
            .iter()
            .map(|it| it.1)
            .fold(0.0, f64::max);
        let shown = impulse * Resolution { highest: found.band[1] }.answer(0.0);
        println!(
            "{:.0} us: impulse {:+.2e}; contact {:.0} us; greatest {:.2} of an impulse's",
            1e6 * duration,
            pulse.impulse_n_s / impulse - 1.0,
            1e6 * pulse.contact_time_s.unwrap_or(f64::NAN),
            recovered / shown
        );
        assert!((pulse.impulse_n_s / impulse - 1.0).abs() <= IMPULSE);
        assert!(
            pulse
                .contact_time_s
                .is_none_or(|time| time < duration + period)
        );
        if duration <= 10e-6 {
            // Samples lie up to half a period of 50 kHz beside the greatest.
            assert!(
                (0.75..1.1).contains(&(recovered / shown)),
                "{recovered} {shown}"
            );
        }
    }
}

/// Two contacts of 0.2 ms, and the impulse of both; a long one.
#[test]
fn near_and_long_contacts() {
    let device = device(0.5);
    let hits = [hits(&device)];
    for (apart, count) in [(0.4e-3, 1), (1e-3, 2), (3e-3, 2)] {
        let blows = [0.0, apart].map(|later| Blow {
            time: BEGIN + later,
            direction: DIRECTION,
            force: half_sine(1000.0, 0.2e-3),
        });
        let found =
            measure(&rehearsal::recording(&device, &blows, 0.1, 3), &hits).expect("measures");
        let impulse: f64 = found.pulses().map(|it| it.impulse_n_s).sum();
        let times: Vec<_> = found.pulses().map(|it| it.contact_time_s).collect();
        let right = 2.0 * area(&half_sine(1000.0, 0.2e-3));
        println!(
            "{:.1} ms apart: impulse {:+.2e}, {times:?}",
            1e3 * apart,
            impulse / right - 1.0
        );
        assert_eq!(found.pulses().count(), count);
        assert!((impulse / right - 1.0).abs() <= IMPULSE);
        assert!(
            times.iter().all(|time| time.is_some() == (count == 2)),
            "{times:?}"
        );
    }
    // From some milliseconds on, all but the ends of a contact is below the band: that is lost.
    for (duration, lost) in [(1e-3, false), (2e-3, false), (5e-3, true)] {
        let force = half_sine(500.0, duration);
        let impulse = area(&force);
        let found = measure(&strike(&device, force, 3), &hits).expect("measures");
        let sum: f64 = found.pulses().map(|it| it.impulse_n_s).sum();
        let off = sum / impulse - 1.0;
        println!(
            "{:.0} ms long: {} pulses, impulse {off:+.2e}",
            1e3 * duration,
            found.pulses().count()
        );
        assert!(
            if lost {
                off < -0.5
            } else {
                off.abs() <= IMPULSE
            },
            "{duration}: {off}"
        );
    }
}

/// Offset and slow drift are below the band; a steady force is too, and is not seen.
#[test]
fn drift_of_the_accelerometer_does_not_matter() {
    let device = device(0.5);
    let meeting = meeting(1.71, 0.0767, 0.8);
    let mut recording = strike(&device, meeting.history(), 3);
    for axis in &mut recording.acceleration {
        for (k, value) in axis.iter_mut().enumerate() {
            *value += 20.0 + 3.0 * (std::f64::consts::TAU * 10.0 * k as f64 / 50e3).sin();
        }
    }
    let pulse = only(&measure(&recording, &[hits(&device)]).expect("measures"));
    let truth = meeting.pulse();
    let off = off(
        &pulse,
        1.8 * 1.71 * 0.0767,
        truth.peak_force,
        truth.duration,
    );
    println!("drift: {off:.4?}");
    assert!(
        off[0].abs() <= IMPULSE && off[2].abs() <= CONTACT_TIME,
        "{off:?}"
    );
}

#[test]
fn one_axis_and_one_hit_will_do() {
    let device = device(0.5);
    let mut hits = hits(&device);
    hits.hits.truncate(1);
    let force = meeting(1.71, 0.0767, 0.8).history();
    let impulse = area(&force);
    let blow = Blow {
        time: BEGIN,
        direction: [-1.0, 0.0],
        force,
    };
    let mut recording = rehearsal::recording(&device, &[blow], 0.1, 5);
    recording.acceleration.truncate(1);
    let found = measure(&recording, &[hits]).expect("measures");
    let pulse = only(&found);
    assert_eq!(found.calibrations[0].coherence, None);
    assert_eq!(pulse.direction_deg, -90.0);
    assert!((pulse.impulse_n_s / impulse - 1.0).abs() <= IMPULSE);
}

#[test]
fn noise_alone_is_no_contact() {
    let device = device(0.5);
    let hits = [hits(&device)];
    for seed in 0..20 {
        let recording = rehearsal::recording(&device, &[], 0.1, seed);
        let found = measure(&recording, &hits).expect("measures");
        assert_eq!(found.pulses().count(), 0, "{seed}");
    }
}

/// The example's files through the program, against its truth.
#[test]
fn files_go_through_the_command() {
    let folder = TempDir::new().unwrap();
    touchdown(folder.path())
        .args(["force", "--example", "try"])
        .assert()
        .success();
    touchdown(folder.path())
        .args([
            "force",
            "try/recording.csv",
            "--calibration",
            "try/calibration.csv",
        ])
        .args(["--json", "found.json", "--report", "found.html"])
        .assert()
        .success()
        .stdout(contains("50000 Hz; calibrated from"));
    let read = |name: &str| -> Value {
        serde_json::from_str(&fs::read_to_string(folder.path().join(name)).unwrap()).unwrap()
    };
    let (found, truth) = (read("found.json"), read("try/truth.json"));
    assert_eq!(found["sample_rate_hz"], 50e3);
    assert!(found["band_hz"][0].as_f64() < found["band_hz"][1].as_f64());
    let pairs = found["pulses"]
        .as_array()
        .unwrap()
        .iter()
        .zip(truth["pulses"].as_array().unwrap());
    assert!(pairs.len() >= 3 && found["pulses"].as_array().unwrap().len() == pairs.len());
    for (found, truth) in pairs {
        let number = |value: &Value, key: &str| value[key].as_f64().unwrap();
        let off = |key| number(found, key) / number(truth, key) - 1.0;
        let turned = number(found, "direction_deg") - number(truth, "direction_deg");
        println!(
            "{:.4} s: impulse {:+.1e}, peak {:+.1e}, contact time {:+.1e}, direction {turned:+.2} degrees",
            number(truth, "time_s"),
            off("impulse_n_s"),
            off("peak_force_n"),
            off("contact_time_s")
        );
        assert!(off("impulse_n_s").abs() <= IMPULSE);
        assert!(off("contact_time_s").abs() <= CONTACT_TIME);
        assert!(turned.abs() < 1.0);
    }
    let page = fs::read_to_string(folder.path().join("found.html")).unwrap();
    assert!(page.contains("Strongest contacts") && !page.contains("http"));
}

struct Files {
    recording: String,
    calibration: String,
}

/// A good pair, from which bad ones are made.
fn good() -> Files {
    let device = device(0.5);
    let mut hits = hits(&device);
    hits.hits.truncate(2);
    let recording = strike(&device, meeting(1.71, 0.0767, 0.8).history(), 3);
    Files {
        recording: write::recording(&recording),
        calibration: write::calibration(&hits),
    }
}

/// The text with line `line`, counted from 1, replaced.
fn replaced(text: &str, line: usize, with: &str) -> String {
    let mut lines: Vec<_> = text.lines().collect();
    lines[line - 1] = with;
    lines.join("\n") + "\n"
}

fn refuse(files: &Files, message: &str) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("r.csv"), &files.recording).unwrap();
    fs::write(folder.path().join("c.csv"), &files.calibration).unwrap();
    touchdown(folder.path())
        .args([
            "force",
            "r.csv",
            "--calibration",
            "c.csv",
            "--json",
            "a.json",
            "--report",
            "a.html",
        ])
        .assert()
        .code(2)
        .stdout("")
        .stderr(contains(message));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "{message}");
}

#[test]
fn bad_recordings_name_file_line_and_rule() {
    let good = good();
    let with = |recording: String, message: &str| {
        let calibration = good.calibration.clone();
        refuse(
            &Files {
                recording,
                calibration,
            },
            message,
        );
    };
    let lines: Vec<&str> = good.recording.lines().collect();
    let first = |count: usize| lines[..count].join("\n") + "\n";
    with(
        String::new(),
        "r.csv:1: the header must be time_s,ax_m_s2[,ay_m_s2], is \"\"",
    );
    with(
        good.recording.replacen("ax_m_s2,", "", 1),
        "r.csv:1: the header must be time_s,ax_m_s2",
    );
    with(first(1), "r.csv:1: there are no rows after the header");
    with(first(2), "r.csv:2: one row alone has no sample rate");
    with(
        replaced(&good.recording, 7, "0.0001,NaN,0"),
        "r.csv:7: ax_m_s2 must be a finite number, is \"NaN\"",
    );
    with(
        replaced(&good.recording, 7, "0.0001,1,inf"),
        "r.csv:7: ay_m_s2 must be a finite number, is \"inf\"",
    );
    with(
        replaced(&good.recording, 7, "0.0001,1"),
        "r.csv:7: a row needs 3 fields, this one has 2",
    );
    with(
        replaced(&good.recording, 7, "x,1,1"),
        "r.csv:7: time_s must be a finite number, is \"x\"",
    );
    with(
        replaced(&good.recording, 7, "0.000107,1,1"),
        "r.csv:7: the sample rate is not constant",
    );
    with(
        replaced(&good.recording, 7, "0.00002,1,1"),
        "r.csv:7: time_s must increase",
    );
    with(
        good.recording.trim_end().to_owned(),
        "r.csv:5001: the last line is cut off",
    );
    with(
        first(200),
        "r.csv:2: the record must begin with 5 ms of quiet and 1 ms more before the first contact, for its zero and its noise; it ends before that",
    );
    let late = [&lines[..1], &lines[900..]].concat().join("\n") + "\n";
    with(
        late,
        "r.csv:2: the record must begin with 5 ms of quiet and 1 ms more before the first contact, for its zero and its noise; here",
    );
    let slow = |text: &str| -> String {
        text.lines()
            .enumerate()
            .filter(|(k, _)| *k == 0 || k % 2 == 1)
            .map(|(_, it)| format!("{it}\n"))
            .collect()
    };
    with(
        slow(&good.recording),
        "r.csv:3: the sample rate is 25000 Hz, that of c.csv 50000 Hz: both need one rate",
    );
    let seconds: String = (0..400)
        .map(|k| format!("{},0.0,0.0\n", f64::from(k) * 1e-3))
        .collect();
    with(
        format!("{}\n{seconds}", lines[0]),
        "r.csv:3: the sample rate must be 5000 to 1000000 Hz, is 1000 Hz",
    );
}

#[test]
fn bad_calibrations_name_file_line_and_rule() {
    let good = good();
    let with = |calibration: String, message: &str| {
        let recording = good.recording.clone();
        refuse(
            &Files {
                recording,
                calibration,
            },
            message,
        );
    };
    let changed = |of: &dyn Fn(usize, &mut Vec<String>)| -> String {
        let mut text = String::new();
        for (k, line) in good.calibration.lines().enumerate() {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            if k > 0 {
                of(k, &mut fields);
            }
            text += &(fields.join(",") + "\n");
        }
        text
    };
    with(
        good.calibration.replacen("force_n,", "", 1),
        "c.csv:1: the header must be [hit,]time_s,force_n,ax_m_s2",
    );
    with(
        good.calibration.replacen("ax_m_s2", "az_m_s2", 1),
        "c.csv:1: the header must be",
    );
    with(
        changed(&|_, it| it[2] = "0".to_owned()),
        "c.csv:2: the hit has no force",
    );
    with(
        changed(&|k, it| {
            if k > 5000 {
                it[2] = format!("0.{}", k % 10)
            }
        }),
        "c.csv:5002: the hit has no force: its greatest",
    );
    with(
        changed(&|_, it| it[3] = "0".to_owned()),
        "c.csv:2: the hit moves nothing",
    );
    with(
        changed(&|k, it| {
            if (1000..1005).contains(&k) {
                it[2] = "500".to_owned()
            }
        }),
        "c.csv:2: the hammer hits twice: 5.000e2 N",
    );
    let short: String = good
        .calibration
        .lines()
        .take(701)
        .map(|it| format!("{it}\n"))
        .collect();
    with(
        short,
        "c.csv:2: the hit is cut off: its acceleration must die out",
    );
    with(
        changed(&|k, it| {
            if k == 41 {
                it[3] = String::new()
            }
        }),
        "c.csv:42: ax_m_s2 must be a finite number, is \"\"",
    );
    with(
        changed(&|k, it| {
            if k > 5000 {
                it[1] = format!("{:.6}", (k - 5001) as f64 / 40e3);
            }
        }),
        "c.csv:5002: the sample rate is 40000 Hz, that of the first hit 50000 Hz: all hits need one rate",
    );
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("r.csv"), &good.recording).unwrap();
    fs::write(folder.path().join("c.csv"), &good.calibration).unwrap();
    for (arguments, message) in [
        (
            &["r.csv", "--calibration", "none.csv"][..],
            "none.csv: no such file",
        ),
        (
            &["none.csv", "--calibration", "c.csv"],
            "none.csv: no such file",
        ),
        (&["r.csv"], "--calibration <FILE>"),
        (
            &["r.csv", "--calibration", "c.csv", "--calibration", "c.csv"],
            "c.csv:1: is for the same axis as c.csv",
        ),
        (
            &[
                "r.csv",
                "--calibration",
                "c.csv",
                "--json",
                "-",
                "--report",
                "-",
            ],
            "two outputs go to standard output",
        ),
        (&["r.csv", "--example", "x"], "cannot be used with"),
    ] {
        touchdown(folder.path())
            .arg("force")
            .args(arguments)
            .assert()
            .code(2)
            .stderr(contains(message).and(contains("panicked").not()));
    }
}
