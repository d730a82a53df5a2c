//! A person's own poses and sequences: the library, its file, and what plays them. Sends nothing; `act_poses` does.

pub mod book;
pub mod edit;
pub mod file;
pub mod library;
pub mod player;
pub mod preview;
pub mod store;
#[cfg(test)]
mod tests;
