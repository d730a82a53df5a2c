//! What to read next, and when. Pure: time, answers and failures come in, spans go out; nothing is sent here.
//!
//! Each part of memory has its own rate. The part that waited longest, measured in its own periods, opens a window,
//! and others that are wanted too join it where that is cheaper (`link::poll::window`). How long a window may be
//! follows from the stop (`link::poll::cost`): so long that a stop is still in time behind it. While something moves
//! and nobody asks for more states than usual, some fingertips come at once. The motion state then has every second turn
//! at least, or every third where fingertips come first, and brings what the drives say along where there is room.

use crate::hand::feedback::group::TIP_BYTES;
use crate::hand::{Moment, RateClass, Span};
use crate::link::poll::cost::{Turnaround, WireCost};
use crate::link::poll::window::{Gaps, Joining, ReadPart, SHAPES_MAX};
use crate::link::quirks::GapRead;
use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Parts that are wanted without limit count as this fast when they are weighed against slow ones …
const SHORTEST_PERIOD: Duration = Duration::from_millis(10);
/// … and slow ones as this fast, so that on a line that is too slow for all they do not wait for many of their periods.
const LONGEST_PERIOD: Duration = Duration::from_millis(30);
/// What waits so long is as urgent as the fastest: a sweep over all fingertips takes a slow hand on CAN most of a second.
const STARVATION_TIMEOUT: Duration = Duration::from_secs(1);
/// Temperatures change slowly and are read just often enough not to be shown as old.
const TEMPERATURE_HZ: f64 = 5.0;
/// While a hand is armed on a wire where nobody hears others' requests, the setpoints that it holds are read this often: so that
/// three of them show another controller within a second.
const WATCHED_HZ: f64 = 25.0;
/// On a way that is too slow for that, they are read before anything but the pose after this.
const WATCH_INTERVAL: Duration = Duration::from_millis(250);
/// A round this long after the one before is none of a stream.
const ALONE: Duration = Duration::from_millis(100);
/// Once one of them is doubtful, they are read before each write for so long.
const DOUBT_DURATION: Duration = Duration::from_secs(1);
/// Windows asked for last, none of which is asked for again in the same form: a whole run of replies may be doubled.
const RECENT: usize = 3;
/// Reckoned with before the first answer: that of a quick hand.
const TURNAROUND: Duration = Duration::from_millis(3);

/// How often each group is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PollRates {
    /// Motion states a second; infinite = as fast as the wire goes.
    pub state_hz: f64,
    /// Sweeps over all fingertips a second; infinite = as fast as the wire goes.
    pub tactile_hz: f64,
    /// Reads of the setpoints that the hand holds, a second.
    pub settings_hz: f64,
}

/// What comes first while something moves on a line that is too slow for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PollPriority {
    /// Angles and forces: every second read.
    #[default]
    Force,
    /// Fingertips: angles and forces are every third read.
    Touch,
}

impl Default for PollRates {
    fn default() -> Self {
        Self {
            state_hz: 100.0,
            tactile_hz: 30.0,
            settings_hz: 2.0,
        }
    }
}

impl PollRates {
    /// As fast as the wire goes, states and fingertips in turn.
    pub const FULL: Self = Self {
        state_hz: f64::INFINITY,
        tactile_hz: f64::INFINITY,
        settings_hz: 2.0,
    };

    fn of(&self, part: ReadPart) -> f64 {
        match part.rate() {
            RateClass::Motion | RateClass::Drives => self.state_hz,
            RateClass::Temperature => self.state_hz.min(TEMPERATURE_HZ),
            RateClass::Settings => self.settings_hz,
            RateClass::Tactile => self.tactile_hz,
        }
    }
}

/// What the hand is about, as far as reading it is concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tempo {
    /// Nothing seems to move.
    Rest,
    /// Setpoints flow, or something moves.
    Motion,
    /// A stop waits to be confirmed: only what tells of motion and faults counts.
    Stopping,
}

