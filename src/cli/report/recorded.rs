//! Recordings for a report: the newest of a hand, and a new one of the hand as it is now. Sends only reads.

use crate::cli::out::failure::FailureKind;
use crate::cli::read::read_register;
use crate::cli::recordings::record::record_parameters;
use crate::cli::session;
use crate::cli::value::value_json;
use crate::hand::kinematics::Side;
use crate::hand::register;
use crate::link::quirks::book;
use crate::link::{Clock, PollRates, entries};
use crate::record::EventKind;
use crate::record::file::{
    Opening, PART_LENGTH, Recorder, RecordingFile, RecordingPlan, SystemDisk, parts,
};
use crate::record::quirk_sheet::QuirkSheet;
use crate::store::calendar;
use crate::transport::Endpoint;
use anyhow::Context as _;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{sleep, timeout};

/// Recordings that are opened in search of faults, the newest first.
const RECORDINGS_MAX: usize = 5;
/// Faults that are listed, the newest first.
const FAULTS_MAX: usize = 100;
/// Maximum time until a closed link has ended.
const LINK_END_TIMEOUT: Duration = Duration::from_secs(2);

/// The newest recordings of this hand in a folder and its subfolders, the newest first. Unreadable files are skipped.
pub(super) fn newest(folder: &Path, hand: &Endpoint) -> Vec<RecordingFile> {
    let is_own = |file: &PathBuf| {
        let hand_of = parts::hand(file).and_then(|hand| hand.parse::<Endpoint>().ok());
        hand_of.is_some_and(|of| of.place_and_id() == hand.place_and_id())
    };
    let mut all = parts::recordings(parts::files(folder));
    all.sort_by(|one, two| two.cmp(one));
    let own = all
        .into_iter()
        .filter(|files| files.first().is_some_and(is_own));
    let opened = own.filter_map(|files| RecordingFile::open_all(&files).0);
    let mut newest: Vec<RecordingFile> = opened.take(RECORDINGS_MAX).collect();
    newest.sort_by_key(|file| std::cmp::Reverse(file.opening().began_since_1970()));
    newest
}

/// The faults in recordings, the newest first.
pub(super) fn faults(recordings: &[RecordingFile]) -> Vec<Value> {
    let of_file = |file: &RecordingFile| {
        let name = file
            .path()
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        let opening = file.opening();
        let marks = file.overview().marks.iter().rev();
        let faults = marks.filter(|mark| mark.kind == EventKind::Fault);
        let faults = faults.take(FAULTS_MAX).map(|mark| {
            let after = mark.at.since(file.first());
            json!({
                "recording": name,
                "at": calendar::stamp(opening.began_since_1970() + after),
                "after_s": after.as_secs_f64(),
                "fault": mark.words,
            })
        });
        faults.collect::<Vec<_>>()
    };
    recordings
        .iter()
        .flat_map(of_file)
        .take(FAULTS_MAX)
        .collect()
}

/// The hand as it is now.
pub(super) struct HandNow {
    /// What the hand differs in.
    pub(super) sheet: QuirkSheet,
    /// The faults that each drive reports; `None` if they could not be read.
    pub(super) faults: Option<Value>,
    /// Its recording.
    pub(super) recording: RecordingFile,
}

impl HandNow {
    /// Records the hand for this time into a new file. Writes nothing to the hand.
    pub(super) async fn record(
        hand: &Endpoint,
        length: Duration,
        path: PathBuf,
    ) -> anyhow::Result<Self> {
        let clock = Clock::start();
        let moments = (clock.now(), calendar::since_1970());
        let opening = Opening::begin(hand.to_string(), moments, Side::Right)
            .with_newtons(session::newtons_per_g(hand));
        let link = session::open(hand, PollRates::default(), clock);
        let observed = link.observe();
        session::answered(&link, hand).await?;
        let plan = RecordingPlan {
            path: path.clone(),
            opening,
            disk: Arc::new(SystemDisk),
            part_length: PART_LENGTH,
        };
        let recorder = Recorder::start(plan).context("cannot start the recorder")?;
        let input = recorder.input();
        let pump = tokio::spawn(entries::record(observed, input.clone(), clock));
        let reads = async {
            record_parameters(&link, hand, &input, clock).await;
            read_register(&link, &register::ERROR).await.ok()
        };
        let (errors, ()) = tokio::join!(reads, sleep(length));
        let sheet = book::sheet(hand, &link.status().quirks, "");
        drop(link);
        let _ended = timeout(LINK_END_TIMEOUT, pump).await;
        let status = recorder.end();
        if let Some(trouble) = status.trouble {
            let words = format!("the recording cannot be written: {trouble}");
            return Err(FailureKind::File.error(words));
        }
        Ok(Self {
            sheet,
            faults: errors.map(|bytes| value_json(&register::ERROR, &bytes)),
            recording: RecordingFile::open(&path)?,
        })
    }
}
