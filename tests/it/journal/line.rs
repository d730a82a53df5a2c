//! Simulated hands behind a wire of any kind: what passes on it, request by request, and what goes wrong.

use crate::journal::page::compact;
use handscope::codec::modbus_rtu::crc16;
use handscope::codec::rs485::encode_write_ack;
use handscope::hand::{Dof, Fault, Moment, SerialSpeed, Span};
use handscope::link::traffic::decode::Heard;
use handscope::link::traffic::frame::hex;
use handscope::link::traffic::{Decoder, Frame, Kind, Wrong};
use handscope::record::{Direction, Piece, PieceKind};
use handscope::sim::serve::{modbus_rtu, modbus_tcp, rs485, slcan};
use handscope::sim::{SharedHand, SimConfig, SimHand, SimHands};
use handscope::transport::{Endpoint, Wire, pair};
use std::net::Ipv4Addr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Instant, sleep, sleep_until};

/// ANGLE_ACT, SAVE, and IP_PART1 to 4 (manual 2.6).
const ANGLE_ACT: Span = Span::new(1546, 12);
const SAVE: u16 = 1005;
const IP: Span = Span::new(1700, 4);

/// Where something goes wrong: `write 1032 1 lose` is at the first write there. The answer is lost, comes `late` by so many
/// milliseconds or `twice`; all wires fall `mute`, this one is `cut`; the hand `drop`s without a word what it was told,
/// `take`s other bytes, or says no (`refuse`).
struct Upset {
    writes: bool,
    address: u16,
    nth: usize,
    trouble: String,
}

impl Upset {
    fn parse(words: &str) -> Self {
        let words: Vec<&str> = words.splitn(4, ' ').collect();
        Self {
            writes: words[0] == "write",
            address: words[1].parse().unwrap(),
            nth: words[2].parse().unwrap(),
            trouble: words[3].into(),
        }
    }
}

/// One request, and what came back for it.
pub(crate) struct Request {
    pub(crate) id: u16,
    pub(crate) writes: bool,
    /// Modbus only.
    pub(crate) function: Option<u8>,
    pub(crate) span: Span,
    pub(crate) bytes: Vec<u8>,
    pub(crate) answer: Option<String>,
}

/// What passed: a request, or what is none.
pub(crate) enum Passed {
    Request(Request),
    Other(String),
}

/// A line to one hand or more.
pub(crate) struct Line {
    hands: SimHands,
    first: SharedHand,
    passed: Mutex<Vec<Passed>>,
    upsets: Mutex<Vec<Upset>>,
    is_mute: AtomicBool,
    /// Where the first hand is found on the network since it was switched on.
    ip: Mutex<Ipv4Addr>,
}

impl Line {
    /// Hands with these ids.
    pub(crate) fn new(ids: &[u8], config: SimConfig, upsets: &[String]) -> Arc<Self> {
        let hand = |id: &u8| {
            let hand = SimHand::new(SimConfig { id: *id, ..config });
            SharedHand::new(hand, Instant::now())
        };
        let mut hands: Vec<SharedHand> = ids.iter().map(hand).collect();
        let first = hands.remove(0);
        let line = Self {
            hands: SimHands::new(first.clone(), hands),
            first,
            passed: Mutex::default(),
            upsets: Mutex::new(upsets.iter().map(|words| Upset::parse(words)).collect()),
            is_mute: AtomicBool::default(),
            ip: Mutex::new(Ipv4Addr::LOCALHOST),
        };
        line.event(&["power"]);
        let line = Arc::new(line);
        tokio::spawn(live(Arc::downgrade(&line)));
        line
    }

    fn holds(&self, span: Span) -> Vec<u8> {
        self.first.with(|hand, now| hand.read(span, now).unwrap())
    }

    fn put(&self, address: u16, bytes: &[u8]) {
        let _taken = self.first.with(|hand, now| hand.write(address, bytes, now));
    }

    /// Where a joint stands, by the hand's own word.
    pub(crate) fn angle(&self, dof: Dof) -> i16 {
        let bytes = self.holds(ANGLE_ACT);
        i16::from_le_bytes([bytes[2 * dof.index()], bytes[2 * dof.index() + 1]])
    }

