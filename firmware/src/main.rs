//! The touchdown monitor on an STM32F405.
fn main() {}
