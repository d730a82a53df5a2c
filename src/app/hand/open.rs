//! An open link, a hand that is being left, and requests whose end is awaited.

use crate::app::notices::RequestKind;
use crate::hand::Moment;
use crate::link::{LinkHandle, MotionTurn, Records, RequestError};
use crate::store::BackgroundJob;
use crate::transport::Endpoint;

/// An open link.
#[derive(Debug)]
pub(crate) struct OpenLink {
    pub(crate) link: LinkHandle,
    pub(crate) records: Records,
    /// The turn at moving the hand, as long as no task has it.
    pub(crate) turn: MotionTurn,
}

impl OpenLink {
    /// With this link and what is heard of it.
    pub(crate) fn new((link, records): (LinkHandle, Records)) -> Self {
        Self {
            turn: link.take_turn(),
            link,
            records,
        }
    }
}

/// A hand that is being left: it was told to hold.
#[derive(Debug)]
pub(crate) struct Leaving {
    /// Where to go then; `None` = nowhere.
    pub(crate) to: Option<Endpoint>,
    pub(crate) told: Moment,
}

/// A request whose end is awaited.
#[derive(Debug)]
pub(crate) struct Pending {
    pub(crate) what: RequestKind,
    pub(crate) end: Option<BackgroundJob<Result<(), RequestError>>>,
}
