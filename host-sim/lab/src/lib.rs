//! Campaigns that measure model and detector against the independent reference.

pub mod score;

pub mod limits;

pub mod paper;

pub mod trade;
