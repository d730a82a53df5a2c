//! A hand that follows what another program sends.

mod follow;
mod stream;
