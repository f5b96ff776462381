//! The image in real time, by emulated time: a Clear over the line is answered whatever goes on, and a core that is too
//! slow tells what it lost.

use std::f64::consts::TAU;
use std::fs;
use std::process::{Command, Stdio};

use tempfile::TempDir;
use touchdown_core::event::{Act, Event, EventKind, Notice, Ordered};
use touchdown_core::monitor::Summary;
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_protocol::link::{Decoder, FRAME_BYTES, Nonce, Reply, Request, State, encode, mac};
use touchdown_protocol::wire::{
    ANSWER_MAGIC, Incoming, NOTICE_BYTES, Record, ReplayHead, decode_record, encode_sample,
};
use touchdown_run::emulator::{built, replay_head};
use touchdown_tests::controller::settings;

const RATE: f64 = 20e3;
/// s: it floats, falls and bounces, and whirls from then on.
const FALLS: f64 = 0.25;
const WHIRLS: f64 = 0.45;
const LASTS: f64 = 0.75;
const CLEARANCE: f64 = 0.3e-3;

/// Displacement in parts of the clearance.
fn place(time: f64) -> [f64; 2] {
    if time > WHIRLS {
        let angle = 60.0 * TAU * (time - WHIRLS) - 0.25 * TAU;
        return [angle.cos(), angle.sin()];
    }
    let mut left = (time - FALLS).max(0.0);
    let mut flight = (2.0 * CLEARANCE / 9.81_f64).sqrt();
    if left < flight {
        return [0.0, -(left / flight).powi(2)];
    }
    left -= flight;
    while flight > 1e-5 {
        flight *= 0.8;
        if left < 2.0 * flight {
            return [0.0, -1.0 + 9.81 / CLEARANCE * left * (flight - 0.5 * left)];
        }
        left -= 2.0 * flight;
    }
    [0.0, -1.0]
}

