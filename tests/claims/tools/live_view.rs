//! The picture of `touchdown live`: what was told is what stands there, at any size.
#![cfg(unix)]

use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::style::Color;
use touchdown_protocol::controller::{Fault, Faults, Mode, Outputs};
use touchdown_core::detect::Phase;
use touchdown_core::event::{EventKind, Notice};
use touchdown_protocol::link;
use touchdown_protocol::link::{Hello, State};
use touchdown_protocol::log::counters::Counters;
use touchdown_sim::live::{Said, Update, View, Watched, draw, line};
use touchdown_tests::controller::{SAMPLE_RATE, circle, event, settings, state};
use touchdown_tests::episode::{COUNTERS, header};

/// Five seconds with a drop in them, after which the plug is pulled.
fn watched(updates: &[(f64, Said)]) -> Watched {
    let mut watched = Watched::new("unix:/tmp/rig.sock".to_owned());
    for (at, said) in updates {
        watched.take(&Update {
            at: *at,
            said: said.clone(),
        });
    }
    watched
}

fn greeting() -> Said {
    let hello = Hello {
        firmware: "0.1.0".try_into().unwrap(),
        sample_rate: SAMPLE_RATE,
    };
    Said::Connected(hello, settings())
}

fn dropped() -> State {
    State {
        cause: None,
        touches: 0,
        sample: 100_000,
        age_us: 40_000,
        phase: Phase::Sliding,
        mode: Mode::Dropped,
        outputs: Outputs::SAFE,
        faults: Faults::NONE.with(Fault::Overrun).with(Fault::SensorsLost),
        counters: link::Counters {
            lost_samples: 11,
            unusable_values: 22,
            lost_notices: 33,
            damaged_frames: 44,
        },
    }
}

fn a_drop() -> Vec<(f64, Said)> {
    let mut updates = vec![(0.5, greeting()), (0.5, Said::Lifetime(COUNTERS))];
    for tick in 0..100_u64 {
        let at = 0.5 + 0.05 * tick as f64;
        let sample = 1_000 * tick;
        updates.push((at, Said::State(State { sample, ..state() })));
    }
    updates.extend([
        (5.46, Said::Recent(circle(99_000, 8))),
        (5.47, Said::Notice(event(0, EventKind::FreeFall, 50_000))),
        (5.47, Said::Notice(event(1, EventKind::FreeFall, 50_500))),
        (5.47, Said::Notice(event(2, EventKind::Impact, 51_000))),
        (5.47, Said::Notice(event(3, EventKind::Sliding, 52_000))),
        (
            5.47,
            Said::Notice(Notice::Withdrawn {
                number: 0,
                sample: 50_100,
            }),
        ),
        (
            5.47,
            Said::Notice(Notice::Confirmed {
                number: 1,
                sample: 50_600,
            }),
        ),
        (5.48, Said::Episode(3, None)),
        (5.48, Said::Episode(4, Some(header()))),
        (5.49, Said::Damaged(55)),
        (5.5, Said::State(dropped())),
    ]);
    updates
}

fn picture(view: &View, watched: &Watched, now: f64, size: [u16; 2]) -> String {
    let backend = TestBackend::new(size[0], size[1]);
    let mut terminal = Terminal::new(backend).expect("a terminal");
    terminal
        .draw(|frame| draw(frame, view, watched, now))
        .expect("a picture");
    let buffer = terminal.backend().buffer();
    let rows = buffer.content().chunks(usize::from(size[0]).max(1));
    let text = |row: &[ratatui::buffer::Cell]| -> String {
        row.iter().map(|it| it.symbol()).collect::<String>()
    };
    rows.map(|row| text(row).trim_end().to_owned() + "\n")
        .collect()
}

#[test]
fn what_was_told_stands_there() {
    let view = View {
        record: Some("r.jsonl".to_owned()),
        ..View::default()
    };
    let text = picture(&view, &watched(&a_drop()), 5.6, [100, 30]);
    println!("{text}");
    assert_eq!(text, include_str!("../../data/live.txt"));
}

#[test]
fn what_is_old_or_not_connected_is_marked() {
    let view = View::default();
    let mut watched = watched(&a_drop());
    let text = picture(&view, &watched, 7.0, [100, 30]);
    assert!(text.contains("1.54 s, OLD"), "{text}");
    watched.take(&Update {
        at: 8.0,
        said: Said::Lost("the line was closed".to_owned()),
    });
    watched.take(&Update {
        at: 8.5,
        said: Said::Lost("no such file".to_owned()),
    });
    let text = picture(&view, &watched, 9.0, [100, 30]);
    assert!(
        text.contains("NOT CONNECTED for 1 s: no such file"),
        "{text}"
    );
    // What was known is still there.
    assert!(
        text.contains("forward whirl") || text.contains("sliding"),
        "{text}"
    );
}

