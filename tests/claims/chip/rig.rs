//! The emulated rig: the firmware's image over its link, from power-on to an erased log, and what it does
//! when the supply, the link or a sensor fails.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::io::{Sink, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{Key, Settings};
use touchdown_protocol::controller::{Busy, Cause, Fault, Mode};
use touchdown_core::event::{Act, EventKind, Notice};
use touchdown_protocol::link::{Refusal, State};
use touchdown_protocol::log::reader::Verdict;
use touchdown_files::drop_log::{Dump, Episode};
use touchdown_files::link::{Client, LinkError, Told};
use touchdown_run::drop;
use touchdown_run::emulator::Emulator;
use touchdown_run::target::Target;
use touchdown_scene::Scene;
use touchdown_scene::sensors::{Failing, SensorFault};
use touchdown_sim::rig::{Options, Order, Rig};

/// Far more than anything here takes.
const LONG: Duration = Duration::from_secs(120);

fn started(scene: &str, folder: &Path, noise: f64) -> Rig {
    let scene = Scene::load(scene).expect("built-in scene");
    let emulator = Emulator::find(None).unwrap_or_else(|error| panic!("{error}"));
    let options = Options {
        folder: folder.to_owned(),
        port: 0,
        noise,
        fast: true,
    };
    Rig::start(scene, emulator, options).expect("starts")
}

fn talk(rig: &Rig) -> Client {
    patient(TcpStream::connect(rig.address).expect("the rig listens"))
}

