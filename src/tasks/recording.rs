//! Gives everything that happens on a link to a recorder.

use crate::link::{Clock, LinkEntries, LinkObserver};
use crate::record::file::recorder::RecorderInput;

/// Records until the link's session ends, and what was left then.
pub async fn record(observed: LinkObserver, input: RecorderInput, clock: Clock) {
    let mut entries = LinkEntries::new(observed, clock);
    while let Some(entry) = entries.next().await {
        tell_missed(&mut entries, &input);
        input.push(entry);
    }
    tell_missed(&mut entries, &input);
}

fn tell_missed(entries: &mut LinkEntries, input: &RecorderInput) {
    let missed = entries.take_missed();
    if missed > 0 {
        input.missed(missed);
    }
}
