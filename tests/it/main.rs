//! What the program promises, tried from outside, one folder an area. `setup` is the one way to put a program, a link or a
//! simulated hand up for a test.
#![cfg(test)]
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "numbers of tests are small, and clippy.toml cannot excuse them"
)]

mod cli;
mod fuzz;
mod inputs;
#[cfg(unix)]
mod layers;
mod licences;
mod link;
mod looks;
mod manual;
mod pad;
mod place_changes;
mod program;
mod record;
#[cfg(unix)]
mod seams;
#[cfg(unix)]
mod session;
mod setup;
mod share;
mod sim;
mod trials;
mod view;
mod window;
