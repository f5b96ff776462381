//! Whether every channel that is fitted is seen to work: one that tells the same count for 10 ms may be stuck, and a
//! stuck one reads as the stillest of rotors.

use crate::sample::CHANNELS;

/// Time without another count after which a channel counts as frozen, s: noise or orbit of a count changes it sooner.
const FROZEN: f32 = 0.01;
const TURN: u16 = CHANNELS as u16;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channels {
    /// A bit for each.
    fitted: u8,
    /// Of a look, whole turns: a sample for each channel in turn.
    samples: u16,
}

/// What was seen of the channels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ChannelsState {
    samples: u16,
    /// Counts at the begin of the look, and which channels have told another one since then.
    counts: [u16; CHANNELS],
    moved: u8,
    /// Whether a channel told one count throughout the last look.
    pub(super) frozen: bool,
}

impl Channels {
    pub(super) fn new(fitted: u8, sample_rate: f32) -> Self {
        let turns = ((FROZEN * sample_rate) as u16 / TURN).max(4);
        Self {
            fitted,
            samples: TURN * turns,
        }
    }

    /// Takes the counts of a sample.
    #[inline]
    pub(super) fn take(&self, state: &mut ChannelsState, counts: &[u16; CHANNELS]) {
        let channel = state.samples % TURN;
        let [now, then] = [counts, &state.counts].map(|it| it[usize::from(channel)]);
        if state.samples < TURN {
            state.counts[usize::from(channel)] = now;
            state.moved &= !(1 << channel);
        } else {
            state.moved |= u8::from(now != then) << channel;
        }
        state.samples += 1;
        if state.samples == self.samples {
            state.samples = 0;
            state.frozen = self.fitted & !state.moved != 0;
        }
    }
}
