//! The hand of one cell and its wire: where the joints truly are, what reached the hand, and what goes wrong with either. The same in
//! memory, on pseudo-terminals and on loopback sockets.

use crate::setup::body::Protocol;
use crate::setup::hand;
use crate::setup::link;
use handscope::codec::modbus_rtu::crc16;
use handscope::hand::{Dof, Fault, Moment, PerDof, Span};
use handscope::sim::{
    ForceCompared, JournalEntry, MinusOne, Scenario, SharedHand, SimConfig, SimHand,
};
use handscope::transport::{Dial, Endpoint, PtyLink, Wire, pair};
use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::runtime::Handle;
use tokio::sync::watch;
use tokio::time::sleep;

/// ANGLE_SET, and what is live from POS_ACT to TEMP (manual 2.6).
pub(super) const ANGLE_SET: u16 = 1486;
const LIVE: Span = Span::new(1534, 90);
/// Between two looks of what carries a disobedient hand's feedback, and of what waits for a wire.
const STEP: Duration = Duration::from_millis(5);
/// One frame as Linux hands it to programs.
const CAN_RECORD: usize = 16;
/// One reply in so many goes wrong.
const ODD_ONE_IN: u32 = 6;
/// What another controller asks of all joints. Nobody else ever asks for it.
pub(super) const FOREIGN: i16 = 913;

/// What becomes of bytes on their way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Carries {
    /// They pass.
    All,
    /// None passes, and no wire breaks.
    Nothing,
    /// Requests pass; replies are late, doubled or wrong now and then.
    OddReplies,
    /// Requests pass; each reply comes this much later.
    Late(Duration),
    /// No request passes: a Modbus gateway answers with this exception that the hand does not.
    Refusals(u8),
}

/// The wire between a program and the hand, governed from outside.
struct Gate {
    protocol: Protocol,
    carries: Mutex<Carries>,
    /// Counts the times at which all wires break.
    cut: watch::Sender<u64>,
    /// No wire can be opened.
    is_away: AtomicBool,
    rng: Mutex<fastrand::Rng>,
}

impl Gate {
    fn carries(&self) -> Carries {
        *self.carries.lock().unwrap()
    }

    /// Until an end is gone or the wire is cut.
    async fn carry(self: Arc<Self>, mut near: impl Wire, mut far: impl Wire) {
        let mut cut = self.cut.subscribe();
        let (mut asked, mut answered) = ([0; 512], [0; 512]);
        loop {
            let passed = tokio::select! {
                biased;
                _ = cut.changed() => return,
                read = far.read(&mut answered) => match read {
                    Ok(len @ 1..) => self.answer(&mut near, &answered[..len]).await,
                    _ => return,
                },
                read = near.read(&mut asked) => match read {
                    Ok(1..) if self.carries() == Carries::Nothing => Ok(()),
                    Ok(len @ 1..) => match self.carries() {
                        Carries::Refusals(code) => {
                            let refused = refusal(self.protocol, &asked[..len], code);
                            near.write_all(&refused).await
                        }
                        _ => far.write_all(&asked[..len]).await,
                    },
                    _ => return,
                },
            };
            if passed.is_err() {
                return;
            }
        }
    }

    async fn answer(&self, near: &mut impl Wire, bytes: &[u8]) -> std::io::Result<()> {
        let (mut bytes, mut copies) = (bytes.to_vec(), 1);
        match self.carries() {
            Carries::All => {}
            Carries::Nothing | Carries::Refusals(_) => return Ok(()),
            Carries::Late(by) => sleep(by).await,
            Carries::OddReplies => {
                let (kind, late_ms) = {
                    let mut rng = self.rng.lock().unwrap();
                    (rng.u32(..3 * ODD_ONE_IN), rng.u64(20..200))
                };
                match kind {
                    0 => sleep(Duration::from_millis(late_ms)).await,
                    1 => copies = 2,
                    2 => self.spoil(&mut bytes),
                    _ => {}
                }
            }
        }
        let piece = match self.protocol {
            Protocol::Can => CAN_RECORD,
            _ => bytes.len(),
        };
        for _ in 0..copies {
            for piece in bytes.chunks(piece.max(1)) {
                near.write_all(piece).await?;
            }
        }
        near.flush().await
    }

    /// As each wire can spoil a reply without its own check letting it through: CAN sends a spoilt frame again.
    fn spoil(&self, bytes: &mut Vec<u8>) {
        match self.protocol {
            Protocol::Rs485 | Protocol::Rtu => {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 0x10;
            }
            Protocol::Tcp => bytes[0] ^= 0x55,
            Protocol::Slcan => bytes[0] = b'?',
            Protocol::Can => bytes.clear(),
        }
    }
}