    /// What happens to the hand itself; `gentle` are defaults that hurt nobody.
    pub(crate) fn event(&self, words: &[&str]) {
        let byte = |word: &&str| word.parse::<u8>().unwrap();
        match words {
            ["power"] => {
                self.hands.with_each(SimHand::power_cycle);
                let ip: [u8; 4] = self.holds(IP).try_into().unwrap();
                *self.ip.lock().unwrap() = ip.into();
                self.is_mute.store(false, Ordering::Relaxed);
            }
            ["mute"] => self.is_mute.store(true, Ordering::Relaxed),
            ["fault", dof] => self.first.with(|hand, now| {
                hand.advance_to(now);
                hand.inject_fault(named(dof), Fault::Stall);
            }),
            ["gentle"] => self.put(1032, &[[150, 0].repeat(6), [44, 1].repeat(6)].concat()),
            ["put", address, bytes @ ..] => {
                let bytes: Vec<u8> = bytes.iter().map(byte).collect();
                self.put(address.parse().unwrap(), &bytes);
            }
            other => panic!("nothing happens so: {other:?}"),
        }
    }

    /// Notes what is no request.
    pub(crate) fn note(&self, text: String) {
        self.passed.lock().unwrap().push(Passed::Other(text));
    }

    /// All that passed since it was asked last.
    pub(crate) fn take(&self) -> Vec<Passed> {
        std::mem::take(&mut *self.passed.lock().unwrap())
    }

    /// The same without a read that is not answered yet.
    pub(crate) fn take_settled(&self) -> Vec<Passed> {
        let mut passed = self.passed.lock().unwrap();
        let is_open = |last: &Passed| matches!(last, Passed::Request(it) if !it.writes && it.answer.is_none());
        let open = passed.pop_if(|last| is_open(last));
        std::mem::replace(&mut *passed, open.into_iter().collect())
    }

    /// True if the hand is on the network there, where the place is an address.
    pub(crate) fn is_at(&self, place: &Endpoint) -> bool {
        let ip = self.ip.lock().unwrap().to_string();
        !matches!(place, Endpoint::Tcp { host, .. } if *host != ip)
    }

    /// True if the hand understands this speed now.
    pub(crate) fn is_heard_at(&self, baud: u32) -> bool {
        let code = self.first.with(|hand, _| hand.baud_code());
        let mut speeds = SerialSpeed::ALL.into_iter();
        speeds.any(|speed| speed.baud() == baud && speed.code() == code)
    }

    /// The trouble that a request meets, if it is its turn.
    fn trouble(&self, request: &Request) -> Option<String> {
        let (writes, address) = (request.writes, request.span.address);
        let mut upsets = self.upsets.lock().unwrap();
        let all = upsets.iter_mut();
        let meant = all.filter(|upset| (upset.writes, upset.address) == (writes, address));
        let due = meant.filter_map(|upset| {
            upset.nth = upset.nth.saturating_sub(1);
            (upset.nth == 0).then(|| std::mem::take(&mut upset.trouble))
        });
        let due: Vec<String> = due.collect();
        upsets.retain(|upset| upset.nth > 0);
        due.into_iter().next()
    }

    /// Sets an answer against the newest request that it fits.
    fn heard(&self, frame: &Frame) {
        let mut passed = self.passed.lock().unwrap();
        let address = frame.span.map(|span| span.address);
        let not_taken = matches!(frame.wrong, Some(Wrong::NotTaken { .. }));
        // On RS485 "no" looks as the result of a SAVE does.
        let is_result = address == Some(SAVE) && not_taken || !is_answer(frame.kind);
        let fits = |request: &Request| {
            request.answer.is_none()
                && !is_result
                && (frame.kind == Kind::Refusal || is_write(frame.kind) == Some(request.writes))
                && address.is_none_or(|address| address == request.span.address)
        };
        let requests = passed.iter_mut().rev().filter_map(|passed| match passed {
            Passed::Request(request) => Some(request),
            Passed::Other(_) => None,
        });
        let mut open = requests.enumerate().filter(|(_, request)| fits(request));
        match open.next() {
            None => passed.push(Passed::Other(format!("heard {}", hex(&frame.bytes)))),
            Some((later, request)) => {
                let by = frame.hand.filter(|by| *by != request.id);
                let by = by.map(|by| format!(" by {by}")).unwrap_or_default();
                let late = if later > 0 { " (late)" } else { "" };
                request.answer = Some(format!("{}{by}{late}", answer(frame)));
            }
        }
    }

