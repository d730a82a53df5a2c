//! A participant without its sockets: what it has received, and what it sends to whom (DDSI-RTPS 2.5, chapter 8). All
//! state about others is bounded.

use crate::transport::dds::discovery::{
    Announced, AnnouncedEndpoint, HAS_PUBLICATIONS_READER, HAS_PUBLICATIONS_WRITER,
};
use crate::transport::dds::discovery::{
    HAS_SUBSCRIPTIONS_READER, HAS_SUBSCRIPTIONS_WRITER, key, keyed, reached,
};
use crate::transport::dds::message::{DdsMessage, DdsTopic, DdsWriterId};
use crate::transport::dds::receive::{Assemblies, Received};
use crate::transport::dds::send::{CacheChange, Outgoing, Writer};
use crate::transport::dds::wire::{
    Data, Datagram, EndpointPair, EntityId, Guid, Message, Prefix, Submessage,
};
use std::collections::{BTreeMap, HashMap};
use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::{Duration, Instant};

/// Maximum length of a message that fits into a datagram with all headers.
pub(super) const MESSAGE_MAX: usize = 60_000;
/// Maximum participants, and readers and writers of all of them.
const PARTICIPANTS_MAX: usize = 128;
const ENDPOINTS_MAX: usize = 16_384;
/// History of announcements of our readers and writers, and of their ends, for late joiners.
const ANNOUNCEMENTS_KEPT: usize = 1024;
/// Interval of a participant's announcements: at first, and later.
const ANNOUNCED_AT_FIRST: Duration = Duration::from_millis(200);
const ANNOUNCE_INTERVAL: Duration = Duration::from_secs(3);
const FIRST_ANNOUNCEMENTS: u64 = 10;
/// Lease announced to others.
const LEASE: Duration = Duration::from_secs(20);
/// Limits of the lease of others, whatever they announce: CycloneDDS announces itself every 30 s.
const LEASE_MIN: Duration = Duration::from_secs(40);
const LEASE_MAX: Duration = Duration::from_secs(120);
/// Interval at which a participant is queried for readers and writers that it never announced.
const INQUIRY_INTERVAL: Duration = Duration::from_secs(1);

/// Our own addresses, and the destinations of announcements.
#[derive(Debug, Clone)]
pub(super) struct Places {
    pub(super) domain: u16,
    pub(super) announcements: SocketAddrV4,
    pub(super) messages: SocketAddrV4,
    /// Destinations of each announcement.
    pub(super) everyone: Vec<SocketAddrV4>,
}

/// Receiver of messages.
pub(super) type Inbox = Box<dyn Fn(DdsMessage) + Send>;

/// Another participant.
#[derive(Debug)]
struct Participant {
    /// Source address of its announcements.
    source: Ipv4Addr,
    announcements: SocketAddrV4,
    messages: Option<SocketAddrV4>,
    expires_after: Duration,
    last_seen: Instant,
    inquire_at: Instant,
    publications: Received,
    subscriptions: Received,
    writers: BTreeMap<EntityId, AnnouncedEndpoint>,
    readers: BTreeMap<EntityId, AnnouncedEndpoint>,
}

struct LocalReader {
    endpoint: AnnouncedEndpoint,
    inbox: Inbox,
    sources: HashMap<Guid, Received>,
}

struct LocalWriter {
    endpoint: AnnouncedEndpoint,
    writer: Writer,
}

pub(super) struct Core {
    prefix: Prefix,
    places: Places,
    announcement: u64,
    announce_at: Instant,
    participants: HashMap<Prefix, Participant>,
    /// Announce our writers and readers.
    publications: Writer,
    subscriptions: Writer,
    writers: BTreeMap<EntityId, LocalWriter>,
    readers: BTreeMap<EntityId, LocalReader>,
    entities: u32,
    assemblies: Assemblies,
    outgoing: Vec<Outgoing>,
}

