//! Decides what to read next, and when. Pure: applies time, replies and failures, and returns spans; sends nothing.
//!
//! Each part of memory has its own rate. The part that is latest, measured in its own periods, opens a window, and
//! other due parts join it if that is cheaper (`link::poll::window`). The maximum length of a window follows from the
//! stop (`link::poll::cost`): a stop must still be in time after it. While the hand moves and the usual state rate is
//! configured, several fingertips are read at once. The motion state then has at least every second turn, or every
//! third if fingertips are preferred, and includes the drive states if there is room.

use crate::hand::feedback::group::TIP_BYTES;
use crate::hand::{Moment, RateClass, Span};
use crate::link::poll::cost::{Turnaround, WireCost};
use crate::link::poll::window::{Gaps, Joining, ReadPart, SHAPES_MAX};
use crate::link::quirks::GapRead;
use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Shortest period used to compare the lateness of parts with unlimited rate with slow ones …
const SHORTEST_PERIOD: Duration = Duration::from_millis(10);
/// … and the longest, so that slow parts do not wait for many of their periods on a line that is too slow for all.
const LONGEST_PERIOD: Duration = Duration::from_millis(30);
/// A part that waits this long is as urgent as the fastest: a sweep over all fingertips takes a slow hand on CAN most
/// of a second.
const STARVATION_TIMEOUT: Duration = Duration::from_secs(1);
/// Temperatures change slowly and are read just often enough not to be shown as old.
const TEMPERATURE_HZ: f64 = 5.0;
/// Rate at which the hand's setpoints are read while it is armed on a wire where requests of others cannot be heard:
/// three of these reads show another controller within a second.
const WATCHED_HZ: f64 = 25.0;
/// If the link is too slow for that, setpoints are read before anything but the pose after this time.
const WATCH_INTERVAL: Duration = Duration::from_millis(250);
/// A round this long after the previous one does not belong to a stream.
const ALONE: Duration = Duration::from_millis(100);
/// Setpoints are read before each write for this long after a doubtful one.
const DOUBT_DURATION: Duration = Duration::from_secs(1);
/// Number of last windows, none of which is requested again in the same shape: a whole run of replies may be duplicated.
const RECENT: usize = 3;
/// Turnaround assumed before the first reply: that of a fast hand.
const TURNAROUND: Duration = Duration::from_millis(3);

/// Poll rates of the groups.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PollRates {
    /// Motion states per second; infinite = as fast as the wire allows.
    pub state_hz: f64,
    /// Sweeps over all fingertips per second; infinite = as fast as the wire allows.
    pub tactile_hz: f64,
    /// Reads of the hand's setpoints per second.
    pub settings_hz: f64,
}

/// Preferred reads while the hand moves on a line that is too slow for all.
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
    /// As fast as the wire allows, states and fingertips in turn.
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

/// The state of the hand, as far as polling is concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tempo {
    /// The hand seems to rest.
    Rest,
    /// Setpoints are sent, or the hand moves.
    Motion,
    /// A stop is being confirmed: only motion and faults are read.
    Stopping,
}

/// The next read: the shapes of one window, in the order of preference.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NextRead {
    /// The caller uses the first whose reply cannot be mistaken for a late one.
    pub(crate) shapes: ArrayVec<Span, SHAPES_MAX>,
    /// True if it reads the pose.
    pub(crate) is_motion: bool,
}

/// Due time of one part.
#[derive(Debug, Clone, Copy)]
struct Due {
    part: ReadPart,
    period: Duration,
    next: Moment,
    /// Not requested before this, however late it is by then.
    held_until: Moment,
    asked: Moment,
}

/// Decides what is read next.
#[derive(Debug)]
pub(crate) struct PollPlan {
    rates: PollRates,
    /// True if setpoints are read often enough to detect another controller.
    watched: bool,
    /// Time of the last setpoint write.
    wrote: Option<Moment>,
    /// Start of the last round of setpoints, and whether it belongs to a stream.
    round: Option<(Moment, bool)>,
    /// Setpoints are read before each write until this time.
    doubtful_until: Moment,
    /// Setpoints are read before anything but the pose from this time.
    settings_due: Option<Moment>,
    parts: [Due; ReadPart::ALL.len()],
    cost: WireCost,
    turnaround: Turnaround,
    gaps: Gaps,
    recent: ArrayVec<Span, RECENT>,
    priority: PollPriority,
    /// Reads since the last motion state.
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
            settings_due: None,
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

    /// Changes the rates: a part whose rate rises waits one of its new periods at most.
    pub(crate) fn change_rates(&mut self, rates: PollRates, now: Moment) {
        self.rates = rates;
        self.keep_rates(now);
    }

    /// Switches frequent setpoint reads on or off.
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

