//! One client's connection: whole requests in, one answer each, and an end at a deadline for whoever keeps neither to the
//! protocol nor to the time. It holds at most two messages in memory.

use crate::codec::mbap::{ADU_LEN_MAX, MbapSplitter};
use crate::share::gateway::board::{Board, ClientId};
use crate::share::gateway::service::Service;
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
        loop {
            while let Some(asked) = splitter.next().map_err(io::Error::other)? {
                let answer = self.service.answer(self.id, &asked).await;
                timeout(TAKES_WITHIN, stream.write_all(&answer)).await??;
                (heard, begun) = (Instant::now(), None);
            }
            if splitter.buffered() > 0 {
                begun.get_or_insert_with(Instant::now);
            }
            let deadline = begun.map_or(heard + IDLE_MAX, |begun| begun + REQUEST_WITHIN);
            let len = tokio::select! {
                biased;
                () = self.granted.notified() => {
                    self.service.leases.granted(self.id).await;
                    continue;
                }
                read = timeout_at(deadline, stream.read(&mut chunk)) => read??,
            };
            if len == 0 {
                return Ok(());
            }
            // There is room: what is kept is less than one message.
            splitter.push(chunk.get(..len).unwrap_or_default());
        }
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.service.leases.disconnect(self.id);
    }
}
