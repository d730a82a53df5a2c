//! What an act at one hand needs besides the hand.

use crate::app::env::Env;
use crate::app::notices::{HandNotices, NoticeKind};
use crate::hand::Moment;

/// What an act at one hand needs besides the hand: the time, what the program stands on, and where it is told what happened.
pub(crate) struct Ctx<'a> {
    pub(crate) now: Moment,
    pub(crate) env: &'a Env,
    pub(crate) notices: HandNotices<'a>,
}

impl Ctx<'_> {
    /// Tells the user this, about this hand.
    pub(crate) fn tell(&mut self, what: NoticeKind) {
        self.notices.push(self.now, what);
    }
}
