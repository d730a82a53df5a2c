//! A hand that follows another one, each behind a link of its own that can break, in virtual time: where it goes, that the other
//! is only read, and what is left of it when either is lost.

use crate::setup::link::{dial, gentle, missing, opened};
use crate::setup::time::in_virtual_time;
use crate::setup::{hand, link};
use handscope::hand::gap::SizeBlocks;
use handscope::hand::grip::GripEstimator;
use handscope::hand::overshoot::OvershootMap;
use handscope::hand::register::ANGLE_SET;
use handscope::hand::{Dof, HandSample};
use handscope::inputs::mirror::{MirrorScale, MirrorSource};
use handscope::inputs::offer::{END_TIMEOUT, HOLD_TIMEOUT};
use handscope::link::{Clock, LinkHandle, Owner, Records};
use handscope::motion::follow::step::FollowPhase;
use handscope::motion::follow::{FollowStart, FollowTerms, FollowView, follow};
use handscope::motion::program::Ended;
use handscope::record::Abort;
use handscope::record::{Disarmed, LinkState, Record, WriteCause};
use handscope::sim::{SharedHand, SimConfig};
use handscope::transport::pair;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::sync::watch;
use tokio::task::JoinHandle;
use tokio::time::sleep;

/// What serves a hand at the far end of a wire; `None` while there is no wire.
type Far = Arc<Mutex<Option<JoinHandle<()>>>>;

/// A hand behind a wire that breaks and is mended.
struct Side {
    hand: SharedHand,
    link: LinkHandle,
    records: Records,
    far: Far,
    is_cut: Arc<Mutex<bool>>,
    seen: Vec<Record>,
}

impl Side {
    fn open(clock: Clock) -> Self {
        let hand = hand::begin(hand::free(SimConfig::default()));
        let (far, is_cut) = (Far::default(), Arc::new(Mutex::new(false)));
        let behind = (hand.clone(), Arc::clone(&far), Arc::clone(&is_cut));
        let dial = dial(move |endpoint| {
            let (hand, far, is_cut) = &behind;
            if *is_cut.lock().unwrap() {
                return missing(endpoint.place());
            }
            let (ours, its) = pair();
            let serves = hand::serve(hand.clone(), endpoint, its);
            *far.lock().unwrap() = Some(serves);
            opened(ours)
        });
        let mut config = link::config("rs485:x", dial);
        config.clock = clock;
        let (link, records) = handscope::link::open(config, &Handle::current());
        Self {
            hand,
            link,
            records,
            far,
            is_cut,
            seen: Vec::new(),
        }
    }

    fn cut(&self) {
        *self.is_cut.lock().unwrap() = true;
        self.far.lock().unwrap().take().unwrap().abort();
    }

    fn mend(&self) {
        *self.is_cut.lock().unwrap() = false;
    }

    fn take_in(&mut self) {
        self.seen
            .extend(std::iter::from_fn(|| self.records.try_next()));
    }

    fn sample(&self) -> HandSample {
        let mut all = self.seen.iter().rev();
        let newest = all.find_map(|record| match record {
            Record::Reading { sample, .. } => Some(**sample),
            _ => None,
        });
        newest.expect("the hand was read")
    }

    fn index(&self) -> i16 {
        self.sample().angle.unwrap().value[Dof::Index].raw()
    }

    /// Somebody else, at the hand itself, sends its index here.
    fn send(&self, index: i16) {
        let mut bytes = [0xFF; 12];
        bytes[6..8].copy_from_slice(&index.to_le_bytes());
        self.hand.with(|hand, now| {
            hand.write(ANGLE_SET.span().address, &bytes, now).unwrap();
        });
    }

    /// Setpoints that went out.
    fn setpoints(&self) -> usize {
        let is_one = |record: &&Record| {
            matches!(
                record,
                Record::Sent {
                    cause: WriteCause::Setpoint,
                    ..
                }
            )
        };
        self.seen.iter().filter(is_one).count()
    }
}

/// One hand that leads and one that follows.
struct Stage {
    clock: Clock,
    leader: Side,
    follower: Side,
    source: MirrorSource,
}

type Following = JoinHandle<(Ended<()>, Vec<FollowPhase>)>;

impl Stage {
    async fn begin(share: f32) -> Self {
        let clock = Clock::start();
        let (leader, follower) = (Side::open(clock), Side::open(clock));
        let scale = MirrorScale::new(share).unwrap();
        let source = MirrorSource::open(leader.link.records(), scale);
        let mut stage = Self {
            clock,
            leader,
            follower,
            source,
        };
        stage.pass(1000).await;
        stage
    }

    async fn pass(&mut self, ms: u64) {
        sleep(Duration::from_millis(ms)).await;
        self.leader.take_in();
        self.follower.take_in();
    }

