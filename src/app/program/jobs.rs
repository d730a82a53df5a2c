//! Jobs off the window's thread: files that the user requested, and the search for serial ports.

use crate::app::env::Env;
use crate::app::files::export::{self, Export};
use crate::app::files::open::open;
use crate::app::files::pose_file;
use crate::app::hands::running::AskedSeries;
use crate::app::notices::NoticeKind;
use crate::app::params::{ParamAction, ParamsHand};
use crate::app::program::hand_tick::start_series;
use crate::app::program::hands;
use crate::app::state::State;
use crate::app::trials::TrialAction;
use crate::app::trials::files::{self, FilesEnd};
use crate::params::file::ParamsFile;
use crate::poses::library::PoseLibrary;
use crate::store::calendar::{since_1970, stamp};
use crate::store::{BackgroundJob, on_thread};
use crate::transport::{PortFound, ports};
use std::path::PathBuf;
use std::sync::Arc;

/// Jobs under way, one of a kind at a time.
#[derive(Default)]
pub(super) struct Jobs {
    finding_ports: Option<BackgroundJob<Vec<PortFound>>>,
    exporting: Option<BackgroundJob<NoticeKind>>,
    importing: Option<BackgroundJob<Result<PoseLibrary, NoticeKind>>>,
    /// Sessions of trials that the user opens or saves.
    sessions: Option<BackgroundJob<FilesEnd>>,
    /// A session of trials that is saved automatically.
    keeping: Option<BackgroundJob<FilesEnd>>,
}

impl Jobs {
    /// Applies the results of finished jobs; returns notices for the user.
    pub(super) fn tick(&mut self, state: &mut State, env: &Env) -> Vec<NoticeKind> {
        if let Some(found) = BackgroundJob::take_from(&mut self.finding_ports) {
            state.ports = found;
        }
        let mut told = Vec::from_iter(BackgroundJob::take_from(&mut self.exporting));
        let trials = &mut state.trials;
        let asked = BackgroundJob::take_from(&mut self.sessions);
        if let Some(end) = &asked {
            trials.asks_path = std::mem::take(&mut trials.is_opening) && end.is_err();
        }
        let kept = BackgroundJob::take_from(&mut self.keeping);
        told.extend(asked.into_iter().chain(kept).map(|end| trials.apply(end)));
        while self.keeping.is_none()
            && let Some(id) = trials.to_keep.pop_front()
        {
            let session = trials.session(id);
            self.keeping = session.and_then(|session| files::keep(session, env));
        }
        match BackgroundJob::take_from(&mut self.importing) {
            None => {}
            // All of it is added, or nothing.
            Some(Ok(library)) => {
                let (poses, sequences) = (library.poses.len(), library.sequences.len());
                state.poses.import(library);
                told.push(NoticeKind::PosesImported { poses, sequences });
            }
            Some(Err(refused)) => {
                state.poses.refused = Some(refused.clone());
                told.push(refused);
            }
        }
        told
    }

    /// True while a session of trials is being saved automatically.
    pub(super) const fn keeps(&self) -> bool {
        self.keeping.is_some()
    }

    /// Carries out an action on parameters: those on files here, all others on the hand.
    pub(super) fn param_action(&mut self, action: ParamAction, state: &mut State, env: &Env) {
        if action != ParamAction::Dump {
            hands::with_shown(state, env, |hand, _, ctx| {
                let of = ParamsHand {
                    connection: &hand.connection,
                    overshoot: &hand.overshoot.map,
                    env: ctx.env,
                };
                hand.params.act(action, of, &hand.readings.sample, ctx.now);
            });
            return;
        }
        let hand = state.hand();
        let params = hand.params.live_params();
        if params.is_empty() {
            return;
        }
        let file = ParamsFile {
            hand: hand.connection.name(),
            at: stamp(since_1970()),
            why: "dump".into(),
            params,
            ..ParamsFile::default()
        };
        self.export(Export::Params(Box::new(file)), env);
    }

    /// Carries out an action on trials.
    pub(super) fn trial_action(&mut self, action: TrialAction, state: &mut State, env: &Env) {
        let State {
            trials, settings, ..
        } = state;
        match action {
            TrialAction::Start(kind) => {
                let mut trials = std::mem::take(trials);
                let plan = trials.planned(kind);
                hands::with_shown(state, env, |hand, _, ctx| {
                    start_series(hand, plan, &mut trials, ctx);
                });
                state.trials = trials;
            }
            TrialAction::ArmAndStart(kind) => {
                let plan = trials.planned(kind);
                if trials.running.is_none() && plan.is_sound() {
                    hands::with_shown(state, env, |hand, _, ctx| {
                        hand.arm_for_series(AskedSeries::Trials(Box::new(plan)), ctx)
                    });
                }
            }
            TrialAction::Open(_) | TrialAction::Save(..) if self.sessions.is_some() => {}
            TrialAction::Open(typed) => {
                trials.is_opening = true;
                self.sessions = Some(files::open(typed, env));
            }
            TrialAction::Save(id, criterion) => {
                let session = trials.session(id);
                let save = |session| files::save(session, criterion, env);
                self.sessions = session.and_then(save);
            }
            TrialAction::ForgetOvershoot => state.hand_mut().overshoot.forget(),
            TrialAction::ExportOvershoot => {
                let map = Arc::clone(&state.hand().overshoot.map);
                self.export(Export::Overshoot(map), env);
            }
            action => trials.act(action, settings),
        }
    }

    /// Exports one file at a time: while a dialog is open, no other is opened.
    pub(super) fn export(&mut self, content: Export, env: &Env) {
        if self.exporting.is_none() {
            self.exporting = Some(export::save(content, env));
        }
    }

    pub(super) fn import_poses(&mut self, typed: Option<PathBuf>, state: &mut State, env: &Env) {
        if self.importing.is_none() {
            state.poses.refused = None;
            let import = open(typed, pose_file::FILE_NAME, env, pose_file::read);
            self.importing = Some(import);
        }
    }

    pub(super) fn find_ports(&mut self, env: &Env) {
        if self.finding_ports.is_none() {
            let find = async { on_thread(|| Ok(ports())).await.unwrap_or_default() };
            let finding = BackgroundJob::start(&env.runtime, &env.wake, find);
            self.finding_ports = Some(finding);
        }
    }
}
