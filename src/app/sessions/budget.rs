//! Which sessions go when they need more room than they may: the oldest first, and none that a person cares for.

use crate::app::sessions::item::SessionItem;
use std::path::PathBuf;

/// The sessions that go so that at most `limit` bytes are left, `items` being the oldest last. One that is being recorded, has a
/// star, a name or notes stays.
#[must_use]
pub fn to_delete(items: &[SessionItem], limit: u64, recording: Option<&PathBuf>) -> Vec<PathBuf> {
    let mut bytes: u64 = items.iter().map(|item| item.bytes).sum();
    let mut going = Vec::new();
    for item in items.iter().rev() {
        if bytes <= limit {
            break;
        }
        if item.about.is_kept(item.counts.notes) || recording == Some(&item.path) {
            continue;
        }
        bytes = bytes.saturating_sub(item.bytes);
        going.push(item.path.clone());
    }
    going
}
