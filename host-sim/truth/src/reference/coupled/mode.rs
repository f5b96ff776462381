//! What a link does.

/// What a link does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// Apart.
    Flight,
    /// Slips with this sign; 0 without friction.
    Slide(f64),
    /// Without slip.
    Stick,
}
