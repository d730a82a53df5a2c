//! What must hold on every schedule, whatever the faults: checked on the wire's log and on the events.

use crate::link::faults::order::{Story, Wish};
use crate::link::faults::tap::{Log, Sent};
use crate::setup::body::{Protocol, STAMPS_END, stamped};
use crate::setup::link::Client;
use handscope::hand::register::{Access, Element, by_address};
use handscope::hand::{
    AngleReading, Dof, Finger, Group, Groups, HandCommand, HandSample, Moment, PerDof, Span,
    Target, Timed,
};
use handscope::link::{Lease, LinkHandle, LinkStatus, RequestError, STOP_PENDING};
use handscope::record::{Disarmed, Hold, LinkState, Record};
use std::collections::BTreeMap;
use std::time::Duration;

/// The stamp is cut to a tenth of a millisecond.
const STAMP_STEP: Duration = Duration::from_micros(100);
/// Hold frames are at most this far apart: the repeat, and one exchange that was under way …
const HOLD_GAP_MAX: Duration = Duration::from_millis(40 + 350);
/// … and over Modbus TCP, once replies were late, the longest wait for an acknowledgement and for a pose between two frames.
const HOLD_GAP_MAX_SLOW: Duration = Duration::from_millis(40 + 425 + 425);
/// … which over CAN is a read of eleven pieces through an adapter, and a hold of two.
const HOLD_GAP_MAX_PIECES: Duration = Duration::from_millis(40 + 500 + 160);
/// A stop is confirmed or raises its alarm within this.
const VERDICT_WITHIN: Duration = Duration::from_millis(500);
/// Without faults every group is newer than this, on the slowest wire: forty pieces of a fingertip sweep at 15 ms each.
const FRESH_WITHIN: Duration = Duration::from_millis(2200);
/// Without faults the pose is newer than this …
const POSE_WITHIN: Duration = Duration::from_millis(300);
/// … and in pieces within one round of all groups at full rates: seventy pieces, with a slow adapter at 20 ms each.
const POSE_WITHIN_PIECES: Duration = Duration::from_millis(1400);

/// After a stop that is called confirmed no joint moves by more than this, counts of ANGLE_ACT: a joint whose feedback froze
/// right before the stop is held where it was seen last.
const RESTS_WITHIN: f64 = 60.0;
/// A pose that is expected, not read, is one in which the joints were by so many counts …
const EXPECTED_COUNTS: f64 = 20.0;
/// … not longer ago than this: a hold of it is repeated.
const EXPECTED_WITHIN: Duration = Duration::from_secs(1);
/// Joints in doubt get frames for this long, and then nothing more.
const DOUBTED_HOLD: Duration = Duration::from_millis(250);
/// A joint that another controller moves arrives within this.
const UNSEEN_MOVE: Duration = Duration::from_secs(2);
/// Writes through a wire that is gone may act so long afterwards.
const LATE: Duration = Duration::from_millis(2500);

/// One thing asked of the hand.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Request {
    Command(HandCommand),
    Read(Span),
}

/// The bytes that were read; none of a command.
pub(crate) type Answer = Result<Vec<u8>, RequestError>;

impl Request {
    pub(crate) async fn answer(self, link: LinkHandle, lease: Lease) -> Answer {
        match self {
            Self::Command(command) if command.is_motion() => link.write_as(lease, command).await?,
            Self::Command(command) => link.write(command).await?,
            Self::Read(span) => return link.read(span).await,
        }
        Ok(Vec::new())
    }
}

/// How often the oracles had something to judge.
#[derive(Debug, Clone, Default)]
pub(crate) struct Seen {
    pub(crate) wires: BTreeMap<Protocol, u64>,
    pub(crate) faults: u64,
    pub(crate) fresh_states: u64,
    pub(crate) fresh_tips: u64,
    pub(crate) wishes: u64,
    pub(crate) setpoint_frames: u64,
    pub(crate) hold_frames: u64,
    pub(crate) arm_asks: u64,
    pub(crate) armed: u64,
    pub(crate) stops_pressed: u64,
    pub(crate) stops_seen: u64,
    pub(crate) stops_kept: u64,
    pub(crate) confirmed: u64,
    pub(crate) losses: u64,
    pub(crate) reconnects: u64,
    pub(crate) answers: u64,
    pub(crate) full: u64,
    pub(crate) disturbed: u64,
    pub(crate) freezes: u64,
    pub(crate) doubts: u64,
    pub(crate) foreign_writes: u64,
    pub(crate) foreign_noticed: u64,
    pub(crate) rests: u64,
}

