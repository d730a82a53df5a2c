//! A hold whose conditions are watched, so that it can be saved as a grasp. A grasp of another hand is confirmed first: five closes, in
//! each of which the user lifts the object and puts it down again. The hand opens only once the load is off its fingertips and the user
//! says that the object stands: a load that is gone may also be carried by the user's other hand.

use crate::hand::grip::{Grip, GripEstimator, TightenCause, Tightened};
use crate::hand::{AngleReading, ArmEpoch, Groups, HandSample, Moment, PerDof};
use crate::link::{ArmRequest, PollRates};
use crate::motion::grasp::confirm::{Agreement, CLOSES, ConfirmingHand};
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::saved::Grasp;
use crate::motion::grasp::seen::{CloseSeen, Ending, GraspLabel, GraspWatch, NoGrasp, grasp};
use crate::motion::hold::{HoldEnd, HoldRun, HoldStart, HoldView, RATES};
use crate::motion::move_to::{MoveEnd, MoveStart, Moving};
use crate::motion::program::{Ended, Order, Program, Seen};
use crate::poses::way::Targets;
use crate::record::Abort;
use serde::Serialize;
use std::collections::VecDeque;
use std::time::Duration;

/// Shortest hold of a close that confirms.
const HELD_LEAST: Duration = Duration::from_secs(2);
/// Rise of the load along the fingertips from which the object counts as lifted, N.
const LIFTED_N: f64 = 0.1;
/// Share of that rise below which it counts as put down, and for how long.
const DOWN_SHARE: f64 = 0.35;
const DOWN_DURATION: Duration = Duration::from_millis(700);
/// Maximum time for the user to lift it and put it down, and then to say that it stands.
const LIFT_TIMEOUT: Duration = Duration::from_secs(90);
/// Time in which the user puts the object back in its place.
const PLACE_DURATION: Duration = Duration::from_secs(2);

/// Settings with which a watched hold starts.
#[derive(Debug, Clone)]
pub struct GraspStart {
    /// The hold.
    pub hold: HoldStart,
    /// The grasp of another hand to confirm before; `None` for a hold that the user chose, or that is trusted.
    pub unconfirmed: Option<Unconfirmed>,
}

/// A grasp of another hand.
#[derive(Debug, Clone)]
pub struct Unconfirmed {
    /// The grasp.
    pub grasp: Grasp,
    /// Newtons for a gram of each joint of this hand.
    pub newtons: PerDof<Option<f64>>,
}

/// Part of a close that confirms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ConfirmStep {
    /// The hand closes.
    Close,
    /// The user lifts the object.
    Lift,
    /// The user puts it down.
    PutDown,
    /// The load is gone, and the hand waits for the user to say that the object stands by itself.
    Release,
    /// The hand opens.
    Open,
}

/// User input while a watched hold runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GraspInput {
    /// The object stands by itself, so the hand may open. Ignored outside [`ConfirmStep::Release`].
    PutDown,
    /// End the hold.
    Abort(Abort),
}

/// Progress of a confirmation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Confirming {
    /// Number of the close, from 1.
    pub close: usize,
    /// Number of all closes.
    pub of: usize,
    /// Part of the close.
    pub step: ConfirmStep,
}

/// A watched hold for display.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GraspView {
    /// The hold.
    #[serde(flatten)]
    pub hold: HoldView,
    /// Progress of the confirmation; `None` without one, and once it is over.
    pub confirming: Option<Confirming>,
}

/// A confirmation under way.
#[derive(Debug)]
struct ConfirmRun {
    unconfirmed: Unconfirmed,
    closes: Vec<CloseSeen>,
    /// Smallest load while the object was held, N.
    least_n: f64,
    /// Time since which the load is gone.
    down_since: Option<Moment>,
    /// The load is gone, and the user may say that the object stands.
    asks: bool,
    opening: Option<Reopening>,
}

/// The hand opens, and the user puts the object back.
#[derive(Debug)]
struct Reopening {
    motion: Moving,
    opened: Option<Moment>,
}

