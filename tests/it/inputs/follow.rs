//! A source that starts, freezes, falls silent and starts again, at a simulated hand behind a real link, in virtual time: what goes
//! over the wire, and under whose lease.

use crate::setup::hand;
use crate::setup::link::{gentle, to_hand};
use crate::setup::time::in_virtual_time;
use handscope::hand::gap::{Gap, SizeBlocks, gap_on_path};
use handscope::hand::grip::GripEstimator;
use handscope::hand::overshoot::OvershootMap;
use handscope::hand::{Angle, Dof, HandSample, Moment, PerDof, Setpoints, Target};
use handscope::inputs::{Offer, OfferLimits};
use handscope::link::{self, Clock, HoldToRun, Lease, LinkHandle, Owner, Records};
use handscope::motion::follow::step::{FollowLimits, FollowPhase};
use handscope::motion::follow::{FollowStart, FollowTerms, FollowView, follow};
use handscope::motion::program::Ended;
use handscope::record::Abort;
use handscope::record::{ArmRefusal, Disarmed, Record, WriteCause};
use handscope::sim::{SharedHand, SimConfig};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;
use tokio::time::sleep;

/// A task that follows, with its end and its phases.
type Following = JoinHandle<(Ended<()>, Vec<FollowPhase>)>;

const LIMITS: FollowLimits = FollowLimits {
    lead: 120,
    rate: 600,
};
/// Targets come at 100 Hz, as xr_teleoperate sends them.
const EACH: Duration = Duration::from_millis(10);

/// A hand, its link, and all that was told of it.
pub(super) struct Stage {
    link: LinkHandle,
    records: Records,
    clock: Clock,
    seen: Vec<Record>,
}

/// What is sent and where the joint was, in order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sent {
    at: Moment,
    pub(super) to: i16,
    actual: i16,
    pub(super) cause: WriteCause,
}

impl Stage {
    pub(super) async fn begin() -> Self {
        Self::at(hand::begin(hand::free(SimConfig::default()))).await
    }

    /// At this hand.
    pub(super) async fn at(hand: SharedHand) -> Self {
        let config = crate::setup::link::config("rs485:x", to_hand(hand));
        let clock = config.clock;
        let (link, records) = link::open(config, &Handle::current());
        let mut stage = Self {
            link,
            records,
            clock,
            seen: Vec::new(),
        };
        stage.pass(1000).await;
        stage
    }

    /// Time passes, and what is told is taken in.
    pub(super) async fn pass(&mut self, ms: u64) {
        sleep(Duration::from_millis(ms)).await;
        self.seen
            .extend(std::iter::from_fn(|| self.records.try_next()));
    }

    pub(super) fn sample(&self) -> HandSample {
        let mut all = self.seen.iter().rev();
        let newest = all.find_map(|record| match record {
            Record::Reading { sample, .. } => Some(**sample),
            _ => None,
        });
        newest.expect("the hand was read")
    }

    pub(super) fn link(&self) -> &LinkHandle {
        &self.link
    }

    pub(super) fn clock(&self) -> Clock {
        self.clock
    }

    pub(super) fn records(&self) -> &[Record] {
        &self.seen
    }

    pub(super) fn beginning(&self, lease: Lease) -> FollowStart {
        let terms = FollowTerms {
            limits: LIMITS,
            ..FollowTerms::default()
        };
        FollowStart {
            lease,
            terms: watch::Sender::new(terms).subscribe(),
            arm: gentle(),
            grip: GripEstimator::default(),
            overshoot: OvershootMap::default(),
            blocks: SizeBlocks::default(),
            seen: self.sample(),
            clock: self.clock,
        }
    }

    /// A person lets what is offered here move the hand.
    pub(super) fn follow(&self, lease: Lease, taken: mpsc::Receiver<Offer>) -> Following {
        let (link, start) = (self.link.clone(), self.beginning(lease));
        tokio::spawn(async move {
            let mut phases = Vec::new();
            let tell = |view: FollowView| {
                if phases.last() != Some(&view.phase) {
                    phases.push(view.phase);
                }
            };
            let end = follow(&link, start, taken, tell).await;
            (end, phases)
        })
    }

    /// A person lets this source move the hand.
    pub(super) fn start(&self, lease: Lease) -> (mpsc::Sender<Offer>, Following) {
        let (offers, taken) = mpsc::channel(64);
        (offers, self.follow(lease, taken))
    }