impl Seen {
    pub(crate) fn add(&mut self, more: &Self) {
        for (wire, schedules) in &more.wires {
            *self.wires.entry(*wire).or_default() += schedules;
        }
        self.faults += more.faults;
        self.fresh_states += more.fresh_states;
        self.fresh_tips += more.fresh_tips;
        self.wishes += more.wishes;
        self.setpoint_frames += more.setpoint_frames;
        self.hold_frames += more.hold_frames;
        self.arm_asks += more.arm_asks;
        self.armed += more.armed;
        self.stops_pressed += more.stops_pressed;
        self.stops_seen += more.stops_seen;
        self.stops_kept += more.stops_kept;
        self.confirmed += more.confirmed;
        self.losses += more.losses;
        self.reconnects += more.reconnects;
        self.answers += more.answers;
        self.full += more.full;
        self.disturbed += more.disturbed;
        self.freezes += more.freezes;
        self.doubts += more.doubts;
        self.foreign_writes += more.foreign_writes;
        self.foreign_noticed += more.foreign_noticed;
        self.rests += more.rests;
    }
}

/// Watches one schedule.
pub(crate) struct Witness {
    seed: u64,
    protocol: Protocol,
    log: Log,
    pub(crate) seen: Seen,
    states: Vec<(Moment, LinkState)>,
    poses: Vec<(Moment, PerDof<AngleReading>)>,
    newest: HandSample,
    stops: Vec<Moment>,
    /// All presses, also those without a live hand.
    presses: Vec<Moment>,
    open: BTreeMap<u64, (Moment, Request)>,
    jobs: Vec<(Moment, Moment)>,
    wishes: Vec<Wish>,
    quiet: Moment,
    /// The adapter gives back what is sent.
    pub(crate) echoes: bool,
    /// Feedback may freeze, and carries no stamps then.
    pub(crate) freezes: bool,
    /// Another program writes.
    pub(crate) foreign: bool,
    foreign_writes: Vec<Moment>,
    /// Where the hand's joints really were.
    reality: Vec<(Moment, PerDof<f64>)>,
    noticed: bool,
    doubted: bool,
}

impl Witness {
    pub(crate) fn new(seed: u64, protocol: Protocol, log: Log) -> Self {
        Self {
            seed,
            protocol,
            log,
            seen: Seen {
                wires: BTreeMap::from([(protocol, 1)]),
                ..Seen::default()
            },
            states: vec![(Moment::ZERO, LinkState::Offline)],
            poses: Vec::new(),
            newest: HandSample::default(),
            stops: Vec::new(),
            presses: Vec::new(),
            open: BTreeMap::new(),
            jobs: Vec::new(),
            wishes: Vec::new(),
            quiet: Moment::ZERO,
            echoes: false,
            freezes: false,
            foreign: false,
            foreign_writes: Vec::new(),
            reality: Vec::new(),
            noticed: false,
            doubted: false,
        }
    }

    pub(crate) fn reality(&mut self, joints: PerDof<f64>, now: Moment) {
        self.reality.push((now, joints));
    }

    pub(crate) fn foreign_write(&mut self, now: Moment) {
        self.seen.foreign_writes += 1;
        self.foreign_writes.push(now);
    }

    pub(crate) fn status(&mut self, status: &LinkStatus) {
        self.noticed |= status.other_controller;
        self.doubted |= status.feedback_in_doubt;
    }

