//! The controller's side: requests in, answers out, orders only by right.

use super::frame::{self, Decoder, Frame, FrameError};
use super::message::{Chunk, Hello, Recent, Refusal, Reply, Request, State, shortened};
use super::right::{Mac, Right};
use crate::config_block::{self, Block, Key, Settings};
use crate::controller::Busy;
use crate::log::counters::Counters as Lifetime;
use crate::wire::{Record, encode_record};
use touchdown_core::event::{Act, Notice, Ordered};

/// The log, as the link sees it: numbered episodes of bytes.
pub trait Log {
    /// Number of the first and of the last episode.
    fn episodes(&mut self) -> Option<(u32, u32)>;

    /// Bytes of an episode from `offset` on, as many as `chunk` has room for and no more than there
    /// are, and how many the whole has.
    fn fetch(&mut self, episode: u32, offset: u32, chunk: &mut Chunk) -> Result<u32, Refusal>;

    /// Erases an episode that is not locked.
    fn erase(&mut self, episode: u32) -> Result<(), Refusal>;

    /// Keeps an episode, or gives it free to be overwritten.
    fn set_locked(&mut self, episode: u32, locked: bool) -> Result<(), Refusal>;

    /// The lifetime counters.
    fn lifetime(&mut self) -> Option<Lifetime>;
}

/// The controller, as the link sees it.
pub trait Device {
    /// What goes on now. The link fills in its own counter.
    fn state(&mut self) -> State;

    /// The block in force, with its key.
    fn config(&mut self) -> Block;

    /// Whether the local service input is on.
    fn service(&mut self) -> bool;

    /// What nobody can know before; 0 on a board without a source of it.
    fn unknown(&mut self) -> u64 {
        0
    }

    /// Takes note of an order, done or not.
    fn ordered(&mut self, notice: &Notice);

    /// Stores a block that is valid and puts it in force; refused while the machine may run or a drop runs.
    fn set_config(&mut self, block: &[u8], settings: &Settings) -> Result<(), Refusal>;

    /// Clears what is latched.
    fn clear(&mut self) -> Result<(), Refusal>;

    /// The newest samples, every `step`-th of those that are recorded.
    fn recent(&mut self, step: u16) -> Recent;

    /// The log, where there is one.
    fn log(&mut self) -> Option<&mut impl Log>;
}

/// The controller's side of the link.
#[derive(Clone, Debug)]
pub struct Server {
    firmware: &'static str,
    sample_rate: f32,
    decoder: Decoder,
    damaged: u32,
    sequence: u8,
    right: Right,
    staged: Block,
    /// The last order's right, and what came of it.
    last: Option<(Mac, Result<(), Refusal>)>,
}

impl Server {
    /// Says `firmware` and `sample_rate` (Hz) to who asks, and obeys who has the `key` of the block in force.
    pub fn new(firmware: &'static str, sample_rate: f32, key: Option<Key>) -> Self {
        Self {
            firmware,
            sample_rate,
            decoder: Decoder::default(),
            damaged: 0,
            sequence: 0,
            right: Right::new(key, sample_rate),
            staged: Block::new(),
            last: None,
        }
    }

