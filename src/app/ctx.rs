//! Context of an action on one hand.

use crate::app::env::Env;
use crate::app::notices::{HandNotices, NoticeKind};
use crate::hand::Moment;

/// Context of an action on one hand: time, environment, and the sink for notices.
pub(crate) struct Ctx<'a> {
    pub(crate) now: Moment,
    pub(crate) env: &'a Env,
    pub(crate) notices: HandNotices<'a>,
}

impl Ctx<'_> {
    /// Publishes a notice about this hand.
    pub(crate) fn notify(&mut self, what: NoticeKind) {
        self.notices.push(self.now, what);
    }
}
