//! Received messages of a writer, missing ones, and the fragments of long ones. All state is bounded regardless of the input.

use crate::transport::dds::wire::{AckNackRequest, EntityId, Fragment, Guid, NumberSet, SET_MAX};
use std::collections::{BTreeSet, VecDeque};

/// A number this far behind is not a late message: its writer restarted, or a forged number preceded it.
const BEHIND_MAX: u64 = 1024;
/// Maximum length of a message assembled from fragments.
pub(super) const ASSEMBLED_MAX: usize = 256 * 1024;
/// Maximum fragments of one message: others use 1344 bytes and more each.
const FRAGMENTS_MAX: usize = 1024;
/// Maximum messages assembled concurrently.
const ASSEMBLIES_MAX: usize = 8;

/// The messages of one writer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Received {
    /// All numbers before this were received, or will not come.
    next: u64,
    /// Received numbers among the 256 from there on.
    ahead: BTreeSet<u64>,
    /// True once its writer reported its messages.
    pub(super) is_known: bool,
    acknacks: u32,
}

impl Default for Received {
    fn default() -> Self {
        Self {
            next: 1,
            ahead: BTreeSet::new(),
            is_known: false,
            acknacks: 0,
        }
    }
}

impl Received {
    /// Returns true if a message is new. Missing ones will be requested.
    pub(super) fn accept(&mut self, number: u64) -> bool {
        let is_near = (self.next..self.next + SET_MAX).contains(&number);
        let is_new = is_near && self.ahead.insert(number);
        self.advance();
        is_new
    }

    /// Returns true if a message is new. Missing ones will not be requested.
    pub(super) fn accept_newest(&mut self, number: u64) -> bool {
        let is_old = number < self.next && self.next - number <= BEHIND_MAX;
        if !is_old {
            self.next = number + 1;
        }
        !is_old
    }

    /// Applies a heartbeat with the writer's range; returns the request for missing messages.
    pub(super) fn heartbeat(
        &mut self,
        (first, last): (u64, u64),
        wants_answer: bool,
    ) -> Option<AckNackRequest> {
        self.is_known = true;
        // The writer restarted, or its earlier numbers were forged.
        let is_anew = last + 1 < self.next;
        if first > self.next || is_anew {
            self.next = first;
            self.ahead = self.ahead.split_off(&first);
            if is_anew {
                self.ahead.clear();
            }
            self.advance();
        }
        let end = last.saturating_add(1).min(self.next + SET_MAX);
        let missing = (self.next..end).filter(|number| !self.ahead.contains(number));
        let numbers: Vec<u64> = missing.collect();
        (wants_answer || !numbers.is_empty()).then(|| self.request(numbers))
    }

    /// Requests a heartbeat from the writer.
    pub(super) fn inquire(&mut self) -> AckNackRequest {
        self.request(Vec::new())
    }

    fn request(&mut self, numbers: Vec<u64>) -> AckNackRequest {
        self.acknacks = self.acknacks.wrapping_add(1);
        let base = self.next;
        AckNackRequest {
            missing: NumberSet { base, numbers },
            wants_heartbeat: !self.is_known,
            count: self.acknacks,
        }
    }

    /// Records numbers that will not come.
    pub(super) fn gap(&mut self, start: u64, set: &NumberSet) {
        let near = self.next..self.next + SET_MAX;
        if start <= self.next {
            self.next = self.next.max(set.base);
        } else {
            let range = start..set.base.min(near.end);
            self.ahead.extend(range);
        }
        let others = set.numbers.iter().filter(|number| near.contains(number));
        self.ahead.extend(others);
        self.advance();
    }

    fn advance(&mut self) {
        self.ahead = self.ahead.split_off(&self.next);
        while self.ahead.remove(&self.next) {
            self.next += 1;
        }
    }

    #[cfg(test)]
    pub(super) fn stored(&self) -> usize {
        self.ahead.len()
    }
}

/// A partially received message.
#[derive(Debug)]
struct Assembly {
    writer: Guid,
    reader: EntityId,
    number: u64,
    fragment_size: usize,
    bytes: Vec<u8>,
    missing: BTreeSet<usize>,
}

/// The last partially received messages.
#[derive(Debug, Default)]
pub(super) struct Assemblies(VecDeque<Assembly>);

impl Assemblies {
    /// Applies a fragment; returns the message once it is complete.
    pub(super) fn push(
        &mut self,
        (writer, reader): (Guid, EntityId),
        part: &Fragment<'_>,
    ) -> Option<Vec<u8>> {
        let fragments = part.total_size.div_ceil(part.fragment_size);
        if part.total_size > ASSEMBLED_MAX || !(part.first + 1..=FRAGMENTS_MAX).contains(&fragments)
        {
            return None;
        }
        let is_it = |whole: &Assembly| {
            let same = (whole.writer, whole.reader, whole.number) == (writer, reader, part.number);
            let sizes = (whole.fragment_size, whole.bytes.len());
            same && sizes == (part.fragment_size, part.total_size)
        };
        let nth = self.0.iter().position(is_it);
        let mut whole = match nth.and_then(|nth| self.0.remove(nth)) {
            Some(whole) => whole,
            None => Assembly {
                writer,
                reader,
                number: part.number,
                fragment_size: part.fragment_size,
                bytes: vec![0; part.total_size],
                missing: (0..fragments).collect(),
            },
        };
        whole.fill(part);
        if whole.missing.is_empty() {
            return Some(whole.bytes);
        }
        self.0.push_back(whole);
        if self.0.len() > ASSEMBLIES_MAX {
            self.0.pop_front();
        }
        None
    }

    #[cfg(test)]
    pub(super) fn stored(&self) -> usize {
        self.0.iter().map(|whole| whole.bytes.len()).sum()
    }
}

impl Assembly {
    fn fill(&mut self, part: &Fragment<'_>) {
        for (nth, bytes) in part.bytes.chunks(self.fragment_size).enumerate() {
            let nth = part.first.saturating_add(nth);
            let start = nth.saturating_mul(self.fragment_size);
            let end = start
                .saturating_add(self.fragment_size)
                .min(self.bytes.len());
            let Some(to) = self.bytes.get_mut(start..end) else {
                return;
            };
            // Padding may follow the last fragment.
            if let Some(bytes) = bytes.get(..to.len()) {
                to.copy_from_slice(bytes);
                self.missing.remove(&nth);
            }
        }
    }
}
