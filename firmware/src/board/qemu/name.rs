//! The name of a file of the desktop.

use core::ffi::CStr;

const NAME_BYTES: usize = 256;

/// A file's name, with the zero that ends it.
pub struct Name([u8; NAME_BYTES]);

impl Name {
    /// Nothing where it is too long.
    pub fn new(name: &str) -> Option<Self> {
        let mut bytes = [0; NAME_BYTES];
        let (bytes_of_name, [_, ..]) = bytes.split_at_mut_checked(name.len())? else {
            return None;
        };
        bytes_of_name.copy_from_slice(name.as_bytes());
        Some(Self(bytes))
    }

    /// The name.
    pub fn get(&self) -> &CStr {
        CStr::from_bytes_until_nul(&self.0).unwrap_or_default()
    }
}
