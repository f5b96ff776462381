//! The right to order: a nonce that the controller gave, answered in time under the key of its configuration.

use core::hash::Hasher;

use siphasher::sip128::{Hasher128, SipHasher24};

use crate::config_block::Key;
use crate::controller::Busy;
use touchdown_core::event::Act;

/// Bytes of a nonce.
pub const NONCE_BYTES: usize = 16;
/// Number of the power-on, number of the nonce since, and what nobody knew before; each once.
pub type Nonce = [u8; NONCE_BYTES];
/// An answer to a nonce.
pub type Mac = [u8; 16];

/// A nonce is good for so long, s. Asked for again in the first half of it, it is the same one: a question that was
/// repeated has one answer.
const GOOD: f32 = 5.0;

/// The answer to `nonce` that gives the right to `act`, which is about `block`: SipHash-2-4 of 128 bits over nonce, act
/// as it is in the request, and block. Without a key that of zeros stands in.
pub fn mac(key: Option<&Key>, nonce: &Nonce, act: &Act, block: &[u8]) -> Mac {
    let Key(key) = key.unwrap_or(&Key::HELD);
    let mut hasher = SipHasher24::new_with_key(key);
    // Its variant, and a number of up to five bytes.
    let mut bytes = [0; 8];
    let act = postcard::to_slice(act, &mut bytes).map_or(&[][..], |it| &*it);
    for part in [nonce, act, block] {
        hasher.write(part);
    }
    hasher.finish128().as_bytes()
}

/// Who may order.
#[derive(Clone, Debug)]
pub(super) struct Right {
    pub(super) key: Option<Key>,
    /// Samples for which a nonce is good.
    good: u64,
    given: u32,
    /// With the sample at which it was given.
    open: Option<(Nonce, u64)>,
}

impl Right {
    pub(super) fn new(key: Option<Key>, sample_rate: f32) -> Self {
        Self {
            key,
            good: (GOOD * sample_rate) as u64,
            given: 0,
            open: None,
        }
    }

    /// The nonce of the next order, at sample `now`.
    pub(super) fn challenge(&mut self, now: u64, boot: u32, unknown: u64) -> Nonce {
        let is_fresh = |(_, at): &(Nonce, u64)| now.wrapping_sub(*at) <= self.good / 2;
        if let Some((nonce, _)) = self.open.filter(is_fresh) {
            return nonce;
        }
        self.given = self.given.wrapping_add(1);
        let number = u64::from(boot) << 32 | u64::from(self.given);
        let nonce = (u128::from(unknown) << 64 | u128::from(number)).to_le_bytes();
        self.open = Some((nonce, now));
        nonce
    }

    /// Whether the `given` one answers the nonce that is open, which it uses up.
    pub(super) fn check(
        &mut self,
        given: &Mac,
        act: &Act,
        block: &[u8],
        now: u64,
        service: bool,
    ) -> Result<(), Busy> {
        let open = self.open.take();
        if self.key.is_none() && !service {
            return Err(Busy::Service);
        }
        let in_time = open.filter(|(_, at)| now.wrapping_sub(*at) <= self.good);
        let right = in_time.map(|(nonce, _)| mac(self.key.as_ref(), &nonce, act, block));
        // All bits at once, wherever the first wrong one is.
        let differ = |it: Mac| u128::from_le_bytes(it) ^ u128::from_le_bytes(*given);
        let is_right = right.map(differ) == Some(0);
        is_right.then_some(()).ok_or(Busy::NoRight)
    }
}
