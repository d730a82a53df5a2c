//! Listens for JSON lines over UDP or TCP and forwards their targets. Listens only while open.

use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::inputs::intake::{Intake, IntakeView};
use crate::inputs::line::{LINE_MAX, LineRefusal, StreamLine, begins_message};
use crate::inputs::lines::{LONGEST, LineCutter, LineEvent};
use crate::inputs::offer::{Offer, OfferLimits, OfferOutlet, SourceSite, is_fresh};
use crate::inputs::scan;
use crate::inputs::stop::{self, Completeness};
use crate::link::{ArmRequest, Owner};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::AsyncReadExt as _;
use tokio::net::{TcpListener, TcpStream, UdpSocket};
use tokio::sync::{mpsc, watch};
use tokio::task::JoinSet;
use tokio::time::{interval, timeout};
use tokio_util::task::AbortOnDropHandle;

/// Connections whose lines are followed.
const CONNECTIONS_MAX: usize = 8;
/// Further connections, which may only stop the hand: the first other line closes them. Connections beyond these are closed at once.
const STOPPERS_MAX: usize = 24;
/// Time without a complete line after which a connection is closed.
const LINE_TIMEOUT: Duration = Duration::from_secs(10);
/// Interval at which the statistics are published.
const REPORT_INTERVAL: Duration = Duration::from_millis(50);
/// Capacity of the queue of lines.
const LINES_MAX: usize = 64;
/// Longest datagram that the network carries: one that is too long for a line may still contain a stop.
const DATAGRAM_MAX: usize = 65_535;

/// Transport and address of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StreamPlace {
    /// One line per datagram.
    Udp(SocketAddr),
    /// Lines terminated by a line feed.
    Tcp(SocketAddr),
}

/// Current state of a stream.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StreamView {
    /// Statistics of the lines.
    pub intake: IntakeView,
    /// The newest target.
    pub newest: Option<Offer>,
    /// Targets without a follower, because the user has not granted control.
    pub not_granted: u64,
    /// Open TCP connections.
    pub connections: usize,
}

impl StreamView {
    /// Owner as which it would control the hand at `now`; `None` without a current sender.
    pub fn owner(&self, now: Moment) -> Option<Owner> {
        let (sender, last) = self.intake.sender?;
        is_fresh(last, now).then_some(Owner::Stream(sender))
    }

    /// True while lines arrive and each is refused.
    pub fn is_refusing(&self, now: Moment) -> bool {
        let last = self.intake.refused_at.filter(|last| is_fresh(*last, now));
        last.is_some() && self.owner(now).is_none()
    }
}

/// An open stream. Dropping it closes it.
#[derive(Debug)]
pub struct StreamSource {
    place: StreamPlace,
    view: watch::Receiver<StreamView>,
    outlet: OfferOutlet,
    _task: AbortOnDropHandle<()>,
}

impl StreamSource {
    /// Listens from now on. `allowed` has the highest force that a hold may request.
    ///
    /// # Errors
    /// The system's error if the address cannot be bound.
    pub fn open(
        place: StreamPlace,
        site: SourceSite,
        allowed: ArmRequest,
        runtime: &tokio::runtime::Handle,
    ) -> std::io::Result<Self> {
        let _entered = runtime.enter();
        let (views, view) = watch::channel(StreamView::default());
        let outlet = OfferOutlet::default();
        let listening = StreamListener {
            intake: Intake::new(site.side),
            view: StreamView::default(),
            site,
            allowed,
            outlet: outlet.clone(),
            views,
            is_news: false,
        };
        let (place, task) = match place {
            StreamPlace::Udp(at) => {
                let socket = std::net::UdpSocket::bind(at)?;
                socket.set_nonblocking(true)?;
                let socket = UdpSocket::from_std(socket)?;
                let local = socket.local_addr()?;
                (
                    StreamPlace::Udp(local),
                    runtime.spawn(listening.datagrams(socket)),
                )
            }
            StreamPlace::Tcp(at) => {
                let listener = std::net::TcpListener::bind(at)?;
                listener.set_nonblocking(true)?;
                let listener = TcpListener::from_std(listener)?;
                let local = listener.local_addr()?;
                (
                    StreamPlace::Tcp(local),
                    runtime.spawn(listening.connections(listener)),
                )
            }
        };
        Ok(Self {
            place,
            view,
            outlet,
            _task: AbortOnDropHandle::new(task),
        })
    }

    /// Transport and listen address, with the port chosen by the system if none was given.
    pub const fn place(&self) -> StreamPlace {
        self.place
    }

    /// Listen address.
    pub const fn local(&self) -> SocketAddr {
        let (StreamPlace::Udp(at) | StreamPlace::Tcp(at)) = self.place;
        at
    }

    /// Current state.
    pub fn view(&self) -> StreamView {
        self.view.borrow().clone()
    }

    /// Receives its targets from now on; replaces the previous follower.
    pub fn follow(&self) -> mpsc::Receiver<Offer> {
        self.outlet.follow()
    }
}

/// A parsed line, or the reason for refusing it.
type ReadLine = Result<StreamLine, LineRefusal>;

/// Reads lines. A stop is carried out before the rest of its line is parsed.
#[derive(Clone)]
struct LineDoor {
    side: Side,
    allowed: ArmRequest,
    stop: Arc<dyn Fn() + Send + Sync>,
}

