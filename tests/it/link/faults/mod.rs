//! The link against seeded faults in virtual time: thousands of schedules over all five wires, each with oracles on what
//! was on the wire and what was told to the window. `HANDSCOPE_SEED=n cargo test --test it link::faults` replays one,
//! `HANDSCOPE_SOAK=1` runs all.

mod can;
mod dial;
mod oracle;
mod order;
mod schedule;
mod slider;
mod tap;

use crate::link::faults::oracle::Seen;
use crate::link::faults::schedule::{Sabotage, run_seed};
use crate::link::faults::tap::Lie;
use crate::setup::body::Protocol;
use crate::setup::soak;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Schedules in a full run.
const SCHEDULES: u64 = 20_000;
/// Schedules within which sabotage must be noticed.
const NOTICED_WITHIN: u64 = 200;

/// Failing seeds that are told; one is enough to begin with.
const FAILURES_TOLD: usize = 20;

/// Runs the seeds on all processors.
fn run_all(schedules: u64) -> Seen {
    let next = AtomicU64::new(0);
    let all = Mutex::new(Seen::default());
    let failed = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= schedules {
                        return;
                    }
                    match judge(seed, Sabotage::default()) {
                        Ok(seen) => all.lock().unwrap().add(&seen),
                        Err(words) => failed.lock().unwrap().push((seed, words)),
                    }
                }
            });
        }
    });
    let mut failed = failed.into_inner().unwrap();
    failed.sort();
    let count = failed.len();
    failed.truncate(FAILURES_TOLD);
    assert!(
        count == 0,
        "{count} failed, replay with HANDSCOPE_SEED=n: {failed:#?}"
    );
    all.into_inner().unwrap()
}

/// What one schedule saw, or the words of the oracle that it broke.
fn judge(seed: u64, sabotage: Sabotage) -> Result<Seen, String> {
    let judged = std::panic::catch_unwind(|| run_seed(seed, sabotage));
    judged.map_err(|caught| {
        let words = caught.downcast_ref::<String>().cloned();
        words
            .or_else(|| caught.downcast_ref::<&str>().map(ToString::to_string))
            .unwrap_or_default()
    })
}

#[test]
fn every_seeded_schedule_keeps_the_rules() {
    if let Ok(seed) = std::env::var("HANDSCOPE_SEED") {
        let seen = run_seed(seed.parse().unwrap(), Sabotage::default());
        println!("{seen:#?}");
        return;
    }
    let schedules = soak::times(SCHEDULES);
    let seen = run_all(schedules);
    println!("{schedules} schedules: {seen:?}");
    // Oracles that never had anything to judge prove nothing.
    for wire in Protocol::ALL {
        assert!(seen.wires[&wire] > schedules / 7, "{wire:?}: {seen:?}");
    }
    assert!(seen.faults > schedules * 5, "{seen:?}");
    assert!(seen.fresh_states > schedules * 20, "{seen:?}");
    assert!(seen.fresh_tips > schedules * 5, "{seen:?}");
    assert!(seen.wishes > schedules / 2, "{seen:?}");
    assert!(seen.setpoint_frames > schedules / 2, "{seen:?}");
    assert!(seen.stops_seen > schedules / 2, "{seen:?}");
    assert!(seen.stops_kept > schedules / 20, "{seen:?}");
    assert!(seen.confirmed > schedules / 8, "{seen:?}");
    assert!(seen.losses > schedules / 2, "{seen:?}");
    assert!(seen.reconnects > schedules / 2, "{seen:?}");
    assert!(seen.full > schedules / 10, "{seen:?}");
    assert!(seen.disturbed > schedules, "{seen:?}");
    assert!(seen.rests > schedules / 16, "{seen:?}");
    if !soak::is_full() {
        return;
    }
    // Nor are there many joints that move for long enough: `link::frozen` tries that alone.
    assert!(seen.doubts > schedules / 1000, "{seen:?}");
    // In a second and a half of faults, in which one hand in four is armed at all and old poses soon end that, few of them can be:
    // `link::others` tries that alone.
    assert!(seen.foreign_noticed > schedules / 1000, "{seen:?}");
}

/// Whether an oracle noticed with these words. One may notice first what follows from it.
fn is_noticed(sabotage: Sabotage, words: &str) -> bool {
    let says = |seed| judge(seed, sabotage).is_err_and(|said| said.contains(words));
    (0..NOTICED_WITHIN).any(says)
}

#[test]
fn the_oracles_notice_what_is_made_wrong_on_purpose() {
    let lie = |lie| Sabotage {
        lie,
        ..Sabotage::default()
    };
    let lag = |ms| Sabotage {
        lag: Duration::from_millis(ms),
        ..Sabotage::default()
    };
    let gone = Sabotage {
        gone: true,
        ..Sabotage::default()
    };
    for (sabotage, words) in [
        (lag(100), "but made"),
        (lag(1000), "but made"),
        (lie(Lie::NoHold), "stop at"),
        (lie(Lie::NoTips), "not asked for"),
        (lie(Lie::TipsFirst), "stop at"),
        (lie(Lie::TipsBeforeWishes), "before Wish"),
        (lie(Lie::TipsBeforeJobs), "while a job waits"),
        (lie(Lie::TooFar), "address: 1486"),
        (lie(Lie::OffPose), "is no pose"),
        (gone, "state: Offline"),
    ] {
        assert!(is_noticed(sabotage, words), "nobody noticed {sabotage:?}");
    }
}
