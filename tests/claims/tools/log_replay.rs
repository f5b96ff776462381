//! An episode of the drop log replays: from what the detector had learnt before it, it tells the same events.

use std::fs::{self, File};
use std::io::Sink;

use touchdown_protocol::log::learnt::{of_parts, part};
use touchdown_protocol::log::block::Kind;
use touchdown_protocol::log::header::Header;
use touchdown_core::event::EventKind;
use touchdown_core::monitor::MonitorState;
use touchdown_core::sensing::{Calibration, PlaneCalibration, Sensing};
use touchdown_files::drop_log::{Dump, Episode, comtrade, stream};
use touchdown_files::recording::{Reading, Recording};
use touchdown_files::stream::{of_field, to_field, to_sample, without_record};
use touchdown_run::drop;
use touchdown_run::outcome::DetectedEvent;
use touchdown_run::replay::{self, Orders};
use touchdown_run::target::Target;
use touchdown_scene::{BUILT_IN, Scene};
use touchdown_tests::binary::touchdown;
use touchdown_tests::even_rows::even_rows;

/// What adding times of different zeros may cost, s.
const ROUNDING: f64 = 1e-9;

/// The log after a drop, and what the controller told.
fn dropped(scene: &Scene) -> (Dump, Vec<DetectedEvent>) {
    let (outcome, _) = drop::by_reference::<Sink>(scene, &Target::Host, None).expect("drops");
    (Dump::of(&outcome.conduct.flash), outcome.detection.events)
}

/// What was told while the episode's samples were taken, the first of which gets number 0.
fn told(episode: &Episode, events: Vec<DetectedEvent>) -> Vec<DetectedEvent> {
    let header = episode.header.as_ref().expect("a header");
    let end = header.first + episode.samples.len() as u64;
    let taken = events
        .into_iter()
        .filter(|it| (header.first..end).contains(&it.sample));
    let from_first = taken.map(|it| DetectedEvent {
        sample: it.sample - header.first,
        ..it
    });
    from_first.collect()
}

fn replayed(episode: &Episode, scene: &Scene) -> Vec<DetectedEvent> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("e.csv");
    assert!(stream(episode, File::create(&path).expect("a file")).expect("is written"));
    replay::recording(&path, &Reading::default(), scene, &Target::Host, &Orders::default())
        .expect("replays")
        .detection
        .events
}

fn assert_same(name: &str, told: &[DetectedEvent], again: &[DetectedEvent]) {
    let kinds = |events: &[DetectedEvent]| -> Vec<_> { events.iter().map(|it| it.event).collect() };
    assert_eq!(kinds(again), kinds(told), "{name}");
    for (was, is) in told.iter().zip(again) {
        assert_eq!(was.sample, is.sample, "{name}: {was:?}");
        assert_eq!(was.normal_speed_m_s, is.normal_speed_m_s, "{name}: {was:?}");
        let [latency, again] = [was, is].map(|it| it.declared_s - it.onset_s);
        assert!((latency - again).abs() < ROUNDING, "{name}: {was:?} {is:?}");
    }
}

#[test]
fn every_built_in_scene_replays_as_it_was_told() {
    for built_in in BUILT_IN {
        let name = built_in.name;
        let scene = Scene::load(name).expect("built-in scene");
        let (dump, events) = dropped(&scene);
        let episode = dump.episodes.first().expect("an episode");
        let told = told(episode, events);
        let replayed = replayed(episode, &scene);
        let from = if episode.learnt.is_some() {
            "learnt"
        } else {
            "cold"
        };
        println!("{name}: {} events, {from}", told.len());
        assert!(!told.is_empty(), "{name}");
        assert_same(name, &told, &replayed);
    }
}

/// Sensors told wrong, turned and skewed, with a commissioning check on record.
fn checked() -> Scene {
    let mut scene = Scene::load("rig").expect("built-in scene");
    let plane = |zero: [f32; 2], gain: [f32; 2], skew: f32| PlaneCalibration { zero, gain, skew };
    let planes = [
        plane([15e-6, -9e-6], [1.12, 0.91], 0.04),
        plane([-12e-6, 6e-6], [0.88, 1.05], -0.03),
    ];
    let sensors = &mut scene.sensors;
    sensors.mounting_angle = [0.6, -1.1];
    sensors.skew = planes.map(|it| f64::from(it.skew));
    for (channel, error) in sensors.gain_error.iter_mut().enumerate() {
        let plane = &planes[channel / 2];
        *error = f64::from(plane.gain[channel % 2]) - 1.0;
        sensors.offset[channel] = plane.zero[channel % 2].into();
    }
    sensors.calibration = Some(Calibration {
        date: 20_261_123,
        planes,
    });
    scene
}

