//! Blocks: one page of flash each.

use touchdown_core::checksum::CRC;

/// Bytes of a block: a page of the usual serial NOR flash.
pub const BLOCK_BYTES: usize = 256;
/// Bytes of its head: kind, length, index, episode.
pub const HEAD_BYTES: usize = 8;
/// Bytes that it carries.
pub const PAYLOAD_BYTES: usize = BLOCK_BYTES - HEAD_BYTES - 4;

/// What a block carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr)]
#[repr(u8)]
pub enum Kind {
    /// [`super::header::Header`].
    Header = b'H',
    /// A part of [`touchdown_core::learnt::Learnt`].
    Learnt = b'L',
    /// [`super::waveform::Waveform`].
    Waveform = b'W',
    /// [`super::pulses::Pulses`].
    Pulses = b'P',
    /// Notices: [`crate::wire::encode_record`], one after another.
    Events = b'E',
    /// A version, then that version's bytes.
    Severity = b'S',
    /// [`super::ending::Ending`].
    Ending = b'Z',
}

/// A block before it has a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    kind: Kind,
    length: u8,
    payload: [u8; PAYLOAD_BYTES],
}

impl Block {
    /// An empty one.
    pub const fn new(kind: Kind) -> Self {
        Self {
            kind,
            length: 0,
            payload: [0; PAYLOAD_BYTES],
        }
    }

    /// One that carries `payload`; what is beyond [`PAYLOAD_BYTES`] is left out.
    pub fn of(kind: Kind, payload: &[u8]) -> Self {
        let mut block = Self::new(kind);
        block.push(payload);
        block
    }

    /// Adds `bytes` if all of them fit; whether they did.
    pub fn push(&mut self, bytes: &[u8]) -> bool {
        let start = usize::from(self.length);
        let Some(room) = self.payload.get_mut(start..start + bytes.len()) else {
            return false;
        };
        room.copy_from_slice(bytes);
        self.length += bytes.len() as u8;
        true
    }

    /// What it carries.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The bytes that it carries.
    pub fn payload(&self) -> &[u8] {
        self.payload
            .get(..usize::from(self.length))
            .unwrap_or_default()
    }

    /// Block `index` of episode `sequence`, as it is stored.
    pub fn seal(&self, sequence: u32, index: u16) -> [u8; BLOCK_BYTES] {
        let mut bytes = [0; BLOCK_BYTES];
        bytes[0] = self.kind as u8;
        bytes[1] = self.length;
        bytes[2..4].copy_from_slice(&index.to_le_bytes());
        bytes[4..8].copy_from_slice(&sequence.to_le_bytes());
        bytes[HEAD_BYTES..BLOCK_BYTES - 4].copy_from_slice(&self.payload);
        let checksum = CRC.checksum(&bytes[..BLOCK_BYTES - 4]);
        bytes[BLOCK_BYTES - 4..].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }
}

/// What a page of flash turned out to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page<'a> {
    /// Erased.
    Blank,
    /// Neither erased nor a block: torn or damaged.
    Broken,
    /// A block.
    Sealed(Sealed<'a>),
}

/// A block with its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sealed<'a> {
    /// The episode.
    pub sequence: u32,
    /// Place in the episode, from 0.
    pub index: u16,
    /// What it carries; `None` for a kind that this version does not know.
    pub kind: Option<Kind>,
    /// The bytes that it carries.
    pub payload: &'a [u8],
}

impl<'a> Page<'a> {
    /// Looks at a page.
    pub fn open(bytes: &'a [u8; BLOCK_BYTES]) -> Self {
        if bytes.iter().all(|&byte| byte == 0xff) {
            return Self::Blank;
        }
        let (body, end) = bytes.split_at(BLOCK_BYTES - 4);
        if end != CRC.checksum(body).to_le_bytes() {
            return Self::Broken;
        }
        let payload = HEAD_BYTES..HEAD_BYTES + usize::from(bytes[1]);
        let Some(payload) = body.get(payload) else {
            return Self::Broken;
        };
        Self::Sealed(Sealed {
            sequence: u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]),
            index: u16::from_le_bytes([bytes[2], bytes[3]]),
            kind: Kind::from_repr(bytes[0]),
            payload,
        })
    }
}
