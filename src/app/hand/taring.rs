//! Taring of the fingertips: by a person, kept for the next time the same hand is connected, and offered then.

use crate::app::hand::{Freshness, HandState};
use crate::app::notices::{NoticeKind, Notices};
use crate::app::settings::Settings;
use crate::hand::Finger;
use crate::store::calendar::since_1970;
use crate::transport::Endpoint;

impl HandState {
    /// Counts tactile channels from now, where the reading is fresh: one fingertip, or all. Refused where one is touched.
    pub(crate) fn tare(&mut self, finger: Option<Finger>, notices: &mut Notices) {
        let wanted = |each: &Finger| finger.is_none_or(|finger| finger == *each);
        let fresh = self.fresh_tips().filter(wanted).collect::<Vec<_>>();
        if let Err((finger, newtons)) = self.tare.tare(fresh, &self.sample) {
            notices.push(self.now, NoticeKind::TareUnderLoad { finger, newtons });
        }
    }

    /// Counts from the taring that was kept, where the reading is fresh. Refused where one fingertip is touched.
    pub(crate) fn take_kept_tare(&mut self, notices: &mut Notices) {
        let fresh = self.fresh_tips().collect::<Vec<_>>();
        if let Err((finger, newtons)) = self.tare.take_kept(fresh, &self.sample, self.now) {
            notices.push(self.now, NoticeKind::TareUnderLoad { finger, newtons });
        }
    }

    fn fresh_tips(&self) -> impl Iterator<Item = Finger> {
        let is_fresh = |finger: &Finger| self.tip_freshness(*finger) == Freshness::Live;
        Finger::ALL.into_iter().filter(is_fresh)
    }

    /// Puts what a person tared into the settings.
    pub(crate) fn keep_tare(&self, settings: &mut Settings) {
        if let Some(hand) = self.tared_hand() {
            settings.keep_tare(hand, self.tare.to_keep(since_1970(), self.now));
        }
    }

    /// Once a connection: offers what was kept of the same hand. Applies nothing.
    pub(crate) fn offer_tare(&mut self, settings: &Settings) {
        if self.link.state.is_live() && !self.tare.was_offered() {
            let hand = self.tared_hand();
            let kept = hand.and_then(|hand| settings.tares.get(&hand)).cloned();
            self.tare.offer(kept, since_1970(), self.now);
        }
    }

    /// The hand as files are kept by it: its place and id. The built-in one is none.
    fn tared_hand(&self) -> Option<String> {
        let endpoint = self.endpoint.as_ref();
        let (place, id) = endpoint
            .filter(|it| !it.is_sim())
            .map(Endpoint::place_and_id)?;
        Some(format!("{place} id {id}"))
    }
}
