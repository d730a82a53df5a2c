//! The recording of a hand: begun when its link opens, ended when that closes or a person wants none.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::notices::{NoticeKind, Notices};
use crate::app::sessions::recording::{HandRecording, RecordingTarget};
use crate::app::settings::Settings;
use crate::hand::Moment;
use crate::record::EventKind;

impl HandState {
    /// Begins or ends the recording of this hand as the settings say.
    pub(crate) fn tick_recording(&mut self, settings: &Settings, env: &Env, notices: &mut Notices) {
        let wanted = settings.records(self.is_simulated());
        match (&mut self.recording, &self.open) {
            (Some(recording), Some(_)) if wanted => {
                for notice in recording.tick(self.now) {
                    notices.push(self.now, NoticeKind::Recording(notice));
                }
                recording.settings(settings, self.now);
                // Half of a reading is no news.
                if !self.params.is_busy() {
                    recording.params(&self.params.live_params(), self.now);
                }
                self.ask_params_to_record(env);
            }
            (Some(_), _) => self.recording = None,
            // A hand that never answers makes no file; what went over the wire before is still in the tap.
            (None, Some(_)) if wanted && self.link.state.is_live() => {
                self.recording = self.begin_recording(settings, env)
            }
            (None, _) => {}
        }
    }

    /// A recording tells what the hand keeps: that is read once, as soon as the hand rests and nothing else goes on, unless a person
    /// looked at it before.
    fn ask_params_to_record(&mut self, env: &Env) {
        let is_idle = self.procedure.is_none() && !self.runs_series();
        if is_idle
            && self.write_refusal().is_none()
            && let (Some(recording), Some(open)) = (&mut self.recording, &self.open)
        {
            recording.ask_params(&open.link, env);
        }
    }

    fn begin_recording(&self, settings: &Settings, env: &Env) -> Option<HandRecording> {
        let (endpoint, open) = (self.endpoint.as_ref()?, self.open.as_ref()?);
        let folder = settings.sessions_folder(env.documents.as_deref())?;
        let target = RecordingTarget {
            folder,
            endpoint,
            side: self.side,
        };
        HandRecording::begin(&target, open.link.observe(), env)
    }

    /// Notes in the recording that a person did something.
    pub(crate) fn record_event(&self, at: Moment, kind: EventKind, words: String) {
        if let Some(recording) = &self.recording {
            recording.event(at, kind, words);
        }
    }
}