impl Core {
    pub(super) fn new(prefix: Prefix, places: Places, now: Instant) -> Self {
        let announcing = |entity| Writer::new(entity, ANNOUNCEMENTS_KEPT);
        Self {
            prefix,
            places,
            announcement: 0,
            announce_at: now,
            participants: HashMap::new(),
            publications: announcing(EntityId::PUBLICATIONS_WRITER),
            subscriptions: announcing(EntityId::SUBSCRIPTIONS_WRITER),
            writers: BTreeMap::new(),
            readers: BTreeMap::new(),
            entities: 0,
            assemblies: Assemblies::default(),
            outgoing: Vec::new(),
        }
    }

    /// Takes the datagrams to send.
    pub(super) fn outgoing(&mut self) -> Vec<(SocketAddrV4, Vec<u8>)> {
        let all = std::mem::take(&mut self.outgoing).into_iter();
        all.map(|(place, datagram)| (place, datagram.bytes()))
            .collect()
    }

    fn guid(&self, entity: EntityId) -> Guid {
        let prefix = self.prefix;
        Guid { prefix, entity }
    }

    fn next_entity(&mut self) -> u32 {
        self.entities += 1;
        self.entities
    }

    fn endpoint(&self, entity: EntityId, topic: &DdsTopic) -> AnnouncedEndpoint {
        AnnouncedEndpoint {
            guid: self.guid(entity),
            topic: topic.name.clone(),
            type_name: topic.type_name.clone(),
            is_reliable: false,
            is_lasting: false,
            is_apart: false,
            places: Vec::new(),
        }
    }

    /// Adds a reliable writer with a history of `depth` messages, for late joiners if it is lasting.
    pub(super) fn add_writer(
        &mut self,
        topic: &DdsTopic,
        (depth, is_lasting): (usize, bool),
        now: Instant,
    ) -> EntityId {
        let entity = EntityId::user_writer(self.next_entity());
        let mut endpoint = self.endpoint(entity, topic);
        (endpoint.is_reliable, endpoint.is_lasting) = (true, is_lasting);
        let mut writer = Writer::new(entity, depth);
        for participant in self.participants.values() {
            for reader in participant.readers.values() {
                participant.reads(&endpoint, &mut writer, reader, now);
            }
        }
        let announced = CacheChange::Payload(endpoint.payload());
        let (own, never) = (self.prefix, (0, 0));
        self.outgoing
            .extend(self.publications.write(announced, own, never, now));
        self.writers
            .insert(entity, LocalWriter { endpoint, writer });
        entity
    }

    /// Adds a reader of all messages from now on, from any writer.
    pub(super) fn add_reader(&mut self, topic: &DdsTopic, inbox: Inbox, now: Instant) -> EntityId {
        let entity = EntityId::user_reader(self.next_entity());
        let endpoint = self.endpoint(entity, topic);
        let all = self
            .participants
            .values()
            .flat_map(|other| other.writers.values());
        let sources = all.filter(|writer| is_of_topic(writer, &endpoint));
        let sources = sources
            .map(|writer| (writer.guid, Received::default()))
            .collect();
        let announced = CacheChange::Payload(endpoint.payload());
        let (own, never) = (self.prefix, (0, 0));
        self.outgoing
            .extend(self.subscriptions.write(announced, own, never, now));
        let reader = LocalReader {
            endpoint,
            inbox,
            sources,
        };
        self.readers.insert(entity, reader);
        entity
    }

    /// Removes a reader or writer.
    pub(super) fn remove(&mut self, entity: EntityId, now: Instant) {
        let guid = self.guid(entity);
        let announcing = if self.writers.remove(&entity).is_some() {
            &mut self.publications
        } else if self.readers.remove(&entity).is_some() {
            &mut self.subscriptions
        } else {
            return;
        };
        let of_it = |change: &CacheChange| match change {
            CacheChange::Payload(payload) => keyed(payload) == Some(guid),
            CacheChange::Gone(..) => false,
        };
        announcing.forget(of_it);
        let gone = CacheChange::Gone(guid, key(guid));
        self.outgoing
            .extend(announcing.write(gone, self.prefix, (0, 0), now));
    }

