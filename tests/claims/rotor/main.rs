//! The rigid model and its functions.

automod::dir!("claims/rotor");
