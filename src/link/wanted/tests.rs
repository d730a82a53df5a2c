use crate::hand::{Angle, ArmEpoch, Dof, Force, Moment, PerDof, Setpoints, Speed, Target};
use crate::link::lease::{Lease, Owner};
use crate::link::status::ArmRequest;
use crate::link::wanted::{ArmCommand, PendingControl};
use crate::record::Disarmed;
use crate::soak;
use fastrand::Rng;
use tokio::sync::oneshot;

const OWNERS: [Owner; 4] = [
    Owner::Person,
    Owner::Task,
    Owner::Exhibition,
    Owner::Gamepad,
];
const ENDS: [Disarmed; 5] = [
    Disarmed::Fault,
    Disarmed::LinkLost,
    Disarmed::Stale,
    Disarmed::Resume,
    Disarmed::OtherController,
];

/// A target that tells which grant it was sent under.
fn tagged(grant: usize) -> Setpoints {
    let mut setpoints = Setpoints::none(ArmEpoch(1));
    let tag = i64::try_from(grant).unwrap_or(0);
    setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(tag)));
    setpoints
}

/// What the rules say of who may move the hand, kept apart from how it is done.
#[derive(Default)]
struct Oracle {
    /// Every lease ever granted, with its owner.
    leases: Vec<(Lease, Owner)>,
    /// The one that holds.
    holds: Option<usize>,
    /// Something of the holder may be waiting.
    may_wait: bool,
}

impl Oracle {
    fn end(&mut self) {
        self.holds = None;
        self.may_wait = false;
    }
}

const REQUEST: ArmRequest = ArmRequest {
    speed: PerDof::splat(Speed::GENTLE),
    force: PerDof::splat(Force::GENTLE),
};

/// 20 000 schedules of all owners together, each with every lease that it ever had: only the newest grant's targets pass, and
/// none after a stop, an end or a release before a new grant.
#[test]
fn never_two_owners_and_nothing_after_an_end_before_a_new_grant() {
    let (mut passed, mut refused) = (0, 0);
    let seeds = soak::times(20_000);
    for seed in 0..seeds {
        let mut rng = Rng::with_seed(seed);
        let mut wanted = PendingControl::default();
        let mut oracle = Oracle::default();
        for _ in 0..60 {
            let some = match oracle.leases.len() {
                0 => None,
                all => Some(rng.usize(0..all)),
            };
            match (rng.u8(0..12), some) {
                (0, _) => {
                    let owner = OWNERS[rng.usize(0..OWNERS.len())];
                    oracle.leases.push((wanted.grant(owner), owner));
                    oracle.holds = Some(oracle.leases.len() - 1);
                    oracle.may_wait = false;
                }
                (1, _) => {
                    wanted.stop(Disarmed::Stop);
                    wanted.book.end(Disarmed::Stop);
                    oracle.end();
                }
                (2, _) => {
                    wanted.disarm(Disarmed::Person);
                    wanted.book.end(Disarmed::Person);
                    oracle.end();
                }
                (3, _) if rng.u8(0..4) == 0 => {
                    let why = ENDS[rng.usize(0..ENDS.len())];
                    wanted.book.end(why);
                    wanted = wanted.lasting();
                    let outlives = oracle.holds.is_some_and(|grant| {
                        oracle.leases[grant].1 == Owner::Exhibition && why == Disarmed::Fault
                    });
                    oracle.may_wait = false;
                    if !outlives {
                        oracle.end();
                    }
                }
                (4, Some(grant)) => {
                    let (lease, _) = oracle.leases[grant];
                    let done = wanted.under(lease, |wanted| {
                        wanted.stop(Disarmed::Silent);
                        wanted.book.end(Disarmed::Silent);
                    });
                    assert_eq!(done.is_ok(), oracle.holds == Some(grant), "seed {seed}");
                    if done.is_ok() {
                        oracle.end();
                    }
                }
                (5, Some(grant)) => {
                    let (lease, _) = oracle.leases[grant];
                    let done = wanted.under(lease, |wanted| wanted.stop(Disarmed::Released));
                    assert_eq!(done.is_ok(), oracle.holds == Some(grant), "seed {seed}");
                    oracle.may_wait &= done.is_err();
                }
                (6, Some(grant)) => {
                    let (lease, _) = oracle.leases[grant];
                    let until = Moment::from_micros(rng.u64(0..1000));
                    let armed = wanted.under(lease, |wanted| {
                        wanted.runs_until = Some(until);
                        wanted.arm = Some(ArmCommand {
                            lease,
                            request: REQUEST,
                            answer: oneshot::channel().0,
                        });
                    });
                    assert_eq!(armed.is_ok(), oracle.holds == Some(grant), "seed {seed}");
                }
                (7 | 8, _) => {
                    let taken = wanted.take();
                    if let Some(setpoints) = taken.setpoints {
                        passed += 1;
                        let grant = oracle.holds.expect("somebody may move the hand");
                        assert!(oracle.may_wait, "seed {seed}");
                        assert_eq!(setpoints, tagged(grant), "seed {seed}");
                    }
                    if let Some(ArmCommand { lease, .. }) = taken.arm {
                        let holder = oracle.holds.map(|grant| oracle.leases[grant].0);
                        assert_eq!(Some(lease), holder, "seed {seed}");
                    }
                    oracle.may_wait = false;
                }
                (_, Some(grant)) => {
                    let (lease, _) = oracle.leases[grant];
                    let set = wanted.under(lease, |wanted| wanted.set(&tagged(grant)));
                    assert_eq!(set.is_ok(), oracle.holds == Some(grant), "seed {seed}");
                    oracle.may_wait |= set.is_ok();
                    refused += usize::from(set.is_err());
                }
                _ => {}
            }
        }
    }
    assert!(
        passed > seeds / 4 && refused as u64 > seeds * 5,
        "{passed} {refused}"
    );
}
