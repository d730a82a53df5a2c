//! One client's connection: complete requests in, one answer each, and disconnection at a deadline for clients that violate the
//! protocol or are too slow. Reads are answered as they complete, writes one at a time in order. Some clients interpret a few
//! unanswered requests as a dead hand, so one request that waits for the hand does not block the others.

use crate::codec::mbap::{ADU_LEN_MAX, Adu, MbapSplitter};
use crate::codec::pdu::{self, ModbusRole, Pdu};
use crate::hand::ModbusException;
use crate::share::gateway::clients::{ClientId, ClientTable};
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

/// Time from the first byte of a request to its last: on a network they arrive together.
pub const REQUEST_TIMEOUT: Duration = Duration::from_secs(2);
/// Time without requests after which a client is disconnected: a half-open connection does not report itself.
pub const IDLE_MAX: Duration = Duration::from_secs(60);
/// Time within which a client must accept its answer; then it is disconnected.
pub const WRITE_TIMEOUT: Duration = Duration::from_secs(2);

/// Limit of one client's reads that wait for the hand, and of its writes queued behind the one in progress: as many as the
/// standard allows a client to have unanswered. Further reads get the busy exception; a client with more writes is disconnected, and
/// the hand stops if that client was moving it: a queue of targets would continue long after they were written.
const WAITING_MAX: usize = 16;

/// A connected client: dropping this disconnects it, however its connection ends.
pub(crate) struct ClientConnection {
    service: Service,
    id: ClientId,
    granted: Arc<Notify>,
}

impl ClientConnection {
    pub(crate) fn new(service: Service, id: ClientId) -> Self {
        let row = |table: &mut ClientTable| table.row(id).map(|row| Arc::clone(&row.granted));
        Self {
            granted: service.leases.table.with(row).unwrap_or_default(),
            service,
            id,
        }
    }

    /// Serves until the client hangs up, sends an invalid header or misses a deadline.
    pub(crate) async fn serve(self, stream: TcpStream) {
        // A client's broken connection ends only that client.
        let _broken = self.talk(stream).await;
    }

    async fn talk(&self, stream: TcpStream) -> io::Result<()> {
        let mut writing = None;
        let ended = self.converse(stream, &mut writing).await;
        // A write in progress is not aborted: it may be acquiring control.
        OptionFuture::from(writing).await;
        ended
    }

    /// Serves the connection, and leaves a write in progress at its end in `writing`.
    async fn converse<'a>(
        &'a self,
        mut stream: TcpStream,
        writing: &mut Option<BoxFuture<'a, Option<Vec<u8>>>>,
    ) -> io::Result<()> {
        let mut splitter = MbapSplitter::default();
        let mut chunk = [0; ADU_LEN_MAX];
        let mut last_received = Instant::now();
        let mut begun = None;
        let mut reads = FuturesUnordered::new();
        // Writes run in order, one at a time, independently of the reads.
        let mut writes = VecDeque::new();
        loop {
            while let Some(asked) = splitter.next().map_err(io::Error::other)? {
                (last_received, begun) = (Instant::now(), None);
                if !is_read(&asked) {
                    writes.push_back(asked);
                } else if reads.len() < WAITING_MAX {
                    reads.push(self.answer(asked));
                } else {
                    let busy = pdu::exception_reply(ModbusException::Busy, asked.function());
                    send(&mut stream, &asked.reply(asked.unit, &busy)).await?;
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
            let deadline = begun.map_or(last_received + IDLE_MAX, |begun| begun + REQUEST_TIMEOUT);
            tokio::select! {
                biased;
                // A grant is handled in place of a write, as a write may acquire control as well.
                () = self.granted.notified(), if writing.is_none() => {
                    let granted = self.service.leases.granted(self.id);
                    *writing = Some(granted.map(|()| None).boxed());
                }
                Some(answer) = OptionFuture::from(writing.as_mut()) => {
                    *writing = None;
                    last_received = Instant::now();
                    if let Some(answer) = answer {
                        send(&mut stream, &answer).await?;
                    }
                }
                Some(answer) = reads.next() => {
                    last_received = Instant::now();
                    send(&mut stream, &answer).await?;
                }
                read = timeout_at(deadline, stream.read(&mut chunk)) => match read {
                    // There is room: the buffered rest is less than one message.
                    Ok(Ok(len @ 1..)) => {
                        splitter.push(chunk.get(..len).unwrap_or_default());
                    }
                    Ok(Ok(0)) => break,
                    _ => return Ok(()),
                },
            }
        }
        // The client has finished sending, but may still read. Its motion is stopped first.
        self.service.leases.disconnect(self.id);
        if let Some(Some(answer)) = OptionFuture::from(writing.take()).await {
            send(&mut stream, &answer).await?;
        }
        while let Some(answer) = reads.next().await {
            send(&mut stream, &answer).await?;
        }
        Ok(())
    }

    async fn answer(&self, asked: Adu) -> Vec<u8> {
        self.service.answer(self.id, &asked).await
    }
}

async fn send(stream: &mut TcpStream, answer: &[u8]) -> io::Result<()> {
    timeout(WRITE_TIMEOUT, stream.write_all(answer)).await?
}

/// True for reads; all other requests are queued as writes.
fn is_read(asked: &Adu) -> bool {
    matches!(
        pdu::parse(ModbusRole::Client, asked.pdu()),
        Pdu::Read { .. }
    )
}

impl Drop for ClientConnection {
    fn drop(&mut self) {
        self.service.leases.disconnect(self.id);
    }
}
