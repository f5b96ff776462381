//! Samples that were never taken: time goes on without them, in the monitor and in the record.

mod common;

use common::desk::Desk;
use common::falling::{DURATION, sample};
use common::rig::{BLOCK, BOOT};
use proptest::prelude::*;
use touchdown_core::event::{EventKind, Notice, Notices};
use touchdown_firmware::app::App;
use touchdown_firmware::board::{SAMPLE_RATE_HZ, default_config, default_settings};
use touchdown_firmware::recorder::{Memory, Recorder};
use touchdown_firmware::tick::tick;
use touchdown_protocol::config_block;
use touchdown_protocol::controller::{Fault, Faults};
use touchdown_protocol::log::waveform::Counts;

const RATE: f64 = SAMPLE_RATE_HZ as f64;

struct Outcome {
    /// Onsets of the fall and of the first three impacts, samples.
    onsets: Vec<f64>,
    samples: u64,
    lost: u32,
    faults: Faults,
    sensor_faults: usize,
    /// The newest that the record has, oldest first.
    recorded: Vec<Counts>,
}

/// A drop of which the samples of `lost` are never taken.
fn drop(lost: impl Fn(usize) -> bool) -> Outcome {
    let config = default_config();
    let memory = Box::leak(Box::new(Memory::EMPTY));
    let mut recorder = Recorder::new(memory, &config, &BLOCK, BOOT);
    let mut app = App::try_new(&config, Faults::NONE).expect("a valid configuration");
    app.assume_lift();
    let mut desk = Desk(config_block::encode(&default_settings()));
    let mut notices = Notices::new();
    let (mut events, mut gone, mut seed) = (vec![], 0, 1);
    let all = (DURATION * RATE) as usize;
    for number in 0..all {
        let sample = sample(number as f64 / RATE, 13, &mut seed);
        if lost(number) && number + 1 < all {
            gone += 1;
            continue;
        }
        tick(
            &mut app,
            &mut recorder,
            &mut desk,
            &sample,
            gone,
            &mut notices,
        );
        gone = 0;
        for notice in &notices {
            if let Notice::Declared(event) = notice {
                events.push(*event);
            }
        }
    }
    let told = events
        .iter()
        .filter(|it| matches!(it.kind, EventKind::FreeFall | EventKind::Impact));
    Outcome {
        onsets: told.map(|it| it.onset.0 as f64 / 256.0).take(4).collect(),
        samples: app.state().samples,
        lost: app.report(0, 0).counters.lost_samples,
        faults: app.faults(),
        sensor_faults: events
            .iter()
            .filter(|it| it.kind == EventKind::SensorFault)
            .count(),
        recorded: recorder.recent(1).counts().collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// One sample in ten lost, or bursts of up to a quarter of a millisecond.
    #[test]
    fn dates_stay_right_where_samples_are_lost(seed in 1_u64.., burst in 1_u64..6) {
        let whole = drop(|_| false);
        let gone = |number: usize| {
            let mut state = seed ^ (number as u64 / burst + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            common::chip::random(&mut state);
            common::chip::random(&mut state).is_multiple_of(10)
        };
        let holed = drop(gone);
        prop_assert_eq!(holed.samples, whole.samples);
        let last = (DURATION * RATE) as usize - 1;
        prop_assert_eq!(holed.lost as usize, (0..last).filter(|&it| gone(it)).count());
        prop_assert!(holed.faults.contains(Fault::Overrun));
        prop_assert_eq!(holed.sensor_faults, whole.sensor_faults, "no sensor is blamed");
        prop_assert_eq!(whole.onsets.len(), 4);
        // The fall begins without a speed; an impact is where two parabolas meet.
        for (whole, holed) in whole.onsets.iter().zip(&holed.onsets).skip(1) {
            prop_assert!((whole - holed).abs() < 2.0 + burst as f64, "{whole} {holed}");
        }
        prop_assert!((whole.onsets[0] - holed.onsets[0]).abs() < 25.0, "{:?} {:?}", whole.onsets, holed.onsets);
    }
}

#[test]
fn the_record_has_a_hole_where_a_sample_was_lost() {
    let last = (DURATION * RATE) as usize - 1;
    let holed = drop(|number| number == last - 2 || number == last - 5);
    let whole = drop(|_| false);
    let pairs = holed.recorded.iter().zip(&whole.recorded).rev();
    for (back, (holed, whole)) in pairs.enumerate() {
        if back == 2 || back == 5 {
            assert_eq!(*holed, [u16::MAX; 4], "{back}");
        } else {
            assert_eq!(holed, whole, "{back}");
        }
    }
}
