//! Asks the controller.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use touchdown_core::event::{Act, Notice};
use touchdown_protocol::config_block::{self, Block, Key, Settings};
use touchdown_protocol::link::{
    Decoder, FrameError, Hello, Recent, Refusal, Reply, Request, State, encode, mac,
};
use touchdown_protocol::log::counters::Counters;
use touchdown_protocol::wire::{Record, decode_record};

use super::error::LinkError;
use super::port::Line;

/// Without an answer for so long, ms, the request is sent again: soon where one was damaged, ever less often where the
/// controller is slow. 4.4 s in all: a sector that is being erased takes 0.4 s, an emulator on a busy machine more.
const PATIENCE: [u64; 7] = [200, 200, 400, 400, 800, 800, 1_600];
/// The same for an emulator on a busy desktop, and for a line with noise: 35 s.
const LONG_PATIENCE: [u64; 20] = {
    let mut all = [2_000; 20];
    (all[0], all[1], all[2], all[3]) = (200, 400, 800, 1_600);
    all
};
/// Longer than any episode that a controller keeps, bytes.
const LONGEST_EPISODE: u32 = 1 << 20;
/// Of what comes by itself, kept while an answer is waited for; the oldest go first.
const KEPT: usize = 1_000;

/// Asks, and takes that answer alone.
macro_rules! asked {
    ($client:ident, $request:expr, $answer:pat => $value:expr) => {
        match $client.ask(&$request)? {
            $answer => Ok($value),
            _ => Err(LinkError::Senseless),
        }
    };
}

/// What the controller says by itself.
#[derive(Clone, Debug, PartialEq)]
pub enum Told {
    /// What goes on.
    State(State),
    /// What happened.
    Notice(Notice),
}

/// The desktop's end of an open line.
pub struct Client {
    line: Box<dyn Line>,
    patience: &'static [u64],
    decoder: Decoder,
    /// Read from the line, not yet decoded.
    bytes: VecDeque<u8>,
    told: VecDeque<Told>,
    sequence: u8,
    /// Frames that came damaged.
    pub damaged: u32,
    /// Requests that were sent again.
    pub repeated: u32,
    /// By whose right it orders, where the controller has one.
    pub key: Option<Key>,
}

impl Client {
    /// Over `line`, with nothing said yet.
    pub fn new(line: Box<dyn Line>) -> Self {
        Self {
            line,
            patience: &PATIENCE,
            decoder: Decoder::default(),
            bytes: VecDeque::new(),
            told: VecDeque::new(),
            sequence: 0,
            damaged: 0,
            repeated: 0,
            key: None,
        }
    }

    /// The same, and waits for 35 s before it gives up: for an emulator, or a line with noise.
    pub fn patient(line: Box<dyn Line>) -> Self {
        Self {
            patience: &LONG_PATIENCE,
            ..Self::new(line)
        }
    }

