//! The campaigns: score, limits, paper, trade, design guide.

automod::dir!("claims/lab");
