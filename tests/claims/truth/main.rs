//! The independent reference.

automod::dir!("claims/truth");
