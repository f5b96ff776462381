//! One sample through application and record, and those that were never taken before it.

use heapless::Deque;
use touchdown_core::event::{Notice, Notices};
use touchdown_core::sample::Sample;
use touchdown_protocol::controller::{Cause, Outputs, Shown};

use crate::app::App;
use crate::board::Board;
use crate::intake::Waiting;
use crate::recorder::Recorder;

/// Missed samples in a row whose time goes on in the monitor: 1 ms at 20 kHz, 2 ms at 10 kHz. It trips after 1 ms. Those beyond are
/// told and not made up for.
const MOST_MISSED: u32 = 20;
/// Samples in a row, after which the others wait for a turn of the main loop: an order over the link is heard also while ticks
/// take all the time.
const IN_A_ROW: u32 = 32;
/// Sample periods that they wait at most. A main loop that hangs stops no tick.
const LONGEST_WAIT: u32 = 8;
/// Notices on their way to log and link. If it is full they are lost and counted; events are numbered, so a gap shows.
pub type Outbox = Deque<Notice, 48>;

/// One sample, before which `lost` were lost. What the monitor said to it is left in `notices`.
#[inline]
pub fn tick(
    app: &mut App,
    recorder: &mut Recorder<'_>,
    board: &mut impl Board,
    sample: &Sample,
    lost: u32,
    notices: &mut Notices,
) {
    let before = sample.missed();
    let mut left = lost.min(MOST_MISSED);
    loop {
        let missed = left > 0;
        let sample = if missed { &before } else { sample };
        let shown = app.take(board, sample, missed, lost, notices);
        recorder.set_severity(&app.state().severity.so_far);
        recorder.set_phase(app.state().detector.phase(), shown);
        recorder.take(sample, notices);
        recorder.keep(app.state());
        if !missed {
            return;
        }
        left -= 1;
    }
}

/// Who takes the samples out of the ring.
pub struct TickTask<'m, B> {
    /// The application.
    pub app: &'m mut App,
    /// The record.
    pub recorder: &'m mut Recorder<'m>,
    /// The board, and what it is told.
    pub desk: Desk<'m, B>,
    notices: Notices,
    /// Number of the next sample.
    next: u32,
    /// Samples since the main loop's last turn began, and periods that one has waited for the next turn.
    row: u32,
}

impl<'m, B: Board> TickTask<'m, B> {
    /// Over a ring of which nothing was taken yet.
    pub fn new(
        app: &'m mut App,
        recorder: &'m mut Recorder<'m>,
        board: B,
        outbox: &'m mut Outbox,
        waiting: Waiting<'m>,
    ) -> Self {
        Self {
            app,
            recorder,
            desk: Desk {
                board,
                outbox,
                lost_notices: 0,
                waiting,
                number: 0,
                service: false,
            },
            notices: Notices::new(),
            next: 0,
            row: 0,
        }
    }

    /// A turn of the main loop begins; how many samples there were.
    pub fn begin_turn(&mut self) -> u64 {
        self.row = 0;
        self.app.state().samples
    }

    /// The oldest sample that waits, if there is one and it is not the main loop's turn.
    #[inline]
    pub fn step(&mut self) -> bool {
        if (IN_A_ROW..IN_A_ROW + LONGEST_WAIT).contains(&self.row) {
            self.row += 1;
            return false;
        }
        let Some((arrival, number)) = self.desk.waiting.pop() else {
            return false;
        };
        if self.row == IN_A_ROW + LONGEST_WAIT {
            self.row = 0;
        }
        self.row += 1;
        let lost = number.wrapping_sub(self.next);
        self.next = number.wrapping_add(1);
        (self.desk.number, self.desk.service) = (number, arrival.service);
        if arrival.clear {
            let notice = self.app.clear_as_ordered();
            self.hear(&notice);
        }
        if self.desk.waiting.gate.is_overruled(number) {
            self.app.trip(Cause::Danger);
        }
        let (desk, notices) = (&mut self.desk, &mut self.notices);
        tick(
            self.app,
            self.recorder,
            desk,
            &arrival.sample,
            lost,
            notices,
        );
        true
    }

    /// A notice that does not come from a tick.
    pub fn hear(&mut self, notice: &Notice) {
        self.desk.report(notice);
        self.recorder.hear(notice);
    }
}

/// The board, as the tick sees it, and what waits for log and link.
pub struct Desk<'m, B> {
    /// The board.
    pub board: B,
    /// On their way.
    pub outbox: &'m mut Outbox,
    /// For which it had no room.
    pub lost_notices: u32,
    /// Whether the service input was on at the last sample.
    pub service: bool,
    waiting: Waiting<'m>,
    /// Of the sample whose tick it is.
    number: u32,
}

impl<B: Board> Board for Desk<'_, B> {
    fn report(&mut self, notice: &Notice) {
        let is_lost = self.outbox.push_back(*notice).is_err();
        self.lost_notices = self.lost_notices.saturating_add(u32::from(is_lost));
        self.board.report(notice);
    }

    fn drive(&mut self, shown: Shown) {
        let gate = self.waiting.gate;
        let outputs = gate.pass(shown.outputs, self.number);
        self.board.drive(Shown { outputs, ..shown });
        // The guard on top may have come in between.
        if gate.is_tripped() && outputs != Outputs::SAFE {
            let outputs = Outputs::SAFE;
            self.board.drive(Shown { outputs, ..shown });
        }
    }

    fn config(&self) -> &[u8] {
        self.board.config()
    }

    fn feed(&mut self) {
        self.board.feed();
    }
}