/// The program of a watched hold.
#[derive(Debug)]
pub struct GraspRun {
    start: HoldStart,
    duration: Option<Duration>,
    epoch: ArmEpoch,
    hold: HoldRun,
    watch: GraspWatch,
    grip: GripEstimator,
    /// Angles before the first close.
    open_at: Option<Targets>,
    confirmation: Option<ConfirmRun>,
    agreement: Option<Agreement>,
    trusted: Option<Moment>,
    events: VecDeque<Tightened>,
    end: Option<Ended<Result<HoldEnd, GraspDoubt>>>,
}

impl GraspRun {
    /// A hold under this arming.
    pub fn new(epoch: ArmEpoch, start: GraspStart, now: Moment) -> Self {
        let mut hold = start.hold;
        let duration = hold.duration;
        let confirmation = start.unconfirmed.map(ConfirmRun::of);
        if confirmation.is_some() {
            // Its time begins once it is trusted.
            hold.duration = None;
        }
        Self {
            hold: HoldRun::new(epoch, hold.clone(), now),
            grip: hold.grip.clone(),
            start: hold,
            duration,
            epoch,
            watch: GraspWatch::new(),
            open_at: None,
            confirmation,
            agreement: None,
            trusted: None,
            events: VecDeque::new(),
            end: None,
        }
    }

    /// Time for which it has held; `None` if it never did.
    pub fn held_for(&self, now: Moment) -> Option<Duration> {
        self.hold.held_for(now)
    }

    /// Grip at the end of the readings.
    pub fn grip(&self) -> Grip {
        self.grip.grip()
    }

    /// How the closes agree with the grasp that they confirmed; `None` without that.
    pub const fn agreement(&self) -> Option<Agreement> {
        self.agreement
    }

    /// Checks that a hold that has ended can be saved.
    ///
    /// # Errors
    /// [`NoGrasp`]: it did not work, or not as a grasp can be repeated.
    pub fn worked(&self, now: Moment) -> Result<(), NoGrasp> {
        self.ending(now)
            .and_then(|ending| ending.worked(&self.watch.seen()))
    }

    /// The grasp of a hold that has ended.
    ///
    /// # Errors
    /// As [`worked`](Self::worked).
    pub fn grasp(&self, about: GraspLabel, now: Moment) -> Result<Grasp, NoGrasp> {
        grasp(&self.watch.seen(), &self.ending(now)?, about)
    }

    fn ending(&self, now: Moment) -> Result<Ending<'_>, NoGrasp> {
        let end = match self.end {
            Some(Ok(Ok(end))) => Ok(end),
            Some(Err(why)) => Err(why),
            Some(Ok(Err(_))) | None => return Err(NoGrasp::Failed),
        };
        Ok(Ending {
            end,
            held: self.held_for(now),
            has_closed: self.hold.has_closed(),
            tightened: self.hold.view(now).tightened,
            close: self.start.close,
            forces: self.start.forces,
            reading_per_g: &self.start.reading_per_g,
        })
    }
}

impl Program for GraspRun {
    type Input = GraspInput;
    type Outcome = Result<HoldEnd, GraspDoubt>;
    type View = GraspView;
    type Event = Tightened;
    const RATES: Option<PollRates> = Some(RATES);