impl LineDoor {
    fn read(&self, line: &[u8]) -> ReadLine {
        if stop::is_stop(line, Completeness::Whole) {
            (self.stop)();
        }
        StreamLine::parse(line, self.side)?.within(&self.allowed)
    }
}

struct StreamListener {
    intake: Intake,
    view: StreamView,
    site: SourceSite,
    allowed: ArmRequest,
    outlet: OfferOutlet,
    views: watch::Sender<StreamView>,
    is_news: bool,
}

impl StreamListener {
    fn door(&self) -> LineDoor {
        LineDoor {
            side: self.site.side,
            allowed: self.allowed,
            stop: Arc::clone(&self.site.stop),
        }
    }

    async fn datagrams(mut self, socket: UdpSocket) {
        let mut datagram = vec![0; DATAGRAM_MAX];
        let door = self.door();
        let mut tick = interval(REPORT_INTERVAL);
        loop {
            tokio::select! {
                received = socket.recv_from(&mut datagram) => {
                    // An error belongs to an earlier reply; nothing is sent here.
                    let Ok((len, from)) = received else { continue };
                    let line = datagram.get(..len).unwrap_or_default();
                    self.receive(door.read(line), from);
                }
                _ = tick.tick() => self.publish(),
            }
        }
    }

    async fn connections(mut self, listener: TcpListener) {
        let (lines, mut received) = mpsc::channel(LINES_MAX);
        let mut readers = JoinSet::new();
        let mut tick = interval(REPORT_INTERVAL);
        loop {
            tokio::select! {
                accepted = listener.accept() => match accepted {
                    Ok((stream, from)) if readers.len() < CONNECTIONS_MAX + STOPPERS_MAX => {
                        let is_read = readers.len() < CONNECTIONS_MAX;
                        let reader = LineReader {
                            from,
                            door: self.door(),
                            lines: is_read.then(|| lines.clone()),
                        };
                        readers.spawn(reader.run(stream));
                    }
                    Ok(_too_many) => {}
                    // A resource of the system is exhausted: it may be available again soon.
                    Err(_error) => tokio::time::sleep(REPORT_INTERVAL).await,
                },
                Some(_ended) = readers.join_next() => {}
                Some((line, from)) = received.recv() => self.receive(line, from),
                _ = tick.tick() => {
                    self.is_news |= self.view.connections != readers.len();
                    self.view.connections = readers.len();
                    self.publish();
                }
            }
        }
    }

    fn receive(&mut self, line: ReadLine, from: SocketAddr) {
        let now = self.site.clock.now();
        self.is_news = true;
        let Ok(line) = self.intake.accept_parsed(line, from, now) else {
            return;
        };
        if line.stop {
            return;
        }
        let offer = Offer {
            at: now,
            aims: line.aims,
            gap: line.gap,
            hold: line.hold,
            limits: OfferLimits::NONE,
            held: line.held,
            mark: Some(line.mark),
        };
        self.view.newest = Some(offer);
        self.view.not_granted += u64::from(!self.outlet.offer(offer));
    }

    fn publish(&mut self) {
        let intake = self.intake.view(self.site.clock.now());
        // The rate decreases with time alone.
        if !self.is_news && intake.rate_hz.to_bits() == self.view.intake.rate_hz.to_bits() {
            return;
        }
        self.is_news = false;
        self.view.intake = intake.clone();
        self.views.send_replace(self.view.clone());
        (self.site.wake)();
    }
}

/// One connection.
struct LineReader {
    from: SocketAddr,
    door: LineDoor,
    /// Receiver of its lines; `None` for a surplus connection, which may only stop the hand.
    lines: Option<mpsc::Sender<(ReadLine, SocketAddr)>>,
}

impl LineReader {
    /// Reads lines until the other side closes, is silent, or sends a line that is no message. Anything after such a line is
    /// ignored: a web page in a browser can send a form whose text has messages on further lines, but never one that begins with
    /// a message.
    async fn run(self, mut stream: TcpStream) {
        let mut cutter = LineCutter::new(LONGEST);
        let mut piece = [0; LINE_MAX];
        loop {
            let Ok(Ok(len @ 1..)) = timeout(LINE_TIMEOUT, stream.read(&mut piece)).await else {
                break;
            };
            for cut in cutter.push(piece.get(..len).unwrap_or_default()) {
                if !self.forward(cut).await {
                    return;
                }
            }
            if !begins_message(cutter.unfinished()) {
                let text = cutter.unfinished().to_vec();
                let has_stopped = false;
                self.forward(LineEvent::Line { text, has_stopped }).await;
                return;
            }
        }
        if let Some(cut) = cutter.end() {
            self.forward(cut).await;
        }
    }

    /// Reads a line and forwards it; returns false if the connection must end.
    async fn forward(&self, cut: LineEvent) -> bool {
        let (text, read) = match cut {
            LineEvent::Stop => {
                (self.door.stop)();
                return true;
            }
            LineEvent::Line { text, .. } if scan::unmarked(&text).is_empty() => return true,
            LineEvent::Line { text, has_stopped } => {
                let read = if has_stopped {
                    StreamLine::parse(&text, self.door.side)
                } else {
                    self.door.read(&text)
                };
                (text, read)
            }
        };
        let is_message = match &read {
            Ok(_) => begins_message(&text),
            Err(refusal) => !refusal.fault.is_no_message(),
        };
        match &self.lines {
            Some(lines) => lines.send((read, self.from)).await.is_ok() && is_message,
            None => is_message && read.is_ok_and(|line| line.stop),
        }
    }
}
