//! Consistent overhead byte stuffing (Cheshire and Baker, IEEE/ACM Trans. Networking 7(2), 1999, 159):
//! each group of bytes that are not zero begins with its length and one; the zero after it is left out.

use heapless::Vec;

/// Longest group: its first byte says so, and no zero follows.
const LONGEST: u8 = 0xff;

/// `data` without zeros; `None` where it has no room.
pub(super) fn encode<const N: usize>(data: &[u8]) -> Option<Vec<u8, N>> {
    let mut out = Vec::new();
    let mut head = 0;
    let mut length = 1;
    out.push(0).ok()?;
    for &byte in data {
        if byte != 0 {
            out.push(byte).ok()?;
            length += 1;
        }
        if byte == 0 || length == LONGEST {
            *out.get_mut(head)? = length;
            head = out.len();
            length = 1;
            out.push(0).ok()?;
        }
    }
    *out.get_mut(head)? = length;
    Some(out)
}

/// Takes stuffed bytes one by one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unstuffer {
    /// Bytes left in the group.
    left: u8,
    /// Whether a zero comes before the next group.
    zero: bool,
}

impl Unstuffer {
    /// Takes a byte that is not 0; hands out what it stands for: nothing, a zero, or itself.
    pub(super) fn take(&mut self, byte: u8) -> Option<u8> {
        if self.left > 0 {
            self.left -= 1;
            return Some(byte);
        }
        let zero = self.zero.then_some(0);
        self.left = byte.saturating_sub(1);
        self.zero = byte != LONGEST;
        zero
    }

    /// Whether a frame may end here.
    pub(super) fn is_whole(&self) -> bool {
        self.left == 0
    }
}
