//! RTPS messages (DDSI-RTPS 2.5, chapter 9): decodes, validates and encodes datagrams. A datagram is untrusted: nothing
//! in it is believed beyond its own length, and no number in it determines memory use or run time.

use std::fmt;
use std::net::{Ipv4Addr, SocketAddrV4};

/// A participant's id: the first part of the ids of all its entities.
pub(super) type Prefix = [u8; 12];

/// A reader or writer of a participant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct EntityId(pub(super) [u8; 4]);

impl EntityId {
    /// Addresses all matching entities.
    pub(super) const UNKNOWN: Self = Self([0; 4]);
    pub(super) const PARTICIPANT: Self = Self([0, 0, 1, 0xc1]);
    /// Announces participants.
    pub(super) const SPDP_WRITER: Self = Self([0, 1, 0, 0xc2]);
    pub(super) const SPDP_READER: Self = Self([0, 1, 0, 0xc7]);
    /// Announces writers.
    pub(super) const PUBLICATIONS_WRITER: Self = Self([0, 0, 3, 0xc2]);
    pub(super) const PUBLICATIONS_READER: Self = Self([0, 0, 3, 0xc7]);
    /// Announces readers.
    pub(super) const SUBSCRIPTIONS_WRITER: Self = Self([0, 0, 4, 0xc2]);
    pub(super) const SUBSCRIPTIONS_READER: Self = Self([0, 0, 4, 0xc7]);

    /// A writer of messages without a key.
    pub(super) fn user_writer(number: u32) -> Self {
        let [_, a, b, c] = number.to_be_bytes();
        Self([a, b, c, 0x03])
    }

    /// A reader of messages without a key.
    pub(super) fn user_reader(number: u32) -> Self {
        let [_, a, b, c] = number.to_be_bytes();
        Self([a, b, c, 0x04])
    }
}

/// Globally unique id of a reader or writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Guid {
    pub(super) prefix: Prefix,
    pub(super) entity: EntityId,
}

impl Guid {
    pub(super) fn bytes(self) -> [u8; 16] {
        let mut bytes = [0; 16];
        let all = self.prefix.into_iter().chain(self.entity.0);
        bytes.iter_mut().zip(all).for_each(|(to, from)| *to = from);
        bytes
    }

    pub(super) fn from_bytes(bytes: [u8; 16]) -> Option<Self> {
        let (prefix, rest) = bytes.split_first_chunk()?;
        Some(Self {
            prefix: *prefix,
            entity: EntityId(rest.try_into().ok()?),
        })
    }
}

impl fmt::Display for Guid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.bytes()
            .iter()
            .try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Reads bytes in sequence, in the announced byte order.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cursor<'a> {
    rest: &'a [u8],
    is_little: bool,
}

impl<'a> Cursor<'a> {
    pub(super) const fn new(rest: &'a [u8], is_little: bool) -> Self {
        Self { rest, is_little }
    }

    pub(super) const fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(super) fn skip(&mut self, len: usize) -> Option<&'a [u8]> {
        let (head, rest) = self.rest.split_at_checked(len)?;
        self.rest = rest;
        Some(head)
    }

    pub(super) fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.rest.split_first_chunk()?;
        self.rest = rest;
        Some(*head)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        let bytes = self.array()?;
        Some(if self.is_little {
            u16::from_le_bytes(bytes)
        } else {
            u16::from_be_bytes(bytes)
        })
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        let bytes = self.array()?;
        Some(if self.is_little {
            u32::from_le_bytes(bytes)
        } else {
            u32::from_be_bytes(bytes)
        })
    }

    /// A length in bytes.
    pub(super) fn length(&mut self) -> Option<usize> {
        usize::try_from(self.u32()?).ok()
    }

    /// At most 2^63 - 1, so that small additions cannot overflow.
    fn sequence_number(&mut self) -> Option<u64> {
        let (high, low) = (self.u32()?, self.u32()?);
        let high = u64::from(high);
        (high < 1 << 31).then(|| high << 32 | u64::from(low))
    }

    fn entity(&mut self) -> Option<EntityId> {
        self.array().map(EntityId)
    }

    /// An IPv4 address for UDP; the inner `None` if it is of another kind.
    pub(super) fn locator(&mut self) -> Option<Option<SocketAddrV4>> {
        let (kind, port) = (self.u32()?, self.u32()?);
        let address: [u8; 16] = self.array()?;
        let port = u16::try_from(port).ok().filter(|port| *port != 0);
        let address = address.last_chunk::<4>().map(|four| Ipv4Addr::from(*four));
        let place = address.zip(port).filter(|_| kind == LOCATOR_UDP_V4);
        Some(place.map(|(address, port)| SocketAddrV4::new(address, port)))
    }
}

