//! Charts as SVG, tables, and the shell of a page that loads nothing from outside.

pub mod plot;
pub mod shell;
pub mod table;
pub mod text;
pub mod waveform;
