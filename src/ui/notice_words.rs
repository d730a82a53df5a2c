//! Messages in the window's language. Decides nothing.

use crate::app::notices::NoticeKind;
use crate::ui::look::Look;

/// A message as one sentence.
pub(crate) fn notice(what: &NoticeKind, _look: Look) -> String {
    match what {
        NoticeKind::Text(text) => text.clone(),
    }
}
