//! Memory, measured over the whole process, and so alone in it.

automod::dir!("claims/memory");
