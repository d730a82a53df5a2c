//! Scans one place: opens it, reads HAND_ID of one id after another, and closes it. A hand that answers is also read to
//! identify its series; nothing is written.

use crate::hand::Refusal;
use crate::hand::register::HAND_ID;
use crate::link::bus::late_replies::LateReplies;
use crate::link::bus::{self, Bus, BusError};
use crate::link::clock::Clock;
use crate::link::scan::event::{FoundHand, ScanEvent, ScanHint};
use crate::link::scan::lent_wire::LentWire;
use crate::link::scan::plan::{Lane, LaneKind, Try, same_line};
use crate::link::scan::tracker::ScanTracker;
use crate::link::series::{DeviceSeries, SeriesEvidence, SeriesQuestion};
use crate::transport::{Dial, Endpoint, TransportError};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::time::Instant;

/// State shared by all lanes of a scan.
pub(crate) struct ScanContext {
    pub(crate) dial: Arc<dyn Dial>,
    pub(crate) clock: Clock,
    pub(crate) events: mpsc::Sender<ScanEvent>,
    pub(crate) wake: Arc<dyn Fn() + Send + Sync>,
    pub(crate) tracker: Arc<Mutex<ScanTracker>>,
    /// One failure of a range was reported; the same failure of all others is not.
    pub(crate) range_told: AtomicBool,
}

impl ScanContext {
    pub(crate) async fn publish(&self, event: ScanEvent) {
        // An error means that the scan is being ended.
        let _unheard = self.events.send(event).await;
        (self.wake)();
    }

    pub(crate) fn tracker(&self) -> MutexGuard<'_, ScanTracker> {
        self.tracker.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Result of a probe.
enum ProbeAnswer {
    Hand {
        hand_id: u8,
        round_trip: Duration,
    },
    Silence,
    OtherId(u8),
    OtherSeries(u8),
    Refused(Refusal),
    /// The wire could not be opened.
    Shut(TransportError),
    /// The wire broke.
    Broke(TransportError),
}

/// Findings at a place where no hand answered.
#[derive(Default)]
struct Noticed {
    series: Option<(Endpoint, u8)>,
    other: Option<(Endpoint, u8)>,
    refused: Option<(Endpoint, Refusal)>,
    foreign: Option<Endpoint>,
    garbled: Vec<u32>,
    bytes: usize,
}

impl Noticed {
    /// The most informative finding.
    fn hint(self, place: &str) -> Option<ScanHint> {
        let series = self
            .series
            .map(|(endpoint, hand_id)| ScanHint::OtherSeries { endpoint, hand_id });
        let other = self
            .other
            .map(|(endpoint, hand_id)| ScanHint::OtherId { endpoint, hand_id });
        let refused = self
            .refused
            .map(|(endpoint, reason)| ScanHint::Refuses { endpoint, reason });
        let foreign = self
            .foreign
            .map(|endpoint| ScanHint::OtherTalk { endpoint });
        let garbled = (self.bytes > 0).then(|| ScanHint::Garbled {
            place: place.into(),
            bauds: self.garbled,
            bytes: self.bytes,
        });
        series.or(other).or(refused).or(foreign).or(garbled)
    }
}

/// The scan of one place.
struct LaneScan {
    room: Arc<ScanContext>,
    nth: usize,
    lane: Lane,
    open: Option<(Endpoint, LentWire)>,
    noticed: Noticed,
    found: usize,
    asked: usize,
    failed: bool,
    /// The last trouble, which is reported once.
    reported: Option<TransportError>,
}

/// Runs all probes of a lane, except those that earlier results make unnecessary.
pub(crate) async fn scan_lane(room: Arc<ScanContext>, nth: usize, lane: Lane) {
    let mut scan = LaneScan {
        room,
        nth,
        lane,
        open: None,
        noticed: Noticed::default(),
        found: 0,
        asked: 0,
        failed: false,
        reported: None,
    };
    scan.go().await;
    scan.finish().await;
}

impl LaneScan {
    async fn go(&mut self) {
        let mut rest: VecDeque<Try> = std::mem::take(&mut self.lane.tries).into();
        while let Some(one) = rest.pop_front() {
            match self.probe(&one).await {
                ProbeAnswer::Silence => {}
                ProbeAnswer::Hand {
                    hand_id,
                    round_trip,
                } => {
                    self.found(&one, hand_id, round_trip).await;
                    rest.retain(|other| same_line(&one.endpoint, &other.endpoint));
                }
                ProbeAnswer::OtherId(hand_id) => {
                    self.noticed.other.get_or_insert((one.endpoint, hand_id));
                }
                ProbeAnswer::OtherSeries(hand_id) => {
                    self.noticed.series.get_or_insert((one.endpoint, hand_id));
                }
                ProbeAnswer::Refused(reason) => {
                    self.noticed.refused.get_or_insert((one.endpoint, reason));
                }
                ProbeAnswer::Broke(_) if self.lane.kind == LaneKind::Host => {}
                ProbeAnswer::Shut(error) | ProbeAnswer::Broke(error) => {
                    self.after(&error, &one.endpoint, &mut rest);
                    self.trouble(error).await;
                }
            }
            self.room.tracker().left(self.nth, rest.iter());
            (self.room.wake)();
        }
    }