/// An exception in answer to a request.
fn refusal(protocol: Protocol, asked: &[u8], code: u8) -> Vec<u8> {
    match protocol {
        Protocol::Tcp => {
            let mut refused = vec![asked[0], asked[1], 0, 0, 0, 3];
            refused.extend([asked[6], asked[7] | 0x80, code]);
            refused
        }
        Protocol::Rtu => {
            let mut refused = vec![asked[0], asked[1] | 0x80, code];
            refused.extend(crc16(&refused).to_le_bytes());
            refused
        }
        Protocol::Rs485 | Protocol::Can | Protocol::Slcan => panic!("only Modbus has exceptions"),
    }
}

/// The hand of one cell.
pub(super) struct SeamHand {
    /// What the wire talks to. Its journal is the judge.
    hand: SharedHand,
    /// Where the joints truly are, once the hand does not do as it is told.
    disobeys: Mutex<Option<SharedHand>>,
    gate: Arc<Gate>,
    /// Serves it; its time is the hand's.
    runtime: Handle,
    /// Where programs find it.
    pub(super) endpoint: String,
}

/// What the hand is like.
#[derive(Debug, Clone, Copy)]
pub(super) enum HandKind {
    Usual,
    /// It takes its time to answer, so that what is written in a row takes a second.
    Slow,
    /// Its joints rest up to 8 counts beside their targets, its drives count what their force sensors read without a load, and -1 stays
    /// in ANGLE_SET where it was written.
    RestsShort,
}

impl HandKind {
    fn config(self) -> SimConfig {
        let mut config = SimConfig {
            scenario: Scenario::Free,
            ..SimConfig::default()
        };
        match self {
            Self::Usual => {}
            Self::Slow => config.personality.turnaround = Duration::from_millis(40),
            Self::RestsShort => {
                config.personality.minus_one_mid_move = MinusOne::Ignore;
                config.personality.force_compared = ForceCompared::AsRead;
                for (_, joint) in config.body.joints.iter_mut() {
                    (joint.backlash, joint.force_zero_g) = (16.0, 60.0);
                }
            }
        }
        config
    }
}

impl SeamHand {
    fn new(protocol: Protocol, endpoint: String, id: u8, kind: HandKind) -> Arc<Self> {
        let config = SimConfig {
            id,
            ..kind.config()
        };
        Arc::new(Self {
            hand: hand::shared(config),
            disobeys: Mutex::default(),
            gate: Arc::new(Gate {
                protocol,
                carries: Mutex::new(Carries::All),
                cut: watch::Sender::new(0),
                is_away: AtomicBool::new(false),
                rng: Mutex::new(fastrand::Rng::with_seed(7)),
            }),
            runtime: Handle::current(),
            endpoint,
        })
    }

    /// A hand on wires in memory. Called inside the runtime whose time it lives in.
    pub(super) fn in_memory(protocol: Protocol, kind: HandKind) -> Arc<Self> {
        let endpoint = match protocol {
            Protocol::Rs485 => "rs485:seam",
            Protocol::Rtu => "rtu:seam",
            Protocol::Tcp => "tcp:seam",
            Protocol::Can => "can:seam",
            Protocol::Slcan => "slcan:seam",
        };
        Self::new(protocol, endpoint.into(), 1, kind)
    }

    /// A hand that other processes reach: a pseudo-terminal in the folder, a loopback socket, or the interface `vcan0`. Each has an
    /// id of its own. Called inside the runtime that serves it.
    pub(super) fn on_a_wire(
        protocol: Protocol,
        folder: &Path,
        id: u8,
        kind: HandKind,
    ) -> Arc<Self> {
        let link = folder.join("hand");
        let port = || link.to_str().unwrap().to_owned();
        match protocol {
            Protocol::Tcp => {
                let socket = TcpListener::bind("127.0.0.1:0").unwrap();
                let place = socket.local_addr().unwrap();
                let hand = Self::new(protocol, format!("tcp:{place}"), id, kind);
                tokio::spawn(Arc::clone(&hand).serve_sockets(socket, place));
                hand
            }
            Protocol::Can => {
                let hand = Self::new(protocol, format!("can:vcan0?id={id}"), id, kind);
                tokio::spawn(Arc::clone(&hand).serve_interface());
                hand
            }
            Protocol::Rs485 | Protocol::Rtu | Protocol::Slcan => {
                let endpoint = format!("{}:{}?id={id}", name(protocol), port());
                let hand = Self::new(protocol, endpoint, id, kind);
                let made = PtyLink::create(&link).unwrap();
                tokio::spawn(Arc::clone(&hand).serve_ports(made, link));
                hand
            }
        }
    }