/// What is read next: the forms of one window, in the order of preference.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NextRead {
    /// The caller takes the first that no late reply can be mistaken for.
    pub(crate) shapes: ArrayVec<Span, SHAPES_MAX>,
    /// True if it asks where the hand is.
    pub(crate) is_motion: bool,
}

/// Due time of one part.
#[derive(Debug, Clone, Copy)]
struct Due {
    part: ReadPart,
    period: Duration,
    next: Moment,
    /// Not asked for before this, however late it is by then.
    held_until: Moment,
    asked: Moment,
}

/// Decides what is read next.
#[derive(Debug)]
pub(crate) struct PollPlan {
    rates: PollRates,
    /// Whether setpoints are read often enough to see another controller's.
    watched: bool,
    /// When a setpoint was written last.
    wrote: Option<Moment>,
    /// When a round of setpoints began last, and whether it is one of a stream.
    round: Option<(Moment, bool)>,
    /// Setpoints are read before each write until then.
    doubtful_until: Moment,
    /// Setpoints are read before anything but the pose from then on.
    look_at: Option<Moment>,
    parts: [Due; ReadPart::ALL.len()],
    cost: WireCost,
    turnaround: Turnaround,
    gaps: Gaps,
    recent: ArrayVec<Span, RECENT>,
    priority: PollPriority,
    /// Questions since the last motion state.
    since_motion: u8,
}

impl PollPlan {
    pub(crate) fn new(rates: PollRates, cost: WireCost, now: Moment) -> Self {
        Self {
            rates,
            watched: false,
            wrote: None,
            round: None,
            doubtful_until: now,
            look_at: None,
            parts: ReadPart::ALL.map(|part| Due {
                part,
                period: period(rates.of(part)),
                next: now,
                held_until: now,
                asked: now,
            }),
            cost,
            turnaround: Turnaround::default(),
            gaps: Gaps::default(),
            recent: ArrayVec::new(),
            priority: PollPriority::Force,
            since_motion: u8::MAX,
        }
    }

    /// Reads at other rates: what is wanted more often than before waits one of its new periods at most.
    pub(crate) fn change_rates(&mut self, rates: PollRates, now: Moment) {
        self.rates = rates;
        self.keep_rates(now);
    }

    /// Reads setpoints often, or as usual again.
    pub(crate) fn watch_setpoints(&mut self, watched: bool, now: Moment) {
        if std::mem::replace(&mut self.watched, watched) != watched {
            self.keep_rates(now);
        }
    }

    fn keep_rates(&mut self, now: Moment) {
        for due in &mut self.parts {
            let is_watched = matches!(due.part, ReadPart::Targets | ReadPart::Speeds);
            let least = if self.watched && is_watched {
                WATCHED_HZ
            } else {
                0.0
            };
            due.period = period(self.rates.of(due.part).max(least));
            due.next = due.next.min(now.plus(due.period));
        }
    }

    /// How far apart the reads of each part are meant to be.
    pub(crate) fn periods(&self) -> impl Iterator<Item = (ReadPart, Duration)> {
        self.parts.iter().map(|due| (due.part, due.period))
    }

    /// What comes first from now on while something moves.
    pub(crate) const fn prefer(&mut self, priority: PollPriority) {
        self.priority = priority;
    }

    /// The wire's cost model.
    pub(crate) const fn cost(&self) -> &WireCost {
        &self.cost
    }

    /// The hand's turnaround as learnt.
    pub(crate) const fn turnaround(&self) -> &Turnaround {
        &self.turnaround
    }

    /// How this hand takes reads through the gap between angles and forces.
    pub(crate) fn know_gap(&mut self, gap: GapRead) {
        self.gaps = Gaps::known(gap);
    }

    /// True if windows are split because the hand refuses to be read through a gap.
    pub(crate) fn gaps_are_split(&self) -> bool {
        self.gaps.are_split()
    }

