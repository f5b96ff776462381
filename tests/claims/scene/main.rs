//! Scenes: what is read, refused and chosen.

automod::dir!("claims/scene");
