//! DDS commands as a source for a hand to follow: one sender at a time, in order, counted.

use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::inputs::dds::ctrl::{self, CtrlFault, CtrlMessage};
use crate::inputs::dds::motors;
use crate::inputs::dds::ros::{self, JointNames};
use crate::inputs::offer::{END_TIMEOUT, Offer, OfferOutlet, SourceSite, is_fresh};
use crate::link::stats::EventRate;
use crate::link::{ArmRequest, Owner};
use crate::transport::dds::{DdsMessage, DdsNode, DdsWriterId};
use std::collections::BTreeMap;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::interval;
use tokio_util::task::AbortOnDropHandle;

/// Interval at which the statistics are published.
const REPORT_INTERVAL: Duration = Duration::from_millis(50);

/// Current state of the source.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DdsView {
    /// Current sender, and the time of its last message.
    pub sender: Option<(DdsWriterId, Moment)>,
    /// Messages per second.
    pub rate_hz: f64,
    /// Accepted messages.
    pub taken: u64,
    /// Refused messages, by reason.
    pub refused: BTreeMap<CtrlFault, u64>,
    /// Messages without a follower, because the user has not granted control.
    pub not_granted: u64,
    /// Messages that stopped the hand although something else in them was wrong.
    pub odd_stops: u64,
    /// The last of them: its sender, and the error.
    pub last_odd: Option<(DdsWriterId, CtrlFault)>,
}

impl DdsView {
    /// Owner as which it would control the hand at `now`; `None` without a current sender.
    pub fn owner(&self, now: Moment) -> Option<Owner> {
        let (_, last) = self.sender?;
        is_fresh(last, now).then_some(Owner::Dds)
    }
}

/// Incoming messages.
#[derive(Debug)]
pub struct DdsCommands {
    /// For this hand, as registers.
    pub ctrl: mpsc::Receiver<DdsMessage>,
    /// For both hands of a robot, as motors.
    pub motors: mpsc::Receiver<DdsMessage>,
    /// For this hand, as ROS 2's trajectories.
    pub trajectories: mpsc::Receiver<DdsMessage>,
    /// For this hand, as ROS 2's positions of joints.
    pub positions: mpsc::Receiver<DdsMessage>,
}

impl DdsCommands {
    /// Receives messages for the hand of this side from now on. Must be called within a tokio runtime.
    pub fn of(node: &DdsNode, side: Side) -> Self {
        Self {
            ctrl: node.reader(&ctrl::topic(side), ctrl::KEPT),
            motors: node.reader(&motors::topic(), ctrl::KEPT),
            trajectories: node.reader(&ros::trajectory_topic(side), ctrl::KEPT),
            positions: node.reader(&ros::position_topic(side), ctrl::KEPT),
        }
    }
}

/// An open source. Receives messages until dropped.
#[derive(Debug)]
pub struct DdsSource {
    view: watch::Receiver<DdsView>,
    outlet: OfferOutlet,
    _task: AbortOnDropHandle<()>,
}

impl DdsSource {
    /// Receives these messages from now on; `allowed` are the highest speeds and forces that one may request. Must be called within a tokio runtime.
    pub fn open(allowed: ArmRequest, site: SourceSite, commands: DdsCommands) -> Self {
        let (views, view) = watch::channel(DdsView::default());
        let outlet = OfferOutlet::default();
        let receiver = DdsReceiver {
            allowed,
            joints: JointNames::of(site.side),
            site,
            view: DdsView::default(),
            rate: EventRate::default(),
            outlet: outlet.clone(),
            views,
        };
        Self {
            view,
            outlet,
            _task: AbortOnDropHandle::new(tokio::spawn(receiver.run(commands))),
        }
    }

    /// Current state.
    pub fn view(&self) -> DdsView {
        self.view.borrow().clone()
    }

    /// Receives its targets from now on; replaces the previous follower.
    pub fn follow(&self) -> mpsc::Receiver<Offer> {
        self.outlet.follow()
    }
}