    fn input(&mut self, input: GraspInput, seen: &Seen<'_>) -> Option<Order> {
        match input {
            GraspInput::PutDown if self.asks() && self.end.is_none() => self.judge(seen),
            GraspInput::PutDown => None,
            GraspInput::Abort(why) => {
                self.abort(why, seen.now);
                None
            }
        }
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        self.grip.apply(sample, fresh, now);
        if let Some(opening) = self.opening() {
            opening.motion.read(sample, fresh, now);
            return;
        }
        self.hold.read(sample, fresh, now);
        self.watch.read(&self.hold, sample, fresh, now);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        if self.end.is_some() {
            return None;
        }
        if self.open_at.is_none() {
            let angles = seen.angles().map(|angles| angles.value);
            self.open_at = angles.map(|angles| angles.map(AngleReading::hold));
        }
        if self.is_opening() {
            return self.open(seen);
        }
        let order = self.hold.tick(seen);
        while let Some(tightened) = self.hold.event() {
            if tightened.cause == TightenCause::Slip {
                self.watch.slid();
            }
            self.events.push_back(tightened);
        }
        if let Some(end) = self.hold.ended() {
            self.end = Some(end.map(|end| self.outcome(end)));
            return order;
        }
        let is_over = |since: Moment| {
            let duration = self.duration.unwrap_or(Duration::MAX);
            seen.now.since(since) >= duration
        };
        if self.trusted.is_some_and(is_over) {
            self.end = Some(Ok(Ok(HoldEnd::Held)));
            return Some(Order::Disarm);
        }
        self.confirm(seen).or(order)
    }

    fn abort(&mut self, why: Abort, now: Moment) {
        self.hold.abort(why, now);
        self.end.get_or_insert(Err(why));
    }

    fn view(&self, now: Moment) -> GraspView {
        let is_opening = self.is_opening();
        GraspView {
            hold: match is_opening {
                true => HoldView::first(self.start.forces),
                false => self.hold.view(now),
            },
            confirming: self.confirmation.as_ref().map(|own| Confirming {
                close: own.nth(),
                of: CLOSES,
                step: match self.hold.held_for(now) {
                    _ if is_opening => ConfirmStep::Open,
                    None => ConfirmStep::Close,
                    Some(_) if own.asks => ConfirmStep::Release,
                    Some(_) if own.is_lifted(&self.watch) => ConfirmStep::PutDown,
                    Some(_) => ConfirmStep::Lift,
                },
            }),
        }
    }

    fn event(&mut self) -> Option<Tightened> {
        self.events.pop_front()
    }

    fn ended(&self) -> Option<Ended<Result<HoldEnd, GraspDoubt>>> {
        self.end
    }
}

/// The confirmation.
impl GraspRun {
    fn is_opening(&self) -> bool {
        let confirmation = self.confirmation.as_ref();
        confirmation.is_some_and(|own| own.opening.is_some())
    }

    /// True while the hand opens as soon as the user says that the object stands.
    fn asks(&self) -> bool {
        let confirmation = self.confirmation.as_ref();
        confirmation.is_some_and(|own| own.asks && own.opening.is_none())
    }

    /// The outcome of a hold that ended by itself.
    fn outcome(&self, end: HoldEnd) -> Result<HoldEnd, GraspDoubt> {
        match (&self.confirmation, end) {
            (Some(own), HoldEnd::Lost) => Err(GraspDoubt::Lost { close: own.nth() }),
            _ => Ok(end),
        }
    }

    /// Follows the load of a close that confirms. The last close is judged once the object is put down, and the hand holds on; after the
    /// others the hand opens, so the user has to say first that the object stands.
    fn confirm(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let own = self.confirmation.as_mut()?;
        let held = self.hold.held_for(seen.now)?;
        let close = own.nth();
        let is_put_down = own.is_put_down(&self.watch, seen.now) && held >= HELD_LEAST;
        own.asks = is_put_down && close < CLOSES;
        let (waited, doubt) = match own.down_since.filter(|_| own.asks) {
            Some(since) => (seen.now.since(since), GraspDoubt::NotReleased { close }),
            None => (held, GraspDoubt::NoLoad { close }),
        };
        if is_put_down && !own.asks {
            return self.judge(seen);
        }
        (waited > LIFT_TIMEOUT).then(|| self.doubt(doubt))
    }

