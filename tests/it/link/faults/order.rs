//! What must hold for the order and the times of what was on the wire: stop before hold before setpoints before jobs
//! before polls, nothing left out for long, and back in time.

use crate::link::faults::tap::Sent;
use crate::setup::body::{Protocol, tip_span};
use handscope::hand::{Finger, Moment};
use handscope::record::LinkState;
use std::ops::Range;
use std::time::Duration;

/// Registers by their addresses (manual 2.4): the state that a stop watches, and the angles in it.
const STATE: Range<u16> = 1534..1624;
const ANGLES: Range<u16> = 1546..1558;
/// Setpoints that the hand holds.
const SETTINGS: Range<u16> = 1486..1522;
/// What only jobs ask for.
const JOBS_END: u16 = 1070;
/// A stop that is not confirmed by then raises the alarm.
const ALARM: Duration = Duration::from_millis(500);
/// Reads of anything but the pose that a wish waits for: one may have its turn between rounds.
const OTHERS_BEFORE_WISH: usize = 1;
/// Rounds of setpoints keep this distance.
const ROUND: Duration = Duration::from_millis(20);
/// Live, and not asked for so long, is starved: a question that late replies may answer waits for two seconds after the
/// last of them, with faults for one and a half before.
const ASKED_WITHIN: Duration = Duration::from_millis(3600);
/// A wire that is back is live again within this …
const BACK_WITHIN: Duration = Duration::from_secs(2);
/// … and a wish is on the wire within this, on a wire without faults.
const SENT_WITHIN: Duration = Duration::from_secs(1);

/// A target that somebody set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wish {
    pub(crate) at: Moment,
    pub(crate) joint: usize,
    pub(crate) angle: i16,
    /// States told until then.
    pub(crate) states: usize,
}

/// All of one schedule.
pub(crate) struct Story<'a> {
    pub(crate) seed: u64,
    pub(crate) protocol: Protocol,
    pub(crate) sent: &'a [Sent],
    pub(crate) states: &'a [(Moment, LinkState)],
    pub(crate) wishes: &'a [Wish],
    /// From asking to the answer.
    pub(crate) jobs: &'a [(Moment, Moment)],
    /// The end of the faults, and of all.
    pub(crate) quiet: Moment,
    pub(crate) end: Moment,
}

