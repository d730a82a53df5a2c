//! Feedback that freezes while the hand moves: valid frames, old values. Judged by where the hand's joints really are.

use crate::setup::hand;
use crate::setup::link::{self, Client, pass};
use handscope::hand::{Angle, Dof, PerDof, Setpoints, Speed, Target};
use handscope::link::LinkStatus;
use handscope::record::{Disarmed, Hold, LinkState, Rest};
use handscope::sim::{Scenario, SharedHand, SimConfig};
use tokio::time::Duration;

const SOON: Duration = Duration::from_secs(3);
const WIRES: [&str; 4] = ["rs485:test", "rtu:test", "tcp:127.0.0.1:6000", "can:test"];

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn freeze(hand: &SharedHand, frozen: bool) {
    hand.with(|hand, now| hand.freeze_feedback(frozen, now));
}

/// Freezes the angles of these joints, while all else that the hand reports lives on.
fn freeze_angles(hand: &SharedHand, joints: &[Dof]) {
    let frozen = PerDof::from_fn(|dof| joints.contains(&dof));
    hand.with(|hand, now| hand.freeze_angles(frozen, now));
}

/// Waits, and says whether a stop was ever told to be confirmed.
async fn confirmed(link: &mut Client, length: Duration) -> bool {
    let mut seen = false;
    for _ in 0..length.as_millis() / 10 {
        pass(link, ms(10)).await;
        seen |= matches!(link.status().hold, Hold::Confirmed { .. });
    }
    seen
}

