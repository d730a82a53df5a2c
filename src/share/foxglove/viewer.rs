//! One viewer's connection: after the greeting it subscribes, and receives its subscriptions until it leaves, stops reading, falls
//! silent, or violates the protocol or its allowance.

use crate::record::file::format::encode::EncodedMessage;
use crate::record::file::format::topic::Topic;
use crate::share::foxglove::allowance::Allowance;
use crate::share::foxglove::outlet::Seat;
use crate::share::foxglove::protocol::{self, Greeting, SUBPROTOCOLS, Subscription, ViewerRequest};
use futures::{SinkExt as _, StreamExt as _};
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::sync::broadcast::Receiver;
use tokio::sync::broadcast::error::RecvError;
use tokio::time::{Instant, MissedTickBehavior, interval, timeout};
use tokio_tungstenite::tungstenite::Message as Frame;
use tokio_tungstenite::tungstenite::handshake::server;
use tokio_tungstenite::tungstenite::http::{HeaderValue, StatusCode, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_tungstenite::{WebSocketStream, accept_hdr_async_with_config};

/// Time from the connection to the end of the handshake.
pub const HANDSHAKE_TIMEOUT: Duration = Duration::from_secs(2);
/// Time within which a viewer must accept sent data; then it is disconnected.
pub const WRITE_TIMEOUT: Duration = Duration::from_secs(10);
/// Interval of pings: a viewer may have nothing to send for hours.
const PING_INTERVAL: Duration = Duration::from_secs(20);
/// Silence after which a viewer is disconnected: a half-open connection does not report itself.
pub const SILENT_MAX: Duration = Duration::from_secs(60);
/// Longest message of a viewer: it names topics, of which there are a dozen.
const SAID_MAX: usize = 16 * 1024;
/// Bytes buffered before they are written.
const GATHERED: usize = 16 * 1024;
/// Messages sent in one batch before the viewer's requests are read again.
const IN_ONE_GO: usize = 64;

type Socket = WebSocketStream<Allowance<TcpStream>>;

/// A connected viewer.
pub(crate) struct ViewerConnection {
    seat: Seat,
    greeting: Arc<Greeting>,
    subscriptions: Vec<Subscription>,
}

impl ViewerConnection {
    pub(crate) const fn new(seat: Seat, greeting: Arc<Greeting>) -> Self {
        Self {
            seat,
            greeting,
            subscriptions: Vec::new(),
        }
    }

    /// Serves until the viewer leaves or is disconnected.
    pub(crate) async fn serve(mut self, stream: TcpStream) {
        // A viewer's broken connection ends only that viewer.
        let _broken = self.show(stream).await;
    }

    async fn show(&mut self, stream: TcpStream) -> io::Result<()> {
        let mut socket = timeout(HANDSHAKE_TIMEOUT, shake_hands(stream)).await??;
        for text in &self.greeting.texts {
            send(&mut socket, Frame::text(text.as_str())).await?;
        }
        let mut messages = self.seat.messages();
        let mut ping = interval(PING_INTERVAL);
        ping.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut last_received = Instant::now();
        loop {
            tokio::select! {
                biased;
                received = socket.next() => {
                    let Some(received) = received else { return Ok(()) };
                    let answers = self.answers(&received.map_err(io::Error::other)?);
                    last_received = Instant::now();
                    for answer in answers {
                        send(&mut socket, answer).await?;
                    }
                }
                message = messages.recv() => {
                    timeout(WRITE_TIMEOUT, self.pass_on(&mut socket, message, &mut messages)).await??;
                }
                _ = ping.tick() => {
                    if last_received.elapsed() > SILENT_MAX {
                        return Err(io::ErrorKind::TimedOut.into());
                    }
                    send(&mut socket, Frame::Ping(Vec::new().into())).await?;
                }
            }
        }
    }

    /// Sends this message and those queued behind it.
    async fn pass_on(
        &self,
        socket: &mut Socket,
        first: Result<Arc<EncodedMessage>, RecvError>,
        waiting: &mut Receiver<Arc<EncodedMessage>>,
    ) -> io::Result<()> {
        let (mut next, mut left, mut sent) = (first, IN_ONE_GO, 0);
        loop {
            match next {
                Ok(message) => {
                    if let Some(number) = self.number(message.topic) {
                        let data = protocol::message_data(number, &message);
                        let frame = Frame::Binary(data.into());
                        socket.feed(frame).await.map_err(io::Error::other)?;
                        sent += 1;
                    }
                }
                Err(RecvError::Lagged(missed)) => {
                    self.seat.note(|viewer| viewer.missed += missed);
                }
                Err(RecvError::Closed) => break,
            }
            left -= 1;
            if left == 0 || waiting.is_empty() {
                break;
            }
            next = waiting.recv().await;
        }
        socket.flush().await.map_err(io::Error::other)?;
        self.seat.note(|viewer| viewer.sent += sent);
        Ok(())
    }

    fn number(&self, topic: Topic) -> Option<u32> {
        let channel = u64::from(topic.channel());
        let mut ours = self.subscriptions.iter();
        let ours = ours.find(|own| own.channel_id == channel)?;
        Some(ours.id)
    }

    /// Carries out a viewer's request and returns the replies.
    fn answers(&mut self, received: &Frame) -> Vec<Frame> {
        let answers = match received {
            Frame::Text(text) => match serde_json::from_str(text) {
                Ok(ViewerRequest::Subscribe { subscriptions }) => {
                    let replies = subscriptions
                        .into_iter()
                        .map(|wanted| self.subscribe(wanted));
                    replies.flatten().collect()
                }
                Ok(ViewerRequest::Unsubscribe { subscription_ids }) => {
                    self.subscriptions
                        .retain(|own| !subscription_ids.contains(&own.id));
                    Vec::new()
                }
                Ok(ViewerRequest::Other) => {
                    vec![warning("ignored: this server only publishes its topics")]
                }
                Err(unknown) => vec![error(&format!("not understood: {unknown}"))],
            },
            Frame::Binary(_) => vec![warning("ignored: this server accepts no messages")],
            // Control frames are answered by the crate.
            Frame::Ping(_) | Frame::Pong(_) | Frame::Close(_) | Frame::Frame(_) => Vec::new(),
        };
        let topics = self.subscriptions.len();
        self.seat.note(|viewer| viewer.topics = topics);
        answers
    }

    /// Adds a subscription, or returns the reason for refusing it; a subscription to what does not change returns that.
    fn subscribe(&mut self, wanted: Subscription) -> Option<Frame> {
        let Subscription { id, channel_id } = wanted;
        let Some(topic) = wanted.topic() else {
            return Some(error(&format!("there is no channel {channel_id}")));
        };
        let is_taken = |own: &Subscription| own.channel_id == channel_id || own.id == id;
        if self.subscriptions.iter().any(is_taken) {
            return Some(warning(&format!(
                "ignored: subscription {id} or channel {channel_id} is subscribed already"
            )));
        }
        self.subscriptions.push(wanted);
        let lasting = self.greeting.lasting(topic)?;
        Some(Frame::Binary(protocol::message_data(id, lasting).into()))
    }
}

fn warning(words: &str) -> Frame {
    Frame::text(protocol::warning(words))
}

fn error(words: &str) -> Frame {
    Frame::text(protocol::error(words))
}

async fn send(socket: &mut Socket, frame: Frame) -> io::Result<()> {
    let sent = timeout(WRITE_TIMEOUT, socket.send(frame)).await?;
    sent.map_err(io::Error::other)
}

async fn shake_hands(stream: TcpStream) -> io::Result<Socket> {
    let config = WebSocketConfig::default()
        .read_buffer_size(4096)
        .write_buffer_size(GATHERED)
        .max_message_size(Some(SAID_MAX))
        .max_frame_size(Some(SAID_MAX));
    let shaken = accept_hdr_async_with_config(Allowance::new(stream), Chooser, Some(config));
    shaken.await.map_err(io::Error::other)
}

/// Chooses the newest subprotocol that the viewer knows, and refuses viewers that know none.
struct Chooser;

impl server::Callback for Chooser {
    fn on_request(
        self,
        request: &server::Request,
        mut response: server::Response,
    ) -> Result<server::Response, server::ErrorResponse> {
        let offers = request.headers().get_all(header::SEC_WEBSOCKET_PROTOCOL);
        let offered = |name: &&str| {
            let texts = offers.iter().filter_map(|value| value.to_str().ok());
            texts
                .flat_map(|text| text.split(','))
                .any(|own| own.trim() == *name)
        };
        let Some(chosen) = SUBPROTOCOLS.into_iter().find(offered) else {
            let words = format!("ask for the subprotocol {}", SUBPROTOCOLS.join(" or "));
            let mut refusal = server::ErrorResponse::new(Some(words));
            *refusal.status_mut() = StatusCode::BAD_REQUEST;
            return Err(refusal);
        };
        let headers = response.headers_mut();
        headers.insert(
            header::SEC_WEBSOCKET_PROTOCOL,
            HeaderValue::from_static(chosen),
        );
        Ok(response)
    }
}