    /// Takes a byte from the line; the answer, where it ends a request. A damaged request is counted and not answered.
    pub fn take(&mut self, byte: u8, device: &mut impl Device) -> Option<Frame> {
        match self.decoder.take::<Request>(byte)? {
            Ok(received) => {
                let reply = self.answer(received.message, device);
                let reply = reply.unwrap_or_else(Reply::Refused);
                frame::encode(received.sequence, &reply)
            }
            // In its version: so a desktop of another one learns who is there.
            Err(FrameError::Hello(version, sequence)) => {
                let hello = Reply::Hello(self.hello());
                frame::encode_as(version, sequence, &hello)
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

    fn hello(&self) -> Hello {
        Hello {
            firmware: shortened(self.firmware),
            sample_rate: self.sample_rate,
        }
    }

    fn state_of(&self, device: &mut impl Device) -> State {
        let mut state = device.state();
        state.counters.damaged_frames = self.damaged;
        state
    }

    fn answer(&mut self, request: Request, device: &mut impl Device) -> Result<Reply, Refusal> {
        Ok(match request {
            Request::Hello => Reply::Hello(self.hello()),
            Request::State => Reply::State(self.state_of(device)),
            Request::ReadConfig => {
                let keyed = self.right.key.is_some();
                Reply::Config(config_block::blanked(&device.config(), keyed))
            }
            Request::Stage(bytes) => self.stage(&bytes)?,
            Request::Challenge => {
                let boot = lifetime(device).map_or(0, |it| it.boots);
                let (now, unknown) = (device.state().sample, device.unknown());
                let nonce = self.right.challenge(now, boot, unknown);
                Reply::Challenge(nonce, self.right.key.is_some())
            }
            Request::Order { mac, act } => self.order(&mac, act, device).map(|()| Reply::Done)?,
            Request::Episodes => Reply::Episodes(device.log().and_then(|it| it.episodes())),
            Request::Fetch { episode, offset } => {
                let mut bytes = Chunk::new();
                let total = log(device)?.fetch(episode, offset, &mut bytes)?;
                Reply::Chunk { total, bytes }
            }
            Request::Lifetime => Reply::Lifetime(lifetime(device)),
            Request::Recent { step } => Reply::Recent(device.recent(step.max(1))),
        })
    }

    fn stage(&mut self, bytes: &[u8]) -> Result<Reply, Refusal> {
        let (block, settings) = config_block::decode(bytes)?;
        self.staged = Block::from_slice(block).unwrap_or_default();
        let shown = config_block::blanked(block, settings.key.is_some());
        Ok(Reply::Config(shown))
    }

    /// Once for each nonce: an order that comes again, as its answer was lost or somebody recorded it, has the same
    /// answer, and nothing is done.
    fn order(&mut self, mac: &Mac, act: Act, device: &mut impl Device) -> Result<(), Refusal> {
        if let Some((_, result)) = self.last.as_ref().filter(|(last, _)| last == mac) {
            return result.clone();
        }
        let sample = device.state().sample;
        let block: &[u8] = match act {
            Act::Commit(_) => &self.staged,
            _ => &[],
        };
        let right = self.right.check(mac, &act, block, sample, device.service());
        let may = right.map_err(Refusal::from);
        let result = may.and_then(|()| self.act(act, device));
        device.ordered(&Notice::Ordered(Ordered {
            act,
            refused: result.as_ref().err().map_or(0, Refusal::code),
            sample,
        }));
        self.last = Some((*mac, result.clone()));
        result
    }

    fn act(&self, act: Act, device: &mut impl Device) -> Result<(), Refusal> {
        match act {
            Act::Clear => device.clear(),
            Act::Commit(checksum) => self.commit(checksum, device),
            Act::Erase(_) if device.state().outputs.run => Err(Busy::Watching.into()),
            Act::Erase(episode) => match log(device)?.episodes() {
                Some((_, last)) if last == episode => Err(Busy::Last.into()),
                _ => log(device)?.erase(episode),
            },
            Act::Lock(episode) => log(device)?.set_locked(episode, true),
            Act::Unlock(episode) => log(device)?.set_locked(episode, false),
        }
    }

    fn commit(&self, checksum: u32, device: &mut impl Device) -> Result<(), Refusal> {
        let (block, mut settings) = config_block::decode(&self.staged)?;
        if block.last_chunk() != Some(&checksum.to_le_bytes()) {
            return Err(Refusal::Block);
        }
        if settings.key == Some(Key::HELD) {
            settings.key = Some(self.right.key.ok_or_else(|| Refusal::parameter("key"))?);
        }
        device.set_config(&config_block::encode(&settings), &settings)
    }
}

fn log(device: &mut impl Device) -> Result<&mut impl Log, Refusal> {
    device.log().ok_or(Refusal::NoEpisode)
}

fn lifetime(device: &mut impl Device) -> Option<Lifetime> {
    device.log()?.lifetime()
}