    /// Configured period of each part.
    pub(crate) fn periods(&self) -> impl Iterator<Item = (ReadPart, Duration)> {
        self.parts.iter().map(|due| (due.part, due.period))
    }

    /// Sets the preferred reads during motion.
    pub(crate) const fn prefer(&mut self, priority: PollPriority) {
        self.priority = priority;
    }

    /// The wire's cost model.
    pub(crate) const fn cost(&self) -> &WireCost {
        &self.cost
    }

    /// The measured turnaround of the hand.
    pub(crate) const fn turnaround(&self) -> &Turnaround {
        &self.turnaround
    }

    /// Sets whether this hand permits reads through the gap between angles and forces.
    pub(crate) fn set_gap_read(&mut self, gap: GapRead) {
        self.gaps = Gaps::known(gap);
    }

    /// True if windows are split because the hand refuses to be read through a gap.
    pub(crate) fn gaps_are_split(&self) -> bool {
        self.gaps.are_split()
    }

    /// Complete reads of a class per second if the wire carried nothing else; 0 before the first reply.
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

    /// Maximum data bytes of a read. A client that requests more states than usual, as trials do, must not get long
    /// reads between them.
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

    /// The read that is due now, if any.
    pub(crate) fn next(&self, now: Moment, tempo: Tempo) -> Option<NextRead> {
        let is_due = |due: &&Due| due.at() <= now && !self.waits_for_write(due.part, now);
        let due = || self.polled_parts(tempo).filter(is_due);
        let motion = || {
            due()
                .filter(|due| due.part.is_motion())
                .reduce(|a, b| a.later(b, now))
        };
        let any = || due().reduce(|a, b| a.later(b, now));
        let others = || {
            let settings = || due().find(|due| self.is_settings_read_due(due, now));
            let longest = || {
                due()
                    .filter(|due| !self.goes_with_motion(due.part, tempo))
                    .reduce(|a, b| a.later(b, now))
            };
            settings().or_else(longest)
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

    /// True for parts that are read with the motion state; while the hand moves also the drive states, if there is room.
    fn goes_with_motion(&self, part: ReadPart, tempo: Tempo) -> bool {
        let whole = ReadPart::Drives.span().end() - u32::from(ReadPart::Angle.span().address);
        let has_room = || u32::from(self.longest(tempo)) >= whole;
        part.is_motion() || part == ReadPart::Drives && tempo == Tempo::Motion && has_room()
    }

    /// The read of the motion state, due or not.
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

    /// The due read of anything but the motion state, between two rounds of setpoints, so that a drag starves nothing.
    pub(crate) fn others(&self, now: Moment) -> Option<NextRead> {
        let due = self.parts.iter().filter(|due| due.at() <= now);
        let due = due.filter(|due| !self.waits_for_write(due.part, now));
        due.filter(|due| !self.goes_with_motion(due.part, Tempo::Motion))
            .reduce(|a, b| a.later(b, now))
            .map(|first| self.question(first, now, Tempo::Motion))
    }

    /// True for setpoints that were just written, are doubtful, or are watched and were not read for long.
    fn is_settings_read_due(&self, due: &Due, now: Moment) -> bool {
        let is_wanted = self.settings_due.is_some_and(|at| at <= now);
        let is_old = self.watched && now.since(due.asked) >= WATCH_INTERVAL;
        due.part == ReadPart::Targets && (is_wanted || is_old)
    }

    /// Time of the next due read.
    pub(crate) fn next_due(&self, now: Moment, tempo: Tempo) -> Moment {
        let waits = |due: &&Due| !self.waits_for_write(due.part, now);
        let next = self.polled_parts(tempo).filter(waits).map(Due::at).min();
        next.unwrap_or(Moment::ZERO)
    }

    /// Records an answered window. Its parts are due one period later, without catching up; counted from the request,
    /// so that rates do not depend on the reply time.
    pub(crate) fn answered(&mut self, window: Span, asked: Moment, took: Duration) {
        self.turnaround.learn(&self.cost, window.len, took);
        self.gaps.answered(window);
        self.note_request(window, asked);
    }

    /// Records a window without a valid reply.
    pub(crate) fn failed(&mut self, window: Span, now: Moment) {
        self.gaps.failed(window);
        self.note_request(window, now);
    }

    /// Records the start of a round of setpoints.
    pub(crate) fn begin_round(&mut self, now: Moment) {
        let in_stream = self.round.is_some_and(|(at, _)| now.since(at) < ALONE);
        self.round = Some((now, in_stream));
    }

    /// Records a setpoint write: a single round is read back at once, before another controller can overwrite it.
    pub(crate) fn wrote_setpoint(&mut self, now: Moment) {
        self.wrote = Some(now);
        if self.watched && !self.watched_in_stream(now) {
            self.schedule_settings_read(now);
        }
    }

    /// The read of the hand's setpoints, if it is due before the next write of a stream: a value that another
    /// controller wrote is visible until then.
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

    /// True while setpoints are read before writes, and only then.
    fn watched_in_stream(&self, now: Moment) -> bool {
        let is_recent = self.wrote.is_some_and(|at| now.since(at) < ALONE);
        let in_stream = self.round.is_some_and(|(_, in_stream)| in_stream);
        self.watched && is_recent && in_stream
    }

    /// Records that a setpoint of the hand may be another controller's.
    pub(crate) fn doubt_setpoints(&mut self, now: Moment) {
        self.doubtful_until = now.plus(DOUBT_DURATION);
    }

    /// Schedules a read of the setpoints at this time at the latest: they were just written, or are doubtful.
    pub(crate) fn schedule_settings_read(&mut self, at: Moment) {
        if self.watched {
            self.settings_due = Some(self.settings_due.map_or(at, |before| before.min(at)));
        }
        for due in &mut self.parts {
            if matches!(due.part, ReadPart::Targets | ReadPart::Speeds) {
                due.next = due.next.min(at);
            }
        }
    }

    /// Records that no shape of this window could be requested: its parts wait until `until`, and remain as late as they were.
    pub(crate) fn failed_to_ask(&mut self, window: Span, until: Moment) {
        self.since_motion = u8::MAX;
        for due in &mut self.parts {
            if window.covers(due.part.span()) {
                due.held_until = until;
            }
        }
    }

    fn note_request(&mut self, window: Span, at: Moment) {
        if self.recent.is_full() {
            self.recent.remove(0);
        }
        self.recent.push(window);
        self.since_motion = self.since_motion.saturating_add(1);
        for due in &mut self.parts {
            if window.covers(due.part.span()) {
                // A part that was read early along with others is not postponed for each such read.
                due.next = due.next.plus(due.period).clamp(at, at.plus(due.period));
                due.asked = at;
                if due.part == ReadPart::Targets {
                    self.settings_due = self.settings_due.filter(|look| at < *look);
                }
                if due.part.is_motion() {
                    self.since_motion = 0;
                }
            }
        }
    }

    fn polled_parts(&self, tempo: Tempo) -> impl Iterator<Item = &Due> + Clone {
        self.parts.iter().filter(move |due| {
            tempo != Tempo::Stopping || due.part.is_motion() || due.part == ReadPart::Drives
        })
    }

    /// The read of a part and those that join it.
    fn question(&self, first: &Due, now: Moment, tempo: Tempo) -> NextRead {
        let joining = self.joining(tempo);
        let with_motion = |due: &Due| self.goes_with_motion(due.part, tempo);
        let joins = self
            .polled_parts(tempo)
            .filter(|due| tempo == Tempo::Rest || with_motion(due) == with_motion(first))
            .filter(|due| due.joins(first, now, joining.longest));
        // Parts of the same period join first, so that chance neighbours do not take their place.
        let alike = joins.clone().filter(|due| due.period == first.period);
        let narrow = joining.window(first.part.span(), alike.map(|due| due.part));
        let wide = joining.window(narrow, joins.map(|due| due.part));
        let is_motion = wide.covers(ReadPart::Angle.span());
        let mut forms = joining.shapes(wide);
        if is_motion {
            // Shorter shapes, for a line on which each longer one may still be answered late.
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
    /// Time from which it may be requested.
    fn at(&self) -> Moment {
        self.next.max(self.held_until)
    }

    /// Lateness in its own periods, scaled.
    fn lateness(&self, now: Moment) -> u128 {
        let late = now.since(self.next);
        let period = if late >= STARVATION_TIMEOUT {
            SHORTEST_PERIOD
        } else {
            self.period.clamp(SHORTEST_PERIOD, LONGEST_PERIOD)
        };
        (late.as_micros() + 1) * 1_000_000 / period.as_micros()
    }

    /// The later of both; the earlier in the table if equal.
    fn later<'a>(&'a self, other: &'a Self, now: Moment) -> &'a Self {
        if other.lateness(now) > self.lateness(now) {
            other
        } else {
            self
        }
    }

    /// True if it may be read with `first`, being due now or shortly.
    fn joins(&self, first: &Self, now: Moment, longest: u16) -> bool {
        match (self.part, first.part) {
            // Always the same tips together: otherwise the first and the last could permanently be read alone.
            (ReadPart::Tip(one), ReadPart::Tip(other)) => {
                let together = (longest / TIP_BYTES).max(1);
                one as u16 / together == other as u16 / together
            }
            // Parts of one period stay together, and rare parts are not read much more often just to join.
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
