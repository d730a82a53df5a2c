//! What happens at an exhibition, and when: touches, the link and heat in, orders out. Sends nothing and reads no clock.

use crate::exhibit::heat::{HeatGovernor, HeatLevel};
use crate::exhibit::plan::{ExhibitPiece, ExhibitPlan};
use crate::hand::{ArmEpoch, Fault, HandSample, Moment};
use crate::link::{ArmRequest, LinkStatus, LinkTrouble};
use crate::poses::player::PlayPlan;
use crate::record::{Disarmed, LinkState};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// A page that was not drawn for this long shows no STOP: the hand is held.
pub const DRAWN_TIMEOUT: Duration = Duration::from_secs(1);
/// A tile that is held this long arms again, where visitors may.
pub const HOLD_DURATION: Duration = Duration::from_secs(2);
/// Faults that may be cleared by themselves …
const CLEARED_MAX: usize = 3;
/// … within this time.
const CLEAR_WINDOW: Duration = Duration::from_secs(600);
/// A fault that is there so long after clearing was not cleared.
const CLEAR_TIMEOUT: Duration = Duration::from_secs(3);
/// Arming takes a few readings.
const ARM_TIMEOUT: Duration = Duration::from_secs(3);
/// A visitor who presses nothing for this long has gone.
const GONE_TIMEOUT: Duration = Duration::from_secs(25);
/// Between two visitors.
const NEXT_VISITOR_DELAY: Duration = Duration::from_secs(5);
/// Between two pieces of the attract loop.
const PAUSE: Duration = Duration::from_millis(1200);
/// The least rest of a hand that grew warm.
const COOLING_DURATION: Duration = Duration::from_secs(120);

/// Why the hand stands still until staff come, or a visitor holds a tile where that is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HaltReason {
    /// Nobody armed it since the program started.
    NotArmed,
    /// No hand answers.
    NoHand,
    /// It answers again, after it did not.
    LinkLost,
    /// What it told grew old, or stood still though motion was asked for.
    NoFeedback,
    /// Somebody pressed STOP.
    Stopped,
    /// A fault that only the user can end, or too many.
    Fault,
    /// Another controller talks to the hand.
    OtherController,
    /// This computer slept.
    Slept,
    /// The page was not drawn for a while: nobody could have seen or pressed STOP.
    NotShown,
}

/// What goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExhibitStage {
    /// Nothing moves, and nothing may.
    Halted(HaltReason),
    /// Nobody is there; the hand is open, or opens.
    Idle,
    /// Nobody is there, and the hand shows what it can do.
    Attract,
    /// Somebody plays, until then at most.
    Visit {
        /// When the next one may.
        until: Moment,
    },
    /// A visitor's time is over; the next one may play then.
    NextVisitor { at: Moment },
    /// The hand rests open because it grew warm, about until then.
    Cooling {
        /// About when.
        until: Moment,
    },
    /// A temperature is unknown, so nothing is played.
    HeatUnknown,
    /// A fault is being cleared.
    Clearing,
}

/// What the page shows of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExhibitView {
    /// What goes on.
    pub stage: ExhibitStage,
    /// The tile that is played.
    pub tile: Option<usize>,
    /// The tile that is held, and since when.
    pub held: Option<(usize, Moment)>,
    /// The hand goes slowly because it is warm.
    pub is_slow: bool,
}

impl Default for ExhibitView {
    fn default() -> Self {
        Self {
            stage: ExhibitStage::Halted(HaltReason::NoHand),
            tile: None,
            held: None,
            is_slow: false,
        }
    }
}

/// What the user does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExhibitWish {
    /// Touches the page, anywhere.
    Touch,
    /// Presses a tile.
    Press(usize),
    /// Lets go.
    Release,
    /// Stops the hand.
    Stop,
    /// Staff, with the PIN: arms for the exhibition.
    Arm,
    /// Staff, with the PIN: arms no more.
    Disarm,
}

/// What is to be done at the hand.
#[derive(Debug, Clone, PartialEq)]
pub enum ExhibitOrder {
    /// The user gave the exhibition the right to move the hand.
    Grant,
    /// Let setpoints pass, with these limits.
    Arm(ArmRequest),
    /// Let none pass any more; the hand is open and rests.
    Rest,
    /// Stop the hand, which disarms it.
    Stop,
    /// Play this, in place of what is played.
    Play(PlayPlan),
    /// End what is played, and hold.
    Hold,
    /// Clear what can be cleared.
    Clear,
}

/// What the day's report counts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExhibitEvent {
    /// Somebody began to play.
    Visit,
    /// A visitor started a piece of this name.
    Piece(String),
    /// A drive reported this.
    Fault(Fault),
    /// The hand had to rest for its heat.
    Rest,
    /// Somebody pressed STOP.
    Stop,
    LinkLost,
}

/// What is known of the hand now.
#[derive(Debug, Clone, Copy)]
pub struct ExhibitInput<'a> {
    /// Where its link stands.
    pub status: &'a LinkStatus,
    /// What was read.
    pub sample: &'a HandSample,
    /// Why the right to move the hand that was granted last ended, if it did.
    pub ended: Option<Disarmed>,
    /// When the page was drawn last.
    pub drawn: Moment,
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

