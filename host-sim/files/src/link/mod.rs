//! The desktop's side of the serial link (`docs/formats/link.md`): asks the controller, and hears what it says
//! by itself.
//!
//! | file | says |
//! |---|---|
//! | `port` | what a person types, to a line: a serial device or a socket |
//! | `client` | requests, retries, answers |
//! | `key` | the key of the right to order, from its file |
//! | `error` | why there is no answer |

mod client;
mod error;
mod key;
mod port;

pub use client::{Client, Told};
pub use error::{LinkError, refused_why, why};
pub use key::load as load_key;
pub(crate) use key::parse as parse_key;
pub use port::{Line, Port};
