//! An exhibition: the only program that moves the hand while it runs. It plays the pieces of visitors and of the attract loop.

use crate::exhibit::heat::{HeatGovernor, HeatLevel};
use crate::exhibit::plan::{ExhibitPiece, ExhibitPlan};
use crate::exhibit::stage::{
    DRAWN_TIMEOUT, ExhibitEvent, ExhibitHold, ExhibitStage, ExhibitView, ExhibitWish,
    HOLD_DURATION, HaltReason,
};
use crate::hand::gap::SizeBlocks;
use crate::hand::grip::GripEstimator;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{ArmEpoch, Fault, Groups, HandSample, Moment, PerDof};
use crate::link::{Clock, LinkHandle, LinkTrouble, Owner, PollRates};
use crate::motion::drive::{ArmedBy, DriveStart, drive};
use crate::motion::hold::HoldPhase;
use crate::motion::play::{PlayCommand, PlayStart, Playing};
use crate::motion::program::{AfterAbort, Ended, Order, Program, Progress, Seen};
use crate::poses::player::{PlayMode, PlayPlan};
use crate::record::{Abort, ArmRefusal, Disarmed, LinkState};
use crate::trials::limits::TaskStall;
use futures::stream::poll_fn;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::sync::mpsc;

/// Number of faults that the exhibition clears by itself …
const CLEARED_MAX: usize = 3;
/// … within this time.
const CLEAR_WINDOW: Duration = Duration::from_secs(600);
/// A fault that is still reported this long after clearing was not cleared.
const CLEAR_TIMEOUT: Duration = Duration::from_secs(3);
/// A visitor who presses nothing for this long has left.
const GONE_TIMEOUT: Duration = Duration::from_secs(25);
/// After a stall of this program, the session decides first whether the computer slept.
const STALL_GRACE: Duration = Duration::from_millis(100);
/// Pause between two visitors.
const NEXT_VISITOR_DELAY: Duration = Duration::from_secs(5);
/// Pause between two pieces of the attract loop.
const PAUSE: Duration = Duration::from_millis(1200);
/// Minimum rest of a hand that became warm.
const COOLING_DURATION: Duration = Duration::from_secs(120);

/// Settings and readings with which an exhibition starts.
#[derive(Debug, Clone)]
pub struct ExhibitStart {
    /// Pieces that visitors may start, and their limits.
    pub plan: Arc<ExhibitPlan>,
    /// Joints that do not move.
    pub locked: PerDof<bool>,
    /// Newest readings.
    pub seen: HandSample,
    /// Grip estimate from these readings.
    pub grip: GripEstimator,
    /// Overshoot measured on this hand.
    pub overshoot: OvershootMap,
    /// Blocks measured with this hand, for the size of what a hold holds.
    pub blocks: SizeBlocks,
    /// The program's clock.
    pub clock: Clock,
    /// Time at which the page was drawn last.
    pub drawn: Arc<PageDrawn>,
}

/// Time at which the page of an exhibition was drawn last: the sign of life of its window.
#[derive(Debug, Default)]
pub struct PageDrawn(AtomicU64);

impl PageDrawn {
    /// Notes that the page was drawn. The hand is stopped if this does not happen for [`DRAWN_TIMEOUT`].
    pub fn mark(&self, now: Moment) {
        self.0.store(now.micros(), Ordering::Relaxed);
    }

    fn last(&self) -> Moment {
        Moment::from_micros(self.0.load(Ordering::Relaxed))
    }
}

/// Progress of an exhibition; its events are those of the report of the day.
pub type ExhibitProgress = Progress<ExhibitView, ExhibitEvent>;

/// Runs until the sender of `wishes` is dropped; then the hand is stopped. Writes nothing before the user arms for the exhibition.
pub async fn exhibit(
    hand: &LinkHandle,
    start: ExhibitStart,
    mut wishes: mpsc::Receiver<ExhibitWish>,
    mut report: impl FnMut(ExhibitProgress),
) {
    let clock = start.clock;
    let begin = DriveStart {
        armed_by: ArmedBy::Program,
        lease: None,
        seen: start.seen,
        clock,
    };
    let program = ExhibitRun::new(start, clock.now());
    let wishes = poll_fn(move |context| wishes.poll_recv(context));
    let driven = drive(hand, begin, program, wishes, |progress| {
        report(progress);
        true
    });
    // It ends with the wishes, and has stopped the hand.
    let _driven = driven.await;
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Halted(HaltReason),
    Idle,
    Attract { until: Moment },
    Visit { until: Moment, tile: Option<usize> },
    Cooling { until: Moment },
    Clearing { since: Moment },
}

