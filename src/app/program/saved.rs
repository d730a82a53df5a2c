//! Settings and the user's own poses: loaded from their files at start, saved off the window's thread when they change.

use crate::app::env::Env;
use crate::app::files::{pose_file, settings_file};
use crate::app::notices::NoticeKind;
use crate::app::poses::PoseState;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::hand::Moment;
use crate::poses::library::PoseLibrary;
use crate::store::Saver;
use crate::trials::plan_settings::from_settings;

/// Saves changes.
pub(super) struct SavedFiles {
    settings: Saver<Settings>,
    poses: Saver<PoseLibrary>,
}

impl SavedFiles {
    /// Initial state of the program: these settings, and the poses beside their file.
    pub(super) fn load(settings: Settings, env: &Env) -> (Self, State) {
        let path = env.settings_path.clone();
        let pose_path = path.as_deref().map(pose_file::path_beside);
        let (library, notice) = pose_path
            .as_deref()
            .map(pose_file::load)
            .unwrap_or_default();
        let runtime = || env.runtime.clone();
        let saved = Self {
            settings: Saver::new(path, runtime(), settings.clone(), settings_file::text),
            poses: Saver::new(pose_path, runtime(), library.clone(), pose_file::text),
        };
        let mut state = State {
            settings,
            poses: PoseState::new(library),
            ..State::default()
        };
        match from_settings(state.settings.trial_plan.as_ref()) {
            Ok(plan) => state.trials.plan = plan,
            Err(error) => {
                let ignored = NoticeKind::PlanIgnored { error };
                state.notices.push(Moment::ZERO, ignored);
            }
        }
        if let Some(what) = notice {
            state.notices.push(Moment::ZERO, what);
        }
        (saved, state)
    }

    /// Saves changes; returns notices of failures.
    pub(super) fn tick(&mut self, state: &State, now: Moment) -> Vec<NoticeKind> {
        let at = now.since(Moment::ZERO);
        // A visitor's choices must not replace those of staff.
        let settings = match state.exhibit {
            Some(_) => Ok(()),
            None => self.settings.tick(&state.settings, at),
        };
        let poses = self.poses.tick(&state.poses.library, at);
        let failed = [settings.err(), poses.err()].into_iter().flatten();
        let told = failed.map(|(path, error)| NoticeKind::not_saved(path, &error));
        told.collect()
    }

    /// Saves all changes without waiting for more. True once all are in files, or cannot be saved.
    pub(super) fn flush(&mut self, state: &State, now: Moment) -> bool {
        let at = now.since(Moment::ZERO);
        let poses = self.poses.flush(&state.poses.library, at);
        self.settings.flush(&state.settings, at) && poses
    }
}
