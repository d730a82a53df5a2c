//! What a session asks of a wire, whichever protocol it speaks.

use crate::codec::rs485::SaveResult;
use crate::hand::register::BytePacking;
use crate::hand::{RegisterWrite, Span};
use crate::link::bus::error::{BusCounts, BusError, Bytes};
use crate::link::bus::late_replies::{LateReplies, LateReply};
use crate::link::poll::cost::WireCost;
use crate::link::series::PermittedWrite;
use async_trait::async_trait;
use std::time::Duration;

/// Whether this wire has a frame with the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ResultFrame {
    /// The maker's framing on RS485.
    Comes,
    /// Modbus and CAN.
    None,
}

/// Says whether something more urgent came up meanwhile.
pub(crate) type Urgent<'a> = &'a (dyn Fn() -> bool + Send + Sync);

/// The client side of one wire. What a protocol does not know has a default.
#[async_trait]
pub(crate) trait Bus: Send {
    /// Reads a span of memory.
    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError>;

    /// Writes, and waits for the acknowledgement.
    async fn write(&mut self, write: PermittedWrite<'_>, limit: Duration) -> Result<(), BusError>;

    /// Whether a write may be sent over this wire at all.
    ///
    /// # Errors
    /// It could change a neighbour: nothing is sent.
    fn allows(&self, _write: &RegisterWrite) -> Result<(), BusError> {
        Ok(())
    }

    /// The first of these spans whose reply cannot be mistaken for a late one; none if all could.
    fn choose(&mut self, shapes: &[Span]) -> Option<Span>;

    /// What reads cost on this wire.
    fn cost(&self) -> WireCost;

    /// What was counted since the wire was opened.
    fn counts(&self) -> BusCounts;

    /// Reads, unless something more urgent comes up between two of its pieces, or while a reply is late on a wire with
    /// numbers. `None` if it did: what was read until then is forgotten.
    async fn read_unless(
        &mut self,
        span: Span,
        limit: Duration,
        _urgent: Urgent<'_>,
    ) -> Result<Option<Bytes>, BusError> {
        self.read(span, limit).await.map(Some)
    }

    /// Writes, unless something urgent comes up between two pieces, or while the acknowledgement is late on a wire with
    /// numbers: for what a stop overrides anyway.
    async fn write_unless(
        &mut self,
        write: PermittedWrite<'_>,
        limit: Duration,
        _urgent: Urgent<'_>,
    ) -> Result<(), BusError> {
        self.write(write, limit).await
    }

    /// Waits until the protocol lets the next request go out. To be called before wishes are looked at, so that a stop
    /// does not wait behind a request that is not on the wire yet.
    async fn turn(&mut self) -> Result<(), BusError> {
        Ok(())
    }

    /// After a reply that did not come: listens until the line is quiet, so that nothing is talked over.
    async fn quiet(&mut self) -> Result<(), BusError> {
        Ok(())
    }

    /// Time that the reply to a read of so many bytes takes on the wire, with its request.
    fn wire_time(&self, _bytes: u16) -> Duration {
        Duration::ZERO
    }

    /// True if the adapter was found to give back what is sent.
    fn echoes(&self) -> bool {
        false
    }

    /// How often what was sent came back, whoever answered then.
    fn own_frames(&self) -> u64 {
        0
    }

    /// True where replies carry the number of their request, so that a late one is known as such.
    fn has_numbers(&self) -> bool {
        false
    }

    /// The slowest of the late replies that came since this was asked last.
    fn take_late(&mut self) -> Option<LateReply> {
        None
    }

    /// True where single bytes travel in words.
    fn has_words(&self) -> bool {
        false
    }

    /// Six words or more as Modbus gives them; none where the protocol has no words.
    async fn words(
        &mut self,
        _address: u16,
        _limit: Duration,
    ) -> Result<Option<Vec<u16>>, BusError> {
        Ok(None)
    }

    /// From now on single bytes are read and written as this hand was found to keep them.
    fn set_packing(&mut self, _found: Option<BytePacking>) {}

    /// Whether a SAVE is followed by a frame with its result here.
    fn save_result_frame(&self) -> ResultFrame {
        ResultFrame::None
    }

    /// A frame with the result of a SAVE that came, the oldest first.
    fn take_save_result(&mut self) -> Option<SaveResult> {
        None
    }

    /// True if the frame came that ends a calibration; once.
    fn take_calibration_end(&mut self) -> bool {
        false
    }

    /// Asks nothing and takes what comes, until the result of a SAVE or the end of a calibration is there; never ends where
    /// there is none. Safe to cancel.
    async fn listen(&mut self) -> Result<(), BusError> {
        std::future::pending().await
    }

    /// Closes the wire; what is still unanswered goes to the next one.
    fn close(self: Box<Self>) -> LateReplies {
        LateReplies::default()
    }
}