#[test]
fn an_episode_shows_what_the_monitor_read_with_its_record() {
    let scene = checked();
    let (dump, events) = dropped(&scene);
    let episode = &dump.episodes[0];
    let mut out = Vec::new();
    assert!(stream(episode, &mut out).expect("is written"));
    let sensing = Sensing::try_new(&scene.sensors.sensing()).expect("valid");
    let (rows, _) = even_rows("e.csv", &out).expect("a stream");
    let mut seen = 0;
    for (row, counts) in rows.zip(&episode.samples) {
        let shown = row.expect("a row").positions;
        let read = sensing.place(counts.expect("recorded").map(|it| Some(f32::from(it))));
        let read = read.map(|it| it.expect("both channels").map(f64::from));
        for (shown, read) in shown.into_iter().zip(read.concat()) {
            assert!((shown - read).abs() < 1e-12, "{shown} {read}");
            seen += 1;
        }
    }
    assert!(seen > 10_000, "{seen}");
    assert!(episode.learnt.is_some());
    assert_same("checked", &told(episode, events), &replayed(episode, &scene));
}

/// The export as COMTRADE: zero and gain of each channel, the skew not.
#[test]
fn channels_of_an_exported_record_are_displacements_along_their_axes() {
    let scene = checked();
    let (dump, _) = dropped(&scene);
    let [cfg, _] = comtrade(&dump.episodes[0]).expect("a header");
    let sensors = &scene.sensors;
    for (channel, line) in cfg.lines().skip(2).take(4).enumerate() {
        let field = |at: usize| -> f64 { line.split(',').nth(at).expect("a field").parse().expect("a number") };
        for count in [1_000.0, 3_000.0] {
            let reading = (count - sensors.zero_count()) * sensors.resolution();
            let along = (reading - sensors.offset[channel]) / (1.0 + sensors.gain_error[channel]);
            let shown = field(5) * count + field(6);
            assert!((shown - 1e6 * along).abs() < 1e-3, "{line}: {shown} {along}");
        }
    }
}

/// Of a checked machine, from the file alone: the counts are those of the episode, with the scene's own record.
#[test]
fn an_export_as_comtrade_replays_with_the_record() {
    let scene = checked();
    let (dump, events) = dropped(&scene);
    let episode = &dump.episodes[0];
    let folder = tempfile::tempdir().expect("a folder");
    let [cfg, dat] = comtrade(episode).expect("a header");
    fs::write(folder.path().join("e.cfg"), cfg).expect("a file");
    fs::write(folder.path().join("e.dat"), dat).expect("a file");
    let path = folder.path().join("e.cfg");
    let orders = Orders::default();
    let replay = replay::recording(&path, &Reading::default(), &scene, &Target::Host, &orders);
    let replay = replay.expect("replays").detection;
    let header = episode.header.as_ref().expect("a header");
    let recording = Recording::open(&path, &Reading::default(), &scene).expect("opens");
    assert!(recording.is_episode);
    let (sensors, rate) = (&scene.sensors, f64::from(header.sample_rate));
    for (row, counts) in recording.zip(&episode.samples) {
        let mut row = row.expect("a row");
        row.positions = without_record(&row.positions, sensors);
        assert_eq!(Some(to_sample(&row, sensors, rate).counts), *counts);
    }
    let kinds = |events: &[DetectedEvent]| -> Vec<_> { events.iter().map(|it| it.event).collect() };
    let impacts = |events: &[DetectedEvent]| kinds(events).iter().filter(|it| **it == EventKind::Impact).count();
    let told = told(episode, events);
    assert!(impacts(&told) > 3, "{told:?}");
    assert_eq!(impacts(&replay.events), impacts(&told), "{:?}", replay.events);
}

