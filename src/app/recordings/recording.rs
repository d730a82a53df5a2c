//! The recording being made of a hand: from the opening of the link to its closing, or until the user turns recording
//! off.

use crate::app::env::Env;
use crate::app::files::settings_file;
use crate::app::layout::Layout;
use crate::app::notices::{HandNotices, NoticeKind};
use crate::app::settings::{Settings, Zoom};
use crate::hand::kinematics::Side;
use crate::hand::{Moment, PerDof};
use crate::history::History;
use crate::link::entries;
use crate::link::{LinkHandle, LinkObserver};
use crate::params::file::ParamsFile;
use crate::params::values::Params;
use crate::record::file::recorder::RecorderInput;
use crate::record::file::{
    FileMark, Opening, PART_LENGTH, Recorder, RecorderStatus, RecordingPlan, SystemDisk,
};
use crate::record::{Entry, Event, EventKind};
use crate::store::calendar::{day, since_1970, stamp};
use crate::store::{JobKind, Jobs};
use crate::tasks::read::rows;
use crate::transport::Endpoint;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Interval at which settings are compared: typing or dragging changes them every frame.
const SETTINGS_INTERVAL: Duration = Duration::from_secs(1);

/// A recording in progress.
#[derive(Debug)]
pub struct HandRecording {
    recorder: Recorder,
    input: RecorderInput,
    /// Endpoint of the hand, as text.
    pub hand: String,
    pub began: Moment,
    /// Persistent parameters of the hand, as last recorded.
    params: Params,
    /// True once the parameters have been requested from the hand.
    is_asked: bool,
    jobs: Jobs<ReadParams>,
    /// True after an event [`EventKind::Play`], until its end is recorded.
    plays: bool,
    /// Settings as last recorded, and the time of the last comparison.
    settings: Option<(Settings, Moment)>,
    /// Recorder status as of this frame.
    pub status: RecorderStatus,
}

/// Background job of a recording: reading the hand's persistent parameters.
#[derive(Debug, PartialEq, Eq)]
struct ReadParams;

impl JobKind for ReadParams {
    type State = HandRecording;
    /// Time of the tick.
    type Ctx<'a> = Moment;
}

/// Subject and destination of a recording.
#[derive(Debug)]
pub(crate) struct RecordingTarget<'a> {
    /// Recordings folder.
    pub(crate) folder: PathBuf,
    pub(crate) endpoint: &'a Endpoint,
    /// Side of the hand, as configured by the user.
    pub(crate) side: Side,
    /// Newtons of a gram of each joint, where they are known.
    pub(crate) newtons_per_g: PerDof<Option<f64>>,
}

impl HandRecording {
    /// Starts recording what the observer receives.
    pub(crate) fn begin(
        target: &RecordingTarget<'_>,
        observed: LinkObserver,
        env: &Env,
    ) -> Option<Self> {
        let wall = since_1970();
        let now = env.clock.now();
        let moments = (now, wall);
        let opening = Opening::begin(target.endpoint.to_string(), moments, target.side)
            .with_newtons(target.newtons_per_g);
        let name = opening.file_name(&stamp(wall));
        let plan = RecordingPlan {
            path: target.folder.join(day(wall)).join(name),
            opening,
            disk: Arc::new(SystemDisk),
            part_length: PART_LENGTH,
        };
        let recorder = Recorder::start(plan).ok()?;
        let input = recorder.input();
        let pump = entries::record(observed, input.clone(), env.clock);
        env.runtime.spawn(pump);
        Some(Self {
            hand: target.endpoint.to_string(),
            began: now,
            params: Params::default(),
            is_asked: false,
            jobs: Jobs::default(),
            plays: false,
            settings: None,
            status: recorder.status(),
            recorder,
            input,
        })
    }