    async fn found(&mut self, one: &Try, hand_id: u8, round_trip: Duration) {
        self.found += 1;
        self.room.tracker().summary.found += 1;
        let found = FoundHand {
            endpoint: one.endpoint.clone(),
            hand_id,
            round_trip,
            usb: self.lane.usb.clone(),
        };
        self.room.publish(ScanEvent::Found(found)).await;
    }

    /// Drops the probes that would fail in the same way.
    fn after(&mut self, error: &TransportError, at: &Endpoint, rest: &mut VecDeque<Try>) {
        match error {
            TransportError::BitrateRefused { .. } => {
                rest.retain(|other| !same_line(at, &other.endpoint));
            }
            // A port may not support one of the speeds, but still the others.
            TransportError::Io { .. } if self.lane.kind == LaneKind::Port => {
                rest.retain(|other| !same_wire(at, &other.endpoint));
            }
            _ => rest.clear(),
        }
    }

    async fn trouble(&mut self, error: TransportError) {
        if self.reported.as_ref() == Some(&error) {
            return;
        }
        self.reported = Some(error.clone());
        // A host that does not accept the connection was scanned: no hand is there.
        let nobody = matches!(
            error,
            TransportError::Refused { .. } | TransportError::Silent { .. }
        );
        self.failed |= !nobody;
        if self.lane.is_one_of_many
            && (nobody || self.room.range_told.swap(true, Ordering::Relaxed))
        {
            return;
        }
        let place = self.lane.place.clone();
        self.room.publish(ScanEvent::Trouble { place, error }).await;
    }

    async fn finish(mut self) {
        self.open = None;
        {
            let mut tracker = self.room.tracker();
            tracker.summary.asked += self.asked;
            tracker.left(self.nth, [].iter());
            if self.failed && self.asked == 0 {
                tracker.summary.failed += 1
            } else {
                tracker.summary.places += 1
            }
        }
        let hint = self.noticed.hint(&self.lane.place);
        if let Some(hint) = hint.filter(|_| self.found == 0) {
            self.room.publish(ScanEvent::Hint(hint)).await;
        }
    }

