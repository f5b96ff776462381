//! Campaigns that measure model and detector against the independent reference.

pub mod score;

pub mod limits;

pub mod paper;

pub mod trade;

pub mod forecast_score;
pub mod severity_score;
