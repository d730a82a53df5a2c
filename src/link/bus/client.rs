//! Interface between a session and a wire, for every protocol.

use crate::codec::rs485::SaveResult;
use crate::hand::register::BytePacking;
use crate::hand::{RegisterWrite, Span};
use crate::link::bus::error::{BusCounts, BusError, Bytes};
use crate::link::bus::late_replies::{LateReplies, LateReply};
use crate::link::poll::cost::WireCost;
use crate::link::series::PermittedWrite;
use async_trait::async_trait;
use std::time::Duration;

/// Indicates whether a SAVE is followed by a result frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ResultFrame {
    /// The maker's framing on RS485.
    Comes,
    /// Modbus and CAN.
    None,
}

/// Returns true if something more urgent is pending.
pub(crate) type Urgent<'a> = &'a (dyn Fn() -> bool + Send + Sync);

/// The client side of one wire. Features that a protocol lacks have a default.
#[async_trait]
pub(crate) trait Bus: Send {
    /// Reads a span of memory.
    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError>;

    /// Writes, and waits for the acknowledgement.
    async fn write(&mut self, write: PermittedWrite<'_>, limit: Duration) -> Result<(), BusError>;

    /// Checks that this wire can carry a write safely.
    ///
    /// # Errors
    /// The write could change a neighbouring register; nothing is sent.
    fn allows(&self, _write: &RegisterWrite) -> Result<(), BusError> {
        Ok(())
    }

    /// The first of these spans whose reply cannot be mistaken for a late one; `None` if there is none.
    fn choose(&mut self, shapes: &[Span]) -> Option<Span>;

    /// Cost of reads on this wire.
    fn cost(&self) -> WireCost;

    /// Counts since the wire was opened.
    fn counts(&self) -> BusCounts;

    /// Reads, unless something more urgent comes up between two pieces, or while a reply is late on a wire with
    /// numbers. `None` if interrupted: pieces read so far are discarded.
    async fn read_unless(
        &mut self,
        span: Span,
        limit: Duration,
        _urgent: Urgent<'_>,
    ) -> Result<Option<Bytes>, BusError> {
        self.read(span, limit).await.map(Some)
    }

    /// Writes, unless something urgent comes up between two pieces, or while the acknowledgement is late on a wire with
    /// numbers: for writes that a stop overrides anyway.
    async fn write_unless(
        &mut self,
        write: PermittedWrite<'_>,
        limit: Duration,
        _urgent: Urgent<'_>,
    ) -> Result<(), BusError> {
        self.write(write, limit).await
    }

    /// Waits until the protocol permits the next request. Called before control requests are checked, so that a stop
    /// does not wait behind a request that is not on the wire yet.
    async fn turn(&mut self) -> Result<(), BusError> {
        Ok(())
    }

    /// After a missing reply: listens until the line is quiet, to avoid a collision.
    async fn quiet(&mut self) -> Result<(), BusError> {
        Ok(())
    }

    /// Time on the wire of a read of this many bytes: request and reply.
    fn wire_time(&self, _bytes: u16) -> Duration {
        Duration::ZERO
    }

    /// True if the adapter echoes what is sent.
    fn echoes(&self) -> bool {
        false
    }

    /// Number of echoes of our own frames, with or without a reply.
    fn own_frames(&self) -> u64 {
        0
    }

    /// True if replies carry the number of their request, so that late ones can be identified.
    fn has_numbers(&self) -> bool {
        false
    }

    /// The slowest late reply since the last call.
    fn take_late(&mut self) -> Option<LateReply> {
        None
    }

    /// True if single bytes are packed into words.
    fn has_words(&self) -> bool {
        false
    }

    /// Six or more raw Modbus words; `None` if the protocol has no words.
    async fn words(
        &mut self,
        _address: u16,
        _limit: Duration,
    ) -> Result<Option<Vec<u16>>, BusError> {
        Ok(None)
    }

    /// Sets the detected packing, for reads and writes of single bytes.
    fn set_packing(&mut self, _found: Option<BytePacking>) {}

    /// Returns whether a SAVE is followed by a result frame on this wire.
    fn save_result_frame(&self) -> ResultFrame {
        ResultFrame::None
    }

    /// The oldest received result frame of a SAVE.
    fn take_save_result(&mut self) -> Option<SaveResult> {
        None
    }

    /// True, once, if the end frame of a calibration was received.
    fn take_calibration_end(&mut self) -> bool {
        false
    }

    /// Listens without sending a request, until the result of a SAVE or the end of a calibration was received; never
    /// returns if there is none. Safe to cancel.
    async fn listen(&mut self) -> Result<(), BusError> {
        std::future::pending().await
    }

    /// Closes the wire; returns the unanswered requests for the next one.
    fn close(self: Box<Self>) -> LateReplies {
        LateReplies::default()
    }
}