#[tokio::test(start_paused = true)]
async fn frozen_feedback_disarms_raises_the_alarm_and_holds_where_the_joints_must_be() {
    for wire in WIRES {
        let hand = hand::begin(hand::free(SimConfig::default()));
        let mut link = link::closing(&hand, wire).await;
        pass(&mut link, ms(250)).await;
        freeze(&hand, true);
        let shown = hand::true_angle(&hand, Dof::Index);
        let doubted = |status: &LinkStatus| status.feedback_in_doubt;
        let status = link::until(&mut link, ms(800), doubted).await;
        assert_eq!(status.disarmed, Some(Disarmed::FrozenFeedback), "{wire}");
        assert_eq!(status.armed, None, "{wire}");
        assert!(
            matches!(status.hold, Hold::Alarm { .. }),
            "{wire}: {status:?}"
        );
        let was = hand::true_angle(&hand, Dof::Index);
        assert!(
            shown - was > 100.0,
            "{wire}: it went on unseen, {shown} {was}"
        );
        assert!(!confirmed(&mut link, SOON).await, "{wire}");
        assert_ne!(link.status().rest, Rest::Resting, "{wire}");
        assert_eq!(link.status().state, LinkState::Holding, "{wire}");
        let rests = hand::true_angle(&hand, Dof::Index);
        // From the last look to the moment of doubt the joint went about 200 counts, by a speed that is known to a tenth.
        assert!((was - rests).abs() < 60.0, "{wire}: {was} {rests}");
        freeze(&hand, false);
        assert!(confirmed(&mut link, SOON).await, "{wire}: it lives again");
        assert!(!link.status().feedback_in_doubt, "{wire}");
        assert!(
            (rests - hand::true_angle(&hand, Dof::Index)).abs() < 5.0,
            "{wire}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_while_feedback_is_frozen_holds_where_the_joints_must_be_and_is_never_confirmed() {
    for wire in WIRES {
        for after in [60, 150, 300] {
            let hand = hand::begin(hand::free(SimConfig::default()));
            let mut link = link::closing(&hand, wire).await;
            pass(&mut link, ms(300)).await;
            freeze(&hand, true);
            pass(&mut link, ms(after)).await;
            let was = hand::true_angle(&hand, Dof::Index);
            link.stop();
            assert!(!confirmed(&mut link, SOON).await, "{wire} {after}");
            let status = link.status();
            assert!(status.feedback_in_doubt, "{wire} {after}: {status:?}");
            let rests = hand::true_angle(&hand, Dof::Index);
            assert!((was - rests).abs() < 60.0, "{wire} {after}: {was} {rests}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_moves_no_joint_back_whose_angle_alone_is_frozen_and_is_never_confirmed() {
    let joints: [&[Dof]; 3] = [&Dof::ALL, &[Dof::Index], &[Dof::Index, Dof::ThumbBend]];
    for (wire, joints) in WIRES
        .into_iter()
        .flat_map(|wire| joints.map(|all| (wire, all)))
    {
        for after in [150, 300, 450] {
            let hand = hand::begin(hand::free(SimConfig::default()));
            let mut link = link::closing(&hand, wire).await;
            pass(&mut link, ms(300)).await;
            freeze_angles(&hand, joints);
            pass(&mut link, ms(after)).await;
            let was = hand::true_angle(&hand, Dof::Index);
            link.stop();
            assert!(
                !confirmed(&mut link, SOON).await,
                "{wire} {joints:?} {after}"
            );
            let status = link.status();
            assert!(
                status.feedback_in_doubt,
                "{wire} {joints:?} {after}: {status:?}"
            );
            assert_ne!(status.rest, Rest::Resting, "{wire} {joints:?} {after}");
            let rests = hand::true_angle(&hand, Dof::Index);
            assert!(
                (was - rests).abs() < 60.0,
                "{wire} {joints:?} {after}: {was} {rests}"
            );
        }
    }
}

#[tokio::test(start_paused = true)]
async fn one_frozen_angle_disarms_whatever_else_in_the_hand_changes() {
    for wire in WIRES {
        let hand = hand::begin(hand::free(SimConfig::default()));
        let mut link = link::closing(&hand, wire).await;
        pass(&mut link, ms(300)).await;
        freeze_angles(&hand, &[Dof::Index]);
        let disarmed = |status: &LinkStatus| status.disarmed.is_some();
        let status = link::until(&mut link, ms(800), disarmed).await;
        assert_eq!(status.disarmed, Some(Disarmed::FrozenFeedback), "{wire}");
        let was = hand::true_angle(&hand, Dof::Index);
        assert!(!confirmed(&mut link, SOON).await, "{wire}");
        let rests = hand::true_angle(&hand, Dof::Index);
        assert!((was - rests).abs() < 60.0, "{wire}: {was} {rests}");
        freeze_angles(&hand, &[]);
        assert!(confirmed(&mut link, SOON).await, "{wire}: it lives again");
        assert!(
            (rests - hand::true_angle(&hand, Dof::Index)).abs() < 5.0,
            "{wire}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_in_motion_is_confirmed_at_every_speed_and_dead_time() {
    for (speed, latency_ms) in [25, 200, 1000]
        .into_iter()
        .flat_map(|speed| [10.0, 64.0, 140.0].map(|ms| (speed, ms)))
    {
        let mut config = SimConfig::default();
        for (_, joint) in config.body.joints.iter_mut() {
            joint.latency_ms = latency_ms;
        }
        let hand = hand::begin(hand::free(config));
        let mut link = link::connect("tcp:127.0.0.1:6000", link::to_hand(hand.clone()));
        link::live(&mut link).await;
        pass(&mut link, ms(200)).await;
        let mut request = link::gentle();
        request.speed = PerDof::splat(Speed::nearest(speed));
        link.arm(request);
        let armed = |status: &LinkStatus| status.armed.is_some();
        let status = link::until(&mut link, SOON, armed).await;
        let mut setpoints = Setpoints::none(status.armed.unwrap());
        setpoints.angle = PerDof::splat(Some(Target::Go(Angle::MIN)));
        link.set(&setpoints);
        pass(&mut link, ms(400)).await;
        link.stop();
        let mut doubted = false;
        let mut confirmed = false;
        for _ in 0..60 {
            pass(&mut link, ms(10)).await;
            doubted |= link.status().feedback_in_doubt;
            confirmed |= matches!(link.status().hold, Hold::Confirmed { .. });
        }
        assert!(
            confirmed && !doubted,
            "{speed} {latency_ms}: {:?}",
            link.status()
        );
    }
}

#[tokio::test(start_paused = true)]
async fn a_deaf_hand_that_wakes_during_the_alarm_does_not_move() {
    for wire in WIRES {
        let hand = hand::begin(hand::free(SimConfig::default()));
        let deaf = |deaf| hand.with(|hand, _| Dof::ALL.map(|dof| hand.set_dead(dof, deaf)));
        deaf(true);
        let mut link = link::closing(&hand, wire).await;
        pass(&mut link, ms(700)).await;
        let was = hand::true_angle(&hand, Dof::Index);
        link.stop();
        assert!(!confirmed(&mut link, ms(1500)).await, "{wire}");
        assert!(matches!(link.status().hold, Hold::Alarm { .. }), "{wire}");
        deaf(false);
        for _ in 0..2 {
            assert!(!confirmed(&mut link, SOON).await, "{wire}");
            let rests = hand::true_angle(&hand, Dof::Index);
            assert!((was - rests).abs() < 5.0, "{wire}: {was} {rests}");
            // Pressed again, as the alarm lasts.
            link.stop();
        }
    }
}

#[tokio::test(start_paused = true)]
async fn the_scenario_freezes_what_the_hand_tells_and_the_link_notices() {
    let frozen = SimConfig {
        scenario: Scenario::Frozen,
        ..SimConfig::default()
    };
    let hand = hand::shared(frozen);
    let mut link = link::closing(&hand, "rs485:test").await;
    let disarmed = |status: &LinkStatus| status.disarmed.is_some();
    let status = link::until(&mut link, SOON, disarmed).await;
    assert_eq!(status.disarmed, Some(Disarmed::FrozenFeedback));
    assert!(
        hand::true_angle(&hand, Dof::Index) > 300.0,
        "it was stopped on its way"
    );
}
