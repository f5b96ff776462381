//! Orders over the link take a right: each case that is refused or done, with its reason, and any sequence of random and
//! recorded frames, which changes nothing. The real server over the real application, drop log and recorder.

mod common;

use common::chip::{Bus, Chip, NoDelay, flash, random};
use common::desk::Desk;
use common::rig::{BLOCK, BOOT, Rig, config};
use touchdown_core::event::{Act, EventKind, Notice, Notices, Ordered};
use touchdown_core::sample::{Sample, TACHOMETERS};
use touchdown_firmware::app::App;
use touchdown_firmware::board::{default_config, default_settings};
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::recorder::{Memory, Recorder};
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::config_block::{self, Block, Key, Settings, blanked};
use touchdown_protocol::controller::{Busy, Cause, Fault, Faults, Mode, Shown};
use touchdown_protocol::link::{
    Decoder, Device, Log, Mac, Nonce, Recent, Refusal, Reply, Request, Server, State, encode, mac,
};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::wire::{Record, decode_record, encode_record};

const KEY: Key = Key(*b"sixteen letters.");
const RATE: u64 = 20_000;
/// Samples for which a nonce is good.
const GOOD: u64 = 5 * RATE;

type Episodes = DropLog<W25q<Bus, NoDelay>, 5>;

/// A controller with four episodes.
struct Controller {
    app: App,
    board: Desk,
    recorder: Recorder<'static>,
    log: Episodes,
    bus: Bus,
    service: bool,
    key: Option<Key>,
    /// Samples that have gone by on the link's clock, beside those of the application.
    waited: u64,
    told: Vec<Ordered>,
    sequence: u8,
}

/// All that an order may change.
#[derive(Clone, Debug, PartialEq)]
struct Kept {
    shown: Shown,
    faults: Faults,
    block: Block,
    counters: Option<Counters>,
    /// Checksum of the log's flash, marks included.
    flash: u32,
}

