//! What ends an arming over a live link stops the hand, whoever moved it. Judged by where its joints really are.

use crate::setup::hand;
use crate::setup::link::{self, pass};
use handscope::hand::{Dof, Fault};
use handscope::link::LinkStatus;
use handscope::record::{Disarmed, Hold, LinkState};
use tokio::time::Duration;

const SOON: Duration = Duration::from_secs(3);

#[tokio::test(start_paused = true)]
async fn a_fault_of_one_drive_stops_all_joints_and_stays_told() {
    for wire in ["rs485:test", "rtu:test", "tcp:127.0.0.1:6000", "can:test"] {
        let hand = hand::plain();
        let mut link = link::closing(&hand, wire).await;
        pass(&mut link, Duration::from_millis(300)).await;
        hand.with(|hand, _| hand.inject_fault(Dof::Ring, Fault::OverCurrent));
        let faulty = |status: &LinkStatus| status.state == LinkState::Fault;
        let status = link::until(&mut link, SOON, faulty).await;
        assert_eq!(
            (status.armed, status.disarmed),
            (None, Some(Disarmed::Fault)),
            "{wire}"
        );
        assert!(
            matches!(status.hold, Hold::Confirmed { .. }),
            "{wire}: {status:?}"
        );
        let rests = hand::true_angle(&hand, Dof::Index);
        pass(&mut link, Duration::from_secs(2)).await;
        let now = hand::true_angle(&hand, Dof::Index);
        assert!(
            rests > 300.0 && (now - rests).abs() < 2.0,
            "{wire}: {rests}, {now}"
        );
    }
}
