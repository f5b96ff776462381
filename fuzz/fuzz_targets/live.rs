//! Whatever a controller says in whole frames is taken, drawn and told as JSON. The input is messages, each
//! with its length (2 bytes) before it, and configuration blocks among them.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use touchdown_files::drop_log::Episode;
use touchdown_firmware::board::default_config;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{Settings, Wiring};
use touchdown_protocol::link::{Hello, Reply};
use touchdown_protocol::wire::{Record, decode_record};
use touchdown_sim::live::{Said, Update, View, Watched, draw, line};

/// Lines and columns of the terminal.
const SIZE: [u16; 2] = [90, 40];

fn greeting(settings: Settings, sample_rate: f32) -> Said {
    let hello = Hello {
        firmware: "fuzz".try_into().expect("short"),
        sample_rate,
    };
    Said::Connected(hello, settings)
}

fn said(reply: Reply) -> Option<Said> {
    match reply {
        Reply::Hello(hello) => {
            let wiring = Wiring::default();
            let monitor = default_config();
            let settings = Settings {
                monitor,
                wiring,
                key: None,
            };
            Some(greeting(settings, hello.sample_rate))
        }
        Reply::Config(block) => {
            let (_, settings) = config_block::decode(&block).ok()?;
            Some(greeting(settings, 20e3))
        }
        Reply::State(state) => Some(Said::State(state)),
        Reply::Notice(bytes) => match decode_record(&bytes)? {
            Record::Notice(notice) => Some(Said::Notice(notice)),
            _ => None,
        },
        Reply::Recent(recent) => Some(Said::Recent(recent)),
        Reply::Chunk { total, bytes } => Some(Said::Episode(total, Episode::of(&bytes).header)),
        Reply::Lifetime(counters) => counters.map(Said::Lifetime),
        Reply::Done | Reply::Refused(_) | Reply::Challenge(..) | Reply::Episodes(_) => None,
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut watched = Watched::new("fuzz".to_owned());
    let mut rest = bytes;
    let mut at = 0.0;
    while let Some((length, more)) = rest.split_first_chunk::<2>() {
        let length = usize::from(u16::from_le_bytes(*length)).min(more.len());
        let (message, more) = more.split_at(length);
        rest = more;
        at += 0.05;
        let reply = postcard::from_bytes(message).ok();
        if let Some(said) = reply.and_then(said) {
            let update = Update { at, said };
            watched.take(&update);
            let line = line(&update, &watched);
            assert!(line.starts_with('{') && !line.contains('\n'));
        }
    }
    let mut terminal = Terminal::new(TestBackend::new(SIZE[0], SIZE[1])).expect("a terminal");
    terminal
        .draw(|frame| draw(frame, &View::default(), &watched, at))
        .expect("a picture");
});
