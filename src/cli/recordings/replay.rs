//! `replay`: a hand that reports recorded values, on the wires of the simulated hand.

use crate::cli::out::{Out, notify};
use crate::cli::parse::number;
use crate::cli::recordings::recording_file::{self, FileArgs, lost, report_remarks};
use crate::cli::wires::{WireArgs, failed};
use crate::hand::{Group, HandId, Moment};
use crate::params::file;
use crate::params::rows::{ParamId, Value};
use crate::params::values::span_of;
use crate::record::file::RecordingFile;
use crate::record::file::reader::{Damage, TimeRange};
use crate::record::{Entry, EventKind, Record};
use crate::shell::interrupt::Interrupt;
use crate::sim::{SharedHand, SimConfig, SimHand, SimHands};
use anyhow::{Context as _, anyhow};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep_until};

/// Capacity of the read-ahead queue: one second of a busy recording.
const AHEAD: usize = 1024;
/// Values first read within this time are available from the start: every polled register has been read by then.
const KNOWN_FROM_START: Duration = Duration::from_secs(6);

#[derive(Debug, clap::Args)]
pub(crate) struct ReplayArgs {
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    wires: WireArgs,
    /// Id of the hand [default: as recorded, else 1]
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u8).range(1..=254))]
    id: Option<u8>,
    /// So many times as fast as it was, 0.1 to 100
    #[arg(long, value_name = "TIMES", default_value = "1", value_parser = times)]
    speed: f64,
    /// Begin again at the end
    #[arg(long = "loop")]
    again: bool,
}

fn times(text: &str) -> Result<f64, String> {
    number(text, 0.1..=100.0, "a number between 0.1 and 100")
}

/// Serves the recorded hand until the recording ends, or the user ends it.
pub(crate) async fn run(out: &mut Out, args: &ReplayArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let path = &args.file.file;
    let file = Arc::new(recording_file::open(path)?);
    report_remarks(&file);
    let hands = SimHands::from(hand(&file, args.id)?);
    let wires = args.wires.serve(&hands).await?;
    out.lines(wires.iter().map(|wire| wire.ready()))?;
    out.flush()?;
    let play = async {
        loop {
            let damage = play(&file, &hands, args.speed).await?;
            if let Some(words) = lost(&damage) {
                notify(&format!("{} is damaged: {words}", path.display()));
            }
            if !args.again {
                return Ok(());
            }
        }
    };
    tokio::select! {
        biased;
        () = interrupt.wished() => Ok(()),
        error = failed(wires) => Err(error),
        done = play => done,
    }
}

/// A change of the hand.
enum ReplayStep {
    /// The memory from this address on has these contents.
    Memory(u16, Vec<u8>),
    /// The hand falls silent, or answers again.
    Silent(bool),
}

/// The hand at the start of the recording.
fn hand(file: &RecordingFile, id: Option<u8>) -> anyhow::Result<SharedHand> {
    let mut first: Vec<(u16, Vec<u8>)> = Vec::new();
    let mut recorded_id = None;
    let begin = TimeRange {
        from: Moment::ZERO,
        to: file.first().plus(KNOWN_FROM_START),
        wire: false,
    };
    let read = file.entries(begin, |entry| {
        recorded_id = recorded_id.or_else(|| hand_id(&entry));
        for step in steps(&entry) {
            if let ReplayStep::Memory(address, bytes) = step
                && !first.iter().any(|(known, _)| *known == address)
            {
                first.push((address, bytes));
            }
        }
        ControlFlow::Continue(())
    });
    read.context("cannot read the recording")?;
    let mut hand = SimHand::new(SimConfig {
        id: id.or(recorded_id).unwrap_or(HandId::MIN.get()),
        ..SimConfig::default()
    });
    hand.follow_recording();
    for (address, bytes) in first {
        hand.put_recorded(address, &bytes);
    }
    Ok(SharedHand::new(hand, Instant::now()))
}

/// Plays the recording once.
async fn play(file: &Arc<RecordingFile>, hands: &SimHands, speed: f64) -> anyhow::Result<Damage> {
    let (give, mut steps) = mpsc::channel(AHEAD);
    let reader = read_ahead(Arc::clone(file), give);
    let begun = Instant::now();
    while let Some((at, step)) = steps.recv().await {
        let after = at.since(file.first()).div_f64(speed);
        sleep_until(begun + after).await;
        hands.with_each(|hand, _| match &step {
            ReplayStep::Memory(address, bytes) => hand.put_recorded(*address, bytes),
            ReplayStep::Silent(silent) => hand.put_silent(*silent),
        });
    }
    let damage = reader.await.context("the reader of the recording ended")?;
    damage.map_err(|error| anyhow!("cannot continue reading the recording: {error}"))
}

/// Reads the file on a blocking thread, as far ahead as the queue permits.
fn read_ahead(
    file: Arc<RecordingFile>,
    give: mpsc::Sender<(Moment, ReplayStep)>,
) -> JoinHandle<std::io::Result<Damage>> {
    tokio::task::spawn_blocking(move || {
        let no_wire = TimeRange {
            wire: false,
            ..TimeRange::WHOLE
        };
        file.entries(no_wire, |entry| {
            let at = entry.at();
            for step in steps(&entry) {
                if give.blocking_send((at, step)).is_err() {
                    return ControlFlow::Break(());
                }
            }
            ControlFlow::Continue(())
        })
    })
}

fn steps(entry: &Entry) -> Vec<ReplayStep> {
    match entry {
        Entry::Heard(Record::Reading { sample, fresh }) => Group::ALL
            .into_iter()
            .filter(|group| fresh.contains(*group))
            .filter_map(|group| {
                Some(ReplayStep::Memory(
                    group.span().address,
                    sample.memory(group)?,
                ))
            })
            .collect(),
        Entry::Heard(Record::State { state, .. }) => vec![ReplayStep::Silent(!state.is_live())],
        Entry::Event(event) if event.kind == EventKind::Parameters => parameters(&event.words),
        _ => Vec::new(),
    }
}

/// Persistent parameters of the hand, except its ID, which the user chooses.
fn parameters(toml: &str) -> Vec<ReplayStep> {
    let Ok(file) = file::read(toml) else {
        return Vec::new();
    };
    let rows = file.params.iter();
    rows.filter(|(id, _)| *id != ParamId::HandId)
        .map(|(id, value)| {
            let span = span_of(id);
            let bytes = match value {
                Value::Number(number) => number.to_le_bytes(),
                Value::Address(address) => address.octets(),
            };
            let kept = bytes.iter().take(usize::from(span.len)).copied();
            ReplayStep::Memory(span.address, kept.collect())
        })
        .collect()
}

fn hand_id(entry: &Entry) -> Option<u8> {
    let Entry::Event(event) = entry else {
        return None;
    };
    let is_it = event.kind == EventKind::Parameters;
    let file = file::read(&event.words).ok().filter(|_| is_it)?;
    match file.params.get(ParamId::HandId)? {
        Value::Number(number) => u8::try_from(number)
            .ok()
            .filter(|id| (1..=254).contains(id)),
        Value::Address(_) => None,
    }
}
