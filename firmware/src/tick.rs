//! One sample through application and record, and those that were never taken before it.

use touchdown_core::event::Notices;
use touchdown_core::sample::Sample;

use crate::app::App;
use crate::board::Board;
use crate::recorder::Recorder;

/// Missed samples in a row whose time goes on in the monitor: 1 ms at 20 kHz, for which it trips. Those beyond are told
/// and not made up for.
const MOST_MISSED: u32 = 20;

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
        app.take(board, sample, missed, lost, notices);
        recorder.set_severity(app.state().severity());
        recorder.set_phase(app.state().phase(), app.shown());
        recorder.take(sample, notices);
        recorder.keep(app.state());
        if !missed {
            return;
        }
        left -= 1;
    }
}