    /// A person lets one follow the other.
    fn follow(&self) -> Following {
        let link = self.follower.link.clone();
        let start = FollowStart {
            lease: link.grant(Owner::Mirror),
            terms: watch::Sender::new(FollowTerms::default()).subscribe(),
            arm: gentle(),
            grip: GripEstimator::default(),
            overshoot: OvershootMap::default(),
            blocks: SizeBlocks::default(),
            seen: self.follower.sample(),
            clock: self.clock,
        };
        let offers = self.source.follow();
        tokio::spawn(async move {
            let mut phases = Vec::new();
            let tell = |view: FollowView| {
                if phases.last() != Some(&view.phase) {
                    phases.push(view.phase);
                }
            };
            (follow(&link, start, offers, tell).await, phases)
        })
    }
}

#[test]
fn one_hand_goes_where_the_other_is_by_its_share_and_the_other_is_only_read() {
    for (share, expected) in [(1.0, 300), (0.5, 650), (0.2, 860)] {
        in_virtual_time(async {
            let mut stage = Stage::begin(share).await;
            let following = stage.follow();
            stage.leader.send(300);
            stage.pass(4000).await;
            let (leads, follows) = (stage.leader.index(), stage.follower.index());
            assert!(leads.abs_diff(300) <= 25, "{leads}");
            assert!(follows.abs_diff(expected) <= 25, "{share}: {follows}");
            let holder = stage.follower.link.status().holder.unwrap();
            assert_eq!(holder.owner, Owner::Mirror);
            following.abort();
            let writes = stage.leader.hand.with(|hand, _| hand.journal().len());
            assert_eq!(writes, 1, "what the test wrote there itself");
            assert_eq!(stage.leader.link.status().state, LinkState::Monitoring);
        });
    }
}

#[test]
fn a_leader_that_rests_is_not_frozen_and_is_followed_on_when_it_moves_again() {
    in_virtual_time(async {
        let mut stage = Stage::begin(1.0).await;
        let following = stage.follow();
        stage.leader.send(500);
        stage.pass(3000).await;
        let still: Vec<i16> = {
            let before = stage.leader.seen.len();
            stage.pass(5000).await;
            let news = stage.leader.seen[before..].iter();
            news.filter_map(|record| match record {
                Record::Reading { sample, .. } => Some(sample.angle?.value[Dof::Index].raw()),
                _ => None,
            })
            .collect()
        };
        assert!(still.len() > 400 && still.iter().all(|angle| *angle == still[0]));
        stage.leader.send(200);
        stage.pass(3000).await;
        let at = stage.follower.index();
        assert!(at.abs_diff(200) <= 25, "{at}");
        stage.follower.link.stop();
        let (end, phases) = following.await.unwrap();
        assert_eq!(
            end,
            Err(Abort::Disarmed {
                why: Some(Disarmed::Stop)
            }),
            "a stop ends it as any other"
        );
        assert_eq!(phases, [FollowPhase::Waiting, FollowPhase::Following]);
    });
}

#[test]
fn a_lost_leader_holds_the_follower_and_ends_it_and_nothing_moves_when_it_is_back() {
    in_virtual_time(async {
        let mut stage = Stage::begin(1.0).await;
        let following = stage.follow();
        stage.leader.send(0);
        stage.pass(400).await;
        assert!(stage.source.view().owner(stage.clock.now()).is_some());
        stage.leader.cut();
        let lost = stage.clock.now();
        let (end, phases) = following.await.unwrap();
        let took = stage.clock.now().since(lost);
        assert_eq!(end, Ok(()));
        assert!(took > END_TIMEOUT - HOLD_TIMEOUT && took < END_TIMEOUT + HOLD_TIMEOUT);
        assert_eq!(phases.last(), Some(&FollowPhase::Silent));
        assert!(stage.source.view().owner(stage.clock.now()).is_none());
        stage.pass(1000).await;
        let status = stage.follower.link.status();
        assert_eq!((status.armed, status.holder), (None, None));
        assert_eq!(status.disarmed, Some(Disarmed::Silent));
        let (held, sent) = (stage.follower.index(), stage.follower.setpoints());
        assert!((100..900).contains(&held), "held on its way: {held}");
        stage.leader.mend();
        stage.pass(5000).await;
        assert!(stage.source.view().owner(stage.clock.now()).is_some());
        assert!(stage.leader.index() < 50, "it went on");
        assert_eq!(stage.follower.setpoints(), sent);
        assert!(stage.follower.index().abs_diff(held) <= 5);
    });
}

#[test]
fn a_lost_follower_ends_it_and_nothing_moves_when_it_is_back() {
    in_virtual_time(async {
        let mut stage = Stage::begin(1.0).await;
        let following = stage.follow();
        stage.leader.send(0);
        stage.pass(400).await;
        stage.follower.cut();
        let (end, _) = following.await.unwrap();
        assert_eq!(end, Err(Abort::LinkLost));
        stage.pass(500).await;
        let sent = stage.follower.setpoints();
        stage.follower.mend();
        stage.pass(5000).await;
        assert_eq!(stage.follower.link.status().state, LinkState::Monitoring);
        assert_eq!(stage.follower.setpoints(), sent);
        assert_eq!(stage.follower.link.status().holder, None);
    });
}
