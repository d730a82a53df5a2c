//! Keeps the quirk sheet of the hand that answers now, off the window's thread, and says where it differs from the one of
//! last time. Decides nothing about the hand.

use crate::app::calendar::{day, since_1970};
use crate::app::notices::NoticeKind;
use crate::app::quirk_sheet::{QuirkBook, QuirkSheet};
use crate::app::state::State;
use crate::link::Quirks;
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};
use tokio::sync::oneshot;

/// The sheet from before, and the one of now.
type Kept = (Option<QuirkSheet>, QuirkSheet);

/// Notes each hand once for what it answers.
#[derive(Debug)]
pub(crate) struct SheetKeeper {
    path: Option<PathBuf>,
    runtime: tokio::runtime::Handle,
    noted: Option<(Endpoint, Quirks)>,
    under_way: Option<oneshot::Receiver<io::Result<Kept>>>,
}

impl SheetKeeper {
    /// Keeps the book beside the settings; without settings nowhere.
    pub(crate) fn new(settings: Option<&Path>, runtime: tokio::runtime::Handle) -> Self {
        Self {
            path: settings.map(QuirkBook::path),
            runtime,
            noted: None,
            under_way: None,
        }
    }

    /// Notes a hand that is new or answers otherwise. What came of an earlier note goes into the state, and comes back
    /// where a person should know it.
    pub(crate) fn tick(&mut self, state: &mut State) -> Option<NoticeKind> {
        let told = self.finished(state);
        let quirks = state.link.quirks;
        let hand = state.endpoint.as_ref().filter(|hand| !hand.is_sim());
        let new = hand.filter(|hand| {
            let noted = self.noted.as_ref();
            state.link.state.is_live()
                && noted.is_none_or(|noted| (&noted.0, noted.1) != (hand, quirks))
        });
        if let Some(hand) = new.filter(|_| self.under_way.is_none()) {
            self.noted = Some((hand.clone(), quirks));
            self.begin(hand.clone(), quirks);
        }
        told
    }

    fn begin(&mut self, hand: Endpoint, quirks: Quirks) {
        let Some(path) = self.path.clone() else {
            return;
        };
        let (done, under_way) = oneshot::channel();
        self.runtime.spawn_blocking(move || {
            let mut now = QuirkSheet::new(&hand, &quirks, &day(since_1970()));
            let kept = QuirkBook::keep(&path, now.clone()).map(|before| {
                if let Some(before) = &before {
                    now.first_seen.clone_from(&before.first_seen);
                }
                (before, now)
            });
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = done.send(kept);
        });
        self.under_way = Some(under_way);
    }

    fn finished(&mut self, state: &mut State) -> Option<NoticeKind> {
        let kept = match self.under_way.as_mut()?.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return None,
            Err(oneshot::error::TryRecvError::Closed) => {
                Err(io::Error::other("the program is ending"))
            }
            Ok(kept) => kept,
        };
        self.under_way = None;
        match kept {
            Err(error) => Some(NoticeKind::SheetNotKept {
                message: error.to_string(),
            }),
            Ok((before, now)) => {
                let differences = before.as_ref().map(|before| before.differences(&now));
                state.sheet = Some(now);
                let differences = differences.filter(|found| !found.is_empty())?;
                Some(NoticeKind::HandDiffers {
                    differences,
                    last_seen: before.map(|before| before.last_seen).unwrap_or_default(),
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::app::desk::Desk;
    use crate::app::quirk_sheet::Fact;
    use crate::app::settings::Settings;
    use crate::link::LinkState;

    async fn settled(keeper: &mut SheetKeeper, state: &mut State) -> Option<NoticeKind> {
        let first = keeper.tick(state);
        while keeper.under_way.is_some() {
            if let Some(told) = keeper.tick(state) {
                return Some(told);
            }
            tokio::task::yield_now().await;
        }
        first
    }

    #[tokio::test]
    async fn another_hand_at_the_same_address_is_said_and_a_simulated_one_is_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let settings = folder.path().join("settings.toml");
        let runtime = tokio::runtime::Handle::current();
        let mut keeper = SheetKeeper::new(Some(&settings), runtime);
        let mut state = Desk::new(Settings::default()).state;
        state.link.state = LinkState::Monitoring;
        state.link.quirks.hand_id = Some(1);
        state.endpoint = Some(Endpoint::sim());
        assert_eq!(settled(&mut keeper, &mut state).await, None);
        assert!(!QuirkBook::path(&settings).exists());

        state.endpoint = Some("tcp:127.0.0.1".parse().unwrap());
        assert_eq!(settled(&mut keeper, &mut state).await, None);
        let sheet = state.sheet.clone().unwrap();
        assert_eq!((sheet.hand_id, sheet.first_seen.len()), (Some(1), 10));

        state.link.state = LinkState::Offline;
        state.link.quirks.hand_id = Some(2);
        assert_eq!(
            settled(&mut keeper, &mut state).await,
            None,
            "only what answers is noted"
        );
        state.link.state = LinkState::Monitoring;
        let Some(NoticeKind::HandDiffers { differences, .. }) =
            settled(&mut keeper, &mut state).await
        else {
            unreachable!("it must be said");
        };
        assert_eq!(differences.first().unwrap().fact, Fact::HandId);
        assert_eq!(
            settled(&mut keeper, &mut state).await,
            None,
            "once is enough"
        );

        std::fs::write(QuirkBook::path(&settings), "version = ").unwrap();
        state.link.quirks.hand_id = Some(3);
        let told = settled(&mut keeper, &mut state).await;
        assert!(
            matches!(told, Some(NoticeKind::SheetNotKept { .. })),
            "{told:?}"
        );
    }
}
