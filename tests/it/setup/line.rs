//! A line to one simulated hand, and what goes wrong on it: answers, wires, power, and a hand that takes what it likes.

use crate::setup::hand;
use crate::setup::link;
use handscope::hand::{SerialSpeed, Span};
use handscope::sim::{Personality, SaveAnswer, SharedHand, SimHand, SimHands};
use handscope::transport::{Dial, Endpoint, Pipe, pair};
use std::net::Ipv4Addr;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Duration, Instant, sleep};

/// IP_PART1 to 4 (manual 2.6).
pub(crate) const IP: Span = Span::new(1700, 4);

/// Any way in which a hand may end a SAVE.
pub(crate) fn some_save_answer(rng: &mut fastrand::Rng) -> SaveAnswer {
    [
        SaveAnswer::Command12,
        SaveAnswer::Command11,
        SaveAnswer::Late,
        SaveAnswer::Never,
        SaveAnswer::Twice,
        SaveAnswer::Failed,
    ][rng.usize(..6)]
}

/// What happens once the hand took a write to the address in question, before its answer passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Trouble {
    None,
    /// The answer is lost.
    LoseAnswer,
    /// It comes so much too late.
    Late(Duration),
    /// Nothing is answered any more on this wire.
    Mute,
    /// The wire breaks before the answer, and can be dialled again.
    Cut,
    /// It breaks, and nobody gets through for so long.
    Gone(Duration),
    /// The hand loses its power so long after the write.
    PowerCut(Duration),
    /// The hand drops the write without a word.
    Dropped,
    /// The hand takes another value, without a word.
    Takes(u8),
}

/// A line to one hand, and what happens on it.
pub(crate) struct Line {
    pub(crate) hand: SharedHand,
    /// A hand beside it on the same line.
    pub(crate) other: Option<SharedHand>,
    /// Where the trouble strikes.
    pub(crate) address: u16,
    /// At which write there: 1 is the first.
    pub(crate) nth: usize,
    pub(crate) trouble: Mutex<Trouble>,
    /// What the address held at the beginning.
    before: Vec<u8>,
    gone_until: Mutex<Option<Instant>>,
    /// Where it is found on the network since it was switched on.
    ip: Mutex<Ipv4Addr>,
    /// Writes that were not the line's.
    puts: AtomicUsize,
    /// It lost its power by a trouble.
    pub(crate) lost_power: AtomicBool,
}

impl Line {
    pub(crate) fn new(personality: Personality, address: u16, trouble: Trouble) -> Self {
        let mut hand = SimHand::new(hand::like(personality));
        let now = handscope::hand::Moment::ZERO;
        let len = if address == IP.address { IP.len } else { 1 };
        let before = hand.read(Span::new(address, len), now).unwrap();
        let ip = ip_of(&mut hand, now);
        Self {
            hand: hand::begin(hand),
            other: None,
            address,
            nth: 1,
            trouble: Mutex::new(trouble),
            before,
            gone_until: Mutex::default(),
            ip: Mutex::new(ip),
            puts: AtomicUsize::default(),
            lost_power: AtomicBool::default(),
        }
    }

    pub(crate) fn writes_to(&self, address: u16) -> usize {
        let is_there = |span: Span| span.covers(Span::new(address, 1));
        self.hand.with(|hand, _| {
            let all = hand.journal().iter();
            all.filter(|entry| {
                is_there(Span::new(
                    entry.address,
                    u16::try_from(entry.bytes.len()).unwrap(),
                ))
            })
            .count()
        }) - match address == self.address {
            true => self.puts.load(Ordering::Relaxed),
            false => 0,
        }
    }

    /// The bytes that the hand holds now.
    pub(crate) fn holds(&self, span: Span) -> Vec<u8> {
        self.hand.with(|hand, now| hand.read(span, now).unwrap())
    }

    /// Switches the hand off and on.
    pub(crate) fn power_cycle(&self) {
        self.hand.with(|hand, now| {
            hand.power_cycle(now);
            *self.ip.lock().unwrap() = ip_of(hand, now);
        });
    }

    /// The byte pair at an address after a power cycle.
    pub(crate) fn wakes_up_with(&self, address: u16) -> i16 {
        self.power_cycle();
        let bytes = self.holds(Span::new(address, 2));
        i16::from_le_bytes([bytes[0], bytes[1]])
    }

