//! The program without drawing: state, actions, and their handling.

pub mod action;
pub mod checkup;
pub mod connect;
pub mod effect;
pub mod env;
pub mod exhibit;
pub mod files;
pub mod fleet;
pub mod hand;
pub mod hands;
pub mod inputs;
pub mod layout;
pub mod notices;
pub mod params;
pub mod poses;
pub mod procedures;
pub mod program;
pub mod readings;
pub mod recordings;
pub(crate) mod replay;
pub mod scan;
pub mod settings;
pub mod slot;
pub mod state;
pub mod trials;
