//! Hands that go away, and programs that are told to end.

use crate::setup::busy::unless_busy;
use crate::setup::process::{sim_on_link, sim_on_tcp, start};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::time::{Duration, Instant};

/// A hand that is back is seen within two seconds; the rest is for a machine with other work.
const RECOVERED: Duration = Duration::from_secs(4);

fn is_sample(line: &str) -> bool {
    line.contains("\"angle\"")
}

fn statistics(line: &str) -> Value {
    serde_json::from_str::<Value>(line).unwrap()["stats"].take()
}

#[test]
fn a_pseudo_terminal_that_was_killed_and_restarted_is_watched_again() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("hand");
        let (sim, hand) = sim_on_link(&link, &[]);
        let mut watch = start(&["watch", "--hand", &hand, "--json"]);
        watch.until(is_sample);
        sim.kill();
        let complaint = watch.complaint();
        assert!(
            complaint.contains("lost") && complaint.contains("hung up"),
            "{complaint}"
        );
        let (_sim, _) = sim_on_link(&link, &[]);
        let restarted = Instant::now();
        while !watch.complaint().contains("answers again") {}
        assert!(restarted.elapsed() < RECOVERED, "{:?}", restarted.elapsed());
        watch.until(is_sample);
        watch.signal(Signal::SIGINT);
        let ended = watch.end().ok();
        let stats = statistics(ended.out.lines().last().unwrap());
        assert!(stats["reconnects"].as_u64().unwrap() >= 1, "{stats}");
        assert_eq!(stats["writes"], 0);
    });
}

#[test]
fn a_socket_that_was_killed_and_restarted_is_watched_again() {
    unless_busy(|| {
        let (sim, hand) = sim_on_tcp(&[]);
        let address = hand.strip_prefix("tcp:").unwrap();
        let mut watch = start(&["watch", "--hand", &hand, "--json"]);
        watch.until(is_sample);
        sim.kill();
        assert!(watch.complaint().contains("lost"));
        let mut sim = start(&["sim", "--tcp", address]);
        sim.line();
        let restarted = Instant::now();
        while !watch.complaint().contains("answers again") {}
        assert!(restarted.elapsed() < RECOVERED, "{:?}", restarted.elapsed());
        watch.until(is_sample);
        watch.signal(Signal::SIGTERM);
        let ended = watch.end().ok();
        assert!(statistics(ended.out.lines().last().unwrap())["reconnects"].as_u64() >= Some(1));
    });
}

#[test]
fn ending_the_hand_removes_its_link() {
    unless_busy(|| {
        for signal in [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP] {
            let folder = tempfile::tempdir().unwrap();
            let link = folder.path().join("hand");
            let (sim, _) = sim_on_link(&link, &[]);
            assert!(link.symlink_metadata().is_ok());
            sim.signal(signal);
            sim.end().ok();
            assert!(link.symlink_metadata().is_err(), "{signal}");
        }
    });
}
