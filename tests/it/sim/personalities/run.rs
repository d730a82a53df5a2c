//! One row on one wire: connect, read all, arm, move, stop, and what must have held meanwhile.

use crate::setup::hand;
use crate::setup::link::{self, Client};
use crate::setup::time::in_virtual_time;
use crate::sim::personalities::wire::{self, Noted, Notes, Protocol};
use handscope::hand::Setpoints;
use handscope::hand::register::{Access, Element, by_address};
use handscope::hand::{Angle, Dof, Finger, Force, HandSample, Moment, PerDof, Speed, Target};
use handscope::link::{ArmRequest, Clock};
use handscope::record::{Hold, LinkState, Record};
use handscope::sim::{
    JournalEntry, Personality, ReplyUnit, SWITCHES, Scenario, SharedHand, SimConfig,
};
use std::time::Duration;
use tokio::time::{Instant, sleep_until};

/// A link must be live this soon, even where the power fails meanwhile.
const LIVE_WITHIN: Duration = Duration::from_secs(8);
/// How long a person lets the hand move before the stop.
const MOVES: Duration = Duration::from_millis(350);
/// A stop is confirmed or alarmed within this, and one exchange.
const STOP_WITHIN: Duration = Duration::from_millis(500 + 130);
/// The link waits at least this long for a reply.
const REPLY_LIMIT: Duration = Duration::from_millis(15);

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Verdict {
    pub(crate) connected: usize,
    pub(crate) armed: usize,
    pub(crate) stopped: usize,
    pub(crate) confirmed: usize,
    pub(crate) alarmed: usize,
    pub(crate) lost_meanwhile: usize,
    pub(crate) written: usize,
}

impl Verdict {
    pub(crate) fn add(&mut self, more: &Self) {
        self.connected += more.connected;
        self.armed += more.armed;
        self.stopped += more.stopped;
        self.confirmed += more.confirmed;
        self.alarmed += more.alarmed;
        self.lost_meanwhile += more.lost_meanwhile;
        self.written += more.written;
    }
}

pub(crate) fn spelled(row: &[usize]) -> String {
    let words = SWITCHES.iter().zip(row).filter(|(_, place)| **place > 0);
    let words = words.map(|(switch, place)| format!("{}={}", switch.name, switch.values[*place]));
    words.collect::<Vec<_>>().join(" ")
}

fn personality(row: &[usize]) -> Personality {
    let mut personality = Personality::default();
    for (switch, place) in SWITCHES.iter().zip(row) {
        personality.set(switch.name, switch.values[*place]).unwrap();
    }
    personality
}

pub(crate) fn judge(row: &[usize], protocol: Protocol) -> Verdict {
    in_virtual_time(async { Run::new(personality(row), protocol).judged().await })
}

struct Run {
    hand: SharedHand,
    link: Client,
    clock: Clock,
    notes: Notes,
    states: Vec<(Moment, LinkState)>,
    sample: HandSample,
    verdict: Verdict,
}

impl Run {
    fn new(personality: Personality, protocol: Protocol) -> Self {
        let hand = hand::begin(hand::free(SimConfig {
            scenario: Scenario::Idle,
            ..hand::like(personality)
        }));
        let notes = Notes::default();
        let unit = match personality.reply_unit {
            ReplyUnit::Echo => 1,
            ReplyUnit::Ff => 255,
            ReplyUnit::Zero => 0,
        };
        let config = link::config(&protocol.endpoint(unit), wire::dial(&hand, &notes));
        Self {
            hand,
            clock: config.clock,
            link: link::open(config),
            notes,
            states: vec![(Moment::ZERO, LinkState::Offline)],
            sample: HandSample::default(),
            verdict: Verdict::default(),
        }
    }

    async fn judged(mut self) -> Verdict {
        let whole = |run: &Self| {
            let sample = &run.sample;
            run.link.status().state.is_live()
                && sample.angle.is_some()
                && sample.temperature.is_some()
                && sample.speed_set.is_some()
                && Finger::ALL
                    .iter()
                    .all(|finger| sample.tactile[*finger].is_some())
        };
        assert!(
            self.until(LIVE_WITHIN, whole).await,
            "all groups are read: {:?} after {:?}",
            self.link.status(),
            self.states
        );
        self.verdict.connected = 1;
        assert!(self.journal().is_empty(), "connecting writes nothing");
        self.check_values();
        self.arm_and_move().await;
        self.check_writes();
        self.check_outstanding();
        self.verdict
    }

    /// Takes events until it is so, or the time is up.
    async fn until(&mut self, within: Duration, done: impl Fn(&Self) -> bool) -> bool {
        let end = Instant::now() + within;
        loop {
            if done(self) {
                return true;
            }
            let event = tokio::select! {
                biased;
                event = self.link.records.next() => event.expect("the session lives as long as its handle"),
                () = sleep_until(end) => return done(self),
            };
            match event {
                Record::Reading { sample, .. } => self.sample = *sample,
                Record::State { at, state } => self.states.push((at, state)),
                _ => {}
            }
        }
    }

