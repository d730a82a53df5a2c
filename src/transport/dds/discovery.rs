//! Announcements of participants, their readers and their writers (DDSI-RTPS 2.5, 8.5 and 9.6.2).

use crate::transport::dds::wire::{Cursor, EntityId, Guid, LOCATOR_UDP_V4};
use crate::transport::dds::wire::{end_parameters, parameter, u16_le, u32_le};
use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

/// Maximum length of a topic or type name: DDS itself allows 255 characters.
pub(super) const NAME_MAX: usize = 256;
/// Maximum locators used of those announced.
const LOCATORS_MAX: usize = 16;

const PID_LEASE: u16 = 0x0002;
const PID_TOPIC_NAME: u16 = 0x0005;
const PID_TYPE_NAME: u16 = 0x0007;
const PID_DOMAIN: u16 = 0x000f;
const PID_PROTOCOL_VERSION: u16 = 0x0015;
const PID_VENDOR: u16 = 0x0016;
const PID_RELIABILITY: u16 = 0x001a;
const PID_DURABILITY: u16 = 0x001d;
const PID_PARTITION: u16 = 0x0029;
const PID_UNICAST_LOCATOR: u16 = 0x002f;
const PID_DEFAULT_UNICAST_LOCATOR: u16 = 0x0031;
const PID_METATRAFFIC_UNICAST_LOCATOR: u16 = 0x0032;
const PID_PARTICIPANT_GUID: u16 = 0x0050;
const PID_BUILTIN_ENDPOINTS: u16 = 0x0058;
const PID_ENDPOINT_GUID: u16 = 0x005a;

/// Encodings in a payload's header: parameters in big and in little endian.
const PL_CDR_BE: u8 = 2;
const PL_CDR_LE: u8 = 3;

/// Built-in endpoints of a participant: writer and reader for announcements of writers, and the same for readers.
pub(super) const HAS_PUBLICATIONS_WRITER: u32 = 1 << 2;
pub(super) const HAS_PUBLICATIONS_READER: u32 = 1 << 3;
pub(super) const HAS_SUBSCRIPTIONS_WRITER: u32 = 1 << 4;
pub(super) const HAS_SUBSCRIPTIONS_READER: u32 = 1 << 5;
const HAS_ALL: u32 = 0b11_1111;

/// A participant as announced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Announced {
    pub(super) guid: Guid,
    pub(super) domain: Option<u32>,
    pub(super) lease: Duration,
    pub(super) builtin: u32,
    /// Its addresses for announcements, and for messages.
    pub(super) announcements: Vec<SocketAddrV4>,
    pub(super) messages: Vec<SocketAddrV4>,
}

/// Default lease duration (9.6.3.2).
const LEASE_DEFAULT: Duration = Duration::from_secs(100);

impl Announced {
    pub(super) fn parse(payload: &[u8]) -> Option<Self> {
        let mut guid = None;
        let mut announced = Self {
            guid: Guid::from_bytes([0; 16])?,
            domain: None,
            lease: LEASE_DEFAULT,
            builtin: 0,
            announcements: Vec::new(),
            messages: Vec::new(),
        };
        each(payload, |id, mut value| {
            match id {
                PID_PARTICIPANT_GUID => guid = Guid::from_bytes(value.array()?),
                PID_DOMAIN => announced.domain = value.u32(),
                PID_LEASE => announced.lease = Duration::from_secs(value.u32()?.into()),
                PID_BUILTIN_ENDPOINTS => announced.builtin = value.u32()?,
                PID_METATRAFFIC_UNICAST_LOCATOR => place(&mut announced.announcements, value)?,
                PID_DEFAULT_UNICAST_LOCATOR => place(&mut announced.messages, value)?,
                _ => {}
            }
            Some(())
        })?;
        announced.guid = guid.filter(|guid| guid.entity == EntityId::PARTICIPANT)?;
        Some(announced)
    }

    /// Encodes it as a payload.
    pub(super) fn payload(&self) -> Vec<u8> {
        let mut bytes = head();
        put(&mut bytes, PID_PROTOCOL_VERSION, &[2, 2, 0, 0]);
        put(&mut bytes, PID_VENDOR, &[0; 4]);
        if let Some(domain) = self.domain {
            put(&mut bytes, PID_DOMAIN, &domain.to_le_bytes());
        }
        put(&mut bytes, PID_PARTICIPANT_GUID, &self.guid.bytes());
        let lease = u32::try_from(self.lease.as_secs()).unwrap_or(u32::MAX);
        put(&mut bytes, PID_LEASE, &u64::from(lease).to_le_bytes());
        put(&mut bytes, PID_BUILTIN_ENDPOINTS, &HAS_ALL.to_le_bytes());
        for place in &self.announcements {
            put(
                &mut bytes,
                PID_METATRAFFIC_UNICAST_LOCATOR,
                &locator(*place),
            );
        }
        for place in &self.messages {
            put(&mut bytes, PID_DEFAULT_UNICAST_LOCATOR, &locator(*place));
        }
        end_parameters(&mut bytes);
        bytes
    }
}

/// A reader or writer, as announced by its participant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AnnouncedEndpoint {
    pub(super) guid: Guid,
    pub(super) topic: String,
    pub(super) type_name: String,
    /// Reliable: a writer repeats lost messages; a reader requires that.
    pub(super) is_reliable: bool,
    /// Transient local: late joiners get the last message, or request it.
    pub(super) is_lasting: bool,
    /// In a partition, which nothing here uses.
    pub(super) is_apart: bool,
    /// Its addresses, if they differ from its participant's.
    pub(super) places: Vec<SocketAddrV4>,
}

