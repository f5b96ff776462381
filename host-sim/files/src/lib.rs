//! What is read and written: streams, recordings, configurations, drop logs, and the link to a controller.

pub mod stream;

pub mod recording;

pub mod configuration;
pub mod controller;
pub mod drop_log;
pub mod link;
pub mod ram_nor;
