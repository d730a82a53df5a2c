//! A Modbus gateway that answers while the hand behind it does not: its exceptions are no feedback. Virtual time.

use crate::setup::gateway::Gateway;
use crate::setup::hand;
use crate::setup::link;
use futures::stream::pending;
use handscope::hand::gap::Gap;
use handscope::hand::grip::GripEstimator;
use handscope::hand::{
    Angle, Dof, Force, HandSample, ModbusException, PerDof, Setpoints, Speed, Target,
};
use handscope::link::{ArmRequest, LinkStatus, LinkTrouble, TouchVariant};
use handscope::motion::drive::Armed;
use handscope::motion::grip::{GripEnd, GripStart, grip};
use handscope::motion::move_to::{MoveEnd, MoveStart, move_to};
use handscope::motion::series::RATES;
use handscope::record::{Disarmed, Hold, LinkState};
use handscope::sim::{Scenario, SharedHand, SimConfig};
use std::sync::Arc;
use tokio::time::{Duration, Instant, sleep};

const PLACE: &str = "tcp:127.0.0.1:6000";
/// The loss of a hand behind a gateway shows within this time.
const LOST_WITHIN: Duration = Duration::from_secs(1);

fn gateway() -> Arc<Gateway> {
    Gateway::to(hand::plain())
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_only_a_gateway_answers_for_is_lost_within_a_second_in_the_gateways_words() {
    for code in [4, 5, 6, 10, 11] {
        let gateway = gateway();
        let mut link = link::connect(PLACE, gateway.dial());
        link::live(&mut link).await;
        link::pass(&mut link, Duration::from_secs(1)).await;
        let (asked, begun) = (gateway.asked(), Instant::now());
        gateway.says(code);
        let lost = link::until(&mut link, LOST_WITHIN, |status| {
            status.state == LinkState::Offline
        })
        .await;
        let exception = ModbusException::of(code);
        let place = "127.0.0.1:6000".to_owned();
        let trouble = Some(LinkTrouble::Gateway { place, exception });
        assert_eq!(lost.trouble, trouble, "{code}");
        let words = lost.trouble.unwrap().to_string();
        assert!(words.contains(&exception.to_string()), "{words}");
        let (asked, took) = (gateway.asked() - asked, begun.elapsed());
        assert!(asked < 60, "{asked} requests in {took:?}: a flood");
        // It comes back by itself once the hand answers.
        sleep(Duration::from_secs(3)).await;
        assert_eq!(link.status().trouble, trouble_of(code), "{code}");
        gateway.says(0);
        link::live(&mut link).await;
        assert_eq!(link.stats().reconnects, 1, "{code}");
    }
}

fn trouble_of(code: u8) -> Option<LinkTrouble> {
    Some(LinkTrouble::Gateway {
        place: "127.0.0.1:6000".into(),
        exception: ModbusException::of(code),
    })
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_was_never_there_is_told_by_its_gateway() {
    for code in [4, 5, 6, 10, 11] {
        let gateway = gateway();
        gateway.says(code);
        let mut link = link::connect(PLACE, gateway.dial());
        let lost = link::until(&mut link, LOST_WITHIN, |status| status.trouble.is_some());
        assert_eq!(lost.await.trouble, trouble_of(code), "{code}");
        assert_eq!(link.stats().state_reads, 0);
    }
}

#[tokio::test(start_paused = true)]
async fn single_exceptions_between_answers_lose_nothing() {
    for (code, every) in [(6, 3), (11, 10), (4, 4)] {
        let gateway = gateway();
        let mut link = link::connect(PLACE, gateway.dial());
        link::live(&mut link).await;
        for _ in 0..40 {
            gateway.says_to(code, 1);
            let from = gateway.asked();
            while gateway.asked() < from + every {
                link::pass(&mut link, Duration::from_millis(5)).await;
            }
        }
        assert_eq!(gateway.dialled(), 1, "{code}");
        assert!(link.stats().refusals >= 40, "{:?}", link.stats());
        assert_eq!(link.status().state, LinkState::Monitoring);
    }
}

#[tokio::test(start_paused = true)]
async fn a_device_that_is_busy_at_the_start_is_known_as_well_as_any_other() {
    let known = {
        let mut link = link::connect(PLACE, gateway().dial());
        link::live(&mut link).await;
        link.status().quirks
    };
    assert_eq!(known.touch, Some(TouchVariant::Capacitive));
    for requests in 1..=24 {
        let gateway = gateway();
        gateway.says_to(6, requests);
        let mut link = link::connect(PLACE, gateway.dial());
        link::live(&mut link).await;
        assert_eq!(link.status().quirks, known, "{requests} refused");
        assert_eq!(gateway.dialled(), 1, "{requests} refused");
    }
}

/// States that a link reads in so long.
async fn states(link: &mut link::Client, length: Duration) -> u64 {
    let before = link.stats().state_reads;
    link::pass(link, length).await;
    link.stats().state_reads - before
}

#[tokio::test(start_paused = true)]
async fn replies_that_come_late_are_waited_for_and_the_delay_is_told() {
    for ms in [45, 60, 100, 150, 200, 300] {
        let gateway = gateway();
        gateway.delays(Duration::from_millis(ms));
        let mut link = link::connect(PLACE, gateway.dial());
        link::live(&mut link).await;
        let read = states(&mut link, Duration::from_secs(8)).await;
        // Fingertips and settings have their turns between.
        assert!(read * ms > 2000, "{ms} ms: {read} states");
        assert_eq!(gateway.dialled(), 1, "{ms} ms");
        let status = link.status();
        let slow_ms = status.slow_ms.map(u64::from);
        assert_eq!(slow_ms.is_some(), ms > 50, "{ms} ms: {slow_ms:?}");
        assert!(slow_ms.is_none_or(|slow| slow >= ms && slow < ms + 20));
        assert_eq!(status.quirks.touch, Some(TouchVariant::Capacitive), "{ms}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_delay_that_begins_later_costs_one_loss_at_most_and_one_that_ends_is_forgotten() {
    for ms in [60, 90, 150, 200, 300] {
        let gateway = gateway();
        let mut link = link::connect(PLACE, gateway.dial());
        link::live(&mut link).await;
        states(&mut link, Duration::from_secs(5)).await;
        gateway.delays(Duration::from_millis(ms));
        let read = states(&mut link, Duration::from_secs(8)).await;
        assert!(read * ms > 1500, "{ms} ms: {read} states");
        let at_most = if ms <= 200 { 1 } else { 2 };
        assert!(
            gateway.dialled() <= at_most,
            "{ms} ms: {}",
            gateway.dialled()
        );
        gateway.delays(Duration::ZERO);
        states(&mut link, Duration::from_secs(2)).await;
        assert_eq!(link.status().slow_ms, None, "{ms} ms");
        let read = states(&mut link, Duration::from_secs(1)).await;
        assert!(read > 90, "{read}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_falls_silent_on_a_slow_way_is_lost_within_a_second() {
    let gateway = gateway();
    gateway.delays(Duration::from_millis(300));
    let mut link = link::connect(PLACE, gateway.dial());
    link::live(&mut link).await;
    states(&mut link, Duration::from_secs(3)).await;
    gateway.delays(Duration::from_secs(60));
    let lost = |status: &LinkStatus| status.state == LinkState::Offline;
    let status = link::until(&mut link, LOST_WITHIN + Duration::from_millis(300), lost).await;
    assert!(matches!(status.trouble, Some(LinkTrouble::Silent { .. })));
}

#[tokio::test(start_paused = true)]
async fn a_hand_stays_armed_and_moves_on_a_slow_way() {
    for ms in [60, 100, 130, 150, 180, 200] {
        let hand = hand::plain();
        let gateway = Gateway::to(hand.clone());
        gateway.delays(Duration::from_millis(ms));
        let mut link = link::connect(PLACE, gateway.dial());
        link::live(&mut link).await;
        states(&mut link, Duration::from_secs(4)).await;
        for angle in [200, 900, 400] {
            link.arm(link::gentle());
            let armed = |status: &LinkStatus| status.armed.is_some();
            let epoch = link::until(&mut link, Duration::from_secs(4), armed).await;
            let mut wish = Setpoints::none(epoch.armed.unwrap());
            wish.angle[Dof::Index] = Some(Target::Go(Angle::nearest(angle)));
            wish.speed[Dof::Index] = Some(Speed::GENTLE);
            wish.force[Dof::Index] = Some(Force::GENTLE);
            for _ in 0..60 {
                link.set(&wish);
                link::pass(&mut link, Duration::from_millis(50)).await;
                let status = link.status();
                assert!(status.armed.is_some(), "{ms} ms: {:?}", status.disarmed);
            }
        }
        let told = hand.with(|hand, _| {
            let mut all = hand.journal().iter().rev();
            let index = all.find(|write| write.address == 1492);
            index.map(|write| i16::from_le_bytes([write.bytes[0], write.bytes[1]]))
        });
        assert_eq!(told, Some(400), "{ms} ms");
    }
}

#[tokio::test(start_paused = true)]
async fn a_motion_and_a_grip_end_where_they_should_on_a_slow_way() {
    for ms in [0, 60, 100, 150, 200] {
        let gateway = Gateway::to(hand::shared(SimConfig {
            scenario: Scenario::Free,
            ..SimConfig::default()
        }));
        gateway.delays(Duration::from_millis(ms));
        let config = link::config(PLACE, gateway.dial());
        let clock = config.clock;
        let mut link = link::open(config);
        link::live(&mut link).await;
        states(&mut link, Duration::from_secs(4)).await;
        let armed = |status: &LinkStatus| status.armed.is_some();
        link.arm(link::gentle());
        let epoch = link::until(&mut link, Duration::from_secs(4), armed).await;
        let armed = Armed {
            epoch: epoch.armed.unwrap(),
            lease: link.lease(),
            seen: HandSample::default(),
            clock,
        };
        for angle in [300, 800] {
            let start = MoveStart {
                targets: PerDof::from_fn(|dof| {
                    (dof == Dof::Index).then_some(Angle::nearest(angle))
                }),
                limits: ArmRequest {
                    speed: PerDof::splat(Speed::nearest(500)),
                    force: PerDof::splat(Force::GENTLE),
                },
                settles: true,
                grip: GripEstimator::default(),
            };
            let moved = move_to(&link, armed, start).await;
            assert_eq!(moved.end, Ok(MoveEnd::Reached), "{angle} at {ms} ms");
        }
        let start = GripStart {
            gap: Gap::new(30.0).unwrap(),
            speed: Speed::nearest(500),
            force: Force::GENTLE,
            grip: GripEstimator::default(),
        };
        let gripped = grip(&link, armed, start, pending()).await;
        assert_eq!(gripped.end, Ok(GripEnd::Reached), "{ms} ms");
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_does_not_wait_for_a_reply_that_is_late() {
    let hand = hand::plain();
    let gateway = Gateway::to(hand.clone());
    gateway.delays(Duration::from_millis(300));
    let mut link = link::connect(PLACE, gateway.dial());
    link::live(&mut link).await;
    for n in 0..20 {
        states(&mut link, Duration::from_millis(2000 + 37 * n)).await;
        let writes = || hand.with(|hand, _| hand.journal().len());
        let (before, pressed) = (writes(), Instant::now());
        link.stop();
        while writes() == before {
            sleep(Duration::from_millis(1)).await;
        }
        let waited = pressed.elapsed();
        assert!(waited <= Duration::from_millis(60), "{waited:?}");
        let held = |status: &LinkStatus| matches!(status.hold, Hold::Confirmed { .. });
        link::until(&mut link, Duration::from_secs(4), held).await;
    }
}

/// A hand with nothing in it behind a gateway whose replies take so long, and an armed link to it.
async fn armed_behind(ms: u64) -> (SharedHand, link::Client) {
    let hand = hand::shared(SimConfig {
        scenario: Scenario::Free,
        ..SimConfig::default()
    });
    let gateway = Gateway::to(hand.clone());
    gateway.delays(Duration::from_millis(ms));
    let mut link = link::connect(PLACE, gateway.dial());
    link::live(&mut link).await;
    states(&mut link, Duration::from_secs(4)).await;
    link.arm(link::gentle());
    let armed = |status: &LinkStatus| status.armed.is_some();
    link::until(&mut link, Duration::from_secs(4), armed).await;
    (hand, link)
}

fn bend(link: &link::Client, to: i16, speed: Speed) {
    let mut wish = Setpoints::none(link.status().armed.unwrap());
    wish.angle[Dof::Index] = Some(Target::Go(Angle::nearest(to)));
    wish.speed[Dof::Index] = Some(speed);
    link.set(&wish);
}

/// Also where a reply takes as long as two frames of a hold are apart, so that frames alone would fill the way. A joint at full
/// speed goes on for the hand's dead time, and a reading is up to two replies old; it is not sent back farther than that. Slower
/// ways do not show half of its way in time.
#[tokio::test(start_paused = true)]
async fn a_stop_is_confirmed_however_long_replies_take_and_sends_no_joint_far_back() {
    for ms in [
        0, 10, 20, 30, 34, 36, 38, 40, 42, 44, 46, 50, 60, 80, 100, 150, 200,
    ] {
        for later in [0, 15, 35, 55] {
            let (hand, mut link) = armed_behind(ms).await;
            let index = || hand::true_angle(&hand, Dof::Index);
            bend(&link, 0, Speed::MAX);
            while index() > 500.0 {
                link::pass(&mut link, Duration::from_millis(2)).await;
            }
            link::pass(&mut link, Duration::from_millis(later)).await;
            link.stop();
            let mut least = index();
            for _ in 0..300 {
                link::pass(&mut link, Duration::from_millis(10)).await;
                least = least.min(index());
            }
            let (hold, back) = (link.status().hold, index() - least);
            assert!(
                matches!(hold, Hold::Confirmed { .. }),
                "{ms} ms, {later} later: {hold:?}"
            );
            assert!(
                ms > 100 || back <= 140.0 + 2.1 * f64::from(u32::try_from(ms).unwrap()),
                "{ms} ms, {later} later: {back} back from {least}"
            );
        }
    }
}

#[tokio::test(start_paused = true)]
async fn another_controller_is_noticed_on_a_slow_way_too() {
    for (ms, within) in [(0, 500), (30, 500), (60, 800), (100, 1200), (150, 1600)] {
        for after in [300, 500, 900] {
            let (hand, mut link) = armed_behind(ms).await;
            link.read_at(RATES);
            bend(&link, 0, Speed::nearest(50));
            link::pass(&mut link, Duration::from_millis(ms * 3 + after)).await;
            let foreign = 500_i16.to_le_bytes().repeat(6);
            hand.with(|hand, now| hand.write(1486, &foreign, now).map(drop))
                .unwrap();
            let mut waited = 0;
            while link.status().armed.is_some() {
                link::pass(&mut link, Duration::from_millis(10)).await;
                waited += 10;
                let status = link.status();
                assert!(waited <= within, "{ms} ms, {after} after: {status:?}");
            }
            let disarmed = link.status().disarmed;
            assert_eq!(disarmed, Some(Disarmed::OtherController), "{ms} ms");
        }
    }
}