    fn journal(&self) -> Vec<JournalEntry> {
        self.hand.with(|hand, _| hand.journal().to_vec())
    }

    /// What was read is what the hand is: open, at rest, at room temperature, without a fault.
    fn check_values(&self) {
        let angles = self.sample.angle.unwrap().value.map(|angle| angle.raw());
        assert_eq!(angles, PerDof::splat(1000));
        for (dof, celsius) in self.sample.temperature.unwrap().value.iter() {
            assert!(
                (20..50).contains(&celsius.raw()),
                "{dof:?}: {}",
                celsius.raw()
            );
        }
        for (dof, faults) in self.sample.faults.unwrap().value.iter() {
            assert!(faults.is_empty(), "{dof:?}: {faults:?}");
        }
    }

    async fn arm_and_move(&mut self) {
        let lost = |run: &Self| !run.link.status().state.is_live();
        let (speed, force) = (PerDof::splat(Speed::GENTLE), PerDof::splat(Force::GENTLE));
        self.link.arm(ArmRequest { speed, force });
        self.until(Duration::from_millis(800), |run| {
            run.link.status().armed.is_some() || lost(run)
        })
        .await;
        if let Some(epoch) = self.link.status().armed {
            self.verdict.armed = 1;
            let mut wish = Setpoints::none(epoch);
            for dof in Dof::ALL {
                wish.angle[dof] = Some(Target::Go(Angle::nearest(400)));
            }
            self.link.set(&wish);
            self.until(MOVES, lost).await;
        }
        if lost(self) {
            self.verdict.lost_meanwhile = 1;
            return;
        }
        self.link.stop();
        let ended = |run: &Self| {
            let hold = run.link.status().hold;
            matches!(hold, Hold::Confirmed { .. } | Hold::Alarm { .. }) || lost(run)
        };
        let pressed = self.clock.now();
        assert!(
            self.until(STOP_WITHIN, ended).await,
            "a stop ends in a verdict: {:?}",
            self.link.status()
        );
        if lost(self) {
            self.verdict.lost_meanwhile = 1;
            return;
        }
        self.verdict.stopped = 1;
        match self.link.status().hold {
            Hold::Confirmed { .. } => {
                self.verdict.confirmed = 1;
                self.check_rest(pressed).await;
            }
            _ => self.verdict.alarmed = 1,
        }
    }

    /// A stop that was confirmed is a stop.
    async fn check_rest(&mut self, pressed: Moment) {
        let angles = |run: &Self| run.sample.angle.unwrap().value.map(|angle| angle.raw());
        let before = angles(self);
        self.until(Duration::from_millis(300), |_| false).await;
        if !self.link.status().state.is_live() || self.sample.angle.is_none() {
            return;
        }
        for (dof, angle) in angles(self).iter() {
            let moved = angle.abs_diff(before[dof]);
            assert!(
                moved <= 6,
                "{dof:?} moved by {moved} after the stop at {pressed:?}"
            );
        }
    }

    fn states_around(&self, at: Moment) -> Vec<LinkState> {
        let began = self
            .states
            .iter()
            .rposition(|(since, _)| *since < at)
            .unwrap_or(0);
        let near = self.states[began..]
            .iter()
            .take_while(|(since, _)| *since <= at.plus(Duration::from_millis(20)));
        near.map(|(_, state)| *state).collect()
    }

    /// Only registers of the manual, only values in range, and motion only while armed or held.
    fn check_writes(&mut self) {
        for entry in self.journal() {
            self.verdict.written += 1;
            let (mut at, mut rest) = (entry.address, entry.bytes.as_slice());
            while !rest.is_empty() {
                let row = by_address(at).unwrap_or_else(|| panic!("{entry:?}"));
                assert_eq!(row.access, Access::ReadWrite, "{entry:?}");
                let value = match row.element {
                    Element::Byte => i32::from(rest[0]),
                    _ => i32::from(i16::from_le_bytes([rest[0], rest[1]])),
                };
                assert!(row.allows(value), "{entry:?}");
                rest = &rest[usize::from(row.element_len())..];
                at += row.element_len();
            }
            if (1474..=1497).contains(&entry.address) {
                let states = self.states_around(entry.at);
                let allowed =
                    |state: &LinkState| matches!(state, LinkState::Armed | LinkState::Holding);
                assert!(states.iter().any(allowed), "{entry:?} in {states:?}");
            }
        }
    }

    /// Nothing is sent while an answer is awaited, unless it was waited for long enough.
    fn check_outstanding(&self) {
        let mut open: Option<Instant> = None;
        for note in self.notes.lock().unwrap().iter() {
            match note {
                Noted::Heard(_) | Noted::Dialled => open = None,
                Noted::Sent(at) => {
                    if let Some(since) = open {
                        let waited = at.duration_since(since);
                        assert!(waited >= REPLY_LIMIT, "asked again after {waited:?}");
                    }
                    open = Some(*at);
                }
            }
        }
    }
}
