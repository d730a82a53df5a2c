//! Streams to viewers, live, the messages that a recording of the link would contain.

use crate::link::LinkEntries;
use crate::record::file::format::encode::EntryEncoder;
use crate::record::file::{Opening, Overview};
use crate::record::{Entry, Event, EventKind};
use crate::share::foxglove::outlet::Outlet;

/// Publishes until the link's session ends.
pub(crate) async fn feed(mut entries: LinkEntries, opening: Opening, outlet: Outlet) {
    let mut encoder = EntryEncoder::live(&opening);
    let mut overview = Overview::default();
    while let Some(entry) = entries.next().await {
        let missed = entries.take_missed();
        let at = entry.at();
        let lost = (missed > 0).then(|| {
            Entry::Event(Event {
                at,
                kind: EventKind::Recording,
                words: format!("{missed} entries are missing before this"),
            })
        });
        for entry in lost.into_iter().chain([entry]) {
            // Derived entries depend on all previous ones, so they are computed even without viewers.
            let derived = overview.apply(&entry);
            overview.rows.clear();
            overview.marks.clear();
            if !outlet.is_viewed() {
                encoder.pass(&entry);
                continue;
            }
            let messages = encoder.encode(&entry).into_iter();
            let marks = derived.iter();
            let marks = marks.map(|mark| encoder.event(mark.at, mark.kind.key(), &mark.words));
            messages
                .chain(marks)
                .for_each(|message| outlet.publish(message));
        }
    }
}