/// State of the current motion.
#[derive(Debug, Clone, PartialEq)]
enum Playback {
    None,
    /// Starts once the hand is armed.
    Waits(PlayPlan),
    Plays,
    /// Ended at this time.
    Done {
        at: Moment,
    },
}

/// A running exhibition.
#[derive(Debug)]
pub(crate) struct ExhibitRun {
    plan: Arc<ExhibitPlan>,
    locked: PerDof<bool>,
    grip: GripEstimator,
    overshoot: OvershootMap,
    blocks: SizeBlocks,
    drawn: Arc<PageDrawn>,
    /// The user armed for the exhibition, and nothing has ended that since.
    permitted: bool,
    phase: Phase,
    motion: Playback,
    /// The piece that moves the hand.
    playing: Option<Playing>,
    /// The hand should hold, which ends the current piece.
    holds: bool,
    /// An arming request has no answer yet.
    is_arming: bool,
    /// The arming that was requested here.
    epoch: Option<ArmEpoch>,
    /// The user permitted motion in this step.
    grants: bool,
    /// The hand should be stopped.
    stops: bool,
    /// Faults should be cleared.
    clears: bool,
    heat: HeatGovernor,
    level: HeatLevel,
    /// Time of the last touch or end of a piece.
    quiet_since: Moment,
    /// Earliest time of the next attract loop.
    attract_from: Moment,
    /// Earliest time of the next visit.
    next_from: Moment,
    held: Option<(usize, Moment)>,
    cleared: VecDeque<Moment>,
    /// The hand answers.
    is_live: bool,
    /// The hand has answered before.
    was_live: bool,
    slept: bool,
    is_faulty: bool,
    /// Index of the next piece of the attract loop.
    next_piece: usize,
    /// Heat of the hand at the start of the current piece.
    played_at: HeatLevel,
    events: VecDeque<ExhibitEvent>,
    is_over: bool,
}

impl ExhibitRun {
    /// Starts without permission to move.
    pub(crate) fn new(start: ExhibitStart, now: Moment) -> Self {
        Self {
            plan: start.plan,
            locked: start.locked,
            grip: start.grip,
            overshoot: start.overshoot,
            blocks: start.blocks,
            drawn: start.drawn,
            permitted: false,
            phase: Phase::Halted(HaltReason::NotArmed),
            motion: Playback::None,
            playing: None,
            holds: false,
            is_arming: false,
            epoch: None,
            grants: false,
            stops: false,
            clears: false,
            heat: HeatGovernor::default(),
            level: HeatLevel::Unknown,
            quiet_since: now,
            attract_from: now,
            next_from: now,
            held: None,
            cleared: VecDeque::with_capacity(CLEARED_MAX),
            is_live: false,
            was_live: false,
            slept: false,
            is_faulty: false,
            next_piece: 0,
            played_at: HeatLevel::Cool,
            events: VecDeque::new(),
            is_over: false,
        }
    }

    /// Applies user input.
    fn wish(&mut self, wish: ExhibitWish, now: Moment) {
        match wish {
            ExhibitWish::Stop => {
                self.events.push_back(ExhibitEvent::Stop);
                self.halt(HaltReason::Stopped);
            }
            ExhibitWish::Disarm => self.halt(HaltReason::NotArmed),
            ExhibitWish::Arm => {
                // Only staff, who can inspect the failure, reset the count.
                self.cleared.clear();
                self.permit(now);
            }
            ExhibitWish::Touch => self.touch(now),
            ExhibitWish::Release => self.held = None,
            ExhibitWish::Press(tile) => {
                self.touch(now);
                if tile < self.plan.tiles.len() {
                    self.held = Some((tile, now));
                    self.press(tile, now);
                }
            }
        }
    }

    /// The user arms for the exhibition; the hand opens.
    fn permit(&mut self, now: Moment) {
        if self.is_live {
            self.permitted = true;
            self.grants = true;
            self.phase = Phase::Idle;
            self.rest(now);
        }
    }

