//! The command line as scripts meet it: the real program in processes of its own, on loopback and pseudo-terminals only.

#[cfg(unix)]
mod can;
#[cfg(unix)]
mod check;
mod consent;
#[cfg(unix)]
mod cut_short;
mod datagrams;
#[cfg(unix)]
mod doctor;
#[cfg(unix)]
mod doors;
#[cfg(unix)]
mod exports;
mod failures;
#[cfg(target_os = "linux")]
mod follow;
#[cfg(unix)]
mod grip;
#[cfg(unix)]
mod hold;
mod inputs;
#[cfg(unix)]
mod interop;
#[cfg(unix)]
mod loss;
#[cfg(unix)]
mod no_result;
#[cfg(unix)]
mod of_others;
#[cfg(target_os = "linux")]
mod outputs;
#[cfg(unix)]
mod overshoot;
mod params;
mod pictures;
#[cfg(unix)]
mod quirks;
#[cfg(unix)]
mod recordings;
#[cfg(unix)]
mod report;
mod ros2;
#[cfg(unix)]
mod scale;
#[cfg(unix)]
mod scan;
#[cfg(unix)]
mod several;
#[cfg(unix)]
mod trial;
#[cfg(unix)]
mod tune;
#[cfg(unix)]
mod tune_close;
mod usage;
#[cfg(unix)]
mod web_page;
mod wire;
#[cfg(unix)]
mod wires;

/// A command that moves a hand is refused without `--arm` in one sentence, and nothing is written.
#[cfg(unix)]
fn refuses_unarmed(hand: &str, args: &[&str]) {
    use crate::setup::process::run;
    let ended = run(args);
    assert_eq!(ended.code, Some(1));
    assert!(ended.err.contains("nothing was moved") && ended.err.contains("--arm"));
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    let watched = run(&["watch", "--hand", hand, "--json", "--for", "0.2"]).ok();
    assert_eq!(watched.lines().last().unwrap()["stats"]["writes"], 0);
}

/// A command that moves a hand, whose output is closed after its first line: it stops the hand, says why, and fails.
#[cfg(unix)]
fn stops_unread(args: &[&str]) {
    use crate::setup::process::take_pipe;
    use std::io::{BufRead as _, BufReader, Read as _};
    let (mut child, out) = take_pipe(args);
    let mut lines = BufReader::new(out).lines();
    lines.next().unwrap().unwrap();
    drop(lines);
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let mut said = String::new();
    let mut messages = child.stderr.take().unwrap();
    messages.read_to_string(&mut said).unwrap();
    let words = "the output is no longer read; stopped: feedback shows rest";
    assert!(said.contains(words), "{said}");
}