    /// Whole reads of a class a second, if the wire carried nothing else; 0 before the first answer.
    pub(crate) fn could_hz(&self, class: RateClass) -> f64 {
        let Some(turnaround) = self.turnaround.typical() else {
            return 0.0;
        };
        let joining = self.joining(Tempo::Rest);
        let mut left: ArrayVec<ReadPart, { ReadPart::ALL.len() }> =
            ReadPart::ALL.into_iter().collect();
        left.retain(|part| part.rate() == class);
        let mut all = Duration::ZERO;
        while let Some(first) = left.first() {
            let window = joining.window(first.span(), left.iter().copied());
            all += self.cost.read(window.len, turnaround);
            left.retain(|part| !window.covers(part.span()));
        }
        if all.is_zero() {
            0.0
        } else {
            1.0 / all.as_secs_f64()
        }
    }

    fn joining(&self, tempo: Tempo) -> Joining {
        Joining {
            cost: self.cost,
            turnaround: self.turnaround.typical().unwrap_or(TURNAROUND),
            longest: self.longest(tempo),
            gaps: self.gaps,
        }
    }

    /// Most data bytes of a read. Who asks for more states than usual, as trials do, wants no long reads between them.
    fn longest(&self, tempo: Tempo) -> u16 {
        let usual = period(PollRates::default().state_hz);
        let mut parts = self.parts.iter();
        let is_usual = parts.all(|due| !due.part.is_motion() || due.period >= usual);
        let turnaround = self.turnaround.longest();
        match tempo {
            Tempo::Rest => self.cost.window(turnaround),
            Tempo::Motion if is_usual => self.cost.window_moving(turnaround),
            Tempo::Motion | Tempo::Stopping => self.cost.window_stopping(),
        }
    }

    /// What is to be read now, if anything is due.
    pub(crate) fn next(&self, now: Moment, tempo: Tempo) -> Option<NextRead> {
        let is_due = |due: &&Due| due.at() <= now && !self.waits_for_write(due.part, now);
        let due = || self.wanted(tempo).filter(is_due);
        let motion = || {
            due()
                .filter(|due| due.part.is_motion())
                .reduce(|a, b| a.later(b, now))
        };
        let any = || due().reduce(|a, b| a.later(b, now));
        let others = || {
            let looked_at = || due().find(|due| self.is_looked_at(due, now));
            let longest = || {
                due()
                    .filter(|due| !self.goes_with_motion(due.part, tempo))
                    .reduce(|a, b| a.later(b, now))
            };
            looked_at().or_else(longest)
        };
        let between = match self.priority {
            PollPriority::Force => 1,
            PollPriority::Touch if tempo == Tempo::Motion => 2,
            PollPriority::Touch => 1,
        };
        let first = match (tempo, self.since_motion >= between) {
            (Tempo::Rest, _) => any(),
            (_, true) => motion().or_else(any),
            (_, false) => others().or_else(any),
        };
        first.map(|first| self.question(first, now, tempo))
    }

    /// True for what is read with the motion state: while something moves what the drives say too, if there is room.
    fn goes_with_motion(&self, part: ReadPart, tempo: Tempo) -> bool {
        let whole = ReadPart::Drives.span().end() - u32::from(ReadPart::Angle.span().address);
        let has_room = || u32::from(self.longest(tempo)) >= whole;
        part.is_motion() || part == ReadPart::Drives && tempo == Tempo::Motion && has_room()
    }

    /// The motion state, due or not.
    pub(crate) fn motion(&self, now: Moment, tempo: Tempo) -> NextRead {
        let angle = self.parts.iter().find(|due| due.part == ReadPart::Angle);
        let angle = angle.copied().unwrap_or(Due {
            part: ReadPart::Angle,
            period: Duration::ZERO,
            next: now,
            held_until: now,
            asked: now,
        });
        self.question(&angle, now, tempo)
    }

    /// What is read between two rounds of setpoints, so that a drag starves nothing; due or not it is no motion state.
    pub(crate) fn others(&self, now: Moment) -> Option<NextRead> {
        let due = self.parts.iter().filter(|due| due.at() <= now);
        let due = due.filter(|due| !self.waits_for_write(due.part, now));
        due.filter(|due| !self.goes_with_motion(due.part, Tempo::Motion))
            .reduce(|a, b| a.later(b, now))
            .map(|first| self.question(first, now, Tempo::Motion))
    }

