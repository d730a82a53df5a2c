//! A slider dragged as fast as a program can, on a clean paced line.

use crate::link::faults::dial::FaultyDial;
use crate::link::faults::tap::{Lie, Log};
use crate::setup::body::{Protocol, Quirks};
use crate::setup::faulty::{FaultPlan, LineSpeed};
use crate::setup::hand;
use crate::setup::link::{self, Client};
use handscope::hand::Setpoints;
use handscope::hand::{Angle, Dof, Target};
use handscope::link::{Clock, LinkConfig};
use handscope::record::{LinkState, Record};
use std::sync::{Arc, Mutex};
use tokio::time::{Duration, Instant, sleep_until};

/// Opens a clean paced wire to a hand that rests, and waits until it is armed.
async fn armed_on(baud: u32, turnaround: Duration) -> (Client, Log, Clock) {
    let clock = Clock::start();
    let hand = hand::plain();
    let log = Log::new(clock, Lie::None);
    let plan = FaultPlan {
        pace: Some(LineSpeed { baud }),
        ..FaultPlan::quiet(1)
    };
    let dial = Arc::new(FaultyDial {
        hand,
        log: log.clone(),
        plan,
        quirks: Quirks {
            turnaround,
            ..Quirks::default()
        },
        protocol: Protocol::Rs485,
        state: Mutex::default(),
    });
    let endpoint = format!("rs485:test?baud={baud}");
    let mut link = link::open(LinkConfig {
        clock,
        ..link::config(&endpoint, dial)
    });
    loop {
        match link.records.next().await.unwrap() {
            Record::Reading { .. } if link.status().state == LinkState::Monitoring => {
                link.arm(link::gentle());
            }
            Record::State {
                state: LinkState::Armed,
                ..
            } => return (link, log, clock),
            _ => {}
        }
    }
}

/// Ten thousand slider events in a second, as fast as a program can make them.
async fn drag(link: &mut Client) -> i16 {
    let epoch = link.status().armed.unwrap();
    let end = Instant::now() + Duration::from_secs(1);
    let mut last = 0;
    for step in 0..10_000u32 {
        sleep_until(end - Duration::from_micros(100) * (10_000 - step)).await;
        last = i16::try_from(400 + step % 500).unwrap();
        let mut wish = Setpoints::none(epoch);
        wish.angle[Dof::Index] = Some(Target::Go(Angle::nearest(last)));
        link.set(&wish);
        while link.records.try_next().is_some() {}
    }
    last
}

#[tokio::test(start_paused = true)]
async fn ten_thousand_slider_events_are_few_writes_and_the_last_is_sent() {
    let (mut link, log, _) = armed_on(115_200, Duration::from_millis(3)).await;
    let before = log.sent().len();
    let last = drag(&mut link).await;
    tokio::time::sleep(Duration::from_millis(200)).await;
    let sent = log.sent().split_off(before);
    let writes: Vec<_> = sent
        .iter()
        .filter_map(|frame| frame.written.as_ref())
        .collect();
    assert!((20..=51).contains(&writes.len()), "{}", writes.len());
    assert_eq!(writes.last().unwrap()[..], last.to_le_bytes());
}

#[tokio::test(start_paused = true)]
async fn a_drag_on_the_slowest_line_leaves_the_pose_fresh_and_the_hand_armed() {
    let (mut link, log, _) = armed_on(19_200, Duration::from_millis(15)).await;
    let before = log.sent().len();
    drag(&mut link).await;
    assert_eq!(link.status().state, LinkState::Armed);
    let sent = log.sent().split_off(before);
    let reads = sent.iter().filter(|frame| frame.written.is_none()).count();
    let writes = sent.len() - reads;
    assert!(
        reads >= writes.saturating_sub(1) && writes > 3,
        "{reads} reads, {writes} writes"
    );
}