    /// Writes a message, with its header, at a time since 1970; false if it is too long.
    pub(super) fn write(
        &mut self,
        entity: EntityId,
        message: Vec<u8>,
        since_1970: Duration,
        now: Instant,
    ) -> bool {
        let Some(local) = self.writers.get_mut(&entity) else {
            return false;
        };
        if message.len() > MESSAGE_MAX {
            return false;
        }
        let from = DdsWriterId(local.endpoint.guid.bytes());
        let own = self.readers.values();
        for reader in own.filter(|reader| is_of_topic(&reader.endpoint, &local.endpoint)) {
            let bytes = message.clone();
            (reader.inbox)(DdsMessage { from, bytes });
        }
        // RTPS time ends in 2106; nothing here relies on it.
        let seconds = u32::try_from(since_1970.as_secs()).unwrap_or(u32::MAX);
        let fraction = (u64::from(since_1970.subsec_nanos()) << 32) / 1_000_000_000;
        let stamp = (seconds, u32::try_from(fraction).unwrap_or_default());
        let change = CacheChange::Payload(message);
        self.outgoing
            .extend(local.writer.write(change, self.prefix, stamp, now));
        true
    }

    /// Performs all due work.
    pub(super) fn tick(&mut self, now: Instant) {
        if now >= self.announce_at {
            let is_new = self.announcement < FIRST_ANNOUNCEMENTS;
            let each = if is_new {
                ANNOUNCED_AT_FIRST
            } else {
                ANNOUNCE_INTERVAL
            };
            self.announce_at = now + each;
            self.announce(&self.places.everyone.clone());
        }
        let expired =
            |other: &&Participant| now.duration_since(other.last_seen) > other.expires_after;
        let all = self.participants.iter();
        let expired: Vec<Prefix> = all
            .filter(|(_, other)| expired(other))
            .map(|(prefix, _)| *prefix)
            .collect();
        expired
            .into_iter()
            .for_each(|prefix| self.remove_participant(prefix));
        let own = self.prefix;
        let announcing = [&mut self.publications, &mut self.subscriptions];
        let writers = self.writers.values_mut().map(|local| &mut local.writer);
        for writer in announcing.into_iter().chain(writers) {
            self.outgoing.extend(writer.query_readers(own, now));
        }
        for (prefix, other) in &mut self.participants {
            if now >= other.inquire_at {
                other.inquire_at = now + INQUIRY_INTERVAL;
                self.outgoing.extend(other.inquire(own, *prefix));
            }
        }
    }

    /// Announces this participant.
    fn announce(&mut self, to: &[SocketAddrV4]) {
        self.announcement += 1;
        let announced = Announced {
            guid: self.guid(EntityId::PARTICIPANT),
            domain: Some(self.places.domain.into()),
            lease: LEASE,
            builtin: 0,
            announcements: vec![self.places.announcements],
            messages: vec![self.places.messages],
        };
        let datagram = Datagram::new(self.prefix, None);
        let datagram = datagram.data(SPDP, self.announcement, &announced.payload());
        self.outgoing
            .extend(to.iter().map(|place| (*place, datagram.clone())));
    }

    /// Announces that this participant leaves.
    pub(super) fn leave(&mut self) {
        self.announcement += 1;
        let guid = self.guid(EntityId::PARTICIPANT);
        let datagram = Datagram::new(self.prefix, None);
        let datagram = datagram.disposal(SPDP, self.announcement, (guid, &key(guid)));
        let known = self.participants.values().map(|other| other.announcements);
        let to = self.places.everyone.iter().copied().chain(known);
        self.outgoing
            .extend(to.map(|place| (place, datagram.clone())));
    }

