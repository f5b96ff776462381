//! Runs model, detector and controller over a scene or a recording.

pub mod model;

pub mod accuracy;
pub mod controller_run;
pub mod controller_trace;
pub mod emulator;
pub mod target;

pub mod timebase;

pub mod detection;
pub mod outcome;
pub mod trace;

pub mod matching;

pub mod drop;
pub mod replay;

pub mod compare;

pub mod ensemble;
pub mod explain;
pub mod fidelity;
pub mod instructions;
