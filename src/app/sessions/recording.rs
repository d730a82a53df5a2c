//! The session that is being recorded of a hand: begun when a link opens, ended when it closes or a person wants none.

use crate::app::env::Env;
use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::link::LinkObserver;
use crate::params::file::ParamsFile;
use crate::params::values::Params;
use crate::record::file::recorder::RecorderInput;
use crate::record::file::{Opening, Recorder, RecorderStatus, RecordingPlan, SystemDisk};
use crate::record::{Entry, Event, EventKind};
use crate::store::calendar::{day, since_1970, stamp};
use crate::tasks::recording;
use crate::transport::Endpoint;
use std::path::PathBuf;
use std::sync::Arc;

/// A recording under way.
#[derive(Debug)]
pub struct HandRecording {
    recorder: Recorder,
    input: RecorderInput,
    /// What the hand keeps, as it was recorded last.
    params: Params,
    /// How it goes, as of this frame.
    pub status: RecorderStatus,
}

/// What is recorded, and where it goes.
#[derive(Debug)]
pub(crate) struct RecordingTarget<'a> {
    /// The folder of sessions.
    pub(crate) folder: PathBuf,
    /// The hand.
    pub(crate) endpoint: &'a Endpoint,
    /// Its side, as the person says.
    pub(crate) side: Side,
}

impl HandRecording {
    /// Begins a recording of what is observed.
    pub(crate) fn begin(
        target: &RecordingTarget<'_>,
        observed: LinkObserver,
        env: &Env,
    ) -> Option<Self> {
        let wall = since_1970();
        let moments = (env.clock.now(), wall);
        let opening = Opening::begin(target.endpoint.to_string(), moments, target.side);
        let name = opening.file_name(&stamp(wall));
        let plan = RecordingPlan {
            path: target.folder.join(day(wall)).join(name),
            opening,
            disk: Arc::new(SystemDisk),
        };
        let recorder = Recorder::start(plan).ok()?;
        let input = recorder.input();
        let pump = recording::record(observed, input.clone(), env.clock);
        env.runtime.spawn(pump);
        Some(Self {
            params: Params::default(),
            status: recorder.status(),
            recorder,
            input,
        })
    }

    /// Brings the status up to date.
    pub(crate) fn tick(&mut self) {
        self.status = self.recorder.status();
    }

    /// Ends the file and waits for that, at most a few seconds.
    pub(crate) fn end(self) {
        let _ended = self.recorder.end();
    }

    /// Adds what the hand keeps, if that is not what was recorded last.
    pub(crate) fn params(&mut self, live: &Params, now: Moment) {
        if *live == self.params || live.is_empty() {
            return;
        }
        self.params.clone_from(live);
        let file = ParamsFile {
            at: stamp(since_1970()),
            why: "recorded".into(),
            params: live.clone(),
            ..ParamsFile::default()
        };
        self.event(now, EventKind::Parameters, file.to_toml());
    }

    /// Adds something that happened beside the link.
    pub(crate) fn event(&self, at: Moment, kind: EventKind, words: String) {
        self.input.push(Entry::Event(Event { at, kind, words }));
    }
}