    /// Judges the close that is over.
    fn judge(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let own = self.confirmation.as_mut()?;
        let nth = own.nth();
        let shown = self.watch.seen();
        let hand = ConfirmingHand {
            grasp: &own.unconfirmed.grasp,
            newtons: &own.unconfirmed.newtons,
            reading_per_g: &self.start.reading_per_g,
        };
        let judged = if self.hold.has_closed() {
            hand.judge_close(nth, &shown)
        } else {
            Err(GraspDoubt::NotClosed { close: nth })
        };
        own.closes.push(shown);
        let judged = judged.and_then(|()| match own.closes.len() {
            CLOSES => hand.judge(&own.closes).map(Some),
            _ => Ok(None),
        });
        match judged {
            Err(doubt) => Some(self.doubt(doubt)),
            Ok(None) => self.begin_opening(seen),
            Ok(agreement) => {
                self.agreement = agreement;
                self.trusted = Some(seen.now);
                self.confirmation = None;
                None
            }
        }
    }

    /// Ends without trust. The hand keeps its position, and so what it holds.
    fn doubt(&mut self, doubt: GraspDoubt) -> Order {
        self.end = Some(Ok(Err(doubt)));
        Order::Disarm
    }

    /// Opens the joints that closed, to where they were.
    fn begin_opening(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let locked = self.start.locked;
        let open_at = self.open_at.unwrap_or_default();
        let start = MoveStart {
            targets: PerDof::from_fn(|dof| open_at[dof].filter(|_| !locked[dof])),
            limits: ArmRequest::GENTLE,
            settles: false,
            grip: self.grip.clone(),
        };
        self.confirmation.as_mut()?.opening = Some(Reopening {
            motion: Moving::new(self.epoch, start, seen.now),
            opened: None,
        });
        self.open(seen)
    }

    fn opening(&mut self) -> Option<&mut Reopening> {
        self.confirmation.as_mut()?.opening.as_mut()
    }

    /// Opens, waits for the user to put the object back, and closes again.
    fn open(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let opening = self.opening()?;
        if let Some(opened) = opening.opened {
            if seen.now.since(opened) >= PLACE_DURATION {
                self.close_again(seen.now);
            }
            return None;
        }
        let order = opening.motion.tick(seen);
        match opening.motion.ended() {
            Some(Ok(MoveEnd::Reached)) => opening.opened = Some(seen.now),
            Some(_) => {
                self.end = Some(Ok(Ok(HoldEnd::Late)));
                return Some(Order::Stop);
            }
            None => {}
        }
        order
    }

    fn close_again(&mut self, now: Moment) {
        if let Some(own) = &mut self.confirmation {
            (own.opening, own.down_since, own.least_n) = (None, None, f64::INFINITY);
            own.asks = false;
        }
        let start = HoldStart {
            grip: self.grip.clone(),
            ..self.start.clone()
        };
        self.hold = HoldRun::new(self.epoch, start, now);
        self.watch = GraspWatch::new();
    }
}

impl ConfirmRun {
    const fn of(unconfirmed: Unconfirmed) -> Self {
        Self {
            unconfirmed,
            closes: Vec::new(),
            least_n: f64::INFINITY,
            down_since: None,
            asks: false,
            opening: None,
        }
    }

    /// Number of the close under way, or of the last one while the hand opens, from 1.
    fn nth(&self) -> usize {
        self.closes.len() + usize::from(self.opening.is_none())
    }

    /// Rise of the load since it was least, N.
    fn rise_n(&self, load_n: Option<f64>) -> f64 {
        load_n.map_or(0.0, |load_n| load_n - self.least_n)
    }

    fn is_lifted(&self, watch: &GraspWatch) -> bool {
        self.rise_n(watch.load_n()) >= LIFTED_N
    }

    /// True once the load has come, and is gone for a while.
    fn is_put_down(&mut self, watch: &GraspWatch, now: Moment) -> bool {
        let Some(load_n) = watch.load_now_n(now) else {
            self.down_since = None;
            return false;
        };
        self.least_n = self.least_n.min(load_n);
        let is_down = self.is_lifted(watch)
            && self.rise_n(Some(load_n)) <= DOWN_SHARE * self.rise_n(watch.load_n());
        let since = is_down.then(|| self.down_since.unwrap_or(now));
        self.down_since = since;
        since.is_some_and(|since| now.since(since) >= DOWN_DURATION)
    }
}
