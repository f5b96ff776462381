//! The detector, its faults, severity and forecast.

automod::dir!("claims/detector");