pub(super) const LOCATOR_UDP_V4: u32 = 1;
/// Maximum numbers in one set (9.4.2.6).
pub(super) const SET_MAX: u64 = 256;

/// A subset of 256 numbers from a base on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NumberSet {
    pub(super) base: u64,
    pub(super) numbers: Vec<u64>,
}

impl NumberSet {
    fn read(cursor: &mut Cursor<'_>) -> Option<Self> {
        let base = cursor.sequence_number().filter(|base| *base >= 1)?;
        let count = u64::from(cursor.u32()?);
        if count > SET_MAX {
            return None;
        }
        let mut numbers = Vec::new();
        let mut word = 0;
        for nth in 0..count {
            if nth % 32 == 0 {
                word = cursor.u32()?;
            }
            if word & 1 << (31 - nth % 32) != 0 {
                numbers.push(base + nth);
            }
        }
        Some(Self { base, numbers })
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        sequence_number(bytes, self.base);
        let count = self.numbers.last().map_or(0, |last| {
            last.saturating_sub(self.base)
                .saturating_add(1)
                .min(SET_MAX)
        });
        let mut words = [0_u32; 8];
        for number in &self.numbers {
            let nth = number.saturating_sub(self.base);
            let word = usize::try_from(nth / 32).ok();
            if let Some(word) = word.and_then(|word| words.get_mut(word)) {
                *word |= 1 << (31 - nth % 32);
            }
        }
        u32_le(bytes, u32::try_from(count).unwrap_or_default());
        let used = usize::try_from(count.div_ceil(32)).unwrap_or_default();
        words
            .iter()
            .take(used)
            .for_each(|word| u32_le(bytes, *word));
    }
}

/// A reader's request to a writer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AckNackRequest {
    pub(super) missing: NumberSet,
    /// The reader does not know the writer's range.
    pub(super) wants_heartbeat: bool,
    /// Grows with each request.
    pub(super) count: u32,
}

/// Reader and writer, within their participants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct EndpointPair {
    pub(super) reader: EntityId,
    pub(super) writer: EntityId,
}

/// A message, or notice of a removed entity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Data<'a> {
    pub(super) number: u64,
    /// From the inline QoS: the entity was disposed or unregistered, and its key.
    pub(super) is_disposed: bool,
    pub(super) key_hash: Option<[u8; 16]>,
    /// The payload with its header; empty if it has none.
    pub(super) payload: &'a [u8],
}

