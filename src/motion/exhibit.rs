//! An exhibition at a hand: the only one that moves it while it lasts. What happens when is decided in `exhibit`; here it is done.

use crate::exhibit::plan::ExhibitPlan;
use crate::exhibit::run::{
    ExhibitEvent, ExhibitInput, ExhibitOrder, ExhibitRun, ExhibitView, ExhibitWish,
};
use crate::hand::grip::GripEstimator;
use crate::hand::{HandCommand, HandSample, Moment, PerDof, Setpoints};
use crate::link::{Clock, Lease, LeaseRefusal, LinkHandle, Owner};
use crate::motion::drive::Armed;
use crate::motion::play::{PlayCommand, PlayStart, PlayStep, play};
use crate::poses::player::{PlayMode, PlayPlan};
use crate::record::{Disarmed, Record};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;
use tokio::time::timeout;

/// How often time is looked at where nothing is read.
const TICK: Duration = Duration::from_millis(50);

/// What an exhibition begins with.
#[derive(Debug, Clone)]
pub struct ExhibitStart {
    /// Motions that visitors may start, and their limits.
    pub plan: Arc<ExhibitPlan>,
    /// Joints that are left alone.
    pub locked: PerDof<bool>,
    /// What was read until now.
    pub seen: HandSample,
    /// What is gripped, from that.
    pub grip: GripEstimator,
    /// The program's clock.
    pub clock: Clock,
    /// When visitors and staff saw the page last.
    pub drawn: Arc<PageDrawn>,
}

/// When the page of an exhibition was drawn last: the sign of life of its window.
#[derive(Debug, Default)]
pub struct PageDrawn(AtomicU64);

impl PageDrawn {
    /// Notes that the page was drawn; the hand is stopped if this stays out.
    pub fn mark(&self, now: Moment) {
        self.0.store(now.micros(), Ordering::Relaxed);
    }

    fn last(&self) -> Moment {
        Moment::from_micros(self.0.load(Ordering::Relaxed))
    }
}

/// What is told on the way.
#[derive(Debug, Clone, PartialEq)]
pub enum ExhibitStep {
    /// Something else goes on now.
    View(ExhibitView),
    /// The hand was told this.
    Sent(Setpoints),
    /// Event for the report of the day.
    Event(ExhibitEvent),
}

/// Runs until nobody wishes anything any more; then what plays is held and the hand disarmed. Writes nothing before the user arms.
pub async fn exhibit(
    hand: &LinkHandle,
    start: ExhibitStart,
    mut wishes: mpsc::Receiver<ExhibitWish>,
    mut tell: impl FnMut(ExhibitStep),
) {
    let clock = start.clock;
    let mut records = hand.records();
    let (told, mut sent) = watch::channel(None);
    let mut at = ExhibitTask {
        hand,
        run: ExhibitRun::new(start.plan, clock.now()),
        locked: start.locked,
        sample: start.seen,
        grip: start.grip,
        playing: None,
        lease: None,
        told,
        clock,
        drawn: start.drawn,
    };
    let mut shown = None;
    loop {
        at.obey_all();
        at.run
            .take_events()
            .into_iter()
            .for_each(|event| tell(ExhibitStep::Event(event)));
        let view = at.run.view(clock.now());
        if shown.replace(view) != Some(view) {
            tell(ExhibitStep::View(view));
        }
        tokio::select! {
            biased;
            wish = wishes.recv() => match wish {
                Some(wish) => at.run.wish(wish, clock.now()),
                None => break,
            },
            Ok(()) = sent.changed() => {
                let mut untold = None;
                at.told.send_if_modified(|waiting| {
                    untold = waiting.take();
                    false
                });
                untold.into_iter().for_each(|setpoints| tell(ExhibitStep::Sent(setpoints)));
            }
            () = ended(&mut at.playing) => at.run.ended(clock.now()),
            record = timeout(TICK, records.next()) => match record {
                Ok(Some(Record::Reading { sample, fresh })) => {
                    at.sample = *sample;
                    at.grip.take(&sample, fresh, sample.newest(fresh).unwrap_or_default());
                }
                // A link may be back before anybody looks at its state.
                Ok(Some(Record::State { state, .. })) if !state.is_live() => at.run.link_lost(),
                _ => {}
            }
        }
    }
    if at.playing.is_some() || hand.status().armed.is_some() {
        hand.stop();
    }
}