fn patient(line: TcpStream) -> Client {
    line.set_nodelay(true).expect("a socket");
    Client::patient(Box::new(line))
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < LONG, "not within {LONG:?}: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The state once `holds`.
fn state_when(talk: &mut Client, what: &str, holds: impl Fn(&State) -> bool) -> State {
    let mut state = State::default();
    until(what, || {
        state = talk.state().expect("answers");
        holds(&state)
    });
    state
}

/// Number of the newest episode that is closed, 0 for none.
fn newest(talk: &mut Client) -> u32 {
    talk.episodes().expect("answers").map_or(0, |it| it.1)
}

fn fetched(talk: &mut Client, number: u32) -> Vec<u8> {
    let bytes = talk.episode(number, |_, _| ()).expect("comes in the end");
    bytes.expect("is there")
}

fn refused(talk: &mut Client, block: &[u8]) -> Refusal {
    let block = config_block::Block::from_slice(block).expect("fits");
    match talk.set_block(&block) {
        Err(LinkError::Refused(why)) => why,
        other => panic!("{other:?}"),
    }
}

fn settings_in_force(talk: &mut Client) -> Settings {
    talk.settings().expect("a valid configuration")
}

/// Switches the service input on, and waits until the image has seen it.
fn serve(rig: &Rig, talk: &mut Client) {
    rig.order(Order::Service(true));
    until("the service input is seen", || {
        !matches!(
            talk.order(Act::Erase(u32::MAX)),
            Err(LinkError::Refused(Refusal::Busy(Busy::Service)))
        )
    });
}

/// Since the last call.
fn events_heard(talk: &mut Client) -> Vec<EventKind> {
    let told = std::iter::from_fn(|| talk.listen(Duration::ZERO).expect("a line"));
    let events = told.filter_map(|told| match told {
        Told::Notice(Notice::Declared(event)) => Some(event.kind),
        _ => None,
    });
    events.collect()
}

#[test]
fn from_power_on_to_an_erased_log_over_the_link() {
    let folder = TempDir::new().expect("a folder");
    let rig = started("rig", folder.path(), 0.0);
    let mut talk = talk(&rig);
    assert_eq!(talk.hello().expect("answers").sample_rate, 20_000.0);
    // It lies: self-test, then permit to lift.
    let state = state_when(&mut talk, "permit", |it| it.outputs.permit);
    assert_eq!((state.mode, state.outputs.bits()), (Mode::Arming, 0b0110));

    let before = settings_in_force(&mut talk);
    assert_eq!(refused(&mut talk, &[1, 2, 3]), Refusal::Block);
    let mut settings = before;
    settings.monitor.detector.machine.clearance = -1.0;
    let why = refused(&mut talk, &config_block::encode(&settings));
    assert_eq!(why, Refusal::parameter("clearance"));
    settings.monitor.detector.machine.clearance = 0.31e-3;
    // Without a key it takes the service input.
    let why = refused(&mut talk, &config_block::encode(&settings));
    assert_eq!(why, Refusal::Busy(Busy::Service));
    assert_eq!(rig.starts(), 1);
    serve(&rig, &mut talk);
    talk.set_block(&config_block::encode(&settings)).expect("is taken");
    until("a restart", || rig.starts() == 2);
    assert_eq!(settings_in_force(&mut talk), settings);

    rig.order(Order::Lift);
    state_when(&mut talk, "watching, and armed", |it| it.outputs.ready);
    let why = refused(&mut talk, &config_block::encode(&before));
    assert_eq!(why, Refusal::Busy(Busy::Watching));
    // Lying is a contact, and so recorded too, after each of the two starts.
    let lying = newest(&mut talk);
    events_heard(&mut talk);
    rig.order(Order::Drop);
    let state = state_when(&mut talk, "the drop", |it| it.mode == Mode::Dropped);
    assert_eq!(state.outputs.bits() & 0b1011, 0);
    // It lies again: 1 s after the last notice the episode is closed.
    until("the episode", || newest(&mut talk) > lying);
    let heard = events_heard(&mut talk);
    assert_eq!(heard[0], EventKind::FreeFall);
    assert!(heard.contains(&EventKind::Impact), "{heard:?}");

    let number = newest(&mut talk);
    let fetched = fetched(&mut talk, number);
    let episode = Episode::of(&fetched);
    assert_eq!(episode.verdict, Verdict::Whole);
    assert_eq!(episode.samples.iter().flatten().count(), 4_450);
    let logged: Vec<_> = episode.events.iter().map(|it| it.event).collect();
    assert_eq!(logged[..], heard[..logged.len()]);
    // The same as the host's reader sees in the flash.
    let flash = Dump::of(&fs::read(folder.path().join("log")).expect("the flash"));
    let stored = flash.episodes.iter().find(|it| it.sequence == number);
    assert_eq!(stored.expect("is there").report, episode.report);
    // It lay there at both starts, and landed once, even if it has begun to roll since; an episode that a restart cut off
    // may count besides.
    let counters = flash.counters.expect("counters");
    assert_eq!(counters.landings - counters.unweighed, 1);

    let (first, last) = talk.episodes().expect("answers").expect("some");
    let because = |result: Result<(), LinkError>| match result {
        Err(LinkError::Refused(why)) => why,
        other => panic!("{other:?}"),
    };
    talk.order(Act::Lock(first)).expect("is locked");
    assert_eq!(because(talk.order(Act::Erase(first))), Busy::Locked.into());
    talk.order(Act::Unlock(first)).expect("is free again");
    for episode in first..last {
        talk.order(Act::Erase(episode)).expect("is erased");
    }
    assert_eq!(because(talk.order(Act::Erase(last))), Busy::Last.into());
    assert_eq!(talk.episodes().expect("answers"), Some((last, last)));
    assert_eq!(because(talk.order(Act::Erase(first))), Refusal::NoEpisode);
    rig.order(Order::Service(false));
    until("the service input is off", || {
        talk.order(Act::Unlock(last)).is_err()
    });
    assert_eq!(because(talk.order(Act::Erase(last))), Busy::Service.into());
    assert_eq!(talk.damaged, 0);
    rig.stop().expect("no failure");
}

#[test]
fn with_a_key_the_image_obeys_its_holder_alone_and_tells_every_order() {
    let folder = TempDir::new().expect("a folder");
    let rig = started("rig", folder.path(), 0.0);
    let mut talk = talk(&rig);
    let key = Key(*b"sixteen letters.");
    let mut settings = settings_in_force(&mut talk);
    settings.key = Some(key);
    serve(&rig, &mut talk);
    talk.set_block(&config_block::encode(&settings)).expect("is taken");
    until("a restart", || rig.starts() == 2);
    // The key is in force, and not told.
    assert_eq!(settings_in_force(&mut talk).key, Some(Key::HELD));
    let stored = fs::read(folder.path().join("settings")).expect("the block");
    assert_eq!(stored, config_block::encode(&settings).to_vec());
    // The service input stands in for no key.
    let no_right = |result| {
        matches!(result, Err(LinkError::Refused(Refusal::Busy(Busy::NoRight))))
    };
    until("the first sample", || talk.state().is_ok_and(|it| it.sample != u64::MAX));
    assert!(no_right(talk.order(Act::Clear)));
    talk.key = Some(Key([1; 16]));
    assert!(no_right(talk.order(Act::Clear)));
    talk.key = Some(key);
    until("it is cleared", || talk.order(Act::Clear).is_ok());
    talk.state().expect("answers");
    let told = std::iter::from_fn(|| talk.listen(Duration::ZERO).expect("a line"));
    let orders: Vec<_> = told
        .filter_map(|told| match told {
            Told::Notice(Notice::Ordered(it)) if it.act == Act::Clear => Some(it.refused),
            _ => None,
        })
        .collect();
    let no_right = Refusal::Busy(Busy::NoRight).code();
    assert_eq!(orders[..2], [no_right; 2]);
    assert_eq!(orders.last(), Some(&0));
    // A file without a key keeps it.
    settings.key = Some(Key::HELD);
    settings.wiring.levitation = true;
    talk.set_block(&config_block::encode(&settings)).expect("is taken");
    until("a restart", || rig.starts() == 3);
    settings.key = Some(key);
    let stored = fs::read(folder.path().join("settings")).expect("the block");
    assert_eq!(stored, config_block::encode(&settings).to_vec());
    rig.stop().expect("no failure");
}

fn kinds(episode: &Episode) -> Vec<EventKind> {
    episode.events.iter().map(|it| it.event).collect()
}

/// Pages of the slot of the newest episode that are not erased.
fn pages_of_the_newest(flash: &[u8]) -> (u32, usize) {
    let dump = Dump::of(flash);
    let newest = dump.episodes.last();
    newest.map_or((0, 0), |it| (it.sequence, it.report.blocks as usize))
}

#[test]
fn brown_out_while_logging_leaves_earlier_episodes_whole_and_the_new_one_whole_or_marked() {
    let folder = TempDir::new().expect("a folder");
    let rig = started("rig", folder.path(), 0.0);
    let flash = || fs::read(folder.path().join("log")).unwrap_or_default();
    let mut talk = talk(&rig);
    talk.hello().expect("answers");
    let mut whole: BTreeMap<u32, Vec<EventKind>> = BTreeMap::new();
    let (mut open, mut counted) = (0, 0);
    let cuts = [1, 3, 10, 40, 90, 140, 154, 166];
    for (number, pages) in (2..).zip(cuts) {
        rig.order(Order::Lift);
        state_when(&mut talk, "watching, and armed", |it| it.outputs.ready);
        let (before, _) = pages_of_the_newest(&flash());
        rig.order(Order::Drop);
        until("pages of a new episode", || {
            let (newest, right) = pages_of_the_newest(&flash());
            newest > before && right >= pages
        });
        rig.order(Order::Cut);
        until("power", || rig.starts() == number);
        let now = Dump::of(&flash());
        let damaged = |it: &&Episode| it.verdict == Verdict::Damaged;
        assert_eq!(now.episodes.iter().filter(damaged).count(), 0);
        open +=
            usize::from(now.episodes.last().expect("the new one").verdict == Verdict::Incomplete);
        // It has 8 slots: the newest six are there, those that were whole just as they were.
        let last = now.episodes.last().expect("the new one").sequence;
        for (sequence, events) in whole.range(last.saturating_sub(5)..) {
            let kept = now.episodes.iter().find(|it| it.sequence == *sequence);
            let kept = kept.unwrap_or_else(|| panic!("episode {sequence} is gone"));
            assert_eq!(kept.verdict, Verdict::Whole);
            assert_eq!(kinds(kept), *events);
        }
        for it in now
            .episodes
            .iter()
            .filter(|it| it.verdict == Verdict::Whole)
        {
            whole.insert(it.sequence, kinds(it));
        }
        // Counted at the next start, however it was cut off.
        let state = state_when(&mut talk, "a first sample", |it| it.sample < 1 << 40);
        assert_eq!(state.faults.0, 0);
        until("the counters", || {
            let counters = Dump::of(&flash()).counters;
            let landings = counters.map_or(0, |it| it.landings);
            assert!(landings >= counted, "counters went backwards");
            counters.is_some_and(|it| it.boots == number) && {
                counted = landings;
                true
            }
        });
        // The drop outlives the power. At rest it is cleared, to be lifted again.
        let state = state_when(&mut talk, "permit", |it| it.outputs.permit);
        assert_eq!(state.mode, Mode::Dropped);
        serve(&rig, &mut talk);
        // While it still records, the order is refused.
        until("it is cleared", || talk.order(Act::Clear).is_ok());
        state_when(&mut talk, "permit again", |it| it.mode == Mode::Arming && it.outputs.permit);
    }
    println!(
        "{} cuts, {open} of them in the middle of an episode; {counted} landings",
        cuts.len()
    );
    assert!(open >= cuts.len() / 2, "only {open} cuts hit an episode");
    rig.stop().expect("no failure");
}

#[test]
fn a_noisy_link_is_asked_again_and_never_touches_the_outputs() {
    let folder = TempDir::new().expect("a folder");
    let rig = started("rig", folder.path(), 0.0);
    let mut talk = talk(&rig);
    rig.order(Order::Lift);
    let quiet = state_when(&mut talk, "watching, and armed", |it| it.outputs.ready);
    rig.order(Order::Noise(0.02));
    for _ in 0..20 {
        talk.hello().expect("answers in the end");
        let state = talk.state().expect("answers in the end");
        assert_eq!((state.mode, state.outputs), (quiet.mode, quiet.outputs));
    }
    assert!(talk.damaged > 0 && talk.repeated > 0);
    // An episode, a byte in two thousand spoilt.
    rig.order(Order::Noise(5e-4));
    rig.order(Order::Drop);
    state_when(&mut talk, "the drop", |it| it.mode == Mode::Dropped);
    let before = newest(&mut talk);
    until("the episode", || newest(&mut talk) > before);
    let number = newest(&mut talk);
    let episode = Episode::of(&fetched(&mut talk, number));
    assert_eq!(episode.verdict, Verdict::Whole);
    // Nothing but noise.
    rig.order(Order::Noise(1.0));
    let mut line = TcpStream::connect(rig.address).expect("the rig listens");
    line.write_all(&[0x55; 200]).expect("is read");
    rig.order(Order::Noise(0.0));
    let mut talk = patient(line);
    let state = talk.state().expect("answers");
    assert!(state.counters.damaged_frames > 0);
    assert_eq!(state.faults.0, 0);
    assert_eq!(rig.starts(), 1);
    println!(
        "{} frames came damaged to the image",
        state.counters.damaged_frames
    );
    rig.stop().expect("no failure");
}

#[test]
fn sensors_that_are_lost_at_the_rig_trip_and_are_told() {
    let folder = TempDir::new().expect("a folder");
    let rig = started("rig", folder.path(), 0.0);
    let mut talk = talk(&rig);
    rig.order(Order::Lift);
    state_when(&mut talk, "watching, and armed", |it| it.outputs.ready);
    // One channel: nobody sees its end.
    rig.order(Order::Spoil(0, Failing::Dropped));
    let told = |talk: &mut Client| {
        talk.state().expect("answers");
        events_heard(talk).contains(&EventKind::SensorFault)
    };
    until("the fault is told", || told(&mut talk));
    let state = state_when(&mut talk, "a trip", |it| it.mode == Mode::Faulted);
    assert_eq!(state.outputs.bits(), 0);
    assert!(state.faults.contains(Fault::SensorsLost));
    assert_eq!(state.cause, Some(Cause::PositionsLost));
    // Without any position an order to clear is refused.
    rig.order(Order::Spoil(2, Failing::Dropped));
    serve(&rig, &mut talk);
    let cleared = talk.order(Act::Clear);
    assert!(matches!(
        cleared,
        Err(LinkError::Refused(Refusal::Busy(Busy::Blind)))
    ));
    rig.order(Order::Repair);
    until("it is cleared", || talk.order(Act::Clear).is_ok());
    // It floats, but has not been seen where it is lifted from since.
    let state = state_when(&mut talk, "arming", |it| it.mode == Mode::Arming);
    assert_eq!(state.cause, Some(Cause::NoProof));
    rig.order(Order::Drop);
    state_when(&mut talk, "permit", |it| it.outputs.permit);
    rig.order(Order::Lift);
    state_when(&mut talk, "watching again", |it| it.outputs.ready);
    rig.stop().expect("no failure");
}

#[test]
fn a_stored_configuration_that_is_damaged_never_gives_current_until_another_is_set() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("settings"), b"TDC\x01 is not all").expect("a file");
    let rig = started("rig", folder.path(), 0.0);
    let mut talk = talk(&rig);
    rig.order(Order::Lift);
    // Far beyond self-test and arming.
    let state = state_when(&mut talk, "10 000 samples", |it| {
        assert_eq!(it.outputs.bits(), 0);
        it.sample > 10_000 && it.sample != u64::MAX
    });
    assert_eq!(state.mode, Mode::Faulted);
    assert!(state.faults.contains(Fault::ConfigDamaged));
    serve(&rig, &mut talk);
    assert!(matches!(
        talk.order(Act::Clear),
        Err(LinkError::Refused(Refusal::Busy(Busy::Configuration)))
    ));
    let settings = settings_in_force(&mut talk);
    talk.set_block(&config_block::encode(&settings)).expect("is taken");
    until("a restart", || rig.starts() == 2);
    rig.order(Order::Drop);
    state_when(&mut talk, "permit", |it| it.outputs.permit);
    rig.order(Order::Lift);
    state_when(&mut talk, "watching, and armed", |it| it.outputs.ready);
    rig.stop().expect("no failure");
}

/// One channel, from this time on, in the emulator.
#[test]
fn sensors_that_are_lost_in_the_emulator_trip_20_ticks_later() {
    let mut scene = Scene::load("rig").expect("built-in scene");
    let start = -0.02;
    scene.faults = vec![SensorFault {
        channel: 3,
        failing: Failing::Dropped,
        start,
        end: f64::INFINITY,
    }];
    let target = Target::Qemu(Emulator::find(None).unwrap_or_else(|error| panic!("{error}")));
    let (outcome, _) = drop::by_reference::<Sink>(&scene, &target, None).expect("drops");
    let conduct = &outcome.conduct;
    let safe = conduct.outputs.last().expect("a change");
    let lost = ((start + 0.2) * scene.run.sample_rate).round() as u64;
    assert_eq!((safe.sample, safe.shown.outputs.bits()), (lost + 19, 0));
    assert_eq!(conduct.state.mode, Mode::Faulted);
    assert!(conduct.state.faults.contains(Fault::SensorsLost));
}
