//! A board whose samples are the sum of some conversions: the image gives the desktop's bits of these sums.

use std::fs;
use std::time::Duration;

use tempfile::TempDir;
use touchdown_core::event::{EventKind, Notice};
use touchdown_core::sample::{CHANNELS, Sample, TACHOMETERS};
use touchdown_protocol::config_block;
use touchdown_protocol::wire::{ReplayHead, encode_sample};
use touchdown_run::controller_trace::Procedure;
use touchdown_run::emulator::{Emulator, replay_head};
use touchdown_run::target::Target;
use touchdown_tests::controller::{CLEARANCE, settings};

/// Conversions a second.
const RATE: f64 = 20e3;

/// Let go after 0.3 s, caught by the wall without a bounce; noise of some counts. Both converters fail once, and a channel is once
/// at full scale.
fn conversion(number: u64) -> Sample {
    let time = (number as f64 / RATE - 0.3).max(0.0);
    let fallen = (0.5 * 9.81 * time * time).min(f64::from(CLEARANCE));
    let counts: [u16; CHANNELS] = [0, 1, 2, 3].map(|channel: u64| {
        let noise = (4 * number + channel).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        let place = if channel % 2 == 1 { -fallen } else { 0.0 };
        (2_047.0 + place / 0.5e-6).round() as u16 + (noise % 5) as u16
    });
    let mut it = Sample {
        counts,
        valid: if number == 5_001 { 0 } else { 0b1111 },
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    };
    if number == 5_102 {
        it.counts[2] = 4_095;
    }
    it
}

/// By its definition, for conversions of 12 bit.
fn sum(conversions: &[Sample]) -> Sample {
    let counts = [0, 1, 2, 3].map(|channel: usize| {
        let all = || conversions.iter().map(|it| it.counts[channel]);
        if all().any(|it| it == 4_095) {
            4_096 * conversions.len() as u16 - 1
        } else {
            all().sum()
        }
    });
    let valid = conversions.iter().fold(0b1111, |valid, it| valid & it.valid);
    let last = conversions.last().expect("a conversion");
    Sample { counts, valid, ..*last }
}

#[test]
fn the_sum_of_some_conversions_gives_the_same_bits() {
    let conversions: Vec<_> = (0..10_000).map(conversion).collect();
    for of_sample in [2, 4] {
        let mut slow = settings();
        slow.monitor.detector.sample_rate /= of_sample as f32;
        let sensing = &mut slow.monitor.sensing;
        sensing.full_scale = 4_096 * of_sample as u16 - 1;
        sensing.zero_count *= of_sample as f32;
        sensing.resolution /= of_sample as f32;
        let folder = TempDir::new().expect("a folder");
        let at = folder.path();
        fs::write(at.join("settings"), config_block::encode(&slow)).expect("a file");
        let mut replay = replay_head(&ReplayHead::new(settings().monitor, false)).expect("a head");
        conversions.iter().for_each(|it| replay.extend(encode_sample(&(*it).into(), None)));
        fs::write(at.join("replay"), replay).expect("a file");
        let emulator = Emulator::find(None).unwrap_or_else(|error| panic!("{error}"));
        let mut session = emulator.open(at).unwrap_or_else(|error| panic!("{error}"));
        let answer = session.answer(Duration::from_secs(120));
        let (target, shown) = answer.unwrap_or_else(|error| panic!("{error}"));

        let sums = conversions.chunks(of_sample).map(sum);
        let desktop = Target::Host.control(&slow.monitor, &Procedure::default(), sums);
        let (desktop, conduct) = desktop.unwrap_or_else(|failure| panic!("{failure:?}"));
        assert_eq!(target.notices, desktop.notices, "{of_sample}");
        assert_eq!(target.summary, desktop.summary, "{of_sample}");
        assert_eq!(shown, conduct.outputs, "{of_sample}");
        assert_eq!(target.summary.samples, 10_000 / of_sample as u64);
        let fell = |it: &Notice| matches!(it, Notice::Declared(it) if it.kind == EventKind::FreeFall);
        assert!(target.notices.iter().any(fell), "{of_sample}");
    }
}