    /// Applies a received datagram.
    pub(super) fn receive(&mut self, datagram: &[u8], source: Ipv4Addr, now: Instant) {
        let Some(message) = Message::parse(datagram) else {
            return;
        };
        let from = message.from;
        if from == self.prefix {
            return;
        }
        if let Some(other) = self.participants.get_mut(&from) {
            other.last_seen = now;
        }
        let mut is_ours = true;
        for submessage in message {
            match submessage {
                Submessage::Destination(to) => is_ours = to == self.prefix || to == [0; 12],
                _ if !is_ours => {}
                Submessage::Data(ends, data) if ends.writer == EntityId::SPDP_WRITER => {
                    self.participant(from, &data, (source, now));
                }
                Submessage::Data(ends, data) => self.data(from, ends, &data, now),
                Submessage::Fragment(ends, part) => {
                    let writer = Guid {
                        prefix: from,
                        entity: ends.writer,
                    };
                    if !self.is_read(writer) {
                        continue;
                    }
                    if let Some(payload) = self.assemblies.push((writer, ends.reader), &part) {
                        let whole = Data {
                            number: part.number,
                            is_disposed: false,
                            key_hash: None,
                            payload: &payload,
                        };
                        self.data(from, ends, &whole, now);
                    }
                }
                Submessage::Heartbeat {
                    ends,
                    first,
                    last,
                    wants_answer,
                } => self.heartbeat(from, ends, (first, last), wants_answer),
                Submessage::AckNack { ends, missing } => {
                    let (prefix, entity, own) = (from, ends.reader, self.prefix);
                    let writer = match ends.writer {
                        EntityId::PUBLICATIONS_WRITER => Some(&mut self.publications),
                        EntityId::SUBSCRIPTIONS_WRITER => Some(&mut self.subscriptions),
                        entity => self.writers.get_mut(&entity).map(|local| &mut local.writer),
                    };
                    let reader = Guid { prefix, entity };
                    let answer = writer.map(|writer| writer.acknack(reader, &missing, own, now));
                    self.outgoing.extend(answer.unwrap_or_default());
                }
                Submessage::Gap { ends, start, set } => {
                    let other = self.participants.get_mut(&from);
                    if let Some(received) = other.and_then(|other| other.announced_by(ends.writer))
                    {
                        received.gap(start, &set);
                    }
                }
            }
        }
    }

    /// True if a reader here uses this writer.
    fn is_read(&self, writer: Guid) -> bool {
        let is_announcing = [
            EntityId::PUBLICATIONS_WRITER,
            EntityId::SUBSCRIPTIONS_WRITER,
        ];
        let is_known = self.participants.contains_key(&writer.prefix);
        let mut readers = self.readers.values();
        is_known && is_announcing.contains(&writer.entity)
            || readers.any(|reader| reader.sources.contains_key(&writer))
    }

    /// Applies the announcement of a participant, or of its end.
    fn participant(&mut self, from: Prefix, data: &Data<'_>, (source, now): (Ipv4Addr, Instant)) {
        if data.is_disposed {
            // A participant can remove only itself.
            return self.remove_participant(from);
        }
        let Some(announced) = Announced::parse(data.payload) else {
            return;
        };
        let is_here = announced
            .domain
            .is_none_or(|domain| domain == u32::from(self.places.domain));
        let Some(place) = reached(&announced.announcements, source) else {
            return;
        };
        if announced.guid.prefix != from || !is_here {
            return;
        }
        let messages = reached(&announced.messages, source);
        if let Some(known) = self.participants.get_mut(&from) {
            if known.source == source {
                (known.announcements, known.messages) = (place, messages);
            }
            return;
        }
        if self.participants.len() >= PARTICIPANTS_MAX {
            return;
        }
        let has = |bit: u32| announced.builtin & bit != 0;
        let unknown = |bit: u32| {
            let mut received = Received::default();
            received.is_known = !has(bit);
            received
        };
        let other = Participant {
            source,
            announcements: place,
            messages,
            expires_after: announced.lease.clamp(LEASE_MIN, LEASE_MAX),
            last_seen: now,
            inquire_at: now + INQUIRY_INTERVAL,
            publications: unknown(HAS_PUBLICATIONS_WRITER),
            subscriptions: unknown(HAS_SUBSCRIPTIONS_WRITER),
            writers: BTreeMap::new(),
            readers: BTreeMap::new(),
        };
        self.participants.insert(from, other);
        self.announce(&[place]);
        for (bit, writer, entity) in [
            (
                HAS_PUBLICATIONS_READER,
                &mut self.publications,
                EntityId::PUBLICATIONS_READER,
            ),
            (
                HAS_SUBSCRIPTIONS_READER,
                &mut self.subscriptions,
                EntityId::SUBSCRIPTIONS_READER,
            ),
        ] {
            if has(bit) {
                let prefix = from;
                writer.add_reader((Guid { prefix, entity }, place), (true, true), now);
                self.outgoing.extend(writer.query_readers(self.prefix, now));
            }
        }
    }

