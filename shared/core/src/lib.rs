#![no_std]
#![forbid(unsafe_code)]
//! Touchdown of a rotor on active magnetic bearings: the phase detector and its monitor, which
//! run on the microcontroller and, with the same bits, on the desktop.
//!
//! Everything that runs per sample comes as three types: `XConfig` (SI units, public, validated), `X` (coefficients) and
//! `XState`. Building an `X` can fail; the per-sample call cannot: it is bounded, allocates nothing and never panics.

pub mod checksum;
pub mod config;
pub mod detect;
pub mod event;
pub mod fault;
pub mod forecast;
pub mod guard;
pub mod health;
pub mod learnt;
mod memory;
pub mod monitor;
pub mod oversampling;
pub mod phase;
pub mod sample;
pub mod sensing;
pub mod severity;
mod spin;
pub mod tachometer;
pub mod touch;
pub mod vector;
