//! The state, the link behind it, and what comes in over the link. What a person asks for is in `act`; no file, no thread.

use crate::app::device::book::DeviceBook;
use crate::app::device::work::DeviceWork;
use crate::app::faults::FaultBook;
use crate::app::gestures::{GestureBook, GestureProgress, Verdict};
use crate::app::history::{History, MarkKind};
use crate::app::notices::{Asked, NoticeKind, Notices};
use crate::app::peaks::ForcePeaks;
use crate::app::poses::book::PoseBook;
use crate::app::recorder::Recorder;
use crate::app::scan::ScanBook;
use crate::app::seam::Link;
use crate::app::settings::Settings;
use crate::app::state::{Joint, State};
use crate::app::tare::Tare;
use crate::app::trial::Abort;
use crate::app::tuner::TunerBook;
use crate::hand::{Dof, Force, Group, Groups, HandSample, Moment, PerDof, Speed, Status};
use crate::link::{
    Disarmed, Hold, LinkEvent, LinkState, LinkStats, LinkStatus, LinkTrouble, Outcome, PollRates,
    Request, RequestError, Ticket, Traffic,
};
use crate::transport::Endpoint;

/// Events taken in one frame: a tenth of a second of the fastest link and far more than a frame brings. The rest
/// waits for the next frame, so that a window that was held up catches up without a jerk.
const EVENTS_PER_FRAME: usize = 256;
/// An adapter may keep what it got for so long without harm.
const TIMER_MS_MAX: u16 = 2;
/// Requests whose end is still awaited; the link itself lets fewer wait.
const ASKED_MAX: usize = 32;

/// The state and the link behind it.
pub(crate) struct Desk {
    pub(crate) state: State,
    pub(crate) link: Option<Box<dyn Link>>,
    /// Sliders that show the actual angle although the hand is armed: locked, or moved by a gesture.
    pub(crate) following: PerDof<bool>,
    /// No arming from before this moment counts, whatever the link still says.
    pub(crate) disarmed_at: Option<Moment>,
    /// Something was sent on this connection that may move the hand.
    pub(crate) commanded: bool,
    /// What is read and written of what the hand keeps.
    pub(crate) work: DeviceWork,
    /// How the link was told to read.
    pub(crate) rates: PollRates,
    asked: Vec<(Ticket, Asked)>,
    /// The one request of what is done under a card, and how it ended.
    own: Option<(Ticket, Option<Result<Outcome, RequestError>>)>,
    /// Angles received before this belong to a connection that is gone.
    seen_from: Option<Moment>,
    was_live: bool,
}

impl Desk {
    pub(crate) fn new(settings: Settings) -> Self {
        let joint = Joint {
            target: None,
            force: Force::GENTLE,
            speed: Speed::GENTLE,
            locked: false,
        };
        let gestures = GestureBook::new(&settings);
        let state = State {
            now: Moment::ZERO,
            endpoint: None,
            link: LinkStatus::default(),
            stats: LinkStats::default(),
            sample: HandSample::default(),
            tare: Tare::default(),
            peaks: ForcePeaks::default(),
            joints: PerDof::splat(joint),
            history: History::new(),
            faults: FaultBook::default(),
            recorder: Recorder::default(),
            notices: Notices::default(),
            gestures,
            poses: PoseBook::default(),
            device: DeviceBook::default(),
            tuner: TunerBook::default(),
            traffic: Traffic::default(),
            ports: Vec::new(),
            scan: ScanBook::default(),
            sheet: None,
            guard: None,
            settings,
        };
        Self {
            state,
            link: None,
            following: PerDof::splat(true),
            disarmed_at: None,
            commanded: false,
            work: DeviceWork::default(),
            rates: PollRates::default(),
            asked: Vec::new(),
            own: None,
            seen_from: None,
            was_live: false,
        }
    }