    async fn serve_ports(self: Arc<Self>, first: PtyLink, link: PathBuf) {
        let mut port = Some(first);
        loop {
            while self.gate.is_away.load(Ordering::Relaxed) {
                sleep(STEP).await;
            }
            let opened = port.take();
            let opened = opened.unwrap_or_else(|| PtyLink::create(&link).unwrap());
            self.carry(opened).await;
        }
    }

    async fn serve_sockets(self: Arc<Self>, first: TcpListener, place: SocketAddr) {
        let mut socket = Some(first);
        loop {
            while self.gate.is_away.load(Ordering::Relaxed) {
                sleep(STEP).await;
            }
            let listens = match socket.take() {
                Some(first) => {
                    first.set_nonblocking(true).unwrap();
                    tokio::net::TcpListener::from_std(first).unwrap()
                }
                None => tokio::net::TcpListener::bind(place).await.unwrap(),
            };
            let mut cut = self.gate.cut.subscribe();
            loop {
                tokio::select! {
                    biased;
                    _ = cut.changed() => break,
                    client = listens.accept() => {
                        let (client, _) = client.unwrap();
                        client.set_nodelay(true).unwrap();
                        let hand = Arc::clone(&self);
                        tokio::spawn(async move { hand.carry(client).await });
                    }
                }
            }
        }
    }

    #[cfg(target_os = "linux")]
    async fn serve_interface(self: Arc<Self>) {
        loop {
            while self.gate.is_away.load(Ordering::Relaxed) {
                sleep(STEP).await;
            }
            let wire = handscope::transport::can::open("vcan0", None).unwrap();
            self.carry(wire).await;
        }
    }

    #[cfg(not(target_os = "linux"))]
    async fn serve_interface(self: Arc<Self>) {}

    async fn carry(&self, near: impl Wire) {
        let (far, at_hand) = pair();
        let endpoint: Endpoint = self.endpoint.parse().unwrap();
        let served = hand::serve(self.hand.clone(), &endpoint, at_hand);
        Arc::clone(&self.gate).carry(near, far).await;
        served.abort();
    }

    /// The hand's time.
    pub(super) fn now(&self) -> Moment {
        self.with(|_, now| now)
    }

    fn with<T>(&self, act: impl FnOnce(&mut SimHand, Moment) -> T) -> T {
        let _inside = self.runtime.enter();
        self.hand.with(act)
    }

    /// Where the joints truly are.
    pub(super) fn angles(&self) -> [i16; 6] {
        let _inside = self.runtime.enter();
        let truly = self.disobeys.lock().unwrap();
        let body = truly.as_ref().unwrap_or(&self.hand);
        let angles = body.with(|hand, now| {
            hand.advance_to(now);
            hand.true_angles()
        });
        Dof::ALL.map(|dof| angles[dof].round() as i16)
    }

    /// What reached the hand since then, but for what the test wrote as another controller.
    pub(super) fn writes_since(&self, from: Moment) -> Vec<JournalEntry> {
        let foreign = FOREIGN.to_le_bytes().repeat(6);
        let all = self.hand.with(|hand, _| hand.journal().to_vec());
        let since = all.into_iter().filter(|entry| entry.at >= from);
        since.filter(|entry| entry.bytes != foreign).collect()
    }

    /// Bytes that the hand holds.
    pub(super) fn holds(&self, span: Span) -> Vec<u8> {
        self.with(|hand, now| hand.read(span, now).unwrap())
    }

    // --- what goes wrong --------------------------------------------------------------------------------------------------

    /// Nothing passes from now on, and no wire breaks; or all passes again.
    pub(super) fn silence(&self, is_silent: bool) {
        *self.gate.carries.lock().unwrap() = match is_silent {
            true => Carries::Nothing,
            false => Carries::All,
        };
    }

    /// A gateway answers with this exception in place of the hand.
    pub(super) fn refuse(&self, code: u8) {
        *self.gate.carries.lock().unwrap() = Carries::Refusals(code);
    }

    /// Each reply comes this much later.
    pub(super) fn delay_replies(&self, by: Duration) {
        *self.gate.carries.lock().unwrap() = Carries::Late(by);
    }

