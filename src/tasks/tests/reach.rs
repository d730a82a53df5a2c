//! The way to the hand of tests.

use crate::fake::{Asked, FakeHand};
use crate::link::LinkHandle;
use crate::params::place;
use crate::params::rows::{ParamId, Value};
use crate::tasks::Reach;
use crate::transport::Endpoint;

/// Goes where the hand may be: it is there where `is_there` says so.
pub(crate) struct FakeReach<F> {
    pub(crate) hand: FakeHand,
    pub(crate) is_there: F,
}

impl<F: FnMut(&Endpoint) -> bool + Send> Reach for FakeReach<F> {
    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        (self.is_there)(place).then(|| LinkHandle::clone(&self.hand))
    }
}

/// The write of a row by which a hand is found.
pub(crate) fn place_write(id: ParamId, value: Value) -> Asked {
    Asked::SetUnread(place::setting(id, value).unwrap())
}