    /// Ends the permission: nothing moves before the user arms again.
    fn halt(&mut self, why: HaltReason) {
        if self.permitted || !matches!(self.phase, Phase::Halted(_)) {
            self.phase = Phase::Halted(why);
        }
        self.permitted = false;
        self.grants = false;
        // A tile that was held before does not count as held from now on.
        self.held = None;
        self.holds = false;
        let may_move = self.epoch.take().is_some() | std::mem::take(&mut self.is_arming);
        self.stops |= may_move || self.motion != Playback::None;
        self.motion = Playback::None;
    }

    fn touch(&mut self, now: Moment) {
        self.quiet_since = now;
        if matches!(self.phase, Phase::Attract { .. }) {
            self.begin_visit(now);
            self.holds = self.motion == Playback::Plays;
            self.motion = Playback::Done { at: now };
        }
    }

    fn begin_visit(&mut self, now: Moment) {
        self.events.push_back(ExhibitEvent::Visit);
        self.phase = Phase::Visit {
            until: now.plus(self.plan.visit),
            tile: None,
        };
    }

    fn press(&mut self, tile: usize, now: Moment) {
        if !self.permitted || self.level >= HeatLevel::Hot || now < self.next_from {
            return;
        }
        if self.phase == Phase::Idle {
            self.begin_visit(now);
        }
        let (Phase::Visit { until, .. }, Some(piece)) = (self.phase, self.plan.tiles.get(tile))
        else {
            return;
        };
        let name = piece.name.en.clone();
        self.events.push_back(ExhibitEvent::Piece(name));
        let tile = Some(tile);
        self.phase = Phase::Visit { until, tile };
        self.play_tile(tile);
    }

    fn play_tile(&mut self, tile: Option<usize>) {
        let plan = Arc::clone(&self.plan);
        if let Some(piece) = tile.and_then(|tile| plan.tiles.get(tile)) {
            self.play(piece);
        }
    }

    fn play(&mut self, piece: &ExhibitPiece) {
        let plan = match self.level {
            HeatLevel::Cool => piece.plan.clone(),
            _ => self.plan.limits.slower().limited(&piece.plan),
        };
        self.played_at = self.level;
        self.motion = Playback::Waits(plan);
    }

    /// Opens the hand, which is then disarmed.
    fn rest(&mut self, now: Moment) {
        self.quiet_since = now;
        let plan = self.plan.open.clone();
        self.motion = Playback::Waits(plan);
    }

    /// Notes that the current piece ended.
    fn piece_ended(&mut self, now: Moment) {
        self.playing = None;
        if self.motion == Playback::Plays {
            self.motion = Playback::Done { at: now };
            self.quiet_since = now;
        }
    }

    /// Handles a lost link, even a momentary one.
    fn link_lost(&mut self) {
        if std::mem::replace(&mut self.is_live, false) {
            self.events.push_back(ExhibitEvent::LinkLost);
        }
        self.halt(HaltReason::NoHand);
        self.phase = Phase::Halted(HaltReason::NoHand);
        // The session disarmed the hand with the link. A stop now would hide why.
        self.stops = false;
    }

    /// A lost link or another controller ends the permission to move.
    fn watch_link(&mut self, seen: &Seen<'_>) {
        let status = seen.status;
        if !status.state.is_live() {
            self.slept |= matches!(status.trouble, Some(LinkTrouble::Suspended { .. }));
            self.link_lost();
            return;
        }
        if !std::mem::replace(&mut self.is_live, true) {
            let slept =
                std::mem::take(&mut self.slept) || status.disarmed == Some(Disarmed::Resume);
            let was_live = std::mem::replace(&mut self.was_live, true);
            self.phase = Phase::Halted(if !was_live {
                HaltReason::NotArmed
            } else if slept {
                HaltReason::Slept
            } else {
                HaltReason::LinkLost
            });
            self.held = None;
        }
        if status.other_controller && self.permitted && !self.grants {
            self.halt(HaltReason::OtherController);
        }
    }

