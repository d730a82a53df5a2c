//! `doctor` against simulated hands in another process.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, run, sim_on_all, start};
use nix::sys::signal::Signal;
use serde_json::Value;

/// A process that gets no processor for 50 ms is a timeout, and this machine has other work: of a few looks one is well.
const RUNS: usize = 4;

fn well(args: &[&str]) -> Ended {
    let mut last = String::new();
    for _ in 0..RUNS {
        let ended = run(args);
        if ended.code == Some(0) {
            return ended;
        }
        last = format!("{}{}", ended.out, ended.err);
    }
    panic!("{args:?}: {last}");
}

#[test]
fn a_healthy_hand_is_called_so_on_each_wire_and_the_figures_add_up() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = sim_on_all(folder.path(), &[]);
        for hand in wires.all() {
            let ended = well(&["doctor", "--for", "0.5", "--json", "--hand", hand]);
            let told = ended.lines().remove(0);
            assert_eq!(
                (&told["well"], &told["answers"]),
                (&true.into(), &true.into())
            );
            assert_eq!(told["adapter_echoes"], false);
            assert_eq!(told["other_controller"], false);
            let windows = told["windows"].as_array().unwrap();
            assert_eq!(windows.len(), 5);
            for window in windows {
                let reads = window["reads"].as_u64().unwrap();
                let counts = window["histogram"]["counts"].as_array().unwrap();
                let sum: u64 = counts.iter().map(|count| count.as_u64().unwrap()).sum();
                assert!(reads > 0 && sum == reads, "{hand}: {window}");
                let rtt = |key: &str| window["rtt_ms"][key].as_f64().unwrap();
                assert!(
                    rtt("min") <= rtt("p50")
                        && rtt("p50") <= rtt("p99")
                        && rtt("p99") <= rtt("max")
                );
                assert_eq!(window["line_hz"].is_null(), hand.starts_with("tcp:"));
            }
            let place = if hand.starts_with("tcp:") {
                "network"
            } else {
                "port"
            };
            assert!(told[place].is_object(), "{told}");
            if cfg!(target_os = "linux") {
                assert_eq!(
                    told["network"]["interface"],
                    if place == "network" {
                        "lo".into()
                    } else {
                        Value::Null
                    }
                );
            }
        }
    });
}

#[test]
fn the_text_has_a_verdict_and_the_hand_is_only_read() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = sim_on_all(folder.path(), &[]);
        for hand in [&wires.tcp, &wires.rs485, "sim:"] {
            let text = well(&["doctor", "--for", "0.3", "--hand", hand]).out;
            for part in [
                "round trips, ms",
                "motion state",
                "the line alone",
                "all is well",
            ] {
                assert!(text.contains(part), "{text}");
            }
        }
    });
}

#[test]
fn what_is_wrong_is_told_in_both_forms_and_by_the_exit_status() {
    unless_busy(|| {
        let text = run(&["doctor", "--hand", "rs485:/no/such/port"]);
        assert_eq!(text.code, Some(1));
        assert!(text.out.contains("WRONG"), "{}", text.out);
        assert!(text.err.contains("one thing is wrong"), "{}", text.err);
        let json = run(&["doctor", "--json", "--hand", "rs485:/no/such/port"]);
        assert_eq!(json.code, Some(1));
        let told = json.lines().remove(0);
        assert_eq!(
            (&told["well"], &told["answers"]),
            (&false.into(), &false.into())
        );
        assert!(told["error"].as_str().unwrap().contains("is not there"));
        assert_eq!(told["findings"][0]["wrong"], true);
        assert_eq!(run(&["doctor"]).code, Some(2));
        assert_eq!(run(&["doctor", "--hand", "nonsense"]).code, Some(2));
    });
}

#[test]
fn ctrl_c_ends_the_look_early_and_shows_what_was_measured() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = sim_on_all(folder.path(), &[]);
        let doctor = start(&["doctor", "--for", "3600", "--json", "--hand", &wires.rs485]);
        std::thread::sleep(std::time::Duration::from_millis(800));
        doctor.signal(Signal::SIGINT);
        let ended = doctor.end();
        let told = ended.lines().remove(0);
        assert_eq!(told["answers"], true, "{told}");
        assert!(told["windows"][0]["reads"].as_u64().unwrap() > 0, "{told}");
    });
}
