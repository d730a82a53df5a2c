#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]

use crate::hand::gap::{Gap, gap_on_path, pad_distance};
use crate::hand::{Angle, ArmEpoch, Dof, Force, Moment, PerDof, Speed, Target};
use crate::inputs::offer::{END_TIMEOUT, HOLD_TIMEOUT, Offer, OfferLimits};
use crate::link::ArmRequest;
use crate::motion::follow::step::{FREEZE_TIMEOUT, Follow, FollowInput, FollowLimits, FollowPhase};
use crate::motion::program::Order;
use crate::record::{Disarmed, LinkState};
use crate::soak;
use fastrand::Rng;
use std::time::Duration;

const LIMITS: FollowLimits = FollowLimits {
    lead: 100,
    rate: 1000,
};

const GENTLE: ArmRequest = ArmRequest {
    speed: PerDof::splat(Speed::GENTLE),
    force: PerDof::splat(Force::GENTLE),
};

fn ms(ms: u64) -> Moment {
    Moment::from_micros(ms * 1000)
}

fn at(angle: i16) -> FollowInput {
    FollowInput {
        held: None,
        state: LinkState::Armed,
        epoch: Some(ArmEpoch::default()),
        arm: GENTLE,
        pose: PerDof::splat(Some(Angle::nearest(angle))),
    }
}

fn offer(when: u64, angle: i16) -> Offer {
    Offer {
        at: ms(when),
        aims: PerDof::splat(Some(Angle::nearest(angle))),
        gap: None,
        hold: None,
        limits: OfferLimits::NONE,
        held: None,
        mark: Some(angle.unsigned_abs().into()),
    }
}

/// The targets of an order that sets any.
fn targets(order: Option<Order>) -> Option<PerDof<Option<Angle>>> {
    match order {
        Some(Order::Set(sent)) => Some(sent.angle.map(|to| to.and_then(Target::angle))),
        _ => None,
    }
}

