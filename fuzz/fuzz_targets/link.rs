//! Any bytes on the line are taken in bounded time, whole frames or not, and a request afterwards is
//! answered.

#![no_main]

use libfuzzer_sys::fuzz_target;
use touchdown_core::checksum::CRC;
use touchdown_protocol::config_block;
use touchdown_protocol::link::{Decoder, Reply, Request, encode};
use touchdown_protocol::wire::decode_record;

fuzz_target!(|bytes: &[u8]| {
    let mut decoder = Decoder::default();
    for &byte in bytes {
        decoder.take::<Request>(byte);
    }
    for &byte in bytes {
        decoder.take::<Reply>(byte);
    }
    decoder.take::<Request>(0);
    let hello = encode(1, &Request::Hello).expect("it has room");
    let said = hello.iter().find_map(|&byte| decoder.take::<Request>(byte));
    assert!(said.is_some_and(|said| said.is_ok_and(|it| it.message == Request::Hello)));

    // Past the checksums.
    let _ = config_block::decode(bytes);
    let sealed = [bytes, &CRC.checksum(bytes).to_le_bytes()].concat();
    let _ = config_block::decode(&sealed);
    for record in bytes.as_chunks().0 {
        let _ = decode_record(record);
    }
});
