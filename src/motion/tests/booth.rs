//! The hand of an exhibition's tests: the simulated hand's drives behind a link of a few rules, and somebody who looks at each
//! write. Speaks no protocol, so that a day takes seconds.

use crate::exhibit::plan::{ExhibitPiece, ExhibitPlan, MotionLimits};
use crate::fake::each_control;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, CurrentReading, Dof, Fault, Group, Groups, HandCommand,
    HandSample, Moment, PerDof, Setpoints, Target, TemperatureReading, Timed,
};
use crate::link::handle::channels;
use crate::link::request::Request;
use crate::link::wanted::{ArmCommand, PendingControl, SessionChannels};
use crate::link::{Clock, LinkHandle, LinkStatus};
use crate::record::{Disarmed, LinkState, Record, Rest};
use crate::sim::drive::{Drive, DriveGoal, DriveSettings, position_of};
use std::collections::{BTreeSet, VecDeque};
use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;
use tokio::sync::{broadcast, mpsc, watch};
use tokio::time::sleep;

/// The world goes on in steps of this while something moves, …
const STEP: Duration = Duration::from_millis(50);
/// … and of this while nothing does.
const SLOW_STEP: Duration = Duration::from_millis(500);
/// Readings that a hold may go to.
const TOLD: usize = 6;
/// How long the link takes to arm: it writes the limits first.
const ARM_DELAY: Duration = Duration::from_millis(40);

/// Everything there is of it.
pub(crate) struct BoothFacts {
    pub(crate) status: LinkStatus,
    pub(crate) drives: PerDof<Drive>,
    settings: PerDof<DriveSettings>,
    sample: HandSample,
    /// Angles that were told lately: a hold goes to one of them.
    told: VecDeque<PerDof<i16>>,
    now_ms: u64,
    epoch: u64,
    /// The wish to arm that is under way, by its number.
    arming: Option<u64>,
    armings: u64,
    wanted: Arc<watch::Sender<PendingControl>>,
    published: watch::Sender<LinkStatus>,
    records: broadcast::Sender<Record>,
    /// What may be sent at all.
    allowed: PerDof<BTreeSet<Angle>>,
    limits: MotionLimits,
    /// The user armed it, and nothing ended that since.
    pub(crate) person_armed: bool,
    /// What should never have been sent.
    pub(crate) wrong: Vec<String>,
    /// Setpoints that were sent.
    pub(crate) moves: u64,
    pub(crate) clears: u64,
    pub(crate) hottest: f64,
    /// How far any joint was commanded from where it was, in one write after a hold.
    pub(crate) sent: Vec<(Moment, Setpoints)>,
}

/// One hand at a booth. Copies are the same hand.
#[derive(Clone)]
pub(crate) struct BoothHand {
    link: LinkHandle,
    facts: Arc<Mutex<BoothFacts>>,
    pub(crate) clock: Clock,
}

impl Deref for BoothHand {
    type Target = LinkHandle;

    fn deref(&self) -> &LinkHandle {
        &self.link
    }
}

fn targets_of(piece: &ExhibitPiece) -> impl Iterator<Item = PerDof<Option<Angle>>> + '_ {
    let cues = piece.plan.cues.iter();
    let touched = piece.plan.reaction.iter().map(|cue| &cue.touched);
    cues.chain(touched).map(|cue| cue.targets)
}

impl BoothHand {
    /// An open hand in a room of so many degrees, whose drives grow so many times as warm as usual. It may be sent what stands in
    /// the plan, and where it is.
    pub(crate) fn new(plan: &ExhibitPlan, ambient: f64, heating: f64) -> Self {
        let mut allowed = PerDof::from_fn(|_| BTreeSet::from([Angle::MAX]));
        let attract = plan.attract.iter().flat_map(|attract| &attract.pieces);
        for targets in plan.tiles.iter().chain(attract).flat_map(targets_of) {
            for (dof, to) in targets.iter() {
                allowed[dof].extend(*to);
            }
        }
        // Where the thumb goes out of the index's way.
        allowed[Dof::ThumbBend].insert(Angle::nearest(800));
        let clock = Clock::start();
        let (link, ends, _) = channels(clock);
        let SessionChannels {
            wanted,
            requests,
            records,
            status,
            ..
        } = ends;
        let mut facts = BoothFacts {
            status: LinkStatus {
                state: LinkState::Monitoring,
                rest: Rest::Resting,
                ..LinkStatus::default()
            },
            drives: PerDof::from_fn(|_| {
                let mut drive = Drive::new(ambient);
                drive.heat_more(heating);
                drive
            }),
            settings: PerDof::splat(DriveSettings {
                speed: 1000.0,
                threshold_g: 3000.0,
            }),
            sample: HandSample::default(),
            told: VecDeque::new(),
            now_ms: 0,
            epoch: 0,
            arming: None,
            armings: 0,
            wanted: Arc::clone(&wanted),
            published: status,
            records,
            allowed,
            limits: plan.limits,
            person_armed: false,
            wrong: Vec::new(),
            moves: 0,
            clears: 0,
            hottest: 0.0,
            sent: Vec::new(),
        };
        facts.publish();
        let hand = Self {
            link,
            facts: Arc::new(Mutex::new(facts)),
            clock,
        };
        let session = hand.clone();
        tokio::spawn(each_control(wanted, move |control| session.obey(control)));
        tokio::spawn(hand.clone().serve_all(requests));
        let world = hand.clone();
        tokio::spawn(async move {
            loop {
                let moves = world.go_on();
                sleep(if moves { STEP } else { SLOW_STEP }).await;
            }
        });
        hand
    }

