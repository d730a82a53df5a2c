//! What each task sends to the hand and receives from it, on each wire, with everything that may go wrong: recorded once in
//! `tests/it/journal/*.txt`, and compared on demand: `JOURNAL=compare` compares, `JOURNAL=renew` records anew, `JOURNAL=strict` gives no second chance to a
//! case in real time, `JOURNAL_CASE=words` runs the cases with these words in their titles.

mod command;
mod line;
mod page;
mod window;

use crate::journal::page::{Case, Outcome, cases, difference};
use crate::setup::skipped::skipped;
use std::path::PathBuf;
use std::sync::Mutex;
use std::thread;

/// A process that gets no processor for 50 ms is a timeout, and machines have other work: of a few runs one is undisturbed.
const RUNS: usize = 6;

fn mode() -> String {
    std::env::var("JOURNAL").unwrap_or_default()
}

/// Runs a case on one wire.
type Run = fn(&Case, &str) -> Vec<Outcome>;

/// Only one wire that runs again at a time: it runs again because the machine is busy.
static AGAIN: Mutex<()> = Mutex::new(());

/// Runs a case on all wires at once; then again, one by one, on those where it is not well, until it is.
fn record(case: &Case, run: Run, mut is_well: impl FnMut(usize, &[Outcome]) -> bool) -> String {
    let mut outcomes: Vec<Vec<Outcome>> = thread::scope(|scope| {
        let runs = case.wires.iter();
        let runs: Vec<_> = runs.map(|wire| scope.spawn(|| run(case, wire))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    for (at, outcome) in outcomes.iter_mut().enumerate() {
        for _ in 0..RUNS {
            if is_well(at, outcome) {
                break;
            }
            let _alone = AGAIN.lock();
            *outcome = run(case, &case.wires[at]);
        }
    }
    case.page(&outcomes)
}

/// The page as it is recorded where two runs of each wire are alike.
fn renewed(case: &Case, run: Run) -> String {
    let mut earlier: Vec<Vec<Vec<Outcome>>> = vec![Vec::new(); case.wires.len()];
    let mut alike = 0;
    let page = record(case, run, |wire, outcome| {
        let is_known = earlier[wire].iter().any(|other| *other == outcome);
        earlier[wire].push(outcome.to_vec());
        alike += usize::from(is_known);
        is_known
    });
    assert_eq!(alike, case.wires.len(), "{}: runs differ", case.title);
    page
}

/// The page as it is recorded where each wire is as it was, if it ever is.
fn compared(case: &Case, stored: &str, run: Run) -> String {
    let wires = case.wires.iter();
    let stored: Vec<_> = wires.map(|wire| case.stored(stored, wire)).collect();
    let is_strict = mode() == "strict";
    record(case, run, |wire, outcome| {
        let lines: Vec<_> = outcome.iter().map(Outcome::lines).collect();
        is_strict || lines == stored[wire]
    })
}

/// Runs all cases of a journal and compares them with what stands there.
fn check(name: &str, run: Run) {
    if mode().is_empty() {
        skipped(
            &format!("journal {name}"),
            "it takes minutes: JOURNAL=compare tries it",
        );
        return;
    }
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/it/journal/{name}.txt"));
    let text = std::fs::read_to_string(&path).unwrap();
    let only = std::env::var("JOURNAL_CASE").unwrap_or_default();
    let mut parts = text.split("\n== ");
    let mut pages = vec![format!("{}\n", parts.next().unwrap().trim_end())];
    let mut differences = Vec::new();
    for (case, part) in cases(&text).iter().zip(parts) {
        let stored = format!("== {}\n", part.trim_end());
        let page = match mode().as_str() {
            _ if !case.title.contains(&only) => stored.clone(),
            "renew" => renewed(case, run),
            _ => compared(case, &stored, run),
        };
        if page != stored {
            differences.push(difference(&stored, &page));
        }
        pages.push(page);
    }
    if mode() == "renew" {
        std::fs::write(path, pages.join("\n")).unwrap();
    } else {
        assert!(
            differences.is_empty(),
            "{name}:\n{}",
            differences.join("\n")
        );
    }
}

macro_rules! journals {
    ($($test:ident $name:literal $run:path)+) => {
        $(#[test]
        fn $test() {
            check($name, $run);
        })+
    };
}

journals! {
    the_command_line_reads "cli-read" command::run
    the_command_line_applies "cli-apply" command::run
    the_command_line_changes_where_a_hand_is_found "cli-place" command::run
    the_command_line_saves_and_resets "cli-flash" command::run
    the_command_line_tries "cli-trial" command::run
    the_window_reads_and_applies "window-params" window::run
    the_window_saves "window-save" window::run
    the_window_changes_where_a_hand_is_found "window-place" window::run
    the_window_resets_and_calibrates "window-guard" window::run
    the_window_moves "window-motion" window::run
    the_window_tries "window-trial" window::run
}
