//! What could not be tried on this machine.

use std::io::Write as _;
use std::path::Path;

/// Says that something was not tried, in the one form that `.ci/run` looks for. It goes past the test harness, which keeps
/// what a passing test prints.
pub(crate) fn skipped(what: &str, why: &str) {
    let line = format!("skipped: {what}: {why}\n");
    std::io::stderr().write_all(line.as_bytes()).unwrap();
}

/// The CAN interface to try, if there is one.
pub(crate) fn can_interface() -> Option<&'static str> {
    let there = Path::new("/sys/class/net/vcan0").exists();
    if !there {
        skipped("SocketCAN", "this machine has no vcan0");
    }
    there.then_some("vcan0")
}
