//! A frame: version, sequence number, message in postcard, CRC-32 of these; all that in COBS, and a
//! zero.

use heapless::Vec;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::cobs::{self, Unstuffer};
use touchdown_core::checksum::CRC;

/// Version of the frames and of all messages.
pub const VERSION: u8 = 4;
/// Most bytes of a frame before the stuffing.
const PLAIN_BYTES: usize = 448;
/// Most bytes of a frame on the line: one more for each 254, the first length and the zero.
pub const FRAME_BYTES: usize = PLAIN_BYTES + PLAIN_BYTES / 254 + 2;
const HEAD: usize = 2;
const TAIL: usize = 4;
/// `Request::Hello` in every version.
const HELLO: [u8; 1] = [0];

/// A frame on the line.
pub type Frame = Vec<u8, FRAME_BYTES>;

/// Message to frame; `None` where it is too long, which no message of this version is.
pub fn encode<M: Serialize>(sequence: u8, message: &M) -> Option<Frame> {
    encode_as(VERSION, sequence, message)
}

/// Likewise, in a frame of this version.
pub(super) fn encode_as<M: Serialize>(version: u8, sequence: u8, message: &M) -> Option<Frame> {
    let mut plain = [0; PLAIN_BYTES];
    let (head, rest) = plain.split_first_chunk_mut::<HEAD>()?;
    *head = [version, sequence];
    let end = HEAD + postcard::to_slice(message, rest).ok()?.len();
    let checksum = CRC.checksum(plain.get(..end)?);
    plain
        .get_mut(end..end + TAIL)?
        .copy_from_slice(&checksum.to_le_bytes());
    let mut frame: Frame = cobs::encode(plain.get(..end + TAIL)?)?;
    frame.push(0).ok()?;
    Some(frame)
}

/// A frame that came whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Received<M> {
    /// Its sequence number.
    pub sequence: u8,
    /// What it says.
    pub message: M,
}

/// Why a frame says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// Longer than any frame.
    TooLong,
    /// Cut short.
    Cut,
    /// The checksum is wrong.
    Checksum,
    /// Another version.
    Version(u8),
    /// A hello of another version, and its sequence number.
    Hello(u8, u8),
    /// No message of this version.
    Message,
}

/// Takes the line's bytes one by one.
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    plain: Vec<u8, PLAIN_BYTES>,
    unstuffer: Unstuffer,
    begun: bool,
    too_long: bool,
}

impl Decoder {
    /// Takes a byte; at the end of a frame, what it says or why nothing. Zeros between frames are
    /// none.
    pub fn take<M: DeserializeOwned>(
        &mut self,
        byte: u8,
    ) -> Option<Result<Received<M>, FrameError>> {
        if byte != 0 {
            self.begun = true;
            if let Some(plain) = self.unstuffer.take(byte) {
                self.too_long |= self.plain.push(plain).is_err();
            }
            return None;
        }
        let said = self.begun.then(|| self.read());
        self.plain.clear();
        self.unstuffer = Unstuffer::default();
        (self.begun, self.too_long) = (false, false);
        said
    }

    fn read<M: DeserializeOwned>(&self) -> Result<Received<M>, FrameError> {
        if self.too_long {
            return Err(FrameError::TooLong);
        }
        let cut = FrameError::Cut;
        if !self.unstuffer.is_whole() {
            return Err(cut);
        }
        let (checked, checksum) = self.plain.split_last_chunk::<TAIL>().ok_or(cut)?;
        let (&[version, sequence], message) = checked.split_first_chunk::<HEAD>().ok_or(cut)?;
        if CRC.checksum(checked) != u32::from_le_bytes(*checksum) {
            return Err(FrameError::Checksum);
        }
        if version != VERSION && message == HELLO {
            return Err(FrameError::Hello(version, sequence));
        }
        if version != VERSION {
            return Err(FrameError::Version(version));
        }
        match postcard::take_from_bytes(message) {
            Ok((message, [])) => Ok(Received { sequence, message }),
            _ => Err(FrameError::Message),
        }
    }
}