    /// Updates the status, applies the requested parameters, and publishes notices about the file.
    pub(crate) fn tick(&mut self, notices: &mut HandNotices<'_>, mut now: Moment) {
        let reported = self.status.notices.len();
        let before = std::mem::replace(&mut self.status, self.recorder.status()).trouble;
        match (&before, &self.status.trouble) {
            (None, Some(why)) => {
                let why = why.clone();
                notices.push(now, NoticeKind::RecordingStalled { why });
            }
            (Some(_), None) => {
                notices.withdraw(|what| matches!(what, NoticeKind::RecordingStalled { .. }));
            }
            _ => {}
        }
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, &mut now);
        }
        for notice in self.status.notices.iter().skip(reported) {
            notices.push(now, NoticeKind::Recording(notice.clone()));
        }
    }

    /// Closes the file, waiting at most a few seconds.
    pub(crate) fn end(self) {
        let _ended = self.recorder.end();
    }

    /// Reads the hand's persistent parameters once, for the file only: the views request and display their own.
    pub(crate) fn request_params(&mut self, link: &LinkHandle, env: &Env) {
        if std::mem::replace(&mut self.is_asked, true) || !self.params.is_empty() {
            return;
        }
        let link = link.clone();
        let read = async move { rows(&link, |_, _| ()).await.params };
        let apply = |recording: &mut Self, now: &mut Moment, live| recording.params(&live, *now);
        self.jobs.start(ReadParams, env.background(), read, apply);
    }

    /// True once the parameters have been requested from the hand.
    pub const fn is_asked(&self) -> bool {
        self.is_asked
    }

    /// Records the hand's persistent parameters if they differ from those last recorded.
    pub(crate) fn params(&mut self, live: &Params, now: Moment) {
        if *live == self.params || live.is_empty() {
            return;
        }
        self.params.clone_from(live);
        let file = ParamsFile {
            hand: self.hand.clone(),
            at: stamp(since_1970()),
            why: "recorded".into(),
            params: live.clone(),
            ..ParamsFile::default()
        };
        self.event(now, EventKind::Parameters, file.to_toml());
    }

    /// Records the program's settings if they differ from those last recorded. The window layout and zoom are left out.
    pub(crate) fn settings(&mut self, settings: &Settings, now: Moment) {
        let recorded_at = self.settings.as_ref().map(|(_, at)| *at);
        if recorded_at.is_some_and(|at| now.since(at) < SETTINGS_INTERVAL) {
            return;
        }
        let own = Settings {
            layout: Layout::default(),
            zoom: Zoom::default(),
            ..settings.clone()
        };
        let before = self.settings.replace((own.clone(), now));
        if before.is_some_and(|(before, _)| before == own) {
            return;
        }
        if let Ok(words) = settings_file::text(&own) {
            self.event(now, EventKind::Settings, words);
        }
    }

    /// Records that a pose, a sequence, a demo or a hold begins; the text names it.
    pub(crate) fn begin_play(&mut self, at: Moment, words: String) {
        self.plays = true;
        self.event(at, EventKind::Play, words);
    }

    /// Records the end of what was begun, once nothing plays.
    pub(crate) fn follow_play(&mut self, is_playing: bool, now: Moment) {
        if self.plays && !is_playing {
            self.plays = false;
            self.event(now, EventKind::PlayEnd, String::new());
        }
    }

    /// Records an event that did not come from the link.
    pub(crate) fn event(&self, at: Moment, kind: EventKind, words: String) {
        self.input.push(Entry::Event(Event { at, kind, words }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::connect::SimDial;
    use crate::link::{Clock, LinkConfig, PollRates, open};
    use crate::record::Record;
    use tokio::runtime::Handle;
    use tokio::time::sleep;

    /// Entries that may wait: fewer than come in the virtual time of the test, and more than are waited for at once.
    const ROOM: usize = 3000;

    // A check-up of a minute and a half in virtual time is over in a few seconds: its recording lacked a close where the recorder's
    // thread got no processor for one of them.
    #[tokio::test(start_paused = true)]
    async fn a_recorder_that_is_held_up_misses_nothing_of_virtual_time() {
        let clock = Clock::start_virtual();
        let (input, taken) = RecorderInput::new(ROOM);
        let recorder = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_secs(1));
            let (mut entries, mut lost, mut angles) = (0, 0, 0);
            for given in taken {
                entries += 1;
                lost += given.lost_before;
                angles += u64::from(matches!(given.entry, Entry::Heard(Record::Reading { .. })));
            }
            (entries, lost, angles)
        });
        let config = LinkConfig {
            endpoint: "sim:".parse().unwrap(),
            rates: PollRates::default(),
            clock,
            dial: Arc::new(SimDial::new(clock)),
            wake: Arc::new(|| ()),
        };
        let (link, _records) = open(config, &Handle::current());
        let pump = tokio::spawn(entries::record(link.observe(), input.clone(), clock));
        sleep(Duration::from_secs(20)).await;
        pump.abort();
        let _aborted = pump.await;
        let lost_last = input.take_lost();
        drop(input);
        let (entries, lost, readings) = recorder.join().unwrap();
        assert_eq!((lost, lost_last), (0, 0));
        assert!(
            entries > 2 * ROOM && readings > 1000,
            "{entries} {readings}"
        );
    }
}

/// A recording overlaid on the replayed one.
#[derive(Debug)]
pub struct BesideRecording {
    /// User-given name, else the file name.
    pub title: String,
    pub first: Moment,
    /// Events in the recording.
    pub marks: Vec<FileMark>,
    /// Measurements in the recording.
    pub history: History,
    /// Moment of the replayed recording that is aligned with `other`.
    pub own: Moment,
    /// Moment of this recording that is aligned with `own`.
    pub other: Moment,
}

impl BesideRecording {
    /// Seconds to add to times of the replayed recording to get times of this one.
    pub fn offset_s(&self) -> f64 {
        self.other.secs() - self.own.secs()
    }
}