    /// Clears faults that allow it; the others need staff.
    fn watch_faults(&mut self, seen: &Seen<'_>) {
        let now = seen.now;
        if seen.status.state != LinkState::Fault {
            // A stop in a fault does not end it.
            self.is_faulty &= seen.status.state == LinkState::Holding;
            if matches!(self.phase, Phase::Clearing { .. }) {
                self.phase = Phase::Idle;
                self.rest(now);
            }
            return;
        }
        let all = seen.sample.faults.map(|faults| faults.value);
        let all = all.iter().flat_map(|faults| faults.iter());
        let faults: Vec<Fault> = all.flat_map(|(_, faults)| faults.iter()).collect();
        if !faults.is_empty() && !std::mem::replace(&mut self.is_faulty, true) {
            let events = faults.iter().copied().map(ExhibitEvent::Fault);
            self.events.extend(events);
        }
        if !self.permitted {
            if matches!(self.phase, Phase::Halted(_)) {
                self.phase = Phase::Halted(HaltReason::Fault);
            }
            return;
        }
        if faults.iter().any(|fault| fault.clearable() != Some(true)) {
            self.halt(HaltReason::Fault);
            return;
        }
        // The link may report a fault a moment before it is read here; no setpoint passes meanwhile.
        let is_waiting = match self.phase {
            Phase::Clearing { since } => now.since(since) < CLEAR_TIMEOUT,
            _ => faults.is_empty(),
        };
        if is_waiting {
            return;
        }
        self.cleared.retain(|at| now.since(*at) < CLEAR_WINDOW);
        if self.cleared.len() >= CLEARED_MAX {
            self.halt(HaltReason::Fault);
            return;
        }
        self.cleared.push_back(now);
        self.phase = Phase::Clearing { since: now };
        self.clears = true;
        // The link disarmed the hand, which ended the piece.
        self.holds = false;
        self.motion = Playback::None;
        self.is_arming = false;
        self.epoch = None;
    }

    /// Arms again while a tile is held, where visitors may do that.
    fn watch_held(&mut self, seen: &Seen<'_>) {
        let (status, now) = (seen.status, seen.now);
        let is_halted =
            matches!(self.phase, Phase::Halted(_)) && status.state == LinkState::Monitoring;
        if let Some((tile, since)) = self.held
            && self.plan.visitor_restart
            && is_halted
            && now.since(since) >= HOLD_DURATION
        {
            self.permit(now);
            self.press(tile, now);
        }
    }

    /// Advances the phase by time and heat.
    fn advance(&mut self, now: Moment) {
        match self.phase {
            Phase::Halted(_) | Phase::Clearing { .. } => {}
            Phase::Cooling { until } if now < until => {}
            Phase::Cooling { .. } if self.heat.is_rested(now) => {
                self.phase = Phase::Idle;
                self.quiet_since = now;
            }
            Phase::Cooling { .. } => {
                let until = now.plus(COOLING_DURATION / 2);
                self.phase = Phase::Cooling { until };
            }
            _ if self.level == HeatLevel::Hot => {
                self.events.push_back(ExhibitEvent::Rest);
                let until = now.plus(COOLING_DURATION);
                self.phase = Phase::Cooling { until };
                self.rest(now);
            }
            Phase::Visit { .. } | Phase::Attract { .. } if self.level == HeatLevel::Unknown => {
                self.go_idle(now);
            }
            Phase::Visit { until, .. } if now >= until => {
                self.next_from = now.plus(NEXT_VISITOR_DELAY);
                self.go_idle(now);
            }
            Phase::Visit { tile, .. } => self.advance_visit(tile, now),
            Phase::Attract { until } => self.advance_attract(until, now),
            Phase::Idle => self.attract(now),
        }
    }

    fn go_idle(&mut self, now: Moment) {
        self.phase = Phase::Idle;
        self.rest(now);
    }

    fn advance_visit(&mut self, tile: Option<usize>, now: Moment) {
        let piece = tile.and_then(|tile| self.plan.tiles.get(tile));
        let again = piece.is_some_and(|piece| piece.again);
        let reacts = piece.is_some_and(|piece| piece.plan.reaction.is_some());
        match self.motion {
            Playback::Done { .. } if again => self.play_tile(tile),
            Playback::Done { .. } if now.since(self.quiet_since) >= GONE_TIMEOUT => {
                self.go_idle(now)
            }
            // Such a piece has no end after which it would be played more slowly.
            Playback::Plays if reacts && self.level > self.played_at => self.play_tile(tile),
            // The hand was not armed in time.
            Playback::None => self.go_idle(now),
            _ => {}
        }
    }

