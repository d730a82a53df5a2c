//! `record`: records everything that a hand reports into a file, until the time is up or the user ends it. Writes nothing to the
//! hand.

use crate::app::env::day_folder;
use crate::cli::out::failure::FailureKind;
use crate::cli::out::file::check_new_file;
use crate::cli::out::{Out, notify};
use crate::cli::parse::seconds;
use crate::cli::recordings::recording_file::add_files;
use crate::cli::session;
use crate::hand::kinematics::Side;
use crate::link::entries;
use crate::link::{Clock, LinkHandle, PollRates};
use crate::params::file::ParamsFile;
use crate::record::file::recorder::RecorderInput;
use crate::record::file::{
    Opening, PART_LENGTH, Recorder, RecorderStatus, RecordingFile, RecordingPlan, SystemDisk,
};
use crate::record::{Entry, Event, EventKind};
use crate::shell::interrupt::Interrupt;
use crate::store::calendar;
use crate::tasks::read;
use crate::transport::Endpoint;
use anyhow::{Context as _, anyhow};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{sleep, timeout};

/// Polling interval of the recorder and the link.
const POLL_INTERVAL: Duration = Duration::from_millis(200);
/// Maximum time to read the persistent parameters; after it the recording omits them.
const PARAMETERS_TIMEOUT: Duration = Duration::from_secs(10);
/// Maximum time until the first bytes are on the disk.
const FILE_TIMEOUT: Duration = Duration::from_secs(3);
/// Maximum time until a closed link has ended.
const LINK_END_TIMEOUT: Duration = Duration::from_secs(2);

#[derive(Debug, clap::Args)]
pub(crate) struct RecordArgs {
    /// The hand to record
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    hand: Endpoint,
    /// Seconds to record [default: until Ctrl-C]
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Option<Duration>,
    /// The file [default: Handscope/<day>/<time>-<hand>.mcap in your documents folder]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Read as fast as the wire allows, instead of 100 states and 30 touch sweeps a second
    #[arg(long)]
    full_rate: bool,
}

/// Records. The last line of the output is one JSON object of statistics.
pub(crate) async fn run(out: &mut Out, args: &RecordArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let clock = Clock::start();
    let moments = (clock.now(), calendar::since_1970());
    let opening = Opening::begin(args.hand.to_string(), moments, Side::Right)
        .with_newtons(session::newtons_per_g(&args.hand));
    let path = path(args, &opening)?;
    let rates = if args.full_rate {
        PollRates::FULL
    } else {
        PollRates::default()
    };
    let link = session::open(&args.hand, rates, clock);
    let observed = link.observe();
    tokio::select! {
        biased;
        () = interrupt.wished() => {
            let words = format!("ended before {} answered; nothing was recorded", args.hand);
            return Err(FailureKind::Interrupted.error(words));
        }
        answered = session::answered(&link, &args.hand) => answered?,
    }
    let recorder = Recorder::start(RecordingPlan {
        path: path.clone(),
        opening,
        disk: Arc::new(SystemDisk),
        part_length: PART_LENGTH,
    })
    .context("cannot start the recorder")?;
    let input = recorder.input();
    let pump = tokio::spawn(entries::record(observed, input.clone(), clock));
    let length = async {
        match args.length {
            Some(length) => sleep(length).await,
            None => std::future::pending().await,
        }
    };
    let done = {
        let mut recording = pin!(async {
            begun(&recorder, &path).await?;
            notify(&format!("recording {} to {}", args.hand, path.display()));
            record_parameters(&link, &args.hand, &input, clock).await;
            watch(&recorder, &link, &args.hand).await
        });
        tokio::select! {
            biased;
            () = interrupt.wished() => Ok(()),
            () = length => Ok(()),
            done = &mut recording => done,
        }
    };
    let status = link.status();
    let lost = session::trouble(&status).map(|trouble| {
        FailureKind::LinkLost.error(format!(
            "the link to {} is lost: {trouble}; the recording ends before that",
            args.hand
        ))
    });
    drop(link);
    let _ended = timeout(LINK_END_TIMEOUT, pump).await;
    let done = done.and(lost.map_or(Ok(()), Err));
    finish(out, &path, &recorder.end(), done)
}

/// Path of the new file.
fn path(args: &RecordArgs, opening: &Opening) -> anyhow::Result<PathBuf> {
    if let Some(path) = &args.out {
        check_new_file(path, "--out")?;
        return Ok(path.clone());
    }
    let documents = day_folder::documents().context(
        "there is no documents folder to put the recording into; name a file with --out",
    )?;
    let began = opening.began_since_1970();
    let folder = day_folder::of_day(&documents, &calendar::day(began));
    let name = opening.file_name(&calendar::stamp(began));
    Ok(day_folder::free_path(&folder, &name))
}

