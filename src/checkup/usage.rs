//! Use of a hand, counted from its recordings.

use crate::hand::{Dof, Fault, PerDof, Quantity, Status};
use crate::record::EventKind;
use crate::record::file::overview::{OverviewRow, joint_line};
use crate::record::file::{Overview, RecordingFile, parts};
use crate::transport::Endpoint;
use std::path::Path;

/// Recordings that are counted: several for each working day of two years. The oldest beyond them are ignored.
const RECORDINGS_MAX: usize = 2000;
/// A joint has closed once when it was open beyond the first and is bent below the second, units of ANGLE_ACT.
const OPEN: f32 = 700.0;
const BENT: f32 = 400.0;
/// A joint moves if its angle spans this within a second.
const MOVES: f32 = 10.0;

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Usage {
    /// Its recordings.
    pub recordings: usize,
    /// Start of the oldest, seconds since 1970.
    pub since_1970_s: u64,
    /// Seconds with readings, and those of them with motion.
    pub read_s: u64,
    pub moved_s: u64,
    /// Closes of each joint; at most one per second.
    pub closes: PerDof<u64>,
    /// Stalls reported by the drives.
    pub stalls: u64,
}

impl Usage {
    /// Sums up the recordings of this hand in a folder and its subfolders; `None` if there are none. Unreadable files are skipped.
    pub fn of(folder: &Path, hand: &Endpoint) -> Option<Self> {
        let mut all = parts::recordings(parts::files(folder));
        all.sort_by(|one, two| two.cmp(one));
        let mut usage = Self::default();
        for files in all.into_iter().take(RECORDINGS_MAX) {
            let is_own = |told: &str| {
                let told = told.parse::<Endpoint>();
                told.is_ok_and(|told| told.place_and_id() == hand.place_and_id())
            };
            let first = files.first().and_then(|file| parts::hand(file));
            if first.as_deref().is_some_and(is_own)
                && let (Some(file), _) = RecordingFile::open_all(&files)
            {
                usage.add(file.overview(), file.opening().began_since_1970().as_secs());
            }
        }
        (usage.recordings > 0).then_some(usage)
    }

    /// Adds a recording.
    fn add(&mut self, overview: &Overview, began_s: u64) {
        self.since_1970_s = match self.recordings {
            0 => began_s,
            _ => self.since_1970_s.min(began_s),
        };
        self.recordings += 1;
        let mut was_open = PerDof::splat(false);
        for row in &overview.rows {
            self.second(row, &mut was_open);
        }
        let faults = overview.marks.iter();
        let faults = faults.filter(|mark| mark.kind == EventKind::Fault);
        let stalls = [Fault::Stall.name(), Status::Stalled.name()];
        let stalled = faults.filter(|mark| {
            let names = mark.words.split_once(": ").map(|(_, names)| names);
            let mut names = names.into_iter().flat_map(|names| names.split(", "));
            names.any(|name| stalls.contains(&name))
        });
        self.stalls += u64::try_from(stalled.count()).unwrap_or(u64::MAX);
    }

    fn second(&mut self, row: &OverviewRow, was_open: &mut PerDof<bool>) {
        let (mut is_read, mut moves) = (false, false);
        for dof in Dof::ALL {
            let line = joint_line(Quantity::Angle, dof);
            let range = row.least.get(line).zip(row.greatest.get(line));
            let Some((least, most)) = range.filter(|(least, _)| !least.is_nan()) else {
                continue;
            };
            is_read = true;
            moves |= most - least >= MOVES;
            // A joint that was bent and opens within this second did not close in it.
            if was_open[dof] && *least < BENT {
                self.closes[dof] += 1;
                was_open[dof] = false;
            } else {
                was_open[dof] |= *most > OPEN;
            }
        }
        self.read_s += u64::from(is_read);
        self.moved_s += u64::from(moves);
    }

    /// The joint that closed most often, and its number of closes.
    pub fn most_closed(&self) -> (Dof, u64) {
        let all = self.closes.iter().map(|(dof, closes)| (dof, *closes));
        let most = all.reduce(|most, own| if own.1 > most.1 { own } else { most });
        most.unwrap_or((Dof::Index, 0))
    }

    /// Hours with readings and with motion, one decimal each.
    pub fn hours(&self) -> [String; 2] {
        [self.read_s, self.moved_s].map(|seconds| {
            let tenths = seconds / 360;
            format!("{}.{}", tenths / 10, tenths % 10)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Moment;
    use crate::record::file::FileMark;
    use crate::record::file::overview::LINES;

    /// Smallest and largest angle of the index in each second.
    fn overview(seconds: &[(f32, f32)]) -> Overview {
        let mut overview = Overview::default();
        for (second, (least, greatest)) in (0..).zip(seconds) {
            let mut row = OverviewRow {
                second,
                least: [f32::NAN; LINES],
                greatest: [f32::NAN; LINES],
            };
            let line = joint_line(Quantity::Angle, Dof::Index);
            (row.least[line], row.greatest[line]) = (*least, *greatest);
            overview.rows.push(row);
        }
        overview
    }

    #[test]
    fn a_joint_closes_that_was_open_and_is_bent_and_not_one_that_opens() {
        let mut usage = Usage::default();
        let seconds = [
            (1000.0, 1000.0),
            (300.0, 1000.0),
            (300.0, 300.0),
            // It opens, stays, bends half, and closes over two seconds.
            (300.0, 1000.0),
            (1000.0, 1000.0),
            (500.0, 1000.0),
            (650.0, 1000.0),
            (200.0, 650.0),
        ];
        usage.add(&overview(&seconds), 100);
        assert_eq!(usage.most_closed(), (Dof::Index, 2));
        assert_eq!((usage.read_s, usage.moved_s), (8, 5));
        usage.add(&overview(&[(0.0, 0.0)]), 50);
        assert_eq!((usage.recordings, usage.since_1970_s), (2, 50));
        assert_eq!(usage.most_closed().1, 2, "it was bent from the beginning");
    }

    #[test]
    fn stalls_are_counted_and_other_faults_are_not() {
        let mut overview = overview(&[]);
        let stall = Fault::Stall.name();
        let other = Fault::OverCurrent.name();
        for words in [
            format!("index: {stall}"),
            format!("ring: {other}, {stall}"),
            format!("ring: {other}"),
        ] {
            overview.marks.push(FileMark {
                at: Moment::ZERO,
                kind: EventKind::Fault,
                words,
            });
        }
        let mut usage = Usage::default();
        usage.add(&overview, 0);
        assert_eq!(usage.stalls, 2);
        assert_eq!(usage.hours(), ["0.0", "0.0"]);
    }
}