    /// Sends this for a while, a hundred times a second.
    async fn send(&mut self, offers: &mpsc::Sender<Offer>, aims: impl Fn(u64) -> i16, ms: u64) {
        for n in 0..ms / 10 {
            let aim = aims(n);
            let _sent = offers.try_send(Offer {
                at: self.clock.now(),
                aims: PerDof::splat(Some(Angle::nearest(aim))),
                gap: None,
                hold: None,
                limits: OfferLimits::NONE,
                held: None,
                mark: Some(aim.unsigned_abs().into()),
            });
            self.pass(u64::try_from(EACH.as_millis()).unwrap()).await;
        }
    }

    /// Every target of the index that went out.
    pub(super) fn index(&self) -> Vec<Sent> {
        let mut actual = 0;
        let mut all = Vec::new();
        for record in &self.seen {
            match record {
                Record::Reading { sample, .. } => {
                    if let Some(angle) = sample.angle {
                        actual = angle.value[Dof::Index].raw();
                    }
                }
                Record::Sent {
                    at, cause, write, ..
                } => {
                    if let Some(to) = write.angle_targets()[Dof::Index] {
                        all.push(Sent {
                            at: *at,
                            to: to.get(),
                            actual,
                            cause: *cause,
                        });
                    }
                }
                _ => {}
            }
        }
        all
    }
}

/// No target of a source goes further than its limits let it in the time since the one before, or is ahead by more than the lead
/// and what the joint moved since it was read.
pub(super) fn check(all: &[Sent]) {
    let mut before: Option<Sent> = None;
    for sent in all.iter().filter(|sent| sent.cause == WriteCause::Setpoint) {
        let is_entry = sent.to.abs_diff(sent.actual) <= 25;
        if let Some(before) = before.filter(|_| !is_entry) {
            let may = f64::from(LIMITS.rate) * sent.at.since(before.at).as_secs_f64() + 25.0;
            let step = f64::from(sent.to.abs_diff(before.to));
            assert!(step <= may, "{step} of {may}: {before:?} {sent:?}");
        } else {
            assert!(is_entry, "begun with a jump: {sent:?}");
        }
        assert!(
            sent.to.abs_diff(sent.actual) <= LIMITS.lead + 25,
            "{sent:?}"
        );
        before = Some(*sent);
    }
}

#[test]
fn a_source_that_starts_freezes_is_killed_and_restarts_never_jumps_the_hand() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let open = stage.sample().angle.unwrap().value[Dof::Index].raw();
        // It asks for a fist in its first message.
        let (offers, task) = stage.start(stage.link.grant(Owner::Gamepad));
        stage
            .send(&offers, |n| i16::try_from(n % 7).unwrap(), 700)
            .await;
        let first = stage.index()[0];
        assert!(first.to.abs_diff(open) <= 2, "{first:?}");
        // Tracking is lost: the same pose for two seconds, and then one far away.
        stage.send(&offers, |_| 640, 2000).await;
        stage
            .send(&offers, |n| 300 + i16::try_from(n % 5).unwrap(), 800)
            .await;
        // It is killed.
        drop(offers);
        stage.pass(600).await;
        let (end, phases) = task.await.unwrap();
        assert_eq!(end, Ok(()));
        assert!(phases.contains(&FollowPhase::Frozen), "{phases:?}");
        let status = stage.link.status();
        assert_eq!((status.armed, status.holder), (None, None));
        let moved = stage.index();
        assert!(moved.len() > 60, "{}", moved.len());
        // Started again, it moves nothing before a person lets it.
        let before = moved.len();
        stage.pass(1000).await;
        assert_eq!(stage.index().len(), before);
        let (offers, task) = stage.start(stage.link.grant(Owner::Gamepad));
        stage
            .send(&offers, |n| 900 + i16::try_from(n % 3).unwrap(), 1000)
            .await;
        // It falls silent, but is not gone.
        stage.pass(1500).await;
        let (end, phases) = task.await.unwrap();
        assert_eq!(end, Ok(()));
        assert!(phases.contains(&FollowPhase::Silent), "{phases:?}");
        assert_eq!(stage.link.status().disarmed, Some(Disarmed::Silent));
        check(&stage.index());
    });
}

