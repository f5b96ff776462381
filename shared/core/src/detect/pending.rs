//! A fall that has been declared and is neither confirmed nor withdrawn.

use crate::event::Moment;

/// Blocks in a row in which a rotor is pulled back that the magnets hold.
const IN_A_ROW: u32 = 3;

/// A straight way, from a declaration on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StraightWay {
    /// m.
    pub(crate) position: [f32; 2],
    /// m a sample.
    pub(crate) step: [f32; 2],
}

/// A declared fall that is neither confirmed nor withdrawn.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pending {
    pub(crate) number: u16,
    /// Its onset.
    pub(crate) since: Moment,
    pub(crate) declared: Moment,
    /// Where the rotor would be: with the orbit ended in its tangent, and without it.
    pub(crate) paths: [StraightWay; 2],
    /// Blocks in a row in which it has come back.
    pub(crate) back: u8,
    /// Of each block since the declaration, the newest in the lowest bit: whether it was pulled back harder than by gravity.
    pub(crate) pulled: u32,
}

impl Pending {
    /// Whether the magnets held it before the last so many blocks.
    pub(crate) fn was_held(&self, blocks: u32) -> bool {
        let all = (1 << IN_A_ROW) - 1;
        self.pulled.checked_shr(blocks).unwrap_or(0) & all == all
    }

    /// Where the rotor would be, m.
    pub(crate) fn would_be(&self, now: Moment) -> [f32; 2] {
        let [_, StraightWay { position, step }] = self.paths;
        let passed = now.since(self.declared);
        [0, 1].map(|axis| position[axis] + step[axis] * passed)
    }
}