const BEST_EFFORT: u32 = 1;
const RELIABLE: u32 = 2;
const TRANSIENT_LOCAL: u32 = 1;

impl AnnouncedEndpoint {
    pub(super) fn parse(payload: &[u8], is_writer: bool) -> Option<Self> {
        let (mut guid, mut topic, mut type_name) = (None, None, None);
        // By default writers are reliable, and readers are not.
        let (mut is_reliable, mut is_lasting, mut is_apart) = (is_writer, false, false);
        let mut places = Vec::new();
        each(payload, |id, mut value| {
            match id {
                PID_ENDPOINT_GUID => guid = Guid::from_bytes(value.array()?),
                PID_TOPIC_NAME => topic = Some(string(value)?),
                PID_TYPE_NAME => type_name = Some(string(value)?),
                PID_RELIABILITY => is_reliable = value.u32()? >= RELIABLE,
                PID_DURABILITY => is_lasting = value.u32()? >= TRANSIENT_LOCAL,
                PID_PARTITION => {
                    is_apart = value.u32()? != 0 && string(value).as_deref() != Some("")
                }
                PID_UNICAST_LOCATOR => place(&mut places, value)?,
                _ => {}
            }
            Some(())
        })?;
        Some(Self {
            guid: guid?,
            topic: topic?,
            type_name: type_name?,
            is_reliable,
            is_lasting,
            is_apart,
            places,
        })
    }

    /// Encodes it as a payload.
    pub(super) fn payload(&self) -> Vec<u8> {
        let mut bytes = head();
        put(&mut bytes, PID_ENDPOINT_GUID, &self.guid.bytes());
        put(&mut bytes, PID_TOPIC_NAME, &string_le(&self.topic));
        put(&mut bytes, PID_TYPE_NAME, &string_le(&self.type_name));
        let kind = if self.is_reliable {
            RELIABLE
        } else {
            BEST_EFFORT
        };
        let mut reliability = kind.to_le_bytes().to_vec();
        // Maximum blocking time of a writer, which is unused.
        reliability.extend([0; 8]);
        put(&mut bytes, PID_RELIABILITY, &reliability);
        let durability = if self.is_lasting { TRANSIENT_LOCAL } else { 0 };
        put(&mut bytes, PID_DURABILITY, &durability.to_le_bytes());
        end_parameters(&mut bytes);
        bytes
    }
}

/// The key of a participant, or of a reader or writer, as a payload.
pub(super) fn key(guid: Guid) -> Vec<u8> {
    let mut bytes = head();
    let id = if guid.entity == EntityId::PARTICIPANT {
        PID_PARTICIPANT_GUID
    } else {
        PID_ENDPOINT_GUID
    };
    put(&mut bytes, id, &guid.bytes());
    end_parameters(&mut bytes);
    bytes
}

/// The id in a key.
pub(super) fn keyed(payload: &[u8]) -> Option<Guid> {
    let mut guid = None;
    each(payload, |id, mut value| {
        if matches!(id, PID_PARTICIPANT_GUID | PID_ENDPOINT_GUID) {
            guid = Guid::from_bytes(value.array()?);
        }
        Some(())
    })?;
    guid
}

/// Reads the parameters of a payload; `None` if one is malformed.
fn each<'a>(payload: &'a [u8], mut read: impl FnMut(u16, Cursor<'a>) -> Option<()>) -> Option<()> {
    let ([0, kind, _, _], list) = payload.split_first_chunk()? else {
        return None;
    };
    let is_little = match *kind {
        PL_CDR_LE => true,
        PL_CDR_BE => false,
        _ => return None,
    };
    let mut list = Cursor::new(list, is_little);
    while let Some((id, value)) = parameter(&mut list, is_little)? {
        read(id, Cursor::new(value, is_little))?;
    }
    Some(())
}

fn string(mut value: Cursor<'_>) -> Option<String> {
    let length = value.length().filter(|length| *length <= NAME_MAX)?;
    let bytes = value.skip(length)?;
    let text = bytes.split(|byte| *byte == 0).next()?;
    Some(std::str::from_utf8(text).ok()?.to_owned())
}

fn string_le(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    u32_le(
        &mut bytes,
        u32::try_from(text.len() + 1).unwrap_or_default(),
    );
    bytes.extend(text.bytes());
    bytes.push(0);
    bytes
}

fn place(places: &mut Vec<SocketAddrV4>, mut value: Cursor<'_>) -> Option<()> {
    if let Some(place) = value.locator()?
        && places.len() < LOCATORS_MAX
    {
        places.push(place);
    }
    Some(())
}

fn locator(place: SocketAddrV4) -> Vec<u8> {
    let mut bytes = Vec::new();
    u32_le(&mut bytes, LOCATOR_UDP_V4);
    u32_le(&mut bytes, place.port().into());
    bytes.extend([0; 12]);
    bytes.extend(place.ip().octets());
    bytes
}

fn head() -> Vec<u8> {
    vec![0, PL_CDR_LE, 0, 0]
}

fn put(bytes: &mut Vec<u8>, id: u16, value: &[u8]) {
    let padded = value.len().next_multiple_of(4);
    u16_le(bytes, id);
    u16_le(bytes, u16::try_from(padded).unwrap_or_default());
    bytes.extend(value);
    bytes.resize(bytes.len() + padded - value.len(), 0);
}

/// Address of a participant: the source address of its announcement, so that it cannot redirect messages to a third party.
pub(super) fn reached(places: &[SocketAddrV4], source: Ipv4Addr) -> Option<SocketAddrV4> {
    let same = places.iter().find(|place| *place.ip() == source);
    let port = same.or(places.first())?.port();
    Some(SocketAddrV4::new(source, port))
}
