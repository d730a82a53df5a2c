//! Hands that other Handscopes share: listed as they come, change and go; watched at no cost; moved by nobody whom no person lets.

use crate::setup::busy::unless_busy;
use crate::setup::link::gentle;
use crate::setup::process::{run, start};
use crate::setup::time::Time;
use crate::share::place::{PATIENCE, Place, config, share, share_as, until};
use handscope::hand::kinematics::Side;
use handscope::link::{self, Clock, LinkConfig, LinkHandle, Owner, PollRates, Records};
use handscope::record::{ArmRefusal, LinkState, Record};
use handscope::share::fleet::{FleetAnnouncer, FleetCard, FleetHand, FleetList, host};
use handscope::share::gateway::{GatewayConfig, Writers};
use handscope::transport::SystemDial;
use handscope::transport::dds::{DdsNode, DdsPlace};
use serde_json::Value;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::timeout;

/// At the loopback, in a domain that no other test uses.
fn node(domain: u16) -> DdsNode {
    let interface = "127.0.0.1".into();
    DdsNode::open(&DdsPlace { interface, domain }).unwrap()
}

fn look(node: &DdsNode) -> FleetList {
    FleetList::open(node, Clock::start(), Arc::new(|| ()))
}

fn card(name: &str, place: &Place) -> FleetCard {
    FleetCard {
        host: "lab".into(),
        name: name.into(),
        side: Side::Left,
        at: Some(place.address()),
        first_may_move: false,
        follows: false,
    }
}

