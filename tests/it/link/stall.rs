//! Stalls of this program's own thread, told apart from a hand that is silent. The clock jumps while nothing runs.

use crate::setup::hand;
use crate::setup::link::{self, pass};
use handscope::link::{LinkHandle, LinkStatus, LinkTrouble};
use tokio::task::yield_now;
use tokio::time::{Duration, advance};

const WIRES: [&str; 4] = ["rs485:test", "rtu:test", "tcp:127.0.0.1:6000", "can:test"];
const SOON: Duration = Duration::from_secs(3);

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

#[tokio::test(start_paused = true)]
async fn a_stall_of_our_own_is_counted_and_neither_loses_the_link_nor_disarms() {
    for wire in WIRES {
        let mut link = link::connect(wire, link::to_hand(hand::plain()));
        link::live(&mut link).await;
        pass(&mut link, ms(300)).await;
        assert_eq!(link.stats().stalls, 0, "{wire}");
        link.arm(link::gentle());
        let armed = |status: &LinkStatus| status.armed.is_some();
        link::until(&mut link, SOON, armed).await;
        let reconnects = link.stats().reconnects;
        for length in [100, 400, 900] {
            advance(ms(length)).await;
            pass(&mut link, ms(300)).await;
            let status = link.status();
            assert!(status.armed.is_some(), "{wire} {length}: {status:?}");
            let stats = link.stats();
            let longest = ms(length - 30)..=ms(length + 5);
            assert!(longest.contains(&stats.longest_stall), "{wire}: {stats:?}");
            assert!(status.stall.is_some(), "{wire}: {status:?}");
        }
        let stats = link.stats();
        assert!((3..=6).contains(&stats.stalls), "{wire}: {stats:?}");
        assert_eq!(stats.reconnects, reconnects, "{wire}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_is_silent_when_we_stall_is_lost_with_both_named() {
    for wire in WIRES {
        let hand = hand::plain();
        let mut link = link::connect(wire, link::to_hand(hand.clone()));
        link::live(&mut link).await;
        pass(&mut link, ms(300)).await;
        hand.with(|hand, _| hand.put_silent(true));
        pass(&mut link, ms(70)).await;
        advance(ms(200)).await;
        let lost = |status: &LinkStatus| !status.state.is_live();
        let status = link::until(&mut link, SOON, lost).await;
        let Some(LinkTrouble::Stalled { stalled_ms, .. }) = status.trouble else {
            panic!("{wire}: {status:?}")
        };
        assert!((150..=205).contains(&stalled_ms), "{wire}: {stalled_ms}");
    }
}

#[tokio::test(start_paused = true)]
async fn an_arming_waits_for_what_is_not_read_yet_and_a_stop_or_disarm_ends_the_wait() {
    let armed = |status: &LinkStatus| status.armed.is_some();
    let disarm: fn(&LinkHandle) = LinkHandle::disarm;
    for wire in WIRES {
        let mut link = link::connect(wire, link::to_hand(hand::plain()));
        // Nothing was read of it but what it is.
        link::live(&mut link).await;
        link.arm(link::gentle());
        link::until(&mut link, SOON, armed).await;
        for end in [None, Some(disarm), Some(|link| drop(link.stop()))] {
            link.disarm();
            pass(&mut link, ms(300)).await;
            // The pose grows old in the stall.
            advance(ms(300)).await;
            link.arm(link::gentle());
            yield_now().await;
            if let Some(end) = end {
                end(&link);
            }
            pass(&mut link, ms(600)).await;
            let status = link.status();
            assert_eq!(status.armed.is_some(), end.is_none(), "{wire}: {status:?}");
        }
    }
}
