//! An open link reads faster when it is told to, and slower again, without writing anything; also after a loss. All in
//! virtual time.

use crate::setup::hand;
use crate::setup::link::{self, Client};
use handscope::hand::{Finger, Group};
use handscope::link::PollRates;
use handscope::motion::series::RATES;
use handscope::record::{LinkState, Record};
use handscope::sim::SharedHand;
use std::sync::{Arc, Mutex};
use tokio::task::JoinHandle;
use tokio::time::{Duration, Instant, sleep};

/// A hand on an endless row of wires.
struct Hand {
    hand: SharedHand,
    wire: Mutex<Option<JoinHandle<()>>>,
}

impl Hand {
    fn new() -> Arc<Self> {
        let hand = hand::plain();
        let wire = Mutex::default();
        Arc::new(Self { hand, wire })
    }

    fn hang_up(&self) {
        self.wire.lock().unwrap().take().unwrap().abort();
    }
}

fn open(hand: &Arc<Hand>) -> Client {
    let hand = Arc::clone(hand);
    let dial = link::behind(move |endpoint, far| {
        let wire = hand::serve(hand.hand.clone(), endpoint, far);
        *hand.wire.lock().unwrap() = Some(wire);
    });
    link::connect("rs485:/dev/ttyT0", dial)
}

async fn live(link: &mut Client) {
    link::live(link).await;
    sleep(Duration::from_millis(50)).await;
}

/// Readings of angles and of the thumb's fingertip in a second.
async fn in_a_second(link: &mut Client) -> (u32, u32) {
    while link.records.try_next().is_some() {}
    let end = Instant::now() + Duration::from_secs(1);
    let mut counts = (0, 0);
    while Instant::now() < end {
        while let Some(event) = link.records.try_next() {
            let Record::Reading { fresh, .. } = event else {
                continue;
            };
            counts.0 += u32::from(fresh.contains(Group::Angle));
            counts.1 += u32::from(fresh.contains(Group::Tactile(Finger::Thumb)));
        }
        sleep(Duration::from_millis(5)).await;
    }
    counts
}

fn check((angles, tips): (u32, u32), rates: PollRates) {
    let near = |count: u32, hz: f64| (f64::from(count) - hz).abs() <= (hz * 0.03).max(1.0);
    assert!(near(angles, rates.state_hz), "{angles} of {rates:?}");
    assert!(near(tips, rates.tactile_hz), "{tips} of {rates:?}");
}

#[tokio::test(start_paused = true)]
async fn an_open_link_reads_at_the_rates_it_was_told_last_and_writes_nothing() {
    let hand = Hand::new();
    let mut link = open(&hand);
    live(&mut link).await;
    check(in_a_second(&mut link).await, PollRates::default());
    link.read_at(RATES);
    sleep(Duration::from_millis(50)).await;
    check(in_a_second(&mut link).await, RATES);
    link.read_at(PollRates::default());
    sleep(Duration::from_millis(50)).await;
    check(in_a_second(&mut link).await, PollRates::default());
    let writes = hand.hand.with(|hand, _| hand.journal().len());
    assert_eq!(writes, 0);
}

#[tokio::test(start_paused = true)]
async fn the_rates_outlast_a_lost_wire_and_may_change_while_it_is_lost() {
    let hand = Hand::new();
    let mut link = open(&hand);
    live(&mut link).await;
    link.read_at(RATES);
    sleep(Duration::from_millis(50)).await;
    hand.hang_up();
    sleep(Duration::from_millis(50)).await;
    live(&mut link).await;
    check(in_a_second(&mut link).await, RATES);
    hand.hang_up();
    sleep(Duration::from_millis(50)).await;
    assert_ne!(link.status().state, LinkState::Monitoring);
    link.read_at(PollRates::default());
    live(&mut link).await;
    check(in_a_second(&mut link).await, PollRates::default());
}
