//! What a source may not keep a hand from that follows it.

use crate::hand::{Angle, Force, HandSample, Moment, PerDof, Speed};
use crate::inputs::follow::FollowPhase;
use crate::inputs::{Offer, OfferLimits};
use crate::link::{ArmRequest, Owner};
use crate::tasks::TaskHand as _;
use crate::tasks::follow::{FollowEnd, FollowStart, FollowTerms, follow};
use crate::tasks::tests::fake::{Asked, FakeHand, WELL};
use tokio::sync::{mpsc, watch};

/// Offers that wait at once: whoever sends without a pause always has some.
const FLOOD: usize = 1000;

fn offer(at: Moment) -> Offer {
    Offer {
        at,
        aims: PerDof::splat(Some(Angle::MAX)),
        gap: None,
        limits: OfferLimits::NONE,
        held: Some(true),
        mark: None,
    }
}

#[tokio::test(start_paused = true)]
async fn a_flood_of_offers_does_not_keep_what_the_hand_says_from_being_heard() {
    let hand = FakeHand::new();
    let start = FollowStart {
        lease: hand.grant(Owner::Gamepad),
        terms: watch::Sender::new(FollowTerms::default()).subscribe(),
        arm: ArmRequest {
            speed: PerDof::splat(Speed::GENTLE),
            force: PerDof::splat(Force::GENTLE),
        },
        // Nothing is armed before the joints are read.
        seen: HandSample::default(),
        clock: hand.clock,
    };
    let (offers, offered) = mpsc::channel(FLOOD);
    while offers.try_send(offer(hand.clock.now())).is_ok() {}
    // They are read after the first view.
    let mut is_told = false;
    let taken = || {
        let asked = hand.asked();
        let taken = asked
            .iter()
            .filter(|asked| matches!(asked, Asked::RunUntil(_)));
        taken.count()
    };
    let mut taken_before_it_follows = None;
    let end = follow(&hand, start, offered, |view| {
        if !std::mem::replace(&mut is_told, true) {
            hand.tells(WELL.sample(hand.clock.now()));
        }
        if view.phase == FollowPhase::Following {
            taken_before_it_follows.get_or_insert_with(taken);
        }
    });
    let end = end.await;
    assert_eq!(end, FollowEnd::Silent);
    let taken = taken_before_it_follows.expect("it follows");
    assert!(taken < FLOOD / 2, "{taken} were taken before the hand");
}