/// Waits for a list that is as wanted.
async fn listed(list: &mut FleetList, wanted: impl Fn(&[FleetHand]) -> bool) -> Vec<FleetHand> {
    let found = async {
        loop {
            let hands = list.changed().await.expect("somebody listens");
            if wanted(&hands) {
                return hands;
            }
        }
    };
    timeout(PATIENCE, found)
        .await
        .expect("the list comes to be right")
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_shared_hand_is_listed_as_it_changes_and_not_longer_than_it_is_there() {
    let (here, there) = (node(51), node(51));
    let mut list = look(&here);
    let place = share(PollRates::default(), Duration::ZERO).await;
    let announcer = FleetAnnouncer::open(&there, &place.link, card("egg", &place));
    let hands = listed(&mut list, |hands| !hands.is_empty()).await;
    let expected = FleetHand {
        card: card("egg", &place),
        state: LinkState::Monitoring,
        owner: None,
    };
    assert_eq!(hands, [expected]);
    let _lease = place.link.grant(Owner::Gamepad);
    listed(&mut list, |hands| hands[0].owner == Some(Owner::Gamepad)).await;
    let without = FleetCard {
        at: None,
        ..card("bread", &place)
    };
    announcer.announce(without.clone());
    listed(&mut list, |hands| hands[0].card == without).await;
    place.wires.cut();
    listed(&mut list, |hands| !hands[0].state.is_live()).await;
    drop(announcer);
    listed(&mut list, <[FleetHand]>::is_empty).await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_hundred_hands_are_listed_right_after_each_change() {
    let here = node(52);
    let mut list = look(&here);
    let place = share(PollRates::default(), Duration::ZERO).await;
    let mut programs: Vec<(DdsNode, Vec<FleetAnnouncer>)> = Vec::new();
    for program in 0..10 {
        let node = node(52);
        let hands = (0..10).map(|hand| {
            let card = card(&format!("{program} {hand}"), &place);
            FleetAnnouncer::open(&node, &place.link, card)
        });
        let hands = hands.collect();
        programs.push((node, hands));
    }
    let all = listed(&mut list, |hands| hands.len() == 100).await;
    let names = all.iter().map(|hand| hand.card.name.as_str());
    assert!(names.is_sorted());
    programs.pop();
    listed(&mut list, |hands| hands.len() == 90).await;
    for (_, hands) in &programs {
        for hand in hands {
            hand.announce(card("same", &place));
        }
    }
    let is_same = |hands: &[FleetHand]| hands.iter().all(|hand| hand.card.name == "same");
    let hands = listed(&mut list, is_same).await;
    assert_eq!(hands.len(), 90);
    programs.clear();
    listed(&mut list, <[FleetHand]>::is_empty).await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn nonsense_on_the_topic_is_survived_and_listed_as_nothing() {
    let (here, there) = (node(53), node(53));
    let mut list = look(&here);
    let place = share(PollRates::default(), Duration::ZERO).await;
    let noise = there.writer(&handscope::share::fleet::topic());
    let announcer = FleetAnnouncer::open(&there, &place.link, card("egg", &place));
    listed(&mut list, |hands| hands.len() == 1).await;
    let mut seed = fastrand::Rng::with_seed(7);
    let good = FleetHand {
        card: card("evil", &place),
        state: LinkState::Armed,
        owner: None,
    };
    let good = good.message();
    for round in 0..3000 {
        let mut message = good.clone();
        match round % 3 {
            // The head says that these are strings of some length.
            0 => message[4..8].fill_with(|| seed.u8(..)),
            1 => message.truncate(seed.usize(4..good.len() - 8)),
            _ => message = (0..seed.usize(4..3000)).map(|_| seed.u8(..)).collect(),
        }
        let _is_sent = noise.send(message);
    }
    announcer.announce(card("bread", &place));
    let hands = listed(&mut list, |hands| {
        hands.iter().any(|hand| hand.card.name == "bread")
    })
    .await;
    assert_eq!(hands.len(), 1, "{hands:?}");
}

/// Another Handscope that connects to a listed hand.
async fn watch(hand: &FleetHand) -> (LinkHandle, Records) {
    let config = LinkConfig {
        endpoint: hand.endpoint().unwrap(),
        rates: PollRates::default(),
        clock: Clock::start(),
        dial: Arc::new(SystemDial),
        wake: Arc::new(|| ()),
    };
    let (link, records) = link::open(config, &Handle::current());
    until(|| link.status().state == LinkState::Monitoring).await;
    (link, records)
}

async fn told(place: &Place) -> FleetHand {
    let (here, there) = (node(54), node(54));
    let mut list = look(&here);
    let _announcer = FleetAnnouncer::open(&there, &place.link, card("egg", place));
    let hands = listed(&mut list, |hands| hands.len() == 1).await;
    hands[0].clone()
}

#[test]
fn to_watch_a_shared_hand_costs_its_link_nothing() {
    unless_busy(|| Time::Real.runtime().block_on(watching_costs_nothing()));
}

async fn watching_costs_nothing() {
    let place = share(PollRates::default(), Duration::from_millis(1)).await;
    let states = || place.link.stats().state_reads;
    let asked = async |states_more: u64| {
        let (begun, before) = (states(), place.wires.reads());
        until(|| states() >= begun + states_more).await;
        place.wires.reads() - before
    };
    // What is asked once, when a hand is met, is over by then.
    asked(100).await;
    let alone = asked(300).await;
    let (watcher, _records) = watch(&told(&place).await).await;
    until(|| watcher.stats().state_reads > 100).await;
    let before = watcher.stats().state_reads;
    let watched = asked(300).await;
    let seen = watcher.stats().state_reads - before;
    assert!(seen > 200, "{seen} states were seen of 300");
    assert!(
        watched <= alone + alone / 50,
        "{watched} questions for {alone}"
    );
    assert_eq!(place.wires.writes(), [0_u16; 0]);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn from_afar_nobody_moves_a_hand_before_a_person_there_lets_it_or_its_file_does() {
    for writers in [Writers::Granted, Writers::First] {
        let gateway = GatewayConfig {
            writers,
            ..config()
        };
        let place = share_as(gateway, PollRates::default(), Duration::ZERO).await;
        let (watcher, mut records) = watch(&told(&place).await).await;
        assert_eq!(place.wires.writes(), [0_u16; 0]);
        let lease = watcher.grant(Owner::Person);
        watcher.arm(lease, gentle()).unwrap();
        if writers == Writers::Granted {
            let refused = async {
                loop {
                    if let Some(Record::ArmRefused { reason, .. }) = records.next().await {
                        return reason;
                    }
                }
            };
            let refused = timeout(PATIENCE, refused).await;
            assert_eq!(refused, Ok(ArmRefusal::Taken));
            assert!(place.gateway.clients()[0].refusal.is_some());
            assert_eq!(place.wires.writes(), [0_u16; 0]);
            assert_ne!(watcher.status().state, LinkState::Armed);
            let client = place.gateway.clients()[0].id;
            place.gateway.grant(client);
            until(|| place.link.status().holder.is_some()).await;
            let lease = watcher.grant(Owner::Person);
            watcher.arm(lease, gentle()).unwrap();
        }
        until(|| watcher.status().state == LinkState::Armed).await;
        let holder = place.link.status().holder.unwrap();
        assert!(matches!(holder.owner, Owner::Gateway(_)), "{holder:?}");
    }
}

#[test]
fn hands_of_other_processes_are_listed_and_a_killed_one_is_gone() {
    unless_busy(|| {
        let words = [
            "--dds", "--domain", "55", "--name", "left arm", "--side", "left",
        ];
        let shares = [
            &["share", "--hand", "sim:", "--tcp", "127.0.0.1:0"],
            &words[..],
        ]
        .concat();
        let mut shares = start(&shares);
        let tcp = shares.line();
        let at = tcp.strip_prefix("ready tcp ").unwrap();
        let mut fleet = start(&["fleet", "--domain", "55", "--json"]);
        let line: Value = serde_json::from_str(&fleet.line()).unwrap();
        let hand = &line["hands"][0];
        assert_eq!(hand["name"], "left arm");
        assert_eq!((&hand["side"], &hand["at"]), (&"left".into(), &at.into()));
        assert_eq!(hand["host"], host());
        assert_eq!(
            (&hand["state"], &hand["owner"]),
            (&"monitoring".into(), &Value::Null)
        );
        let mut spoken = start(&["fleet", "--domain", "55"]);
        let said = spoken.line();
        assert!(
            said.contains("left arm  left  watched  nobody moves it  tcp:127.0.0.1:"),
            "{said}"
        );
        drop(shares);
        let line: Value = serde_json::from_str(&fleet.line()).unwrap();
        assert_eq!(line["hands"], Value::Array(Vec::new()));
        assert!(spoken.line().ends_with("left arm  gone"));
    });
}

#[test]
fn where_nobody_shares_or_nothing_is_one_sentence_says_so() {
    unless_busy(|| {
        let ended = run(&["fleet", "--domain", "56", "--for", "0.5"]).ok();
        assert!(
            ended.out.is_empty() && ended.err.contains("no hand is shared at 127.0.0.1"),
            "{}",
            ended.err
        );
        let ended = run(&["fleet", "--domain", "56", "--for", "0.3", "--json"]).ok();
        assert_eq!(ended.lines()[0]["hands"], Value::Array(Vec::new()));
        let ended = run(&["fleet", "nowhere0"]);
        assert_eq!(ended.code, Some(1));
        assert!(
            ended.err.contains("there is no network interface nowhere0"),
            "{}",
            ended.err
        );
        assert_eq!(run(&["fleet", "--domain", "233"]).code, Some(2));
        for unused in [["--name", "egg"], ["--domain", "3"]] {
            let follow = ["follow", "--hand", "sim:", "--udp", "127.0.0.1:0"];
            let ended = run(&[&follow[..], &unused].concat());
            assert_eq!(ended.code, Some(2), "{}", ended.err);
            assert!(ended.err.contains("belong to --dds"), "{}", ended.err);
        }
    });
}
