//! Tests that depend on real time, on a computer that may stall: what fails while a thread beside the test woke late is tried
//! again; what fails while none did has failed.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// How often the thread beside the test wakes.
const NAP: Duration = Duration::from_millis(5);
/// Woken so much later, the computer stalled.
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

/// Runs the test; up to twice more while it panics and this computer stalled meanwhile.
pub(crate) fn unless_stalled<R>(mut doing: impl FnMut() -> R) -> R {
    retried(|| with_worst_stall(|| catch_unwind(AssertUnwindSafe(&mut doing))))
}

fn retried<R>(mut attempt: impl FnMut() -> (thread::Result<R>, Duration)) -> R {
    let mut left = ATTEMPTS;
    loop {
        left -= 1;
        match attempt() {
            (Ok(done), _) => return done,
            (Err(panic), stall) if stall < STALL || left == 0 => resume_unwind(panic),
            (Err(_), stall) => println!("this computer stalled for {stall:?}: tried again"),
        }
    }
}

#[test]
fn what_fails_is_tried_again_only_after_a_stall() {
    for (stall, wanted) in [(Duration::ZERO, 1), (STALL, ATTEMPTS)] {
        let mut attempts = 0;
        let failed = catch_unwind(AssertUnwindSafe(|| {
            retried(|| {
                attempts += 1;
                (Err::<(), _>(Box::new("it fails")), stall)
            });
        }));
        assert!(failed.is_err());
        assert_eq!(attempts, wanted, "{stall:?}");
    }
    assert_eq!(unless_stalled(|| 7), 7);
}
