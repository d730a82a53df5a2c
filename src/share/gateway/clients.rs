//! Clients of a gateway, with their statistics. Stores only; sends nothing.

use crate::hand::{HandCommand, Moment};
use crate::link::session::motion::SETPOINT_HZ_MAX;
use crate::link::{Lease, LeaseRefusal};
use crate::share::gateway::refusal::WriteRefusal;
use std::collections::VecDeque;
use std::mem::Discriminant;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::Notify;
use tokio::time::Instant;

/// Concurrent clients; further connections are refused at once.
pub const CLIENTS_MAX: usize = 16;
/// Smallest interval between commands of one kind, as for the setpoints of a slider.
const WRITE_INTERVAL: Duration = Duration::from_millis(1000 / SETPOINT_HZ_MAX as u64);
/// Period over which requests are counted.
const RATE_OVER: Duration = Duration::from_secs(1);
/// Queue of control changes until they are reported: clients may come and go between two polls.
const EVENTS_MAX: usize = 256;

/// Identifies one connection to a gateway; never reused. The default is not a valid id.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct ClientId(u64);

/// One client, as shown to the user.
#[derive(Debug, Clone, PartialEq)]
pub struct GatewayClient {
    pub id: ClientId,
    pub address: SocketAddr,
    /// Time of the connection, by the link's clock.
    pub since: Moment,
    /// Requests in the last full second.
    pub hz: u32,
    /// Reads answered with values.
    pub reads: u64,
    /// Writes acknowledged by the hand.
    pub writes: u64,
    /// Refused writes.
    pub refused: u64,
    /// Reason for the last refusal.
    pub refusal: Option<WriteRefusal>,
    /// Control of the hand.
    pub lease: ClientLease,
}

/// State of a client's control of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClientLease {
    /// It never had control.
    Never,
    /// It has control.
    Held(Lease),
    /// It had control until this.
    Ended(LeaseRefusal),
}

/// A change of control of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MoverEvent {
    pub client: SocketAddr,
    pub change: MoverChange,
}

/// Kind of a control change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoverChange {
    /// The client got control.
    Began,
    /// The client lost control, for this reason.
    Ended(LeaseRefusal),
    /// The client disconnected, and the hand is stopped.
    Left,
}

/// The clients of one gateway, shared by their connections. Each lock lasts for one call.
#[derive(Debug, Clone, Default)]
pub(crate) struct SharedClientTable(Arc<Mutex<ClientTable>>);

impl SharedClientTable {
    pub(crate) fn with<T>(&self, act: impl FnOnce(&mut ClientTable) -> T) -> T {
        // Each call leaves the table consistent, even one that panicked.
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The clients of one gateway.
#[derive(Debug, Default)]
pub(crate) struct ClientTable {
    rows: Vec<Client>,
    last_id: u64,
    pub(crate) turned_away: u64,
    /// The client that is acquiring control.
    taking: Option<ClientId>,
    /// Control changes not yet reported.
    events: VecDeque<MoverEvent>,
    /// Time of the last command of each kind.
    turns: Vec<(Discriminant<HandCommand>, Instant)>,
}

/// The client that has control of the hand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Holder {
    pub(crate) client: ClientId,
    pub(crate) lease: Lease,
    pub(crate) last_request: Moment,
}

/// One client's entry.
#[derive(Debug)]
pub(crate) struct Client {
    shown: GatewayClient,
    pace: Pace,
    /// Time of its last request.
    last_request: Moment,
    /// Time at which it last stopped another controller's motion.
    pub(crate) stopped: Option<Instant>,
    /// Notified when the user grants it control.
    pub(crate) granted: Arc<Notify>,
}

impl Client {
    /// Counts a complete request.
    pub(crate) fn count_request(&mut self, now: Moment) {
        self.last_request = now;
        self.pace.hit(now);
    }

    /// Control state, for changes.
    pub(crate) fn lease(&mut self) -> &mut ClientLease {
        &mut self.shown.lease
    }

    /// Records that a grant by the user failed.
    pub(crate) fn not_granted(&mut self, refusal: WriteRefusal) {
        self.shown.refusal = Some(refusal);
    }

    /// Counts an answered read.
    pub(crate) fn read(&mut self) {
        self.shown.reads += 1;
    }

    /// Counts a stop that was obeyed although the request itself was invalid.
    pub(crate) fn note_odd_stop(&mut self, odd: WriteRefusal) {
        self.shown.writes += 1;
        self.shown.refusal = Some(odd);
    }

    /// Counts the result of a write.
    pub(crate) fn wrote(&mut self, written: Result<(), WriteRefusal>) {
        match written {
            Ok(()) => self.shown.writes += 1,
            Err(refusal) => {
                self.shown.refused += 1;
                self.shown.refusal = Some(refusal);
            }
        }
    }
}

impl ClientTable {
    /// Adds a new client, unless there are too many.
    pub(crate) fn connect(&mut self, address: SocketAddr, now: Moment) -> Option<ClientId> {
        if self.rows.len() >= CLIENTS_MAX {
            self.turned_away += 1;
            return None;
        }
        self.last_id += 1;
        let id = ClientId(self.last_id);
        self.rows.push(Client {
            shown: GatewayClient {
                id,
                address,
                since: now,
                hz: 0,
                reads: 0,
                writes: 0,
                refused: 0,
                refusal: None,
                lease: ClientLease::Never,
            },
            pace: Pace::default(),
            last_request: now,
            stopped: None,
            granted: Arc::default(),
        });
        Some(id)
    }

