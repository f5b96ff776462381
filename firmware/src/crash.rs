//! What a program that stops leaves behind for the next one, in memory that a reset does not clear.

use core::panic::PanicInfo;

use touchdown_core::checksum::CRC;

/// Words of a record, the checksum included.
pub const WORDS: usize = 8;
const MAGIC: u32 = u32::from_le_bytes(*b"TDX\x02");

/// Why the program stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::FromRepr)]
#[repr(u8)]
pub enum Cause {
    /// A panic.
    Panic = 1,
    /// A fault of the core.
    HardFault = 2,
    /// An interrupt that nothing serves.
    StrayInterrupt = 3,
}

/// What it leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crash {
    /// Why.
    pub cause: Cause,
    /// Where: for a panic the line, for a fault the program counter, else the interrupt's number.
    pub place: u32,
    /// For a panic the CRC-32 of the file's name, for a fault the link register, else 0.
    pub detail: u32,
    /// Of a fault what the core says of it, else 0: CFSR, HFSR, and BFAR where CFSR says that it holds (ARMv7-M, system
    /// control block).
    pub status: [u32; 3],
}

impl Crash {
    /// Of which the core says nothing.
    pub fn new(cause: Cause, place: u32, detail: u32) -> Self {
        Self {
            cause,
            place,
            detail,
            status: [0; 3],
        }
    }

    /// A panic.
    pub fn of_panic(info: &PanicInfo) -> Self {
        let (line, file) = info.location().map_or((0, 0), |place| {
            (place.line(), CRC.checksum(place.file().as_bytes()))
        });
        Self::new(Cause::Panic, line, file)
    }

    /// Record to words: magic, cause, place, detail, status, CRC-32 of these.
    pub fn encode(&self) -> [u32; WORDS] {
        let mut words = [0; WORDS];
        words[..4].copy_from_slice(&[MAGIC, self.cause as u32, self.place, self.detail]);
        words[4..7].copy_from_slice(&self.status);
        words[WORDS - 1] = checksum(&words);
        words
    }

    /// Words to record; `None` for what is none, as after power-on.
    pub fn decode(words: &[u32; WORDS]) -> Option<Self> {
        let [magic, cause, place, detail, status @ .., sum] = *words;
        if magic != MAGIC || sum != checksum(words) {
            return None;
        }
        Some(Self {
            cause: Cause::from_repr(u8::try_from(cause).ok()?)?,
            place,
            detail,
            status,
        })
    }
}

/// Of all but the last.
fn checksum(words: &[u32; WORDS]) -> u32 {
    let mut digest = CRC.digest();
    let said = words.iter().take(WORDS - 1);
    said.for_each(|it| digest.update(&it.to_le_bytes()));
    digest.finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CRASH: Crash = Crash {
        cause: Cause::HardFault,
        place: 0x0800_1234,
        detail: 0x0800_0567,
        status: [0x8200, 0x4000_0000, 0x4002_3c00],
    };

    #[test]
    fn record_is_read_back() {
        assert_eq!(Crash::decode(&CRASH.encode()), Some(CRASH));
    }

    #[test]
    fn what_memory_holds_after_power_on_is_no_record() {
        assert_eq!(Crash::decode(&[0; WORDS]), None);
        assert_eq!(Crash::decode(&[u32::MAX; WORDS]), None);
        for bit in 0..32 * WORDS {
            let mut words = CRASH.encode();
            words[bit / 32] ^= 1 << (bit % 32);
            assert_eq!(Crash::decode(&words), None, "bit {bit}");
        }
    }
}
