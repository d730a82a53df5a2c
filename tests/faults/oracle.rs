//! What must hold on every schedule, whatever the faults: checked on the wire's log and on the events.

use crate::device::stamped;
use crate::tap::{Log, Sent};
use handscope::hand::register::{Access, Element, by_address};
use handscope::hand::{Finger, Group, Groups, HandSample, Moment, Timed};
use handscope::link::{
    Disarmed, Hold, LinkEvent, LinkHandle, LinkState, Outcome, Request, RequestError, Ticket,
};
use std::collections::BTreeMap;
use std::time::Duration;

/// The stamp is cut to a tenth of a millisecond.
const STAMP_STEP: Duration = Duration::from_micros(100);
/// Hold frames are at most this far apart: the repeat, and one exchange that was under way.
const HOLD_GAP_MAX: Duration = Duration::from_millis(40 + 350);

/// How often the oracles had something to judge.
#[derive(Debug, Clone, Default)]
pub struct Seen {
    pub fresh_states: u64,
    pub fresh_tips: u64,
    pub setpoint_frames: u64,
    pub hold_frames: u64,
    pub arm_asks: u64,
    pub armed: u64,
    pub stops_seen: u64,
    pub confirmed: u64,
    pub losses: u64,
    pub answers: u64,
    pub disturbed: u64,
}

impl Seen {
    pub fn add(&mut self, more: &Self) {
        self.fresh_states += more.fresh_states;
        self.fresh_tips += more.fresh_tips;
        self.setpoint_frames += more.setpoint_frames;
        self.hold_frames += more.hold_frames;
        self.arm_asks += more.arm_asks;
        self.armed += more.armed;
        self.stops_seen += more.stops_seen;
        self.confirmed += more.confirmed;
        self.losses += more.losses;
        self.answers += more.answers;
        self.disturbed += more.disturbed;
    }
}

/// Watches one schedule.
pub struct Witness {
    seed: u64,
    log: Log,
    pub seen: Seen,
    states: Vec<(Moment, LinkState)>,
    samples: Vec<(Moment, HandSample)>,
    stops: Vec<Moment>,
    open: BTreeMap<Ticket, Request>,
}

impl Witness {
    pub fn new(seed: u64, log: Log) -> Self {
        Self {
            seed,
            log,
            seen: Seen::default(),
            states: vec![(Moment::ZERO, LinkState::Offline)],
            samples: Vec::new(),
            stops: Vec::new(),
            open: BTreeMap::new(),
        }
    }

    pub fn stop_pressed(&mut self, link: &LinkHandle, now: Moment) {
        if link.status().state.is_live() {
            self.stops.push(now);
        }
    }

    pub fn asked(&mut self, ticket: Ticket, request: Request) {
        self.open.insert(ticket, request);
    }

    pub fn event(&mut self, event: &LinkEvent, now: Moment) {
        match event {
            LinkEvent::Sample { sample, fresh } => self.sample(sample, *fresh, now),
            LinkEvent::State { at, state } => {
                let (_, before) = *self.states.last().unwrap();
                self.transition(before, *state);
                self.states.push((*at, *state));
            }
            LinkEvent::ArmRefused { .. } => {}
            LinkEvent::Done { ticket, result } => self.done(*ticket, result),
        }
    }

    fn transition(&mut self, before: LinkState, after: LinkState) {
        use LinkState::{Armed, Fault, Holding, Identifying, Monitoring, Offline};
        let fits = match after {
            Armed => before == Monitoring,
            Identifying => before == Offline,
            Monitoring => before != Offline,
            Fault => before.is_live(),
            Holding | Offline => true,
        };
        assert!(fits, "seed {}: {before:?} -> {after:?}", self.seed);
        self.seen.armed += u64::from(after == Armed);
        self.seen.losses += u64::from(after == Offline);
    }

