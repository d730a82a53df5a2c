//! A Modbus TCP gateway in front of a simulated hand: it can answer with an exception in place of the hand, and takes its time.

use crate::setup::hand;
use crate::setup::link;
use handscope::sim::SharedHand;
use handscope::transport::{Dial, Endpoint, Wire, pair};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, AtomicUsize, Ordering};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWriteExt as _, split};
use tokio::net::TcpListener;
use tokio::sync::mpsc;
use tokio::time::{Duration, Instant, sleep_until};

/// What the gateway does.
pub(crate) struct Gateway {
    hand: SharedHand,
    /// The exception that every request gets; 0 for none.
    says: AtomicU8,
    /// Requests that are refused yet, if it says something.
    refuses: AtomicUsize,
    delay_ms: AtomicU64,
    asked: AtomicUsize,
    dialled: AtomicUsize,
}

impl Gateway {
    pub(crate) fn to(hand: SharedHand) -> Arc<Self> {
        Arc::new(Self {
            hand,
            says: AtomicU8::new(0),
            refuses: AtomicUsize::new(0),
            delay_ms: AtomicU64::new(0),
            asked: AtomicUsize::new(0),
            dialled: AtomicUsize::new(0),
        })
    }

    /// Every request is refused with this exception from now on; with 0 the hand answers.
    pub(crate) fn says(&self, exception: u8) {
        self.refuses.store(usize::MAX, Ordering::Relaxed);
        self.says.store(exception, Ordering::Relaxed);
    }

    /// So many requests are refused with this exception.
    pub(crate) fn says_to(&self, exception: u8, requests: usize) {
        self.says(exception);
        self.refuses.store(requests, Ordering::Relaxed);
    }

    /// Replies come so much later from now on.
    pub(crate) fn delays(&self, by: Duration) {
        let ms = u64::try_from(by.as_millis()).unwrap();
        self.delay_ms.store(ms, Ordering::Relaxed);
    }

    /// Requests that came so far.
    pub(crate) fn asked(&self) -> usize {
        self.asked.load(Ordering::Relaxed)
    }

    /// Connections that were made so far.
    pub(crate) fn dialled(&self) -> usize {
        self.dialled.load(Ordering::Relaxed)
    }

    /// Dials this gateway.
    pub(crate) fn dial(self: &Arc<Self>) -> Arc<dyn Dial> {
        let gateway = Arc::clone(self);
        link::behind(move |endpoint, far| {
            gateway.dialled.fetch_add(1, Ordering::Relaxed);
            tokio::spawn(Arc::clone(&gateway).serve(endpoint.clone(), far));
        })
    }

    /// Takes connections on a loopback port, which it gives, for as long as the runtime lives.
    pub(crate) async fn listen(self: &Arc<Self>) -> u16 {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        let gateway = Arc::clone(self);
        tokio::spawn(async move {
            let endpoint: Endpoint = "tcp:127.0.0.1".parse().unwrap();
            while let Ok((client, _)) = listener.accept().await {
                tokio::spawn(Arc::clone(&gateway).serve(endpoint.clone(), client));
            }
        });
        port
    }

    async fn serve(self: Arc<Self>, endpoint: Endpoint, client: impl Wire) {
        let (near, at_hand) = pair();
        let server = hand::serve(self.hand.clone(), &endpoint, at_hand);
        let (mut from_client, mut to_client) = split(client);
        let (mut from_hand, mut to_hand) = split(near);
        let (replies, mut waiting) = mpsc::unbounded_channel::<(Instant, Vec<u8>)>();
        let due = |gateway: &Self| {
            Instant::now() + Duration::from_millis(gateway.delay_ms.load(Ordering::Relaxed))
        };
        let requests = async {
            while let Some(request) = adu(&mut from_client).await {
                self.asked.fetch_add(1, Ordering::Relaxed);
                match self.exception() {
                    0 => to_hand.write_all(&request).await.unwrap(),
                    code => {
                        let [a, b, _, _, _, _, unit, function, ..] = request[..] else {
                            return;
                        };
                        let refusal = vec![a, b, 0, 0, 0, 3, unit, function | 0x80, code];
                        replies.send((due(&self), refusal)).unwrap();
                    }
                }
            }
        };
        let answers = async {
            while let Some(reply) = adu(&mut from_hand).await {
                replies.send((due(&self), reply)).unwrap();
            }
        };
        let out = async {
            while let Some((due, reply)) = waiting.recv().await {
                sleep_until(due).await;
                if to_client.write_all(&reply).await.is_err() {
                    return;
                }
            }
        };
        tokio::select! {
            () = requests => {}
            () = answers => {}
            () = out => {}
        }
        server.abort();
    }

    fn exception(&self) -> u8 {
        let fewer = |left: usize| left.checked_sub(1);
        let order = Ordering::Relaxed;
        match self.refuses.fetch_update(order, order, fewer) {
            Ok(_before) => self.says.load(order),
            Err(_none) => 0,
        }
    }
}

/// One frame of Modbus TCP; none at the end of the wire.
async fn adu(from: &mut (impl AsyncRead + Unpin)) -> Option<Vec<u8>> {
    let mut frame = vec![0; 6];
    from.read_exact(&mut frame).await.ok()?;
    let len = usize::from(u16::from_be_bytes([frame[4], frame[5]]));
    frame.resize(6 + len, 0);
    from.read_exact(&mut frame[6..]).await.ok()?;
    Some(frame)
}
