//! Frames on their way out of the link.

use heapless::Deque;
use touchdown_protocol::link::{FRAME_BYTES, Frame};

/// Room for two of the longest frames, bytes.
const ROOM: usize = 2 * FRAME_BYTES;

/// What waits for the line.
#[derive(Default)]
pub struct Outgoing {
    bytes: Deque<u8, ROOM>,
}

impl Outgoing {
    /// Queues a frame; without room for all of it none of it. Whether it had room.
    #[must_use]
    pub fn push(&mut self, frame: &Frame) -> bool {
        if frame.len() > ROOM - self.bytes.len() {
            return false;
        }
        for &byte in frame {
            let _ = self.bytes.push_back(byte);
        }
        true
    }

    /// The next byte for the line.
    pub fn pop(&mut self) -> Option<u8> {
        self.bytes.pop_front()
    }

    /// Whether nothing waits.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }
}
