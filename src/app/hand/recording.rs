//! The recording of a hand: begun when its link opens, ended when that closes or a person wants none.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::sessions::recording::{HandRecording, RecordingTarget};
use crate::app::settings::Settings;
use crate::hand::Moment;
use crate::record::EventKind;

impl HandState {
    /// Begins or ends the recording of this hand as the settings say.
    pub(crate) fn tick_recording(&mut self, settings: &Settings, env: &Env) {
        let wanted = settings.records(self.is_simulated());
        match (&mut self.recording, &self.open) {
            (Some(recording), Some(_)) if wanted => {
                recording.tick();
                recording.params(&self.params.live_params(), self.now);
            }
            (Some(_), _) => self.recording = None,
            // A hand that never answers makes no file; what went over the wire before is still in the tap.
            (None, Some(_)) if wanted && self.link.state.is_live() => {
                self.recording = self.begin_recording(settings, env)
            }
            (None, _) => {}
        }
    }

    fn begin_recording(&self, settings: &Settings, env: &Env) -> Option<HandRecording> {
        let (endpoint, open) = (self.endpoint.as_ref()?, self.open.as_ref()?);
        let folder = settings.sessions_folder(env.documents.as_deref())?;
        let target = RecordingTarget {
            folder,
            endpoint,
            side: settings.side,
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