    pub(crate) fn facts(&self) -> MutexGuard<'_, BoothFacts> {
        self.facts.lock().unwrap()
    }

    /// Lets the drives go on until now, and tells of them. True if something moves.
    fn go_on(&self) -> bool {
        let now = self.clock.now();
        let mut facts = self.facts();
        facts.go_on(now);
        facts.publish();
        facts.status.armed.is_some() || facts.drives.iter().any(|(_, one)| one.status().is_moving())
    }

    /// The cable is pulled or plugged in.
    pub(crate) fn plug(&self, is_in: bool) {
        let mut facts = self.facts();
        facts.disarm(Disarmed::LinkLost);
        facts.status.state = if is_in {
            LinkState::Monitoring
        } else {
            LinkState::Offline
        };
        facts.person_armed = false;
        facts.publish();
    }

    /// The computer slept: the link is lost, and back before anybody looks at it.
    pub(crate) fn sleeps(&self) {
        let at = self.clock.now();
        let mut facts = self.facts();
        facts.disarm(Disarmed::Resume);
        facts.person_armed = false;
        for state in [LinkState::Offline, LinkState::Monitoring] {
            // Nobody may be listening.
            let _heard = facts.records.send(Record::State { at, state });
        }
        facts.publish();
    }

    /// The link's own reasons.
    pub(crate) fn disarmed(&self, why: Disarmed) {
        let mut facts = self.facts();
        facts.disarm(why);
        facts.person_armed = false;
        facts.publish();
    }

    /// A drive reports a fault.
    pub(crate) fn fails(&self, dof: Dof, fault: Fault) {
        let mut facts = self.facts();
        facts.drives[dof].inject(fault);
        let now = self.clock.now();
        facts.go_on(now);
        facts.publish();
    }

    pub(crate) fn angle(&self, dof: Dof) -> f64 {
        self.facts().drives[dof].angle()
    }
}

impl BoothFacts {
    fn go_on(&mut self, now: Moment) {
        let until = now.micros() / 1000;
        while self.now_ms < until {
            self.now_ms += 1;
            for (dof, drive) in self.drives.iter_mut() {
                drive.step(self.now_ms, self.settings[dof]);
            }
        }
        let all = self.drives.iter();
        let hottest = all.map(|(_, drive)| drive.temperature());
        self.hottest = hottest.fold(self.hottest, f64::max);
        if !self.status.state.is_live() {
            return;
        }
        let is_faulty = self.drives.iter().any(|(_, one)| !one.faults().is_empty());
        match self.status.state {
            LinkState::Fault if !is_faulty => self.status.state = LinkState::Monitoring,
            LinkState::Fault => {}
            LinkState::Holding if self.drives.iter().any(|(_, one)| one.status().is_moving()) => {}
            _ if is_faulty => {
                self.disarm(Disarmed::Fault);
                self.status.state = LinkState::Fault;
                let faults = self.drives.iter().flat_map(|(_, one)| one.faults().iter());
                let faults: Vec<Fault> = faults.collect();
                self.person_armed &= faults.iter().all(|one| one.clearable() == Some(true));
            }
            // A stop is over as soon as everything stands.
            LinkState::Holding => self.status.state = LinkState::Monitoring,
            _ => {}
        }
        self.tell(now);
    }

