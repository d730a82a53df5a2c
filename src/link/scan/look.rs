//! Looks at one place: opens it, asks one id after another for its HAND_ID, and closes it. Reads that one register and
//! writes nothing.

use crate::hand::Refusal;
use crate::hand::register::HAND_ID;
use crate::link::bus::late_replies::LateReplies;
use crate::link::bus::{self, Bus, BusError};
use crate::link::clock::Clock;
use crate::link::scan::board::Board;
use crate::link::scan::event::{FoundHand, ScanEvent, ScanHint};
use crate::link::scan::heard::LentWire;
use crate::link::scan::plan::{Lane, LaneKind, Try, same_line};
use crate::link::series::{Series, SeriesEvidence, SeriesQuestion};
use crate::transport::{Dial, Endpoint, TransportError};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::time::Instant;

/// What all lanes of a scan share.
pub(crate) struct ScanContext {
    pub(crate) dial: Arc<dyn Dial>,
    pub(crate) clock: Clock,
    pub(crate) events: mpsc::Sender<ScanEvent>,
    pub(crate) wake: Arc<dyn Fn() + Send + Sync>,
    pub(crate) board: Arc<Mutex<Board>>,
    /// One address of a range was told of: that all others fail alike is not worth a thousand lines.
    pub(crate) range_told: AtomicBool,
}

impl ScanContext {
    pub(crate) async fn tell(&self, event: ScanEvent) {
        // Nobody listens any more when the scan is being ended.
        let _unheard = self.events.send(event).await;
        (self.wake)();
    }

    pub(crate) fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What came back.
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

/// What was noticed at a place where no hand answered.
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
    /// The most telling of it.
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

/// One place being looked at.
struct LaneScan {
    room: Arc<ScanContext>,
    nth: usize,
    lane: Lane,
    open: Option<(Endpoint, LentWire)>,
    noticed: Noticed,
    found: usize,
    asked: usize,
    failed: bool,
    /// The newest trouble, which is told once.
    told: Option<TransportError>,
}

/// Goes through all tries of a lane, or until what it learned makes the rest needless.
pub(crate) async fn look(room: Arc<ScanContext>, nth: usize, lane: Lane) {
    let mut look = LaneScan {
        room,
        nth,
        lane,
        open: None,
        noticed: Noticed::default(),
        found: 0,
        asked: 0,
        failed: false,
        told: None,
    };
    look.go().await;
    look.finish().await;
}

impl LaneScan {
    async fn go(&mut self) {
        let mut rest: VecDeque<Try> = std::mem::take(&mut self.lane.tries).into();
        while let Some(one) = rest.pop_front() {
            match self.ask(&one).await {
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
            self.room.board().left(self.nth, rest.iter());
            (self.room.wake)();
        }
    }

    async fn found(&mut self, one: &Try, hand_id: u8, round_trip: Duration) {
        self.found += 1;
        self.room.board().summary.found += 1;
        let found = FoundHand {
            endpoint: one.endpoint.clone(),
            hand_id,
            round_trip,
            usb: self.lane.usb.clone(),
        };
        self.room.tell(ScanEvent::Found(found)).await;
    }

    /// Leaves out what fails in the same way.
    fn after(&mut self, error: &TransportError, at: &Endpoint, rest: &mut VecDeque<Try>) {
        match error {
            TransportError::BitrateRefused { .. } => {
                rest.retain(|other| !same_line(at, &other.endpoint));
            }
            // A port may not have one of the speeds, and the others all the same.
            TransportError::Io { .. } if self.lane.kind == LaneKind::Port => {
                rest.retain(|other| !same_wire(at, &other.endpoint));
            }
            _ => rest.clear(),
        }
    }

    async fn trouble(&mut self, error: TransportError) {
        if self.told.as_ref() == Some(&error) {
            return;
        }
        self.told = Some(error.clone());
        // A host that does not take the call was looked at: nobody is there.
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
        self.room.tell(ScanEvent::Trouble { place, error }).await;
    }

    async fn finish(mut self) {
        self.open = None;
        {
            let mut board = self.room.board();
            board.summary.asked += self.asked;
            board.left(self.nth, [].iter());
            if self.failed && self.asked == 0 {
                board.summary.failed += 1
            } else {
                board.summary.places += 1
            }
        }
        let hint = self.noticed.hint(&self.lane.place);
        if let Some(hint) = hint.filter(|_| self.found == 0) {
            self.room.tell(ScanEvent::Hint(hint)).await;
        }
    }

    async fn ask(&mut self, one: &Try) -> ProbeAnswer {
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
            _ => Series::Unknown,
        };
        let heard = wire.take_heard();
        let foreign = bus.counts().foreign_replies > 0;
        if heard > 0 && !matches!(read, Err(BusError::Lost(_))) {
            // The next question must not be talked over what still comes. A wire that breaks now breaks then too.
            let _broken = bus.quiet().await;
        }
        bus.close();
        match read {
            Ok(bytes) => match bytes.first() {
                Some(hand_id) if series == Series::Other => ProbeAnswer::OtherSeries(*hand_id),
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
                self.notice(&one.endpoint, heard, foreign);
                ProbeAnswer::Silence
            }
        }
    }

