//! DDS: a participant on one interface, with writers and readers of messages in CDR. No socket is open before it is
//! created, nor after it and everything it created are dropped. Independent of the hand.
//!
//! It implements the part of RTPS that this program needs: reliable writers, best-effort readers, UDP over IPv4. Crates
//! that implement more of it listen at every address of the computer, and store whatever an untrusted datagram
//! requests.

mod discovery;
mod message;
mod participant;
mod receive;
mod send;
mod sockets;
#[cfg(test)]
mod tests;
mod wire;

pub use crate::transport::dds::message::{DdsMessage, DdsTopic, DdsWriterId};
use crate::transport::dds::participant::{Core, MESSAGE_MAX, Places};
use crate::transport::dds::sockets::{DATAGRAM_MAX, Sockets};
use crate::transport::dds::wire::{EntityId, Prefix};
use std::collections::VecDeque;
use std::fmt;
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddrV4, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use tokio::sync::{Notify, mpsc};

/// The highest domain whose ports exist (RTPS 9.6.2.3).
pub const DOMAIN_MAX: u16 = 232;
/// Capacity of a reader's channel; beyond it the reader keeps the newest.
const MESSAGES_MAX: usize = 64;
/// Messages that a writer keeps to repeat them for readers that lost them.
const REPEATED_MAX: usize = 8;
/// Interval at which due work is done.
const TICK: Duration = Duration::from_millis(20);

/// Reason why DDS is unavailable.
#[derive(Debug, thiserror::Error)]
pub enum DdsError {
    /// No interface of this computer has this name or address.
    #[error(
        "there is no network interface {name} with an IPv4 address here; 'ip address' lists them"
    )]
    NoInterface {
        /// Name given by the user.
        name: String,
    },
    /// The system refused to listen or to list interfaces.
    #[error("the system does not let DDS use {name}: {error}")]
    System {
        /// The interface.
        name: String,
        /// The system's error.
        error: io::Error,
    },
}

/// Configuration of a participant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DdsPlace {
    /// The interface: its name, or its address in numbers.
    pub interface: String,
    /// DDS domain; programs in other domains are invisible.
    pub domain: u16,
}

/// One participant, shared by its copies.
#[derive(Debug, Clone)]
pub struct DdsNode {
    open: Arc<Open>,
}

/// A participant and its sockets. When dropped, it leaves, and its threads end soon afterwards.
struct Open {
    shared: Arc<NodeState>,
    prefix: Prefix,
    address: Ipv4Addr,
}

struct NodeState {
    core: Mutex<Core>,
    sockets: Sockets,
    has_ended: AtomicBool,
}

impl DdsNode {
    /// Joins now, on this interface alone.
    ///
    /// # Errors
    /// [`DdsError`], if there is no such interface or it cannot be listened on.
    pub fn open(place: &DdsPlace) -> Result<Self, DdsError> {
        let address = address(&place.interface)?;
        let failed = |error| DdsError::System {
            name: place.interface.clone(),
            error,
        };
        let domain = place.domain.min(DOMAIN_MAX);
        let sockets = Sockets::open(address, domain).map_err(failed)?;
        let places = Places {
            domain,
            announcements: sockets.announcements_at(),
            messages: sockets.messages_at(),
            everyone: sockets.everyone(),
        };
        let prefix = new_prefix();
        let shared = Arc::new(NodeState {
            core: Mutex::new(Core::new(prefix, places, Instant::now())),
            sockets,
            has_ended: AtomicBool::new(false),
        });
        let node = Self {
            open: Arc::new(Open {
                shared: Arc::clone(&shared),
                prefix,
                address,
            }),
        };
        for nth in 0..Sockets::COUNT {
            let shared = Arc::clone(&shared);
            spawn(move || shared.listen(nth)).map_err(failed)?;
        }
        spawn(move || shared.tick()).map_err(failed)?;
        Ok(node)
    }

    /// The address of its interface.
    pub fn address(&self) -> Ipv4Addr {
        self.open.address
    }

    /// True if a message came from this participant itself.
    pub fn wrote(&self, message: &DdsMessage) -> bool {
        message.from.0.starts_with(&self.open.prefix)
    }

    /// Creates a writer with the default QoS of CycloneDDS and ROS 2: reliable, for the present readers.
    pub fn writer(&self, topic: &DdsTopic) -> DdsWriter {
        self.writer_that((REPEATED_MAX, false), topic)
    }

    /// The same, and late joiners also get the last message.
    pub fn lasting_writer(&self, topic: &DdsTopic) -> DdsWriter {
        self.writer_that((1, true), topic)
    }

    fn writer_that(&self, keeps: (usize, bool), topic: &DdsTopic) -> DdsWriter {
        let shared = &self.open.shared;
        let (entity, _sent) = shared.with(|core, now| core.add_writer(topic, keeps, now));
        DdsWriter {
            entity,
            node: self.clone(),
        }
    }

