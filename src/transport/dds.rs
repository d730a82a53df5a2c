//! DDS: a participant on one interface, with writers and readers of messages in CDR. Nothing is open before it, nor after it and
//! all that it made are dropped. Knows no hand.

use futures::StreamExt as _;
use rustdds::RTPSEntity as _;
use rustdds::bytes::Bytes;
use rustdds::no_key::{DataReader, DataWriter, Decode, DefaultDecoder};
use rustdds::no_key::{DeserializerAdapter, SerializerAdapter};
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, Publisher, QosPolicies, QosPolicyBuilder,
    RepresentationIdentifier, Subscriber, Topic, TopicKind,
};
use std::convert::Infallible;
use std::fmt;
use std::io;
use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use tokio::sync::mpsc;

/// The highest domain whose ports exist (RTPS 9.6.2.3).
pub const DOMAIN_MAX: u16 = 232;
/// Messages that may wait to be looked at; a reader keeps the newest of those beyond.
const MESSAGES_MAX: usize = 64;
/// The head of a message in little-endian CDR, which DDS keeps apart from its body.
const HEAD: usize = 4;
/// Bytes of an id that name the participant.
const PREFIX: usize = 12;

/// Why there is no DDS.
#[derive(Debug, thiserror::Error)]
pub enum DdsError {
    /// No interface of this computer is named so, or has such an address.
    #[error(
        "there is no network interface {name} with an IPv4 address here; 'ip address' lists them"
    )]
    NoInterface {
        /// As the user named it.
        name: String,
    },
    /// The system did not let it listen or ask for interfaces.
    #[error("the system does not let DDS use {name}: {error}")]
    System {
        /// The interface.
        name: String,
        /// The system's words.
        error: io::Error,
    },
    /// The library did not come up.
    #[error("DDS did not start: {error}")]
    Library {
        /// Its words.
        error: rustdds::dds::CreateError,
    },
}

/// Who wrote a message: one writer of one process. None is ever given twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DdsWriterId(pub [u8; 16]);

impl fmt::Display for DdsWriterId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// A message that came in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DdsMessage {
    /// Who wrote it.
    pub from: DdsWriterId,
    /// CDR behind its head of four bytes.
    pub bytes: Vec<u8>,
}

/// A topic and the type of its messages, as DDS names them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DdsTopic {
    pub name: String,
    pub type_name: String,
}

/// Where DDS is to be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DdsPlace {
    /// The interface: its name, or its address in numbers.
    pub interface: String,
    /// Programs of other domains are not met.
    pub domain: u16,
}

/// One participant. Copies are the same one.
#[derive(Clone)]
pub struct DdsNode {
    participant: DomainParticipant,
    publisher: Publisher,
    subscriber: Subscriber,
    address: Ipv4Addr,
}

impl fmt::Debug for DdsNode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("DdsNode").field(&self.address).finish()
    }
}

impl DdsNode {
    /// Joins from now on, at this interface alone. Blocks for some milliseconds.
    ///
    /// # Errors
    /// [`DdsError`], if there is no such interface or nobody can listen there.
    pub fn open(place: &DdsPlace) -> Result<Self, DdsError> {
        let address = address(&place.interface)?;
        let participant = DomainParticipantBuilder::new(place.domain.min(DOMAIN_MAX))
            .with_only_networks([address])
            .build()?;
        Ok(Self {
            publisher: participant.create_publisher(&QosPolicies::qos_none())?,
            subscriber: participant.create_subscriber(&QosPolicies::qos_none())?,
            participant,
            address,
        })
    }

    /// The address of its interface.
    pub const fn address(&self) -> Ipv4Addr {
        self.address
    }

    /// Whether a message came from this participant itself.
    pub fn wrote(&self, message: &DdsMessage) -> bool {
        // A writer's id begins with its participant's (RTPS 8.2.4).
        let own = self.participant.guid().to_bytes();
        own.iter()
            .zip(message.from.0)
            .take(PREFIX)
            .all(|(own, from)| *own == from)
    }

    /// Writes to a topic, as CycloneDDS and ROS 2 do unless they are told otherwise: reliably, to whoever is there now.
    ///
    /// # Errors
    /// [`DdsError::Library`].
    pub fn writer(&self, topic: &DdsTopic) -> Result<DdsWriter, DdsError> {
        self.writer_that(Durability::Volatile, topic)
    }

    /// The same; whoever comes later gets the last message, too.
    ///
    /// # Errors
    /// [`DdsError::Library`].
    pub fn lasting_writer(&self, topic: &DdsTopic) -> Result<DdsWriter, DdsError> {
        self.writer_that(Durability::TransientLocal, topic)
    }

    fn writer_that(&self, lasts: Durability, topic: &DdsTopic) -> Result<DdsWriter, DdsError> {
        let reliably = QosPolicyBuilder::new()
            .durability(lasts)
            .history(History::KeepLast { depth: 1 })
            .reliability(Reliability::Reliable {
                // What cannot go out at once is too late.
                max_blocking_time: rustdds::Duration::ZERO,
            })
            .build();
        let topic = self.topic(topic, &reliably)?;
        let writer = self.publisher.create_datawriter_no_key(&topic, None)?;
        Ok(DdsWriter {
            writer,
            _participant: self.participant.clone(),
        })
    }