    fn remove_participant(&mut self, prefix: Prefix) {
        if self.participants.remove(&prefix).is_none() {
            return;
        }
        let announcing = [&mut self.publications, &mut self.subscriptions];
        let writers = self.writers.values_mut().map(|local| &mut local.writer);
        for writer in announcing.into_iter().chain(writers) {
            writer.remove_participant(prefix);
        }
        for reader in self.readers.values_mut() {
            reader.sources.retain(|writer, _| writer.prefix != prefix);
        }
    }

    fn data(&mut self, from: Prefix, ends: EndpointPair, data: &Data<'_>, now: Instant) {
        let writer = Guid {
            prefix: from,
            entity: ends.writer,
        };
        if let Some(other) = self.participants.get_mut(&from)
            && let Some(received) = other.announced_by(ends.writer)
        {
            if received.accept(data.number) {
                self.announced(
                    from,
                    ends.writer == EntityId::PUBLICATIONS_WRITER,
                    data,
                    now,
                );
            }
            return;
        }
        for (entity, reader) in &mut self.readers {
            let is_addressed = [EntityId::UNKNOWN, *entity].contains(&ends.reader);
            let Some(received) = reader.sources.get_mut(&writer).filter(|_| is_addressed) else {
                continue;
            };
            if received.accept_newest(data.number) && !data.is_disposed {
                (reader.inbox)(DdsMessage {
                    from: DdsWriterId(writer.bytes()),
                    bytes: message(data.payload),
                });
            }
        }
    }

    /// Applies a participant's announcement of a reader or writer, or of its end.
    fn announced(&mut self, from: Prefix, is_writer: bool, data: &Data<'_>, now: Instant) {
        let endpoints = |other: &Participant| other.writers.len() + other.readers.len();
        let known: usize = self.participants.values().map(endpoints).sum();
        let Some(other) = self.participants.get_mut(&from) else {
            return;
        };
        let kept = if is_writer {
            &mut other.writers
        } else {
            &mut other.readers
        };
        if data.is_disposed {
            let hash = data.key_hash.and_then(Guid::from_bytes);
            let Some(gone) = keyed(data.payload)
                .or(hash)
                .filter(|gone| gone.prefix == from)
            else {
                return;
            };
            kept.remove(&gone.entity);
            for local in self.writers.values_mut() {
                local.writer.remove_reader(gone);
            }
            for reader in self.readers.values_mut() {
                reader.sources.remove(&gone);
            }
            return;
        }
        let Some(endpoint) = AnnouncedEndpoint::parse(data.payload, is_writer) else {
            return;
        };
        if endpoint.guid.prefix != from || known >= ENDPOINTS_MAX {
            return;
        }
        kept.insert(endpoint.guid.entity, endpoint.clone());
        if is_writer {
            let all = self.readers.values_mut();
            for reader in all.filter(|reader| is_of_topic(&endpoint, &reader.endpoint)) {
                reader.sources.entry(endpoint.guid).or_default();
            }
        } else {
            for local in self.writers.values_mut() {
                other.reads(&local.endpoint, &mut local.writer, &endpoint, now);
            }
        }
    }

    fn heartbeat(
        &mut self,
        from: Prefix,
        ends: EndpointPair,
        range: (u64, u64),
        wants_answer: bool,
    ) {
        let own = self.prefix;
        let Some(other) = self.participants.get_mut(&from) else {
            return;
        };
        let place = other.announcements;
        let Some(received) = other.announced_by(ends.writer) else {
            return;
        };
        if let Some(request) = received.heartbeat(range, wants_answer) {
            let datagram = Datagram::new(own, Some(from));
            let datagram = datagram.acknack(answering(ends.writer), &request);
            self.outgoing.push((place, datagram));
        }
    }