    /// Puts another hand in place of the one before, or none. Nothing of the old one is taken for the new one's.
    pub(crate) fn replace(
        &mut self,
        endpoint: Option<Endpoint>,
        link: Option<Box<dyn Link>>,
        now: Moment,
    ) {
        self.end_trials(Abort::LinkLost, now);
        self.state.traffic = match (&link, &endpoint) {
            (Some(link), Some(endpoint)) => Traffic::of(link.tap(), endpoint),
            _ => Traffic::default(),
        };
        let hand = self.state.hand_name();
        self.state
            .recorder
            .another_hand(&self.state.history, &hand, now);
        self.link = link;
        self.state.endpoint = endpoint;
        self.state.link = LinkStatus {
            since: now,
            ..LinkStatus::default()
        };
        self.state.stats = LinkStats::default();
        self.state.sample = HandSample::default();
        self.state.tare = Tare::default();
        self.state.peaks = ForcePeaks::default();
        self.state.sheet = None;
        self.state.faults.clear();
        self.state.gestures.another_hand();
        self.state.poses.run = None;
        self.device_replaced();
        self.state.history.gap(now);
        self.state
            .notices
            .withdraw(|what| matches!(what, NoticeKind::LinkLost(_) | NoticeKind::NoLink(_)));
        self.following = PerDof::splat(true);
        self.disarmed_at = None;
        self.commanded = false;
        self.rates = PollRates::default();
        self.asked.clear();
        self.own = None;
        self.seen_from = Some(now);
        self.was_live = false;
        self.follow();
    }

    /// Takes in what happened on the link.
    pub(crate) fn drain(&mut self, now: Moment) {
        self.state.now = now;
        let Some(link) = self.link.as_mut() else {
            self.follow();
            self.tick_sequence(now);
            self.tick_trials(now);
            return;
        };
        let status = link.status();
        self.state.stats = link.stats();
        let events: Vec<LinkEvent> = std::iter::from_fn(|| link.try_event())
            .take(EVENTS_PER_FRAME)
            .collect();
        for event in events {
            self.event(event, now);
        }
        self.status(status, now);
        self.follow();
        self.tick_sequence(now);
        self.tick_device(now);
        self.tick_trials(now);
        self.read_at_need();
    }

    fn event(&mut self, event: LinkEvent, now: Moment) {
        match event {
            LinkEvent::Sample { sample, fresh } => self.sample(&sample, fresh, now),
            LinkEvent::State { .. } => {}
            LinkEvent::ArmRefused { at, reason } => {
                self.state.notices.push(at, NoticeKind::ArmRefused(reason))
            }
            LinkEvent::Done { ticket, result } => self.done(ticket, result, now),
        }
    }

    fn sample(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        self.state.sample = *sample;
        self.state.tare.begin(sample);
        if fresh.contains(Group::Force) {
            self.state.peaks.update(sample);
        }
        self.state.history.push(sample, fresh);
        self.state.recorder.sample(sample, fresh, now);
        if self.state.faults.update(sample, fresh, now) {
            self.state.history.mark(now, MarkKind::Fault);
            let begun: Vec<_> = self
                .state
                .faults
                .active()
                .filter(|entry| entry.since == now)
                .copied()
                .collect();
            for entry in begun {
                self.state.recorder.fault(entry.dof, entry.what, now);
                self.state.notices.push(
                    now,
                    NoticeKind::Fault {
                        dof: entry.dof,
                        what: entry.what,
                    },
                );
            }
        }
        self.take_trials(sample, fresh, now);
    }

    /// Asks one thing for what is done under a card.
    pub(crate) fn ask_own(&mut self, request: Request) -> Result<(), RequestError> {
        let link = self.link.as_ref().ok_or(RequestError::NotConnected)?;
        self.own = Some((link.ask(request)?, None));
        Ok(())
    }