struct DdsReceiver {
    allowed: ArmRequest,
    joints: JointNames,
    site: SourceSite,
    view: DdsView,
    rate: EventRate,
    outlet: OfferOutlet,
    views: watch::Sender<DdsView>,
}

impl DdsReceiver {
    async fn run(mut self, mut commands: DdsCommands) {
        let mut tick = interval(REPORT_INTERVAL);
        loop {
            tokio::select! {
                message = commands.ctrl.recv() => match message {
                    Some(message) => self.receive_ctrl(&message),
                    None => return self.publish(),
                },
                Some(message) = commands.motors.recv() => {
                    let asked = motors::parse(&message.bytes, self.site.side);
                    self.receive(message.from, asked);
                }
                Some(message) = commands.trajectories.recv() => self.receive_trajectory(&message),
                Some(message) = commands.positions.recv() => {
                    let asked = self.joints.positions(&message.bytes);
                    self.receive(message.from, asked);
                }
                _ = tick.tick() => self.publish(),
            }
        }
    }

    fn receive_ctrl(&mut self, message: &DdsMessage) {
        let is_stop = ctrl::is_stop(&message.bytes);
        if is_stop {
            (self.site.stop)();
        }
        let asked = CtrlMessage::parse(&message.bytes, &self.allowed);
        if is_stop {
            self.stopped(message.from, asked.err());
        } else {
            self.receive(message.from, asked);
        }
    }

    fn receive_trajectory(&mut self, message: &DdsMessage) {
        if ros::is_stop(&message.bytes) {
            (self.site.stop)();
            self.stopped(message.from, None);
        } else {
            let asked = self.joints.trajectory(&message.bytes);
            self.receive(message.from, asked);
        }
    }

    fn receive(&mut self, from: DdsWriterId, asked: Result<CtrlMessage, CtrlFault>) {
        let now = self.site.clock.now();
        let asked = asked.and_then(|asked| self.in_turn(from, now).map(|()| asked));
        let asked = match asked {
            Ok(asked) => asked,
            Err(fault) => {
                *self.view.refused.entry(fault).or_default() += 1;
                return;
            }
        };
        let is_new = self
            .views
            .borrow()
            .sender
            .is_none_or(|(sender, last)| sender != from || !is_fresh(last, now));
        self.view.taken += 1;
        self.rate.hit(now);
        let offer = Offer {
            at: now,
            aims: asked.aims,
            gap: None,
            hold: None,
            limits: asked.limits,
            held: None,
            mark: Some(asked.mark),
        };
        self.view.not_granted += u64::from(!self.outlet.offer(offer));
        if is_new {
            // A user may be waiting for a sender to follow.
            self.publish();
        }
    }

    /// Counts a stop and any error in its message.
    fn stopped(&mut self, from: DdsWriterId, odd: Option<CtrlFault>) {
        self.view.taken += 1;
        self.rate.hit(self.site.clock.now());
        if let Some(odd) = odd {
            self.view.odd_stops += 1;
            self.view.last_odd = Some((from, odd));
        }
    }

    /// Accepts one sender until it is silent; Unitree's programs do not number their messages.
    fn in_turn(&mut self, from: DdsWriterId, now: Moment) -> Result<(), CtrlFault> {
        let is_other =
            |(sender, last): (DdsWriterId, Moment)| sender != from && now.since(last) < END_TIMEOUT;
        if self.view.sender.is_some_and(is_other) {
            return Err(CtrlFault::OtherSender);
        }
        self.view.sender = Some((from, now));
        Ok(())
    }

    fn publish(&mut self) {
        self.view.rate_hz = self.rate.hz(self.site.clock.now());
        let is_news = self.views.send_if_modified(|view| {
            let is_news = *view != self.view;
            if is_news {
                view.clone_from(&self.view);
            }
            is_news
        });
        if is_news {
            (self.site.wake)();
        }
    }
}
