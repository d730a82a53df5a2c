//! One request and its reply, over whichever protocol the endpoint speaks. No plan, no retry.

use crate::codec::modbus::BytePacking;
use crate::codec::rs485::SaveResult;
use crate::hand::{RegisterWrite, Span};
use crate::link::can::Can;
use crate::link::clock::Clock;
use crate::link::cost::WireCost;
use crate::link::late::LateReplies;
use crate::link::modbus_rtu::ModbusRtu;
use crate::link::modbus_tcp::ModbusTcp;
use crate::link::rs485::Rs485;
use crate::link::save_watch::ResultFrame;
use crate::transport::{BoxedWire, Endpoint, TransportError};
use arrayvec::ArrayVec;
use std::time::Duration;

/// Most bytes that one read can carry over any protocol.
pub(crate) const READ_MAX: usize = 252;

/// The memory bytes of one reply.
pub(crate) type Bytes = ArrayVec<u8, READ_MAX>;

/// Why a request has no good end. Only `Lost` ends the session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum BusError {
    /// No reply in time.
    Timeout { after: Duration },
    /// The hand said no.
    Refused { reason: String },
    /// A reply of another length than was asked for.
    WrongLength { got: usize, want: usize },
    /// This protocol cannot carry so much.
    TooLong,
    /// Every way to ask could be answered by a late reply.
    Ambiguous,
    /// The wire is gone.
    Lost(TransportError),
}

/// What a bus counted since it was opened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct BusCounts {
    pub(crate) checksum_errors: u64,
    pub(crate) resyncs: u64,
    pub(crate) foreign_replies: u64,
    pub(crate) foreign_requests: u64,
}

impl BusCounts {
    pub(crate) const fn plus(self, more: Self) -> Self {
        Self {
            checksum_errors: self.checksum_errors + more.checksum_errors,
            resyncs: self.resyncs + more.resyncs,
            foreign_replies: self.foreign_replies + more.foreign_replies,
            foreign_requests: self.foreign_requests + more.foreign_requests,
        }
    }
}

/// The protocols this version speaks.
pub(crate) enum Bus {
    Rs485(Box<Rs485>),
    ModbusTcp(Box<ModbusTcp>),
    ModbusRtu(Box<ModbusRtu>),
    Can(Box<Can>),
}

impl Bus {
    /// Puts the endpoint's protocol on an open wire. `late` is what earlier wires to this hand left unanswered.
    pub(crate) fn new(
        endpoint: &Endpoint,
        wire: BoxedWire,
        late: LateReplies,
        clock: Clock,
    ) -> Result<Self, TransportError> {
        match endpoint {
            Endpoint::Sim { .. } | Endpoint::Rs485(_) => {
                let bus = Rs485::new(wire, endpoint, late, clock);
                Ok(Self::Rs485(Box::new(bus)))
            }
            Endpoint::Tcp { unit, .. } => Ok(Self::ModbusTcp(Box::new(ModbusTcp::new(
                wire, *unit, endpoint,
            )))),
            Endpoint::Rtu(line) => {
                let bus = ModbusRtu::new(wire, line.baud, endpoint, late, clock);
                Ok(Self::ModbusRtu(Box::new(bus)))
            }
            Endpoint::Can { .. } | Endpoint::Slcan { .. } => {
                let bus = Can::new(wire, endpoint, late, clock);
                Ok(Self::Can(Box::new(bus)))
            }
        }
    }

    /// Six words or more as Modbus gives them; none where the protocol has no words.
    pub(crate) async fn words(
        &mut self,
        address: u16,
        limit: Duration,
    ) -> Result<Option<Vec<u16>>, BusError> {
        let least = BytePacking::OnePerWord.words_per_group();
        match self {
            Self::ModbusTcp(bus) => bus.words(address, least, limit).await.map(Some),
            Self::ModbusRtu(bus) => bus.words(address, limit).await.map(Some),
            Self::Rs485(_) | Self::Can(_) => Ok(None),
        }
    }

