//! What can be wrong with a configuration.

use core::fmt;

/// A rule that a parameter breaks, and the parameter's name.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConfigError {
    /// NaN or infinite.
    NotFinite(&'static str),
    /// Must be above zero.
    NotPositive(&'static str),
    /// Must be zero or more.
    Negative(&'static str),
    /// Outside its range; the text states the range.
    OutOfRange(&'static str, &'static str),
    /// Contradicts another parameter; the text states the rule.
    Inconsistent(&'static str, &'static str),
}

impl ConfigError {
    /// The parameter that breaks the rule.
    pub const fn parameter(&self) -> &'static str {
        match *self {
            Self::NotFinite(name)
            | Self::NotPositive(name)
            | Self::Negative(name)
            | Self::OutOfRange(name, _)
            | Self::Inconsistent(name, _) => name,
        }
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite(name) => write!(f, "{name} must be a finite number"),
            Self::NotPositive(name) => write!(f, "{name} must be above 0"),
            Self::Negative(name) => write!(f, "{name} must be 0 or more"),
            Self::OutOfRange(name, range) => write!(f, "{name} must be {range}"),
            Self::Inconsistent(name, rule) => write!(f, "{name}: {rule}"),
        }
    }
}

impl core::error::Error for ConfigError {}
