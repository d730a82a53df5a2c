//! The readable contents of a recording file, found by reading all of it.

use crate::hand::Moment;
use crate::record::file::damage::{Damage, MessageGap};
use crate::record::file::overview::{Counts, Overview};
use crate::record::file::reader::{RecordingFile, TimeRange};
use crate::record::{Entry, EventKind, Record};
use std::io;
use std::ops::ControlFlow;
use std::time::Duration;

/// The link reports its statistics once a second, regardless of the hand, and a hand is read more often than that. A longer
/// period without any entry was not recorded; one without readings means that the hand did not answer or was not polled.
const SILENT: Duration = Duration::from_millis(2500);

/// The readable contents of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contents {
    /// Number of entries by kind. Faults are those that the readings show.
    pub counts: Counts,
    /// Missing data: by checksums, by message numbers, as the recorder reported, and where nothing was recorded.
    pub damage: Damage,
    /// Periods in which the hand was not read, although the recording continued. Nothing is missing in the file there.
    pub unread: Vec<MessageGap>,
    /// Time of the last entry.
    pub last: Moment,
}

impl Contents {
    /// Reads all of a file.
    ///
    /// # Errors
    /// The system's error.
    pub fn of(file: &RecordingFile) -> io::Result<Self> {
        let mut overview = Overview::default();
        let (mut newest, mut gaps) = (file.first(), Vec::new());
        let (mut last_read, mut unread) = (file.first(), Vec::new());
        let is_live = !file.opening().is_imported();
        let mut damage = file.entries(TimeRange::WHOLE, |entry| {
            let at = entry.at();
            let missing = reported_missing(&entry);
            if missing > 0 || is_live && at.since(newest) > SILENT {
                gaps.push(MessageGap {
                    from: newest,
                    to: at.max(newest),
                    messages: missing,
                });
            }
            if matches!(entry, Entry::Heard(Record::Reading { .. })) {
                unread.extend(silence(last_read, at));
                last_read = last_read.max(at);
            }
            newest = newest.max(at);
            overview.apply(&entry);
            ControlFlow::Continue(())
        })?;
        for gap in gaps {
            let is_same = |other: &MessageGap| other.from < gap.to && gap.from < other.to;
            if gap.messages > 0 || !damage.gaps.iter().any(is_same) {
                damage.gap(MessageGap { messages: 0, ..gap });
            }
        }
        damage.gaps.sort_by_key(|gap| gap.from);
        unread.extend(silence(last_read, newest));
        let is_damage = |gap: &MessageGap| {
            (damage.gaps.iter()).any(|lost| lost.from <= gap.from && gap.to <= lost.to)
        };
        unread.retain(|gap| is_live && !is_damage(gap));
        Ok(Self {
            unread,
            counts: overview.counts,
            damage,
            last: newest,
        })
    }
}

/// The period between two moments, if it is a silence.
fn silence(from: Moment, to: Moment) -> Option<MessageGap> {
    let messages = 0;
    (to.since(from) > SILENT).then_some(MessageGap { from, to, messages })
}

/// Number of entries before this one that the recorder reported as lost.
fn reported_missing(entry: &Entry) -> u64 {
    match entry {
        Entry::Event(event) if event.kind == EventKind::Recording => {
            let number = event.words.split_once(" entries are missing");
            number.map_or(0, |(number, _)| number.parse().unwrap_or_default())
        }
        _ => 0,
    }
}