/// The motion that is wanted, on its way to the hand.
#[derive(Debug, Clone, PartialEq)]
enum Playback {
    /// Nothing.
    None,
    /// This, once the hand is armed.
    Waits(PlayPlan),
    Plays,
    /// It was played, then.
    Done {
        at: Moment,
    },
}

/// A running exhibition.
#[derive(Debug)]
pub struct ExhibitRun {
    plan: Arc<ExhibitPlan>,
    /// The user armed for the exhibition, and nothing ended that since.
    permitted: bool,
    phase: Phase,
    motion: Playback,
    /// What is played is to be held; and it was told to, and has not ended yet.
    holds: bool,
    is_holding: bool,
    /// Arming was asked for then, whatever is wanted by now, and the link did not arm yet.
    asked: Option<Moment>,
    /// The link's arming that was asked for here.
    epoch: Option<ArmEpoch>,
    /// The user permitted it just now.
    grants: bool,
    /// The hand is to be stopped.
    stops: bool,
    /// Faults are to be cleared.
    clears: bool,
    heat: HeatGovernor,
    level: HeatLevel,
    /// The last touch or end of something.
    quiet_since: Moment,
    /// No attract loop before.
    attract_from: Moment,
    /// The next visitor may play then.
    next_from: Moment,
    held: Option<(usize, Moment)>,
    cleared: VecDeque<Moment>,
    /// Whether the hand answers, and whether it ever did.
    is_live: bool,
    was_live: bool,
    slept: bool,
    is_faulty: bool,
    /// The piece of the attract loop that comes next.
    next_piece: usize,
    /// How warm the hand was when what plays began.
    played_at: HeatLevel,
    events: Vec<ExhibitEvent>,
}

impl ExhibitRun {
    /// Begins without a permission to move.
    pub fn new(plan: Arc<ExhibitPlan>, now: Moment) -> Self {
        Self {
            plan,
            permitted: false,
            phase: Phase::Halted(HaltReason::NotArmed),
            motion: Playback::None,
            holds: false,
            is_holding: false,
            asked: None,
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
            events: Vec::new(),
        }
    }

