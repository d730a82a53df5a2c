//! Simulated hands as a Modbus RTU server (manual 2.4), through tokio-modbus. Opens no port of its own: it is given
//! a wire. Unix only, because that server takes nothing but a serial port, and one end of a pair of pseudo-terminals is
//! one.

use crate::sim::serve::hands::Hands;
use crate::sim::serve::modbus::Memory;
use crate::transport::Wire;
use futures::future::BoxFuture;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::time::sleep;
use tokio_modbus::server::Service;
use tokio_modbus::server::rtu::Server;
use tokio_modbus::{ExceptionCode, Response, SlaveRequest};
use tokio_serial::SerialStream;

/// Bytes taken at once: the longest frame.
const CHUNK: usize = 256;
/// Silence after which a request that is still unanswered is given up: far longer than any gap inside one.
const SILENCE: Duration = Duration::from_millis(50);

/// Answers on `wire` until the other side hangs up. Silent for other ids and bad frames.
///
/// The server skips noise byte by byte but ends after twenty, and waits without limit for the rest of a frame; both
/// are met by giving it a fresh line: at its end, and after a silence that no reply broke.
///
/// # Errors
/// The system has no pseudo-terminal to give.
pub async fn serve(hands: impl Into<Hands>, mut wire: impl Wire) -> io::Result<()> {
    let hands = hands.into();
    loop {
        let (theirs, ours) = SerialStream::pair()?;
        let units = hands.iter().cloned().map(Memory::new).map(Arc::new);
        let bus = Line(units.collect());
        tokio::select! {
            biased;
            // Noise ended the server; the next begins with an empty line.
            _ended = Server::new(theirs).serve_forever(bus) => {}
            between = carry(&mut wire, ours, hands.turnaround()) => match between {
                Carried::HungUp => return Ok(()),
                Carried::Unanswered => {}
            }
        }
    }
}

/// Why bytes are not carried any more.
enum Carried {
    HungUp,
    Unanswered,
}

/// Carries bytes between the wire and the server's line.
async fn carry(wire: &mut impl Wire, mut server: SerialStream, turnaround: Duration) -> Carried {
    let (mut asked, mut answered) = ([0; CHUNK], [0; CHUNK]);
    let mut unanswered = false;
    loop {
        let done = tokio::select! {
            biased;
            read = server.read(&mut answered) => {
                unanswered = false;
                let len = read.unwrap_or_default();
                wire.write_all(answered.get(..len).unwrap_or_default()).await
            }
            read = wire.read(&mut asked) => {
                unanswered = true;
                match read {
                    Ok(len @ 1..) => server.write_all(asked.get(..len).unwrap_or_default()).await,
                    Ok(0) | Err(_) => return Carried::HungUp,
                }
            }
            () = sleep(SILENCE + turnaround), if unanswered => return Carried::Unanswered,
        };
        if done.is_err() {
            return Carried::HungUp;
        }
    }
}

/// The hands on the bus.
struct Line(Vec<Arc<Memory>>);

impl Service for Line {
    type Request = SlaveRequest<'static>;
    type Response = Option<Response>;
    type Exception = ExceptionCode;
    type Future = BoxFuture<'static, Result<Option<Response>, ExceptionCode>>;

    fn call(&self, asked: Self::Request) -> Self::Future {
        let mut units = self.0.iter();
        let meant = units.find(|unit| unit.hand().with(|hand, _| hand.id()) == asked.slave);
        let meant = meant.map(Arc::clone);
        Box::pin(async move {
            let Some(memory) = meant else { return Ok(None) };
            let turnaround = memory.hand().with(|hand, _| hand.personality().turnaround);
            let answer = memory.answer(&asked.request);
            if !turnaround.is_zero() {
                sleep(turnaround).await;
            }
            answer.map(Some)
        })
    }
}
