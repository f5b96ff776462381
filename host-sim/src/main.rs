//! The touchdown simulator.
fn main() {}
