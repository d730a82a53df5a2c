//! A recording beside what another command does: the same file as `record` makes. What goes wrong with it is told, and holds nothing
//! up.

use crate::cli::out::file::nothing_at;
use crate::cli::out::say;
use crate::cli::recordings::record::{FileTold, tell_parameters};
use crate::hand::kinematics::Side;
use crate::link::{Clock, LinkHandle};
use crate::record::file::{Opening, PART_LENGTH, Recorder, RecordingPlan, SystemDisk};
use crate::store::calendar;
use crate::tasks::recording;
use crate::transport::Endpoint;
use anyhow::{Context as _, bail};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::task::{JoinHandle, spawn_blocking};
use tokio::time::{interval, timeout};

/// How often it is looked whether the disk is well.
const POLL_INTERVAL: Duration = Duration::from_millis(200);
/// A link that is closed ends in less.
const LINK_END_TIMEOUT: Duration = Duration::from_secs(2);

/// A recording that goes on by itself, if one was asked for.
pub(crate) struct SideRecording(Option<Running>);

struct Running {
    recorder: Arc<Recorder>,
    pump: JoinHandle<()>,
    /// Tells what the hand keeps, and then how the disk is.
    beside: JoinHandle<()>,
}

impl SideRecording {
    /// Records what happens at this link from now on, into a file that is not there yet. Must be called within a tokio runtime.
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
            opening: Opening::begin(hand.to_string(), moments, side),
            disk: Arc::new(SystemDisk),
            part_length: PART_LENGTH,
        })
        .context("cannot start the recorder")?;
        say(&format!("recording {hand} to {}", path.display()));
        let recorder = Arc::new(recorder);
        let observed = link.observe();
        let pump = tokio::spawn(recording::record(observed, recorder.input(), clock));
        let beside = watch(Arc::clone(&recorder), link.clone(), hand.clone(), clock);
        Ok(Self(Some(Running {
            recorder,
            pump,
            beside: tokio::spawn(beside),
        })))
    }

    /// Ends the file here, though the link goes on.
    pub(crate) async fn end_here(self) -> anyhow::Result<()> {
        if let Some(running) = &self.0 {
            running.pump.abort();
        }
        self.end().await
    }

    /// Ends the file. Fails if it could not be written. The link must be closed, or it goes on being recorded.
    pub(crate) async fn end(self) -> anyhow::Result<()> {
        let Some(running) = self.0 else { return Ok(()) };
        running.beside.abort();
        // It keeps the link open.
        let _aborted = running.beside.await;
        let _ended = timeout(LINK_END_TIMEOUT, running.pump).await;
        let Some(recorder) = Arc::into_inner(running.recorder) else {
            bail!("the recording was not ended: it is still written to");
        };
        // A slow disk must not hold up the hand. It ends early only with the program.
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

    /// How the command beside it ends: a recording that failed is a failure, whatever else was.
    pub(crate) fn and(
        done: anyhow::Result<()>,
        recorded: anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        match (done, recorded) {
            (Err(why), Err(recording)) => {
                say(&format!("{recording:#}"));
                Err(why)
            }
            (done, recorded) => done.and(recorded),
        }
    }
}

/// Asks once what the hand keeps, and then says what becomes of the file.
async fn watch(recorder: Arc<Recorder>, link: LinkHandle, hand: Endpoint, clock: Clock) {
    tell_parameters(&link, &hand, &recorder.input(), clock).await;
    drop(link);
    let mut told = FileTold::default();
    let mut tick = interval(POLL_INTERVAL);
    loop {
        tick.tick().await;
        told.tell(&recorder);
    }
}
