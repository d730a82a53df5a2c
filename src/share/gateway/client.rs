//! One client's connection: whole requests in, one answer each, and an end at a deadline for whoever keeps neither to the
//! protocol nor to the time. Reads are answered as they are ready, writes one at a time in their order. Some clients take a few
//! unanswered requests for a dead hand, so one request that waits for the hand does not hold up the others.

use crate::codec::mbap::{ADU_LEN_MAX, Adu, MbapSplitter};
use crate::codec::pdu::{self, ModbusRole, Pdu};
use crate::hand::ModbusException;
use crate::share::gateway::board::{Board, ClientId};
use crate::share::gateway::service::Service;
use futures::future::{BoxFuture, FutureExt as _, OptionFuture};
use futures::stream::{FuturesUnordered, StreamExt as _};
use std::collections::VecDeque;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::sync::Notify;
use tokio::time::{Instant, timeout, timeout_at};

/// From the first byte of a request to its last: on a network they come together.
pub const REQUEST_TIMEOUT: Duration = Duration::from_secs(2);
/// A client that asks nothing for so long is taken for gone: a half-open connection says nothing of itself.
pub const IDLE_MAX: Duration = Duration::from_secs(60);
/// A client that does not take its answer within this is ended.
pub const WRITE_TIMEOUT: Duration = Duration::from_secs(2);

/// So many reads of one client wait for the hand at a time, and so many writes behind the one under way: as many as the standard
/// lets a client have unanswered. Reads beyond them are told that the hand is busy; a client with more writes is ended, and the
/// hand stops where it moved it: a queue of targets would go on long after whoever wrote them.
const WAITING_MAX: usize = 16;

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

    async fn talk(&self, stream: TcpStream) -> io::Result<()> {
        let mut writing = None;
        let ended = self.converse(stream, &mut writing).await;
        // A write that has begun is not broken off: it may be taking the right to move the hand.
        OptionFuture::from(writing).await;
        ended
    }

    /// Answers, and leaves the write that had begun at the end.
    async fn converse<'a>(
        &'a self,
        mut stream: TcpStream,
        writing: &mut Option<BoxFuture<'a, Option<Vec<u8>>>>,
    ) -> io::Result<()> {
        let mut splitter = MbapSplitter::default();
        let mut chunk = [0; ADU_LEN_MAX];
        let mut heard = Instant::now();
        let mut begun = None;
        let mut reads = FuturesUnordered::new();
        // Writes go in their order, one at a time, and past the reads.
        let mut writes = VecDeque::new();
        loop {
            while let Some(asked) = splitter.next().map_err(io::Error::other)? {
                (heard, begun) = (Instant::now(), None);
                if !is_read(&asked) {
                    writes.push_back(asked);
                } else if reads.len() < WAITING_MAX {
                    reads.push(self.answer(asked));
                } else {
                    let busy = pdu::exception_reply(ModbusException::Busy, asked.function());
                    tell(&mut stream, &asked.reply(asked.unit, &busy)).await?;
                }
            }
            if writing.is_none() {
                let next = writes.pop_front();
                *writing = next.map(|asked| self.answer(asked).map(Some).boxed());
            }
            if writes.len() > WAITING_MAX {
                return Ok(());
            }
            if splitter.buffered() > 0 {
                begun.get_or_insert_with(Instant::now);
            }
            let deadline = begun.map_or(heard + IDLE_MAX, |begun| begun + REQUEST_TIMEOUT);
            tokio::select! {
                biased;
                // It takes the turn of a write, which may take the right as well.
                () = self.granted.notified(), if writing.is_none() => {
                    let granted = self.service.leases.granted(self.id);
                    *writing = Some(granted.map(|()| None).boxed());
                }
                Some(answer) = OptionFuture::from(writing.as_mut()) => {
                    *writing = None;
                    heard = Instant::now();
                    if let Some(answer) = answer {
                        tell(&mut stream, &answer).await?;
                    }
                }
                Some(answer) = reads.next() => {
                    heard = Instant::now();
                    tell(&mut stream, &answer).await?;
                }
                read = timeout_at(deadline, stream.read(&mut chunk)) => match read {
                    // There is room: what is kept is less than one message.
                    Ok(Ok(len @ 1..)) => {
                        splitter.push(chunk.get(..len).unwrap_or_default());
                    }
                    Ok(Ok(0)) => break,
                    _ => return Ok(()),
                },
            }
        }
        // It asks no more, but may listen on. What it moved is stopped first.
        self.service.leases.disconnect(self.id);
        if let Some(Some(answer)) = OptionFuture::from(writing.take()).await {
            tell(&mut stream, &answer).await?;
        }
        while let Some(answer) = reads.next().await {
            tell(&mut stream, &answer).await?;
        }
        Ok(())
    }

    async fn answer(&self, asked: Adu) -> Vec<u8> {
        self.service.answer(self.id, &asked).await
    }
}

async fn tell(stream: &mut TcpStream, answer: &[u8]) -> io::Result<()> {
    timeout(WRITE_TIMEOUT, stream.write_all(answer)).await?
}

/// Whatever else is asked takes its turn among the writes.
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
