use proptest::prelude::*;
use touchdown_core::sensing::Sensing;

use super::*;
use crate::{BUILT_IN, Scene};

fn defaults() -> SensorsConfig {
    Scene::parse("rig", BUILT_IN[0].text).unwrap().sensors
}

fn quiet() -> SensorsConfig {
    SensorsConfig {
        noise: 0.0,
        ..defaults()
    }
}

fn at(position: [f64; 2]) -> Motion {
    Motion {
        planes: [position; PLANES],
        spin: 0.0,
        levitated: true,
        bearing: None,
    }
}

fn read_once(config: &SensorsConfig, motion: &Motion) -> Sample {
    let sensors = Sensors::try_new(config, 20_000.0).unwrap();
    sensors.read(&mut sensors.start(1), motion)
}

proptest! {
    #[test]
    fn the_core_reads_back_what_the_sensors_saw(
        radius in 0.0..900e-6,
        angle in 0.0..TAU,
        mounting in prop::array::uniform2(-4.0..4.0_f64),
        bits in 8_u32..=16,
    ) {
        let config = SensorsConfig { mounting_angle: mounting, bits, ..quiet() };
        let position = [radius * angle.cos(), radius * angle.sin()];
        let sample = read_once(&config, &at(position));
        let planes = Sensing::try_new(&config.sensing()).unwrap().planes(&sample);
        // Half a count on both axes, and the single precision of the core.
        let bound = 0.5 * config.resolution() * 2_f64.sqrt() + 1e-9;
        for plane in planes {
            let [x, y] = plane.unwrap().map(f64::from);
            prop_assert!((x - position[0]).hypot(y - position[1]) <= bound);
        }
    }
}

#[test]
fn out_of_range_saturates() {
    let sample = read_once(&quiet(), &at([2e-3, -2e-3]));
    assert_eq!(sample.counts, [4095, 0, 4095, 0]);
    let config = quiet();
    let sensing = Sensing::try_new(&config.sensing()).unwrap();
    for channel in 0..4 {
        let mut one = read_once(&config, &at([0.0; 2]));
        assert!(sensing.planes(&one)[channel / 2].is_some());
        one.counts[channel] = sample.counts[channel];
        assert!(sensing.planes(&one)[channel / 2].is_none(), "{channel}");
    }
}

#[test]
fn noise_is_white_and_as_strong_as_asked() {
    let config = SensorsConfig {
        bits: 16,
        ..defaults()
    };
    let sensors = Sensors::try_new(&config, 20_000.0).unwrap();
    let mut state = sensors.start(7);
    let mut readings = [const { Vec::new() }; CHANNELS];
    for _ in 0..100_000 {
        let counts = sensors.read(&mut state, &at([0.0; 2])).counts;
        for (readings, count) in readings.iter_mut().zip(counts) {
            readings.push(displacement(&config, count));
        }
    }
    let mean_product = |a: &[f64], b: &[f64]| {
        let products = a.iter().zip(b).map(|(a, b)| a * b);
        products.sum::<f64>() / a.len().min(b.len()) as f64
    };
    for channel in &readings {
        let mean = channel.iter().sum::<f64>() / channel.len() as f64;
        let variance = mean_product(channel, channel);
        let lag = mean_product(channel, &channel[1..]);
        assert!(mean.abs() < 2e-8, "{mean}");
        assert!((variance.sqrt() / 1e-6 - 1.0).abs() < 0.01, "{variance}");
        assert!((lag / variance).abs() < 0.015, "{lag}");
    }
    let cross = mean_product(&readings[0], &readings[2]);
    assert!(cross.abs() < 1.5e-14, "{cross}");
}

#[test]
fn a_seed_gives_the_same_counts() {
    let run = |seed| {
        let sensors = Sensors::try_new(&defaults(), 20_000.0).unwrap();
        let mut state = sensors.start(seed);
        (0..100)
            .map(|_| sensors.read(&mut state, &at([1e-5, 2e-5])).counts)
            .collect::<Vec<_>>()
    };
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
}

#[test]
fn the_low_pass_lags_by_its_time_constant() {
    let config = SensorsConfig {
        bandwidth: Some(1000.0),
        bits: 16,
        ..quiet()
    };
    let sensors = Sensors::try_new(&config, 200_000.0).unwrap();
    let mut state = sensors.start(1);
    let rate = 1e-3;
    let mut last = 0.0;
    for k in 0..400 {
        last = f64::from(k) / 200_000.0 * rate * 100.0;
        sensors.read(&mut state, &at([last, 0.0]));
    }
    let sample = sensors.read(&mut state, &at([last, 0.0]));
    let lag = last - displacement(&config, sample.counts[0]);
    let expected = rate * 100.0 / (TAU * 1000.0);
    assert!((lag / expected - 1.0).abs() < 0.05, "{lag} {expected}");
}

#[test]
fn runout_turns_with_the_shaft() {
    let config = SensorsConfig {
        runout: 50e-6,
        bits: 16,
        ..quiet()
    };
    let sensors = Sensors::try_new(&config, 20_000.0).unwrap();
    let mut state = sensors.start(1);
    let spin = TAU * 1000.0;
    let motion = Motion {
        spin,
        ..at([0.0; 2])
    };
    for k in 0..40 {
        let counts = sensors.read(&mut state, &motion).counts;
        let [x, y] = [0, 1].map(|axis| displacement(&config, counts[axis]));
        let shaft = spin * f64::from(k) / 20_000.0;
        assert!((x - 50e-6 * shaft.cos()).abs() < 2e-8);
        assert!((y - 50e-6 * shaft.sin()).abs() < 2e-8);
    }
}

#[test]
fn offset_gain_and_nonlinearity_add_up() {
    let config = SensorsConfig {
        offset: [5e-6, 0.0, 0.0, 0.0],
        gain_error: [0.0, 0.1, 0.0, 0.0],
        nonlinearity: 0.02,
        bits: 16,
        ..quiet()
    };
    let counts = read_once(&config, &at([500e-6, 500e-6])).counts;
    let bent = 500e-6 * (1.0 + 0.02 * 0.25);
    for (count, expected) in counts
        .into_iter()
        .zip([bent + 5e-6, 1.1 * bent, bent, bent])
    {
        assert!((displacement(&config, count) - expected).abs() <= config.resolution());
    }
}

#[test]
fn an_unfitted_plane_is_never_valid() {
    let config = SensorsConfig {
        planes: 1,
        ..quiet()
    };
    assert_eq!(read_once(&config, &at([0.0; 2])).valid, 0b0011);
}