    /// True where single bytes travel in words.
    pub(crate) const fn has_words(&self) -> bool {
        matches!(self, Self::ModbusTcp(_) | Self::ModbusRtu(_))
    }

    /// From now on single bytes are read and written as this hand was found to keep them.
    pub(crate) const fn set_packing(&mut self, found: Option<BytePacking>) {
        match self {
            Self::ModbusTcp(bus) => bus.word_use.found = found,
            Self::ModbusRtu(bus) => bus.word_use.found = found,
            Self::Rs485(_) | Self::Can(_) => {}
        }
    }

    /// The first of these spans, in their order, whose reply cannot be mistaken for a late one.
    pub(crate) fn first_clear(&mut self, shapes: &[Span]) -> Option<Span> {
        match self {
            Self::ModbusTcp(_) => shapes.first().copied(),
            Self::Rs485(_) | Self::ModbusRtu(_) | Self::Can(_) => self.choose(shapes),
        }
    }

    /// Reads a span of memory.
    pub(crate) async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        match self {
            Self::Rs485(bus) => bus.read(span, limit).await,
            Self::ModbusRtu(bus) => bus.read(span, limit).await,
            Self::ModbusTcp(bus) => bus.read(span, limit).await,
            Self::Can(bus) => bus.read(span, limit).await,
        }
    }

    /// Reads a span of memory, unless something more urgent comes up between two of its pieces, where it has some.
    /// None if it did: what was read until then is forgotten.
    pub(crate) async fn read_unless(
        &mut self,
        span: Span,
        limit: Duration,
        urgent: impl Fn() -> bool,
    ) -> Result<Option<Bytes>, BusError> {
        match self {
            Self::Can(bus) => bus.read_unless(span, limit, urgent).await,
            whole => whole.read(span, limit).await.map(Some),
        }
    }

    /// Writes, and waits for the acknowledgement.
    pub(crate) async fn write(
        &mut self,
        write: &RegisterWrite,
        limit: Duration,
    ) -> Result<(), BusError> {
        match self {
            Self::Rs485(bus) => bus.write(write, limit).await,
            Self::ModbusRtu(bus) => bus.write(write, limit).await,
            Self::ModbusTcp(bus) => bus.write(write, limit).await,
            Self::Can(bus) => bus.write_unless(write, limit, || false).await,
        }
    }

    /// Writes, unless something urgent comes up between two pieces: for what a stop overrides anyway.
    pub(crate) async fn write_unless(
        &mut self,
        write: &RegisterWrite,
        limit: Duration,
        urgent: impl Fn() -> bool,
    ) -> Result<(), BusError> {
        match self {
            Self::Can(bus) => bus.write_unless(write, limit, urgent).await,
            whole => whole.write(write, limit).await,
        }
    }

    /// Waits until the protocol lets the next request go out. To be called before the wishes of the window are looked
    /// at, so that a stop does not wait behind a request that is not on the wire yet.
    pub(crate) async fn turn(&mut self) -> Result<(), BusError> {
        match self {
            Self::ModbusRtu(bus) => bus.turn().await,
            Self::Rs485(_) | Self::ModbusTcp(_) | Self::Can(_) => Ok(()),
        }
    }

    /// After a reply that did not come: listens until the line is quiet, so that nothing is talked over.
    pub(crate) async fn settle(&mut self) -> Result<(), BusError> {
        match self {
            Self::Rs485(bus) => bus.settle().await,
            Self::ModbusRtu(bus) => bus.settle().await,
            Self::ModbusTcp(_) => Ok(()),
            Self::Can(bus) => bus.settle().await,
        }
    }

    /// Whether a SAVE is followed by a frame with its result here.
    pub(crate) const fn save_result_frame(&self) -> ResultFrame {
        match self {
            Self::Rs485(_) => ResultFrame::Comes,
            Self::ModbusTcp(_) | Self::ModbusRtu(_) | Self::Can(_) => ResultFrame::None,
        }
    }

    /// A frame with the result of a SAVE that came, the oldest first.
    pub(crate) fn take_save_result(&mut self) -> Option<SaveResult> {
        match self {
            Self::Rs485(bus) => bus.take_save_result(),
            Self::ModbusTcp(_) | Self::ModbusRtu(_) | Self::Can(_) => None,
        }
    }

    /// True if the frame came that ends a calibration; once.
    pub(crate) fn take_calibration_end(&mut self) -> bool {
        match self {
            Self::Rs485(bus) => bus.take_calibration_end(),
            Self::ModbusTcp(_) | Self::ModbusRtu(_) | Self::Can(_) => false,
        }
    }

    /// Asks nothing and takes what comes, until the result of a SAVE is there; never ends where there is none.
    pub(crate) async fn listen(&mut self) -> Result<(), BusError> {
        match self {
            Self::Rs485(bus) => bus.listen().await,
            Self::ModbusTcp(_) | Self::ModbusRtu(_) | Self::Can(_) => std::future::pending().await,
        }
    }

    /// The first of these spans whose reply cannot be mistaken for a late one; none if all could.
    pub(crate) fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        match self {
            Self::Rs485(bus) => bus.choose(shapes),
            Self::ModbusRtu(bus) => bus.choose(shapes),
            // Transaction ids tell replies apart, so the first serves always.
            Self::ModbusTcp(_) => shapes.first().copied(),
            Self::Can(bus) => bus.choose(shapes),
        }
    }

    /// What reads cost on this wire.
    pub(crate) fn cost(&self) -> WireCost {
        match self {
            Self::Rs485(bus) => bus.cost(),
            Self::ModbusRtu(bus) => bus.cost(),
            Self::ModbusTcp(_) => WireCost::tcp(),
            Self::Can(bus) => bus.cost(),
        }
    }

    /// Time that the reply to a read of so many bytes takes on the wire, with its request.
    pub(crate) fn wire_time(&self, bytes: u16) -> Duration {
        match self {
            Self::Rs485(bus) => bus.wire_time(bytes),
            Self::ModbusRtu(bus) => bus.wire_time(bytes),
            Self::ModbusTcp(_) => Duration::ZERO,
            Self::Can(bus) => bus.wire_time(bytes),
        }
    }

    pub(crate) fn counts(&self) -> BusCounts {
        match self {
            Self::Rs485(bus) => bus.counts(),
            Self::ModbusRtu(bus) => bus.counts(),
            Self::ModbusTcp(bus) => bus.counts(),
            Self::Can(bus) => bus.counts(),
        }
    }

    /// True if the adapter was found to give back what is sent.
    pub(crate) fn echoes(&self) -> bool {
        match self {
            Self::Rs485(bus) => bus.echoes(),
            Self::ModbusRtu(bus) => bus.echoes(),
            Self::ModbusTcp(_) => false,
            Self::Can(bus) => bus.echoes(),
        }
    }

    /// Closes the wire; what is still unanswered goes to the next one.
    pub(crate) fn close(self) -> LateReplies {
        match self {
            Self::Rs485(bus) => bus.close(),
            Self::ModbusRtu(bus) => bus.close(),
            Self::ModbusTcp(_) => LateReplies::default(),
            Self::Can(bus) => bus.close(),
        }
    }
}

/// The id or unit that an endpoint asks for, for messages.
pub(crate) fn id_of(endpoint: &Endpoint) -> u16 {
    match endpoint {
        Endpoint::Sim { .. } => 1,
        Endpoint::Rs485(line) | Endpoint::Rtu(line) => u16::from(line.id),
        Endpoint::Tcp { unit, .. } => u16::from(*unit),
        Endpoint::Can { id, .. } | Endpoint::Slcan { id, .. } => *id,
    }
}
