//! Current and past faults per joint, latched until the user marks them as seen. Texts are in `hand`.
//!
//! The rule: a new fault is unseen, and only the user's action marks it as seen, one entry or all. Opening the list is
//! not enough, and neither is clearing errors: a fault that ended before the user noticed it must still be shown. A
//! recurring fault is unseen again.

use crate::hand::{Dof, Fault, Group, Groups, HandSample, Moment, Status};
use std::time::Duration;

/// Maximum number of entries: eight fault bits and three protective codes per joint, one entry each.
pub const FAULT_ENTRIES_MAX: usize = 6 * (8 + 3);

/// Kind of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaultKind {
    /// A bit of ERROR (manual 2.6.18).
    Fault(Fault),
    /// A protective code of STATUS (manual 2.6.19) that no bit of the drive's ERROR explains.
    Status(Status),
}

impl FaultKind {
    /// Stable lower-case name, as used in session files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fault(fault) => fault.name(),
            Self::Status(status) => status.name(),
        }
    }

    /// Fault or protective code with this name.
    pub fn named(name: &str) -> Option<Self> {
        let faults = (0..8).map(|bit| Self::Fault(Fault::from_bit(bit)));
        let codes = (0..8).map(|raw| Self::Status(Status::from_raw(raw)));
        faults.chain(codes).find(|kind| kind.name() == name)
    }

    /// True if CLEAR_ERROR can clear it (manual 2.6.3); `None` if the manual does not specify it: unknown bits, and
    /// status codes, which follow from the faults.
    pub const fn clearable(self) -> Option<bool> {
        match self {
            Self::Fault(fault) => fault.clearable(),
            Self::Status(_) => None,
        }
    }
}

/// Reason why CLEAR_ERROR would have no effect now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NothingToClear {
    /// There is no active fault.
    NoFault,
    /// The active faults end by themselves once the drive has cooled down.
    OnlyHeat,
}

/// A current or past fault of one joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultEntry {
    pub dof: Dof,
    pub what: FaultKind,
    /// First occurrence.
    pub first: Moment,
    /// Start of the latest occurrence.
    pub since: Moment,
    /// Time of the last report that the fault is active.
    pub last: Moment,
    /// Time of the first report that the fault is over; `None` while active.
    pub until: Option<Moment>,
    /// Number of occurrences.
    pub count: u32,
    /// True if the user has marked the latest occurrence as seen.
    pub seen: bool,
}

impl FaultEntry {
    /// True while the fault lasts.
    pub const fn is_active(&self) -> bool {
        self.until.is_none()
    }

    /// Duration of the latest occurrence so far.
    pub fn lasted(&self, now: Moment) -> Duration {
        self.until.unwrap_or(now).since(self.since)
    }
}

/// Current and past faults.
#[derive(Debug, Clone, Default)]
pub struct FaultList {
    entries: Vec<FaultEntry>,
}

impl FaultList {
    /// Applies a sample. Returns true if a fault is active that was not active before.
    pub fn update(&mut self, sample: &HandSample, fresh: Groups, now: Moment) -> bool {
        let mut news = false;
        if let Some(faults) = sample.faults.filter(|_| fresh.contains(Group::Faults)) {
            for (dof, faults) in faults.value.iter() {
                news |= faults.iter().fold(false, |new, fault| {
                    self.see(dof, FaultKind::Fault(fault), now) | new
                });
                self.end(
                    dof,
                    now,
                    |what| matches!(what, FaultKind::Fault(fault) if !faults.contains(fault)),
                );
            }
        }
        if let Some(statuses) = sample.status.filter(|_| fresh.contains(Group::Status)) {
            for (dof, status) in statuses.value.iter() {
                // A drive with reported faults stops because of them: its status adds no second entry.
                let explained = sample.faults.is_some_and(|all| !all.value[dof].is_empty());
                if status.is_protective() && !explained {
                    news |= self.see(dof, FaultKind::Status(*status), now);
                }
                self.end(
                    dof,
                    now,
                    |what| matches!(what, FaultKind::Status(old) if old != *status),
                );
            }
        }
        news
    }

    /// Marks one fault as seen.
    pub fn see_one(&mut self, dof: Dof, what: FaultKind) {
        for entry in &mut self.entries {
            entry.seen |= entry.dof == dof && entry.what == what;
        }
    }

