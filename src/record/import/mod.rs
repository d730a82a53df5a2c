//! Imports recordings from other formats. Data missing there stays unknown.

pub mod csv;
mod lines;
