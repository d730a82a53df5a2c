//! What can be read of a recording file, found by reading all of it.

use crate::hand::Moment;
use crate::record::file::damage::{Damage, Gap};
use crate::record::file::overview::{Counts, Overview};
use crate::record::file::reader::{RecordingFile, Stretch};
use crate::record::{Entry, EventKind, Record};
use std::io;
use std::ops::ControlFlow;
use std::time::Duration;

/// The link tells its figures once a second, whatever the hand does, and a hand is read more often than that. Where nothing is told
/// for longer, nothing was recorded; where no reading is, the hand did not answer or was not asked.
const SILENT: Duration = Duration::from_millis(2500);

/// What can be read of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contents {
    /// How much of what. Faults are those that the readings show.
    pub counts: Counts,
    /// What is missing: by the sums, by the messages' numbers, as the recorder said, and where nothing was recorded.
    pub damage: Damage,
    /// Where the hand was not read, though the recording went on. Nothing is missing in the file there.
    pub unread: Vec<Gap>,
    /// The last moment of which there is anything.
    pub last: Moment,
}

impl Contents {
    /// Reads all of a file.
    ///
    /// # Errors
    /// What the system says.
    pub fn of(file: &RecordingFile) -> io::Result<Self> {
        let mut overview = Overview::default();
        let (mut newest, mut told) = (file.first(), Vec::new());
        let (mut last_read, mut unread) = (file.first(), Vec::new());
        let is_live = !file.opening().is_imported();
        let mut damage = file.entries(Stretch::WHOLE, |entry| {
            let at = entry.at();
            let missing = said_missing(&entry);
            if missing > 0 || is_live && at.since(newest) > SILENT {
                told.push(Gap {
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
            overview.take(&entry);
            ControlFlow::Continue(())
        })?;
        for gap in told {
            let is_same = |other: &Gap| other.from < gap.to && gap.from < other.to;
            if gap.messages > 0 || !damage.gaps.iter().any(is_same) {
                damage.gap(Gap { messages: 0, ..gap });
            }
        }
        damage.gaps.sort_by_key(|gap| gap.from);
        unread.extend(silence(last_read, newest));
        let is_damage =
            |gap: &Gap| (damage.gaps.iter()).any(|lost| lost.from <= gap.from && gap.to <= lost.to);
        unread.retain(|gap| is_live && !is_damage(gap));
        Ok(Self {
            unread,
            counts: overview.counts,
            damage,
            last: newest,
        })
    }
}

/// The stretch between two moments, if it is long.
fn silence(from: Moment, to: Moment) -> Option<Gap> {
    let messages = 0;
    (to.since(from) > SILENT).then_some(Gap { from, to, messages })
}

/// Entries that the recorder could not take before this.
fn said_missing(entry: &Entry) -> u64 {
    match entry {
        Entry::Event(event) if event.kind == EventKind::Recording => {
            let number = event.words.split_once(" entries are missing");
            number.map_or(0, |(number, _)| number.parse().unwrap_or_default())
        }
        _ => 0,
    }
}