    /// Marks all faults as seen.
    pub fn see_all(&mut self) {
        for entry in &mut self.entries {
            entry.seen = true;
        }
    }

    /// Entries that the user has not marked as seen, active or over, newest first.
    pub fn unseen(&self) -> impl Iterator<Item = &FaultEntry> {
        self.iter().filter(|entry| !entry.seen)
    }

    /// Reason why CLEAR_ERROR would have no effect; `None` if it has or may have one.
    pub fn nothing_to_clear(&self) -> Option<NothingToClear> {
        let mut any = false;
        for entry in self.entries.iter().filter(|entry| entry.is_active()) {
            if entry.what.clearable() != Some(false) {
                return None;
            }
            any = true;
        }
        Some(if any {
            NothingToClear::OnlyHeat
        } else {
            NothingToClear::NoFault
        })
    }

    /// All entries: active ones first, then unseen past ones, then the rest; each group newest first.
    pub fn iter(&self) -> impl Iterator<Item = &FaultEntry> {
        let mut sorted: Vec<&FaultEntry> = self.entries.iter().collect();
        sorted.sort_by_key(|entry| {
            let over = !entry.is_active();
            (over, over && entry.seen, std::cmp::Reverse(entry.since))
        });
        sorted.into_iter()
    }

    /// Active faults, newest first.
    pub fn active(&self) -> impl Iterator<Item = &FaultEntry> {
        self.iter().filter(|entry| entry.is_active())
    }

    /// Records an occurrence. Returns true if the fault was not active before.
    fn see(&mut self, dof: Dof, what: FaultKind, now: Moment) -> bool {
        let known = self
            .entries
            .iter_mut()
            .find(|entry| entry.dof == dof && entry.what == what);
        match known {
            Some(entry) if entry.is_active() => {
                entry.last = now;
                false
            }
            Some(entry) => {
                *entry = FaultEntry {
                    since: now,
                    last: now,
                    until: None,
                    count: entry.count.saturating_add(1),
                    seen: false,
                    ..*entry
                };
                true
            }
            None => {
                debug_assert!(
                    self.entries.len() < FAULT_ENTRIES_MAX,
                    "one entry per joint and kind"
                );
                self.entries.push(FaultEntry {
                    dof,
                    what,
                    first: now,
                    since: now,
                    last: now,
                    until: None,
                    count: 1,
                    seen: false,
                });
                true
            }
        }
    }