    /// True for setpoints that were just written, are doubtful, or were not read for long though they are watched.
    fn is_looked_at(&self, due: &Due, now: Moment) -> bool {
        let is_wanted = self.look_at.is_some_and(|at| at <= now);
        let is_old = self.watched && now.since(due.asked) >= WATCH_INTERVAL;
        due.part == ReadPart::Targets && (is_wanted || is_old)
    }

    /// When something is due next.
    pub(crate) fn next_due(&self, now: Moment, tempo: Tempo) -> Moment {
        let waits = |due: &&Due| !self.waits_for_write(due.part, now);
        let next = self.wanted(tempo).filter(waits).map(Due::at).min();
        next.unwrap_or(Moment::ZERO)
    }

    /// A window was answered. Its parts are due one period on, without catching up; counted from the asking, so that
    /// rates are kept whatever the reply takes.
    pub(crate) fn answered(&mut self, window: Span, asked: Moment, took: Duration) {
        self.turnaround.learn(&self.cost, window.len, took);
        self.gaps.answered(window);
        self.asked(window, asked);
    }

    /// A window was not answered as it should be.
    pub(crate) fn failed(&mut self, window: Span, now: Moment) {
        self.gaps.failed(window);
        self.asked(window, now);
    }

    /// A round of setpoints begins.
    pub(crate) fn begin_round(&mut self, now: Moment) {
        let in_stream = self.round.is_some_and(|(at, _)| now.since(at) < ALONE);
        self.round = Some((now, in_stream));
    }

    /// A setpoint was written: a round that stands alone is read back at once, so that nobody else's comes between.
    pub(crate) fn wrote_setpoint(&mut self, now: Moment) {
        self.wrote = Some(now);
        if self.watched && !self.watched_in_stream(now) {
            self.look_at_settings(now);
        }
    }

    /// The setpoints that the hand holds, if they are to be read before the next write of a stream: what another wrote since the
    /// last one is there until then.
    pub(crate) fn before_write(&self, now: Moment) -> Option<NextRead> {
        let wrote = self.wrote.filter(|_| self.watched_in_stream(now))?;
        let targets = self
            .parts
            .iter()
            .find(|due| due.part == ReadPart::Targets)?;
        let is_doubtful = now < self.doubtful_until && targets.held_until <= now;
        let is_due = targets.at() <= now || is_doubtful && targets.asked <= wrote;
        is_due.then(|| self.question(targets, now, Tempo::Motion))
    }

    fn waits_for_write(&self, part: ReadPart, now: Moment) -> bool {
        matches!(part, ReadPart::Targets | ReadPart::Speeds) && self.watched_in_stream(now)
    }

    /// True while setpoints are read before writes, and only there.
    fn watched_in_stream(&self, now: Moment) -> bool {
        let is_recent = self.wrote.is_some_and(|at| now.since(at) < ALONE);
        let in_stream = self.round.is_some_and(|(_, in_stream)| in_stream);
        self.watched && is_recent && in_stream
    }

    /// A setpoint that the hand holds may be another controller's.
    pub(crate) fn doubt_setpoints(&mut self, now: Moment) {
        self.doubtful_until = now.plus(DOUBT_DURATION);
    }

    /// Reads the setpoints at this time at the latest: they were just written, or are doubtful.
    pub(crate) fn look_at_settings(&mut self, at: Moment) {
        if self.watched {
            self.look_at = Some(self.look_at.map_or(at, |before| before.min(at)));
        }
        for due in &mut self.parts {
            if matches!(due.part, ReadPart::Targets | ReadPart::Speeds) {
                due.next = due.next.min(at);
            }
        }
    }

    /// No form of this window could be asked for: its parts wait until `until`, and are as late as they were.
    pub(crate) fn failed_to_ask(&mut self, window: Span, until: Moment) {
        self.since_motion = u8::MAX;
        for due in &mut self.parts {
            if window.covers(due.part.span()) {
                due.held_until = until;
            }
        }
    }

