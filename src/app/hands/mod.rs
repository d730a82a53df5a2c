//! Several hands in one window: the list of them, and what a person does with it.

pub mod action;
mod leading;
pub mod list;
pub(crate) mod work;
