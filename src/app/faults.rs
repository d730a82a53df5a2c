//! Faults now and before, joint by joint, kept until a person forgets them. Words are in `hand`.

use crate::hand::{Dof, Fault, Group, Groups, HandSample, Moment, Status};

/// Entries that can be: per joint eight fault bits and three protective codes. One entry each, so it cannot grow.
pub const FAULT_ENTRIES_MAX: usize = 6 * (8 + 3);

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaultKind {
    /// A bit of ERROR (manual 2.6.18).
    Fault(Fault),
    /// A protective code of STATUS (manual 2.6.19).
    Status(Status),
}

/// One thing that is or was wrong with one joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultEntry {
    /// The joint.
    pub dof: Dof,
    /// What.
    pub what: FaultKind,
    /// When it was first seen, this time.
    pub since: Moment,
    /// When it was seen last.
    pub seen: Moment,
    /// When the hand first said that it is over; `None` while it lasts.
    pub until: Option<Moment>,
    /// Times it came.
    pub count: u32,
}

impl FaultEntry {
    /// True while it lasts.
    #[must_use]
    pub const fn is_active(&self) -> bool {
        self.until.is_none()
    }
}

/// Faults now and before.
#[derive(Debug, Clone, Default)]
pub struct FaultBook {
    entries: Vec<FaultEntry>,
}

impl FaultBook {
    /// Takes in what the hand says now. True if something is wrong that was not wrong before.
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
                if status.is_protective() {
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

    /// Forgets what is over. What lasts stays.
    pub fn forget(&mut self) {
        self.entries.retain(FaultEntry::is_active);
    }

    /// Another hand: nothing is known of it.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// What lasts first, then what is over; the newest first within each.
    pub fn iter(&self) -> impl Iterator<Item = &FaultEntry> {
        let mut sorted: Vec<&FaultEntry> = self.entries.iter().collect();
        sorted.sort_by_key(|entry| (!entry.is_active(), std::cmp::Reverse(entry.since)));
        sorted.into_iter()
    }

    /// What lasts, newest first.
    pub fn active(&self) -> impl Iterator<Item = &FaultEntry> {
        self.iter().filter(|entry| entry.is_active())
    }

    /// Entries of all kinds.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.entries.len()
    }

    /// True if nothing is or was wrong.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// True if it was not active before.
    fn see(&mut self, dof: Dof, what: FaultKind, now: Moment) -> bool {
        let known = self
            .entries
            .iter_mut()
            .find(|entry| entry.dof == dof && entry.what == what);
        match known {
            Some(entry) if entry.is_active() => {
                entry.seen = now;
                false
            }
            Some(entry) => {
                *entry = FaultEntry {
                    since: now,
                    seen: now,
                    until: None,
                    count: entry.count.saturating_add(1),
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
                    since: now,
                    seen: now,
                    until: None,
                    count: 1,
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
    #![allow(clippy::expect_used, reason = "a test may")]
    use super::*;
    use crate::hand::{Faults, PerDof, Timed};

    const AT: fn(u64) -> Moment = Moment::from_micros;

    fn see(book: &mut FaultBook, at: u64, raw: u8, status: u8) -> bool {
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
    fn a_fault_stays_until_it_is_over_and_forgotten() {
        let mut book = FaultBook::default();
        assert!(see(&mut book, 1, 1, 2));
        assert!(!see(&mut book, 2, 1, 2), "the same fault is no news");
        book.forget();
        assert_eq!(book.active().count(), 1, "what lasts is not forgotten");
        assert!(!see(&mut book, 3, 0, 2));
        let entry = *book.iter().next().expect("kept");
        assert_eq!(
            (entry.since, entry.seen, entry.until),
            (AT(1), AT(2), Some(AT(3)))
        );
        assert!(see(&mut book, 4, 1, 2), "it came again");
        assert_eq!(
            book.iter().next().map(|entry| (entry.count, entry.since)),
            Some((2, AT(4)))
        );
        see(&mut book, 5, 0, 2);
        book.forget();
        assert!(book.is_empty());
    }

    #[test]
    fn what_lasts_comes_first_then_the_newest() {
        let mut book = FaultBook::default();
        see(&mut book, 1, 0b1, 2);
        see(&mut book, 2, 0b11, 2);
        see(&mut book, 3, 0b1, 6);
        let order: Vec<_> = book.iter().map(|entry| entry.what).collect();
        let fault = |bit| FaultKind::Fault(Fault::from_bit(bit));
        assert_eq!(
            order,
            [FaultKind::Status(Status::Stalled), fault(0), fault(1)]
        );
    }

    #[test]
    fn every_bit_and_code_fits() {
        let mut book = FaultBook::default();
        for status in 0..=255 {
            see(&mut book, u64::from(status), status, status);
        }
        assert!(book.len() <= FAULT_ENTRIES_MAX);
        assert_eq!(
            book.iter()
                .filter(|entry| matches!(entry.what, FaultKind::Status(_)))
                .count(),
            3
        );
    }

    #[test]
    fn nothing_fresh_ends_nothing() {
        let mut book = FaultBook::default();
        see(&mut book, 1, 1, 2);
        assert!(!book.update(&HandSample::default(), Groups::NONE, AT(2)));
        assert_eq!(book.active().count(), 1);
    }
}
