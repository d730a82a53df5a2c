//! A writer: its history, its readers, and what each of them has acknowledged.

use crate::transport::dds::wire::{Datagram, EndpointPair, EntityId, Guid, NumberSet, Prefix};
use std::collections::BTreeMap;
use std::net::SocketAddrV4;
use std::time::{Duration, Instant};

/// Maximum readers of one participant per writer.
const READERS_MAX: usize = 8;
/// Time without an acknowledgement after which a reader is queried again: at first, and at most.
const ASKED_AGAIN: Duration = Duration::from_millis(100);
const ASKED_AGAIN_MAX: Duration = Duration::from_secs(2);
/// Shortest interval between replies to one reader, so that its requests cost at most as much as its messages.
const ANSWER_INTERVAL: Duration = Duration::from_millis(5);

/// One entry of the history.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum CacheChange {
    /// A message with its header.
    Payload(Vec<u8>),
    /// The entity with this id was removed.
    Gone(Guid, Vec<u8>),
}

/// A matched reader.
#[derive(Debug, Clone)]
pub(super) struct ReaderProxy {
    place: SocketAddrV4,
    is_reliable: bool,
    /// Messages up to this number precede the reader and are not sent to it.
    after: u64,
    /// The reader has all up to this number, or does not need them.
    acknowledged: u64,
    asked_again: Duration,
    ask_at: Instant,
    answer_at: Instant,
}

#[derive(Debug)]
pub(super) struct Writer {
    entity: EntityId,
    depth: usize,
    changes: BTreeMap<u64, CacheChange>,
    last: u64,
    heartbeats: u32,
    readers: BTreeMap<Guid, ReaderProxy>,
}

/// A datagram and its destination.
pub(super) type Outgoing = (SocketAddrV4, Datagram);

impl Writer {
    /// A writer with a history of `depth` messages.
    pub(super) const fn new(entity: EntityId, depth: usize) -> Self {
        Self {
            entity,
            depth,
            changes: BTreeMap::new(),
            last: 0,
            heartbeats: 0,
            readers: BTreeMap::new(),
        }
    }

    /// Adds a reader, from now on: including the history, if it requests that.
    pub(super) fn add_reader(
        &mut self,
        (reader, place): (Guid, SocketAddrV4),
        (is_reliable, wants_kept): (bool, bool),
        now: Instant,
    ) {
        let after = if wants_kept { 0 } else { self.last };
        if let Some(known) = self.readers.get_mut(&reader) {
            known.place = place;
            return;
        }
        let of_it = self.readers.keys().filter(|id| id.prefix == reader.prefix);
        if of_it.count() >= READERS_MAX {
            return;
        }
        let proxy = ReaderProxy {
            place,
            is_reliable,
            after,
            acknowledged: after,
            asked_again: ASKED_AGAIN,
            ask_at: now,
            answer_at: now,
        };
        self.readers.insert(reader, proxy);
    }

    pub(super) fn remove_reader(&mut self, reader: Guid) {
        self.readers.remove(&reader);
    }

    pub(super) fn remove_participant(&mut self, prefix: Prefix) {
        self.readers.retain(|reader, _| reader.prefix != prefix);
    }

    /// Drops history entries of an entity that was removed.
    pub(super) fn forget(&mut self, is_it: impl Fn(&CacheChange) -> bool) {
        self.changes.retain(|_, change| !is_it(change));
    }

    /// Writes to all readers. `stamp` is the time, and `own` our participant.
    pub(super) fn write(
        &mut self,
        change: CacheChange,
        own: Prefix,
        stamp: (u32, u32),
        now: Instant,
    ) -> Vec<Outgoing> {
        self.last += 1;
        let number = self.last;
        let ends = self.ends(EntityId::UNKNOWN);
        let mut by_place: BTreeMap<(SocketAddrV4, Prefix), Datagram> = BTreeMap::new();
        for (reader, proxy) in &self.readers {
            by_place
                .entry((proxy.place, reader.prefix))
                .or_insert_with(|| {
                    let datagram = Datagram::new(own, Some(reader.prefix));
                    change.put(datagram.timestamp(stamp.0, stamp.1), ends, number)
                });
        }
        self.changes.insert(number, change);
        while self.changes.len() > self.depth {
            self.changes.pop_first();
        }
        let readers: Vec<Guid> = self.readers.keys().copied().collect();
        for reader in readers {
            let Some((place, ends, range, wants)) = self.heartbeat(reader, now) else {
                continue;
            };
            let count = (self.heartbeats, wants);
            by_place
                .entry((place, reader.prefix))
                .and_modify(|datagram| *datagram = datagram.clone().heartbeat(ends, range, count));
        }
        let all = by_place.into_iter();
        all.map(|((place, _), datagram)| (place, datagram))
            .collect()
    }