    /// No value may be older than the request that it is said to answer.
    fn sample(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        if fresh.contains(Group::Current) {
            let current = sample.current.unwrap();
            let [low, high, ..] = current
                .value
                .as_array()
                .map(|reading| reading.raw().cast_unsigned());
            self.check_stamp(&current, u32::from(low) | u32::from(high) << 16);
            self.seen.fresh_states += 1;
        }
        for finger in Finger::ALL {
            if fresh.contains(Group::Tactile(finger)) {
                let block = sample.tactile[finger].unwrap();
                self.check_stamp(&block, block.value.raw[0]);
                self.seen.fresh_tips += 1;
            }
        }
        self.samples.push((now, *sample));
    }

    fn check_stamp<T>(&self, value: &Timed<T>, stamp: u32) {
        let made = stamped(stamp);
        let fresh = made.plus(STAMP_STEP) >= value.asked && made <= value.received;
        if !fresh {
            let sent = self.log.sent();
            let last = sent.get(sent.len().saturating_sub(12)..);
            println!("last requests: {last:#?}");
        }
        assert!(
            fresh,
            "seed {}: asked {:?}, received {:?}, but made {made:?}",
            self.seed, value.asked, value.received
        );
    }

    fn done(&mut self, ticket: Ticket, result: &Result<Outcome, RequestError>) {
        let request = self.open.remove(&ticket);
        assert!(
            request.is_some(),
            "seed {}: {ticket:?} answered twice or never asked",
            self.seed
        );
        if let (Some(Request::Read(asked)), Ok(Outcome::Memory { span, bytes })) = (request, result)
        {
            assert_eq!(
                (asked, usize::from(asked.len)),
                (*span, bytes.len()),
                "seed {}",
                self.seed
            );
        }
        self.seen.answers += 1;
    }

    /// The state that held at a moment, and those that began or ended in it.
    fn states_at(&self, at: Moment) -> impl Iterator<Item = LinkState> {
        let ended = self
            .states
            .iter()
            .rposition(|(since, _)| *since < at)
            .unwrap_or(0);
        self.states[ended..]
            .iter()
            .take_while(move |(since, _)| *since <= at)
            .map(|(_, state)| *state)
    }

    pub fn finish(&mut self, link: &LinkHandle, now: Moment) {
        let sent = self.log.sent();
        for frame in &sent {
            self.check_range(frame);
            self.check_motion(frame);
        }
        self.check_stops(&sent);
        self.check_recovery(link, now);
        let stats = link.stats();
        assert_eq!(stats.dropped_events, 0, "seed {}", self.seed);
        let status = link.status();
        assert!(
            !status.rival && status.disarmed != Some(Disarmed::Rival) && !status.echoes,
            "seed {}: nobody else was on the line: {status:?} {stats:?}",
            self.seed
        );
        assert!(
            self.seen.armed <= self.seen.arm_asks,
            "seed {}: armed by itself",
            self.seed
        );
        assert!(
            self.open.is_empty(),
            "seed {}: never answered: {:?}",
            self.seed,
            self.open
        );
        self.seen.disturbed +=
            stats.timeouts + stats.checksum_errors + stats.foreign_replies + stats.refusals;
    }

    /// No write outside the manual's addresses and ranges.
    fn check_range(&self, frame: &Sent) {
        let Some(mut rest) = frame.written.as_deref() else {
            return;
        };
        let mut at = frame.address;
        while !rest.is_empty() {
            let row = by_address(at).unwrap_or_else(|| panic!("seed {}: {frame:?}", self.seed));
            assert_eq!(
                row.access,
                Access::ReadWrite,
                "seed {}: {frame:?}",
                self.seed
            );
            let value = match row.element {
                Element::Byte => i32::from(rest[0]),
                _ => i32::from(i16::from_le_bytes([rest[0], rest[1]])),
            };
            assert!(row.allows(value), "seed {}: {frame:?}", self.seed);
            rest = &rest[usize::from(row.element_len())..];
            at += row.element_len();
        }
    }