    /// What is called a confirmed stop is one: the joints stay, until somebody moves the hand again.
    fn check_rests(&mut self, sent: &[Sent]) {
        let confirmed = self.states.windows(2).filter(|two| {
            two[0].1 == LinkState::Holding
                && matches!(two[1].1, LinkState::Monitoring | LinkState::Fault)
        });
        for at in confirmed.map(|two| two[1].0) {
            let lost = |(since, state): &(Moment, LinkState)| {
                *state == LinkState::Offline && *since <= at && at.since(*since) < LATE
            };
            if self.states.iter().skip(1).any(lost) {
                continue;
            }
            // Where another moves a hand whose feedback is frozen, nobody can know that it moves, nor from where.
            let unseen = |told: &Moment| *told <= at && at.since(*told) < UNSEEN_MOVE;
            if self.freezes && self.foreign_writes.iter().any(unseen) {
                continue;
            }
            let moved = |(since, state): &&(Moment, LinkState)| {
                *since >= at && matches!(state, LinkState::Armed | LinkState::Offline)
            };
            let armed = self.states.iter().find(moved).map(|(since, _)| *since);
            let told = |since: &&Moment| since.plus(Duration::from_millis(200)) >= at;
            let told = self.foreign_writes.iter().find(told).copied();
            let ends = [armed, told].into_iter().flatten().min();
            let ends = ends.unwrap_or(Moment::from_micros(u64::MAX));
            let mut after = self.reality.iter().filter(|(t, _)| *t >= at && *t < ends);
            let Some((_, rest)) = after.next() else {
                continue;
            };
            for (t, joints) in after {
                for (dof, angle) in joints.iter() {
                    let stays = (angle - rest[dof]).abs() <= RESTS_WITHIN;
                    if !stays {
                        self.tell_way(dof, *t, sent);
                    }
                    assert!(
                        stays,
                        "seed {}: a stop was called confirmed at {at:?}, and {dof:?} moves from {} to {angle} at {t:?}",
                        self.seed, rest[dof]
                    );
                }
            }
            self.seen.rests += 1;
        }
    }

    /// Prints where a joint was in the last second before this moment, where it was seen, and what it was told.
    fn tell_way(&self, dof: Dof, until: Moment, sent: &[Sent]) {
        let is_near = |at: Moment| at <= until && until.since(at) < Duration::from_secs(1);
        let mut lines = Vec::new();
        for (at, joints) in self.reality.iter().filter(|(at, _)| is_near(*at)) {
            lines.push((*at, format!("is at {:.0}", joints[dof])));
        }
        for (at, seen) in self.poses.iter().filter(|(at, _)| is_near(*at)) {
            lines.push((*at, format!("seen at {}", seen[dof].raw())));
        }
        for (at, state) in self.states.iter().filter(|(at, _)| is_near(*at)) {
            lines.push((*at, format!("{state:?}")));
        }
        for sent in sent.iter().filter(|sent| is_near(sent.at)) {
            if let Some(bytes) = &sent.written {
                lines.push((sent.at, format!("{} {bytes:?}", sent.address)));
            }
        }
        lines.sort();
        for (at, what) in lines {
            println!("{at:?} {what}");
        }
    }

    /// Prints all that was sent, asked and seen, in the order of time, for whoever replays a seed.
    fn print_story(&self, sent: &[Sent]) {
        let frames = sent.iter().map(|frame| match &frame.written {
            Some(bytes) => (frame.at, format!("writes {} {bytes:?}", frame.address)),
            None => (frame.at, format!("reads {} +{}", frame.address, frame.len)),
        });
        let states = self.states.iter();
        let states = states.map(|(at, state)| (*at, format!("{state:?}")));
        let poses = self.poses.iter().map(|(at, pose)| {
            let raw = pose.as_array().map(|angle| angle.raw());
            (*at, format!("seen at {raw:?}"))
        });
        let presses = self.presses.iter().map(|at| (*at, "STOP".to_owned()));
        let jobs = self.jobs.iter();
        let jobs =
            jobs.map(|(asked, done)| (*done, format!("answers what was asked at {asked:?}")));
        let quiet = [(self.quiet, "the faults end".to_owned())];
        let truly = self.reality.iter().map(|(at, joints)| {
            let rounded = joints.as_array().map(|angle| angle.round() as i16);
            (*at, format!("is at {rounded:?}"))
        });
        let all = frames
            .chain(states)
            .chain(poses)
            .chain(presses)
            .chain(truly);
        let mut lines: Vec<(Moment, String)> = all.chain(jobs).chain(quiet).collect();
        lines.sort();
        lines.dedup();
        for (at, what) in lines {
            println!("{at:?} {what}");
        }
    }

    /// The faults end.
    pub(crate) fn quiet(&mut self, now: Moment) {
        self.quiet = now;
    }

