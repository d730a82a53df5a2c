//! Messages over DDS as a source that a hand can follow: one sender at a time, in order, counted.

use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::inputs::dds::ctrl::{self, CtrlFault, CtrlMessage};
use crate::inputs::dds::motors;
use crate::inputs::follow::{END_TIMEOUT, is_fresh};
use crate::inputs::offer::{Offer, OfferOutlet};
use crate::link::rate::EventRate;
use crate::link::{ArmRequest, Clock, Owner, Wake};
use crate::transport::dds::{DdsMessage, DdsNode, DdsWriterId};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::interval;
use tokio_util::task::AbortOnDropHandle;

/// How often it is told what came in.
const REPORT_INTERVAL: Duration = Duration::from_millis(50);

/// What is taken from DDS.
#[derive(Clone)]
pub struct DdsSourceConfig {
    /// Which of a robot's hands it is.
    pub side: Side,
    /// The highest speeds and forces that a message may ask for.
    pub allowed: ArmRequest,
    /// The program's clock.
    pub clock: Clock,
    /// Stops the hand. Called for each message that asks for it, whoever sent it.
    pub stop: Arc<dyn Fn() + Send + Sync>,
    /// Called when there is news. Must return at once.
    pub wake: Wake,
}

/// What is known of the source now.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DdsView {
    /// Who is listened to, and when a message of theirs came last.
    pub sender: Option<(DdsWriterId, Moment)>,
    /// Messages a second.
    pub rate_hz: f64,
    /// Messages that were taken.
    pub taken: u64,
    /// Messages that were refused, by reason.
    pub refused: BTreeMap<CtrlFault, u64>,
    /// Messages that nobody followed, as no user granted it.
    pub not_granted: u64,
    /// Messages that stopped the hand although something else in them was wrong.
    pub odd_stops: u64,
    /// The newest of them: its sender, and what was wrong.
    pub last_odd: Option<(DdsWriterId, CtrlFault)>,
}

impl DdsView {
    /// As whom it would move the hand at `now`; `None` while nobody sends.
    pub fn owner(&self, now: Moment) -> Option<Owner> {
        let (_, last) = self.sender?;
        is_fresh(last, now).then_some(Owner::Dds)
    }
}

/// Messages that come in.
#[derive(Debug)]
pub struct DdsCommands {
    /// To this hand, as registers.
    pub ctrl: mpsc::Receiver<DdsMessage>,
    /// To both hands of a robot, as motors.
    pub motors: mpsc::Receiver<DdsMessage>,
}

impl DdsCommands {
    /// Those that are sent to the hand of this side from now on. Must be called within a tokio runtime.
    pub fn of(node: &DdsNode, side: Side) -> Self {
        Self {
            ctrl: node.reader(&ctrl::topic(side), ctrl::KEPT),
            motors: node.reader(&motors::topic(), ctrl::KEPT),
        }
    }
}

/// An open source. Dropped, it takes nothing any more.
#[derive(Debug)]
pub struct DdsSource {
    view: watch::Receiver<DdsView>,
    outlet: OfferOutlet,
    _task: AbortOnDropHandle<()>,
}

impl DdsSource {
    /// Takes these messages from now on. Must be called within a tokio runtime.
    pub fn open(config: DdsSourceConfig, commands: DdsCommands) -> Self {
        let (told, view) = watch::channel(DdsView::default());
        let outlet = OfferOutlet::default();
        let taking = Taking {
            config,
            view: DdsView::default(),
            rate: EventRate::default(),
            outlet: outlet.clone(),
            told,
        };
        Self {
            view,
            outlet,
            _task: AbortOnDropHandle::new(tokio::spawn(taking.run(commands))),
        }
    }

    /// What is known of it.
    pub fn view(&self) -> DdsView {
        self.view.borrow().clone()
    }

    /// Its targets from now on, for whoever follows; whoever did before does no more.
    pub fn follow(&self) -> mpsc::Receiver<Offer> {
        self.outlet.follow()
    }
}

struct Taking {
    config: DdsSourceConfig,
    view: DdsView,
    rate: EventRate,
    outlet: OfferOutlet,
    told: watch::Sender<DdsView>,
}

impl Taking {
    async fn run(mut self, mut commands: DdsCommands) {
        let mut tell = interval(REPORT_INTERVAL);
        loop {
            tokio::select! {
                message = commands.ctrl.recv() => match message {
                    Some(message) => self.take_ctrl(&message),
                    None => return self.tell(),
                },
                Some(message) = commands.motors.recv() => {
                    let asked = motors::parse(&message.bytes, self.config.side);
                    self.take(message.from, asked);
                }
                _ = tell.tick() => self.tell(),
            }
        }
    }

    fn take_ctrl(&mut self, message: &DdsMessage) {
        let is_stop = ctrl::is_stop(&message.bytes);
        if is_stop {
            (self.config.stop)();
        }
        let asked = CtrlMessage::parse(&message.bytes, &self.config.allowed);
        if is_stop {
            self.stopped(message.from, asked.err());
        } else {
            self.take(message.from, asked);
        }
    }

    fn take(&mut self, from: DdsWriterId, asked: Result<CtrlMessage, CtrlFault>) {
        let now = self.config.clock.now();
        let asked = asked.and_then(|asked| self.in_turn(from, now).map(|()| asked));
        let asked = match asked {
            Ok(asked) => asked,
            Err(fault) => {
                *self.view.refused.entry(fault).or_default() += 1;
                return;
            }
        };
        let is_new = self
            .told
            .borrow()
            .sender
            .is_none_or(|(told, last)| told != from || !is_fresh(last, now));
        self.view.taken += 1;
        self.rate.hit(now);
        let offer = Offer {
            at: now,
            aims: asked.aims,
            gap: None,
            limits: asked.limits,
            held: None,
            mark: Some(asked.mark),
        };
        self.view.not_granted += u64::from(!self.outlet.offer(offer));
        if is_new {
            // Somebody may wait for one to follow.
            self.tell();
        }
    }

    /// Counts a stop, and what was odd about it.
    fn stopped(&mut self, from: DdsWriterId, odd: Option<CtrlFault>) {
        self.view.taken += 1;
        self.rate.hit(self.config.clock.now());
        if let Some(odd) = odd {
            self.view.odd_stops += 1;
            self.view.last_odd = Some((from, odd));
        }
    }

    /// One sender is listened to until it is silent; Unitree's programs do not number their messages.
    fn in_turn(&mut self, from: DdsWriterId, now: Moment) -> Result<(), CtrlFault> {
        let is_other =
            |(sender, last): (DdsWriterId, Moment)| sender != from && now.since(last) < END_TIMEOUT;
        if self.view.sender.is_some_and(is_other) {
            return Err(CtrlFault::OtherSender);
        }
        self.view.sender = Some((from, now));
        Ok(())
    }

    fn tell(&mut self) {
        self.view.rate_hz = self.rate.hz(self.config.clock.now());
        let is_news = self.told.send_if_modified(|told| {
            let is_news = *told != self.view;
            if is_news {
                told.clone_from(&self.view);
            }
            is_news
        });
        if is_news {
            (self.config.wake)();
        }
    }
}