/// The export has the very pulses that the monitor saw, and none where an episode has none, as in earlier formats.
#[test]
fn pulses_are_handed_on_where_they_are_known() {
    let scene = Scene::load("ball-bearing").expect("built-in scene");
    let (dump, events) = dropped(&scene);
    let mut episode = dump.episodes[0].clone();
    let header = episode.header.expect("a header");
    let known = episode.samples_with_pulses.expect("pulse sensors");
    assert_eq!(known, episode.samples.len());
    let mut out = Vec::new();
    assert!(stream(&episode, &mut out).expect("is written"));
    let rate = f64::from(header.sample_rate);
    let (mut reader, _) = even_rows("e.csv", &out).expect("a stream");
    for (row, shown) in reader.by_ref().zip(&episode.pulses) {
        let sample = to_sample(&row.expect("a row"), &scene.sensors, rate);
        assert_eq!(Some(sample.edges), *shown);
    }
    // Cut short: what is beyond has no value.
    episode.pulses.truncate(100);
    let mut out = Vec::new();
    assert!(stream(&episode, &mut out).expect("is written"));
    let (rows, _) = even_rows("e.csv", &out).expect("a stream");
    let rows = rows.map(|row| row.expect("a row").edges != [None; 2]);
    assert_eq!(rows.filter(|it| *it).count(), 100);
    // As it was before there were pulses.
    let old = Header {
        pulsed: 0,
        ..header
    };
    episode.header = Some(old);
    episode.pulses.clear();
    let learnt = episode.learnt.take().expect("learnt");
    let parts: Vec<_> = learnt.split('-').collect();
    assert_eq!(parts.len(), 10);
    episode.learnt = Some(parts[..8].join("-"));
    let mut out = Vec::new();
    assert!(stream(&episode, &mut out).expect("is written"));
    let head = String::from_utf8_lossy(&out);
    assert!(
        head.starts_with("time_s,ax_um,ay_um,bx_um,by_um,speed_rpm,learnt\n"),
        "{}",
        &head[..60]
    );
    let told = told(&episode, events);
    assert_eq!(replayed(&episode, &scene)[0].event, told[0].event);
}

#[test]
fn what_the_pulse_channels_knew_comes_back() {
    let scene = Scene::load("ball-bearing").expect("built-in scene");
    let (dump, _) = dropped(&scene);
    let field = dump.episodes[0].learnt.clone().expect("learnt");
    let learnt = of_field(&field).expect("is read");
    let parts: Vec<_> = (0..).map_while(|it| part(&learnt, it)).collect();
    assert_eq!(to_field(parts.iter().map(|it| it.payload())), field);
    // A part more or less is of no known episode.
    let parts = || parts.iter().map(|it| it.payload());
    assert!(of_parts(parts().take(8)).is_some());
    assert!(of_parts(parts().take(9)).is_none());
    assert!(of_parts(parts().chain(parts().take(1))).is_none());
}

#[test]
fn without_what_was_learnt_the_fall_is_late() {
    let scene = Scene::load("rig").expect("built-in scene");
    let (mut dump, events) = dropped(&scene);
    let episode = &mut dump.episodes[0];
    episode.learnt = None;
    let cold = replayed(episode, &scene)[0].clone();
    let warm = told(episode, events)[0].clone();
    assert_eq!(cold.event, warm.event);
    assert!(cold.sample > warm.sample + 20, "{cold:?} {warm:?}");
}

#[test]
fn an_exported_drop_compares_with_its_own_stream() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let scene = Scene::load("rig").expect("built-in scene");
    let (outcome, _) = drop::by_reference::<Sink>(&scene, &Target::Host, None).expect("drops");
    fs::write(at.join("flash.bin"), &outcome.conduct.flash).expect("a dump");
    for run in [
        &["drop", "rig", "--stream", "rig.csv"][..],
        &["log", "export", "flash.bin", "--out", "e.csv"],
        &["compare", "e.csv", "rig.csv", "--scene", "rig"],
    ] {
        touchdown(at).args(run).assert().success();
    }
    // The first line is that of a stream, and only the first row has more.
    let text = fs::read_to_string(at.join("e.csv")).expect("a stream");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time_s,ax_um,ay_um,bx_um,by_um,learnt"));
    assert!(lines.next().is_some_and(|it| it.len() > 1_000));
    assert!(lines.all(|it| it.ends_with(',')));
    // What cannot be handed on is refused.
    let damaged = text.replacen(",0200", ",0300", 1);
    fs::write(at.join("d.csv"), damaged).expect("a stream");
    let run = ["replay", "d.csv", "--scene", "rig"];
    touchdown(at).args(run).assert().code(2);
}

#[test]
fn what_was_learnt_comes_back() {
    let scene = Scene::load("rig").expect("built-in scene");
    let (dump, _) = dropped(&scene);
    let field = dump.episodes[0].learnt.clone().expect("learnt");
    let learnt = of_field(&field).expect("is read");
    let parts: Vec<_> = (0..).map_while(|it| part(&learnt, it)).collect();
    assert!(parts.iter().all(|it| it.kind() == Kind::Learnt));
    assert_eq!(to_field(parts.iter().map(|it| it.payload())), field);
    let parts = || parts.iter().map(|it| it.payload());
    assert!(of_parts(parts().take(7)).is_none());
    assert!(of_parts(parts().chain(parts())).is_none());
    // Nothing has been learnt yet.
    let mut learnt = learnt;
    learnt.update(&MonitorState::default());
    assert!(!learnt.is_known());
}