    /// What the page shows.
    pub fn view(&self, now: Moment) -> ExhibitView {
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
        }
    }

    /// What happened since the last call.
    pub fn take_events(&mut self) -> Vec<ExhibitEvent> {
        std::mem::take(&mut self.events)
    }

    /// Takes in what the user did.
    pub fn wish(&mut self, wish: ExhibitWish, now: Moment) {
        match wish {
            ExhibitWish::Stop => {
                self.events.push(ExhibitEvent::Stop);
                self.halt(HaltReason::Stopped);
            }
            ExhibitWish::Disarm => self.halt(HaltReason::NotArmed),
            ExhibitWish::Arm => {
                // A visitor who arms again is nobody who looked at what failed.
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

    /// Nothing moves any more before the user arms again.
    fn halt(&mut self, why: HaltReason) {
        if self.permitted || !matches!(self.phase, Phase::Halted(_)) {
            self.phase = Phase::Halted(why);
        }
        self.permitted = false;
        self.grants = false;
        // A tile that was held before does not count as held from now on.
        self.held = None;
        self.holds = false;
        self.is_holding = false;
        let may_move = self.epoch.take().is_some() | self.asked.take().is_some();
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
        self.events.push(ExhibitEvent::Visit);
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
        self.events.push(ExhibitEvent::Piece(name));
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

    /// The hand opens, and is disarmed then.
    fn rest(&mut self, now: Moment) {
        self.quiet_since = now;
        let plan = self.plan.open.clone();
        self.motion = Playback::Waits(plan);
    }

    /// What was played is over.
    pub fn ended(&mut self, now: Moment) {
        if std::mem::replace(&mut self.is_holding, false) {
            return;
        }
        if self.motion == Playback::Plays {
            self.motion = Playback::Done { at: now };
            self.quiet_since = now;
        }
    }

    /// Time goes on. What is to be done at the hand, one after the other until nothing is.
    pub fn tick(&mut self, seen: ExhibitInput<'_>, now: Moment) -> Option<ExhibitOrder> {
        self.heat.take(seen.sample);
        self.level = self.heat.level(now);
        self.watch_link(seen);
        if self.permitted && now.since(seen.drawn) >= DRAWN_TIMEOUT {
            self.halt(HaltReason::NotShown);
        }
        self.watch_faults(seen, now);
        self.watch_held(seen.status, now);
        if std::mem::take(&mut self.stops) && self.is_live {
            self.holds = false;
            self.is_holding = false;
            return Some(ExhibitOrder::Stop);
        }
        if std::mem::take(&mut self.grants) {
            return Some(ExhibitOrder::Grant);
        }
        if std::mem::take(&mut self.holds) {
            self.is_holding = true;
            return Some(ExhibitOrder::Hold);
        }
        if std::mem::take(&mut self.clears) {
            return Some(ExhibitOrder::Clear);
        }
        if self.is_holding {
            return None;
        }
        if self.permitted {
            self.go_on(now);
        }
        self.moves(seen.status, now)
    }

    /// The hand did not answer, be it for a moment.
    pub fn link_lost(&mut self) {
        if std::mem::replace(&mut self.is_live, false) {
            self.events.push(ExhibitEvent::LinkLost);
        }
        self.halt(HaltReason::NoHand);
        self.phase = Phase::Halted(HaltReason::NoHand);
    }

    /// A link that is lost, a stop, or another who talks to the hand ends the permission to move.
    fn watch_link(&mut self, seen: ExhibitInput<'_>) {
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
        let why = match seen.ended {
            _ if seen.status.other_controller => Some(HaltReason::OtherController),
            None => None,
            Some(Disarmed::Fault) => Some(HaltReason::Fault),
            Some(Disarmed::Resume) => Some(HaltReason::Slept),
            Some(Disarmed::OtherController) => Some(HaltReason::OtherController),
            Some(Disarmed::LinkLost) => Some(HaltReason::LinkLost),
            Some(Disarmed::Stale | Disarmed::FrozenFeedback) => Some(HaltReason::NoFeedback),
            Some(Disarmed::Stop) => Some(HaltReason::Stopped),
            Some(
                Disarmed::Person
                | Disarmed::Released
                | Disarmed::Silent
                | Disarmed::Hot
                | Disarmed::HeatUnknown,
            ) => Some(HaltReason::NotArmed),
        };
        if let Some(why) = why.filter(|_| self.permitted && !self.grants) {
            self.halt(why);
        }
    }

    /// Faults are cleared by themselves where that may be, and need the user where not.
    fn watch_faults(&mut self, seen: ExhibitInput<'_>, now: Moment) {
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
            let told = faults.iter().copied().map(ExhibitEvent::Fault);
            self.events.extend(told);
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
        // The link may know of a fault a moment before it is read here; nothing passes meanwhile.
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
        // The link disarmed, and what played ends with that.
        self.holds = false;
        self.is_holding = false;
        self.motion = Playback::None;
        self.asked = None;
        self.epoch = None;
    }

    /// A tile that is held arms again, where visitors may.
    fn watch_held(&mut self, status: &LinkStatus, now: Moment) {
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

    /// What time and heat change.
    fn go_on(&mut self, now: Moment) {
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
                self.events.push(ExhibitEvent::Rest);
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
            Phase::Visit { tile, .. } => self.go_on_visiting(tile, now),
            Phase::Attract { until } => self.go_on_attracting(until, now),
            Phase::Idle => self.attract(now),
        }
    }

    fn go_idle(&mut self, now: Moment) {
        self.phase = Phase::Idle;
        self.rest(now);
    }

    fn go_on_visiting(&mut self, tile: Option<usize>, now: Moment) {
        let piece = tile.and_then(|tile| self.plan.tiles.get(tile));
        let again = piece.is_some_and(|piece| piece.again);
        let reacts = piece.is_some_and(|piece| piece.plan.reaction.is_some());
        match self.motion {
            Playback::Done { .. } if again => self.play_tile(tile),
            Playback::Done { .. } if now.since(self.quiet_since) >= GONE_TIMEOUT => {
                self.go_idle(now)
            }
            // It has no end of its own at which it would be played more slowly.
            Playback::Plays if reacts && self.level > self.played_at => self.play_tile(tile),
            // The hand was not armed in time.
            Playback::None => self.go_idle(now),
            _ => {}
        }
    }

    fn go_on_attracting(&mut self, until: Moment, now: Moment) {
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

    /// Brings the motion that is wanted to the hand.
    fn moves(&mut self, status: &LinkStatus, now: Moment) -> Option<ExhibitOrder> {
        if self.asked.is_some() && status.state == LinkState::Armed {
            self.asked = None;
            self.epoch = status.armed;
        }
        let is_late = |at| now.since(at) >= ARM_TIMEOUT;
        if self.asked.take_if(|at| is_late(*at)).is_some() {
            self.motion = Playback::None;
            // Nor is it armed later.
            return Some(ExhibitOrder::Rest);
        }
        let is_resting = matches!(self.phase, Phase::Idle | Phase::Cooling { .. });
        let is_disarmed = status.state == LinkState::Monitoring && status.armed.is_none();
        match &self.motion {
            Playback::Done { .. } if is_resting => {
                self.motion = Playback::None;
                self.epoch = None;
                Some(ExhibitOrder::Rest)
            }
            Playback::Waits(plan) if self.epoch.is_some() && self.epoch == status.armed => {
                let plan = plan.clone();
                self.motion = Playback::Plays;
                Some(ExhibitOrder::Play(plan))
            }
            Playback::Waits(_) if self.asked.is_none() && is_disarmed => {
                self.asked = Some(now);
                Some(ExhibitOrder::Arm(self.plan.limits.arm_request()))
            }
            _ => None,
        }
    }
}