    /// Motion only while armed; otherwise only a hold, which repeats what the hand said of itself.
    fn check_motion(&mut self, frame: &Sent) {
        if !frame.is_motion() {
            return;
        }
        if self
            .states_at(frame.at)
            .any(|state| state == LinkState::Armed)
        {
            self.seen.setpoint_frames += 1;
            return;
        }
        self.seen.hold_frames += 1;
        let state: Vec<_> = self.states_at(frame.at).collect();
        assert!(
            state.iter().any(|state| state.is_live()),
            "seed {}: {frame:?} {state:?}",
            self.seed
        );
        assert_eq!(
            frame.address, 1486,
            "seed {}: {frame:?} {state:?}",
            self.seed
        );
        let targets: Vec<i16> = frame
            .written
            .as_ref()
            .unwrap()
            .chunks(2)
            .map(|pair| i16::from_le_bytes([pair[0], pair[1]]))
            .collect();
        let known = self.samples.iter().any(|(at, sample)| {
            *at <= frame.at
                && sample.angle.is_some_and(|angle| {
                    angle
                        .value
                        .iter()
                        .zip(&targets)
                        .all(|((_, actual), target)| actual.raw() == *target)
                })
        });
        let leaves = targets.iter().all(|target| *target == -1);
        assert!(
            known || leaves,
            "seed {}: {frame:?} is no pose the hand was in",
            self.seed
        );
    }

    /// A stop is the next thing on the wire, unless the link is lost first.
    fn check_stops(&mut self, sent: &[Sent]) {
        for pressed in self.stops.clone() {
            let lost = self
                .states
                .iter()
                .find(|(at, state)| *at >= pressed && *state == LinkState::Offline);
            let lost = lost.map_or(Moment::from_micros(u64::MAX), |(at, _)| *at);
            let mut after = sent
                .iter()
                .filter(|frame| frame.at > pressed && frame.at < lost);
            let Some(next) = after.next() else { continue };
            // Within a stop that is under way, reads that watch for rest may come first.
            let already = self
                .states_at(pressed)
                .any(|state| state == LinkState::Holding);
            if !already {
                assert!(
                    next.is_motion() && next.address == 1486,
                    "seed {}: stop at {pressed:?}, then {next:?}",
                    self.seed
                );
            }
            self.seen.stops_seen += 1;
            self.check_repeats(pressed, lost, sent);
        }
    }

    /// Hold goes out again and again until rest is seen.
    fn check_repeats(&self, pressed: Moment, lost: Moment, sent: &[Sent]) {
        let end = self
            .states
            .iter()
            .find(|(at, state)| *at > pressed && *state != LinkState::Holding);
        let end = end.map_or(lost, |(at, _)| (*at).min(lost));
        let mut last = pressed;
        for frame in sent
            .iter()
            .filter(|frame| frame.at > pressed && frame.at < end && frame.is_motion())
        {
            assert!(
                frame.at.since(last) <= HOLD_GAP_MAX,
                "seed {}: hold paused at {last:?}",
                self.seed
            );
            last = frame.at;
        }
    }

    /// Without faults the link is live and fresh again, and every stop has ended in a verdict.
    fn check_recovery(&mut self, link: &LinkHandle, now: Moment) {
        let status = link.status();
        assert!(status.state.is_live(), "seed {}: {status:?}", self.seed);
        assert!(
            status.state != LinkState::Holding,
            "seed {}: {status:?} at {now:?}",
            self.seed
        );
        let (_, sample) = self.samples.last().unwrap();
        let age = sample.angle.unwrap().age(now);
        assert!(
            age < Duration::from_millis(300),
            "seed {}: the newest pose is {age:?} old",
            self.seed
        );
        self.seen.confirmed += u64::from(matches!(status.hold, Hold::Confirmed { .. }));
    }
}