    /// Returns the messages of a topic from now on, of every writer, reliable or not; the newest `kept` are kept until
    /// they are read. Must be called within a tokio runtime.
    pub fn reader(&self, topic: &DdsTopic, kept: u16) -> mpsc::Receiver<DdsMessage> {
        let waiting = Arc::new(ReceiveQueue {
            messages: Mutex::new(VecDeque::new()),
            kept: usize::from(kept).max(1),
            arrived: Notify::new(),
        });
        let inbox = Arc::clone(&waiting);
        let shared = &self.open.shared;
        let inbox = Box::new(move |message| inbox.push(message));
        let (entity, _sent) = shared.with(|core, now| core.add_reader(topic, inbox, now));
        let (messages, taken) = mpsc::channel(MESSAGES_MAX);
        let node = self.clone();
        tokio::spawn(async move {
            waiting.hand_on(messages).await;
            node.open.shared.with(|core, now| core.remove(entity, now));
        });
        taken
    }
}

impl fmt::Debug for Open {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Open").field(&self.address).finish()
    }
}

impl Drop for Open {
    fn drop(&mut self) {
        self.shared.with(|core, _now| core.leave());
        self.shared.has_ended.store(true, Ordering::Relaxed);
    }
}

impl NodeState {
    /// Runs `work` on the participant, and sends the resulting datagrams; also returns false if some of them could not be sent.
    fn with<T>(&self, work: impl FnOnce(&mut Core, Instant) -> T) -> (T, bool) {
        let (done, outgoing) = {
            let mut core = lock(&self.core);
            let done = work(&mut core, Instant::now());
            (done, core.outgoing())
        };
        let is_unsent =
            |(place, bytes): &(SocketAddrV4, Vec<u8>)| !self.sockets.send(bytes, *place);
        let unsent = outgoing.iter().filter(|one| is_unsent(one)).count();
        (done, unsent == 0)
    }

    fn listen(&self, nth: usize) {
        let mut buffer = Box::new([0; DATAGRAM_MAX]);
        while !self.has_ended.load(Ordering::Relaxed) {
            self.sockets.receive(nth, &mut buffer, |datagram, source| {
                self.with(|core, now| core.receive(datagram, source, now));
            });
        }
    }

    fn tick(&self) {
        while !self.has_ended.load(Ordering::Relaxed) {
            self.with(Core::tick);
            thread::sleep(TICK);
        }
    }
}

/// Spawns a thread that ends with the participant and is not joined.
fn spawn(work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let thread = thread::Builder::new().name("dds".into());
    thread.spawn(work).map(drop)
}

fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A random prefix whose first two bytes are those of no vendor.
fn new_prefix() -> Prefix {
    let mut prefix = [0; 12];
    prefix
        .iter_mut()
        .skip(2)
        .for_each(|byte| *byte = fastrand::u8(..));
    prefix
}

/// Received messages that were not read yet.
struct ReceiveQueue {
    messages: Mutex<VecDeque<DdsMessage>>,
    kept: usize,
    arrived: Notify,
}

impl ReceiveQueue {
    fn push(&self, message: DdsMessage) {
        let mut messages = lock(&self.messages);
        if messages.len() >= self.kept {
            messages.pop_front();
        }
        messages.push_back(message);
        self.arrived.notify_one();
    }

    /// Forwards messages until the receiver is dropped.
    async fn hand_on(&self, to: mpsc::Sender<DdsMessage>) {
        loop {
            let next = lock(&self.messages).pop_front();
            let is_open = match next {
                Some(message) => to.send(message).await.is_ok(),
                None => tokio::select! {
                    () = to.closed() => false,
                    () = self.arrived.notified() => true,
                },
            };
            if !is_open {
                return;
            }
        }
    }
}

/// A writer. When dropped, it is removed from its readers.
#[derive(Debug)]
pub struct DdsWriter {
    entity: EntityId,
    node: DdsNode,
}

impl DdsWriter {
    /// Sends little-endian CDR with its header; false if it could not be sent at once.
    pub fn send(&self, message: Vec<u8>) -> bool {
        debug_assert!(message.len() <= MESSAGE_MAX, "{}", message.len());
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
        let since_1970 = since_1970.unwrap_or_default();
        let shared = &self.node.open.shared;
        let (fits, is_sent) =
            shared.with(|core, now| core.write(self.entity, message, since_1970, now));
        fits && is_sent
    }
}

impl Drop for DdsWriter {
    fn drop(&mut self) {
        self.node
            .open
            .shared
            .with(|core, now| core.remove(self.entity, now));
    }
}

/// The address of an interface of this computer, given by name or address.
fn address(interface: &str) -> Result<Ipv4Addr, DdsError> {
    let missing = || DdsError::NoInterface {
        name: interface.to_owned(),
    };
    match interface.parse() {
        // Only a local address can be bound.
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
