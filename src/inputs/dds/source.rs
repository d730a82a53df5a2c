//! Messages over DDS as a source that a hand can follow: one sender at a time, in order, counted.

use crate::hand::Moment;
use crate::inputs::dds::ctrl::{CtrlFault, CtrlMessage};
use crate::inputs::follow::{ENDS_AFTER, is_fresh};
use crate::inputs::offer::{Offer, OfferOutlet};
use crate::link::rate::EventRate;
use crate::link::{ArmRequest, Clock, Owner, Wake};
use crate::transport::dds::{DdsMessage, DdsWriterId};
use std::collections::BTreeMap;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::interval;
use tokio_util::task::AbortOnDropHandle;

/// How often it is told what came in.
const TELL_EACH: Duration = Duration::from_millis(50);

/// What is taken from DDS.
#[derive(Clone)]
pub struct DdsSourceConfig {
    /// The highest speeds and forces that a message may ask for.
    pub allowed: ArmRequest,
    /// The program's clock.
    pub clock: Clock,
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
}

impl DdsView {
    /// As whom it would move the hand at `now`; `None` while nobody sends.
    pub fn owner(&self, now: Moment) -> Option<Owner> {
        let (_, last) = self.sender?;
        is_fresh(last, now).then_some(Owner::Dds)
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
    pub fn open(config: DdsSourceConfig, messages: mpsc::Receiver<DdsMessage>) -> Self {
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
            _task: AbortOnDropHandle::new(tokio::spawn(taking.run(messages))),
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
    async fn run(mut self, mut messages: mpsc::Receiver<DdsMessage>) {
        let mut tell = interval(TELL_EACH);
        loop {
            tokio::select! {
                message = messages.recv() => match message {
                    Some(message) => self.take(&message),
                    None => return self.tell(),
                },
                _ = tell.tick() => self.tell(),
            }
        }
    }

    fn take(&mut self, message: &DdsMessage) {
        let now = self.config.clock.now();
        let asked = CtrlMessage::parse(&message.bytes, &self.config.allowed)
            .and_then(|asked| self.in_turn(message.from, now).map(|()| asked));
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
            .is_none_or(|(told, last)| told != message.from || !is_fresh(last, now));
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

    /// One sender is listened to until it is silent; Unitree's programs do not number their messages.
    fn in_turn(&mut self, from: DdsWriterId, now: Moment) -> Result<(), CtrlFault> {
        let is_other =
            |(sender, last): (DdsWriterId, Moment)| sender != from && now.since(last) < ENDS_AFTER;
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