    /// Carries bytes both ways between a program and the hands until the program hangs up. `is_heard` is whether the hand
    /// understands the program's speed now.
    pub(crate) async fn carry(
        self: Arc<Self>,
        place: Endpoint,
        near: impl Wire,
        is_heard: impl Fn() -> bool,
    ) {
        let (far, at_hand) = pair();
        let (kind, hands) = (place.kind(), self.hands.clone());
        tokio::spawn(async move {
            match kind {
                "rtu" => modbus_rtu::serve(hands, at_hand).await,
                "tcp" => modbus_tcp::serve_client(hands, at_hand).await,
                "slcan" => slcan::serve(hands, at_hand).await,
                _ => rs485::serve(hands, at_hand).await,
            }
        });
        let relay = Relay {
            decoder: Decoder::new(&place),
            kind,
            line: self,
            near,
            trouble: None,
            held: Vec::new(),
            late: None,
        };
        relay.run(far, is_heard).await;
    }
}

/// The hands live on when nobody asks.
async fn live(line: Weak<Line>) {
    while let Some(line) = line.upgrade() {
        line.hands.with_each(SimHand::advance_to);
        drop(line);
        sleep(Duration::from_millis(10)).await;
    }
}

/// The joint of this name.
pub(crate) fn named(name: &str) -> Dof {
    let mut all = Dof::ALL.into_iter();
    all.find(|dof| dof.name() == name).expect(name)
}

/// One wire.
struct Relay<N> {
    line: Arc<Line>,
    kind: &'static str,
    decoder: Decoder,
    near: N,
    /// What is to happen to the next answer, and what the hand then holds where.
    trouble: Option<(String, u16, Vec<u8>)>,
    /// An answer that it will happen to, as far as it came.
    held: Vec<u8>,
    late: Option<(Instant, Vec<u8>)>,
}

impl<N: Wire> Relay<N> {
    async fn run(mut self, mut far: impl Wire, is_heard: impl Fn() -> bool) {
        let (mut asked, mut answered) = ([0; 512], [0; 512]);
        loop {
            let due = self.late.as_ref().map(|(at, _)| *at);
            let goes_on = tokio::select! {
                biased;
                () = sleep_until(due.unwrap_or_else(Instant::now)), if due.is_some() => {
                    let (_, bytes) = self.late.take().unwrap();
                    self.pass(&bytes).await
                }
                read = far.read(&mut answered) => match read {
                    Ok(len @ 1..) => self.answered(&answered[..len]).await,
                    _ => false,
                },
                read = self.near.read(&mut asked) => match read {
                    Ok(len @ 1..) => {
                        let reaches = self.asked(&asked[..len]).await && is_heard();
                        !reaches || far.write_all(&asked[..len]).await.is_ok()
                    }
                    _ => false,
                },
            };
            if !goes_on {
                return;
            }
        }
    }

    fn is_mute(&self) -> bool {
        self.line.is_mute.load(Ordering::Relaxed)
    }

    /// Notes what the program asks; true if it reaches the hand.
    async fn asked(&mut self, bytes: &[u8]) -> bool {
        for frame in frames(&mut self.decoder, Direction::ToHand, bytes) {
            let Some((span, writes)) = frame.span.zip(is_write(frame.kind)) else {
                let text = String::from_utf8_lossy(&frame.bytes).trim_end().to_owned();
                self.line.note(format!("adapter {text}"));
                continue;
            };
            let request = Request {
                id: frame.hand.unwrap_or_default(),
                writes,
                function: match self.kind {
                    "rtu" => Some(frame.bytes[1]),
                    "tcp" => Some(frame.bytes[7]),
                    _ => None,
                },
                span,
                bytes: frame.memory.to_vec(),
                answer: None,
            };
            let trouble = self.line.trouble(&request);
            let request = Passed::Request(request);
            self.line.passed.lock().unwrap().push(request);
            if trouble.as_deref() == Some("refuse") {
                let refusal = refusal(self.kind, &frame);
                self.pass(&refusal).await;
                return false;
            }
            self.trouble = trouble.map(|trouble| {
                let becomes = match trouble.strip_prefix("take ") {
                    Some(bytes) => bytes.split(' ').map(|byte| byte.parse().unwrap()).collect(),
                    None if trouble == "drop" => self.line.holds(span),
                    None => Vec::new(),
                };
                (trouble, span.address, becomes)
            });
        }
        !self.is_mute()
    }

