//! Several simulated hands on one wire, in memory: what one is told the others do not do, and what the others say
//! does not upset a link. Virtual time.

use crate::setup::hand::{free, numbered};
use crate::setup::link::{self, Client};
use handscope::codec::rs485::{encode_read, encode_write};
use handscope::hand::register::{ANGLE_ACT, STATE};
use handscope::hand::{Angle, HandCommand, HandId, PerDof, Target};
use handscope::record::{LinkState, Record};
use handscope::sim::serve::rs485;
use handscope::sim::{SharedHand, SimConfig, SimHands};
use handscope::transport::pair;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Instant, interval, sleep, timeout};

fn hand(id: u8, epoch: Instant) -> SharedHand {
    let seed = u64::from(id);
    let config = SimConfig {
        seed,
        ..numbered(id)
    };
    SharedHand::new(free(config), epoch)
}

/// Carries whole frames both ways, and puts a question to hand 2 in now and then.
async fn between(
    mut near: impl handscope::transport::Wire,
    mut bus: impl handscope::transport::Wire,
) {
    let question = encode_read(HandId::nearest(2u8), STATE).unwrap();
    let mut other = interval(Duration::from_millis(7));
    let (mut asked, mut answered) = ([0; 512], [0; 512]);
    loop {
        tokio::select! {
            Ok(len @ 1..) = near.read(&mut asked) => bus.write_all(&asked[..len]).await.unwrap(),
            Ok(len @ 1..) = bus.read(&mut answered) => {
                if near.write_all(&answered[..len]).await.is_err() { return; }
            }
            _ = other.tick() => bus.write_all(&question).await.unwrap(),
            else => return,
        }
    }
}

/// A link to one of two hands on a bus, on which another program asks the second one between our questions.
fn open(hands: SimHands, id: u8) -> Client {
    let dial = link::behind(move |_, middle| {
        let (bus, its) = pair();
        tokio::spawn(rs485::serve(hands.clone(), its));
        tokio::spawn(between(middle, bus));
    });
    link::connect(&format!("rs485:bus?id={id}"), dial)
}

/// Bends all fingers of one hand half way, over the bus.
async fn bend(hands: &SimHands, id: u8) {
    let (mut wire, its) = pair();
    tokio::spawn(rs485::serve(hands.clone(), its));
    let command = HandCommand::Angles(PerDof::splat(Some(Target::Go(Angle::nearest(400)))));
    for write in &command.writes() {
        let frame = encode_write(HandId::nearest(id), write);
        wire.write_all(&frame).await.unwrap();
    }
    sleep(Duration::from_secs(3)).await;
}

fn angles(hand: &SharedHand) -> Vec<i16> {
    let bytes = hand.with(|hand, now| hand.read(ANGLE_ACT.span(), now).unwrap());
    let (pairs, _) = bytes.as_chunks::<2>();
    pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect()
}

#[tokio::test(start_paused = true)]
async fn what_one_hand_is_told_the_others_do_not_do() {
    let begun = Instant::now();
    let (one, two) = (hand(1, begun), hand(2, begun));
    let hands = SimHands::new(one.clone(), vec![two.clone()]);
    bend(&hands, 2).await;
    assert!(angles(&one).iter().all(|angle| *angle > 990));
    assert!(angles(&two).iter().all(|angle| (390..=410).contains(angle)));
    assert_eq!(one.with(|hand, _| hand.journal().len()), 0);
    assert_eq!(two.with(|hand, _| hand.journal().len()), 1);
}

#[tokio::test(start_paused = true)]
async fn replies_of_another_hand_are_counted_and_never_taken() {
    let begun = Instant::now();
    let hands = SimHands::new(hand(1, begun), vec![hand(2, begun)]);
    bend(&hands, 2).await;
    for (id, wanted) in [(1, 990..=1010), (2, 390..=410), (1, 990..=1010)] {
        let mut link = open(hands.clone(), id);
        let end = Instant::now() + Duration::from_secs(5);
        let mut seen = 0;
        while let Ok(Some(event)) = timeout(end - Instant::now(), link.records.next()).await {
            let Record::Reading { sample, .. } = event else {
                continue;
            };
            for (_, angle) in sample.angle.iter().flat_map(|angle| angle.value.iter()) {
                assert!(wanted.contains(&angle.raw()), "id {id}: {angle:?}");
                seen += 1;
            }
        }
        assert!(seen > 500, "id {id}: {seen}");
        assert_eq!(link.status().state, LinkState::Monitoring, "id {id}");
        let stats = link.stats();
        assert_eq!((stats.reconnects, stats.writes), (0, 0), "id {id}");
        if id == 1 {
            assert!(stats.foreign_replies > 100, "{stats:?}");
        }
        assert!(link.read(STATE).await.is_ok());
    }
}
