//! Exhibitions in virtual time: what a visitor, staff, heat, faults and a lost link do, and that nothing else ever moves.

use crate::exhibit::file;
use crate::exhibit::plan::ExhibitPlan;
use crate::exhibit::stage::{ExhibitEvent, ExhibitStage, ExhibitView, ExhibitWish, HaltReason};
use crate::hand::gap::SizeBlocks;
use crate::hand::grip::GripEstimator;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Fault, Faults, HandSample, Moment, PerDof, Target,
    TemperatureReading, Timed,
};
use crate::link::{Clock, LinkStatus, Owner};
use crate::motion::exhibit::{ExhibitRun, ExhibitStart, PageDrawn, exhibit};
use crate::motion::program::Progress;
use crate::motion::program::{Order, Program as _, Seen};
use crate::motion::tests::booth::BoothHand;
use crate::record::{Disarmed, LinkState};
use crate::soak;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::task::JoinHandle;
use tokio::time::sleep;

/// Tiles of the built-in exhibition.
const FIST: usize = 1;
const POINT: usize = 2;
const WAVE: usize = 8;

fn plan() -> ExhibitPlan {
    file::built_in().unwrap()
}

/// An exhibition at a hand.
struct Booth {
    hand: BoothHand,
    wishes: mpsc::Sender<ExhibitWish>,
    view: Arc<Mutex<ExhibitView>>,
    events: Arc<Mutex<BTreeMap<String, u64>>>,
    task: JoinHandle<()>,
    /// What draws the page.
    window: JoinHandle<()>,
}

/// A window that draws the page all the time.
fn draws(clock: Clock, page: Arc<PageDrawn>) -> JoinHandle<()> {
    tokio::spawn(async move {
        loop {
            page.mark(clock.now());
            sleep(Duration::from_millis(250)).await;
        }
    })
}

impl Booth {
    fn open(plan: ExhibitPlan, heating: f64) -> Self {
        Self::open_with(plan, heating, PerDof::splat(false))
    }

    fn open_with(plan: ExhibitPlan, heating: f64, locked: PerDof<bool>) -> Self {
        let hand = BoothHand::new(&plan, 30.0, heating);
        let (wishes, wanted) = mpsc::channel(64);
        let view = Arc::new(Mutex::new(ExhibitView::default()));
        let events = Arc::new(Mutex::new(BTreeMap::new()));
        let start = ExhibitStart {
            plan: Arc::new(plan),
            locked,
            seen: HandSample::default(),
            grip: GripEstimator::default(),
            overshoot: OvershootMap::default(),
            blocks: SizeBlocks::default(),
            clock: hand.clock,
            drawn: Arc::default(),
        };
        let window = draws(hand.clock, Arc::clone(&start.drawn));
        let (shown, counted, at) = (Arc::clone(&view), Arc::clone(&events), hand.clone());
        let task = tokio::spawn(async move {
            let tell = |step| match step {
                Progress::View(view) => *shown.lock().unwrap() = view,
                Progress::Event(event) => {
                    let name = match event {
                        ExhibitEvent::Piece(_) => "piece".to_owned(),
                        event => format!("{event:?}"),
                    };
                    *counted.lock().unwrap().entry(name).or_default() += 1;
                }
                Progress::Sent(_) => {}
            };
            exhibit(&at, start, wanted, tell).await;
        });
        Self {
            hand,
            wishes,
            view,
            events,
            task,
            window,
        }
    }

    fn wish(&self, wish: ExhibitWish) {
        self.wishes.try_send(wish).unwrap();
    }

    /// Staff arm it, with all that belongs to it.
    async fn arm(&self) {
        self.hand.facts().person_armed = true;
        self.wish(ExhibitWish::Arm);
        sleep(Duration::from_secs(1)).await;
    }

    async fn armed(plan: ExhibitPlan) -> Self {
        let booth = Self::open(plan, 1.0);
        sleep(Duration::from_secs(2)).await;
        booth.arm().await;
        sleep(Duration::from_secs(5)).await;
        booth
    }

