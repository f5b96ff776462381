//! The program: its commands, files, outputs and views.

automod::dir!("claims/tools");