impl Story<'_> {
    pub(crate) fn check(&self) {
        let exchanges = self.exchanges();
        self.only_the_state_is_read_while_holding(&exchanges);
        self.setpoints_go_before_jobs_and_polls(&exchanges);
        self.jobs_go_before_polls(&exchanges);
        self.nothing_starves(&exchanges);
        self.it_is_back_in_time();
    }

    /// Requests; the pieces of one read are one.
    fn exchanges(&self) -> Vec<Sent> {
        let mut all: Vec<Sent> = Vec::with_capacity(self.sent.len());
        for sent in self.sent {
            match all.last_mut() {
                Some(last)
                    if self.protocol.in_pieces()
                        && last.written.is_none()
                        && sent.written.is_none()
                        && last.address + last.len == sent.address
                        && last.len + sent.len <= 252 =>
                {
                    last.len += sent.len;
                }
                _ => all.push(sent.clone()),
            }
        }
        all
    }

    fn between(all: &[Sent], after: Moment, before: Moment) -> &[Sent] {
        let from = all.partition_point(|sent| sent.at <= after);
        let to = all.partition_point(|sent| sent.at < before).max(from);
        &all[from..to]
    }

    /// The first change away from this state.
    fn leaves(&self, state: LinkState, after: Moment) -> Moment {
        let mut later = self.states.iter().filter(|(at, _)| *at > after);
        later
            .find(|(_, to)| *to != state)
            .map_or(self.end, |(at, _)| *at)
    }

    fn disarmed(&self, wish: &Wish) -> Moment {
        let mut later = self.states[wish.states..].iter();
        later
            .find(|(_, to)| *to != LinkState::Armed)
            .map_or(self.end, |(at, _)| *at)
    }

    fn only_the_state_is_read_while_holding(&self, exchanges: &[Sent]) {
        for (at, state) in self.states {
            if *state != LinkState::Holding {
                continue;
            }
            // After the alarm the rest is read in turns again.
            let until = self.leaves(*state, *at).min(at.plus(ALARM));
            for sent in Self::between(exchanges, *at, until) {
                assert!(
                    sent.asks_in(STATE) || sent.is_motion(),
                    "seed {}: holding since {at:?}, but {sent:?}",
                    self.seed
                );
            }
        }
    }

    fn setpoints_go_before_jobs_and_polls(&self, exchanges: &[Sent]) {
        for (n, wish) in self.wishes.iter().enumerate() {
            let newer = self.wishes[n + 1..]
                .iter()
                .find(|newer| newer.joint == wish.joint);
            let given_up = newer
                .map_or(self.end, |newer| newer.at)
                .min(self.disarmed(wish));
            // The session may have had its turn behind the wish in the same instant.
            let from = self.sent.partition_point(|sent| sent.at < wish.at);
            let waits = self.sent[from..]
                .iter()
                .take_while(|sent| sent.at < given_up);
            let sent = waits.into_iter().find(|sent| carries(sent, wish));
            let until = sent.map_or(given_up, |sent| sent.at);
            let late = until == self.end && self.end.since(wish.at) > SENT_WITHIN;
            assert!(!late, "seed {}: {wish:?} was never sent", self.seed);
            let mut others = Self::between(exchanges, wish.at.plus(ROUND), until)
                .iter()
                .filter(|other| !other.is_setpoint() && !other.asks_in(ANGLES));
            if let Some(job) = others.clone().find(|other| other.address < JOBS_END) {
                panic!("seed {}: {job:?} before {wish:?}", self.seed);
            }
            // Over TCP the setpoints that the hand holds are looked at before a round: the one that is under way, and the wish's own.
            let looks = if self.protocol == Protocol::Tcp { 2 } else { 0 };
            let other = others.nth(OTHERS_BEFORE_WISH + looks);
            assert!(
                other.is_none(),
                "seed {}: {other:?} before {wish:?}",
                self.seed
            );
        }
    }

    fn jobs_go_before_polls(&self, exchanges: &[Sent]) {
        for (asked, done) in self.jobs {
            // A round of setpoints may wait for a read of anything, and goes before a job.
            let (mut rounds, mut polls) = (0, 0);
            for other in Self::between(exchanges, *asked, *done) {
                let is_poll = other.asks().is_some_and(|asks| asks.start >= JOBS_END);
                rounds += usize::from(other.is_setpoint());
                polls += usize::from(is_poll && !other.asks_in(STATE));
                assert!(
                    polls <= rounds + 1,
                    "seed {}: {other:?} while a job waits since {asked:?}",
                    self.seed
                );
            }
        }
    }

    /// Each group is asked for again and again while the link is live and nothing is held.
    fn nothing_starves(&self, exchanges: &[Sent]) {
        let mut groups = vec![ANGLES, SETTINGS];
        groups.extend(Finger::ALL.map(|finger| {
            let tip = tip_span(finger);
            tip.address..tip.address + tip.len
        }));
        let mut since = Moment::ZERO;
        let mut spell = false;
        let mut spells = Vec::new();
        for (at, state) in self.states.iter().chain([&(self.end, LinkState::Offline)]) {
            let polls = state.is_live() && *state != LinkState::Holding;
            if polls && !spell {
                since = *at;
            } else if spell && !polls {
                spells.push((since, *at));
            }
            spell = polls;
        }
        for (from, to) in spells {
            if to.since(from) <= ASKED_WITHIN {
                continue;
            }
            let asked = Self::between(exchanges, from, to);
            for group in &groups {
                let mut last = from;
                let asks = asked
                    .iter()
                    .filter(|sent| sent.asks_in(group.clone()))
                    .map(|sent| sent.at);
                for at in asks.chain([to]) {
                    assert!(
                        at.since(last) <= ASKED_WITHIN,
                        "seed {}: {group:?} not asked for from {last:?} to {at:?}",
                        self.seed
                    );
                    last = at;
                }
            }
        }
    }

    fn it_is_back_in_time(&self) {
        let mut gone: Option<Moment> = None;
        for (at, state) in self
            .states
            .iter()
            .chain([&(self.end, LinkState::Monitoring)])
        {
            match (*state, gone) {
                (LinkState::Offline, _) => gone = Some(*at),
                (state, Some(since)) if state.is_live() => {
                    let back = since.max(self.quiet);
                    assert!(
                        at.since(back) <= BACK_WITHIN,
                        "seed {}: gone at {since:?}, could be back from {back:?}, live at {at:?}",
                        self.seed
                    );
                    gone = None;
                }
                _ => {}
            }
        }
    }
}

fn carries(sent: &Sent, wish: &Wish) -> bool {
    let at = 1486 + 2 * u16::try_from(wish.joint).unwrap();
    let Some(from) = at.checked_sub(sent.address) else {
        return false;
    };
    let bytes = sent.written.as_deref().unwrap_or_default();
    bytes.get(usize::from(from)..usize::from(from) + 2) == Some(&wish.angle.to_le_bytes())
}