#[test]
fn a_warm_drive_is_told_and_a_hot_one_stops_the_hand_whoever_is_followed() {
    in_virtual_time(async {
        let hand = hand::begin(hand::free(SimConfig::default()));
        let mut stage = Stage::at(hand.clone()).await;
        let warm = |celsius| hand.with(|hand, _| hand.warm(Dof::Index, celsius));
        warm(65.0);
        let (offers, taken) = mpsc::channel(64);
        let (link, start) = (
            stage.link.clone(),
            stage.beginning(stage.link.grant(Owner::Gamepad)),
        );
        let task = tokio::spawn(async move {
            let mut heats = Vec::new();
            let end = follow(&link, start, taken, |view| heats.push(view.heat)).await;
            (end, heats)
        });
        let about = |n: u64| 500 + i16::try_from(n % 5).unwrap();
        stage.send(&offers, about, 1000).await;
        assert!(
            stage.link.status().armed.is_some(),
            "warm is no reason to stop"
        );
        warm(72.0);
        stage.send(&offers, about, 1000).await;
        let (end, heats) = task.await.unwrap();
        let by_heat = |end| {
            let dof = Dof::Index;
            matches!(end, Err(Abort::Heat { dof: hot, .. }) if hot == dof)
        };
        assert!(by_heat(end), "{end:?}");
        let heat = stage.link.status().heat.unwrap();
        assert!(heat.dof == Dof::Index && heat.is_hot(), "{heat}");
        let warmest = heats.iter().flatten().map(|heat| heat.celsius).max();
        assert!(
            warmest.is_some_and(|celsius| (60..70).contains(&celsius)),
            "{warmest:?}"
        );
        let status = stage.link.status();
        assert_eq!((status.armed, status.holder), (None, None));
        assert_eq!(status.disarmed, Some(Disarmed::Hot));
        let sent = stage.index();
        assert_eq!(sent.last().unwrap().cause, WriteCause::Hold);
        check(&sent);
        // Let again while it is hot, it moves nothing.
        stage.pass(1000).await;
        let before = stage.index().len();
        let (offers, task) = stage.start(stage.link.grant(Owner::Gamepad));
        stage.send(&offers, about, 500).await;
        assert!(by_heat(task.await.unwrap().0));
        let since = stage.index().split_off(before);
        assert!(
            since.iter().all(|sent| sent.cause == WriteCause::Hold),
            "{since:?}"
        );
    });
}

#[test]
fn whoever_moved_the_hand_before_is_refused_and_a_stop_ends_all() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let lease = stage.link.grant(Owner::Gamepad);
        let (offers, task) = stage.start(lease);
        stage
            .send(&offers, |n| 500 + i16::try_from(n % 3).unwrap(), 300)
            .await;
        assert!(stage.link.status().armed.is_some());
        // A person takes over.
        let person = stage.link.grant(Owner::Person);
        let here = stage.index().len();
        stage.send(&offers, |_| 0, 300).await;
        task.await.unwrap().0.unwrap_err();
        assert_eq!(stage.index().len(), here, "nothing of the one before");
        let mut setpoints = Setpoints::none(stage.link.status().armed.unwrap());
        setpoints.angle[Dof::Index] = Some(Target::Go(Angle::MAX));
        assert!(stage.link.set(lease, &setpoints).is_err());
        assert!(stage.link.set(person, &setpoints).is_ok());
        stage.pass(50).await;
        assert_eq!(stage.index().last().unwrap().to, 1000);
        stage.link.stop();
        stage.pass(1000).await;
        assert!(stage.link.set(person, &setpoints).is_err());
        assert!(stage.link.arm(person, gentle()).is_err());
        let holds = stage.index();
        stage.pass(1000).await;
        let after = stage.index();
        assert_eq!(after.len(), holds.len());
        assert_eq!(after.last().unwrap().cause, WriteCause::Hold);
    });
}

