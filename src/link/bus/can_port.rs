//! CAN frames over a wire: as text or packets through a serial adapter, or as Linux's frames. Sends no requests to a
//! hand by itself.

use crate::codec::NoiseCounts;
use crate::codec::can::{CanFrame, CanRecord, RECORD_LEN, from_record, to_record};
use crate::codec::slcan::{AnswerDecoder, SlcanAnswer, SlcanCommand, bitrate_code, encode_command};
use crate::codec::usbcan::{self, PacketContent, PacketDecoder};
use crate::link::bus::error::{BusError, lost};
use crate::transport::{BoxedWire, Endpoint, TransportError, WireFailure};
use arrayvec::ArrayVec;
use futures::FutureExt as _;
use std::collections::VecDeque;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Instant, timeout, timeout_at};

/// Maximum bytes per read from the wire, which bounds the queued frames: a frame has at least 11 bytes.
const CHUNK: usize = 512;
/// Wait for an adapter's reply, behind a USB latency of 16 ms; some never reply, and work all the same.
const ANSWER_WAIT: Duration = Duration::from_millis(60);
/// Leftovers of an earlier session have arrived after this long without data …
const QUIET: Duration = Duration::from_millis(25);
/// … with this limit: an adapter that does not close shows all bus traffic.
const QUIET_MAX: Duration = Duration::from_millis(150);

/// Encoding of frames on the wire.
enum CanEncoding {
    /// Lawicel's text.
    Text {
        bitrate: u32,
        decoder: AnswerDecoder,
    },
    /// The packets of the maker's adapter.
    Packets(PacketDecoder),
    /// Linux's `struct can_frame`, one after the other.
    Records(ArrayVec<u8, RECORD_LEN>),
}

/// One end of a CAN bus.
pub(crate) struct CanPort {
    wire: BoxedWire,
    place: String,
    form: CanEncoding,
    inbox: VecDeque<CanFrame>,
    /// Replies of the adapter since its last command.
    done: bool,
    failed: bool,
    passive: bool,
}

impl CanPort {
    pub(crate) fn new(wire: BoxedWire, endpoint: &Endpoint) -> Self {
        let (form, place) = match endpoint {
            Endpoint::Slcan { port, bitrate, .. } => (
                CanEncoding::Text {
                    bitrate: *bitrate,
                    decoder: AnswerDecoder::default(),
                },
                port.clone(),
            ),
            Endpoint::UsbCan { port, .. } => {
                (CanEncoding::Packets(PacketDecoder::default()), port.clone())
            }
            Endpoint::Can { interface, .. } => {
                (CanEncoding::Records(ArrayVec::new()), interface.clone())
            }
            other => (CanEncoding::Records(ArrayVec::new()), other.to_string()),
        };
        Self {
            wire,
            place,
            form,
            inbox: VecDeque::new(),
            done: false,
            failed: false,
            passive: false,
        }
    }

    /// True if sent frames never come back: Linux ensures it. Adapters may echo.
    pub(crate) const fn never_echoes(&self) -> bool {
        matches!(self.form, CanEncoding::Records(_))
    }

    /// Opens the bus. An adapter that never replies is assumed to have obeyed.
    pub(crate) async fn open(&mut self) -> Result<(), BusError> {
        let CanEncoding::Text { bitrate, .. } = self.form else {
            return Ok(());
        };
        let refused = BusError::Lost(TransportError::BitrateRefused {
            place: self.place.clone(),
            bitrate,
        });
        let Some(code) = bitrate_code(bitrate) else {
            return Err(refused);
        };
        // Ends an incomplete line of a previous program.
        self.put(b"\r").await?;
        // An adapter that is closed already reports a failure; either is fine.
        self.send_command(&SlcanCommand::Close).await?;
        self.drain().await?;
        if self.send_command(&SlcanCommand::Bitrate(code)).await? {
            return Err(refused);
        }
        if self.send_command(&SlcanCommand::Open).await? {
            return Err(BusError::Lost(TransportError::Io {
                place: self.place.clone(),
                failure: WireFailure::OffBus,
            }));
        }
        self.inbox.clear();
        Ok(())
    }

    /// Closes the bus, if the wire accepts the command at once.
    pub(crate) fn close(&mut self) {
        if matches!(self.form, CanEncoding::Text { .. })
            && let Some(line) = encode_command(&SlcanCommand::Close)
        {
            // A wire that does not accept it is lost.
            let _taken = self.put(&line).now_or_never();
        }
    }

