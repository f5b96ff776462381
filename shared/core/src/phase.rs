//! The phase of a drop.

/// Phase of the rotor, or of one end of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
#[derive(serde::Serialize, serde::Deserialize)]
pub enum Phase {
    /// Switched on, not judged yet.
    #[default]
    Starting = 0,
    /// Floating.
    Levitated = 1,
    /// In flight, before the first impact or after a lift-off.
    #[strum(serialize = "free fall")]
    FreeFall = 2,
    /// Between impacts.
    #[strum(serialize = "impacts")]
    Impact = 3,
    /// Permanent contact with slip, or not yet known.
    Sliding = 4,
    /// Permanent contact without.
    Rolling = 5,
}

impl Phase {
    /// Whether in permanent contact.
    pub const fn is_contact(self) -> bool {
        matches!(self, Self::Sliding | Self::Rolling)
    }
}