/// Waits for the first bytes on the disk.
async fn begun(recorder: &Recorder, path: &Path) -> anyhow::Result<()> {
    let there = async {
        loop {
            let status = recorder.status();
            if let Some(trouble) = status.trouble {
                return Err(cannot_write(path, &trouble));
            }
            if status.bytes > 0 {
                return Ok(());
            }
            sleep(Duration::from_millis(10)).await;
        }
    };
    let slow = |_| cannot_write(path, "the disk does not answer");
    timeout(FILE_TIMEOUT, there).await.map_err(slow)?
}

fn cannot_write(path: &Path, trouble: &str) -> anyhow::Error {
    FailureKind::File.error(format!(
        "cannot write {}: {trouble}; choose another place with --out",
        path.display()
    ))
}

/// Records the hand's persistent parameters, if they can be read.
pub(crate) async fn record_parameters(
    link: &LinkHandle,
    hand: &Endpoint,
    input: &RecorderInput,
    clock: Clock,
) {
    let rows = timeout(PARAMETERS_TIMEOUT, read::rows(link, |_, _| ())).await;
    let Some(rows) = rows.ok().filter(|rows| !rows.params.is_empty()) else {
        return;
    };
    let file = ParamsFile {
        hand: hand.to_string(),
        at: calendar::stamp(calendar::since_1970()),
        why: "recording".into(),
        params: rows.params,
        ..ParamsFile::default()
    };
    input.push(Entry::Event(Event {
        at: clock.now(),
        kind: EventKind::Parameters,
        words: file.to_toml(),
    }));
}

/// Reports failures of the disk or the hand, and their recovery, once each. Never ends by itself.
async fn watch(recorder: &Recorder, link: &LinkHandle, hand: &Endpoint) -> anyhow::Result<()> {
    let (mut reporter, mut lost) = (FileReporter::default(), None);
    loop {
        sleep(POLL_INTERVAL).await;
        reporter.report(recorder);
        let status = link.status();
        let trouble = session::trouble(&status).map(ToString::to_string);
        if lost != trouble && (trouble.is_some() || status.state.is_live()) {
            notify(&match &trouble {
                Some(trouble) => format!("link to {hand} lost: {trouble}; trying again"),
                None => "the hand answers again".to_owned(),
            });
            lost = trouble;
        }
    }
}

/// The reported status of the file being written.
#[derive(Default)]
pub(crate) struct FileReporter {
    trouble: Option<String>,
    notices: usize,
}

impl FileReporter {
    /// Reports changes: the file was moved or removed, writing fails, or works again.
    pub(crate) fn report(&mut self, recorder: &Recorder) {
        let RecorderStatus {
            trouble, notices, ..
        } = recorder.status();
        for notice in notices.iter().skip(self.notices) {
            notify(&notice.to_string());
        }
        self.notices = notices.len();
        let trouble = trouble.map(|trouble| trouble.to_string());
        if self.trouble != trouble {
            notify(&match &trouble {
                Some(trouble) => {
                    format!("the recording cannot be written: {trouble}; trying again")
                }
                None => "the recording is written again".to_owned(),
            });
            self.trouble = trouble;
        }
    }
}

/// Reads the file back and reports its contents, even if the recording failed.
fn finish(
    out: &mut Out,
    asked: &Path,
    status: &RecorderStatus,
    done: anyhow::Result<()>,
) -> anyhow::Result<()> {
    let path = status.path.as_deref().unwrap_or(asked);
    let written = match (&status.trouble, status.ended) {
        (Some(trouble), _) => Err(cannot_write(path, trouble)),
        (None, false) => Err(anyhow!(
            "{} was not ended: the disk does not take its last bytes; 'handscope recover' repairs it",
            path.display()
        )),
        (None, true) => Ok(()),
    };
    let file = RecordingFile::open(path)
        .map_err(|error| anyhow!("cannot read {} back: {error}", path.display()));
    let object = statistics(path, file.as_ref().ok(), status);
    // The cause of the failure is more informative than an unreadable or empty file.
    let failed = done.and(written).and(file.and_then(|file| {
        if file.overview().counts.states > 0 {
            return Ok(());
        }
        Err(anyhow!(
            "no state of the hand was read: {} holds none",
            path.display()
        ))
    }));
    let printed = out.object(&object);
    failed.and(printed)
}

/// Statistics of the file; `null` where it cannot be read.
fn statistics(path: &Path, file: Option<&RecordingFile>, status: &RecorderStatus) -> Value {
    let counts = file.map(|file| file.overview().counts);
    let length = file.map(|file| file.last().since(file.first()).as_secs_f64());
    let mut object = json!({
        "file": file.map_or(path, RecordingFile::path),
        "length_s": length,
        "states": counts.map(|counts| counts.states),
        "touch_sweeps": counts.map(|counts| counts.touch_sweeps()),
        "writes": counts.map(|counts| counts.writes),
        "faults": counts.map(|counts| counts.faults),
        "missing": status.missing,
        "bytes": status.bytes + status.earlier_bytes,
        "mb_per_hour": status.megabytes_an_hour(),
        "closed": file.is_some_and(RecordingFile::is_closed),
    });
    add_files(&mut object, file);
    object
}