    /// The messages of a topic from now on, of every writer, reliable or not; the newest so many are kept until they are taken. Must
    /// be called within a tokio runtime.
    ///
    /// # Errors
    /// [`DdsError::Library`].
    pub fn reader(
        &self,
        topic: &DdsTopic,
        kept: u16,
    ) -> Result<mpsc::Receiver<DdsMessage>, DdsError> {
        let anyhow = QosPolicyBuilder::new()
            .durability(Durability::Volatile)
            .history(History::KeepLast { depth: kept.into() })
            .reliability(Reliability::BestEffort)
            .build();
        let topic = self.topic(topic, &anyhow)?;
        let reader: DataReader<RawMessage, Cdr> =
            self.subscriber.create_datareader_no_key(&topic, None)?;
        let (messages, taken) = mpsc::channel(MESSAGES_MAX);
        let participant = self.participant.clone();
        tokio::spawn(async move {
            read(reader, messages).await;
            // It does not read without.
            drop(participant);
        });
        Ok(taken)
    }

    fn topic(&self, topic: &DdsTopic, qos: &QosPolicies) -> Result<Topic, DdsError> {
        let (name, type_name) = (topic.name.clone(), topic.type_name.clone());
        let kind = TopicKind::NoKey;
        Ok(self.participant.create_topic(name, type_name, qos, kind)?)
    }
}

impl From<rustdds::dds::CreateError> for DdsError {
    fn from(error: rustdds::dds::CreateError) -> Self {
        Self::Library { error }
    }
}

/// Hands messages on for as long as somebody takes them.
async fn read(reader: DataReader<RawMessage, Cdr>, messages: mpsc::Sender<DdsMessage>) {
    let mut samples = reader.async_sample_stream();
    loop {
        let sample = tokio::select! {
            () = messages.closed() => return,
            sample = samples.next() => sample,
        };
        let message = match sample {
            Some(Ok(sample)) => DdsMessage {
                from: DdsWriterId(sample.sample_info().writer_guid().to_bytes()),
                bytes: sample.into_value().0,
            },
            // In an encoding that nobody here reads; it is not said whose.
            Some(Err(rustdds::dds::ReadError::Deserialization { .. })) => DdsMessage {
                from: DdsWriterId([0; 16]),
                bytes: Vec::new(),
            },
            Some(Err(_)) | None => return,
        };
        if messages.send(message).await.is_err() {
            return;
        }
    }
}

/// A writer. Dropped, it is gone for its readers.
pub struct DdsWriter {
    writer: DataWriter<Bytes, Cdr>,
    /// It does not write without.
    _participant: DomainParticipant,
}

impl fmt::Debug for DdsWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("DdsWriter")
    }
}

impl DdsWriter {
    /// Sends little-endian CDR with its head; false if it could not go out at once.
    pub fn send(&self, mut message: Vec<u8>) -> bool {
        let body = message.split_off(HEAD.min(message.len()));
        self.writer.write(Bytes::from(body), None).is_ok()
    }
}

/// A message with its head.
struct RawMessage(Vec<u8>);

/// Messages are made and read elsewhere.
struct Cdr;

impl SerializerAdapter<Bytes> for Cdr {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(value: &Bytes) -> Result<Bytes, Infallible> {
        Ok(value.clone())
    }
}

impl DeserializerAdapter<RawMessage> for Cdr {
    type Error = Infallible;
    type Decoded = RawMessage;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[
            RepresentationIdentifier::CDR_LE,
            RepresentationIdentifier::CDR_BE,
        ]
    }

    fn transform_decoded(decoded: RawMessage) -> RawMessage {
        decoded
    }
}

impl DefaultDecoder<RawMessage> for Cdr {
    type Decoder = CdrHead;
    const DECODER: CdrHead = CdrHead;
}

/// Puts the head before the body again.
#[derive(Clone)]
struct CdrHead;

impl Decode<'_, RawMessage> for CdrHead {
    type Error = Infallible;

    fn decode_bytes(
        self,
        body: &[u8],
        encoding: RepresentationIdentifier,
    ) -> Result<RawMessage, Infallible> {
        let little = u8::from(encoding == RepresentationIdentifier::CDR_LE);
        let mut message = vec![0, little, 0, 0];
        message.extend_from_slice(body);
        Ok(RawMessage(message))
    }
}

/// The address of an interface of this computer, which is named or given in numbers.
fn address(interface: &str) -> Result<Ipv4Addr, DdsError> {
    let missing = || DdsError::NoInterface {
        name: interface.to_owned(),
    };
    match interface.parse() {
        // Only an own address can be listened at.
        Ok(IpAddr::V4(address)) if UdpSocket::bind((address, 0)).is_ok() => Ok(address),
        Ok(_) => Err(missing()),
        Err(_a_name) => named(interface)?.ok_or_else(missing),
    }
}

#[cfg(unix)]
fn named(interface: &str) -> Result<Option<Ipv4Addr>, DdsError> {
    let all = nix::ifaddrs::getifaddrs().map_err(|error| DdsError::System {
        name: interface.to_owned(),
        error: error.into(),
    })?;
    let mut own = all.filter(|own| own.interface_name == interface);
    Ok(own.find_map(|own| Some(own.address?.as_sockaddr_in()?.ip())))
}

#[cfg(not(unix))]
fn named(_interface: &str) -> Result<Option<Ipv4Addr>, DdsError> {
    Ok(None)
}