    fn advance_attract(&mut self, until: Moment, now: Moment) {
        if now >= until || self.motion == Playback::None {
            let rest = self.plan.attract.as_ref().map(|attract| attract.rest);
            self.attract_from = now.plus(rest.unwrap_or_default());
            self.go_idle(now);
            return;
        }
        if let Playback::Done { at } = self.motion
            && now.since(at) >= PAUSE
        {
            self.play_next();
        }
    }

    fn attract(&mut self, now: Moment) {
        let Some(attract) = &self.plan.attract else {
            return;
        };
        let is_quiet = now.since(self.quiet_since) >= attract.after && now >= self.attract_from;
        if is_quiet && self.motion == Playback::None && self.level < HeatLevel::Hot {
            let until = now.plus(attract.play);
            self.phase = Phase::Attract { until };
            self.play_next();
        }
    }

    fn play_next(&mut self) {
        let plan = Arc::clone(&self.plan);
        let pieces = plan.attract.iter().flat_map(|attract| &attract.pieces);
        let count = pieces.clone().count().max(1);
        let piece = pieces.clone().nth(self.next_piece % count);
        self.next_piece = (self.next_piece + 1) % count;
        if let Some(piece) = piece {
            self.play(piece);
        }
    }

    /// Starts the waiting motion, and arms or disarms the hand for it.
    fn start_motion(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let (status, now) = (seen.status, seen.now);
        let is_resting = matches!(self.phase, Phase::Idle | Phase::Cooling { .. });
        let is_disarmed = status.state == LinkState::Monitoring && status.armed.is_none();
        let own = self.epoch.filter(|epoch| status.armed == Some(*epoch));
        match (&self.motion, own) {
            (Playback::Done { .. }, _) if is_resting => {
                self.motion = Playback::None;
                self.epoch = None;
                Some(Order::Rest)
            }
            (Playback::Waits(plan), Some(epoch)) => {
                let start = PlayStart {
                    plan: plan.clone(),
                    pace: PlayMode::Through,
                    locked: self.locked,
                    grip: self.grip.clone(),
                    overshoot: self.overshoot.clone(),
                    blocks: self.blocks.clone(),
                    force_limit: self.plan.limits.force,
                };
                self.motion = Playback::Plays;
                self.playing = Some(Playing::new(epoch, start, now));
                None
            }
            (Playback::Waits(_), None) if !self.is_arming && is_disarmed => {
                self.is_arming = true;
                Some(Order::Arm(self.plan.limits.arm_request()))
            }
            _ => None,
        }
    }

    /// Advances the current piece.
    fn play_on(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let piece = self.playing.as_mut()?;
        let is_armed = seen.status.armed == Some(piece.epoch());
        if !is_armed || seen.status.state == LinkState::Fault {
            self.epoch = None;
            self.piece_ended(seen.now);
            return None;
        }
        let order = piece.tick(seen);
        if piece.ended().is_some() {
            let has_held = piece.player().has_hold();
            self.piece_ended(seen.now);
            if has_held && matches!(self.motion, Playback::Done { .. }) {
                // The next visitor begins with an open hand.
                self.motion = Playback::Waits(self.plan.open.clone());
            }
        }
        order
    }
}

impl Program for ExhibitRun {
    type Input = ExhibitWish;
    type Outcome = ();
    type View = ExhibitView;
    type Event = ExhibitEvent;
    const AFTER_ABORT: AfterAbort = AfterAbort::Nothing;

    fn rates(&self) -> Option<PollRates> {
        self.playing.as_ref().and_then(Playing::rates)
    }

    fn input(&mut self, wish: ExhibitWish, seen: &Seen<'_>) -> Option<Order> {
        self.wish(wish, seen.now);
        None
    }

    fn armed(&mut self, answer: Result<ArmEpoch, ArmRefusal>) -> Option<Order> {
        // A halt or a fault withdraws the request.
        if !std::mem::take(&mut self.is_arming) {
            return None;
        }
        self.epoch = answer.ok();
        if self.epoch.is_none() {
            self.motion = Playback::None;
        }
        // It must not be armed later either.
        self.epoch.is_none().then_some(Order::Rest)
    }

