//! How fast the program is, as a table of figures and aims: `cargo bench`, or `cargo bench -- WORD` for a part.
//! A figure that misses its aim is told, and fails nothing: machines differ.

mod check;
mod clock;
mod codec;
mod cycles;
mod fleet;
mod foxglove;
mod frames;
#[cfg(unix)]
mod gateway;
#[expect(clippy::cast_precision_loss, reason = "counts of grasps")]
mod grasp;
#[expect(
    clippy::cast_possible_truncation,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    reason = "forces of a hand; the simulated hand answers, or the bench has no meaning"
)]
mod grasp_table;
#[expect(clippy::cast_precision_loss, reason = "counts of grasps")]
mod grip;
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::unwrap_used,
    reason = "figures of a model, within what a hand reads"
)]
mod grip_model;
#[expect(
    clippy::cast_precision_loss,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    reason = "counts of grasps in a square table by state; the simulated hand answers, or the bench has no meaning"
)]
mod grip_table;
mod hand;
mod hands;
#[expect(clippy::cast_precision_loss, reason = "counts of holds")]
mod hold;
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::unwrap_used,
    reason = "counts of holds; the simulated hand answers, or the bench has no meaning"
)]
mod hold_table;
mod idle;
#[cfg(unix)]
mod line;
mod memory;
#[expect(clippy::cast_precision_loss, reason = "counts of objects")]
mod object;
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    reason = "counts of objects; the simulated hand answers, or the bench has no meaning"
)]
mod object_table;
#[path = "../it/trials/other_hand.rs"]
#[expect(
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "it is a file of the tests, which use more of it and may stop at what is wrong"
)]
mod other_hand;
mod pictures;
mod plain;
mod press;
mod record;
mod report;
mod scene;
mod start;
mod tune;
#[path = "../it/trials/virtual_hand.rs"]
#[expect(
    dead_code,
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    reason = "it is a file of the tests, which use more of it and may stop at what is wrong"
)]
mod virtual_hand;
mod waiting;
#[path = "../it/trials/worn.rs"]
mod worn;

use crate::report::{Failure, Report};
use std::path::Path;
use std::process::ExitCode;

/// The allocator of the desktop's program.
#[cfg(feature = "desktop")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

#[cfg(not(unix))]
mod line {
    use crate::report::{Failure, Report};

    pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
        report.absent("serial lines over a pseudo-terminal", "not on this system")
    }
}

#[cfg(not(unix))]
mod gateway {
    use crate::report::{Failure, Report};

    pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
        report.absent("a shared serial line", "not on this system")
    }
}

/// One part of the table: its name, by which it can be chosen, and what measures it.
type Part = (&'static str, fn(&mut Report) -> Result<(), Failure>);

const PARTS: [Part; 22] = [
    ("codec", codec::run),
    ("cycles", cycles::run),
    ("line", line::run),
    ("gateway", gateway::run),
    ("foxglove", foxglove::run),
    ("fleet", fleet::run),
    ("ui", frames::run),
    ("hand", hand::run),
    ("grip", grip::run),
    ("hold", hold::run),
    ("grasp", grasp::run),
    ("object", object::run),
    ("png", pictures::run),
    ("start", start::run),
    ("memory", memory::run),
    ("idle", idle::run),
    ("press", press::run),
    ("waiting", waiting::run),
    ("record", record::run),
    ("several", hands::run),
    ("tune", tune::run),
    ("check", check::run),
];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word == memory::CHILD) {
        return ended(memory::child());
    }
    if let [word, endpoints @ ..] = words.as_slice()
        && word == hands::CHILD
    {
        return ended(hands::child(endpoints));
    }
    if let [.., word, path] = words.as_slice()
        && word == record::CHILD
    {
        return ended(record::child(Path::new(path)));
    }
    // Tests build benches too; only `cargo bench` says that time may be taken.
    if !words.iter().any(|word| word == "--bench") {
        return ExitCode::SUCCESS;
    }
    let wanted: Vec<&String> = words.iter().filter(|word| !word.starts_with('-')).collect();
    ended(table(&wanted))
}

fn table(wanted: &[&String]) -> Result<(), Failure> {
    let known = |word: &str| PARTS.iter().any(|(name, _)| name.contains(word));
    if let Some(word) = wanted.iter().find(|word| !known(word)) {
        let names = PARTS.map(|(name, _)| name).join(", ");
        return Err(format!("'{word}' is no part: choose of {names}").into());
    }
    let mut report = Report::begin()?;
    for (name, measure) in PARTS {
        if wanted.is_empty() || wanted.iter().any(|word| name.contains(word.as_str())) {
            measure(&mut report)?;
        }
    }
    report.end()
}

fn ended(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::complain(&failure);
            ExitCode::FAILURE
        }
    }
}