    /// Queries the readers that may miss messages.
    pub(super) fn query_readers(&mut self, own: Prefix, now: Instant) -> Vec<Outgoing> {
        let waiting = self.readers.iter().filter(|(_, proxy)| {
            proxy.is_reliable && proxy.acknowledged < self.last && proxy.ask_at <= now
        });
        let waiting: Vec<Guid> = waiting.map(|(reader, _)| *reader).collect();
        let mut outgoing = Vec::new();
        for reader in waiting {
            if let Some((place, ends, range, wants)) = self.heartbeat(reader, now) {
                let datagram = Datagram::new(own, Some(reader.prefix));
                let count = (self.heartbeats, wants);
                outgoing.push((place, datagram.heartbeat(ends, range, count)));
            }
        }
        outgoing
    }

    /// The heartbeat for a reader: destination, ends, range of numbers, and whether it must answer. `None` for a
    /// best-effort reader.
    fn heartbeat(
        &mut self,
        reader: Guid,
        now: Instant,
    ) -> Option<(SocketAddrV4, EndpointPair, (u64, u64), bool)> {
        let ends = self.ends(reader.entity);
        let first = self.first();
        let proxy = self.readers.get_mut(&reader)?;
        if !proxy.is_reliable {
            return None;
        }
        self.heartbeats = self.heartbeats.wrapping_add(1);
        let wants_answer = proxy.ask_at <= now;
        if wants_answer {
            proxy.ask_at = now + proxy.asked_again;
            proxy.asked_again = (proxy.asked_again * 2).min(ASKED_AGAIN_MAX);
        }
        let range = (first.max(proxy.after + 1), self.last);
        Some((proxy.place, ends, range, wants_answer))
    }

    /// Applies a reader's acknowledgement, and answers its request for missing messages.
    pub(super) fn acknack(
        &mut self,
        reader: Guid,
        missing: &NumberSet,
        own: Prefix,
        now: Instant,
    ) -> Vec<Outgoing> {
        let ends = self.ends(reader.entity);
        let last = self.last;
        let Some(proxy) = self.readers.get_mut(&reader) else {
            return Vec::new();
        };
        // A number that was not written yet cannot be acknowledged.
        if missing.base > last + 1 {
            return Vec::new();
        }
        proxy.acknowledged = proxy.acknowledged.max(missing.base - 1);
        proxy.asked_again = ASKED_AGAIN;
        if proxy.answer_at > now {
            return Vec::new();
        }
        proxy.answer_at = now + ANSWER_INTERVAL;
        let (place, after) = (proxy.place, proxy.after);
        let datagram = || Datagram::new(own, Some(reader.prefix));
        // A reader that never received a heartbeat sends an empty request.
        if missing.numbers.is_empty() && missing.base <= last {
            proxy.ask_at = now;
            return self.query_readers(own, now);
        }
        let (mut outgoing, mut absent) = (Vec::new(), Vec::new());
        for number in missing.numbers.iter().filter(|number| **number <= last) {
            match self.changes.get(number).filter(|_| *number > after) {
                Some(change) => outgoing.push((place, change.put(datagram(), ends, *number))),
                None => absent.push(*number),
            }
        }
        if let Some(start) = absent.first().copied() {
            let base = start + 1;
            let numbers = absent.into_iter().skip(1).collect();
            let gap = datagram().gap(ends, start, &NumberSet { base, numbers });
            outgoing.push((place, gap));
        }
        outgoing
    }

    /// The first number in the history.
    fn first(&self) -> u64 {
        let first = self.changes.first_key_value();
        first.map_or(self.last + 1, |(number, _)| *number)
    }

    const fn ends(&self, reader: EntityId) -> EndpointPair {
        let writer = self.entity;
        EndpointPair { reader, writer }
    }

    #[cfg(test)]
    pub(super) fn stored(&self) -> usize {
        self.changes.len() + self.readers.len()
    }
}

impl CacheChange {
    fn put(&self, datagram: Datagram, ends: EndpointPair, number: u64) -> Datagram {
        match self {
            Self::Payload(payload) => datagram.data(ends, number, payload),
            Self::Gone(guid, payload) => datagram.disposal(ends, number, (*guid, payload)),
        }
    }
}