    fn end(&mut self, dof: Dof, now: Moment, over: impl Fn(FaultKind) -> bool) {
        for entry in &mut self.entries {
            if entry.dof == dof && entry.is_active() && over(entry.what) {
                entry.until = Some(now);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Faults, PerDof, Timed};

    const AT: fn(u64) -> Moment = Moment::from_micros;

    fn see(book: &mut FaultList, at: u64, raw: u8, status: u8) -> bool {
        let mut faults = PerDof::splat(Faults::from_raw(0));
        faults[Dof::Ring] = Faults::from_raw(raw);
        let mut statuses = PerDof::splat(Status::PositionReached);
        statuses[Dof::Ring] = Status::from_raw(status);
        let sample = HandSample {
            faults: Some(Timed {
                value: faults,
                asked: AT(at),
                received: AT(at),
            }),
            status: Some(Timed {
                value: statuses,
                asked: AT(at),
                received: AT(at),
            }),
            ..HandSample::default()
        };
        let mut fresh = Groups::NONE;
        fresh.insert(Group::Faults);
        fresh.insert(Group::Status);
        book.update(&sample, fresh, AT(at))
    }

    #[test]
    fn a_fault_that_comes_again_is_the_same_entry() {
        let mut book = FaultList::default();
        assert!(see(&mut book, 1, 1, 2));
        assert!(!see(&mut book, 2, 1, 2), "the same fault is no news");
        assert_eq!(book.active().count(), 1);
        assert!(!see(&mut book, 3, 0, 2));
        let entry = *book.iter().next().expect("kept");
        assert_eq!(
            (entry.since, entry.last, entry.until),
            (AT(1), AT(2), Some(AT(3)))
        );
        assert!(see(&mut book, 4, 1, 2), "it came again");
        assert_eq!(
            book.iter().next().map(|entry| (entry.count, entry.since)),
            Some((2, AT(4)))
        );
    }

    #[test]
    fn a_fault_that_came_and_went_is_unseen_until_a_person_says_so_and_again_when_it_comes_again() {
        let stall = FaultKind::Fault(Fault::Stall);
        let mut book = FaultList::default();
        see(&mut book, 1, 1, 2);
        see(&mut book, 3_000_001, 0, 2);
        let entry = *book.unseen().next().expect("latched");
        assert_eq!((entry.what, entry.is_active()), (stall, false));
        assert_eq!(entry.lasted(AT(9_000_000)), Duration::from_secs(3));
        book.see_one(Dof::Index, stall);
        assert_eq!(book.unseen().count(), 1, "another joint's");
        book.see_one(Dof::Ring, stall);
        assert_eq!(book.unseen().count(), 0);
        see(&mut book, 5_000_000, 1, 2);
        let entry = *book.unseen().next().expect("again");
        assert_eq!((entry.count, entry.first), (2, AT(1)));
        assert_eq!(entry.lasted(AT(6_000_000)), Duration::from_secs(1));
        book.see_all();
        see(&mut book, 7_000_000, 0, 2);
        assert_eq!(book.unseen().count(), 0, "seen while it lasted is seen");
    }

    #[test]
    fn clearing_is_offered_where_it_can_help_and_only_there() {
        let mut book = FaultList::default();
        assert_eq!(book.nothing_to_clear(), Some(NothingToClear::NoFault));
        for (faults, status, want) in [
            (0b0_0001, 2, None),
            (0b0_0010, 2, Some(NothingToClear::OnlyHeat)),
            (0b0_0010, 7, Some(NothingToClear::OnlyHeat)),
            (0b0_0110, 7, None),
            (0b0_1000, 2, None),
            (0b1_0000, 2, None),
            (0b10_0000, 2, None),
            (0, 5, None),
            (0, 2, Some(NothingToClear::NoFault)),
        ] {
            see(&mut book, 1, faults, status);
            assert_eq!(book.nothing_to_clear(), want, "{faults:b} {status}");
        }
    }

    #[test]
    fn what_lasts_comes_first_then_the_newest() {
        let mut book = FaultList::default();
        see(&mut book, 1, 0, 6);
        see(&mut book, 2, 0b01, 2);
        see(&mut book, 3, 0b11, 2);
        see(&mut book, 4, 0b10, 2);
        let order: Vec<_> = book.iter().map(|entry| entry.what).collect();
        let fault = |bit| FaultKind::Fault(Fault::from_bit(bit));
        let stalled = FaultKind::Status(Status::Stalled);
        assert_eq!(order, [fault(1), fault(0), stalled]);
        book.see_one(Dof::Ring, fault(0));
        let order: Vec<_> = book.iter().map(|entry| entry.what).collect();
        assert_eq!(order, [fault(1), stalled, fault(0)], "unseen before seen");
    }

    #[test]
    fn a_status_that_a_fault_explains_is_no_entry_of_its_own() {
        let mut book = FaultList::default();
        see(&mut book, 1, 0b1, 6);
        assert_eq!(book.iter().count(), 1);
        see(&mut book, 2, 0, 6);
        assert_eq!(
            book.active().map(|entry| entry.what).collect::<Vec<_>>(),
            [FaultKind::Status(Status::Stalled)]
        );
    }

    #[test]
    fn every_bit_and_code_fits() {
        let mut book = FaultList::default();
        for status in 0..=255 {
            see(&mut book, 2 * u64::from(status), status, status);
            see(&mut book, 2 * u64::from(status) + 1, 0, status);
        }
        assert!(book.iter().count() <= FAULT_ENTRIES_MAX);
        assert_eq!(
            book.iter()
                .filter(|entry| matches!(entry.what, FaultKind::Status(_)))
                .count(),
            3
        );
    }

    #[test]
    fn nothing_fresh_ends_nothing() {
        let mut book = FaultList::default();
        see(&mut book, 1, 1, 2);
        assert!(!book.update(&HandSample::default(), Groups::NONE, AT(2)));
        assert_eq!(book.active().count(), 1);
    }
}