    /// Passes what the hand says, or does to it what is to happen; false if the wire breaks.
    async fn answered(&mut self, bytes: &[u8]) -> bool {
        self.held.extend(bytes);
        let frames = frames(&mut self.decoder.clone(), Direction::FromHand, &self.held);
        let is_whole = frames.iter().any(|frame| is_answer(frame.kind));
        if self.trouble.is_some() && !is_whole {
            return true;
        }
        let bytes = std::mem::take(&mut self.held);
        let (trouble, address, becomes) = self.trouble.take().unwrap_or_default();
        match trouble.as_str() {
            _ if self.is_mute() => true,
            "" => self.pass(&bytes).await,
            "lose" => true,
            "twice" => self.pass(&bytes).await && self.pass(&bytes).await,
            "cut" => false,
            "mute" => {
                self.line.event(&["mute"]);
                true
            }
            _ if !becomes.is_empty() => {
                self.line.put(address, &becomes);
                self.pass(&bytes).await
            }
            late => {
                let by = late.strip_prefix("late ").expect(late).parse();
                self.late = Some((Instant::now() + Duration::from_millis(by.unwrap()), bytes));
                true
            }
        }
    }

    async fn pass(&mut self, bytes: &[u8]) -> bool {
        for frame in frames(&mut self.decoder, Direction::FromHand, bytes) {
            if frame.kind != Kind::AdapterReply {
                self.line.heard(&frame);
            }
        }
        self.near.write_all(bytes).await.is_ok()
    }
}

fn frames(decoder: &mut Decoder, direction: Direction, bytes: &[u8]) -> Vec<Frame> {
    let (kind, bytes) = (PieceKind::Bytes(direction), bytes.to_vec());
    // Time stands still: what is not whole yet is waited for, however busy the machine is.
    let at = Moment::ZERO;
    let mut heard = Vec::new();
    decoder.push(&Piece { at, kind, bytes }, &mut heard);
    let frames = heard.into_iter().filter_map(|heard| match heard {
        Heard::Frame(frame) => Some(frame),
        Heard::NoReply(_) => None,
    });
    frames.collect()
}

const fn is_write(kind: Kind) -> Option<bool> {
    match kind {
        Kind::Read | Kind::ReadReply => Some(false),
        Kind::Write | Kind::WriteReply => Some(true),
        _ => None,
    }
}

const fn is_answer(kind: Kind) -> bool {
    matches!(kind, Kind::ReadReply | Kind::WriteReply | Kind::Refusal)
}

fn answer(frame: &Frame) -> String {
    match (frame.kind, frame.wrong) {
        (_, Some(Wrong::Refused { code })) => format!("refused {code}"),
        (_, Some(Wrong::NotTaken { value })) => format!("ack {value}"),
        (Kind::WriteReply, _) => "ack".into(),
        _ => compact(&frame.memory),
    }
}

/// "No" in the words of a protocol.
fn refusal(kind: &str, asked: &Frame) -> Vec<u8> {
    const VALUE: u8 = 3;
    let bytes = &asked.bytes;
    match kind {
        "rtu" => {
            let reply = [bytes[0], bytes[1] | 0x80, VALUE];
            [&reply[..], &crc16(&reply).to_le_bytes()].concat()
        }
        "tcp" => [&bytes[..4], &[0, 3, bytes[6], bytes[7] | 0x80, VALUE]].concat(),
        "rs485" => encode_write_ack(bytes[2], asked.span.unwrap().address, 0).to_vec(),
        _ => panic!("this wire has no word for no"),
    }
}
