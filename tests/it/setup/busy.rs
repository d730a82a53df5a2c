//! Tests that depend on real time, on a computer that may have other work: what fails while this computer was busy is tried again
//! with none of the others beside it; what fails while it was not has failed.

use std::fmt;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{PoisonError, RwLock};
use std::thread;
use std::time::{Duration, Instant};

/// How often the thread beside the test wakes.
const NAP: Duration = Duration::from_millis(5);
/// Woken so much later, the computer stalled.
const STALL: Duration = Duration::from_millis(100);
/// So much of the time some program waited for a processor: a hand, its wire and what moves it are late in turn, though none by much.
const BUSY_SHARE: f64 = 0.3;
const ATTEMPTS: usize = 4;

/// Shared by the tests that run side by side; exclusive to one that needs the processors for itself.
static PROCESSORS: RwLock<()> = RwLock::new(());

/// How busy this computer was during a test.
#[derive(Debug, Clone, Copy, Default)]
struct Load {
    /// By how much a thread beside the test woke late at most.
    stall: Duration,
    /// The share of the time in which some program waited for a processor; 0 where the kernel does not say.
    waited: f64,
}

impl Load {
    fn is_busy(self) -> bool {
        self.stall >= STALL || self.waited >= BUSY_SHARE
    }
}

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = self.waited * 100.0;
        write!(
            f,
            "woke late by {:?}, programs waited {percent:.0} % of the time",
            self.stall
        )
    }
}

/// The time in which some program waited for a processor, since the computer started (Linux: pressure stall information).
fn waited() -> Duration {
    let text = fs::read_to_string("/proc/pressure/cpu").unwrap_or_default();
    let total = text
        .lines()
        .next()
        .and_then(|some| some.split_once("total="));
    let micros = total.and_then(|(_, total)| total.trim().parse().ok());
    Duration::from_micros(micros.unwrap_or(0))
}

/// Does it, and measures beside it how busy this computer is.
fn with_load<R>(doing: impl FnOnce() -> R) -> (R, Load) {
    let is_done = AtomicBool::new(false);
    let (began, waited_before) = (Instant::now(), waited());
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
        let waited = waited().saturating_sub(waited_before);
        let load = Load {
            stall: beside.join().unwrap(),
            waited: waited.as_secs_f64() / began.elapsed().as_secs_f64(),
        };
        (done, load)
    })
}

/// Runs the test; up to three times more while it panics and this computer was busy meanwhile. Calls do not nest.
pub(crate) fn unless_busy<R>(doing: impl FnMut() -> R) -> R {
    let shared = PROCESSORS.read().unwrap_or_else(PoisonError::into_inner);
    retried(shared, measured(doing))
}

/// The same for a test that needs all processors, such as one that compares what two windows draw.
pub(crate) fn alone<R>(doing: impl FnMut() -> R) -> R {
    let exclusive = PROCESSORS.write().unwrap_or_else(PoisonError::into_inner);
    retried(exclusive, measured(doing))
}

/// One attempt of a test, with the load during it.
fn measured<R>(mut doing: impl FnMut() -> R) -> impl FnMut() -> (thread::Result<R>, Load) {
    move || with_load(|| catch_unwind(AssertUnwindSafe(&mut doing)))
}

/// Repeats an attempt, with the processors for itself. `first` is its share of them in the first attempt.
fn retried<R>(first: impl Sized, mut attempt: impl FnMut() -> (thread::Result<R>, Load)) -> R {
    let mut tried = attempt();
    drop(first);
    for _ in 1..ATTEMPTS {
        let (done, load) = &tried;
        if done.is_ok() || !load.is_busy() {
            break;
        }
        println!("this computer was busy ({load}): tried again");
        let _alone = PROCESSORS.write().unwrap_or_else(PoisonError::into_inner);
        tried = attempt();
    }
    tried.0.unwrap_or_else(|panic| resume_unwind(panic))
}

#[test]
fn what_fails_is_tried_again_only_after_a_busy_time() {
    let stalled = Load {
        stall: STALL,
        ..Load::default()
    };
    let waited = Load {
        waited: 0.9,
        ..Load::default()
    };
    for (load, wanted) in [
        (Load::default(), 1),
        (stalled, ATTEMPTS),
        (waited, ATTEMPTS),
    ] {
        let mut attempts = 0;
        let failed = catch_unwind(AssertUnwindSafe(|| {
            retried((), || {
                attempts += 1;
                (Err::<(), _>(Box::new("it fails")), load)
            });
        }));
        assert!(failed.is_err());
        assert_eq!(attempts, wanted, "{load}");
    }
    assert_eq!(unless_busy(|| 7), 7);
}
