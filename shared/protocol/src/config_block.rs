//! The configuration as it is stored: a block with version, length and checksum.
//!
//! [`MAGIC`], whose last byte is the version; the length of the body (u16, little-endian); the body
//! ([`Settings`] in postcard); the CRC-32 of all that (u32, little-endian).

use core::fmt;

use crc::Digest;
use heapless::Vec;

use touchdown_core::checksum::CRC;
use touchdown_core::monitor::{Monitor, MonitorConfig};
use touchdown_rotor::error::ConfigError;

/// First bytes of a block; the last is the version.
pub const MAGIC: [u8; 4] = *b"TDC\x05";
/// Most bytes of a block.
pub const BLOCK_BYTES: usize = 384;
const HEAD: usize = MAGIC.len() + 2;
const TAIL: usize = 4;

/// A block.
pub type Block = Vec<u8, BLOCK_BYTES>;

/// All that the controller is told.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// The monitor.
    pub monitor: MonitorConfig,
    /// What else is wired.
    pub wiring: Wiring,
    /// Of the right to order over the link. The last field: [`blanked`] finds it there.
    pub key: Option<Key>,
}

/// Neither speed nor levitation is wired, and there is no key.
impl From<MonitorConfig> for Settings {
    fn from(monitor: MonitorConfig) -> Self {
        Self {
            monitor,
            wiring: Wiring::default(),
            key: None,
        }
    }
}

/// A key of the right to order.
#[derive(Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Key(pub [u8; KEY_BYTES]);

/// Bytes of a key.
pub const KEY_BYTES: usize = 16;

impl Key {
    /// Stands for a key that is not told: in what is read back, and in what leaves the key as it is.
    pub const HELD: Self = Self([0; KEY_BYTES]);
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Self::HELD {
            "held"
        } else {
            "secret"
        })
    }
}

/// What is wired besides the position sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Wiring {
    /// Pulses of the speed input in a turn of the rotor, 1 or more; `None` where it is not wired. The
    /// way of turning is that of the machine's nominal spin.
    pub pulses_per_turn: Option<u16>,
    /// Whether the input "levitation on" is wired.
    pub levitation: bool,
}

/// Why bytes are not a valid configuration.
#[derive(Clone, Copy, Debug, PartialEq, strum::Display)]
pub enum BlockError {
    /// Nothing was ever stored.
    #[strum(to_string = "nothing is stored")]
    Blank,
    /// Another magic or version.
    #[strum(to_string = "not a configuration of this version")]
    Version,
    /// Shorter than its length says, or longer than a block can be.
    #[strum(to_string = "the length is wrong")]
    Length,
    /// The checksum is wrong.
    #[strum(to_string = "the checksum is wrong")]
    Checksum,
    /// The body is none of this version.
    #[strum(to_string = "the body is none of this version")]
    Body,
    /// A parameter breaks its rule.
    #[strum(transparent)]
    Refused(ConfigError),
}

impl core::error::Error for BlockError {}

/// Settings to block.
pub fn encode(settings: &Settings) -> Block {
    let mut bytes = [0; BLOCK_BYTES - HEAD - TAIL];
    // Far from full: a test holds the size.
    let body = postcard::to_slice(settings, &mut bytes).map_or(&[][..], |body| &*body);
    let mut block = Block::new();
    let length = (body.len() as u16).to_le_bytes();
    for part in [&MAGIC[..], &length, body] {
        let _ = block.extend_from_slice(part);
    }
    let checksum = CRC.checksum(&block);
    let _ = block.extend_from_slice(&checksum.to_le_bytes());
    block
}

/// The block with [`Key::HELD`] for its key, if it is `keyed`. A checksum that was wrong stays wrong.
pub fn blanked(block: &[u8], keyed: bool) -> Block {
    let mut blank = Block::from_slice(block).unwrap_or_default();
    if let Some((checked, checksum)) = blank.split_last_chunk_mut::<TAIL>() {
        let was = CRC.checksum(checked);
        if let Some(key) = checked.last_chunk_mut::<KEY_BYTES>().filter(|_| keyed) {
            *key = Key::HELD.0;
        }
        let change = (was ^ CRC.checksum(checked)).to_le_bytes();
        checksum
            .iter_mut()
            .zip(change)
            .for_each(|(to, it)| *to ^= it);
    }
    blank
}

/// The block at the start of `bytes`, and its settings, checked.
#[inline(never)]
pub fn decode(bytes: &[u8]) -> Result<(&[u8], Settings), BlockError> {
    if bytes.iter().take(HEAD).all(|&byte| byte == 0xff) {
        return Err(BlockError::Blank);
    }
    let rest = bytes.strip_prefix(&MAGIC).ok_or(BlockError::Version)?;
    let (length, _) = rest.split_first_chunk().ok_or(BlockError::Length)?;
    let end = HEAD + usize::from(u16::from_le_bytes(*length)) + TAIL;
    let block = bytes.get(..end).filter(|it| it.len() <= BLOCK_BYTES);
    let block = block.ok_or(BlockError::Length)?;
    let (checked, checksum) = block.split_last_chunk().ok_or(BlockError::Length)?;
    if CRC.checksum(checked) != u32::from_le_bytes(*checksum) {
        return Err(BlockError::Checksum);
    }
    let body = checked.get(HEAD..).ok_or(BlockError::Length)?;
    let Ok((settings, [])) = postcard::take_from_bytes::<Settings>(body) else {
        return Err(BlockError::Body);
    };
    settings.validate().map_err(BlockError::Refused)?;
    Ok((block, settings))
}

impl Settings {
    /// Names the first parameter that breaks its rule.
    pub fn validate(&self) -> Result<(), ConfigError> {
        if self.wiring.pulses_per_turn == Some(0) {
            return Err(ConfigError::OutOfRange("pulses_per_turn", "1 or more"));
        }
        Monitor::try_new(&self.monitor).map(|_| ())
    }
}

/// Bytes that one call of [`ConfigScrub::step`] takes in.
pub const SLICE_BYTES: usize = 4;

/// Checks a block over and over, a slice a tick.
#[derive(Clone, Default)]
pub struct ConfigScrub {
    at: usize,
    /// Of what was taken in of this pass.
    digest: Option<Digest<'static, u32>>,
}

impl ConfigScrub {
    /// Takes in the next slice; at the end of a pass, whether the block still is what it was.
    pub fn step(&mut self, block: &[u8]) -> Option<bool> {
        let Some((checked, checksum)) = block.split_last_chunk() else {
            return Some(false);
        };
        let left = checked.get(self.at..).unwrap_or(&[]);
        let slice = left.get(..SLICE_BYTES).unwrap_or(left);
        let digest = self.digest.get_or_insert_with(|| CRC.digest());
        digest.update(slice);
        self.at += slice.len();
        if self.at < checked.len() {
            return None;
        }
        self.at = 0;
        let checked = self.digest.take()?.finalize();
        Some(checked == u32::from_le_bytes(*checksum))
    }

    /// Most steps until a change of a block of `length` bytes is found: one pass may just have gone by.
    pub const fn steps(length: usize) -> usize {
        2 * length.div_ceil(SLICE_BYTES)
    }
}
