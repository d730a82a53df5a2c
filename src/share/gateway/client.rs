//! One client's connection: whole requests in, one answer each, and an end at a deadline for whoever keeps neither to the
//! protocol nor to the time. What waits for the hand keeps no other read waiting: requests have numbers, and a client that takes
//! a few of them without an answer for a silent hand would give up one that is only busy.

use crate::codec::mbap::{ADU_LEN_MAX, Adu, MbapSplitter};
use crate::codec::pdu::{self, ModbusRole, Pdu};
use crate::share::gateway::board::{Board, ClientId};
use crate::share::gateway::service::Service;
use futures::StreamExt as _;
use futures::stream::FuturesUnordered;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::sync::Notify;
use tokio::time::{Instant, timeout, timeout_at};

/// From the first byte of a request to its last: on a network they come together.
pub const REQUEST_WITHIN: Duration = Duration::from_secs(2);
/// A client that asks nothing for so long is taken for gone: a half-open connection says nothing of itself.
pub const IDLE_MAX: Duration = Duration::from_secs(60);
/// A client that does not take its answer within this is ended.
pub const TAKES_WITHIN: Duration = Duration::from_secs(2);

/// So many requests of one client wait for the hand at a time; what it asks beyond them stays on the wire.
const WAITING_MAX: usize = 8;

/// A client while it is connected: it is gone when this is dropped, however its connection ends.
pub(crate) struct Connection {
    service: Service,
    id: ClientId,
    granted: Arc<Notify>,
}

impl Connection {
    pub(crate) fn new(service: Service, id: ClientId) -> Self {
        let row = |board: &mut Board| board.row(id).map(|row| Arc::clone(&row.granted));
        Self {
            granted: service.leases.board.with(row).unwrap_or_default(),
            service,
            id,
        }
    }

    /// Answers until the client hangs up, talks nonsense or misses a deadline.
    pub(crate) async fn serve(self, stream: TcpStream) {
        // A client's broken connection ends with that client; the others go on.
        let _broken = self.talk(stream).await;
    }

    async fn talk(&self, mut stream: TcpStream) -> io::Result<()> {
        let mut splitter = MbapSplitter::default();
        let mut chunk = [0; ADU_LEN_MAX];
        let mut heard = Instant::now();
        let mut begun = None;
        let mut answers = FuturesUnordered::new();
        // Writes go in their order, one at a time.
        let (mut next, mut is_writing) = (None, false);
        loop {
            while answers.len() < WAITING_MAX {
                if next.is_none() {
                    next = splitter.next().map_err(io::Error::other)?;
                    if next.is_none() {
                        break;
                    }
                    (heard, begun) = (Instant::now(), None);
                }
                let Some(asked) = next.take_if(|asked| !is_writing || is_read(asked)) else {
                    break;
                };
                let writes = !is_read(&asked);
                is_writing |= writes;
                answers.push(async move { (writes, self.service.answer(self.id, &asked).await) });
            }
            let has_room = next.is_none() && answers.len() < WAITING_MAX;
            if has_room && splitter.buffered() > 0 {
                begun.get_or_insert_with(Instant::now);
            }
            let deadline = begun.map_or(heard + IDLE_MAX, |begun| begun + REQUEST_WITHIN);
            let read = tokio::select! {
                biased;
                () = self.granted.notified() => {
                    self.service.leases.granted(self.id).await;
                    continue;
                }
                Some((wrote, answer)) = answers.next() => {
                    timeout(TAKES_WITHIN, stream.write_all(&answer)).await??;
                    is_writing &= !wrote;
                    heard = Instant::now();
                    continue;
                }
                read = timeout_at(deadline, stream.read(&mut chunk)), if has_room => read,
            };
            let Ok(Ok(len @ 1..)) = read else {
                // A write that has begun is not broken off: it may be taking the right to move the hand.
                while is_writing && let Some((wrote, _gone)) = answers.next().await {
                    is_writing &= !wrote;
                }
                return Ok(());
            };
            // There is room: what is kept is less than one message.
            splitter.push(chunk.get(..len).unwrap_or_default());
        }
    }
}

fn is_read(asked: &Adu) -> bool {
    matches!(
        pdu::parse(ModbusRole::Client, asked.pdu()),
        Pdu::Read { .. }
    )
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.service.leases.disconnect(self.id);
    }
}
