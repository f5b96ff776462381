//! The image in the emulator and the library on the desktop say the same, and leave the same bits.

use touchdown_core::detect::{DetectorConfig, MachineConfig, Tuning};
use touchdown_core::event::{Notice, Plane};
use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::{CHANNELS, Edges, Sample, TACHOMETERS};
use touchdown_core::sensing::SensingConfig;
use touchdown_core::tachometer::TachometersConfig;
use touchdown_run::emulator::{Emulator, EmulatorError};
use touchdown_run::controller_trace::{MonitorOutput, Procedure};
use touchdown_tests::monitor_run;

const SAMPLES: u64 = 20_000;
const SAMPLE_RATE: f32 = 20_000.0;
const ZERO_COUNT: f32 = 2_048.0;
const COUNTS_PER_METRE: f32 = 4_096.0 / 2_000e-6;
const CLEARANCE: f32 = 0.3e-3;
const GRAVITY: f32 = 9.81;
const RESTITUTION: f32 = 0.8;
const SPIN: f32 = -3_141.6;

fn config() -> MonitorConfig {
    MonitorConfig {
        fitted: 0b1111,
        sensing: SensingConfig {
            resolution: 1.0 / COUNTS_PER_METRE,
            zero_count: ZERO_COUNT,
            full_scale: 4_095,
            mounting_angle: [0.0; 2],
            calibration: None,
            places: None,
        },
        tachometers: None,
        detector: DetectorConfig {
            sample_rate: SAMPLE_RATE,
            machine: MachineConfig {
                mass: 3.42,
                clearance: CLEARANCE,
                gravity: GRAVITY,
                rotor_radius: 24e-3,
                inertia_ratio: 0.5,
                friction: 0.1,
                restitution: RESTITUTION,
                spin: SPIN,
            },
            tuning: Tuning::default(),
        },
        guard: touchdown_core::guard::GuardConfig::default(),
        commissioned: false,
    }
}

