//! Tests that depend on real time, on a computer that may stall: what fails while a thread beside the test woke late is tried
//! again; what fails while none did has failed.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// How often the thread beside the test wakes.
const NAP: Duration = Duration::from_millis(5);
/// A test that allows less than this is no test of real time.
const STALL: Duration = Duration::from_millis(100);
const ATTEMPTS: usize = 3;

/// Does it, and beside it measures by how much a thread woke late at most.
fn with_worst_stall<R>(doing: impl FnOnce() -> R) -> (R, Duration) {
    let is_done = AtomicBool::new(false);
    thread::scope(|scope| {
        let beside = scope.spawn(|| {
            let mut worst = Duration::ZERO;
            while !is_done.load(Ordering::Relaxed) {
                let slept = Instant::now();
                thread::sleep(NAP);
                worst = worst.max(slept.elapsed().saturating_sub(NAP));
            }
            worst
        });
        let done = doing();
        is_done.store(true, Ordering::Relaxed);
        (done, beside.join().unwrap())
    })
}

/// Does it; once more, twice at most, where it panics and this computer had stalled meanwhile.
pub(crate) fn unless_stalled<R>(mut doing: impl FnMut() -> R) -> R {
    for attempt in 1.. {
        let (done, stall) = with_worst_stall(|| catch_unwind(AssertUnwindSafe(&mut doing)));
        match done {
            Ok(done) => return done,
            Err(panic) if stall < STALL || attempt == ATTEMPTS => resume_unwind(panic),
            Err(_) => println!("this computer stalled for {stall:?}: tried again"),
        }
    }
    unreachable!("the last attempt returns or panics")
}

#[test]
fn what_fails_is_tried_again_only_after_a_stall() {
    let mut attempts = 0;
    let failed = catch_unwind(AssertUnwindSafe(|| {
        unless_stalled(|| {
            attempts += 1;
            // Not this computer's fault, unless it stalls just now.
            assert!(with_worst_stall(|| ()).1 >= STALL, "it fails");
        });
    }));
    assert!(failed.is_err() && attempts <= ATTEMPTS);
    assert_eq!(unless_stalled(|| 7), 7);
}