#[test]
fn motion_ends_with_the_time_that_a_person_holds_what_has_to_be_held() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let lease = stage.link.grant(Owner::Person);
        let until = |stage: &Stage| stage.clock.now().plus(Duration::from_millis(300));
        stage.link.run_until(lease, until(&stage)).unwrap();
        stage.link.arm(lease, gentle()).unwrap();
        stage.pass(200).await;
        assert!(stage.link.status().armed.is_some());
        // Put off while it is held.
        stage.link.run_until(lease, until(&stage)).unwrap();
        stage.pass(250).await;
        assert!(stage.link.status().armed.is_some());
        // The window hangs: nobody puts it off any more.
        stage.pass(100).await;
        let status = stage.link.status();
        assert_eq!(
            (status.armed, status.disarmed),
            (None, Some(Disarmed::Released))
        );
        stage.pass(500).await;
        assert_eq!(stage.index().last().unwrap().cause, WriteCause::Hold);
        // Held again, it goes on under the same lease; let go, the stop is the next thing on the wire.
        stage.link.run_until(lease, until(&stage)).unwrap();
        stage.link.arm(lease, gentle()).unwrap();
        stage.pass(200).await;
        assert!(stage.link.status().armed.is_some());
        let let_go = stage.clock.now();
        stage.link.halt(lease).unwrap();
        stage.pass(50).await;
        let hold = *stage.index().last().unwrap();
        assert_eq!(hold.cause, WriteCause::Hold);
        assert!(
            hold.at.since(let_go) <= Duration::from_millis(50),
            "{hold:?}"
        );
        assert!(stage.link.check(lease).is_ok());
    });
}

#[test]
fn nobody_arms_or_goes_on_while_what_has_to_be_held_at_the_window_is_not() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let lease = stage.link.grant(Owner::Stream(([127, 0, 0, 1], 9).into()));
        stage.link.hold_to_run(HoldToRun::Released);
        stage.link.arm(lease, gentle()).unwrap();
        stage.pass(200).await;
        assert_eq!(stage.link.status().armed, None);
        let refused = |record: &Record| {
            matches!(
                record,
                Record::ArmRefused {
                    reason: ArmRefusal::LetGo,
                    ..
                }
            )
        };
        assert!(stage.seen.iter().any(refused));
        let held = stage.clock.now().plus(Duration::from_millis(300));
        stage.link.hold_to_run(HoldToRun::Held(held));
        stage.link.arm(lease, gentle()).unwrap();
        stage.pass(150).await;
        assert!(stage.link.status().armed.is_some());
        let let_go = stage.clock.now();
        stage.link.hold_to_run(HoldToRun::Released);
        stage.pass(50).await;
        let hold = *stage.index().last().unwrap();
        assert_eq!(hold.cause, WriteCause::Hold);
        let took = hold.at.since(let_go);
        assert!(took <= Duration::from_millis(50), "{took:?}");
        // The lease outlasts it, and another that is granted has to be held, too.
        assert!(stage.link.check(lease).is_ok());
        let person = stage.link.grant(Owner::Person);
        stage.pass(500).await;
        stage.link.arm(person, gentle()).unwrap();
        stage.pass(200).await;
        assert_eq!(stage.link.status().armed, None);
    });
}

#[test]
fn a_gap_is_gone_to_over_the_wire_and_not_at_all_without_one_of_its_joints() {
    for is_locked in [false, true] {
        in_virtual_time(async {
            let mut stage = Stage::begin().await;
            let (offers, taken) = mpsc::channel(64);
            let mut locked = PerDof::splat(false);
            locked[Dof::ThumbRotate] = is_locked;
            let terms = FollowTerms {
                limits: LIMITS,
                locked,
                ..FollowTerms::default()
            };
            let start = FollowStart {
                terms: watch::Sender::new(terms).subscribe(),
                ..stage.beginning(stage.link.grant(Owner::Gamepad))
            };
            let link = stage.link.clone();
            let task = tokio::spawn(async move { follow(&link, start, taken, |_| ()).await });
            let gap = Gap::nearest(30.0);
            for _ in 0..1200 {
                let _sent = offers.try_send(Offer {
                    at: stage.clock.now(),
                    aims: gap.angles().map(Some),
                    gap: Some(gap),
                    hold: None,
                    limits: OfferLimits::NONE,
                    held: None,
                    mark: None,
                });
                stage.pass(10).await;
            }
            let now = stage.sample().angle.unwrap().value;
            let counts = now.map(|angle| f32::from(angle.raw()));
            if is_locked {
                assert!(
                    stage.index().is_empty(),
                    "nothing is closed beside the thumb"
                );
            } else {
                let mm = gap_on_path(&counts).unwrap();
                assert!((mm - 30.0).abs() < 3.0, "{mm}");
                check(&stage.index());
            }
            drop(offers);
            let _end = task.await.unwrap();
        });
    }
}
