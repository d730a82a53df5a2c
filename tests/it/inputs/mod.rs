//! A hand that follows what another program sends.

mod dds;
mod follow;
mod hold;
mod mirror;
mod pad;
pub(crate) mod stops;
mod stream;
