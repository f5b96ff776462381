//! What the monitor had learnt, a block a part.

use postcard::ser_flavors::Flavor;
use touchdown_core::learnt::{Learnt, PARTS, RING_PARTS};

use super::block::{Block, Kind};

/// Version of the parts.
pub const VERSION: u8 = 2;

/// Part `number` of `learnt`, from 0, as a block; nothing beyond the last.
pub fn part(learnt: &Learnt, number: u8) -> Option<Block> {
    let mut block = Block::of(Kind::Learnt, &[VERSION, number]);
    learnt.write(number, Room(&mut block))?;
    Some(block)
}

/// From the payloads of all parts, in their order; nothing where one is missing or of another version.
pub fn of_parts<'a>(parts: impl Iterator<Item = &'a [u8]>) -> Option<Learnt> {
    let mut learnt = Learnt::default();
    let mut number = 0;
    for part in parts {
        match part {
            [VERSION, it, body @ ..] if *it == number => learnt.read(number, body)?,
            _ => return None,
        }
        number += 1;
    }
    (number == PARTS || number == PARTS + RING_PARTS).then_some(learnt)
}

/// A block's payload as a place for values. One copy of what fills it: they are many.
struct Room<'a>(&'a mut Block);

impl Flavor for Room<'_> {
    type Output = ();

    #[inline(never)]
    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    #[inline(never)]
    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        let fits = self.0.push(bytes);
        fits.then_some(())
            .ok_or(postcard::Error::SerializeBufferFull)
    }

    fn finalize(self) -> postcard::Result<()> {
        Ok(())
    }
}
