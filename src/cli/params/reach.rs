//! Connection to the hand for parameter commands: one link at a time, at each possible address.

use crate::app::files::settings_file;
use crate::cli::params::words;
use crate::cli::session::{self, ANSWER_TIMEOUT, PORT_RESTS};
use crate::hand::overshoot::OvershootMap;
use crate::link::{Clock, LinkHandle, PollRates};
use crate::tasks::hand::answers;
use crate::tasks::{Question, Reach};
use crate::transport::Endpoint;
use crate::trials::overshoot_file;
use std::sync::Arc;
use tokio::time::sleep;

/// Rate that suffices to detect motion of the hand.
const ONLY_THE_STATE: PollRates = PollRates {
    state_hz: 20.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

/// Opens the link and waits for the hand. Must be called within a tokio runtime.
pub(crate) async fn open(hand: &Endpoint) -> anyhow::Result<LinkHandle> {
    session::reach(hand, ONLY_THE_STATE).await
}

/// Opens one link after another at the possible addresses of the hand.
#[derive(Default)]
pub(crate) struct LinkOpener {
    has_been_open: bool,
}

impl Reach for LinkOpener {
    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        if std::mem::replace(&mut self.has_been_open, true) {
            sleep(PORT_RESTS).await;
        }
        let link = session::open(place, ONLY_THE_STATE, Clock::start());
        answers(&link, ANSWER_TIMEOUT).await.then_some(link)
    }
}

/// The user's answers on the command line: risks need --yes, and are named. A change of address is kept, and not saved, because SAVE
/// is a separate command.
pub(crate) fn answers_of(yes: bool) -> impl FnMut(&Question) -> bool + Send {
    move |question| match question {
        Question::Apply(risks) | Question::Save(risks) => {
            if yes {
                words::warn(risks);
            }
            yes
        }
        Question::KeepPlace(_) => true,
        Question::SavePlace(_) => false,
    }
}

/// Measured overshoot of a hand, used by its warnings. If it cannot be read, the warnings use data of another hand.
pub(crate) fn overshoot(hand: &Endpoint) -> Arc<OvershootMap> {
    let file =
        settings_file::default_path().and_then(|settings| overshoot_file::file_of(&settings, hand));
    let map = file.and_then(|file| overshoot_file::read(&file).ok());
    Arc::new(map.unwrap_or_default())
}
