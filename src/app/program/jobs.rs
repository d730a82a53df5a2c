//! Jobs off the window's thread: files that the user requested, and the search for serial ports.

use crate::app::env::Env;
use crate::app::files::export::{self, Export};
use crate::app::files::{open, pose_file};
use crate::app::hand::running::AskedSeries;
use crate::app::notices::NoticeKind;
use crate::app::params::{ParamAction, ParamsHand};
use crate::app::program::hand_tick::start_series;
use crate::app::program::hands;
use crate::app::state::State;
use crate::app::trials::TrialAction;
use crate::app::trials::files::{self, FilesEnd};
use crate::params::file::ParamsFile;
use crate::store::calendar::{since_1970, stamp};
use crate::store::{JobKind, Jobs, on_thread};
use crate::transport::ports;
use std::path::PathBuf;
use std::sync::Arc;

/// Background jobs of the program, one of a kind at a time.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum ProgramJob {
    FindPorts,
    Export,
    ImportPoses,
    /// Open or save a session of trials for the user.
    Session,
    /// Write a session of trials that the user did not ask to save.
    KeepSession,
}

impl JobKind for ProgramJob {
    type State = State;
    /// Notices for the user.
    type Ctx<'a> = Vec<NoticeKind>;
}

/// Running jobs of the program.
#[derive(Default)]
pub(super) struct ProgramJobs(Jobs<ProgramJob>);

impl ProgramJobs {
    /// Applies the results of ended jobs; returns notices for the user.
    pub(super) fn tick(&mut self, state: &mut State, env: &Env) -> Vec<NoticeKind> {
        let mut notices = Vec::new();
        while let Some(effect) = self.0.next_ended() {
            effect(state, &mut notices);
        }
        while !self.keeps()
            && let Some(id) = state.trials.to_keep.pop_front()
        {
            let session = state.trials.session(id);
            let Some(keep) = session.and_then(|session| files::keep(session, env)) else {
                continue;
            };
            self.0.start(
                ProgramJob::KeepSession,
                env.background(),
                keep,
                |state, notices, end| notices.push(state.trials.apply(end)),
            );
        }
        notices
    }

    /// True while a session of trials is being saved automatically.
    pub(super) fn keeps(&self) -> bool {
        self.0.is_running(&ProgramJob::KeepSession)
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
            TrialAction::Open(_) | TrialAction::Save(..)
                if self.0.is_running(&ProgramJob::Session) => {}
            TrialAction::Open(typed) => self.0.start(
                ProgramJob::Session,
                env.background(),
                files::open(typed, env),
                |state, notices, end: FilesEnd| {
                    state.trials.asks_path = end.is_err();
                    notices.push(state.trials.apply(end));
                },
            ),
            TrialAction::Save(id, criterion) => {
                let session = trials.session(id);
                let save = session.and_then(|session| files::save(session, criterion, env));
                if let Some(save) = save {
                    self.0.start(
                        ProgramJob::Session,
                        env.background(),
                        save,
                        |state, notices, end| {
                            state.trials.asks_path = false;
                            notices.push(state.trials.apply(end));
                        },
                    );
                }
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
        if self.0.is_running(&ProgramJob::Export) {
            return;
        }
        self.0.start(
            ProgramJob::Export,
            env.background(),
            export::save(content, env),
            |_, notices, notice| notices.push(notice),
        );
    }

    pub(super) fn import_poses(&mut self, typed: Option<PathBuf>, state: &mut State, env: &Env) {
        if self.0.is_running(&ProgramJob::ImportPoses) {
            return;
        }
        state.poses.refused = None;
        self.0.start(
            ProgramJob::ImportPoses,
            env.background(),
            open(typed, pose_file::FILE_NAME, env, pose_file::read),
            |state, notices, read| match read {
                // All of it is added, or nothing.
                Ok(library) => {
                    let (poses, sequences) = (library.poses.len(), library.sequences.len());
                    state.poses.import(library);
                    notices.push(NoticeKind::PosesImported { poses, sequences });
                }
                Err(refused) => {
                    state.poses.refused = Some(refused.clone());
                    notices.push(refused);
                }
            },
        );
    }

    pub(super) fn find_ports(&mut self, env: &Env) {
        if self.0.is_running(&ProgramJob::FindPorts) {
            return;
        }
        self.0.start(
            ProgramJob::FindPorts,
            env.background(),
            on_thread(|| Ok(ports())),
            |state, _, found| state.ports = found.unwrap_or_default(),
        );
    }
}
