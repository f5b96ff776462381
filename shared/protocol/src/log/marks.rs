//! Marks on an episode's slot, made by clearing bits of a page that is otherwise erased.

/// Bytes of the marks.
pub const MARKS_BYTES: usize = 32;
/// Bytes of the mark that the episode is given up, at their beginning.
pub const RELEASE_BYTES: usize = 8;

/// State of a slot's marks. A mark counts as made once half of its bits are cleared, so one wrong
/// bit makes none and undoes none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// Given up: about to be erased.
    pub released: bool,
    /// To be kept.
    pub locked: bool,
    /// Place of the byte that is cleared to lock or unlock; `None` when all are used up.
    pub toggle: Option<u8>,
}

impl Marks {
    /// From the page's first bytes.
    pub fn decode(bytes: &[u8; MARKS_BYTES]) -> Self {
        let (release, toggles) = bytes.split_at(RELEASE_BYTES);
        let cleared: u32 = release.iter().map(|byte| byte.count_zeros()).sum();
        let made = |byte: &&u8| byte.count_zeros() >= 4;
        let used = toggles.iter().take_while(made).count();
        Self {
            released: cleared >= 4 * RELEASE_BYTES as u32,
            locked: used % 2 == 1,
            toggle: (used < toggles.len()).then_some((RELEASE_BYTES + used) as u8),
        }
    }
}
