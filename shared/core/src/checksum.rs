//! The one checksum: CRC-32 of ISO-HDLC, as of Ethernet and zip.

use crc::{CRC_32_ISO_HDLC, Crc};

/// CRC-32, polynomial 0x04c11db7 reflected, begins and ends with all ones; of "123456789" 0xcbf43926.
pub static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