    /// The wire for an endpoint: the open one if that serves.
    async fn wire(&mut self, endpoint: &Endpoint) -> Result<LentWire, TransportError> {
        if let Some((at, wire)) = &self.open
            && same_wire(at, endpoint)
        {
            return Ok(wire.clone());
        }
        // The old one goes first: a serial port has room for one.
        self.open = None;
        let wire = LentWire::new(self.room.dial.dial(endpoint).await?);
        self.open = Some((endpoint.clone(), wire.clone()));
        Ok(wire)
    }

    /// Bytes came, and none of them answered.
    fn notice(&mut self, endpoint: &Endpoint, heard: usize, foreign: bool) {
        let (Endpoint::Rs485(line) | Endpoint::Rtu(line)) = endpoint else {
            return;
        };
        if foreign {
            self.noticed.foreign.get_or_insert_with(|| endpoint.clone());
        }
        if heard > 0 {
            self.noticed.bytes += heard;
            if !self.noticed.garbled.contains(&line.baud) {
                self.noticed.garbled.push(line.baud);
            }
        }
    }
}

/// What answers, asked until that is clear or nothing more is to be asked.
async fn series(bus: &mut dyn Bus, limit: Duration) -> Series {
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
            // The serial framing has no word for no.
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

/// True if both are reached over one opening of a wire. A CAN interface listens for one id only, and over TCP a late
/// answer to one unit could be taken for another's: there each has its own.
fn same_wire(one: &Endpoint, other: &Endpoint) -> bool {
    match (one, other) {
        (Endpoint::Rs485(a) | Endpoint::Rtu(a), Endpoint::Rs485(b) | Endpoint::Rtu(b)) => {
            a.baud == b.baud
        }
        (Endpoint::Slcan { .. }, Endpoint::Slcan { .. }) => true,
        (Endpoint::UsbCan { baud: a, .. }, Endpoint::UsbCan { baud: b, .. }) => a == b,
        _ => false,
    }
}

/// A hand on a bus says the id by which it was asked; at a network address any id that a hand can have will do.
fn is_expected(endpoint: &Endpoint, hand_id: u8) -> bool {
    match endpoint {
        Endpoint::Rs485(line) | Endpoint::Rtu(line) | Endpoint::RtuTcp(line) => line.id == hand_id,
        Endpoint::Can { id, .. } | Endpoint::Slcan { id, .. } | Endpoint::UsbCan { id, .. } => {
            *id == u16::from(hand_id)
        }
        Endpoint::Sim { .. } | Endpoint::Tcp { .. } => (1..=254).contains(&hand_id),
    }
}