    #[cfg(test)]
    pub(super) fn stored(&self) -> usize {
        let others = self.participants.values().map(|other| {
            let received = other.publications.stored() + other.subscriptions.stored();
            other.writers.len() + other.readers.len() + received + 1
        });
        let writers = self.writers.values().map(|local| local.writer.stored());
        let readers = self.readers.values().map(|reader| {
            let received = reader
                .sources
                .values()
                .map(|received| 1 + received.stored());
            received.sum::<usize>()
        });
        let own = self.publications.stored() + self.subscriptions.stored();
        let all = others.sum::<usize>() + writers.sum::<usize>() + readers.sum::<usize>();
        own + all + self.assemblies.stored() / 1024 + self.outgoing.len()
    }

    #[cfg(test)]
    pub(super) fn known(&self) -> usize {
        self.participants.len()
    }
}

/// The ends for announcements of participants.
const SPDP: EndpointPair = EndpointPair {
    reader: EntityId::SPDP_READER,
    writer: EntityId::SPDP_WRITER,
};

/// The ends of a reply to an announcing writer.
const fn answering(writer: EntityId) -> EndpointPair {
    let reader = match writer {
        EntityId::PUBLICATIONS_WRITER => EntityId::PUBLICATIONS_READER,
        _ => EntityId::SUBSCRIPTIONS_READER,
    };
    EndpointPair { reader, writer }
}

fn is_of_topic(one: &AnnouncedEndpoint, other: &AnnouncedEndpoint) -> bool {
    let same = one.topic == other.topic && one.type_name == other.type_name;
    same && !one.is_apart && !other.is_apart
}

impl Participant {
    /// State of the messages received from one of its announcing writers.
    fn announced_by(&mut self, writer: EntityId) -> Option<&mut Received> {
        match writer {
            EntityId::PUBLICATIONS_WRITER => Some(&mut self.publications),
            EntityId::SUBSCRIPTIONS_WRITER => Some(&mut self.subscriptions),
            _ => None,
        }
    }

    /// Adds one of its readers to one of our writers, if they match.
    fn reads(
        &self,
        endpoint: &AnnouncedEndpoint,
        writer: &mut Writer,
        reader: &AnnouncedEndpoint,
        now: Instant,
    ) {
        let own = reached(&reader.places, self.source);
        let Some(place) = own.or(self.messages) else {
            return;
        };
        let is_kept = endpoint.is_lasting && reader.is_lasting;
        if is_of_topic(endpoint, reader) && (is_kept || !reader.is_lasting) {
            writer.add_reader((reader.guid, place), (reader.is_reliable, is_kept), now);
        }
    }

    /// Queries its readers and writers, if it never announced them.
    fn inquire(&mut self, own: Prefix, prefix: Prefix) -> Vec<Outgoing> {
        let place = self.announcements;
        let all = [
            (&mut self.publications, EntityId::PUBLICATIONS_WRITER),
            (&mut self.subscriptions, EntityId::SUBSCRIPTIONS_WRITER),
        ];
        let unknown = all.into_iter().filter(|(received, _)| !received.is_known);
        unknown
            .map(|(received, writer)| {
                let datagram = Datagram::new(own, Some(prefix));
                (
                    place,
                    datagram.acknack(answering(writer), &received.inquire()),
                )
            })
            .collect()
    }
}

/// A message with the uniform header: plain CDR in one of two byte orders, without the padding to a multiple of four.
/// Empty if it is in another encoding.
fn message(payload: &[u8]) -> Vec<u8> {
    match payload {
        [0, little @ (0 | 1), _, options, body @ ..] => {
            let filled = usize::from(options & 3);
            let len = body.len().saturating_sub(filled);
            let body = body.get(..len).unwrap_or_default();
            [&[0, *little, 0, 0], body].concat()
        }
        _ => Vec::new(),
    }
}