    async fn probe(&mut self, one: &Try) -> ProbeAnswer {
        let wire = match self.wire(&one.endpoint).await {
            Ok(wire) => wire,
            Err(error) => return ProbeAnswer::Shut(error),
        };
        let late = LateReplies::default();
        let lent = Box::new(wire.clone());
        let mut bus = bus::on_wire(&one.endpoint, lent, late, self.room.clock);
        self.asked += 1;
        let begun = Instant::now();
        let read = bus.read(HAND_ID.span(), one.limit).await;
        let round_trip = begun.elapsed();
        let series = match &read {
            Ok(bytes) if is_expected_of(&one.endpoint, bytes) => {
                series(bus.as_mut(), one.limit).await
            }
            _ => DeviceSeries::Unknown,
        };
        let received = wire.take_received();
        let foreign = bus.counts().foreign_replies > 0;
        if received > 0 && !matches!(read, Err(BusError::Lost(_))) {
            // The next request must not collide with data that still arrives. A wire that breaks now fails the next
            // request too.
            let _broken = bus.quiet().await;
        }
        bus.close();
        match read {
            Ok(bytes) => match bytes.first() {
                Some(hand_id) if series == DeviceSeries::Other => {
                    ProbeAnswer::OtherSeries(*hand_id)
                }
                Some(hand_id) if is_expected(&one.endpoint, *hand_id) => ProbeAnswer::Hand {
                    hand_id: *hand_id,
                    round_trip,
                },
                Some(hand_id) => ProbeAnswer::OtherId(*hand_id),
                None => ProbeAnswer::Silence,
            },
            Err(BusError::Refused { reason }) => ProbeAnswer::Refused(reason),
            Err(BusError::Lost(error)) => {
                self.open = None;
                ProbeAnswer::Broke(error)
            }
            Err(_) => {
                self.notice(&one.endpoint, received, foreign);
                ProbeAnswer::Silence
            }
        }
    }

    /// The wire for an endpoint: the open one if it fits.
    async fn wire(&mut self, endpoint: &Endpoint) -> Result<LentWire, TransportError> {
        if let Some((at, wire)) = &self.open
            && same_wire(at, endpoint)
        {
            return Ok(wire.clone());
        }
        // The old one is closed first: a serial port can be opened once.
        self.open = None;
        let wire = LentWire::new(self.room.dial.dial(endpoint).await?);
        self.open = Some((endpoint.clone(), wire.clone()));
        Ok(wire)
    }

    /// Records bytes that were not a reply.
    fn notice(&mut self, endpoint: &Endpoint, received: usize, foreign: bool) {
        let (Endpoint::Rs485(line) | Endpoint::Rtu(line)) = endpoint else {
            return;
        };
        if foreign {
            self.noticed.foreign.get_or_insert_with(|| endpoint.clone());
        }
        if received > 0 {
            self.noticed.bytes += received;
            if !self.noticed.garbled.contains(&line.baud) {
                self.noticed.garbled.push(line.baud);
            }
        }
    }
}

/// Identifies the series, with as many reads as needed.
async fn series(bus: &mut dyn Bus, limit: Duration) -> DeviceSeries {
    let mut evidence = SeriesEvidence::default();
    for question in SeriesQuestion::ALL {
        if !evidence.needs(question) || bus.turn().await.is_err() {
            continue;
        }
        let Some(span) = bus.choose(question.shapes()) else {
            continue;
        };
        match bus.read(span, limit).await {
            Ok(bytes) => evidence.read(question, span, &bytes),
            Err(BusError::Refused { reason }) if reason.is_by_the_hand() => {
                evidence.refused(question);
            }
            // The serial framing cannot refuse.
            Err(_) => {
                let _broken = bus.quiet().await;
            }
        }
    }
    evidence.verdict()
}

fn is_expected_of(endpoint: &Endpoint, id: &[u8]) -> bool {
    id.first().is_some_and(|id| is_expected(endpoint, *id))
}

/// True if one open wire serves both. A CAN interface filters for one id only, and over TCP a late reply of one unit
/// could be mistaken for another's: there each has its own.
fn same_wire(one: &Endpoint, other: &Endpoint) -> bool {
    let is_direct = !one.is_can() && !other.is_can();
    let are_serial = one.port().is_some() && other.port().is_some();
    are_serial && one.baud() == other.baud() && (is_direct || one.kind() == other.kind())
}

/// A hand on a bus returns the id by which it was addressed; at a network address any valid id is accepted.
fn is_expected(endpoint: &Endpoint, hand_id: u8) -> bool {
    match endpoint.bus_id() {
        Some(id) => id == u16::from(hand_id),
        None => (1..=254).contains(&hand_id),
    }
}
