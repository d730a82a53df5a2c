//! The session with one hand: owns the wire, and handles arming, holding, requests and reconnecting.

mod absence;
mod adapter;
pub(crate) mod conversation;
pub(crate) mod counters;
pub(crate) mod hold;
pub(crate) mod identify;
pub(crate) mod job;
pub mod motion;
pub(crate) mod pending;
pub(crate) mod polling;
pub(crate) mod requests;
pub(crate) mod rest;
pub(crate) mod serve;
pub(crate) mod settings;
pub(crate) mod stall;
pub(crate) mod watch;
