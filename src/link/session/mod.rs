//! One conversation with one hand: owner of the wire, arming and hold, requests, reconnecting.

pub(crate) mod adapter;
pub(crate) mod conversation;
pub(crate) mod counters;
pub(crate) mod feedback_watch;
pub(crate) mod hold;
pub(crate) mod identify;
pub(crate) mod job;
pub mod motion;
pub(crate) mod other_controller;
pub(crate) mod polling;
pub(crate) mod requests;
pub(crate) mod rest;
pub(crate) mod save_watch;
#[cfg(test)]
pub(crate) mod save_watch_tests;
pub(crate) mod serve;
pub(crate) mod setpoint_watch;
pub(crate) mod settings;
