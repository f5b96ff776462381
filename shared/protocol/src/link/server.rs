//! The controller's side: requests in, answers out.

use super::frame::{self, Decoder, Frame};
use super::message::{Chunk, Hello, Recent, Refusal, Reply, Request, State, shortened};
use crate::config_block::{self, Block, Settings};
use crate::log::counters::Counters as Lifetime;
use crate::wire::{Record, encode_record};
use touchdown_core::event::Notice;

/// The log, as the link sees it: numbered episodes of bytes.
pub trait Log {
    /// Number of the first and of the last episode.
    fn episodes(&mut self) -> Option<(u32, u32)>;

    /// Bytes of an episode from `offset` on, as many as `chunk` has room for and no more than there
    /// are, and how many the whole has.
    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal>;

    /// Erases an episode.
    fn erase(&mut self, episode: u32) -> Result<(), Refusal>;

    /// The lifetime counters.
    fn lifetime(&mut self) -> Option<Lifetime>;
}

/// A controller that keeps no log.
impl Log for () {
    fn episodes(&mut self) -> Option<(u32, u32)> {
        None
    }

    fn fetch(&mut self, _: u32, _: u32, _: &mut Chunk) -> Result<u32, Refusal> {
        Err(Refusal::NoEpisode)
    }

    fn erase(&mut self, _: u32) -> Result<(), Refusal> {
        Err(Refusal::NoEpisode)
    }

    fn lifetime(&mut self) -> Option<Lifetime> {
        None
    }
}

/// A controller whose log may be missing.
impl<L: Log> Log for Option<L> {
    fn episodes(&mut self) -> Option<(u32, u32)> {
        self.as_mut()?.episodes()
    }

    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal> {
        let log = self.as_mut().ok_or(Refusal::NoEpisode)?;
        log.fetch(episode, offset, chunk)
    }

    fn erase(&mut self, episode: u32) -> Result<(), Refusal> {
        self.as_mut().ok_or(Refusal::NoEpisode)?.erase(episode)
    }

    fn lifetime(&mut self) -> Option<Lifetime> {
        self.as_mut()?.lifetime()
    }
}

/// The controller, as the link sees it.
pub trait Device {
    /// What goes on now. The link fills in its own counter.
    fn state(&mut self) -> State;

    /// The block in force.
    fn config(&mut self) -> Block;

    /// Stores a block that is valid and puts it in force; refused while a drop runs.
    fn set_config(&mut self, block: &[u8], settings: &Settings) -> Result<(), Refusal>;

    /// Clears what is latched.
    fn clear(&mut self) -> Result<(), Refusal>;

    /// The newest samples, every `step`-th of those that are recorded.
    fn recent(&mut self, step: u16) -> Recent;

    /// The log.
    fn log(&mut self) -> &mut impl Log;
}

/// The controller's side of the link.
#[derive(Clone, Debug)]
pub struct Server {
    firmware: &'static str,
    sample_rate: f32,
    decoder: Decoder,
    damaged: u32,
    sequence: u8,
}

impl Server {
    /// Says `firmware` and `sample_rate` (Hz) to who asks.
    pub fn new(firmware: &'static str, sample_rate: f32) -> Self {
        Self {
            firmware,
            sample_rate,
            decoder: Decoder::default(),
            damaged: 0,
            sequence: 0,
        }
    }

    /// Takes a byte from the line; the answer, where it ends a request. A damaged request is counted
    /// and not answered.
    pub fn take(&mut self, byte: u8, device: &mut impl Device) -> Option<Frame> {
        match self.decoder.take::<Request>(byte)? {
            Ok(received) => {
                let reply = self.answer(received.message, device);
                frame::encode(received.sequence, &reply)
            }
            Err(_) => {
                self.damaged = self.damaged.saturating_add(1);
                None
            }
        }
    }

    /// A notice on its way out.
    pub fn notice(&mut self, notice: &Notice) -> Option<Frame> {
        self.tell(&Reply::Notice(encode_record(&Record::Notice(*notice))))
    }

    /// The state on its way out, unasked.
    pub fn state(&mut self, device: &mut impl Device) -> Option<Frame> {
        let state = self.state_of(device);
        self.tell(&Reply::State(state))
    }

    fn tell(&mut self, reply: &Reply) -> Option<Frame> {
        self.sequence = self.sequence.wrapping_add(1);
        frame::encode(self.sequence, reply)
    }

    fn state_of(&self, device: &mut impl Device) -> State {
        let mut state = device.state();
        state.counters.damaged_frames = self.damaged;
        state
    }

    fn answer(&self, request: Request, device: &mut impl Device) -> Reply {
        let done = |result: Result<(), Refusal>| match result {
            Ok(()) => Reply::Done,
            Err(refusal) => Reply::Refused(refusal),
        };
        match request {
            Request::Hello => Reply::Hello(Hello {
                firmware: shortened(self.firmware),
                sample_rate: self.sample_rate,
            }),
            Request::State => Reply::State(self.state_of(device)),
            Request::ReadConfig => Reply::Config(device.config()),
            Request::SetConfig(bytes) => done(set_config(&bytes, device)),
            Request::Clear => done(device.clear()),
            Request::Episodes => Reply::Episodes(device.log().episodes()),
            Request::Fetch { episode, offset } => {
                let mut bytes = Chunk::new();
                match device.log().fetch(episode, offset, &mut bytes) {
                    Ok(total) => Reply::Chunk { total, bytes },
                    Err(refusal) => Reply::Refused(refusal),
                }
            }
            Request::Erase { episode } => done(device.log().erase(episode)),
            Request::Lifetime => Reply::Lifetime(device.log().lifetime()),
            Request::Recent { step } => Reply::Recent(device.recent(step.max(1))),
        }
    }
}

fn set_config(bytes: &[u8], device: &mut impl Device) -> Result<(), Refusal> {
    let (block, settings) = config_block::decode(bytes)?;
    device.set_config(block, &settings)
}