    /// How that ended, once.
    pub(crate) fn take_own(&mut self) -> Option<Result<Outcome, RequestError>> {
        let (_, end) = self.own.take_if(|(_, end)| end.is_some())?;
        end
    }

    fn done(&mut self, ticket: Ticket, result: Result<Outcome, RequestError>, now: Moment) {
        if let Some((_, end)) = self.own.as_mut().filter(|(own, _)| *own == ticket) {
            *end = Some(result);
            return;
        }
        if self.device_done(ticket, &result, now) {
            return;
        }
        let Some(index) = self.asked.iter().position(|(asked, _)| *asked == ticket) else {
            return;
        };
        let (_, what) = self.asked.swap_remove(index);
        match result {
            Ok(outcome) => {
                self.acknowledged(what, now);
                self.gesture_answered(what, &outcome, now);
            }
            Err(error) => self.failed(what, error, now),
        }
    }

    fn acknowledged(&mut self, what: Asked, now: Moment) {
        match what {
            Asked::Gesture(_) => self.state.gestures.progress(GestureProgress::Acknowledged),
            // What these come to is shown beside the pose, once it was read back.
            Asked::StoreGesture(_) | Asked::ReadGesture(_) => return,
            Asked::ClearErrors => {}
        }
        self.state
            .notices
            .push(now, NoticeKind::Acknowledged { what });
    }

    /// Says that something did not work.
    pub(crate) fn failed(&mut self, what: Asked, error: RequestError, now: Moment) {
        match what {
            Asked::Gesture(_) => self.state.gestures.progress(GestureProgress::Failed),
            Asked::StoreGesture(gesture) | Asked::ReadGesture(gesture) => {
                self.state.gestures.judge(gesture, Verdict::Failed);
            }
            Asked::ClearErrors => {}
        }
        self.state
            .notices
            .push(now, NoticeKind::RequestFailed { what, error });
    }

    /// Remembers what a ticket stands for.
    pub(crate) fn await_end(&mut self, ticket: Ticket, what: Asked) {
        if self.asked.len() >= ASKED_MAX {
            self.asked.remove(0);
        }
        self.asked.push((ticket, what));
    }

    /// A stop or disarm counts here at once, although the link's own word for it comes a moment later.
    fn status(&mut self, mut status: LinkStatus, now: Moment) {
        let outdated = self.disarmed_at.is_some_and(|at| status.since <= at);
        if outdated && (status.state == LinkState::Armed || status.armed.is_some()) {
            status.state = self.state.link.state;
            status.armed = None;
        }
        let before = std::mem::replace(&mut self.state.link, status);
        self.reached(&before, now);
        self.slowed(&before, now);
        self.held(&before, now);
        self.armed(&before, now);
    }

    /// An adapter that keeps replies back is told of once a connection.
    fn slowed(&mut self, before: &LinkStatus, now: Moment) {
        let link = &self.state.link;
        let told = |link: &LinkStatus| link.latency_timer_ms.filter(|ms| *ms > TIMER_MS_MAX);
        let is_news = link.state.is_live()
            && (told(link).is_some() && !before.state.is_live()
                || link.latency_ticks && !before.latency_ticks);
        let asked = self.state.endpoint.as_ref().and_then(Endpoint::port);
        let port = link.moved_to.as_deref().or(asked).map(str::to_owned);
        if let Some(port) = port.filter(|_| is_news) {
            let ms = told(link);
            let kind = NoticeKind::LatencyTimer { port, ms };
            self.state.notices.push(now, kind);
        }
    }

    fn reached(&mut self, before: &LinkStatus, now: Moment) {
        let live = self.state.link.state.is_live();
        let trouble = self.state.link.trouble.clone();
        if before.state.is_live() && !live {
            self.lost(trouble, now);
        } else if !before.state.is_live() && live {
            self.found(now);
        } else if let Some(trouble) =
            trouble.filter(|_| !live && before.trouble != self.state.link.trouble)
        {
            let kind = if self.was_live {
                NoticeKind::LinkLost(trouble)
            } else {
                NoticeKind::NoLink(trouble)
            };
            self.state.notices.push(now, kind);
        }
    }