    fn input_ended(&mut self, seen: &Seen<'_>) -> Option<Order> {
        self.is_over = true;
        let may_move = self.playing.is_some() || seen.status.armed.is_some();
        may_move.then_some(Order::Stop)
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        let read = sample.newest(fresh).unwrap_or_default();
        self.grip.apply(sample, fresh, read);
        if let Some(piece) = &mut self.playing {
            piece.read(sample, fresh, now);
        }
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let now = seen.now;
        self.heat.apply(seen.sample);
        self.level = self.heat.level(now);
        self.watch_link(seen);
        let has_stalled = |stall: TaskStall| now.since(stall.ended) < STALL_GRACE;
        let is_shown = now.since(self.drawn.last()) < DRAWN_TIMEOUT;
        if self.permitted && !is_shown && !seen.stall.is_some_and(has_stalled) {
            self.halt(HaltReason::NotShown);
        }
        self.watch_faults(seen);
        self.watch_held(seen);
        if std::mem::take(&mut self.stops) && self.is_live {
            self.holds = false;
            self.playing = None;
            return Some(Order::Stop);
        }
        if std::mem::take(&mut self.grants) {
            return Some(Order::Grant(Owner::Exhibition));
        }
        if std::mem::take(&mut self.holds)
            && let Some(mut piece) = self.playing.take()
        {
            return piece.input(PlayCommand::End, seen);
        }
        if std::mem::take(&mut self.clears) {
            self.playing = None;
            return Some(Order::Clear);
        }
        if self.permitted {
            self.advance(now);
        }
        self.start_motion(seen).or_else(|| self.play_on(seen))
    }

    /// Control ended; staff may grant it again.
    fn abort(&mut self, why: Abort, _now: Moment) {
        let why = match why {
            Abort::LinkLost => return self.link_lost(),
            Abort::Disarmed {
                why: Some(Disarmed::Resume),
            } => {
                self.slept = true;
                return self.link_lost();
            }
            Abort::Fault { .. } => HaltReason::Fault,
            Abort::OtherController { .. } => HaltReason::OtherController,
            Abort::Disarmed {
                why: Some(Disarmed::Stop),
            } => HaltReason::Stopped,
            Abort::Disarmed {
                why: Some(Disarmed::Stale | Disarmed::FrozenFeedback),
            } => HaltReason::NoFeedback,
            _ => HaltReason::NotArmed,
        };
        if self.permitted && !self.grants {
            self.halt(why);
        }
    }

    fn view(&self, now: Moment) -> ExhibitView {
        let (stage, tile) = match self.phase {
            Phase::Halted(why) => (ExhibitStage::Halted(why), None),
            Phase::Cooling { until } => (ExhibitStage::Cooling { until }, None),
            Phase::Clearing { .. } => (ExhibitStage::Clearing, None),
            Phase::Visit { until, tile } => (ExhibitStage::Visit { until }, tile),
            _ if self.level == HeatLevel::Unknown => (ExhibitStage::HeatUnknown, None),
            Phase::Attract { .. } => (ExhibitStage::Attract, None),
            Phase::Idle if now < self.next_from => {
                let at = self.next_from;
                (ExhibitStage::NextVisitor { at }, None)
            }
            Phase::Idle => (ExhibitStage::Idle, None),
        };
        ExhibitView {
            stage,
            tile,
            held: self.held,
            is_slow: self.permitted && self.level == HeatLevel::Warm,
            hold: self.playing.as_ref().and_then(|piece| hold_of(piece, now)),
        }
    }

    fn event(&mut self) -> Option<ExhibitEvent> {
        self.events.pop_front()
    }

    fn ended(&self) -> Option<Ended<()>> {
        self.is_over.then_some(Ok(()))
    }
}

/// What a piece holds, or will hold.
fn hold_of(piece: &Playing, now: Moment) -> Option<ExhibitHold> {
    if let Some(view) = piece.view(now).hold {
        let is_short = view.phase == HoldPhase::CannotHold;
        return Some(ExhibitHold {
            is_held: is_short || view.phase == HoldPhase::Holding,
            is_short,
            force_g: view.mean_g(),
            tightened: view.tightened,
            last: view.last,
        });
    }
    piece.player().will_hold().then(ExhibitHold::default)
}