    /// Sends `request`, again where no answer comes; the answer, unless it is a refusal.
    pub fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        self.sequence = self.sequence.wrapping_add(1);
        // A zero first ends what noise began.
        let mut bytes = vec![0];
        bytes.extend(encode(self.sequence, request).ok_or(LinkError::Senseless)?);
        for (attempt, patience) in self.patience.iter().enumerate() {
            self.repeated += u32::from(attempt > 0);
            self.line.write(&bytes)?;
            let end = Instant::now() + Duration::from_millis(*patience);
            while let Some((sequence, reply)) = self.receive(end)? {
                if sequence == self.sequence && answers(request, &reply) {
                    return match reply {
                        Reply::Refused(why) => Err(LinkError::Refused(why)),
                        reply => Ok(reply),
                    };
                }
                self.keep(reply);
            }
        }
        Err(LinkError::Silent)
    }

    /// What the controller says by itself, after at most `limit`.
    pub fn listen(&mut self, limit: Duration) -> Result<Option<Told>, LinkError> {
        let end = Instant::now() + limit;
        while self.told.is_empty()
            && let Some((_, reply)) = self.receive(end)?
        {
            self.keep(reply);
        }
        Ok(self.told.pop_front())
    }

    /// Who is there.
    pub fn hello(&mut self) -> Result<Hello, LinkError> {
        asked!(self, Request::Hello, Reply::Hello(hello) => hello)
    }

    /// What goes on.
    pub fn state(&mut self) -> Result<State, LinkError> {
        asked!(self, Request::State, Reply::State(state) => state)
    }

    /// Has something done: by the right of the key, or where the controller has none by its service input.
    pub fn order(&mut self, act: Act) -> Result<(), LinkError> {
        self.order_about(act, &[])
    }

    fn order_about(&mut self, act: Act, block: &[u8]) -> Result<(), LinkError> {
        let (nonce, keyed) =
            asked!(self, Request::Challenge, Reply::Challenge(nonce, keyed) => (nonce, keyed))?;
        let key = self.key.as_ref().filter(|_| keyed);
        let mac = mac(key, &nonce, &act, block);
        asked!(self, Request::Order { mac, act }, Reply::Done => ())
    }

    /// The configuration in force.
    pub fn settings(&mut self) -> Result<Settings, LinkError> {
        let block = asked!(self, Request::ReadConfig, Reply::Config(block) => block)?;
        let (_, settings) = config_block::decode(&block).map_err(LinkError::Config)?;
        Ok(settings)
    }

    /// Puts another configuration in force: staged, read back, and only then. The controller restarts with it.
    pub fn set_block(&mut self, block: &Block) -> Result<(), LinkError> {
        let taken = self.ask(&Request::Stage(block.clone()))?;
        let (_, settings) = config_block::decode(block).map_err(LinkError::Config)?;
        let sent = Reply::Config(config_block::blanked(block, settings.key.is_some()));
        let Some(checksum) = block.last_chunk().filter(|_| taken == sent) else {
            return Err(LinkError::Senseless);
        };
        self.order_about(Act::Commit(u32::from_le_bytes(*checksum)), block)
    }

    /// Where the rotor has been: every `step`-th of the newest samples.
    pub fn recent(&mut self, step: u16) -> Result<Recent, LinkError> {
        asked!(self, Request::Recent { step }, Reply::Recent(recent) => recent)
    }

    /// The lifetime counters; `None` where the controller has no log.
    pub fn lifetime(&mut self) -> Result<Option<Counters>, LinkError> {
        asked!(self, Request::Lifetime, Reply::Lifetime(counters) => counters)
    }

    /// Numbers of the first and of the last episode in the log.
    pub fn episodes(&mut self) -> Result<Option<(u32, u32)>, LinkError> {
        asked!(self, Request::Episodes, Reply::Episodes(range) => range)
    }

    /// Bytes of an episode from `offset` on, and how many the whole has; `None` where there is no such episode.
    pub fn chunk(
        &mut self,
        episode: u32,
        offset: u32,
    ) -> Result<Option<(u32, Vec<u8>)>, LinkError> {
        match self.ask(&Request::Fetch { episode, offset }) {
            Ok(Reply::Chunk { total, bytes }) => Ok(Some((total, bytes.to_vec()))),
            Ok(_) => Err(LinkError::Senseless),
            Err(LinkError::Refused(Refusal::NoEpisode)) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// All bytes of an episode; `None` where there is none. `progress` hears how many are there of how many.
    pub fn episode(
        &mut self,
        episode: u32,
        mut progress: impl FnMut(u32, u32),
    ) -> Result<Option<Vec<u8>>, LinkError> {
        let mut bytes = Vec::new();
        while let Some((total, chunk)) = self.chunk(episode, bytes.len() as u32)? {
            if total > LONGEST_EPISODE {
                return Err(LinkError::Senseless);
            }
            bytes.extend(&chunk);
            progress(bytes.len() as u32, total);
            if chunk.is_empty() || bytes.len() as u32 >= total {
                return Ok(Some(bytes));
            }
        }
        Ok(None)
    }

    /// The next whole frame until `end`.
    fn receive(&mut self, end: Instant) -> Result<Option<(u8, Reply)>, LinkError> {
        loop {
            while let Some(byte) = self.bytes.pop_front() {
                match self.decoder.take::<Reply>(byte) {
                    None => {}
                    Some(Ok(received)) => return Ok(Some((received.sequence, received.message))),
                    Some(Err(FrameError::Version(version))) => {
                        return Err(LinkError::Version(version));
                    }
                    Some(Err(_)) => self.damaged = self.damaged.saturating_add(1),
                }
            }
            let limit = end.saturating_duration_since(Instant::now());
            if limit.is_zero() {
                return Ok(None);
            }
            let mut bytes = [0; 512];
            let came = self.line.read(&mut bytes, limit)?;
            self.bytes.extend(&bytes[..came]);
        }
    }

    /// What is no answer, for [`Self::listen`]. An answer that comes too late is none any more.
    fn keep(&mut self, reply: Reply) {
        let told = match reply {
            Reply::State(state) => Some(Told::State(state)),
            Reply::Notice(bytes) => match decode_record(&bytes) {
                Some(Record::Notice(notice)) => Some(Told::Notice(notice)),
                _ => {
                    self.damaged = self.damaged.saturating_add(1);
                    None
                }
            },
            _ => None,
        };
        if self.told.len() == KEPT {
            self.told.pop_front();
        }
        self.told.extend(told);
    }
}

/// Whether `reply` can be the answer to `request`. What comes by itself may have its sequence number.
fn answers(request: &Request, reply: &Reply) -> bool {
    match reply {
        Reply::Notice(_) => false,
        Reply::State(_) => matches!(request, Request::State),
        _ => true,
    }
}