    /// Queues a control change of this client for reporting.
    pub(crate) fn mover(&mut self, id: ClientId, change: MoverChange) {
        let Some(client) = self.row(id).map(|row| row.shown.address) else {
            return;
        };
        if self.events.len() >= EVENTS_MAX {
            self.events.pop_front();
        }
        self.events.push_back(MoverEvent { client, change });
    }

    /// Returns the changes since the last call, in order.
    pub(crate) fn take_events(&mut self) -> Vec<MoverEvent> {
        self.events.drain(..).collect()
    }

    /// Removes a client.
    pub(crate) fn disconnect(&mut self, id: ClientId) {
        self.taking.take_if(|taking| *taking == id);
        self.rows.retain(|row| row.shown.id != id);
    }

    /// Returns the client that has control, with the time of its last request.
    pub(crate) fn holder(&self) -> Option<Holder> {
        self.rows.iter().find_map(|row| match row.shown.lease {
            ClientLease::Held(lease) => Some(Holder {
                client: row.shown.id,
                lease,
                last_request: row.last_request,
            }),
            _ => None,
        })
    }

    /// Starts acquiring control for a client, one at a time, and returns its address; `None` if another is in progress.
    pub(crate) fn begin_taking(&mut self, id: ClientId) -> Option<SocketAddr> {
        let row = self.rows.iter().find(|row| row.shown.id == id)?;
        if self.taking.is_some() {
            return None;
        }
        self.taking = Some(id);
        Some(row.shown.address)
    }

    /// Ends the acquisition, successful or not.
    pub(crate) fn end_taking(&mut self) {
        self.taking = None;
    }

    /// Time at which a command of this kind may be sent next: at most [`SETPOINT_HZ_MAX`] per second.
    pub(crate) fn turn(&mut self, command: &HandCommand, now: Instant) -> Instant {
        let kind = std::mem::discriminant(command);
        let before = self.turns.iter().find(|(own, _)| *own == kind);
        let turn = before.map_or(now, |(_, before)| now.max(*before + WRITE_INTERVAL));
        self.turns.retain(|(own, _)| *own != kind);
        self.turns.push((kind, turn));
        turn
    }

    pub(crate) fn row(&mut self, id: ClientId) -> Option<&mut Client> {
        self.rows.iter_mut().find(|row| row.shown.id == id)
    }

    /// All clients, the oldest first.
    pub(crate) fn shown(&self, now: Moment) -> Vec<GatewayClient> {
        let shown = |row: &Client| GatewayClient {
            hz: row.pace.hz(now),
            ..row.shown.clone()
        };
        self.rows.iter().map(shown).collect()
    }
}

/// Counts events per full second.
#[derive(Debug, Default)]
struct Pace {
    began: Moment,
    now: u32,
    before: u32,
}

impl Pace {
    fn hit(&mut self, now: Moment) {
        let passed = now.since(self.began);
        if passed >= RATE_OVER {
            self.before = if passed < 2 * RATE_OVER { self.now } else { 0 };
            self.now = 0;
            self.began = Moment::from_micros(now.micros() / 1_000_000 * 1_000_000);
        }
        self.now = self.now.saturating_add(1);
    }

    fn hz(&self, now: Moment) -> u32 {
        match now.since(self.began).as_secs() {
            0 => self.before,
            1 => self.now,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> ClientTable {
        ClientTable::default()
    }

    fn address() -> SocketAddr {
        ([127, 0, 0, 1], 4000).into()
    }

    #[test]
    fn the_rate_is_that_of_the_last_whole_second_and_ends_with_the_requests() {
        let (mut table, ms) = (table(), |ms: u64| Moment::from_micros(ms * 1000));
        let id = table.connect(address(), ms(0)).unwrap();
        for nth in 0..300 {
            table.row(id).unwrap().count_request(ms(10_000 + 10 * nth));
        }
        let hz = |table: &ClientTable, at| table.shown(ms(at))[0].hz;
        assert_eq!(hz(&table, 12_995), 100);
        assert_eq!(hz(&table, 13_500), 100);
        assert_eq!(hz(&table, 14_500), 0);
    }

    #[test]
    fn clients_beyond_the_most_are_turned_away_and_counted() {
        let mut table = table();
        let ids: Vec<_> = (0..CLIENTS_MAX)
            .map(|_| table.connect(address(), Moment::ZERO).unwrap())
            .collect();
        assert_eq!(table.connect(address(), Moment::ZERO), None);
        assert_eq!(table.turned_away, 1);
        table.disconnect(ids[3]);
        let next = table.connect(address(), Moment::ZERO).unwrap();
        assert!(!ids.contains(&next));
    }

    #[test]
    fn the_newest_refusal_is_shown() {
        let mut table = table();
        let id = table.connect(address(), Moment::ZERO).unwrap();
        let row = table.row(id).unwrap();
        row.wrote(Err(WriteRefusal::NotGranted));
        row.wrote(Err(WriteRefusal::Taken));
        row.wrote(Ok(()));
        let shown = &table.shown(Moment::ZERO)[0];
        assert_eq!((shown.writes, shown.refused), (1, 2));
        assert_eq!(shown.refusal, Some(WriteRefusal::Taken));
    }
}
