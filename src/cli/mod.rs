//! The command line: one module per command, which carries it out and reports the outcome.

mod about;
mod args;
mod check;
mod consent;
mod doctor;
mod grip;
mod guard;
mod hold;
mod inputs;
mod listen;
mod out;
mod params;
mod parse;
mod quirks;
mod read;
mod recordings;
mod report;
mod scale;
mod scan;
mod session;
mod share;
mod sim;
mod trial;
mod tune;
mod value;
mod watch;
mod window;
mod wires;

use crate::link::guard::{hold_all, holder};
use anyhow::Context as _;
use args::{Cli, CliCommand};
use clap::{CommandFactory as _, Parser as _};
use out::Out;
use out::failure::{FailureForm, FailureKind};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use tokio::runtime::Builder;

/// Runs the command line. Errors are printed to standard error as one sentence each, with `--json` as one JSON object.
///
/// The exit status is 0 when done, 1 on failure, 2 on wrong usage.
pub fn run() -> ExitCode {
    let form = FailureForm::requested(std::env::args_os());
    let Cli { command, window } = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(said) => form.end_of_parse(&said),
    };
    holder::use_this_program(out::notify);
    report_panics(form);
    let done = catch_unwind(AssertUnwindSafe(|| match command {
        None => has_room_for_files().and_then(|()| window::run(window)),
        Some(command) => execute(command),
    }));
    let status = match done {
        Ok(done) => form.status(done),
        // The panic hook has reported it.
        Err(_panic) => ExitCode::FAILURE,
    };
    out::finish_messages();
    status
}

/// Installs the panic hook: a panic on any thread stops each hand that may move, and is reported in one sentence, with a backtrace
/// if requested.
fn report_panics(form: FailureForm) {
    let default = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        hold_all();
        if std::env::var_os("RUST_BACKTRACE").is_some() {
            default(panic);
        }
        let place = panic.location().map(ToString::to_string);
        let (place, words) = (place.unwrap_or_default(), panic.payload_as_str());
        let words = words.unwrap_or("no words").replace('\n', " ");
        let words = format!(
            "internal error, please report it ({place}: {words}); each hand that it moved is being stopped"
        );
        form.report(FailureKind::Internal, &words);
    }));
}

fn execute(command: CliCommand) -> anyhow::Result<()> {
    if let CliCommand::Guard(args) = command {
        // Before any thread is started: the threads of this process must inherit its signal mask.
        return if guard::is_needed() {
            wait_for(guard::run(&args))
        } else {
            Ok(())
        };
    }
    let mut out = Out::stdout()?;
    if matches!(command, CliCommand::Snapshot(_) | CliCommand::Exhibit(_)) {
        has_room_for_files()?;
    }
    let done = match command {
        CliCommand::Snapshot(args) => window::snapshot::run(&mut out, &args),
        CliCommand::Watch(args) => wait_for(watch::run(&mut out, &args)),
        CliCommand::Read(args) => wait_for(read::run(&mut out, &args)),
        CliCommand::Scan(args) => wait_for(scan::run(&mut out, &args)),
        CliCommand::Doctor(args) => wait_for(doctor::run(&mut out, &args)),
        CliCommand::Report(args) => wait_for(report::run(&mut out, &args)),
        CliCommand::Quirks(args) => wait_for(quirks::run(&mut out, &args)),
        CliCommand::Params(args) => wait_for(params::run(&mut out, &args)),
        CliCommand::Inputs(args) => wait_for(inputs::show::run(&mut out, &args)),
        CliCommand::Exhibit(args) => window::exhibit::run(&mut out, args),
        CliCommand::Trial(args) => wait_for(trial::run(&mut out, &args)),
        CliCommand::Check(args) => wait_for(check::run(&mut out, &args)),
        CliCommand::Tune(args) => wait_for(tune::run(&mut out, &args)),
        CliCommand::Overshoot(args) => trial::overshoot::run(&mut out, &args),
        CliCommand::Model(args) => about::model::run(&mut out, &args),
        CliCommand::Ros2(args) => about::ros2::run(&mut out, &args),
        CliCommand::Completions(args) => {
            about::packaging::completions(&mut out, &args, Cli::command())
        }
        CliCommand::Man(args) => about::packaging::man(&mut out, &args, Cli::command()),
        CliCommand::Grip(args) => wait_for(grip::run(&mut out, &args)),
        CliCommand::Hold(args) => wait_for(hold::run(&mut out, &args)),
        CliCommand::Scale(args) => wait_for(scale::run(&mut out, &args)),
        CliCommand::Follow(args) => wait_for(inputs::follow::run(&mut out, &args)),
        CliCommand::Record(args) => wait_for(recordings::record::run(&mut out, &args)),
        CliCommand::Info(args) => recordings::info::run(&mut out, &args),
        CliCommand::Export(args) => recordings::export::run(&mut out, &args),
        CliCommand::Recover(args) => recordings::export::recover(&mut out, &args),
        CliCommand::Import(args) => recordings::import::run(&mut out, &args),
        CliCommand::Replay(args) => wait_for(recordings::replay::run(&mut out, &args)),
        CliCommand::Fleet(args) => wait_for(share::fleet::run(&mut out, &args)),
        CliCommand::Share(args) => wait_for(share::run(&mut out, &args)),
        CliCommand::Sim(args) => wait_for(sim::run(&mut out, &args)),
        CliCommand::Registers(args) => about::registers::run(&mut out, args.json),
        CliCommand::Guard(_) => Ok(()),
        CliCommand::Help(args) => about::help::run(&mut out, &args, Cli::command()),
    };
    // Output written before a failure is shown as well.
    let shown = out.finish();
    done.and(shown)
}

/// Minimum number of files, sockets and timers for a runtime and a command. A runtime that cannot open its own reports no clear
/// error.
#[cfg(unix)]
const FILES_NEEDED: usize = 16;

/// Fails if this number of additional files cannot be opened.
#[cfg(unix)]
fn has_room_for_files() -> anyhow::Result<()> {
    let opened = || std::fs::File::open("/dev/null");
    let opened: std::io::Result<Vec<_>> = (0..FILES_NEEDED).map(|_| opened()).collect();
    match opened {
        Ok(_all) => Ok(()),
        Err(error) => Err(anyhow::anyhow!(
            "cannot start: the limit on open files is too low ({error}); raise it with 'ulimit -n 1024'"
        )),
    }
}

/// There is no such limit here.
#[cfg(not(unix))]
fn has_room_for_files() -> anyhow::Result<()> {
    Ok(())
}

/// Runs a command on a single-threaded runtime. Nothing on it waits for a disk or a reader of the output.
fn wait_for(command: impl Future<Output = anyhow::Result<()>>) -> anyhow::Result<()> {
    has_room_for_files()?;
    let runtime = Builder::new_current_thread().enable_all().build();
    let runtime = runtime.context("cannot start the runtime")?;
    crate::link::priority::raise();
    let done = runtime.block_on(command);
    // Name resolution in progress cannot be cancelled, and must not delay the exit.
    runtime.shutdown_background();
    done
}
