//! Frames that find no room on the line are told, and never sent in part.

use touchdown_core::event::Notice;
use touchdown_firmware::outgoing::Outgoing;
use touchdown_protocol::link::{Decoder, Reply, Server};

#[test]
fn a_notice_without_room_is_told_and_the_others_come_whole() {
    let notice = Notice::Withdrawn {
        number: 7,
        sample: 100,
    };
    let mut server = Server::new("0.1.0", 20_000.0, None);
    let mut outgoing = Outgoing::default();
    let (mut queued, mut lost, mut came) = (0, 0, 0);
    let mut decoder = Decoder::default();
    for round in 0..1_000 {
        let frame = server.notice(&notice).expect("a frame");
        if outgoing.push(&frame) {
            queued += 1;
        } else {
            lost += 1;
        }
        // The line takes less than comes.
        for _ in 0..20 {
            let Some(byte) = outgoing.pop() else { break };
            let said = decoder.take::<Reply>(byte);
            came +=
                usize::from(said.is_some_and(
                    |it| matches!(it, Ok(it) if matches!(it.message, Reply::Notice(_))),
                ));
        }
        assert_eq!(queued + lost, round + 1);
    }
    assert!(lost > 300, "{lost}");
    while let Some(byte) = outgoing.pop() {
        if let Some(said) = decoder.take::<Reply>(byte) {
            assert!(matches!(said.expect("whole").message, Reply::Notice(_)));
            came += 1;
        }
    }
    assert_eq!(came, queued);
    assert!(outgoing.is_empty());
}
