//! Feedback that freezes while the hand moves: valid frames, old values. Judged by where the hand's joints really are.

use crate::setup::hand;
use crate::setup::link::{self, Client, pass};
use handscope::hand::{Angle, Dof, PerDof, Setpoints, Target};
use handscope::link::LinkStatus;
use handscope::record::{Disarmed, Hold, LinkState, Rest};
use handscope::sim::{Scenario, SharedHand, SimConfig};
use tokio::time::Duration;

const SOON: Duration = Duration::from_secs(3);
const WIRES: [&str; 4] = ["rs485:test", "rtu:test", "tcp:127.0.0.1:6000", "can:test"];

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

async fn closing(hand: &SharedHand, wire: &str) -> Client {
    let mut link = link::connect(wire, link::to_hand(hand.clone()));
    link::live(&mut link).await;
    pass(&mut link, ms(200)).await;
    link.arm(link::gentle());
    let armed = |status: &LinkStatus| status.armed.is_some();
    let status = link::until(&mut link, SOON, armed).await;
    let mut setpoints = Setpoints::none(status.armed.unwrap());
    setpoints.angle = PerDof::splat(Some(Target::Go(Angle::MIN)));
    link.set(&setpoints);
    link
}

fn freeze(hand: &SharedHand, frozen: bool) {
    hand.with(|hand, now| hand.freeze_feedback(frozen, now));
}

fn index(hand: &SharedHand) -> f64 {
    hand.with(|hand, now| {
        hand.advance_to(now);
        hand.true_angles()[Dof::Index]
    })
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
        let mut link = closing(&hand, wire).await;
        pass(&mut link, ms(250)).await;
        freeze(&hand, true);
        let shown = index(&hand);
        let doubted = |status: &LinkStatus| status.feedback_in_doubt;
        let status = link::until(&mut link, ms(800), doubted).await;
        assert_eq!(status.disarmed, Some(Disarmed::FrozenFeedback), "{wire}");
        assert_eq!(status.armed, None, "{wire}");
        assert!(
            matches!(status.hold, Hold::Alarm { .. }),
            "{wire}: {status:?}"
        );
        let was = index(&hand);
        assert!(
            shown - was > 100.0,
            "{wire}: it went on unseen, {shown} {was}"
        );
        assert!(!confirmed(&mut link, SOON).await, "{wire}");
        assert_ne!(link.status().rest, Rest::Resting, "{wire}");
        assert_eq!(link.status().state, LinkState::Holding, "{wire}");
        let rests = index(&hand);
        // From the last look to the moment of doubt the joint went about 200 counts, by a speed that is known to a tenth.
        assert!((was - rests).abs() < 60.0, "{wire}: {was} {rests}");
        freeze(&hand, false);
        assert!(confirmed(&mut link, SOON).await, "{wire}: it lives again");
        assert!(!link.status().feedback_in_doubt, "{wire}");
        assert!((rests - index(&hand)).abs() < 5.0, "{wire}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_while_feedback_is_frozen_holds_where_the_joints_must_be_and_is_never_confirmed() {
    for wire in WIRES {
        for after in [60, 150, 300] {
            let hand = hand::begin(hand::free(SimConfig::default()));
            let mut link = closing(&hand, wire).await;
            pass(&mut link, ms(300)).await;
            freeze(&hand, true);
            pass(&mut link, ms(after)).await;
            let was = index(&hand);
            link.stop();
            assert!(!confirmed(&mut link, SOON).await, "{wire} {after}");
            let status = link.status();
            assert!(status.feedback_in_doubt, "{wire} {after}: {status:?}");
            let rests = index(&hand);
            assert!((was - rests).abs() < 60.0, "{wire} {after}: {was} {rests}");
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
    let mut link = closing(&hand, "rs485:test").await;
    let disarmed = |status: &LinkStatus| status.disarmed.is_some();
    let status = link::until(&mut link, SOON, disarmed).await;
    assert_eq!(status.disarmed, Some(Disarmed::FrozenFeedback));
    assert!(index(&hand) > 300.0, "it was stopped on its way");
}
