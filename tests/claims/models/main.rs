//! The levels of fidelity beyond the rigid one.

automod::dir!("claims/models");
