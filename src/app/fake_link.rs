//! A link that only notes what it is told, and a program on it, for the tests of the rules.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may")]

use crate::app::desk::Desk;
use crate::app::notices::NoticeKind;
use crate::app::seam::Link;
use crate::app::settings::Settings;
use crate::hand::{
    Angle, AngleReading, Dof, Faults, Group, Groups, HandSample, Moment, PerDof, Timed,
};
use crate::link::{
    ArmEpoch, ArmRequest, LinkEvent, LinkState, LinkStats, LinkStatus, PollRates, Request,
    RequestError, Setpoints, Ticket, WireTap,
};
use crate::transport::Endpoint;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};

/// What the link was told.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Told {
    Stop,
    Arm(ArmRequest),
    Disarm,
    Set(Setpoints),
    ReadAt(PollRates),
    Ask(Request),
}

#[derive(Default)]
pub(super) struct Wire {
    pub(super) status: LinkStatus,
    pub(super) told: Vec<Told>,
    pub(super) events: VecDeque<LinkEvent>,
    pub(super) refuse: Option<RequestError>,
}

/// The wire, for the link and the test that looks at it.
#[derive(Clone, Default)]
pub(super) struct SharedWire(Arc<Mutex<Wire>>);

impl SharedWire {
    pub(super) fn borrow(&self) -> MutexGuard<'_, Wire> {
        self.0.lock().unwrap()
    }

    pub(super) fn borrow_mut(&self) -> MutexGuard<'_, Wire> {
        self.0.lock().unwrap()
    }
}

pub(super) struct FakeLink(SharedWire);

impl FakeLink {
    pub(super) const fn on(wire: SharedWire) -> Self {
        Self(wire)
    }

    pub(super) fn note(&self, told: Told) {
        self.0.borrow_mut().told.push(told);
    }
}

impl Link for FakeLink {
    fn status(&self) -> LinkStatus {
        self.0.borrow().status.clone()
    }
    fn stats(&self) -> LinkStats {
        LinkStats::default()
    }
    fn stop(&self) {
        self.note(Told::Stop);
    }
    fn arm(&self, request: ArmRequest) {
        self.note(Told::Arm(request));
    }
    fn disarm(&self) {
        self.note(Told::Disarm);
    }
    fn set(&self, setpoints: &Setpoints) {
        self.note(Told::Set(*setpoints));
    }
    fn read_at(&self, rates: PollRates) {
        self.note(Told::ReadAt(rates));
    }
    fn ask(&self, request: Request) -> Result<Ticket, RequestError> {
        self.note(Told::Ask(request));
        self.0.borrow().refuse.clone().map_or(Ok(Ticket(7)), Err)
    }
    fn tap(&self) -> WireTap {
        WireTap::default()
    }
    fn try_event(&mut self) -> Option<LinkEvent> {
        self.0.borrow_mut().events.pop_front()
    }
}

pub(super) struct Bench {
    pub(super) desk: Desk,
    pub(super) wire: SharedWire,
    pub(super) millis: u64,
}

impl Bench {
    pub(super) fn new() -> Self {
        let wire = SharedWire::default();
        let mut desk = Desk::new(Settings::default());
        desk.replace(
            Some(Endpoint::sim()),
            Some(Box::new(FakeLink(wire.clone()))),
            Moment::ZERO,
        );
        Self {
            desk,
            wire,
            millis: 1,
        }
    }

    pub(super) fn monitoring(angle: i16) -> Self {
        let mut bench = Self::new();
        bench.state(LinkState::Monitoring);
        bench.angles(angle);
        bench.step();
        bench
    }

    pub(super) fn armed(angle: i16) -> Self {
        let mut bench = Self::monitoring(angle);
        bench.desk.arm(bench.now());
        bench.epoch(1);
        bench.step();
        bench.told();
        bench
    }

    pub(super) fn now(&self) -> Moment {
        Moment::from_micros(self.millis * 1000)
    }

    pub(super) fn step(&mut self) {
        self.millis += 10;
        let now = self.now();
        self.desk.drain(now);
    }

    pub(super) fn state(&self, state: LinkState) {
        let status = LinkStatus {
            state,
            since: self.now(),
            ..LinkStatus::default()
        };
        self.wire.borrow_mut().status = status;
    }

    pub(super) fn epoch(&mut self, epoch: u64) {
        self.millis += 1;
        self.state(LinkState::Armed);
        self.wire.borrow_mut().status.armed = Some(ArmEpoch(epoch));
    }

    pub(super) fn angles(&mut self, angle: i16) {
        self.millis += 1;
        let at = self.now();
        let angles = PerDof::splat(AngleReading::new(angle));
        let sample = HandSample {
            angle: Some(Timed {
                value: angles,
                asked: at,
                received: at,
            }),
            faults: Some(Timed {
                value: PerDof::splat(Faults::default()),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        };
        let mut fresh = Groups::NONE;
        fresh.insert(Group::Angle);
        self.wire.borrow_mut().events.push_back(LinkEvent::Sample {
            sample: Box::new(sample),
            fresh,
        });
    }

    pub(super) fn told(&self) -> Vec<Told> {
        std::mem::take(&mut self.wire.borrow_mut().told)
    }

    pub(super) fn target(&self, dof: Dof) -> Option<i16> {
        self.desk.state.joints[dof].target.map(Angle::get)
    }

    pub(super) fn notices(&self) -> Vec<NoticeKind> {
        self.desk
            .state
            .notices
            .iter()
            .map(|notice| notice.what.clone())
            .collect()
    }
}

pub(super) fn set(epoch: u64, fill: impl FnOnce(&mut Setpoints)) -> Told {
    let mut setpoints = Setpoints::none(ArmEpoch(epoch));
    fill(&mut setpoints);
    Told::Set(setpoints)
}
