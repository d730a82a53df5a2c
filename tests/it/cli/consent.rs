//! Whether a hand may be moved again is answered after it was asked, by a person: at a terminal, or where they said so.

use crate::cli::follow::{Sender, phase, setpoint};
use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, handscope, listen, sim_on_tcp};
use nix::pty::openpty;
use serde_json::Value;
use std::fs::File;
use std::io::{PipeWriter, Write};
use std::process::Stdio;
use std::time::Duration;

/// Follows with this standard input.
fn following(hand: &str, input: impl Into<Stdio>, more: &[&str]) -> (Running, String) {
    let args = [
        "follow",
        "--hand",
        hand,
        "--udp",
        "127.0.0.1:0",
        "--json",
        "--arm",
    ];
    let mut command = handscope();
    command.args(args).args(more).stdin(input);
    let mut running = listen(command);
    let ready = running.line();
    let place = ready.strip_prefix("ready udp ").expect(&ready).to_owned();
    (running, place)
}

fn question(line: &str) -> Value {
    serde_json::from_str::<Value>(line).unwrap()["question"].take()
}

/// A sender falls silent. What was entered before and while it was followed is no answer; what is entered then is.
fn asks_and_is_answered(hand: &str, running: &mut Running, place: &str, person: &mut impl Write) {
    let sends = Sender::start(place);
    running.until(|line| phase(line) == "following");
    person.write_all(b"yes\n\n\n").unwrap();
    drop(sends);
    running.until(|line| question(line).is_string());
    let asked = running.complaint();
    assert!(
        asked.contains("fell silent: the hand was stopped; "),
        "{asked}"
    );
    // It is told each second that it is asked, and somebody who sends meanwhile moves nothing.
    let _sends = Sender::start(place);
    let before = setpoint(hand);
    for _ in 0..2 {
        let line = running.line();
        assert_eq!(phase(&line), "waiting", "{line}");
        assert!(
            question(&line).as_str().unwrap().contains("fell silent"),
            "{line}"
        );
    }
    assert_eq!(setpoint(hand), before);
    person.write_all(b"\n").unwrap();
    let told = running.until(|line| phase(line) == "following");
    assert_eq!(question(&told), Value::Null);
}

#[test]
fn an_enter_that_was_typed_before_the_question_is_no_consent() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let terminal = openpty(None, None).unwrap();
        let mut person = File::from(terminal.master);
        let (mut running, place) = following(&hand, terminal.slave, &[]);
        person.write_all(b"\n\n").unwrap();
        asks_and_is_answered(&hand, &mut running, &place, &mut person);
    });
}

#[test]
fn a_program_answers_over_standard_input_only_if_a_person_said_so_and_each_question_anew() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let (input, mut person) = std::io::pipe().unwrap();
        let (mut running, place) = following(&hand, input, &["--consent", "stdin"]);
        asks_and_is_answered(&hand, &mut running, &place, &mut person);
        running.until(|line| question(line).is_string());
        drop(person);
        let ended = running.end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(
            ended.err.contains("ended without an answer"),
            "{}",
            ended.err
        );
    });
}

/// Enters lines for as long as somebody reads.
fn always(mut to: PipeWriter) {
    std::thread::spawn(move || while to.write_all(&[b'\n'; 512]).is_ok() {});
}

#[test]
fn lines_that_come_whether_one_is_asked_or_not_are_no_consent() {
    unless_busy(|| {
        for (more, words) in [
            (&[][..], "no terminal here to ask for consent"),
            (&["--consent", "stdin"], "does not pause"),
        ] {
            let (input, person) = std::io::pipe().unwrap();
            always(person);
            let (mut running, place) = following("sim:?scenario=free", input, more);
            let sends = Sender::start(&place);
            running.until(|line| phase(line) == "following");
            drop(sends);
            let ended = running.end();
            assert_eq!(ended.code, Some(1), "{}", ended.err);
            assert!(
                ended.err.contains("fell silent: the hand was stopped"),
                "{}",
                ended.err
            );
            assert!(ended.err.contains(words), "{}", ended.err);
            assert!(ended.took > Duration::from_secs(1));
        }
    });
}