    pub(crate) fn wished(&mut self, wishes: &PerDof<Option<Target>>, now: Moment) {
        for (dof, wish) in wishes.iter() {
            if let Some(Target::Go(angle)) = wish {
                self.seen.wishes += 1;
                self.wishes.push(Wish {
                    at: now,
                    joint: dof.index(),
                    angle: angle.get(),
                    states: self.states.len(),
                });
            }
        }
    }

    pub(crate) fn stop_pressed(&mut self, link: &Client, now: Moment) {
        self.presses.push(now);
        if link.status().state.is_live() {
            self.stops.push(now);
            self.seen.stops_pressed += 1;
        }
    }

    pub(crate) fn asked(&mut self, number: u64, request: Request, now: Moment) {
        self.open.insert(number, (now, request));
    }

    pub(crate) fn record(&mut self, record: &Record, now: Moment) {
        match record {
            Record::Reading { sample, fresh } => self.sample(sample, *fresh, now),
            Record::State { at, state } => {
                let (_, before) = *self.states.last().unwrap();
                self.transition(before, *state);
                self.states.push((*at, *state));
            }
            Record::ArmRefused { .. } | Record::Sent { .. } | Record::Answered { .. } => {}
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
            for (_, reading) in current.value.iter() {
                self.check_stamp(&current, u32::from(reading.raw().cast_unsigned()));
            }
            self.seen.fresh_states += 1;
        }
        if fresh.contains(Group::Force) {
            let force = sample.force.unwrap();
            for (_, reading) in force.value.iter() {
                self.check_stamp(&force, u32::from(reading.raw().cast_unsigned()));
            }
        }
        for finger in Finger::ALL {
            if fresh.contains(Group::Tactile(finger)) {
                let block = sample.tactile[finger].unwrap();
                for stamp in block.value.raw {
                    self.check_stamp(&block, stamp);
                }
                self.seen.fresh_tips += 1;
            }
        }
        if let Some(angle) = sample.angle
            && fresh.contains(Group::Angle)
        {
            self.poses.push((now, angle.value));
        }
        self.newest = *sample;
    }

    fn check_stamp<T>(&self, value: &Timed<T>, stamp: u32) {
        let made = stamped(stamp);
        let in_time = made.plus(STAMP_STEP) >= value.asked && made <= value.received;
        let fresh = self.freezes || in_time;
        if !fresh {
            let sent = self.log.take();
            let last = sent.get(sent.len().saturating_sub(12)..);
            println!("last requests: {last:#?}");
        }
        assert!(
            fresh,
            "seed {}: asked {:?}, received {:?}, but made {made:?}",
            self.seed, value.asked, value.received
        );
    }