    /// True if the hand answers there now.
    pub(crate) fn is_at(&self, place: &Endpoint) -> bool {
        let (id, code) = self.hand.with(|hand, _| (hand.id(), hand.baud_code()));
        match place {
            Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
                line.id == id && code_of(line.baud) == Some(code)
            }
            Endpoint::Can { id: at, .. } => *at == u16::from(id),
            Endpoint::Tcp { host, .. } => *host == self.ip.lock().unwrap().to_string(),
            _ => false,
        }
    }

    fn is_gone(&self) -> bool {
        let until = *self.gone_until.lock().unwrap();
        until.is_some_and(|until| Instant::now() < until)
    }

    /// Puts another value into the hand, past its journal of what came over the wire.
    fn put(&self, bytes: &[u8]) {
        let address = self.address;
        self.puts.fetch_add(1, Ordering::Relaxed);
        let _taken = self.hand.with(|hand, now| hand.write(address, bytes, now));
    }

    /// What it held before the last write there.
    fn held_before(&self) -> Vec<u8> {
        self.hand.with(|hand, _| {
            let all = hand.journal().iter().rev();
            let mut there = all.filter(|entry| entry.address == self.address);
            let former = there.nth(1).map(|entry| entry.bytes.clone());
            former.unwrap_or_else(|| self.before.clone())
        })
    }

    /// What the hand does instead of what it says, and what becomes of its answer.
    async fn strike(self: &Arc<Self>, trouble: Trouble) -> Passes {
        match trouble {
            Trouble::None => {}
            Trouble::LoseAnswer => return Passes::Lost,
            Trouble::Late(by) => sleep(by).await,
            Trouble::Mute => return Passes::Never,
            Trouble::Cut => return Passes::HangsUp,
            Trouble::Gone(length) => {
                *self.gone_until.lock().unwrap() = Some(Instant::now() + length);
                return Passes::HangsUp;
            }
            Trouble::PowerCut(after) => {
                let line = Arc::clone(self);
                tokio::spawn(async move {
                    sleep(after).await;
                    line.lost_power.store(true, Ordering::Relaxed);
                    line.power_cycle();
                });
            }
            Trouble::Dropped => self.put(&self.held_before()),
            Trouble::Takes(byte) => {
                let mut bytes = self.before.clone();
                *bytes.last_mut().unwrap() = byte;
                self.put(&bytes);
            }
        }
        Passes::Yes
    }

    async fn carry(self: Arc<Self>, mut ours: Pipe, mut hands: Pipe, baud: Option<u32>) {
        let (mut asked, mut answered) = ([0; 512], [0; 512]);
        let mut is_mute = false;
        loop {
            let at_speed = || {
                let code = self.hand.with(|hand, _| hand.baud_code());
                baud.is_none_or(|baud| code_of(baud) == Some(code))
            };
            tokio::select! {
                biased;
                read = hands.read(&mut answered) => {
                    let Ok(len @ 1..) = read else { return };
                    let trouble = if self.writes_to(self.address) >= self.nth {
                        std::mem::replace(&mut *self.trouble.lock().unwrap(), Trouble::None)
                    } else {
                        Trouble::None
                    };
                    match self.strike(trouble).await {
                        Passes::Yes => {}
                        Passes::Lost => continue,
                        Passes::Never => is_mute = true,
                        Passes::HangsUp => return,
                    }
                    if !is_mute && ours.write_all(&answered[..len]).await.is_err() {
                        return;
                    }
                }
                read = ours.read(&mut asked) => {
                    let Ok(len @ 1..) = read else { return };
                    if self.is_gone() {
                        return;
                    }
                    if at_speed() && hands.write_all(&asked[..len]).await.is_err() {
                        return;
                    }
                }
            }
        }
    }
}

/// What becomes of an answer.
enum Passes {
    Yes,
    Lost,
    Never,
    HangsUp,
}

fn code_of(baud: u32) -> Option<u8> {
    let mut speeds = SerialSpeed::ALL.into_iter();
    speeds
        .find(|speed| speed.baud() == baud)
        .map(SerialSpeed::code)
}

fn ip_of(hand: &mut SimHand, now: handscope::hand::Moment) -> Ipv4Addr {
    let bytes = hand.read(IP, now).unwrap();
    Ipv4Addr::from([bytes[0], bytes[1], bytes[2], bytes[3]])
}

/// Dials the line; the hand is there only where it is found, except that a name that is no address is its own.
pub(crate) struct Dialled(pub Arc<Line>);

impl Dial for Dialled {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        let line = &self.0;
        let is_elsewhere = match endpoint {
            Endpoint::Tcp { host, .. } => host.parse::<Ipv4Addr>().is_ok() && !line.is_at(endpoint),
            _ => false,
        };
        if line.is_gone() || is_elsewhere {
            return link::missing(endpoint.to_string());
        }
        let (near, ours) = pair();
        let (far, at_hand) = pair();
        let hands = SimHands::new(line.hand.clone(), line.other.iter().cloned().collect());
        let baud = match endpoint {
            Endpoint::Rs485(serial) | Endpoint::Rtu(serial) => Some(serial.baud),
            _ => None,
        };
        hand::serve(hands, endpoint, at_hand);
        tokio::spawn(Arc::clone(line).carry(ours, far, baud));
        link::opened(near)
    }
}
