//! Getting to know a hand: bounded in time on the slowest line, and no match for a stop.

use crate::setup::hand;
use crate::setup::link::{self, Client};
use handscope::codec::rs485::{RequestDecoder, Rs485Request, encode_read_reply, encode_write_ack};
use handscope::hand::Span;
use handscope::hand::register::ANGLE_ACT;
use handscope::link::Quirks;
use handscope::record::{Hold, LinkState};
use handscope::sim::SimConfig;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream};
use tokio::time::{Instant, sleep, timeout};

/// All questions but the first.
const WITHIN: Duration = Duration::from_millis(500);

/// A hand that answers for its id, takes writes, and is silent on everything else.
#[derive(Clone, Default)]
struct Shy {
    asked: Arc<Mutex<Vec<(Instant, Rs485Request)>>>,
}

impl Shy {
    async fn serve(self, mut wire: DuplexStream) {
        let mut decoder = RequestDecoder::default();
        let mut chunk = [0; 512];
        while let Ok(len @ 1..) = wire.read(&mut chunk).await {
            decoder.push(&chunk[..len]);
            while let Some(request) = decoder.next() {
                let now = Instant::now();
                let reply = match &request {
                    Rs485Request::Read { id, span } if span.address == 1000 => {
                        encode_read_reply(*id, 1000, &vec![*id; usize::from(span.len)])
                    }
                    Rs485Request::Read { .. } => None,
                    Rs485Request::Write { id, address, .. } => {
                        Some(encode_write_ack(*id, *address, 1))
                    }
                };
                self.asked.lock().unwrap().push((now, request));
                if let Some(reply) = reply {
                    wire.write_all(&reply).await.unwrap();
                }
            }
        }
    }

    fn asked(&self) -> Vec<(Instant, Rs485Request)> {
        self.asked.lock().unwrap().clone()
    }
}

fn open(hand: &Shy) -> Client {
    let hand = hand.clone();
    let dial = link::behind(move |_, far| drop(tokio::spawn(hand.clone().serve(far))));
    link::connect("rs485:test?baud=19200", dial)
}

async fn live(link: &Client) {
    let look = async {
        while !link.status().state.is_live() {
            sleep(Duration::from_micros(200)).await;
        }
    };
    timeout(Duration::from_secs(5), look).await.unwrap();
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_answers_nothing_but_its_id_is_live_within_half_a_second_and_unwritten() {
    let hand = Shy::default();
    let link = open(&hand);
    let begun = Instant::now();
    live(&link).await;
    assert!(begun.elapsed() < WITHIN, "{:?}", begun.elapsed());
    let known = Quirks {
        hand_id: Some(1),
        ..Quirks::default()
    };
    assert_eq!(
        link.status().quirks,
        known,
        "silence is not taken for an answer"
    );
    let asked = hand.asked();
    assert!(asked.len() > 4, "{asked:?}");
    let mut spans: Vec<Span> = Vec::new();
    for (_, request) in asked {
        let Rs485Request::Read { span, .. } = request else {
            panic!("{request:?} writes");
        };
        assert!(
            !spans.contains(&span),
            "{span:?} was given up and asked again"
        );
        spans.push(span);
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_ends_the_questions_and_asks_only_where_the_joints_are_before_it() {
    let hand = Shy::default();
    let link = open(&hand);
    while hand.asked().len() < 3 {
        sleep(Duration::from_millis(1)).await;
    }
    assert_eq!(link.status().state, LinkState::Identifying);
    let (before, pressed) = (hand.asked().len(), Instant::now());
    link.stop();
    while hand.asked().len() < before + 2 {
        sleep(Duration::from_millis(1)).await;
    }
    let (_, first) = hand.asked()[before].clone();
    assert!(
        matches!(&first, Rs485Request::Read { span, .. } if span.covers(ANGLE_ACT.span())),
        "{first:?}"
    );
    // This one does not say where it is, and is told to stop all the same.
    let (at, next) = hand.asked()[before + 1].clone();
    assert!(
        matches!(next, Rs485Request::Write { address: 1486, .. }),
        "{next:?}"
    );
    let waited = at.duration_since(pressed);
    assert!(waited < Duration::from_millis(250), "{waited:?}");
}

#[tokio::test(start_paused = true)]
async fn the_first_hold_frame_of_a_hand_that_nobody_knew_holds_every_joint() {
    for endpoint in ["rs485:test", "rtu:test", "tcp:test"] {
        let hand = hand::begin(hand::free(SimConfig::default()));
        hand.with(|hand, now| hand.write(1486, &[0; 12], now).unwrap());
        sleep(Duration::from_millis(300)).await;
        let link = link::connect(endpoint, link::to_hand(hand.clone()));
        // As the process does that holds a hand whose program died.
        while link.status().hold == Hold::None {
            link.stop();
            sleep(Duration::from_millis(2)).await;
        }
        sleep(Duration::from_millis(200)).await;
        let journal = hand.with(|hand, _| hand.journal().to_vec());
        let frame = &journal[1];
        assert_eq!((frame.address, frame.bytes.len()), (1486, 12), "{endpoint}");
        let (targets, _) = frame.bytes.as_chunks::<2>();
        let targets: Vec<i16> = targets.iter().map(|to| i16::from_le_bytes(*to)).collect();
        assert!(
            targets.iter().all(|to| *to > 100),
            "{endpoint}: {targets:?}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn closing_ends_the_questions() {
    let hand = Shy::default();
    let link = open(&hand);
    while hand.asked().len() < 3 {
        sleep(Duration::from_millis(1)).await;
    }
    let before = hand.asked().len();
    drop(link);
    sleep(Duration::from_secs(2)).await;
    assert_eq!(hand.asked().len(), before);
}