/// A part of a message that is too long for a datagram.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fragment<'a> {
    pub(super) number: u64,
    /// The first of its fragments, from 0.
    pub(super) first: usize,
    pub(super) fragment_size: usize,
    pub(super) total_size: usize,
    pub(super) bytes: &'a [u8],
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Submessage<'a> {
    /// The following submessages are for this participant; all zeros: for all.
    Destination(Prefix),
    Data(EndpointPair, Data<'a>),
    Fragment(EndpointPair, Fragment<'a>),
    Heartbeat {
        ends: EndpointPair,
        first: u64,
        /// One less than the first if there are none.
        last: u64,
        wants_answer: bool,
    },
    AckNack {
        ends: EndpointPair,
        missing: NumberSet,
    },
    /// Numbers that will not come: from the start up to the base of the set, and those in it.
    Gap {
        ends: EndpointPair,
        start: u64,
        set: NumberSet,
    },
}

const PAD: u8 = 0x01;
const ACKNACK: u8 = 0x06;
const HEARTBEAT: u8 = 0x07;
const GAP: u8 = 0x08;
const INFO_TS: u8 = 0x09;
const INFO_SRC: u8 = 0x0c;
const INFO_DST: u8 = 0x0e;
const DATA: u8 = 0x15;
const DATA_FRAG: u8 = 0x16;

const LITTLE: u8 = 1;
/// On a heartbeat: no answer required. On an acknowledgement: no heartbeat requested.
const FINAL: u8 = 2;
const INLINE_QOS: u8 = 2;
const HAS_DATA: u8 = 4;
const HAS_KEY: u8 = 8;
/// In a fragment, the key flag differs from that of a whole message.
const FRAGMENT_HAS_KEY: u8 = 4;

const PID_SENTINEL: u16 = 1;
const PID_KEY_HASH: u16 = 0x70;
const PID_STATUS_INFO: u16 = 0x71;
/// Status bits: disposed or unregistered.
const GONE: u8 = 3;

/// The submessages of a datagram, up to the first that is malformed.
#[derive(Debug, Clone)]
pub(super) struct Message<'a> {
    pub(super) from: Prefix,
    rest: &'a [u8],
}

impl<'a> Message<'a> {
    /// Parses a header; `None` unless it is RTPS 2.
    pub(super) fn parse(datagram: &'a [u8]) -> Option<Self> {
        let mut head = Cursor::new(datagram, true);
        let is_rtps = head.array()? == *b"RTPS" && head.array::<2>()?.first() == Some(&2);
        let _vendor: [u8; 2] = head.array()?;
        let from = head.array()?;
        is_rtps.then_some(Self {
            from,
            rest: head.rest(),
        })
    }
}

impl<'a> Iterator for Message<'a> {
    type Item = Submessage<'a>;

    fn next(&mut self) -> Option<Submessage<'a>> {
        loop {
            let ([kind, flags, length @ ..], rest) = self.rest.split_first_chunk::<4>()?;
            let (kind, flags) = (*kind, *flags);
            let is_little = flags & LITTLE != 0;
            let length = Cursor::new(length, is_little).u16()?;
            // No length means all the rest, except for those that may be empty (9.4.5.1.3).
            let length = match (length, kind) {
                (0, PAD | INFO_TS) => 0,
                (0, _) => rest.len(),
                (length, _) => length.into(),
            };
            let (body, rest) = rest.split_at_checked(length)?;
            self.rest = rest;
            let body = Cursor::new(body, is_little);
            let read = match kind {
                INFO_DST => destination(body),
                DATA => data(body, flags),
                DATA_FRAG => fragment(body, flags),
                HEARTBEAT => heartbeat(body, flags),
                ACKNACK => acknack(body),
                GAP => gap(body),
                // Changes the source, which nothing here needs.
                INFO_SRC => None,
                _ => continue,
            };
            if read.is_none() {
                self.rest = &[];
            }
            return read;
        }
    }
}

fn ends(body: &mut Cursor<'_>) -> Option<EndpointPair> {
    Some(EndpointPair {
        reader: body.entity()?,
        writer: body.entity()?,
    })
}