    async fn press(&self, tile: usize) {
        self.wish(ExhibitWish::Press(tile));
        sleep(Duration::from_millis(80)).await;
        self.wish(ExhibitWish::Release);
    }

    fn stop(&self) {
        self.hand.facts().person_armed = false;
        self.hand.stop();
        self.wish(ExhibitWish::Stop);
    }

    fn stage(&self) -> ExhibitStage {
        self.view.lock().unwrap().stage
    }

    fn count(&self, event: &str) -> u64 {
        self.events
            .lock()
            .unwrap()
            .get(event)
            .copied()
            .unwrap_or_default()
    }

    /// Nothing was sent that should not have been.
    fn all_well(&self) {
        assert!(!self.task.is_finished());
        assert_eq!(self.hand.facts().wrong, Vec::<String>::new());
    }

    fn is_armed(&self) -> bool {
        self.hand.facts().status.armed.is_some()
    }

    fn moves(&self) -> u64 {
        self.hand.facts().moves
    }
}

fn s(seconds: u64) -> Duration {
    Duration::from_secs(seconds)
}

#[tokio::test(start_paused = true)]
async fn nothing_moves_before_staff_arm_whatever_is_pressed() {
    let booth = Booth::open(plan(), 1.0);
    sleep(s(2)).await;
    for tile in 0..14 {
        booth.press(tile).await;
        booth.wish(ExhibitWish::Touch);
        sleep(s(20)).await;
    }
    assert_eq!(booth.stage(), ExhibitStage::Halted(HaltReason::NotArmed));
    assert_eq!(booth.moves(), 0);
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_visitor_has_a_moving_hand_at_once_and_it_opens_and_disarms_once_they_have_gone() {
    let booth = Booth::armed(plan()).await;
    assert_eq!(booth.stage(), ExhibitStage::Idle);
    assert!(!booth.is_armed(), "at rest nothing may move");
    booth.press(FIST).await;
    sleep(Duration::from_millis(500)).await;
    assert!(matches!(booth.stage(), ExhibitStage::Visit { .. }));
    assert!(
        booth.hand.angle(Dof::Index) < 990.0,
        "{}",
        booth.hand.angle(Dof::Index)
    );
    sleep(s(6)).await;
    assert!(booth.hand.angle(Dof::Index) < 10.0);
    sleep(s(30)).await;
    assert_eq!(booth.stage(), ExhibitStage::Idle);
    assert!(booth.hand.angle(Dof::Index) > 990.0 && !booth.is_armed());
    assert_eq!((booth.count("Visit"), booth.count("piece")), (1, 1));
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn the_time_of_a_visitor_ends_and_the_next_one_plays() {
    let booth = Booth::armed(plan()).await;
    booth.press(WAVE).await;
    sleep(s(100)).await;
    assert!(
        matches!(booth.stage(), ExhibitStage::Visit { .. }),
        "it goes round and round"
    );
    assert!(booth.is_armed());
    sleep(s(21)).await;
    assert!(
        matches!(booth.stage(), ExhibitStage::NextVisitor { .. }),
        "{:?}",
        booth.stage()
    );
    booth.press(FIST).await;
    sleep(s(4)).await;
    assert!(booth.hand.angle(Dof::Index) > 990.0, "not yet");
    sleep(s(2)).await;
    booth.press(FIST).await;
    sleep(s(5)).await;
    assert!(booth.hand.angle(Dof::Index) < 10.0);
    assert_eq!(booth.count("Visit"), 2);
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn the_attract_loop_begins_after_a_minute_and_rests() {
    let booth = Booth::armed(plan()).await;
    sleep(s(50)).await;
    assert_eq!(
        (booth.stage(), booth.is_armed()),
        (ExhibitStage::Idle, false)
    );
    sleep(s(15)).await;
    assert_eq!(
        (booth.stage(), booth.is_armed()),
        (ExhibitStage::Attract, true)
    );
    sleep(s(60)).await;
    assert_eq!(
        (booth.stage(), booth.is_armed()),
        (ExhibitStage::Idle, false)
    );
    sleep(s(130)).await;
    assert_eq!(booth.stage(), ExhibitStage::Attract);
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_touch_ends_the_attract_loop_with_a_hold_at_once_and_the_tile_follows() {
    let booth = Booth::armed(plan()).await;
    while !(booth.stage() == ExhibitStage::Attract && booth.hand.angle(Dof::Little) < 800.0) {
        sleep(Duration::from_millis(20)).await;
    }
    let before = booth.hand.facts().sent.len();
    let at = booth.hand.clock.now();
    booth.wish(ExhibitWish::Press(POINT));
    sleep(Duration::from_millis(200)).await;
    let sent = booth.hand.facts().sent.clone();
    let (held, hold) = &sent[before];
    assert!(
        held.since(at) <= Duration::from_millis(16),
        "{:?}",
        held.since(at)
    );
    assert!(
        hold.speed.iter().all(|(_, speed)| speed.is_none()),
        "a hold: {hold:?}"
    );
    let near = |dof: Dof| match hold.angle[dof] {
        Some(Target::Go(to)) => (f64::from(to.get()) - booth.hand.angle(dof)).abs() < 120.0,
        _ => false,
    };
    assert!(near(Dof::Little), "{hold:?}");
    let after: Vec<_> = sent[before + 1..].iter().collect();
    assert!(
        after
            .iter()
            .any(|(_, to)| to.angle[Dof::Ring] == Some(Target::Go(Angle::MIN))),
        "{after:?}"
    );
    assert!(matches!(booth.stage(), ExhibitStage::Visit { .. }));
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_touch_beside_the_tiles_holds_the_attract_loop_and_it_opens_later() {
    let booth = Booth::armed(plan()).await;
    while !(booth.stage() == ExhibitStage::Attract && booth.hand.angle(Dof::Little) < 800.0) {
        sleep(Duration::from_millis(20)).await;
    }
    booth.wish(ExhibitWish::Touch);
    sleep(Duration::from_millis(300)).await;
    let held = booth.hand.angle(Dof::Little);
    sleep(s(20)).await;
    assert!((booth.hand.angle(Dof::Little) - held).abs() < 2.0);
    sleep(s(15)).await;
    assert!(booth.hand.angle(Dof::Little) > 990.0 && !booth.is_armed());
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn stop_a_lost_link_sleep_and_others_end_the_arming_until_staff_come() {
    type Ends = fn(&Booth);
    let ends: [(HaltReason, Ends); 6] = [
        (HaltReason::Stopped, Booth::stop),
        (HaltReason::Slept, |booth| booth.hand.sleeps()),
        (HaltReason::NoFeedback, |booth| {
            booth.hand.disarmed(Disarmed::Stale)
        }),
        (HaltReason::NoFeedback, |booth| {
            booth.hand.disarmed(Disarmed::FrozenFeedback);
        }),
        (HaltReason::OtherController, |booth| {
            booth.hand.disarmed(Disarmed::OtherController);
        }),
        (HaltReason::Fault, |booth| {
            booth.hand.fails(Dof::Ring, Fault::OverTemperature);
        }),
    ];
    for (why, end) in ends {
        let booth = Booth::armed(plan()).await;
        booth.press(FIST).await;
        sleep(Duration::from_millis(700)).await;
        end(&booth);
        sleep(s(1)).await;
        let before = booth.moves();
        for _ in 0..20 {
            booth.press(FIST).await;
            sleep(s(60)).await;
        }
        assert_eq!(booth.stage(), ExhibitStage::Halted(why));
        assert_eq!(booth.moves(), before, "{why:?}");
        booth.arm().await;
        sleep(s(5)).await;
        assert_eq!(booth.stage(), ExhibitStage::Idle, "{why:?}");
        booth.all_well();
    }
}

#[tokio::test(start_paused = true)]
async fn a_pulled_cable_or_a_hand_off_and_on_comes_back_and_does_not_move() {
    let booth = Booth::armed(plan()).await;
    booth.press(WAVE).await;
    sleep(s(2)).await;
    booth.hand.plug(false);
    sleep(Duration::from_millis(200)).await;
    assert_eq!(booth.stage(), ExhibitStage::Halted(HaltReason::NoHand));
    sleep(s(30)).await;
    booth.hand.plug(true);
    let moves = booth.moves();
    sleep(s(1)).await;
    assert_eq!(booth.stage(), ExhibitStage::Halted(HaltReason::LinkLost));
    sleep(s(300)).await;
    assert_eq!(booth.moves(), moves, "never by itself");
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn faults_that_can_be_cleared_are_at_most_three_times_in_ten_minutes() {
    let booth = Booth::armed(plan()).await;
    for clears in 1..=3 {
        booth.press(FIST).await;
        sleep(s(1)).await;
        booth.hand.fails(Dof::Index, Fault::Stall);
        sleep(s(8)).await;
        assert_eq!(booth.stage(), ExhibitStage::Idle);
        assert_eq!(booth.hand.facts().clears, clears);
        assert!(booth.hand.angle(Dof::Index) > 990.0, "it opens then");
    }
    booth.press(FIST).await;
    sleep(s(1)).await;
    booth.hand.facts().person_armed = false;
    booth.hand.fails(Dof::Index, Fault::Stall);
    sleep(s(700)).await;
    assert_eq!(
        booth.stage(),
        ExhibitStage::Halted(HaltReason::Fault),
        "the fourth needs a person"
    );
    assert_eq!(
        (booth.hand.facts().clears, booth.count("Fault(Stall)")),
        (3, 4)
    );
    booth.arm().await;
    sleep(s(8)).await;
    assert_eq!(
        (booth.stage(), booth.hand.facts().clears),
        (ExhibitStage::Idle, 4)
    );
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_held_tile_arms_again_only_where_the_file_says_so_and_after_two_seconds() {
    for restart in [false, true] {
        let booth = Booth::armed(ExhibitPlan {
            visitor_restart: restart,
            ..plan()
        })
        .await;
        booth.wish(ExhibitWish::Press(FIST));
        sleep(s(3)).await;
        booth.stop();
        sleep(s(30)).await;
        assert_eq!(
            booth.stage(),
            ExhibitStage::Halted(HaltReason::Stopped),
            "held before does not count"
        );
        booth.press(FIST).await;
        sleep(s(5)).await;
        assert_eq!(
            booth.stage(),
            ExhibitStage::Halted(HaltReason::Stopped),
            "too short"
        );
        booth.wish(ExhibitWish::Press(FIST));
        sleep(Duration::from_millis(1900)).await;
        let moves = booth.moves();
        booth.hand.facts().person_armed = restart;
        sleep(s(8)).await;
        let is_playing = matches!(booth.stage(), ExhibitStage::Visit { .. });
        assert_eq!((is_playing, booth.moves() > moves), (restart, restart));
        booth.all_well();
    }
}

#[tokio::test(start_paused = true)]
async fn a_joint_that_was_locked_is_left_alone() {
    let locked = PerDof::from_fn(|dof| dof == Dof::Ring);
    let booth = Booth::open_with(plan(), 1.0, locked);
    sleep(s(2)).await;
    booth.arm().await;
    booth.press(FIST).await;
    sleep(s(8)).await;
    assert!(booth.hand.angle(Dof::Ring) > 990.0 && booth.hand.angle(Dof::Middle) < 10.0);
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn nobody_who_leaves_the_exhibition_leaves_an_armed_hand() {
    let booth = Booth::armed(plan()).await;
    booth.press(WAVE).await;
    sleep(s(2)).await;
    let Booth {
        hand, wishes, task, ..
    } = booth;
    drop(wishes);
    task.await.unwrap();
    assert!(hand.facts().status.armed.is_none());
    assert_eq!(hand.facts().status.disarmed, Some(Disarmed::Stop));
}

#[tokio::test(start_paused = true)]
async fn a_touch_while_the_attract_loop_is_arming_leaves_tiles_that_play() {
    let booth = Booth::armed(plan()).await;
    while booth.stage() != ExhibitStage::Attract {
        sleep(Duration::from_millis(10)).await;
    }
    assert!(!booth.is_armed(), "it is only asked for");
    booth.wish(ExhibitWish::Touch);
    sleep(s(3)).await;
    booth.press(FIST).await;
    sleep(s(6)).await;
    assert!(booth.hand.angle(Dof::Index) < 10.0);
    sleep(s(30)).await;
    assert!(booth.hand.angle(Dof::Index) > 990.0 && !booth.is_armed());
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_stop_while_it_is_arming_wins() {
    let booth = Booth::armed(plan()).await;
    for wait_ms in [0, 5, 20, 39, 41, 60] {
        let moves = booth.moves();
        booth.wish(ExhibitWish::Press(FIST));
        sleep(Duration::from_millis(wait_ms)).await;
        booth.stop();
        sleep(Duration::from_millis(5)).await;
        assert!(booth.moves() <= moves + 1, "{wait_ms}");
        let moves = booth.moves();
        sleep(s(5)).await;
        assert_eq!(
            booth.stage(),
            ExhibitStage::Halted(HaltReason::Stopped),
            "{wait_ms}"
        );
        assert_eq!((booth.moves(), booth.is_armed()), (moves, false));
        booth.arm().await;
        sleep(s(5)).await;
    }
    booth.all_well();
}

fn at(second: u64) -> Moment {
    Moment::from_micros(second * 1_000_000)
}

/// One step of an exhibition at a cool hand in this state, under the arming of this number if any, after a wish.
fn order_of(
    run: &mut ExhibitRun,
    (state, armed): (LinkState, Option<u64>),
    second: u64,
    wish: Option<ExhibitWish>,
) -> Option<Order> {
    fn timed<T: Copy>(value: T, second: u64) -> Option<Timed<PerDof<T>>> {
        Some(Timed {
            value: PerDof::splat(value),
            asked: at(second),
            received: at(second),
        })
    }
    let bits = u8::from(state == LinkState::Fault) << Fault::Stall.bit();
    let sample = HandSample {
        angle: timed(AngleReading::new(500), second),
        faults: timed(Faults::from_raw(bits), second),
        temperature: timed(TemperatureReading::new(30), second),
        ..HandSample::default()
    };
    let status = LinkStatus {
        state,
        armed: armed.map(ArmEpoch),
        ..LinkStatus::default()
    };
    let seen = Seen {
        status: &status,
        sample: &sample,
        stall: None,
        now: at(second),
    };
    if let Some(epoch) = armed {
        assert_eq!(run.armed(Ok(ArmEpoch(epoch))), None);
    }
    if let Some(wish) = wish {
        assert_eq!(run.input(wish, &seen), None);
    }
    run.tick(&seen)
}

#[test]
fn a_touch_in_the_moment_of_a_fault_does_not_hang_the_exhibition() {
    let free = (LinkState::Monitoring, None);
    let drawn = Arc::new(PageDrawn::default());
    let start = ExhibitStart {
        plan: Arc::new(plan()),
        locked: PerDof::splat(false),
        seen: HandSample::default(),
        grip: GripEstimator::default(),
        overshoot: OvershootMap::default(),
        blocks: SizeBlocks::default(),
        clock: Clock::start(),
        drawn: Arc::clone(&drawn),
    };
    let mut run = ExhibitRun::new(start, at(0));
    let mut order = |state, second, wish| {
        drawn.mark(at(second));
        order_of(&mut run, state, second, wish)
    };
    assert_eq!(order(free, 1, None), None);
    let granted = order(free, 1, Some(ExhibitWish::Arm));
    assert_eq!(granted, Some(Order::Grant(Owner::Exhibition)));
    for (second, epoch) in [(1, 1), (70, 2)] {
        let asked = order(free, second, None);
        assert!(matches!(asked, Some(Order::Arm(_))), "{asked:?}");
        let armed = (LinkState::Armed, Some(epoch));
        let plays = order(armed, second, None);
        assert!(matches!(plays, Some(Order::Set(_))), "{plays:?}");
        if epoch == 1 {
            assert_eq!(order(free, 5, None), None, "the piece ends with its arming");
            assert_eq!(order(free, 5, None), Some(Order::Rest));
        }
    }
    // The piece is to be held for a visitor, and ends with the fault before it can be.
    let faulty = (LinkState::Fault, None);
    let cleared = order(faulty, 71, Some(ExhibitWish::Touch));
    assert_eq!(cleared, Some(Order::Clear));
    let asked = order(free, 72, None);
    assert!(matches!(asked, Some(Order::Arm(_))), "to open: {asked:?}");
}

#[tokio::test(start_paused = true)]
async fn a_stall_of_a_hot_hand_is_cleared_once_and_then_the_hand_rests() {
    let booth = Booth::armed(plan()).await;
    booth.press(FIST).await;
    sleep(s(3)).await;
    {
        let mut facts = booth.hand.facts();
        for (_, drive) in facts.drives.iter_mut() {
            drive.warm(58.0);
        }
    }
    booth.hand.fails(Dof::Index, Fault::Stall);
    sleep(s(8)).await;
    assert!(
        matches!(booth.stage(), ExhibitStage::Cooling { .. }),
        "{:?}",
        booth.stage()
    );
    assert_eq!((booth.hand.facts().clears, booth.count("Rest")), (1, 1));
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_fault_that_lasts_is_counted_once() {
    let booth = Booth::armed(plan()).await;
    booth.press(FIST).await;
    sleep(s(1)).await;
    booth.hand.facts().person_armed = false;
    booth.hand.facts().drives[Dof::Ring].warm(80.0);
    booth.hand.fails(Dof::Ring, Fault::OverTemperature);
    sleep(s(5)).await;
    assert_eq!(booth.stage(), ExhibitStage::Halted(HaltReason::Fault));
    booth.stop();
    sleep(s(5)).await;
    assert_eq!(booth.count("Fault(OverTemperature)"), 1);
    booth.all_well();
}

#[tokio::test(start_paused = true)]
async fn a_visitor_who_arms_again_does_not_begin_the_count_of_faults_anew() {
    let booth = Booth::armed(ExhibitPlan {
        visitor_restart: true,
        ..plan()
    })
    .await;
    for clears in 1..=3 {
        booth.press(FIST).await;
        sleep(s(1)).await;
        booth.hand.fails(Dof::Index, Fault::Stall);
        sleep(s(8)).await;
        assert_eq!(booth.hand.facts().clears, clears);
    }
    booth.stop();
    sleep(s(2)).await;
    booth.hand.facts().person_armed = true;
    booth.wish(ExhibitWish::Press(FIST));
    sleep(s(3)).await;
    booth.wish(ExhibitWish::Release);
    assert!(booth.is_armed());
    booth.hand.facts().person_armed = false;
    booth.hand.fails(Dof::Index, Fault::Stall);
    sleep(s(8)).await;
    assert_eq!(booth.stage(), ExhibitStage::Halted(HaltReason::Fault));
    assert_eq!(booth.hand.facts().clears, 3);
    booth.all_well();
}

/// Visitors who press without a pause, some of whom hold fingers, for so many hours. Gives the highest temperature of all, how
/// often it rested, and how many pieces were played.
async fn crowd(hours: u64, heating: f64) -> (f64, u64, u64) {
    let booth = Booth::armed(plan()).await;
    for (_, drive) in booth.hand.facts().drives.iter_mut() {
        drive.heat_more(heating);
    }
    let mut chance = fastrand::Rng::with_seed(7);
    for _ in 0..hours * 900 {
        if matches!(booth.stage(), ExhibitStage::Halted(_)) {
            booth.arm().await;
        }
        let dof = *chance.choice(&Dof::ALL).unwrap();
        let jam = (chance.u8(0..20) == 0).then(|| f64::from(chance.u16(300..900)));
        booth.hand.facts().drives[dof].set_jam(jam);
        booth.press(chance.usize(0..10)).await;
        sleep(Duration::from_millis(chance.u64(2000..5500))).await;
        booth.hand.facts().drives[dof].set_jam(None);
    }
    assert_eq!(booth.hand.facts().wrong, Vec::<String>::new());
    (
        booth.hand.facts().hottest,
        booth.count("Rest"),
        booth.count("piece"),
    )
}

#[tokio::test(start_paused = true)]
async fn no_drive_passes_60_degrees_in_hours_of_a_crowd() {
    let hours = soak::times_at_least(1, 8);
    let (usual, _, pieces) = crowd(hours, 1.0).await;
    assert!(usual < 60.0 && pieces > 625 * hours, "{usual} {pieces}");
    let (harsher, _, pieces) = crowd(hours, 1.5).await;
    assert!(harsher < 60.0 && pieces > 625 * hours, "{harsher} {pieces}");
    println!("hottest: {usual:.1} and {harsher:.1}");
}

#[tokio::test(start_paused = true)]
async fn drives_that_would_grow_too_hot_are_slowed_and_rested_before_they_do() {
    // So that pieces played without a rest would make them hotter than 60 °C.
    let (hottest, rests, pieces) = crowd(2, 120.0).await;
    println!("hottest: {hottest:.1}, rests: {rests}, pieces: {pieces}");
    assert!(hottest < 60.0 && hottest > 45.0, "{hottest}");
    assert!(rests > 3 && pieces > 200, "{rests} {pieces}");
}

/// Marks the process that has a day to itself, so that its memory is its own.
const ALONE: &str = "HANDSCOPE_TEST_ALONE";
/// What runs in it.
const THIS: &str =
    "motion::tests::exhibit::a_day_of_touches_faults_and_losses_moves_nothing_that_it_should_not";

#[test]
fn a_day_of_touches_faults_and_losses_moves_nothing_that_it_should_not() {
    if std::env::var_os(ALONE).is_none() {
        let name = THIS;
        let mut alone = std::process::Command::new(std::env::current_exe().unwrap());
        alone.args([name, "--exact", "--nocapture"]).env(ALONE, "1");
        let output = alone.output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        println!("{said}{}", String::from_utf8_lossy(&output.stderr));
        assert!(
            output.status.success() && said.contains("1 passed"),
            "{name}"
        );
        return;
    }
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .start_paused(true)
        .build()
        .unwrap();
    runtime.block_on(a_day());
}

/// Memory of this process, KiB; `None` where the system does not tell.
fn resident_kib() -> Option<u64> {
    let all = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = all.split(' ').nth(1)?.parse().ok()?;
    Some(pages * 4)
}

async fn a_day() {
    let booth = Booth::open(
        ExhibitPlan {
            visitor_restart: true,
            ..plan()
        },
        1.0,
    );
    let mut chance = fastrand::Rng::with_seed(14);
    let hours = soak::times_at_least(3, 24);
    let day = s(hours * 3600);
    let start = booth.hand.clock.now();
    let mut longest_halt = Duration::ZERO;
    let mut halted_since = None;
    let mut early_kib = None;
    while booth.hand.clock.now().since(start) < day {
        let now = booth.hand.clock.now();
        if early_kib.is_none() && now.since(start) > s(2 * 3600) {
            early_kib = resident_kib();
        }
        match booth.stage() {
            ExhibitStage::Halted(_) => {
                let since = *halted_since.get_or_insert(now);
                longest_halt = longest_halt.max(now.since(since));
            }
            _ => halted_since = None,
        }
        step(&booth, &mut chance).await;
    }
    let facts = booth.hand.facts();
    assert_eq!(facts.wrong, Vec::<String>::new());
    println!(
        "{} moves, {} clears, longest halt {longest_halt:?}",
        facts.moves, facts.clears
    );
    assert!(facts.moves > 200 * hours && (facts.clears > 5 || !soak::is_full()));
    drop(facts);
    for event in [
        "Visit",
        "piece",
        "Stop",
        "LinkLost",
        "Fault(Stall)",
        "Fault(Motor)",
    ] {
        assert!(
            booth.count(event) > 5 || !soak::is_full(),
            "{event}: {:?}",
            booth.events
        );
    }
    assert!(longest_halt < s(3 * 3600), "{longest_halt:?}");
    if let Some((early, late)) = early_kib.zip(resident_kib()) {
        println!("after 2 h {early} KiB, after {hours} h {late} KiB");
        assert!(late < early + 2048, "{early} {late}");
    }
}

/// One thing happens.
async fn step(booth: &Booth, chance: &mut fastrand::Rng) {
    let pause = match chance.u8(0..20) {
        0 => chance.u64(60_000..900_000),
        1..=4 => chance.u64(5_000..40_000),
        _ => chance.u64(10..4_000),
    };
    sleep(Duration::from_millis(pause)).await;
    let dof = *chance.choice(&Dof::ALL).unwrap();
    match chance.u16(0..1000) {
        0..=9 => booth.stop(),
        10..=19 => {
            booth.hand.plug(false);
            sleep(Duration::from_millis(chance.u64(5..60_000))).await;
            booth.hand.plug(true);
        }
        20..=22 => booth.hand.sleeps(),
        23..=25 if booth.is_armed() => booth.hand.disarmed(Disarmed::Stale),
        26..=60 => {
            booth.hand.fails(dof, Fault::Stall);
            sleep(s(1)).await;
            // More than three of them need the user.
            if matches!(booth.stage(), ExhibitStage::Halted(_)) {
                booth.hand.facts().person_armed = false;
            }
        }
        61..=70 => booth.hand.fails(dof, Fault::Motor),
        71..=72 => {
            booth.hand.fails(dof, Fault::OverTemperature);
            sleep(s(2)).await;
            booth.hand.facts().drives[dof].warm(30.0);
        }
        73..=120 => booth.wish(ExhibitWish::Touch),
        121..=180 => hold_a_tile(booth, chance).await,
        181..=220 if matches!(booth.stage(), ExhibitStage::Halted(_)) => booth.arm().await,
        _ => booth.press(chance.usize(0..14)).await,
    }
}

/// Somebody holds a tile: where nothing moves, that arms.
async fn hold_a_tile(booth: &Booth, chance: &mut fastrand::Rng) {
    let is_halted = matches!(booth.stage(), ExhibitStage::Halted(why) if why != HaltReason::NoHand);
    let tile = chance.usize(0..10);
    booth.wish(ExhibitWish::Press(tile));
    sleep(Duration::from_millis(1950)).await;
    let may = booth.hand.facts().status.state == LinkState::Monitoring;
    if is_halted && may {
        booth.hand.facts().person_armed = true;
    }
    sleep(Duration::from_millis(chance.u64(100..3000))).await;
    booth.wish(ExhibitWish::Release);
}

#[tokio::test(start_paused = true)]
async fn a_window_that_hangs_ends_the_motion_within_a_second_and_only_staff_begin_again() {
    let booth = Booth::armed(plan()).await;
    booth.press(1).await;
    sleep(Duration::from_millis(300)).await;
    assert!(booth.is_armed());
    booth.window.abort();
    sleep(Duration::from_millis(700)).await;
    assert!(booth.is_armed(), "a slow frame is none that hangs");
    sleep(Duration::from_millis(700)).await;
    assert!(!booth.is_armed());
    let halted = ExhibitStage::Halted(HaltReason::NotShown);
    assert_eq!(booth.stage(), halted);
    let moves = booth.moves();
    booth.press(1).await;
    sleep(Duration::from_secs(5)).await;
    assert_eq!((booth.stage(), booth.moves()), (halted, moves));
    booth.all_well();
}
