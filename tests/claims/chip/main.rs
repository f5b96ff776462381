//! The images, in the emulator.

automod::dir!("claims/chip");