    fn lost(&mut self, trouble: Option<LinkTrouble>, now: Moment) {
        self.was_live = true;
        self.seen_from = Some(now);
        self.commanded = false;
        self.state.device.link_lost(now);
        self.state.history.gap(now);
        self.state.history.mark(now, MarkKind::LinkLost);
        if let Some(trouble) = trouble {
            self.state.notices.push(now, NoticeKind::LinkLost(trouble));
        }
    }

    fn found(&mut self, now: Moment) {
        self.state
            .notices
            .withdraw(|what| matches!(what, NoticeKind::NoLink(_)));
        if self.was_live {
            self.state.history.mark(now, MarkKind::Reconnected);
            self.state.notices.push(now, NoticeKind::Reconnected);
        }
        self.was_live = true;
    }

    fn held(&mut self, before: &LinkStatus, now: Moment) {
        if before.hold == self.state.link.hold {
            return;
        }
        match self.state.link.hold {
            Hold::Confirmed { at, rest } => {
                self.state.history.mark(rest, MarkKind::HoldConfirmed);
                self.state
                    .notices
                    .withdraw(|what| *what == NoticeKind::HoldAlarm);
                self.state.notices.push(
                    now,
                    NoticeKind::HoldConfirmed {
                        after: rest.since(at),
                    },
                );
            }
            Hold::Alarm { .. } => self.state.notices.push(now, NoticeKind::HoldAlarm),
            Hold::None | Hold::Asked { .. } => {}
        }
    }

    fn armed(&mut self, before: &LinkStatus, now: Moment) {
        let armed = self.state.link.armed;
        if armed.is_some() && armed != before.armed {
            self.state.history.mark(now, MarkKind::Armed);
            let joints = self.state.joints;
            self.following =
                PerDof::from_fn(|dof| joints[dof].locked || joints[dof].target.is_none());
        }
        if before.armed.is_some() && armed.is_none() {
            let asked_for = |why: &Disarmed| matches!(why, Disarmed::Stop | Disarmed::Person);
            if let Some(why) = self.state.link.disarmed.filter(|why| !asked_for(why)) {
                self.state.notices.push(now, NoticeKind::Disarmed(why));
            }
        }
    }

    /// Sliders that no person holds stand at the actual angle, so that arming and taking over never jump.
    pub(crate) fn follow(&mut self) {
        let armed = self.state.is_armed();
        let live = self.state.link.state.is_live();
        let seen_from = self.seen_from;
        let angle = self
            .state
            .sample
            .angle
            .filter(|angle| live && seen_from.is_none_or(|from| angle.received > from));
        for dof in Dof::ALL {
            if !armed || self.following[dof] {
                self.state.joints[dof].target = angle.and_then(|angle| angle.value[dof].hold());
            }
        }
        if !armed {
            self.following = PerDof::splat(true);
        }
    }

    /// True if closing or leaving now could leave a hand in motion that this program set in motion.
    pub(crate) fn may_move(&self) -> bool {
        let moves = |status: &Status| matches!(status, Status::Releasing | Status::Grasping);
        let seen = self
            .state
            .sample
            .status
            .is_some_and(|all| all.value.iter().any(|(_, status)| moves(status)));
        let holding = self.state.link.state == LinkState::Holding;
        self.state.link.state.is_live()
            && (self.state.is_armed() || holding || self.commanded && seen)
    }

    /// True once nothing more can be done for a hand that was told to hold at this moment: it rests, or is gone.
    pub(crate) fn is_at_rest(&self, told: Moment) -> bool {
        let rests = matches!(self.state.link.hold, Hold::Confirmed { rest, .. } if rest >= told);
        !self.state.link.state.is_live() || rests
    }
}
