//! A recording made alongside another command, in the same format as `record`. Its errors are reported and do not delay the command.

use crate::cli::out::file::nothing_at;
use crate::cli::out::notify;
use crate::cli::recordings::record::{FileReporter, record_parameters};
use crate::cli::session;
use crate::hand::kinematics::Side;
use crate::link::entries;
use crate::link::{Clock, LinkHandle};
use crate::record::file::{Opening, PART_LENGTH, Recorder, RecordingPlan, SystemDisk};
use crate::store::calendar;
use crate::transport::Endpoint;
use anyhow::{Context as _, bail};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::task::{JoinHandle, spawn_blocking};
use tokio::time::{interval, timeout};

/// Polling interval of the recorder status.
const POLL_INTERVAL: Duration = Duration::from_millis(200);
/// Maximum time until a closed link has ended.
const LINK_END_TIMEOUT: Duration = Duration::from_secs(2);

/// A recording in the background, if requested.
pub(crate) struct SideRecording(Option<RunningRecording>);

struct RunningRecording {
    recorder: Arc<Recorder>,
    pump: JoinHandle<()>,
    /// Records the hand's persistent parameters, then reports the recorder status.
    beside: JoinHandle<()>,
}

impl SideRecording {
    /// Starts recording the link into a new file. Must be called within a tokio runtime.
    pub(crate) fn begin(
        path: Option<&Path>,
        link: &LinkHandle,
        hand: &Endpoint,
        side: Side,
    ) -> anyhow::Result<Self> {
        let Some(path) = path else {
            return Ok(Self(None));
        };
        nothing_at(path, "--record")?;
        let clock = link.clock();
        let moments = (clock.now(), calendar::since_1970());
        let recorder = Recorder::start(RecordingPlan {
            path: path.to_path_buf(),
            opening: Opening::begin(hand.to_string(), moments, side)
                .with_newtons(session::newtons_per_g(hand)),
            disk: Arc::new(SystemDisk),
            part_length: PART_LENGTH,
        })
        .context("cannot start the recorder")?;
        notify(&format!("recording {hand} to {}", path.display()));
        let recorder = Arc::new(recorder);
        let observed = link.observe();
        let pump = tokio::spawn(entries::record(observed, recorder.input(), clock));
        let beside = watch(Arc::clone(&recorder), link.clone(), hand.clone(), clock);
        Ok(Self(Some(RunningRecording {
            recorder,
            pump,
            beside: tokio::spawn(beside),
        })))
    }

    /// Closes the file while the link stays open.
    pub(crate) async fn end_here(self) -> anyhow::Result<()> {
        if let Some(running) = &self.0 {
            running.pump.abort();
        }
        self.end().await
    }

    /// Closes the file. Fails if it could not be written. The link must be closed first, otherwise recording continues
    /// until a timeout.
    pub(crate) async fn end(self) -> anyhow::Result<()> {
        let Some(running) = self.0 else { return Ok(()) };
        running.beside.abort();
        // The task keeps the link open.
        let _aborted = running.beside.await;
        let _ended = timeout(LINK_END_TIMEOUT, running.pump).await;
        let Some(recorder) = Arc::into_inner(running.recorder) else {
            bail!("the recording was not ended: it is still being written");
        };
        // A slow disk must not delay the hand. The task fails only at program exit.
        let status = spawn_blocking(move || recorder.end()).await;
        let status = status.context("the recording was not ended")?;
        if let Some(trouble) = status.trouble {
            bail!("the recording cannot be written: {trouble}");
        }
        if !status.ended {
            bail!(
                "the recording was not ended: the disk does not take its last bytes; 'handscope recover' repairs it"
            );
        }
        Ok(())
    }

    /// Combines both results: a failed recording is a failure, whatever the command returns.
    pub(crate) fn and(
        done: anyhow::Result<()>,
        recorded: anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        match (done, recorded) {
            (Err(why), Err(recording)) => {
                notify(&format!("{recording:#}"));
                Err(why)
            }
            (done, recorded) => done.and(recorded),
        }
    }
}

/// Records the hand's persistent parameters once, then reports changes of the file's status.
async fn watch(recorder: Arc<Recorder>, link: LinkHandle, hand: Endpoint, clock: Clock) {
    record_parameters(&link, &hand, &recorder.input(), clock).await;
    drop(link);
    let mut reporter = FileReporter::default();
    let mut tick = interval(POLL_INTERVAL);
    loop {
        tick.tick().await;
        reporter.report(&recorder);
    }
}