    /// Replies are late, doubled or wrong now and then.
    pub(super) fn odd_replies(&self) {
        *self.gate.carries.lock().unwrap() = Carries::OddReplies;
    }

    /// The wire breaks, and none can be opened until it is plugged in again.
    pub(super) fn unplug(&self) {
        self.gate.is_away.store(true, Ordering::Relaxed);
        self.gate.cut.send_modify(|times| *times += 1);
    }

    pub(super) fn plug_in(&self) {
        self.gate.is_away.store(false, Ordering::Relaxed);
    }

    /// Its power goes and comes back at once. What it does not hear while it starts is for [`Self::silence`].
    pub(super) fn power_cycle(&self) {
        self.with(|hand, now| hand.power_cycle(now));
    }

    pub(super) fn fault(&self, fault: Fault) {
        self.with(|hand, _| hand.inject_fault(Dof::Middle, fault));
    }

    /// The temperature of a drive reads this from now on.
    pub(super) fn reads_temperature(&self, celsius: u8) {
        self.with(|hand, _| hand.break_temperature_sensor(Dof::Middle, celsius));
    }

    /// What it tells stands still from now on; its joints do not.
    pub(super) fn freeze_feedback(&self) {
        self.with(|hand, now| hand.freeze_feedback(true, now));
    }

    /// The angles that it tells of these joints stand still from now on; all else lives on.
    pub(super) fn freeze_angles(&self, frozen: PerDof<bool>) {
        self.with(|hand, now| hand.freeze_angles(frozen, now));
    }

    /// From now on it takes and reads back what it is told, and its joints go on to where they were sent before.
    pub(super) fn disobey(self: &Arc<Self>) {
        let _inside = self.runtime.enter();
        let body = self.hand.with(|hand, now| {
            hand.advance_to(now);
            let body = hand.clone();
            hand.follow_recording();
            body
        });
        let began = tokio::time::Instant::now() - self.now().since(Moment::ZERO);
        let body = SharedHand::new(body, began);
        *self.disobeys.lock().unwrap() = Some(body.clone());
        let hand = self.hand.clone();
        let mut seen = hand.with(|hand, _| hand.journal().len());
        tokio::spawn(async move {
            loop {
                sleep(STEP).await;
                let live = body.with(|hand, now| hand.read(LIVE, now).unwrap());
                hand.with(|hand, _| {
                    hand.put_recorded(LIVE.address, &live);
                    let new = hand.journal()[seen..].to_vec();
                    seen += new.len();
                    for write in new {
                        let kept = without_leave(&write, hand);
                        hand.put_recorded(write.address, &kept);
                    }
                });
            }
        });
    }

    /// Another controller sends all joints somewhere.
    pub(super) fn another_controller_writes(&self) {
        let bytes = FOREIGN.to_le_bytes().repeat(6);
        self.with(|hand, now| hand.write(ANGLE_SET, &bytes, now).unwrap());
    }
}

/// The bytes as the hand keeps them: -1 leaves what is there.
fn without_leave(write: &JournalEntry, hand: &mut SimHand) -> Vec<u8> {
    let len = u16::try_from(write.bytes.len()).unwrap();
    let mut kept = hand.read(Span::new(write.address, len), write.at).unwrap();
    let pairs = kept.chunks_mut(2).zip(write.bytes.chunks(2));
    for (kept, new) in pairs {
        if new != [0xFF, 0xFF] {
            kept.copy_from_slice(new);
        }
    }
    kept
}

impl Dial for InMemory {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        if let Some((_, leader)) = self.others.iter().find(|(at, _)| at == endpoint) {
            let (ours, its) = pair();
            hand::serve(leader.clone(), endpoint, its);
            return link::opened(ours);
        }
        if self.hand.gate.is_away.load(Ordering::Relaxed) {
            return link::missing(endpoint.to_string());
        }
        let (ours, near) = pair();
        let hand = Arc::clone(&self.hand);
        tokio::spawn(async move { hand.carry(near).await });
        link::opened(ours)
    }
}

/// Opens wires in memory to the hand of a cell, and to others that nothing happens to.
pub(super) struct InMemory {
    pub(super) hand: Arc<SeamHand>,
    pub(super) others: Vec<(Endpoint, SharedHand)>,
}

/// As in endpoints, and in the names of cells.
pub(super) const fn name(protocol: Protocol) -> &'static str {
    match protocol {
        Protocol::Rs485 => "rs485",
        Protocol::Rtu => "rtu",
        Protocol::Tcp => "tcp",
        Protocol::Can => "can",
        Protocol::Slcan => "slcan",
    }
}