    fn asked(&mut self, window: Span, at: Moment) {
        if self.recent.is_full() {
            self.recent.remove(0);
        }
        self.recent.push(window);
        self.since_motion = self.since_motion.saturating_add(1);
        for due in &mut self.parts {
            if window.covers(due.part.span()) {
                // A part that came along in company before its time is not put off for all the times it did.
                due.next = due.next.plus(due.period).clamp(at, at.plus(due.period));
                due.asked = at;
                if due.part == ReadPart::Targets {
                    self.look_at = self.look_at.filter(|look| at < *look);
                }
                if due.part.is_motion() {
                    self.since_motion = 0;
                }
            }
        }
    }

    fn wanted(&self, tempo: Tempo) -> impl Iterator<Item = &Due> + Clone {
        self.parts.iter().filter(move |due| {
            tempo != Tempo::Stopping || due.part.is_motion() || due.part == ReadPart::Drives
        })
    }

    /// The question about a part and what goes well with it.
    fn question(&self, first: &Due, now: Moment, tempo: Tempo) -> NextRead {
        let joining = self.joining(tempo);
        let with_motion = |due: &Due| self.goes_with_motion(due.part, tempo);
        let joins = self
            .wanted(tempo)
            .filter(|due| tempo == Tempo::Rest || with_motion(due) == with_motion(first))
            .filter(|due| due.joins(first, now, joining.longest));
        // What belongs together goes first, so that chance neighbours do not take its place.
        let alike = joins.clone().filter(|due| due.period == first.period);
        let narrow = joining.window(first.part.span(), alike.map(|due| due.part));
        let wide = joining.window(narrow, joins.map(|due| due.part));
        let is_motion = wide.covers(ReadPart::Angle.span());
        let mut forms = joining.shapes(wide);
        if is_motion {
            // Shorter ones, for a line on which each longer one may still be answered late.
            let shorter = [narrow, ReadPart::Angle.span()].into_iter();
            for window in shorter.filter(|window| *window != wide) {
                forms.extend(
                    joining
                        .shapes(window)
                        .into_iter()
                        .take(forms.remaining_capacity()),
                );
            }
        }
        let is_recent = |shape: &&Span| self.recent.contains(shape);
        let fresh = forms.iter().filter(|shape| !is_recent(shape));
        let shapes = fresh
            .chain(forms.iter().filter(is_recent))
            .copied()
            .collect();
        NextRead { shapes, is_motion }
    }
}

impl Due {
    /// When it may be asked for.
    fn at(&self) -> Moment {
        self.next.max(self.held_until)
    }

    /// How long it waits, in its own periods.
    fn lateness(&self, now: Moment) -> u128 {
        let late = now.since(self.next);
        let period = if late >= STARVATION_TIMEOUT {
            SHORTEST_PERIOD
        } else {
            self.period.clamp(SHORTEST_PERIOD, LONGEST_PERIOD)
        };
        (late.as_micros() + 1) * 1_000_000 / period.as_micros()
    }

    /// Whichever waits longer; the earlier in the table if both do.
    fn later<'a>(&'a self, other: &'a Self, now: Moment) -> &'a Self {
        if other.lateness(now) > self.lateness(now) {
            other
        } else {
            self
        }
    }

    /// True if it may be read with `first`, being wanted now or so soon that this read serves as well.
    fn joins(&self, first: &Self, now: Moment, longest: u16) -> bool {
        match (self.part, first.part) {
            // Always the same ones together: else the first and the last may be left alone, which nothing then ends.
            (ReadPart::Tip(one), ReadPart::Tip(other)) => {
                let together = (longest / TIP_BYTES).max(1);
                one as u16 / together == other as u16 / together
            }
            // What belongs together stays together, and what is wanted seldom is not read much more often for company.
            _ if self.period == first.period => self.next <= now.plus(self.period / 2),
            _ => self.next <= now.plus(self.period / 8),
        }
    }
}

fn period(hz: f64) -> Duration {
    if hz > 0.0 {
        Duration::try_from_secs_f64(1.0 / hz).unwrap_or(Duration::MAX)
    } else {
        Duration::from_secs(u64::from(u32::MAX))
    }
}