fn sample(height: f64) -> Sample {
    let gap = f64::from(default_config().detector.machine.clearance);
    let y = (4_096.0 + height * gap * 8_192.0 / 2_000e-6).round() as u16;
    Sample {
        counts: [4_096, y, 4_096, y],
        valid: 0b1111,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

fn settings(key: Option<Key>) -> Settings {
    Settings {
        key,
        ..default_settings()
    }
}

/// With the number of the power-on in flash, as both boards have it before they serve the link.
fn mounted(flash: W25q<Bus, NoDelay>) -> Episodes {
    let mut log = Episodes::mount(flash).unwrap_or_else(|_| panic!("a log"));
    while log.work(Default::default(), None, || None) == Ok(true) {}
    log
}

impl Controller {
    fn new(key: Option<Key>, found: Faults) -> Self {
        let (mut flash, bus) = flash(Chip::new(20));
        for drop in 1..=4 {
            let mut rig = Rig::new(2_000.0, drop);
            let mut log = DropLog::<_, 5>::mount(&mut flash).unwrap();
            (0..150).for_each(|_| rig.tick(&[]));
            (0..500).for_each(|tick| rig.drop_tick(tick, 450));
            while log
                .work(Default::default(), None, || rig.recorder.fetch())
                .unwrap()
            {}
        }
        Self {
            app: App::try_new(&default_config(), found).expect("a valid configuration"),
            board: Desk(config_block::encode(&settings(key))),
            recorder: Recorder::new(
                Box::leak(Box::new(Memory::EMPTY)),
                &config(RATE as f32),
                &BLOCK,
                BOOT,
            ),
            log: mounted(flash),
            bus,
            service: false,
            key,
            waited: 0,
            told: vec![],
            sequence: 0,
        }
    }

    /// Faulted, and lying still: whatever is ordered by right is done.
    fn lying(key: Option<Key>) -> Self {
        let mut it = Self::new(key, Faults::NONE.with(Fault::Crash));
        it.stay(-1.0, 2 * RATE);
        assert_eq!(it.app.shown().mode, Mode::Faulted);
        assert_eq!(it.app.may_restart(), Ok(()));
        it
    }

    fn watching(key: Option<Key>) -> Self {
        let mut it = Self::new(key, Faults::NONE);
        it.app.assume_lift();
        it.stay(0.0, 4_000);
        assert!(it.app.shown().outputs.run);
        it
    }

    fn stay(&mut self, height: f64, samples: u64) {
        let mut notices = Notices::new();
        for _ in 0..samples {
            let mut sample = sample(height);
            // A count of noise: one that stands still may be a sensor that does not work.
            let noise = (self.app.state().samples / 3 % 2) as u16;
            sample.counts = sample.counts.map(|count| count + noise);
            self.app
                .take(&mut self.board, &sample, false, 0, &mut notices);
            self.recorder.take(&sample, &notices);
        }
    }

    /// The log of another power-on.
    fn cycle(&mut self) {
        let flash = W25q::try_new(self.bus.clone(), NoDelay).expect("it answers");
        self.log = mounted(flash);
    }

    fn server(&self) -> Server {
        Server::new("0.1.0", RATE as f32, self.key)
    }

    fn kept(&mut self) -> Kept {
        Kept {
            shown: self.app.shown(),
            faults: self.app.faults(),
            block: self.board.0.clone(),
            counters: self.log.lifetime(),
            flash: touchdown_core::checksum::CRC.checksum(&self.bus.0.borrow().bytes),
        }
    }

    fn say(&mut self, server: &mut Server, frame: &[u8]) -> Option<Reply> {
        let mut decoder = Decoder::default();
        let mut answer = None;
        for byte in frame {
            for byte in server.take(*byte, self).iter().flatten() {
                let said = decoder.take::<Reply>(*byte);
                answer = said
                    .map(|it| it.expect("a whole answer").message)
                    .or(answer);
            }
        }
        answer
    }

    fn frame(&mut self, request: &Request) -> Vec<u8> {
        self.sequence = self.sequence.wrapping_add(1);
        encode(self.sequence, request).expect("room").to_vec()
    }

    fn ask(&mut self, server: &mut Server, request: &Request) -> Reply {
        let frame = self.frame(request);
        self.say(server, &frame).expect("an answer")
    }

    fn nonce(&mut self, server: &mut Server) -> Nonce {
        match self.ask(server, &Request::Challenge) {
            Reply::Challenge(nonce, keyed) => {
                assert_eq!(keyed, self.key.is_some());
                nonce
            }
            other => panic!("{other:?}"),
        }
    }

    /// By the right of `key`.
    fn order(&mut self, server: &mut Server, act: Act, key: Option<&Key>) -> Reply {
        let nonce = self.nonce(server);
        let mac = mac(key, &nonce, &act, &[]);
        self.ask(server, &Request::Order { mac, act })
    }

    /// Stages and commits.
    fn set(&mut self, server: &mut Server, wanted: &Settings, key: Option<&Key>) -> Reply {
        let block = config_block::encode(wanted);
        let staged = self.ask(server, &Request::Stage(block.clone()));
        assert_eq!(staged, Reply::Config(blanked(&block, wanted.key.is_some())));
        let act = Act::Commit(u32::from_le_bytes(*block.last_chunk().expect("a checksum")));
        let nonce = self.nonce(server);
        let mac = mac(key, &nonce, &act, &block);
        self.ask(server, &Request::Order { mac, act })
    }
}

impl Device for Controller {
    fn state(&mut self) -> State {
        let mut state = self.app.report(0, 0);
        state.sample = state.sample.wrapping_add(self.waited);
        state
    }

    fn config(&mut self) -> Block {
        self.board.0.clone()
    }

    fn service(&mut self) -> bool {
        self.service
    }

    fn ordered(&mut self, notice: &Notice) {
        let Notice::Ordered(ordered) = notice else {
            panic!("{notice:?}");
        };
        self.told.push(*ordered);
        self.recorder.hear(notice);
    }

    fn set_config(&mut self, block: &[u8], _: &Settings) -> Result<(), Refusal> {
        self.app.may_restart()?;
        self.board.0 = Block::from_slice(block).expect("room");
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Refusal> {
        Ok(self.app.clear()?)
    }

    fn recent(&mut self, step: u16) -> Recent {
        self.recorder.recent(step)
    }

    fn log(&mut self) -> Option<&mut impl Log> {
        Some(&mut self.log)
    }
}

const NO_RIGHT: Reply = Reply::Refused(Refusal::Busy(Busy::NoRight));
const SERVICE: Reply = Reply::Refused(Refusal::Busy(Busy::Service));

fn refused(busy: Busy) -> Reply {
    Reply::Refused(busy.into())
}

#[test]
fn without_a_key_it_obeys_only_while_the_service_input_is_on() {
    let mut it = Controller::lying(None);
    let mut server = it.server();
    let before = it.kept();
    for act in [Act::Clear, Act::Erase(1), Act::Lock(1), Act::Unlock(1)] {
        assert_eq!(it.order(&mut server, act, None), SERVICE);
    }
    let mut wanted = settings(None);
    wanted.wiring.levitation = true;
    assert_eq!(it.set(&mut server, &wanted, None), SERVICE);
    assert_eq!(it.kept(), before);
    it.service = true;
    // A key that it does not have gives no right.
    assert_eq!(it.order(&mut server, Act::Clear, Some(&KEY)), NO_RIGHT);
    assert_eq!(it.kept(), before);
    assert_eq!(it.order(&mut server, Act::Lock(1), None), Reply::Done);
    assert_eq!(it.order(&mut server, Act::Erase(2), None), Reply::Done);
    assert_eq!(it.set(&mut server, &wanted, None), Reply::Done);
    assert_eq!(it.board.0, config_block::encode(&wanted));
    assert_eq!(it.order(&mut server, Act::Clear, None), Reply::Done);
    assert_eq!(it.app.faults(), Faults::NONE);
}

#[test]
fn with_a_key_only_its_answer_to_an_open_nonce_in_time_gives_the_right() {
    let mut it = Controller::lying(Some(KEY));
    let mut server = it.server();
    let before = it.kept();
    let act = Act::Erase(2);
    // The service input stands in for no key.
    it.service = true;
    assert_eq!(it.order(&mut server, act, None), NO_RIGHT);
    it.service = false;
    assert_eq!(it.order(&mut server, act, Some(&Key([1; 16]))), NO_RIGHT);
    // No nonce was given.
    let order = |mac: Mac| Request::Order { mac, act };
    let right = |nonce: &Nonce| mac(Some(&KEY), nonce, &act, &[]);
    assert_eq!(it.ask(&mut server, &order([7; 16])), NO_RIGHT);
    // Too late by a sample.
    let nonce = it.nonce(&mut server);
    it.waited += GOOD + 1;
    assert_eq!(it.ask(&mut server, &order(right(&nonce))), NO_RIGHT);
    // Used up by a wrong answer.
    let nonce = it.nonce(&mut server);
    let mut wrong = right(&nonce);
    wrong[15] ^= 1;
    assert_eq!(it.ask(&mut server, &order(wrong)), NO_RIGHT);
    assert_eq!(it.ask(&mut server, &order(right(&nonce))), NO_RIGHT);
    // For another order.
    let nonce = it.nonce(&mut server);
    let mac = right(&nonce);
    let act = Act::Erase(3);
    assert_eq!(it.ask(&mut server, &Request::Order { mac, act }), NO_RIGHT);
    // One at a time: after half its time another one takes its place.
    let nonce = it.nonce(&mut server);
    it.waited += GOOD / 2;
    assert_eq!(it.nonce(&mut server), nonce);
    it.waited += 1;
    assert_ne!(it.nonce(&mut server), nonce);
    assert_eq!(it.ask(&mut server, &order(right(&nonce))), NO_RIGHT);
    assert_eq!(it.kept(), before);
    // In the last sample of its time.
    let nonce = it.nonce(&mut server);
    it.waited += GOOD;
    assert_eq!(it.ask(&mut server, &order(right(&nonce))), Reply::Done);
    assert_ne!(it.kept(), before);
}

#[test]
fn an_order_whose_answer_was_lost_has_the_same_answer_and_is_done_once() {
    let mut it = Controller::lying(Some(KEY));
    let mut server = it.server();
    let act = Act::Erase(2);
    let nonce = it.nonce(&mut server);
    let mac = mac(Some(&KEY), &nonce, &act, &[]);
    let frame = it.frame(&Request::Order { mac, act });
    assert_eq!(it.say(&mut server, &frame), Some(Reply::Done));
    let after = it.kept();
    assert_eq!(it.say(&mut server, &frame), Some(Reply::Done));
    assert_eq!((it.kept(), it.told.len()), (after, 1));
    // A copy of the other order's right is none.
    assert_eq!(
        it.order(&mut server, Act::Erase(2), Some(&KEY)),
        Reply::Refused(Refusal::NoEpisode)
    );
    assert_eq!(it.say(&mut server, &frame), Some(NO_RIGHT));
}

#[test]
fn nonces_never_repeat_across_power_cycles() {
    let mut seen = std::collections::HashSet::new();
    let mut it = Controller::lying(Some(KEY));
    for _ in 0..20 {
        let mut server = it.server();
        for _ in 0..20 {
            assert!(seen.insert(it.nonce(&mut server)));
            it.order(&mut server, Act::Clear, None);
        }
        it.cycle();
    }
}

#[test]
fn while_it_runs_nothing_is_erased_or_set() {
    let mut it = Controller::watching(Some(KEY));
    let mut server = it.server();
    let before = it.kept();
    let watching = refused(Busy::Watching);
    assert_eq!(it.order(&mut server, Act::Erase(1), Some(&KEY)), watching);
    assert_eq!(it.set(&mut server, &settings(None), Some(&KEY)), watching);
    assert_eq!(it.kept(), before);
    // To keep an episode stops nothing.
    assert_eq!(it.order(&mut server, Act::Lock(1), Some(&KEY)), Reply::Done);
    assert!(it.app.shown().outputs.run);
}

#[test]
fn a_locked_episode_and_the_newest_one_are_not_erased() {
    let mut it = Controller::lying(Some(KEY));
    let mut server = it.server();
    let mut order = |act| it.order(&mut server, act, Some(&KEY));
    assert_eq!(order(Act::Lock(2)), Reply::Done);
    assert_eq!(order(Act::Erase(2)), refused(Busy::Locked));
    assert_eq!(order(Act::Erase(4)), refused(Busy::Last));
    assert_eq!(order(Act::Lock(9)), Reply::Refused(Refusal::NoEpisode));
    assert_eq!(order(Act::Erase(9)), Reply::Refused(Refusal::NoEpisode));
    assert_eq!(order(Act::Lock(3)), Reply::Done);
    assert_eq!(order(Act::Lock(4)), Reply::Refused(Refusal::NoRoom));
    assert_eq!(order(Act::Unlock(2)), Reply::Done);
    assert_eq!(order(Act::Erase(2)), Reply::Done);
    let told: Vec<_> = it.told.iter().map(|it| it.refused).collect();
    assert_eq!(told, [0, 7, 8, 21, 21, 0, 22, 0, 0]);
    for (ordered, code) in it.told.iter().zip(told) {
        let record = Record::Notice(Notice::Ordered(*ordered));
        assert_eq!(decode_record(&encode_record(&record)), Some(record));
        assert_eq!(Refusal::of_code(code).map_or(0, |it| it.code()), code);
    }
}

#[test]
fn a_configuration_keeps_the_key_that_it_does_not_name_and_none_is_read_back() {
    let mut it = Controller::lying(Some(KEY));
    let mut server = it.server();
    let mut wanted = settings(Some(Key::HELD));
    wanted.wiring.levitation = true;
    assert_eq!(it.set(&mut server, &wanted, Some(&KEY)), Reply::Done);
    wanted.key = Some(KEY);
    assert_eq!(it.board.0, config_block::encode(&wanted));
    let Reply::Config(block) = it.ask(&mut server, &Request::ReadConfig) else {
        panic!("no configuration");
    };
    wanted.key = Some(Key::HELD);
    assert_eq!(config_block::decode(&block), Ok((&*block, wanted)));
    // Another one, by the right of the old one.
    let another = Some(Key([3; 16]));
    assert_eq!(
        it.set(&mut server, &settings(another), another.as_ref()),
        NO_RIGHT
    );
    assert_eq!(
        it.set(&mut server, &settings(another), Some(&KEY)),
        Reply::Done
    );
    assert_eq!(it.board.0, config_block::encode(&settings(another)));
}

#[test]
fn what_is_staged_is_not_in_force_and_another_block_of_its_checksum_has_no_right() {
    let mut it = Controller::lying(Some(KEY));
    let mut server = it.server();
    let before = it.kept();
    let wanted = config_block::encode(&settings(Some(Key::HELD)));
    it.ask(&mut server, &Request::Stage(wanted.clone()));
    assert_eq!(it.kept(), before);
    let act = Act::Commit(u32::from_le_bytes(
        *wanted.last_chunk().expect("a checksum"),
    ));
    let nonce = it.nonce(&mut server);
    let mac = mac(Some(&KEY), &nonce, &act, &wanted);
    // Somebody on the line stages another one in between.
    let mut other = settings(Some(Key::HELD));
    other.monitor.guard.danger = 0.9;
    it.ask(&mut server, &Request::Stage(config_block::encode(&other)));
    assert_eq!(it.ask(&mut server, &Request::Order { mac, act }), NO_RIGHT);
    assert_eq!(it.kept(), before);
    // Nothing is staged after a start.
    let mut server = it.server();
    assert_eq!(
        it.order(&mut server, act, Some(&KEY)),
        Reply::Refused(Refusal::Block)
    );
}

#[test]
fn an_order_in_a_drop_stands_in_its_episode_done_or_not() {
    let mut it = Controller::lying(Some(KEY));
    let mut server = it.server();
    let mut number = 0;
    let mut declare = |it: &mut Controller, kind: EventKind| {
        let mut notice = Rig::switched_on(RATE as f32, 1).declared(kind);
        if let Notice::Declared(event) = &mut notice {
            number += 1;
            event.number = number;
        }
        it.recorder.take(&sample(-1.0), &[notice]);
    };
    declare(&mut it, EventKind::FreeFall);
    assert_eq!(it.order(&mut server, Act::Clear, None), NO_RIGHT);
    assert_eq!(it.order(&mut server, Act::Lock(1), Some(&KEY)), Reply::Done);
    (0..2 * RATE).for_each(|_| it.recorder.take(&sample(-1.0), &[]));
    let mut found = vec![];
    while let Some(block) = it.recorder.fetch() {
        if block.kind() == touchdown_protocol::log::block::Kind::Events {
            let (records, _) = block.payload().as_chunks();
            found.extend(records.iter().filter_map(decode_record));
        }
    }
    let told: Vec<_> = it
        .told
        .iter()
        .map(|it| Record::Notice(Notice::Ordered(*it)))
        .collect();
    assert_eq!(told.len(), 2);
    assert!(told.iter().all(|it| found.contains(it)), "{found:?}");
}

#[test]
fn after_a_clear_it_runs_only_with_a_new_proof() {
    let mut it = Controller::new(None, Faults::NONE);
    it.app.assume_lift();
    it.stay(0.0, 2_100);
    assert_eq!(it.app.shown().mode, Mode::Watching);
    it.stay(-1.0, 100);
    assert_eq!(it.app.shown().mode, Mode::Dropped);
    it.stay(-1.0, 2 * RATE);
    it.service = true;
    let mut server = it.server();
    assert_eq!(it.order(&mut server, Act::Clear, None), Reply::Done);
    for number in 0..RATE {
        it.stay((number as f64 / 2_000.0 - 1.0).min(0.0), 1);
        let Shown {
            outputs,
            mode,
            cause,
        } = it.app.shown();
        if outputs.run {
            assert_eq!((mode, cause), (Mode::Watching, None));
            return;
        }
        assert!(
            matches!(cause, Some(Cause::Order | Cause::NoProof)),
            "{cause:?}"
        );
    }
    panic!("it never runs again");
}

/// What somebody on the line can send who has no key.
fn attack(it: &mut Controller, server: &mut Server, recorded: &[Vec<u8>], seed: &mut u64) {
    let mut pick = |most: u64| random(seed) % most;
    let act = match pick(5) {
        0 => Act::Clear,
        1 => Act::Commit(pick(1 << 32) as u32),
        2 => Act::Erase(pick(6) as u32),
        3 => Act::Lock(pick(6) as u32),
        _ => Act::Unlock(pick(6) as u32),
    };
    let mut wrong = settings(None);
    wrong.monitor.guard.danger = 0.9;
    let kind = pick(8);
    let mut mac_given: Mac = [0; 16];
    mac_given.fill_with(|| pick(256) as u8);
    let frame = match kind {
        0 | 1 if !recorded.is_empty() => recorded[pick(recorded.len() as u64) as usize].clone(),
        2 if !recorded.is_empty() => {
            let mut frame = recorded[pick(recorded.len() as u64) as usize].clone();
            let byte = pick(frame.len() as u64) as usize;
            frame[byte] ^= 1 << pick(8);
            frame.push(0);
            frame
        }
        3 => it.frame(&Request::Challenge),
        4 => it.frame(&Request::Stage(config_block::encode(&wrong))),
        5 => {
            let nonce = it.nonce(server);
            let key = [None, Some(Key(mac_given))][pick(2) as usize];
            let mac = mac(key.as_ref(), &nonce, &act, &[]);
            it.frame(&Request::Order { mac, act })
        }
        6 => {
            it.waited += pick(2 * GOOD);
            vec![0]
        }
        _ => it.frame(&Request::Order {
            mac: mac_given,
            act,
        }),
    };
    it.say(server, &frame);
}

/// Frames of a session in which everything was ordered by right, answers apart.
fn recorded(key: Option<Key>, service: bool) -> Vec<Vec<u8>> {
    let mut it = Controller::lying(key);
    it.service = service;
    let mut server = it.server();
    let mut frames = vec![];
    let staged = config_block::encode(&settings(key.map(|_| Key::HELD)));
    let checksum = u32::from_le_bytes(*staged.last_chunk().expect("a checksum"));
    let acts = [
        Act::Lock(1),
        Act::Erase(2),
        Act::Clear,
        Act::Commit(checksum),
    ];
    for act in acts {
        let block = if matches!(act, Act::Commit(_)) {
            &staged[..]
        } else {
            &[]
        };
        frames.push(it.frame(&Request::Stage(staged.clone())));
        it.say(&mut server, frames.last().expect("one"));
        frames.push(it.frame(&Request::Challenge));
        let Some(Reply::Challenge(nonce, _)) = it.say(&mut server, frames.last().expect("one"))
        else {
            panic!("no nonce");
        };
        let mac = mac(key.as_ref(), &nonce, &act, block);
        frames.push(it.frame(&Request::Order { mac, act }));
        let done = it.say(&mut server, frames.last().expect("one"));
        assert_eq!(done, Some(Reply::Done), "{act:?}");
    }
    frames
}

#[test]
fn a_thousand_random_and_replayed_sequences_without_a_right_change_nothing() {
    // Whether it has a key, and its service input is on in the recorded session and in the attacked one.
    let cases = [
        (Some(KEY), false, false),
        (Some(KEY), true, true),
        (None, true, false),
    ];
    let mut told = 0;
    for (number, (key, before, now)) in cases.into_iter().enumerate() {
        let recorded = recorded(key, before);
        let mut it = Controller::lying(key);
        // Another session: it was switched on once more.
        it.cycle();
        it.service = now;
        let kept = it.kept();
        for sequence in 0..334 {
            let mut server = it.server();
            let mut seed = 1_000 * (1 + number as u64) + sequence;
            for _ in 0..30 {
                attack(&mut it, &mut server, &recorded, &mut seed);
            }
            assert_eq!(it.kept(), kept, "case {number}, sequence {sequence}");
        }
        assert!(it.told.iter().all(|it| it.refused != 0));
        told += it.told.len();
    }
    println!("{told} orders refused");
    assert!(told > 5_000);
}

#[test]
fn frames_of_one_session_change_nothing_in_another_even_with_the_service_input_on() {
    for key in [None, Some(KEY)] {
        let recorded = recorded(key, true);
        let mut it = Controller::lying(key);
        it.cycle();
        it.service = true;
        let mut server = it.server();
        let kept = it.kept();
        for frame in recorded.iter().chain(&recorded) {
            it.say(&mut server, frame);
        }
        assert_eq!(it.kept(), kept);
        assert_eq!(it.told.len(), 8);
    }
}