    pub(crate) fn answered(&mut self, number: u64, answer: &Answer, now: Moment) {
        let Some((since, request)) = self.open.remove(&number) else {
            panic!("seed {}: {number} answered twice or never asked", self.seed)
        };
        self.jobs.push((since, now));
        if let (Request::Read(span), Ok(bytes)) = (request, answer) {
            assert_eq!(usize::from(span.len), bytes.len(), "seed {}", self.seed);
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

    pub(crate) fn finish(&mut self, link: &Client, now: Moment) {
        assert!(now.since(Moment::ZERO) < STAMPS_END);
        let sent = self.log.take();
        if std::env::var_os("HANDSCOPE_SEED").is_some() {
            self.print_story(&sent);
        }
        for frame in &sent {
            self.check_range(frame);
            self.check_motion(frame);
        }
        self.check_stops(&sent);
        self.check_kept_stops(&sent);
        self.check_recovery(link, now);
        self.check_rests(&sent);
        self.story(&sent, now).check();
        let stats = link.stats();
        self.seen.reconnects += stats.reconnects;
        assert_eq!(stats.dropped_events, 0, "seed {}", self.seed);
        let status = link.status();
        self.status(&status);
        self.seen.foreign_noticed += u64::from(self.noticed);
        self.seen.doubts += u64::from(self.doubted);
        assert!(
            self.freezes || !self.doubted && status.disarmed != Some(Disarmed::FrozenFeedback),
            "seed {}: nothing was frozen: {status:?}",
            self.seed
        );
        assert!(
            (self.foreign || !self.noticed && status.disarmed != Some(Disarmed::OtherController))
                && (self.echoes || !status.echoes),
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

    fn story<'a>(&'a self, sent: &'a [Sent], end: Moment) -> Story<'a> {
        Story {
            seed: self.seed,
            protocol: self.protocol,
            sent,
            states: &self.states,
            wishes: &self.wishes,
            jobs: &self.jobs,
            quiet: self.quiet,
            end,
        }
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
        let second = self.protocol.in_pieces() && frame.address == 1494;
        assert!(
            frame.address == 1486 || second,
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
        let first = usize::from(frame.address - 1486) / 2;
        let before = self.poses.partition_point(|(at, _)| *at <= frame.at);
        let known = self.poses[..before].iter().rev().any(|(_, pose)| {
            let pose = pose.as_array().map(|angle| angle.raw());
            pose[first..].starts_with(&targets)
        });
        let leaves = targets.iter().all(|target| *target == -1);
        // Slow replies are learnt over Modbus TCP alone. The pose is then where the joints are by now as far as is known: on the way
        // that they just went.
        let is_recent = |at: Moment| at <= frame.at && frame.at.since(at) <= EXPECTED_WITHIN;
        let lately = self.reality.iter().filter(|(at, _)| is_recent(*at));
        let lately: Vec<[f64; 6]> = lately.map(|(_, joints)| *joints.as_array()).collect();
        let newest = self.poses[..before].last();
        let was_there = |(joint, target): (usize, &i16)| {
            let is_read = newest.is_some_and(|(_, pose)| pose.as_array()[joint].raw() == *target);
            let lately = || lately.iter().map(|joints| joints[joint]);
            let (least, most) = (
                lately().fold(f64::MAX, f64::min),
                lately().fold(f64::MIN, f64::max),
            );
            let way = least - EXPECTED_COUNTS..=most + EXPECTED_COUNTS;
            is_read || way.contains(&f64::from(*target))
        };
        // What was told here says nothing of where joints are that another moves.
        let is_foreign = |told: &Moment| *told <= frame.at && frame.at.since(*told) < UNSEEN_MOVE;
        let expected = || {
            self.protocol == Protocol::Tcp
                && ((first..).zip(&targets).all(was_there)
                    || self.foreign_writes.iter().any(is_foreign))
        };
        // Where feedback is in doubt the pose is reckoned: where the joints then are is judged instead.
        assert!(
            known || leaves || self.freezes || expected(),
            "seed {}: {frame:?} is no pose the hand was in: {:?}",
            self.seed,
            self.reality.iter().rfind(|(at, _)| *at <= frame.at),
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
            let under_way = sent.iter().rfind(|frame| frame.at <= pressed);
            let mut after = sent
                .iter()
                .filter(|frame| frame.at > pressed && frame.at < lost)
                .skip_while(|frame| under_way.is_some_and(|write| self.completes(frame, write)));
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

    /// A stop that feedback had not confirmed when the link was lost, or that was pressed while it was, comes first when the hand is
    /// back in time.
    fn check_kept_stops(&mut self, sent: &[Sent]) {
        for pressed in self.presses.clone() {
            let from = self.states.partition_point(|(at, _)| *at <= pressed);
            let before = from.saturating_sub(1);
            let is_confirmed =
                |two: &[(Moment, LinkState)]| two[0].1 == LinkState::Holding && two[1].1.is_live();
            let lost = self.states[before..]
                .iter()
                .position(|(_, state)| !state.is_live());
            let Some(lost) = lost.map(|lost| before + lost) else {
                continue;
            };
            if self.states[before..lost].windows(2).any(is_confirmed) {
                continue;
            }
            let since = self.states[lost].0.max(pressed);
            let back = self.states[lost..]
                .iter()
                .position(|(_, state)| state.is_live());
            let Some(back) = back.map(|back| lost + back) else {
                continue;
            };
            let (at, _) = self.states[back];
            if at.since(since) > STOP_PENDING {
                continue;
            }
            let next = self.states.get(back + 1);
            assert!(
                next.is_some_and(|(then, state)| *then == at && *state == LinkState::Holding),
                "seed {}: the stop at {pressed:?} is forgotten at {at:?}: {next:?}",
                self.seed
            );
            let written = sent
                .iter()
                .find(|frame| frame.at >= at && frame.written.is_some());
            assert!(
                written.is_none_or(|frame| frame.address == 1486),
                "seed {}: the stop at {pressed:?} does not come first at {at:?}: {written:?}",
                self.seed
            );
            self.seen.stops_kept += 1;
        }
    }

    /// True for the second piece of a write that was under way.
    fn completes(&self, frame: &Sent, write: &Sent) -> bool {
        self.protocol.in_pieces()
            && frame.written.is_some()
            && write.written.is_some()
            && frame.address == write.address + 8
    }

    /// Hold goes out again and again until rest is seen.
    fn check_repeats(&self, pressed: Moment, lost: Moment, sent: &[Sent]) {
        let end = self
            .states
            .iter()
            .find(|(at, state)| *at > pressed && *state != LinkState::Holding);
        let end = end.map_or(lost, |(at, _)| (*at).min(lost));
        let longest = match self.protocol {
            Protocol::Tcp => HOLD_GAP_MAX_SLOW,
            protocol if protocol.in_pieces() => HOLD_GAP_MAX_PIECES,
            _ => HOLD_GAP_MAX,
        };
        let mut last = pressed;
        // An earlier stop may have begun these frames.
        let begun = self.states.iter().rfind(|(at, _)| *at <= pressed);
        let begun = begun.filter(|(_, state)| *state == LinkState::Holding);
        let begun = begun.map_or(pressed, |(at, _)| *at);
        for frame in sent
            .iter()
            .filter(|frame| frame.at > pressed && frame.at < end && frame.is_motion())
        {
            assert!(
                frame.at.since(last) <= longest
                    || self.freezes && last.since(begun) >= DOUBTED_HOLD,
                "seed {}: hold paused at {last:?}",
                self.seed
            );
            last = frame.at;
        }
    }

    /// Without faults the link is live and fresh again, and every stop has ended in a verdict.
    fn check_recovery(&mut self, link: &Client, now: Moment) {
        let status = link.status();
        assert!(status.state.is_live(), "seed {}: {status:?}", self.seed);
        // A joint in doubt that rests shows by nothing that its angle is true again.
        let is_doubted = self.freezes && status.feedback_in_doubt;
        // A pose that grew old stops the hand, at any time where replies come in slow pieces.
        let is_new = now.since(status.since) < VERDICT_WITHIN;
        assert!(
            status.state != LinkState::Holding
                || is_new && status.disarmed == Some(Disarmed::Stale)
                || is_doubted && matches!(status.hold, Hold::Alarm { .. }),
            "seed {}: {status:?} at {now:?}",
            self.seed
        );
        let longest = if self.protocol.in_pieces() {
            POSE_WITHIN_PIECES
        } else {
            POSE_WITHIN
        };
        self.check_age("angle", self.newest.angle.as_ref(), now, longest);
        self.check_freshness(now);
        self.seen.confirmed += u64::from(matches!(status.hold, Hold::Confirmed { .. }));
    }

    fn check_freshness(&self, now: Moment) {
        let HandSample {
            angle_set,
            force_set,
            speed_set,
            force,
            current,
            faults,
            status,
            temperature,
            tactile,
            ..
        } = &self.newest;
        let longest = FRESH_WITHIN;
        self.check_age("angle_set", angle_set.as_ref(), now, longest);
        self.check_age("force_set", force_set.as_ref(), now, longest);
        self.check_age("speed_set", speed_set.as_ref(), now, longest);
        self.check_age("force", force.as_ref(), now, longest);
        self.check_age("current", current.as_ref(), now, longest);
        self.check_age("faults", faults.as_ref(), now, longest);
        self.check_age("status", status.as_ref(), now, longest);
        self.check_age("temperature", temperature.as_ref(), now, longest);
        for (finger, block) in tactile.iter() {
            self.check_age(&format!("{finger:?}"), block.as_ref(), now, longest);
        }
    }

    fn check_age<T>(&self, name: &str, value: Option<&Timed<T>>, now: Moment, longest: Duration) {
        let age = value.map(|value| value.age(now));
        assert!(
            age.is_some_and(|age| age < longest),
            "seed {}: {name} is {age:?} old",
            self.seed
        );
    }
}