fn index(order: Option<Order>) -> Option<i16> {
    match order {
        Some(Order::Set(sent)) => sent.angle[Dof::Index]
            .and_then(Target::angle)
            .map(Angle::get),
        None => None,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_first_target_is_the_actual_pose_and_the_next_are_within_rate_and_lead() {
    let mut follow = Follow::new(LIMITS, ms(0));
    follow.offer(offer(0, 0));
    assert_eq!(index(follow.tick(at(800), ms(0))), Some(800));
    assert_eq!(index(follow.tick(at(800), ms(10))), Some(790));
    // A look that comes late moves no further than one in time.
    assert_eq!(index(follow.tick(at(800), ms(150))), Some(750));
    for n in 0..20 {
        follow.offer(offer(160 + n * 10, 0));
        let _sent = follow.tick(at(800), ms(160 + n * 10));
    }
    assert_eq!(follow.sent()[Dof::Index], Some(Angle::nearest(700)), "lead");
}

/// Follows a gap from these angles with a hand that is where it is told 50 ms later; all places of the hand on the way.
fn to_gap(mm: f32, from: PerDof<i16>, limits: FollowLimits) -> Vec<PerDof<i16>> {
    let gap = Gap::nearest(mm);
    let mut follow = Follow::new(limits, ms(0));
    let mut commanded = vec![from; 6];
    let mut places = Vec::new();
    for n in 0..700 {
        let now = ms(n * 10);
        follow.offer(Offer {
            gap: Some(gap),
            aims: gap.angles().map(Some),
            mark: None,
            ..offer(n * 10, 0)
        });
        let hand = commanded[commanded.len() - 6];
        places.push(hand);
        let seen = FollowInput {
            pose: hand.map(|at| Some(Angle::nearest(at))),
            ..at(0)
        };
        let mut next = commanded[commanded.len() - 1];
        match follow.tick(seen, now) {
            Some(Order::Set(sent)) => {
                for (dof, to) in sent.angle.iter() {
                    if let Some(to) = to.and_then(Target::angle) {
                        let lead = i16::try_from(limits.lead).unwrap();
                        assert!(to.get().abs_diff(hand[dof]) <= limits.lead + 1, "{lead}");
                        next[dof] = to.get();
                    }
                }
            }
            other => assert_eq!(other, None),
        }
        commanded.push(next);
    }
    places
}

#[test]
fn a_gap_is_gone_to_along_the_path_within_rate_and_lead_from_wherever_the_hand_is() {
    let limits = FollowLimits::default();
    for (from, is_open) in [
        (PerDof::splat(0), false),
        (PerDof::new([0, 0, 0, 300, 100, 0]), false),
        (Gap::MAX.angles().map(Angle::get), true),
        (Gap::nearest(20.0).angles().map(Angle::get), true),
    ] {
        for mm in [3.0, 100.0] {
            let places = to_gap(mm, from, limits);
            let counts = |place: &PerDof<i16>| place.map(f32::from);
            let last = gap_on_path(&counts(&places[places.len() - 1]));
            assert!((last.unwrap() - mm).abs() < 0.6, "{from:?} {mm}: {last:?}");
            let on_path = |place: &PerDof<i16>| gap_on_path(&counts(place)).is_some();
            let first = places.iter().position(on_path).unwrap();
            assert_eq!(first == 0, is_open, "{from:?}");
            assert!(places[first..].iter().all(on_path), "{from:?} {mm}");
            let off = |place: &PerDof<i16>| {
                let near = Gap::nearest(pad_distance(&counts(place))).angles();
                let off = Gap::JOINTS.map(|dof| near[dof].get().abs_diff(place[dof]));
                off.into_iter().max().unwrap()
            };
            let settled = &places[(first + 60).min(places.len() - 1)..];
            let most = settled.iter().step_by(10).map(off).max().unwrap();
            assert!(most <= 12, "{from:?} {mm}: {most} counts off the path");
        }
    }
}

#[test]
fn what_is_left_alone_or_locked_stays_where_it_is_while_a_gap_is_gone_to() {
    let gap = Gap::nearest(30.0);
    let aims = gap.angles().map(Some);
    let alone = PerDof::from_fn(|dof| aims[dof].filter(|_| dof != Dof::Little));
    for from in [PerDof::splat(0), Gap::MAX.angles().map(Angle::get)] {
        for (aims, moves) in [(aims, true), (alone, false)] {
            let mut follow = Follow::new(FollowLimits::default(), ms(0));
            let mut hand = from;
            hand[Dof::Little] = 200;
            for n in 0..300 {
                follow.offer(Offer {
                    gap: Some(gap),
                    aims,
                    mark: None,
                    ..offer(n * 10, 0)
                });
                let seen = FollowInput {
                    pose: hand.map(|at| Some(Angle::nearest(at))),
                    ..at(0)
                };
                if let Some(to) = targets(follow.tick(seen, ms(n * 10))) {
                    hand = PerDof::from_fn(|dof| to[dof].map_or(hand[dof], Angle::get));
                }
            }
            assert_eq!(hand[Dof::Little] != 200, moves, "{hand:?}");
            let index = gap.angles()[Dof::Index].get();
            assert!(hand[Dof::Index].abs_diff(index) <= 2, "{hand:?}");
        }
    }
}

#[test]
fn a_gap_that_stays_the_same_is_not_frozen() {
    let mut follow = Follow::new(LIMITS, ms(0));
    let gap = Gap::nearest(30.0);
    for n in 0..100 {
        follow.offer(Offer {
            gap: Some(gap),
            aims: gap.angles().map(Some),
            ..offer(n * 10, 1)
        });
        let _sent = follow.tick(at(500), ms(n * 10));
    }
    assert_eq!(follow.phase(), FollowPhase::Following);
}

#[test]
fn what_stops_the_index_stops_the_thumb_on_the_path_too() {
    let mut follow = Follow::new(LIMITS, ms(0));
    let (gap, block) = (Gap::nearest(10.0), Gap::nearest(60.0).angles());
    let mut last = PerDof::splat(1000);
    for n in 0..500 {
        follow.offer(Offer {
            gap: Some(gap),
            aims: gap.angles().map(Some),
            mark: None,
            ..offer(n * 10, 0)
        });
        let mut pose = last;
        // The index is held where the block is; the thumb goes where it is told.
        pose[Dof::Index] = pose[Dof::Index].max(block[Dof::Index].get());
        pose[Dof::ThumbRotate] = 0;
        let seen = FollowInput {
            pose: pose.map(|at| Some(Angle::nearest(at))),
            ..at(0)
        };
        if let Some(aims) = targets(follow.tick(seen, ms(n * 10))) {
            for (dof, to) in aims.iter() {
                last[dof] = to.map_or(last[dof], Angle::get);
            }
        }
    }
    let ahead = block[Dof::Index].get() - last[Dof::Index];
    assert!((95..=101).contains(&ahead), "lead {ahead}");
    let beyond = block[Dof::ThumbBend].get() - last[Dof::ThumbBend];
    assert!((0..=210).contains(&beyond), "the thumb went on by {beyond}");
}

#[test]
fn a_silent_source_is_held_and_then_ended() {
    let mut follow = Follow::new(LIMITS, ms(0));
    follow.offer(offer(0, 0));
    let _entered = follow.tick(at(800), ms(0));
    let _moved = follow.tick(at(795), ms(30));
    let held = HOLD_TIMEOUT.as_micros().try_into().unwrap();
    let held = Moment::from_micros(held);
    assert_eq!(index(follow.tick(at(760), held)), Some(760));
    assert_eq!(follow.phase(), FollowPhase::Silent);
    assert_eq!(
        index(follow.tick(at(755), ms(260))),
        Some(755),
        "it acts late"
    );
    assert_eq!(index(follow.tick(at(750), ms(330))), None, "and stays then");
    // A target that comes now is entered to from where the joint is.
    let mut back = follow.clone();
    back.offer(offer(400, 0));
    assert_eq!(index(back.tick(at(752), ms(400))), Some(752));
    let end = Moment::from_duration(END_TIMEOUT);
    assert_eq!(
        follow.tick(at(750), end),
        Some(Order::GiveBack(Disarmed::Silent))
    );
}

#[test]
fn a_source_that_never_says_anything_ends_too() {
    let mut follow = Follow::new(LIMITS, ms(0));
    assert_eq!(follow.tick(at(800), ms(999)), None);
    assert_eq!(
        follow.tick(at(800), ms(1000)),
        Some(Order::GiveBack(Disarmed::Silent))
    );
}

/// Offers the same each 10 ms, and gives the phase and what was sent last.
fn repeat(aim: i16, mark: Option<u64>, for_ms: u64) -> (Follow, FollowPhase) {
    let mut follow = Follow::new(LIMITS, ms(0));
    for when in (0..=for_ms).step_by(10) {
        follow.offer(Offer {
            mark,
            ..offer(when, aim)
        });
        let _sent = follow.tick(at(500), ms(when));
    }
    let phase = follow.phase();
    (follow, phase)
}

#[test]
fn targets_that_repeat_to_the_last_bit_are_called_frozen_and_the_next_one_is_entered_to() {
    let frozen_ms = u64::try_from(FREEZE_TIMEOUT.as_millis()).unwrap();
    assert_eq!(
        repeat(450, Some(1), frozen_ms - 10).1,
        FollowPhase::Following
    );
    let (mut follow, phase) = repeat(450, Some(1), frozen_ms);
    assert_eq!(phase, FollowPhase::Frozen);
    for end in [0, 1000] {
        assert_eq!(
            repeat(end, Some(1), 2000).1,
            FollowPhase::Following,
            "{end}"
        );
    }
    assert_eq!(repeat(450, None, 2000).1, FollowPhase::Following, "a pad");
    follow.offer(offer(510, 100));
    // Not from the target of before, but from where the joint is.
    assert_eq!(index(follow.tick(at(520), ms(510))), Some(520));
    assert_eq!(follow.phase(), FollowPhase::Following);
}

#[test]
fn a_dead_man_that_is_let_go_stops_and_begins_anew_when_held() {
    let held = |when, held| Offer {
        held: Some(held),
        ..offer(when, 0)
    };
    let free = FollowInput {
        state: LinkState::Monitoring,
        ..at(800)
    };
    let mut follow = Follow::new(LIMITS, ms(0));
    follow.offer(held(0, true));
    assert_eq!(follow.tick(free, ms(0)), Some(Order::Arm(GENTLE)));
    assert_eq!(index(follow.tick(at(800), ms(10))), Some(800));
    follow.offer(held(20, false));
    assert_eq!(follow.tick(at(800), ms(20)), Some(Order::Halt));
    follow.offer(held(30, false));
    assert_eq!(follow.tick(free, ms(30)), None);
    assert_eq!(follow.phase(), FollowPhase::Released);
    follow.offer(held(40, true));
    assert_eq!(follow.tick(free, ms(40)), Some(Order::Arm(GENTLE)));
    assert_eq!(index(follow.tick(at(780), ms(50))), Some(780));
    // Its state grows old like a target.
    assert_eq!(follow.tick(at(780), ms(240)), Some(Order::Halt));
    assert_eq!(follow.phase(), FollowPhase::Silent);
}

#[test]
fn arming_is_requested_again_after_a_refusal_and_not_while_a_request_is_open() {
    let mut follow = Follow::new(LIMITS, ms(0));
    let disarmed = FollowInput {
        state: LinkState::Monitoring,
        epoch: None,
        ..at(800)
    };
    let mut tick = |at: u64, answered: bool| {
        follow.offer(offer(at, 0));
        if answered {
            follow.answered();
        }
        follow.tick(disarmed, ms(at))
    };
    assert_eq!(tick(0, false), Some(Order::Arm(GENTLE)));
    for ms in (100..2000).step_by(100) {
        assert_eq!(tick(ms, false), None, "{ms}");
    }
    assert_eq!(tick(2000, true), Some(Order::Arm(GENTLE)));
    assert_eq!(tick(2100, true), None, "not at once");
    assert_eq!(tick(2500, false), Some(Order::Arm(GENTLE)));
}

#[test]
fn a_joint_that_is_not_aimed_at_or_not_known_is_left_alone() {
    let mut follow = Follow::new(LIMITS, ms(0));
    let mut aims = offer(0, 0);
    aims.aims[Dof::Index] = None;
    follow.offer(aims);
    let mut seen = at(800);
    seen.pose[Dof::Ring] = None;
    let Some(sent) = targets(follow.tick(seen, ms(0))) else {
        panic!("nothing sent")
    };
    assert_eq!((sent[Dof::Index], sent[Dof::Ring]), (None, None));
    assert!(sent[Dof::Little].is_some());
}

/// A hand that goes where it was told at its own speed, late, and is pushed now and then.
struct Joints {
    at: PerDof<f32>,
    commanded: PerDof<f32>,
    state: LinkState,
}

impl Joints {
    fn advance(&mut self, elapsed: Duration, rng: &mut Rng) {
        for dof in Dof::ALL {
            let reach = 1667.0 * elapsed.as_secs_f32();
            self.at[dof] += (self.commanded[dof] - self.at[dof]).clamp(-reach, reach);
            if rng.f32() < 0.002 {
                self.at[dof] = rng.f32() * 1000.0;
            }
        }
    }

    fn input(&self, rng: &mut Rng) -> FollowInput {
        #[expect(clippy::cast_possible_truncation, reason = "in range")]
        let pose = self.at.map(|at| Angle::nearest(at.round() as i64));
        FollowInput {
            held: None,
            state: self.state,
            epoch: (self.state == LinkState::Armed).then(ArmEpoch::default),
            arm: GENTLE,
            pose: pose.map(|at| (rng.f32() >= 0.01).then_some(at)),
        }
    }
}

/// What a source does now and then.
fn next_offer(now: Moment, before: Option<Offer>, rng: &mut Rng) -> Option<Offer> {
    if rng.f32() < 0.1 {
        return None;
    }
    if let Some(before) = before.filter(|_| rng.f32() < 0.5) {
        return Some(Offer { at: now, ..before });
    }
    // Few: each reckons its path anew.
    let gap = (rng.f32() < 0.005).then(|| Gap::nearest(130.0 * rng.f32()));
    let each = PerDof::from_fn(|_| {
        let aim = Angle::nearest(rng.i16(0..=1000));
        (rng.f32() >= 0.1).then_some(aim)
    });
    Some(Offer {
        at: now,
        gap,
        hold: None,
        limits: OfferLimits::NONE,
        aims: gap.map_or(each, |gap| gap.angles().map(Some)),
        held: match rng.u8(0..4) {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        },
        mark: (rng.f32() < 0.8).then(|| rng.u64(..)),
    })
}

/// 20 000 schedules of offers, silence, pushes and disarming: no target beyond rate and lead, none without a fresh offer but
/// where the hand is, none after the end.
#[test]
fn no_schedule_moves_a_hand_beyond_its_limits_or_after_the_end() {
    let (mut aims, mut halts, mut ends) = (0, 0, 0);
    let seeds = soak::times(20_000);
    for seed in 0..seeds {
        let mut rng = Rng::with_seed(seed);
        let limits = FollowLimits {
            lead: rng.u16(20..=500),
            rate: rng.u16(50..=1700),
        };
        let mut follow = Follow::new(limits, ms(0));
        let start = rng.f32() * 1000.0;
        let mut hand = Joints {
            at: PerDof::splat(start),
            commanded: PerDof::splat(start),
            state: LinkState::Monitoring,
        };
        let mut offered: Option<Offer> = None;
        let mut sent: PerDof<Option<(Angle, Moment)>> = PerDof::splat(None);
        let mut now = ms(0);
        let mut silence = 0_u32;
        for _ in 0..120 {
            let elapsed = Duration::from_micros(rng.u64(200..30_000));
            now = now.plus(elapsed);
            hand.advance(elapsed, &mut rng);
            if silence > 0 {
                silence -= 1;
            } else if rng.f32() < 0.03 {
                silence = rng.u32(1..60);
            } else if let Some(offer) = next_offer(now, offered, &mut rng) {
                offered = Some(offer);
                follow.offer(offer);
            }
            if rng.f32() < 0.01 {
                hand.state = LinkState::Monitoring;
            }
            let seen = hand.input(&mut rng);
            match follow.tick(seen, now) {
                None => {}
                Some(Order::Arm(_)) => {
                    follow.answered();
                    assert_ne!(offered.unwrap().held, Some(false), "seed {seed}");
                    hand.state = LinkState::Armed;
                    sent = PerDof::splat(None);
                }
                Some(Order::Halt) => {
                    halts += 1;
                    hand.commanded = hand.at;
                    hand.state = LinkState::Monitoring;
                    sent = PerDof::splat(None);
                }
                Some(Order::GiveBack(Disarmed::Silent)) => {
                    ends += 1;
                    let last = offered.map_or(ms(0), |offer| offer.at);
                    assert!(now.since(last) >= END_TIMEOUT, "seed {seed}");
                    break;
                }
                Some(Order::Set(set)) => {
                    assert_eq!(hand.state, LinkState::Armed, "seed {seed}");
                    let offer = offered.unwrap();
                    assert_ne!(offer.held, Some(false), "seed {seed}");
                    let is_fresh = now.since(offer.at) < HOLD_TIMEOUT;
                    for (dof, to) in set.angle.iter() {
                        let Some(to) = to.and_then(Target::angle) else {
                            continue;
                        };
                        aims += 1;
                        let actual = seen.pose[dof].expect("a pose that is known");
                        let is_entry = to == actual;
                        assert!(is_fresh || is_entry, "seed {seed}: moved in silence");
                        let ahead = to.get().abs_diff(actual.get());
                        if let (Some((before, when)), false) = (sent[dof], is_entry) {
                            let step = f32::from(to.get().abs_diff(before.get()));
                            let may = f32::from(limits.rate) * now.since(when).as_secs_f32() + 1.0;
                            assert!(step <= may, "seed {seed}: {step} of {may}");
                            let was = before.get().abs_diff(actual.get());
                            let may = limits.lead.max(was) + 1;
                            assert!(ahead <= may, "seed {seed}: lead {ahead} of {may}");
                        } else {
                            assert!(is_entry, "seed {seed}: entered with a jump of {ahead}");
                        }
                        sent[dof] = Some((to, now));
                        hand.commanded[dof] = to.get().into();
                    }
                    for dof in Dof::ALL {
                        if offer.aims[dof].is_none() {
                            sent[dof] = None;
                        }
                    }
                }
                other => panic!("seed {seed}: {other:?}"),
            }
        }
    }
    assert!(
        aims > seeds * 25 && halts > seeds / 4 && ends > seeds / 100,
        "{aims} {halts} {ends}"
    );
}
