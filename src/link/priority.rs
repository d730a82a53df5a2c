//! The priority of the thread that links run on. The system may refuse it; only the doctor reports that.

use std::sync::atomic::{AtomicBool, Ordering};

/// Requested nice value: ahead of compilers and browsers, behind everything that the system needs.
#[cfg(target_os = "linux")]
const NICE: i32 = -10;

static IS_RAISED: AtomicBool = AtomicBool::new(false);

/// Requests a higher priority for the calling thread, on which links will run.
pub fn raise() {
    IS_RAISED.store(try_raise(), Ordering::Relaxed);
}

/// True if the system granted that priority.
pub fn is_raised() -> bool {
    IS_RAISED.load(Ordering::Relaxed)
}

/// On Linux, process 0 of this call is the calling thread alone.
#[cfg(target_os = "linux")]
fn try_raise() -> bool {
    rustix::process::setpriority_process(None, NICE).is_ok()
}

#[cfg(not(target_os = "linux"))]
fn try_raise() -> bool {
    false
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_is_reported_is_what_the_system_granted() {
        let thread = std::thread::spawn(|| {
            let before = rustix::process::getpriority_process(None).unwrap_or_default();
            let granted = try_raise();
            let after = rustix::process::getpriority_process(None).unwrap_or_default();
            (before, granted, after)
        });
        let (before, granted, after) = thread.join().unwrap_or_default();
        assert_eq!(after, if granted { NICE } else { before });
    }
}
