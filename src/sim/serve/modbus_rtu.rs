//! The simulated hand as a Modbus RTU server (manual 2.4), through tokio-modbus. Opens no port of its own: it is given
//! a wire. Unix only, because that server takes nothing but a serial port, and one end of a pair of pseudo-terminals is
//! one.

use crate::sim::serve::modbus::Memory;
use crate::sim::serve::shared::SharedHand;
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
pub async fn serve(hand: SharedHand, mut wire: impl Wire) -> io::Result<()> {
    loop {
        let (theirs, ours) = SerialStream::pair()?;
        let unit = Unit(Arc::new(Memory::new(hand.clone())));
        tokio::select! {
            biased;
            // Noise ended the server; the next begins with an empty line.
            _ended = Server::new(theirs).serve_forever(unit) => {}
            between = carry(&mut wire, ours, turnaround(&hand)) => match between {
                Carried::HungUp => return Ok(()),
                Carried::Unanswered => {}
            }
        }
    }
}

fn turnaround(hand: &SharedHand) -> Duration {
    hand.with(|hand, _| hand.personality().turnaround)
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

/// One hand on the bus.
struct Unit(Arc<Memory>);

impl Service for Unit {
    type Request = SlaveRequest<'static>;
    type Response = Option<Response>;
    type Exception = ExceptionCode;
    type Future = BoxFuture<'static, Result<Option<Response>, ExceptionCode>>;

    fn call(&self, asked: Self::Request) -> Self::Future {
        let memory = Arc::clone(&self.0);
        Box::pin(async move {
            let (id, turnaround) = memory
                .hand()
                .with(|hand, _| (hand.id(), hand.personality().turnaround));
            if asked.slave != id {
                return Ok(None);
            }
            let answer = memory.answer(&asked.request);
            if !turnaround.is_zero() {
                sleep(turnaround).await;
            }
            answer.map(Some)
        })
    }
}