/// A piece that plays.
struct PlayingPiece {
    commands: mpsc::Sender<PlayCommand>,
    task: JoinHandle<()>,
}

/// Waits for the end of a piece, for ever if there is none.
async fn ended(playing: &mut Option<PlayingPiece>) {
    match playing {
        Some(piece) => {
            // However it ended: why is seen at the link.
            let _end = (&mut piece.task).await;
            *playing = None;
        }
        None => std::future::pending().await,
    }
}

struct ExhibitTask<'a> {
    hand: &'a LinkHandle,
    run: ExhibitRun,
    locked: PerDof<bool>,
    sample: HandSample,
    grip: GripEstimator,
    playing: Option<PlayingPiece>,
    /// What the user granted; it may have ended.
    lease: Option<Lease>,
    /// What the hand was told since that was told last, each joint's newest.
    told: watch::Sender<Option<Setpoints>>,
    clock: Clock,
    drawn: Arc<PageDrawn>,
}

impl ExhibitTask<'_> {
    fn obey_all(&mut self) {
        loop {
            let status = self.hand.status();
            let refused = self.lease.and_then(|lease| self.hand.check(lease).err());
            let seen = ExhibitInput {
                status: &status,
                sample: &self.sample,
                ended: refused.map(|refused| match refused {
                    LeaseRefusal::Ended(why) => why,
                    LeaseRefusal::Taken(_) => Disarmed::Person,
                }),
                drawn: self.drawn.last(),
            };
            match self.run.tick(seen, self.clock.now()) {
                Some(order) => self.obey(order),
                None => return,
            }
        }
    }

    fn obey(&mut self, order: ExhibitOrder) {
        match order {
            ExhibitOrder::Grant => self.lease = Some(self.hand.grant(Owner::Exhibition)),
            // A lease that ended is seen in the next step.
            ExhibitOrder::Arm(request) => {
                let _asked = self.lease.map(|lease| self.hand.arm(lease, request));
            }
            ExhibitOrder::Rest => {
                let _rests = self.lease.map(|lease| self.hand.rest(lease));
            }
            ExhibitOrder::Stop => {
                self.playing = None;
                self.hand.stop();
            }
            ExhibitOrder::Hold => match &self.playing {
                // It holds where the hand is, and ends; one that has ended already says so anyway.
                Some(piece) => drop(piece.commands.try_send(PlayCommand::End)),
                None => self.run.ended(self.clock.now()),
            },
            ExhibitOrder::Play(plan) => self.play(plan),
            ExhibitOrder::Clear => {
                self.playing = None;
                let hand = self.hand.clone();
                // Whether it helped is seen at the link.
                tokio::spawn(async move { hand.write(HandCommand::ClearErrors).await });
            }
        }
    }

    fn play(&mut self, plan: PlayPlan) {
        let Some((epoch, lease)) = self.hand.status().armed.zip(self.lease) else {
            return;
        };
        let start = PlayStart {
            plan,
            pace: PlayMode::Through,
            locked: self.locked,
            grip: self.grip.clone(),
        };
        let armed = Armed {
            epoch,
            lease,
            seen: self.sample,
            clock: self.clock,
        };
        let (commands, wanted) = mpsc::channel(1);
        let (hand, told) = (self.hand.clone(), self.told.clone());
        let task = tokio::spawn(async move {
            let tell = |step| {
                if let PlayStep::Sent(setpoints) = step {
                    told.send_modify(|untold| match untold {
                        Some(untold) => untold.merge(&setpoints),
                        None => *untold = Some(setpoints),
                    });
                }
            };
            let _end = play(&hand, armed, start, wanted, tell).await;
        });
        self.playing = Some(PlayingPiece { commands, task });
    }
}
