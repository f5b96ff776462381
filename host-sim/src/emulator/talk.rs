//! The desktop's side of the link to the image: docs/link.md.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use touchdown_core::link::{Decoder, Hello, Received, Refusal, Reply, Request, State, encode};

/// How long an answer may take before the request is sent again; then twice as long, up to the longest.
const PATIENCE: Duration = Duration::from_millis(200);
const LONGEST: Duration = Duration::from_secs(2);
/// Requests before it is given up: 35 s, for an emulator on a busy desktop.
const TRIES: u32 = 20;

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum TalkError {
    /// Of the socket.
    #[error("the link is broken")]
    Line(#[from] io::Error),
    /// None came, however often it was asked.
    #[error("the link does not answer")]
    Silent,
    /// It says no.
    #[error("refused: {0:?}")]
    Refused(Refusal),
}

/// The link over a socket.
#[derive(Debug)]
pub struct Talk {
    line: TcpStream,
    decoder: Decoder,
    sequence: u8,
    /// What came by itself, in its order.
    pub heard: Vec<Reply>,
    /// Frames that came damaged.
    pub damaged: u32,
    /// Requests that were sent again.
    pub repeated: u32,
}

impl Talk {
    /// Over `line`.
    pub fn new(line: TcpStream) -> io::Result<Self> {
        line.set_nodelay(true)?;
        line.set_read_timeout(Some(Duration::from_millis(10)))?;
        Ok(Self {
            line,
            decoder: Decoder::default(),
            sequence: 0,
            heard: Vec::new(),
            damaged: 0,
            repeated: 0,
        })
    }

    /// Asks until there is an answer.
    pub fn ask(&mut self, request: &Request) -> Result<Reply, TalkError> {
        // Of all tries: the answer to an earlier one is as good.
        self.sequence = self.sequence.wrapping_add(1);
        let mut patience = PATIENCE;
        for attempt in 0..TRIES {
            self.repeated += u32::from(attempt > 0);
            let frame = encode(self.sequence, request).expect("a request fits a frame");
            // The zero before it ends what noise began.
            self.line.write_all(&[0])?;
            self.line.write_all(&frame)?;
            let sent = Instant::now();
            while sent.elapsed() < patience {
                let mut answer = None;
                for Received { sequence, message } in self.listen()? {
                    if sequence == self.sequence && answers(&message, request) {
                        answer = Some(message);
                    } else {
                        self.heard.push(message);
                    }
                }
                if let Some(answer) = answer {
                    return Ok(answer);
                }
            }
            patience = LONGEST.min(2 * patience);
        }
        Err(TalkError::Silent)
    }

    /// What has come; waits a little where nothing has.
    pub fn listen(&mut self) -> Result<Vec<Received<Reply>>, TalkError> {
        let mut bytes = [0; 4096];
        let read = match self.line.read(&mut bytes) {
            Ok(0) => return Err(io::Error::from(ErrorKind::UnexpectedEof).into()),
            Ok(read) => read,
            Err(e) if [ErrorKind::WouldBlock, ErrorKind::TimedOut].contains(&e.kind()) => 0,
            Err(e) => return Err(e.into()),
        };
        let frames = bytes[..read].iter();
        let frames: Vec<_> = frames.filter_map(|it| self.decoder.take(*it)).collect();
        self.damaged += frames.iter().filter(|it| it.is_err()).count() as u32;
        Ok(frames.into_iter().flatten().collect())
    }

    /// Who is there.
    pub fn hello(&mut self) -> Result<Hello, TalkError> {
        match self.ask(&Request::Hello)? {
            Reply::Hello(hello) => Ok(hello),
            other => unreachable!("{other:?} answers no Hello"),
        }
    }

    /// What goes on.
    pub fn state(&mut self) -> Result<State, TalkError> {
        match self.ask(&Request::State)? {
            Reply::State(state) => Ok(state),
            other => unreachable!("{other:?} answers no State"),
        }
    }

    /// Number of the first and the last episode.
    pub fn episodes(&mut self) -> Result<Option<(u32, u32)>, TalkError> {
        match self.ask(&Request::Episodes)? {
            Reply::Episodes(numbers) => Ok(numbers),
            other => unreachable!("{other:?} answers no Episodes"),
        }
    }

    /// SetConfig, Clear or Erase.
    pub fn order(&mut self, request: &Request) -> Result<(), TalkError> {
        match self.ask(request)? {
            Reply::Refused(why) => Err(TalkError::Refused(why)),
            _ => Ok(()),
        }
    }

    /// All bytes of an episode.
    pub fn fetch(&mut self, episode: u32) -> Result<Vec<u8>, TalkError> {
        let mut whole = Vec::new();
        loop {
            let offset = whole.len() as u32;
            match self.ask(&Request::Fetch { episode, offset })? {
                Reply::Chunk { bytes, .. } if bytes.is_empty() => return Ok(whole),
                Reply::Chunk { bytes, .. } => whole.extend_from_slice(&bytes),
                Reply::Refused(why) => return Err(TalkError::Refused(why)),
                other => unreachable!("{other:?} answers no Fetch"),
            }
        }
    }
}

/// Whether `reply` is of the kind that `request` is answered with: what comes by itself may have its
/// number.
fn answers(reply: &Reply, request: &Request) -> bool {
    let is_order = matches!(
        request,
        Request::SetConfig(_) | Request::Clear | Request::Erase { .. }
    );
    match reply {
        Reply::Hello(_) => matches!(request, Request::Hello),
        Reply::State(_) => matches!(request, Request::State),
        Reply::Config(_) => matches!(request, Request::ReadConfig),
        Reply::Episodes(_) => matches!(request, Request::Episodes),
        Reply::Chunk { .. } => matches!(request, Request::Fetch { .. }),
        Reply::Done => is_order,
        Reply::Refused(_) => is_order || matches!(request, Request::Fetch { .. }),
        _ => false,
    }
}
