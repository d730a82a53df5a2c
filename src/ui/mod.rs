//! The window: reads [`crate::app::state::State`], draws it with egui, returns actions. No clock, file, thread or wire.

mod checkup;
mod connection;
mod exhibit;
mod faults;
pub(crate) mod hand;
pub(crate) mod hands;
mod inputs;
mod joints;
pub(crate) mod kit;
mod params;
mod plots;
mod poses;
mod recordings;
mod style;
mod text;
mod theme;
mod touch;
mod traffic;
pub(crate) mod trials;
pub(crate) mod view;
mod window;

pub use view::View;
pub use window::{Window, install};
