//! A hand that follows what another program sends.

mod follow;
mod mirror;
mod stream;