/// SplitMix64.
fn noise(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Any counts, flags and spin, usable or not.
fn noise_on_every_input(index: u64) -> Sample {
    let bits = noise(index);
    Sample {
        counts: std::array::from_fn(|channel| (bits >> (12 * channel)) as u16 & 0x0fff),
        valid: (bits >> 48) as u8 & 0x0f,
        spin: (bits >> 52 & 1 == 0).then_some((bits >> 56) as f32 * 40.0 - 5_000.0),
        levitated: (bits >> 53 & 1 == 0).then_some(bits >> 54 & 1 == 0),
        edges: std::array::from_fn(|channel| {
            let bits = noise(!index) >> (32 * channel);
            (bits & 0xff != 0).then_some(Edges {
                count: (bits >> 8) as u16,
                age: (bits >> 24) as u8,
            })
        }),
    }
}

/// Height of a rotor that falls from the centre and bounces, m; `time` since its release, s.
fn bouncing_height(mut time: f32) -> f32 {
    let mut fall = (2.0 * CLEARANCE / GRAVITY).sqrt();
    if time <= fall {
        return -0.5 * GRAVITY * time * time;
    }
    time -= fall;
    for _ in 0..20 {
        fall *= RESTITUTION;
        if time < 2.0 * fall {
            return -CLEARANCE + GRAVITY * time * (fall - 0.5 * time);
        }
        time -= 2.0 * fall;
    }
    -CLEARANCE
}

/// A quarter of the run levitated, then a drop, with noise of one count on every channel.
fn drop_of_the_rotor(index: u64) -> Sample {
    let time = index.saturating_sub(SAMPLES / 4) as f32 / SAMPLE_RATE;
    let height = bouncing_height(time);
    let axes = [0.0, height, 0.0, height];
    Sample {
        counts: std::array::from_fn(|channel| {
            let jitter = noise(index * CHANNELS as u64 + channel as u64) % 3;
            (ZERO_COUNT + axes[channel] * COUNTS_PER_METRE) as u16 + jitter as u16
        }),
        valid: 0b1111,
        spin: Some(SPIN),
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

/// Likewise, but one end falls from half the height, onto a ring that turns at most of the rotor's speed.
fn drop_of_a_tilted_rotor_on_a_turning_ring(index: u64) -> Sample {
    let sample = drop_of_the_rotor(index);
    let released = SAMPLES / 4 - 60;
    let time = index.saturating_sub(released) as f32 / SAMPLE_RATE;
    let height = (0.5 * bouncing_height(time * 2.0_f32.sqrt()) - 0.5 * CLEARANCE).max(-CLEARANCE);
    let jitter = noise(index) % 3;
    let mut counts = sample.counts;
    counts[1] = (ZERO_COUNT + height * COUNTS_PER_METRE) as u16 + jitter as u16;
    // 8 marks pass with 3 700 a second.
    let edges = index as f32 * 3_700.0 / SAMPLE_RATE;
    let age = edges.fract() / 3_700.0 * SAMPLE_RATE;
    Sample {
        counts,
        edges: [
            Some(Edges {
                count: edges as u32 as u16,
                age: (256.0 * age).min(255.0) as u8,
            }),
            None,
        ],
        ..sample
    }
}

/// What the image says of these samples.
fn on_target(
    config: &MonitorConfig,
    samples: impl Iterator<Item = Sample>,
) -> Result<MonitorOutput, EmulatorError> {
    let emulator = Emulator::find(None).unwrap_or_else(|error| panic!("{error}"));
    let answer = emulator.control(config, &Procedure::default(), samples);
    answer.map(|(output, _)| output)
}

/// Optical sensors on inner ring and cage.
fn config_with_tachometers() -> MonitorConfig {
    MonitorConfig {
        tachometers: Some(TachometersConfig {
            marks: [Some(8), Some(12)],
            cage_ratio: 0.4,
            bore_radius: 24.3e-3,
            edge_error: 1e-4,
            window: 10e-3,
        }),
        ..config()
    }
}

/// Runs the stream on both, and gives the notices.
fn assert_same_on_both(config: &MonitorConfig, stream: fn(u64) -> Sample) -> Vec<Notice> {
    let samples = || (0..SAMPLES).map(stream);
    let desktop = monitor_run::run(config, samples()).unwrap();
    let target = on_target(config, samples()).unwrap();
    assert_eq!(target.notices, desktop.notices);
    assert_eq!(target.summary, desktop.summary);
    assert_eq!(target.summary.samples, SAMPLES);
    target.notices
}

#[test]
fn same_bits_for_a_drop() {
    let notices = assert_same_on_both(&config(), drop_of_the_rotor);
    // Free fall, its confirmation, and more than one impact.
    assert!(notices.len() >= 4, "{notices:?}");
}

#[test]
fn same_bits_for_noise_on_every_input() {
    assert_same_on_both(&config(), noise_on_every_input);
    assert_same_on_both(&config_with_tachometers(), noise_on_every_input);
}

#[test]
fn same_bits_for_ends_that_are_apart_on_a_ring_that_turns() {
    let config = config_with_tachometers();
    let notices = assert_same_on_both(&config, drop_of_a_tilted_rotor_on_a_turning_ring);
    for plane in [Plane::A, Plane::B] {
        let of_plane = |notice: &&Notice| match notice {
            Notice::Declared(event) => event.plane == plane,
            _ => false,
        };
        assert!(
            notices.iter().any(|notice| of_plane(&notice)),
            "{notices:?}"
        );
    }
}

#[test]
fn one_flipped_count_changes_the_fingerprint() {
    let flipped = |index| {
        let mut sample = drop_of_the_rotor(index);
        if index == SAMPLES / 2 {
            sample.counts[2] ^= 1;
        }
        sample
    };
    let desktop = monitor_run::run(&config(), (0..SAMPLES).map(drop_of_the_rotor)).unwrap();
    let target = on_target(&config(), (0..SAMPLES).map(flipped)).unwrap();
    assert_ne!(target.summary.state_hash, desktop.summary.state_hash);
}

#[test]
fn image_logs_start_configuration_and_end() {
    let log = on_target(&config(), (0..10).map(drop_of_the_rotor))
        .unwrap()
        .log;
    let [start, configuration, .., end] = &log[..] else {
        panic!("{log:?}");
    };
    assert!(start.starts_with("touchdown "), "{log:?}");
    assert!(configuration.contains("20000"), "{log:?}");
    assert!(end.starts_with("end: 10 samples"), "{log:?}");
}

#[test]
fn impossible_configuration_is_refused_with_its_reason() {
    let mut config = config();
    config.sensing.resolution = -1.0;
    let error = on_target(&config, (0..10).map(drop_of_the_rotor)).unwrap_err();
    let EmulatorError::Failed { status, log, .. } = &error else {
        panic!("{error}");
    };
    assert!(!status.success());
    let log = log.join("\n");
    assert!(log.contains("resolution must be above 0"), "{log}");
}