    fn tell(&mut self, now: Moment) {
        fn timed<T>(now: Moment, value: PerDof<T>) -> Option<Timed<PerDof<T>>> {
            Some(Timed {
                value,
                asked: now,
                received: now,
            })
        }
        let drives = &self.drives;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a test may"
        )]
        let sample = HandSample {
            angle: timed(
                now,
                PerDof::from_fn(|dof| AngleReading::new(drives[dof].angle() as i16)),
            ),
            current: timed(
                now,
                PerDof::from_fn(|dof| CurrentReading::new(drives[dof].current_ma() as i16)),
            ),
            temperature: timed(
                now,
                PerDof::from_fn(|dof| TemperatureReading::new(drives[dof].temperature() as u8)),
            ),
            faults: timed(now, PerDof::from_fn(|dof| drives[dof].faults())),
            status: timed(now, PerDof::from_fn(|dof| drives[dof].status())),
            ..HandSample::default()
        };
        self.sample = sample;
        self.told
            .extend(sample.angle.map(|angle| angle.value.map(AngleReading::raw)));
        if self.told.len() > TOLD {
            self.told.pop_front();
        }
        let record = Record::Reading {
            sample: Arc::new(sample),
            fresh: Groups::from_iter([Group::Angle, Group::Current, Group::Temperature]),
        };
        // Nobody may be listening.
        let _heard = self.records.send(record);
    }

    fn stop(&mut self, why: Disarmed) {
        self.disarm(why);
        self.hold();
        if self.status.state.is_live() {
            self.status.state = LinkState::Holding;
        }
    }

    fn disarm(&mut self, why: Disarmed) {
        if !why.is_asked_for() {
            self.wanted.send_modify(|wanted| wanted.book.end(why));
        }
        self.arming = None;
        if self.status.armed.take().is_some() {
            self.status.disarmed = Some(why);
            self.status.state = LinkState::Monitoring;
        }
    }

    fn arm(&mut self, asked: ArmCommand) {
        let request = asked.request;
        if self.status.state != LinkState::Monitoring || self.sample.angle.is_none() {
            return;
        }
        if !self.person_armed {
            self.complain("armed, and no person did".into());
        }
        for dof in Dof::ALL {
            self.settings[dof] = DriveSettings {
                speed: request.speed[dof].get().into(),
                threshold_g: request.force[dof].get().into(),
            };
        }
        self.epoch += 1;
        self.status.armed = Some(ArmEpoch(self.epoch));
        self.status.disarmed = None;
        self.status.state = LinkState::Armed;
        self.publish();
        // The exhibition may have given up waiting.
        let _heard = asked.answer.send(Ok(ArmEpoch(self.epoch)));
    }

    fn publish(&mut self) {
        self.published.send_replace(self.status.clone());
    }

    fn complain(&mut self, what: String) {
        if self.wrong.len() < 10 {
            self.wrong.push(format!("{} s: {what}", self.now_ms / 1000));
        }
    }

    fn hold(&mut self) {
        let now_ms = self.now_ms;
        for (_, drive) in self.drives.iter_mut() {
            drive.command(DriveGoal::Freeze, now_ms);
        }
    }

    /// Looks at what is sent before it is.
    fn check(&mut self, setpoints: &Setpoints) {
        self.moves += 1;
        if !self.person_armed {
            self.complain("moved without a person's arming".into());
        }
        for dof in Dof::ALL {
            let Some(Target::Go(to)) = setpoints.angle[dof] else {
                continue;
            };
            let is_hold = self.told.iter().any(|told| told[dof] == to.get());
            if !self.allowed[dof].contains(&to) && !is_hold {
                self.complain(format!("{} to {}", dof.name(), to.get()));
            }
            let setting = self.settings[dof];
            let limits = (
                self.limits.speed.get().into(),
                self.limits.force.get().into(),
            );
            if setting.speed > limits.0 || setting.threshold_g > limits.1 {
                self.complain(format!("{} at {setting:?}", dof.name()));
            }
        }
    }
}

impl BoothHand {
    fn obey(&self, control: PendingControl) {
        let now = self.clock.now();
        let mut facts = self.facts();
        if control.stop {
            facts.stop(control.why.unwrap_or(Disarmed::Stop));
        } else if control.disarm {
            facts.disarm(control.why.unwrap_or(Disarmed::Person));
        }
        if let Some(asked) = control.arm {
            facts.armings += 1;
            let number = facts.armings;
            facts.arming = Some(number);
            let hand = self.clone();
            tokio::spawn(async move {
                sleep(ARM_DELAY).await;
                let mut facts = hand.facts();
                if facts.arming == Some(number) {
                    facts.arming = None;
                    facts.arm(asked);
                }
            });
        }
        if let Some(setpoints) = control.setpoints {
            facts.set(&setpoints, now);
        }
        facts.publish();
    }

    /// Clearing holds first, and takes a moment.
    async fn serve_all(self, mut requests: mpsc::Receiver<Request>) {
        while let Some(request) = requests.recv().await {
            let Request::Command(HandCommand::ClearErrors, _, answer) = request else {
                panic!("an exhibition does not ask for {request:?}");
            };
            self.facts().hold();
            sleep(Duration::from_millis(100)).await;
            let mut facts = self.facts();
            facts.clears += 1;
            facts
                .drives
                .iter_mut()
                .for_each(|(_, drive)| drive.clear_errors());
            // The exhibition may be over.
            let _heard = answer.send(Ok(()));
        }
    }
}

impl BoothFacts {
    fn set(&mut self, setpoints: &Setpoints, now: Moment) {
        if self.status.armed != Some(setpoints.epoch) {
            return;
        }
        self.go_on(now);
        for dof in Dof::ALL {
            if let Some(speed) = setpoints.speed[dof] {
                self.settings[dof].speed = speed.get().into();
            }
            if let Some(force) = setpoints.force[dof] {
                self.settings[dof].threshold_g = force.get().into();
            }
        }
        self.check(setpoints);
        let now_ms = self.now_ms;
        for dof in Dof::ALL {
            if let Some(Target::Go(to)) = setpoints.angle[dof] {
                let to = DriveGoal::Position(position_of(to.get().into()));
                self.drives[dof].command(to, now_ms);
            }
        }
        if self.sent.len() < 1000 {
            self.sent.push((now, *setpoints));
        }
    }
}
