//! What the pulse channels know of a ring, and channels that go on from there.

use heapless::Vec;
use serde::{Deserialize, Serialize};

use super::TachometersState;
use super::channel::{ChannelState, Edge, KEPT, Trend};
use crate::event::Moment;
use crate::sample::TACHOMETERS;

/// Of each channel.
pub(crate) type Rings = [Ring; TACHOMETERS];

/// What a channel carries from sample to sample, in a third of the room.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Ring {
    last: Option<Past>,
    /// Oldest first.
    kept: Vec<Past, KEPT>,
    trend: Option<Trend>,
}

/// An edge.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Past {
    count: u16,
    /// Before the next sample, in 1/256 of a sample period; what is longer ago stays at the greatest value.
    ago: u32,
}

impl Past {
    fn of(edge: Edge, next: Moment) -> Self {
        let ago = (next.0 - edge.at.0).min(i64::from(u32::MAX));
        Self {
            count: edge.count,
            ago: ago as u32,
        }
    }
}

impl From<Past> for Edge {
    fn from(it: Past) -> Self {
        Self {
            count: it.count,
            at: Moment(-i64::from(it.ago)),
        }
    }
}

/// Takes over what `state` knows before the sample `next`.
pub(crate) fn update(rings: &mut Rings, state: &TachometersState, next: Moment) {
    for (ring, state) in rings.iter_mut().zip(&state.0) {
        ring.update(state, next);
    }
}

/// Whether any channel has shown a value.
pub(crate) fn are_known(rings: &Rings) -> bool {
    rings.iter().any(|it| it.last.is_some())
}

impl Ring {
    // One copy of it for all channels: flash is scarce.
    #[inline(never)]
    fn update(&mut self, state: &ChannelState, next: Moment) {
        self.last = state.last.map(|edge| Past::of(edge, next));
        self.trend = state.trend;
        self.kept.clear();
        for steps in (0..state.filled).rev() {
            if let Some(edge) = state.back(steps) {
                // They are as many as there is room for.
                let _ = self.kept.push(Past::of(edge, next));
            }
        }
    }
}

impl From<&Rings> for TachometersState {
    /// The state before the sample that follows, which gets number 0.
    fn from(rings: &Rings) -> Self {
        Self(rings.each_ref().map(|ring| {
            let mut state = ChannelState {
                last: ring.last.map(Edge::from),
                filled: ring.kept.len(),
                newest: ring.kept.len().saturating_sub(1),
                trend: ring.trend,
                ..ChannelState::default()
            };
            for (slot, past) in state.kept.iter_mut().zip(&ring.kept) {
                *slot = (*past).into();
            }
            state
        }))
    }
}