    /// Sends a command to the adapter; true if it reported a failure.
    async fn send_command(&mut self, command: &SlcanCommand) -> Result<bool, BusError> {
        let Some(line) = encode_command(command) else {
            return Ok(false);
        };
        (self.done, self.failed) = (false, false);
        self.put(&line).await?;
        let until = Instant::now() + ANSWER_WAIT;
        while !self.done && !self.failed {
            match timeout_at(until, self.receive()).await {
                Ok(received) => received?,
                Err(_) => break,
            }
            self.inbox.clear();
        }
        Ok(std::mem::take(&mut self.failed))
    }

    async fn drain(&mut self) -> Result<(), BusError> {
        let until = Instant::now() + QUIET_MAX;
        while Instant::now() < until {
            match timeout(QUIET, self.receive()).await {
                Ok(received) => received?,
                Err(_) => break,
            }
            self.inbox.clear();
        }
        Ok(())
    }

    pub(crate) async fn send(&mut self, frame: &CanFrame) -> Result<(), BusError> {
        match self.form {
            CanEncoding::Text { .. } => match encode_command(&SlcanCommand::Send(frame.clone())) {
                Some(line) => self.put(&line).await,
                None => Ok(()),
            },
            CanEncoding::Packets(_) => self.put(&usbcan::encode(frame)).await,
            CanEncoding::Records(_) => self.put(&to_record(frame)).await,
        }
    }

    async fn put(&mut self, bytes: &[u8]) -> Result<(), BusError> {
        let written = self.wire.write_all(bytes).await;
        written.map_err(|error| lost(&self.place, &error))
    }

    /// The next received frame.
    pub(crate) fn next(&mut self) -> Option<CanFrame> {
        self.inbox.pop_front()
    }

    /// Waits for bytes and decodes frames. Safe to cancel: no bytes are lost.
    pub(crate) async fn receive(&mut self) -> Result<(), BusError> {
        let mut chunk = [0; CHUNK];
        let got = self.wire.read(&mut chunk).await;
        let got = got.map_err(|error| lost(&self.place, &error))?;
        if got == 0 {
            return Err(BusError::Lost(TransportError::HungUp {
                place: self.place.clone(),
            }));
        }
        for byte in chunk.iter().take(got) {
            self.push_byte(*byte)?;
        }
        Ok(())
    }

    fn push_byte(&mut self, byte: u8) -> Result<(), BusError> {
        match &mut self.form {
            CanEncoding::Text { decoder, .. } => match decoder.push(byte) {
                Some(SlcanAnswer::Done | SlcanAnswer::Sent) => self.done = true,
                Some(SlcanAnswer::Failed) => self.failed = true,
                Some(SlcanAnswer::Frame(frame)) => self.inbox.push_back(frame),
                Some(SlcanAnswer::Other(_)) | None => {}
            },
            CanEncoding::Packets(decoder) => {
                if let Some(PacketContent::Frame(frame)) = decoder.push(byte) {
                    self.inbox.push_back(frame);
                }
            }
            CanEncoding::Records(record) => {
                record.push(byte);
                if let Ok(whole) = record.clone().into_inner() {
                    record.clear();
                    return self.push_record(&whole);
                }
            }
        }
        Ok(())
    }

    fn push_record(&mut self, record: &[u8; RECORD_LEN]) -> Result<(), BusError> {
        match from_record(record) {
            CanRecord::Frame(frame) => self.inbox.push_back(frame),
            CanRecord::ErrorPassive => self.passive = true,
            CanRecord::ErrorActive => self.passive = false,
            CanRecord::Other => {}
            CanRecord::BusOff => {
                return Err(BusError::Lost(TransportError::BusOff {
                    place: self.place.clone(),
                }));
            }
        }
        Ok(())
    }

    /// The bus state that explains missing replies, if any.
    pub(crate) fn trouble(&self) -> Option<TransportError> {
        let place = self.place.clone();
        if self.passive {
            Some(TransportError::ErrorPassive { place })
        } else if self.failed {
            Some(TransportError::QueueFull { place })
        } else {
            None
        }
    }

    /// Forgets earlier failures of the adapter, after a reply came.
    pub(crate) fn forget_refusals(&mut self) {
        self.failed = false;
    }

    /// Data that was not a valid line or packet.
    pub(crate) fn noise(&self) -> NoiseCounts {
        match &self.form {
            CanEncoding::Text { decoder, .. } => decoder.counts(),
            CanEncoding::Packets(decoder) => decoder.counts(),
            CanEncoding::Records(_) => NoiseCounts::default(),
        }
    }
}
