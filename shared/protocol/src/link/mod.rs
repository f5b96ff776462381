//! The serial link to the controller: frames, messages, and the controller's side of the talk.
//!
//! | file | says |
//! |---|---|
//! | `cobs` | bytes without zeros, so that a zero ends a frame |
//! | `frame` | a frame: version, sequence number, message, checksum |
//! | `message` | what is said |
//! | `right` | who may order: nonces and answers to them |
//! | `server` | what the controller answers |
//!
//! `docs/formats/link.md` gives every byte.

mod cobs;
mod frame;
mod message;
mod right;
mod server;

pub use frame::{Decoder, FRAME_BYTES, Frame, FrameError, Received, VERSION, encode};
pub use message::{
    CHUNK_BYTES, Chunk, Counters, Hello, Recent, Refusal, Reply, Request, State, TEXT_BYTES, Text,
};
pub use right::{Mac, NONCE_BYTES, Nonce, mac};
pub use server::{Device, Log, Server};
