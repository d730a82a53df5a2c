//! How a task under a card goes where the hand is: the program opens the link there, so that the window shows what answers.

use crate::link::{LinkHandle, Wake};
use crate::tasks::Reach;
use crate::tasks::hand::{REACHED_WITHIN, answers};
use crate::tasks::place::Person;
use crate::transport::Endpoint;
use tokio::sync::{mpsc, oneshot};

/// A wish to have the link at a place.
#[derive(Debug)]
pub(crate) struct GoRequest {
    pub(crate) place: Endpoint,
    pub(crate) opened: oneshot::Sender<LinkHandle>,
}

/// Asks the program to go there.
pub(crate) struct Asking {
    pub(crate) wishes: mpsc::UnboundedSender<GoRequest>,
    pub(crate) wake: Wake,
}

impl Reach for Asking {
    type Hand = LinkHandle;

    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        let (opened, open) = oneshot::channel();
        let place = place.clone();
        self.wishes.send(GoRequest { place, opened }).ok()?;
        (self.wake)();
        let hand = open.await.ok()?;
        answers(&hand, REACHED_WITHIN).await.then_some(hand)
    }
}

/// A person at the card.
pub(crate) struct AtCard {
    pub(crate) keeps: Option<oneshot::Receiver<bool>>,
    pub(crate) saves: Option<oneshot::Receiver<bool>>,
}

impl Person for AtCard {
    async fn keeps(&mut self) -> bool {
        decided(&mut self.keeps).await
    }

    async fn saves(&mut self) -> bool {
        decided(&mut self.saves).await
    }
}

/// What was decided; a card that is gone decides nothing.
async fn decided(question: &mut Option<oneshot::Receiver<bool>>) -> bool {
    match question.take() {
        Some(question) => question.await.unwrap_or(false),
        None => false,
    }
}
