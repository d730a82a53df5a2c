//! How a command about parameters reaches the hand: one link at a time, and where it may be next.

use crate::app::files::settings_file;
use crate::cli::session::{self, ANSWER_TIMEOUT};
use crate::hand::overshoot::OvershootMap;
use crate::link::{Clock, LinkHandle, PollRates};
use crate::tasks::Reach;
use crate::tasks::hand::answers;
use crate::tasks::place::Decisions;
use crate::transport::Endpoint;
use crate::trials::overshoot_file;
use std::future::ready;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::sleep;

/// Often enough to see whether the hand moves.
const ONLY_THE_STATE: PollRates = PollRates {
    state_hz: 20.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};
/// Between giving up a port and taking it again.
const PORT_RESTS: Duration = Duration::from_millis(300);

/// Opens the link and waits for the hand. Must be called within a tokio runtime.
pub(crate) async fn open(hand: &Endpoint) -> anyhow::Result<LinkHandle> {
    session::reach(hand, ONLY_THE_STATE).await
}

/// Opens one link after the other, where the hand may be.
#[derive(Default)]
pub(crate) struct LinkOpener {
    has_been_open: bool,
}

impl Reach for LinkOpener {
    type Link = LinkHandle;

    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        if std::mem::replace(&mut self.has_been_open, true) {
            sleep(PORT_RESTS).await;
        }
        let link = session::open(place, ONLY_THE_STATE, Clock::start());
        answers(&link, ANSWER_TIMEOUT).await.then_some(link)
    }
}

/// Who said --yes keeps what was asked for; SAVE is a command of its own.
pub(crate) fn said_yes() -> Decisions {
    Decisions {
        keeps: Box::pin(ready(true)),
        saves: Box::pin(ready(false)),
    }
}

/// What trials measured of a hand, by which its warnings go. Where that cannot be read they go by another hand.
pub(crate) fn overshoot(hand: &Endpoint) -> Arc<OvershootMap> {
    let file =
        settings_file::default_path().and_then(|settings| overshoot_file::file_of(&settings, hand));
    let map = file.and_then(|file| overshoot_file::read(&file).ok());
    Arc::new(map.unwrap_or_default())
}