fn destination(mut body: Cursor<'_>) -> Option<Submessage<'_>> {
    body.array().map(Submessage::Destination)
}

fn heartbeat(mut body: Cursor<'_>, flags: u8) -> Option<Submessage<'_>> {
    let ends = ends(&mut body)?;
    let (first, last) = (body.sequence_number()?, body.sequence_number()?);
    (first >= 1 && last + 1 >= first).then_some(Submessage::Heartbeat {
        ends,
        first,
        last,
        wants_answer: flags & FINAL == 0,
    })
}

fn acknack(mut body: Cursor<'_>) -> Option<Submessage<'_>> {
    Some(Submessage::AckNack {
        ends: ends(&mut body)?,
        missing: NumberSet::read(&mut body)?,
    })
}

fn gap(mut body: Cursor<'_>) -> Option<Submessage<'_>> {
    let ends = ends(&mut body)?;
    let start = body.sequence_number().filter(|start| *start >= 1)?;
    let set = NumberSet::read(&mut body)?;
    (start <= set.base).then_some(Submessage::Gap { ends, start, set })
}

/// Header of a message and of a fragment: the ends, the number, and the rest.
fn data_head<'a>(body: &mut Cursor<'a>) -> Option<(EndpointPair, u64, Cursor<'a>)> {
    let _extra_flags = body.u16()?;
    let to_rest: usize = body.u16()?.into();
    let mut rest = *body;
    rest.skip(to_rest)?;
    let ends = ends(body)?;
    let number = body.sequence_number().filter(|number| *number >= 1)?;
    Some((ends, number, rest))
}

fn data(mut body: Cursor<'_>, flags: u8) -> Option<Submessage<'_>> {
    let (ends, number, mut rest) = data_head(&mut body)?;
    let mut data = Data {
        number,
        is_disposed: false,
        key_hash: None,
        payload: &[],
    };
    if flags & INLINE_QOS != 0 {
        let is_little = flags & LITTLE != 0;
        while let Some((id, value)) = parameter(&mut rest, is_little)? {
            match (id, value) {
                (PID_STATUS_INFO, [_, _, _, status, ..]) => data.is_disposed = status & GONE != 0,
                (PID_KEY_HASH, value) => data.key_hash = value.first_chunk().copied(),
                _ => {}
            }
        }
    }
    if flags & (HAS_DATA | HAS_KEY) != 0 {
        data.payload = rest.rest();
    }
    Some(Submessage::Data(ends, data))
}

fn fragment(mut body: Cursor<'_>, flags: u8) -> Option<Submessage<'_>> {
    let (ends, number, mut rest) = data_head(&mut body)?;
    let first = body
        .length()?
        .checked_sub(1)
        .filter(|first| *first < usize::MAX)?;
    let _in_this: u16 = body.u16()?;
    let fragment_size: usize = body.u16()?.into();
    let total_size = body.length()?;
    if flags & FRAGMENT_HAS_KEY != 0 || fragment_size == 0 {
        return None;
    }
    if flags & INLINE_QOS != 0 {
        while parameter(&mut rest, flags & LITTLE != 0)?.is_some() {}
    }
    Some(Submessage::Fragment(
        ends,
        Fragment {
            number,
            first,
            fragment_size,
            total_size,
            bytes: rest.rest(),
        },
    ))
}

/// The next parameter of a list; the inner `None` at its end.
pub(super) fn parameter<'a>(
    list: &mut Cursor<'a>,
    is_little: bool,
) -> Option<Option<(u16, &'a [u8])>> {
    let mut head = Cursor::new(list.skip(4)?, is_little);
    let (id, length) = (head.u16()?, head.u16()?);
    if id == PID_SENTINEL {
        return Some(None);
    }
    Some(Some((id, list.skip(length.into())?)))
}

/// Ends a list of parameters.
pub(super) fn end_parameters(bytes: &mut Vec<u8>) {
    u16_le(bytes, PID_SENTINEL);
    u16_le(bytes, 0);
}

pub(super) fn u16_le(bytes: &mut Vec<u8>, value: u16) {
    bytes.extend(value.to_le_bytes());
}

pub(super) fn u32_le(bytes: &mut Vec<u8>, value: u32) {
    bytes.extend(value.to_le_bytes());
}

fn sequence_number(bytes: &mut Vec<u8>, number: u64) {
    let [high, low] = [number >> 32, number & u64::from(u32::MAX)];
    for half in [high, low] {
        u32_le(bytes, u32::try_from(half).unwrap_or_default());
    }
}

/// An outgoing datagram, little-endian.
#[derive(Debug, Clone)]
pub(super) struct Datagram(Vec<u8>);

impl Datagram {
    /// An RTPS 2.2 datagram without vendor id, for one participant if given.
    pub(super) fn new(from: Prefix, to: Option<Prefix>) -> Self {
        let mut bytes = b"RTPS\x02\x02\x00\x00".to_vec();
        bytes.extend(from);
        let datagram = Self(bytes);
        match to {
            Some(to) => datagram.with(INFO_DST, 0, |bytes| bytes.extend(to)),
            None => datagram,
        }
    }

    pub(super) fn bytes(self) -> Vec<u8> {
        self.0
    }

    fn with(mut self, kind: u8, flags: u8, write: impl FnOnce(&mut Vec<u8>)) -> Self {
        let mut body = Vec::new();
        write(&mut body);
        // Submessages begin at multiples of four (9.4.1).
        body.resize(body.len().next_multiple_of(4), 0);
        self.0.extend([kind, flags | LITTLE]);
        // A body that is too long for the field is the last one, and needs no length.
        u16_le(&mut self.0, u16::try_from(body.len()).unwrap_or_default());
        self.0.append(&mut body);
        self
    }

    /// Write time of the following submessages: seconds since 1970 and fractions of 2^-32 s.
    pub(super) fn timestamp(self, seconds: u32, fraction: u32) -> Self {
        self.with(INFO_TS, 0, |bytes| {
            u32_le(bytes, seconds);
            u32_le(bytes, fraction);
        })
    }

    pub(super) fn data(self, ends: EndpointPair, number: u64, payload: &[u8]) -> Self {
        self.with(DATA, HAS_DATA, |bytes| {
            data_head_le(bytes, ends, number);
            bytes.extend(payload);
        })
    }

    /// Adds a notice that the entity with this key was removed.
    pub(super) fn disposal(self, ends: EndpointPair, number: u64, key: (Guid, &[u8])) -> Self {
        let (guid, payload) = key;
        self.with(DATA, INLINE_QOS | HAS_KEY, |bytes| {
            data_head_le(bytes, ends, number);
            u16_le(bytes, PID_KEY_HASH);
            u16_le(bytes, 16);
            bytes.extend(guid.bytes());
            u16_le(bytes, PID_STATUS_INFO);
            u16_le(bytes, 4);
            bytes.extend([0, 0, 0, GONE]);
            end_parameters(bytes);
            bytes.extend(payload);
        })
    }

    pub(super) fn heartbeat(
        self,
        ends: EndpointPair,
        (first, last): (u64, u64),
        (count, wants_answer): (u32, bool),
    ) -> Self {
        let flags = if wants_answer { 0 } else { FINAL };
        self.with(HEARTBEAT, flags, |bytes| {
            ends_le(bytes, ends);
            sequence_number(bytes, first);
            sequence_number(bytes, last);
            u32_le(bytes, count);
        })
    }

    /// Adds an acknowledgement with a request for missing messages.
    pub(super) fn acknack(self, ends: EndpointPair, request: &AckNackRequest) -> Self {
        let flags = if request.wants_heartbeat { 0 } else { FINAL };
        self.with(ACKNACK, flags, |bytes| {
            ends_le(bytes, ends);
            request.missing.write(bytes);
            u32_le(bytes, request.count);
        })
    }

    /// Adds numbers that will not come: from the start up to the base of the set, and those in it.
    pub(super) fn gap(self, ends: EndpointPair, start: u64, set: &NumberSet) -> Self {
        self.with(GAP, 0, |bytes| {
            ends_le(bytes, ends);
            sequence_number(bytes, start);
            set.write(bytes);
        })
    }
}

fn ends_le(bytes: &mut Vec<u8>, ends: EndpointPair) {
    bytes.extend(ends.reader.0);
    bytes.extend(ends.writer.0);
}

fn data_head_le(bytes: &mut Vec<u8>, ends: EndpointPair, number: u64) {
    u16_le(bytes, 0);
    u16_le(bytes, 16);
    ends_le(bytes, ends);
    sequence_number(bytes, number);
}