/// SplitMix64.
fn noise(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn sample(number: u64) -> Sample {
    let [x, y] = place(number as f64 / RATE).map(|it| it * CLEARANCE / 2_000e-6 * 4_096.0);
    let count = |place: f64, channel: u64| {
        let jitter = noise(4 * number + channel) % 3;
        (2_047.0 + place).round() as u16 + jitter as u16
    };
    Sample {
        counts: [count(x, 0), count(y, 1), count(x, 2), count(y, 3)],
        valid: 0b1111,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

/// A request whose first byte comes with this sample.
struct Asked(u64, Request);

impl Asked {
    /// The sample with whose period each byte comes; a byte takes 87 us.
    fn bytes(&self, sequence: u8) -> impl Iterator<Item = (u64, u8)> {
        let frame = encode(sequence, &self.1).expect("a frame");
        (self.0..).step_by(2).zip(frame)
    }
}

struct Run {
    events: Vec<Event>,
    ordered: Vec<Ordered>,
    summary: Summary,
    /// What came over the line, each with its bytes.
    replies: Vec<(Reply, usize)>,
}

impl Run {
    fn nonces(&self) -> Vec<Nonce> {
        let nonce = |reply: &Reply| match reply {
            Reply::Challenge(nonce, _) => Some(*nonce),
            _ => None,
        };
        self.replies.iter().filter_map(|(reply, _)| nonce(reply)).collect()
    }

    fn last_state(&self) -> &State {
        let state = |it: &'_ (Reply, usize)| matches!(it.0, Reply::State(_));
        match self.replies.iter().rfind(|it| state(it)) {
            Some((Reply::State(state), _)) => state,
            _ => panic!("no state"),
        }
    }
}

/// Runs the image at 2^`shift` ns an instruction.
fn run(shift: u32, asked: &[Asked]) -> Run {
    let folder = TempDir::new().expect("a folder");
    let head = ReplayHead {
        in_real_time: true,
        ..ReplayHead::new(settings().monitor, false)
    };
    let mut replay = replay_head(&head).expect("a head");
    let samples = (LASTS * RATE) as u64;
    let mut records: Vec<_> = (0..samples)
        .map(|it| (Incoming { service: true, ..sample(it).into() }, None))
        .collect();
    for (sequence, asked) in (1..).zip(asked) {
        for (at, byte) in asked.bytes(sequence) {
            records[at as usize].1 = Some(byte);
        }
    }
    replay.extend(records.iter().flat_map(|(incoming, line)| encode_sample(incoming, *line)));
    fs::write(folder.path().join("replay"), replay).expect("a file");
    let status = Command::new("qemu-system-arm")
        .args(["-M", "netduinoplus2", "-nographic", "-monitor", "none", "-serial", "file:line"])
        .arg("-icount")
        .arg(format!("shift={shift},sleep=off"))
        .args(["-semihosting-config", "enable=on,target=native,arg=replay,arg=answer,arg=log"])
        .arg("-kernel")
        .arg(built("touchdown-qemu"))
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status();
    assert!(status.expect("QEMU").success());
    let read = |name: &str| fs::read(folder.path().join(name)).expect("a file");
    let mut it = Run {
        events: vec![],
        ordered: vec![],
        summary: Summary { samples: 0, faults: 0, conditions: Default::default(), state_hash: 0 },
        replies: vec![],
    };
    let answer = read("answer");
    let records = answer.strip_prefix(&ANSWER_MAGIC).expect("an answer").as_chunks::<NOTICE_BYTES>().0;
    for record in records {
        match decode_record(record).expect("a record") {
            Record::Notice(Notice::Declared(event)) => it.events.push(event),
            Record::Notice(Notice::Ordered(ordered)) => it.ordered.push(ordered),
            Record::Summary(summary) => it.summary = summary,
            _ => {}
        }
    }
    let (mut decoder, mut length) = (Decoder::default(), 0);
    for byte in read("line") {
        length += 1;
        if let Some(Ok(received)) = decoder.take::<Reply>(byte) {
            it.replies.push((received.message, length));
            length = 0;
        }
    }
    it
}

fn onset(run: &Run, kind: EventKind) -> f64 {
    let event = run.events.iter().find(|it| it.kind == kind);
    event.unwrap_or_else(|| panic!("no {kind:?}")).onset.0 as f64 / 256.0 / RATE
}

/// While it floats, falls, bounces and whirls; the log is written, and erased, meanwhile.
#[test]
fn a_clear_is_answered_within_20_ms_of_emulated_time() {
    let times = [0.2, 0.253, 0.27, 0.34, 0.46, 0.55, 0.65];
    // 8 ms for the nonce.
    let at = |time: f64| (time * RATE) as u64;
    let challenges = || times.map(|time| Asked(at(time), Request::Challenge));
    let first = run(3, &challenges());
    let nonces = first.nonces();
    assert_eq!(nonces.len(), times.len());
    assert!(onset(&first, EventKind::FreeFall) > FALLS - 1e-3);
    let whirls = [EventKind::ForwardWhirl, EventKind::BackwardWhirl];
    assert!(first.events.iter().any(|it| whirls.contains(&it.kind)), "{:?}", first.events.iter().map(|it| it.kind).collect::<Vec<_>>());
    let mut asked = vec![];
    // Without a source of chance a nonce is a number that goes up with each that was used: `link/right.rs`.
    let mut nonce = nonces[0];
    for challenge in challenges() {
        let order = Request::Order { mac: mac(None, &nonce, &Act::Clear, &[]), act: Act::Clear };
        nonce[0] += 1;
        asked.extend([Asked(challenge.0 + 240, order)]);
        asked.push(challenge);
    }
    asked.sort_by_key(|it| it.0);
    let second = run(3, &asked);
    assert_eq!(second.ordered.len(), times.len());
    // What may be on its way already when the answer is ready.
    let is_unasked = |it: &&(Reply, usize)| matches!(it.0, Reply::Notice(_) | Reply::State(_));
    let ahead = second.replies.iter().filter(is_unasked).map(|it| it.1).max().expect("notices");
    assert!(ahead < FRAME_BYTES);
    let mut refusals = vec![];
    for (ordered, time) in second.ordered.iter().zip(times) {
        let order = asked.iter().find(|it| it.0 == at(time) + 240).expect("asked");
        let (end, _) = order.bytes(0).last().expect("bytes");
        let done = (ordered.sample as f64 - end as f64) / RATE;
        // The answer to an order takes 16 bytes at most.
        let all = (end - order.0) as f64 / RATE + done + (ahead + 16) as f64 * 87e-6;
        println!("{time} s: done {:.2} ms after the last byte, {:.2} ms in all, refused {}", 1e3 * done, 1e3 * all, ordered.refused);
        assert!((0.0..20e-3).contains(&all), "{time} s: {all} s");
        refusals.push(ordered.refused);
    }
    // Allowed while it floats, and refused while it falls.
    assert_eq!(refusals[0], 0);
    assert!(refusals.iter().any(|it| *it != 0));
}

/// 62 million instructions a second: less than the ticks need.
#[test]
fn a_core_that_is_too_slow_tells_what_it_lost_and_dates_stay_right() {
    let (fast, slow) = (run(3, &[]), run(4, &[]));
    let samples = (LASTS * RATE) as u64;
    println!("lost: {} at 8 ns an instruction, {} at 16 ns of {}", fast.last_state().counters.lost_samples, slow.last_state().counters.lost_samples, slow.last_state().sample);
    assert_eq!(fast.summary.samples, samples);
    // No gap is longer than what time goes on for; what waits at the end has no tick any more.
    assert!(samples - slow.summary.samples <= 20, "{}", slow.summary.samples);
    let lost = u64::from(slow.last_state().counters.lost_samples);
    assert!(lost > samples / 4, "{lost}");
    let late = onset(&slow, EventKind::FreeFall) - onset(&fast, EventKind::FreeFall);
    assert!(late.abs() < 2e-3, "{late} s");
}
