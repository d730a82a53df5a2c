//! How a task under a card goes where the hand is: the program opens the link there, so that the window shows what answers.

use crate::link::{LinkHandle, Wake};
use crate::tasks::Reach;
use crate::tasks::hand::{REACH_TIMEOUT, answers};
use crate::transport::Endpoint;
use futures::future::BoxFuture;
use tokio::sync::{mpsc, oneshot};

/// Asks the program for the link at a place.
#[derive(Debug)]
pub(crate) struct GoRequest {
    pub(crate) place: Endpoint,
    pub(crate) opened: oneshot::Sender<LinkHandle>,
}

/// Asks the program to go there.
pub(crate) struct Asking {
    pub(crate) requests: mpsc::Sender<GoRequest>,
    pub(crate) wake: Wake,
}

impl Reach for Asking {
    type Link = LinkHandle;

    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        let (opened, open) = oneshot::channel();
        let place = place.clone();
        self.requests.send(GoRequest { place, opened }).await.ok()?;
        (self.wake)();
        let hand = open.await.ok()?;
        answers(&hand, REACH_TIMEOUT).await.then_some(hand)
    }
}

/// What the user decides on the card; a card that is gone decides nothing.
pub(crate) fn decided(answer: oneshot::Receiver<bool>) -> BoxFuture<'static, bool> {
    Box::pin(async { answer.await.unwrap_or(false) })
}