#[test]
fn a_controller_that_began_again_is_not_mixed_with_what_it_was() {
    let mut updates = a_drop();
    updates.push((
        5.6,
        Said::State(State {
            sample: 10,
            ..state()
        }),
    ));
    let watched = watched(&updates);
    assert_eq!(watched.restarts, 1);
    assert_eq!(watched.events().count(), 0);
    let text = picture(&View::default(), &watched, 5.7, [100, 30]);
    assert!(text.contains("restarts 1"), "{text}");
}

#[test]
fn rates_are_those_of_what_came() {
    let watched = watched(&a_drop());
    // 1000 samples every 50 ms, and one that came 4 ms after the last.
    let rate = watched.sample_rate().expect("a rate");
    assert!((rate / 20_000.0 - 1.0).abs() < 0.01, "{rate}");
    let events: Vec<_> = watched.events().collect();
    assert_eq!(events.len(), 4);
    assert_eq!(events[3].withdrawn_s, Some(2.505));
    assert_eq!(events[2].confirmed_s, Some(2.53));
    assert_eq!(events[1].normal_speed_m_s, Some(f64::from(0.0765_f32)));
}

#[test]
fn without_colour_there_is_none() {
    let watched = watched(&a_drop());
    for paint in [false, true] {
        let view = View {
            paint,
            ..View::default()
        };
        let mut terminal = Terminal::new(TestBackend::new(100, 30)).expect("a terminal");
        terminal
            .draw(|frame| draw(frame, &view, &watched, 5.6))
            .expect("a picture");
        let cells = terminal.backend().buffer().content();
        let plain = cells
            .iter()
            .all(|it| it.fg == Color::Reset && it.bg == Color::Reset);
        assert_eq!(plain, !paint);
    }
}

fn any_state() -> impl Strategy<Value = Said> {
    (
        any::<u64>(),
        any::<u32>(),
        0..6_usize,
        0..5_u8,
        any::<u16>(),
    )
        .prop_map(|(sample, age_us, phase, mode, faults)| {
            let phases = [
                Phase::Starting,
                Phase::Levitated,
                Phase::FreeFall,
                Phase::Impact,
                Phase::Sliding,
                Phase::Rolling,
            ];
            Said::State(State {
                sample,
                age_us,
                phase: phases[phase],
                mode: Mode::from_repr(mode).unwrap(),
                faults: Faults(faults),
                ..state()
            })
        })
}

fn any_update() -> impl Strategy<Value = Said> {
    prop_oneof![
        Just(greeting()),
        any::<String>().prop_map(Said::Lost),
        any_state(),
        (any::<u16>(), 0..11_u8, 0..1_u64 << 40)
            .prop_map(|(number, kind, at)| Said::Notice(event(number, EventKind::from_repr(kind).unwrap(), at))),
        (any::<u16>(), any::<u64>())
            .prop_map(|(number, sample)| Said::Notice(Notice::Confirmed { number, sample })),
        (any::<u64>(), any::<u16>()).prop_map(|(sample, step)| Said::Recent(circle(sample, step))),
        (any::<u32>(), any::<bool>())
            .prop_map(|(number, whole)| Said::Episode(number, whole.then(header))),
        any::<u32>().prop_map(Said::Damaged),
        (any::<u32>(), any::<u64>()).prop_map(|(landings, weight)| {
            let counted = Counters {
                landings,
                weight,
                ..COUNTERS
            };
            Said::Lifetime(counted)
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn anything_told_has_a_picture_and_a_line_at_any_size(
        updates in prop::collection::vec((0.0..1e6, any_update()), 0..60),
        size in [0..200_u16, 0..60_u16],
        plane in 0..3_usize,
    ) {
        let mut watched = Watched::new("tcp:rig:1".to_owned());
        for (at, said) in updates {
            let update = Update { at, said };
            watched.take(&update);
            let line = line(&update, &watched);
            prop_assert!(!line.contains('\n'));
            let line: serde_json::Value = serde_json::from_str(&line).expect("JSON");
            prop_assert!(line["said"].is_string());
        }
        let view = View { plane, paint: true, ..View::default() };
        picture(&view, &watched, 1e6, size);
    }
}
