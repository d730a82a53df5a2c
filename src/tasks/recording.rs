//! Gives everything that happens on a link to a recorder.

use crate::link::{Clock, LinkEntries, LinkObserver};
use crate::record::file::recorder::RecorderInput;

/// In virtual time the recorder is waited for after so many entries: far fewer than may wait for it, and about a second of one hand.
const SYNC_ENTRIES: usize = 2048;

/// Records until the link's session ends, and what was left then. In virtual time, which passes as fast as the computer can, the
/// recorder keeps up; in real time nothing waits for it.
pub async fn record(observed: LinkObserver, input: RecorderInput, clock: Clock) {
    let mut entries = LinkEntries::new(observed, clock);
    let mut given = 0_usize;
    while let Some(entry) = entries.next().await {
        tell_missed(&mut entries, &input);
        given = given.wrapping_add(1);
        if clock.is_virtual() && given.is_multiple_of(SYNC_ENTRIES) {
            input.push_in_step(entry);
        } else {
            input.push(entry);
        }
    }
    tell_missed(&mut entries, &input);
}

fn tell_missed(entries: &mut LinkEntries, input: &RecorderInput) {
    let missed = entries.take_missed();
    if missed > 0 {
        input.missed(missed);
    }
}
