//! The program: carries out actions, and advances hands and files. The rules of motion are with the hand.

pub(crate) mod exhibit;
mod hand_actions;
mod hand_tick;
mod hands;
mod hold;
mod inputs;
mod jobs;
mod leading;
mod pinch;
mod pose_actions;
pub(crate) mod quirk_notes;
mod saved;
mod scale;
mod taring;

use crate::app::action::Action;
use crate::app::activity::Activity;
use crate::app::checkup::files;
use crate::app::controls::JointChange;
use crate::app::env::{Ctx, Env};
use crate::app::exhibit::Exhibition;
use crate::app::files::export::{self, Export};
use crate::app::hand::Hand;
use crate::app::hand::REST_TIMEOUT;
use crate::app::notices::{NoticeKind, RequestKind};
use crate::app::params::ParamsHand;
use crate::app::program::exhibit::ExhibitWork;
use crate::app::program::hand_actions::each;
use crate::app::program::hand_tick::{Shared, record_event};
use crate::app::program::hands::Closing;
use crate::app::program::jobs::ProgramJobs;
use crate::app::program::pose_actions::accepts_poses;
use crate::app::program::quirk_notes::QuirkNotes;
use crate::app::program::saved::SavedFiles;
use crate::app::recordings::RecordingAction;
use crate::app::recordings::recording::HandRecording;
use crate::app::replay::ReplayWork;
use crate::app::settings::Settings;
use crate::app::state::{LeaveQuestion, State};
use crate::exhibit::stage::ExhibitWish;
use crate::hand::{HandCommand, Moment};
use crate::poses::Play;
use crate::record::EventKind;
use crate::transport::Endpoint;
use std::collections::VecDeque;
use std::time::Duration;

/// Far longer than a series takes to end and be written, on a working disk.
const SAVE_TIMEOUT: Duration = Duration::from_secs(10);

/// The whole program without its window.
pub struct App {
    env: Env,
    state: State,
    saved: SavedFiles,
    quirk_notes: QuirkNotes,
    closing: Option<Closing>,
    jobs: ProgramJobs,
    exhibit: ExhibitWork,
    recorded: ReplayWork,
    records: bool,
    leaves: bool,
}

impl App {
    /// Creates the program without connecting.
    pub fn new(env: Env, settings: Settings) -> Self {
        let (saved, state) = SavedFiles::load(settings, &env);
        Self {
            quirk_notes: QuirkNotes::new(env.settings_path.as_deref()),
            env,
            state,
            saved,
            closing: None,
            jobs: ProgramJobs::default(),
            exhibit: ExhibitWork::default(),
            recorded: ReplayWork::default(),
            records: true,
            leaves: false,
        }
    }

    /// Opens a hand at start: the given one, else those of the last session, else the built-in one. Remembers nothing.
    pub fn open(&mut self, endpoint: Option<Endpoint>, now: Moment) {
        let settings = &self.state.settings;
        let known = settings.open.iter().filter_map(|text| text.parse().ok());
        let mut known: VecDeque<Endpoint> = known.collect();
        let shown = settings.endpoint.clone();
        let first = endpoint.clone().or_else(|| known.pop_front());
        open(&mut self.state, first, &self.env, now);
        if endpoint.is_none() {
            open_beside(&mut self.state, known.into(), &self.env, now);
            hands::show_last(&mut self.state, shown.as_deref());
        }
    }

    /// Opens further hands at start, each in its own slot; the first stays shown. Remembers nothing.
    pub fn open_beside(&mut self, endpoints: Vec<Endpoint>, now: Moment) {
        open_beside(&mut self.state, endpoints, &self.env, now);
    }

    /// Disables recording in this run, regardless of the settings.
    pub fn record_nothing(&mut self) {
        self.records = false;
    }

    /// Adds a notice from outside the program, such as an unreadable settings file.
    pub fn notify(&mut self, what: NoticeKind, now: Moment) {
        if let Some(player) = &mut self.recorded.player {
            player.notify(what.clone());
        }
        self.state.notices.push(now, what);
    }

    /// Everything the window shows: the live hands, or the session that is replayed.
    pub fn state(&self) -> &State {
        let replayed = self.recorded.player.as_ref();
        replayed.map_or(&self.state, |player| &player.state)
    }

    /// The live hands, regardless of what is shown.
    pub const fn live(&self) -> &State {
        &self.state
    }

    /// Applies all news since the last call. Also runs while the window is hidden.
    pub fn logic(&mut self, now: Moment) {
        self.state.now = now;
        let State {
            hands,
            notices,
            trials,
            settings,
            poses,
            scan,
            fleet,
            ..
        } = &mut self.state;
        let is_several = hands.is_several();
        for hand in hands.iter_mut() {
            hand.apply_settings(settings);
            let mut ctx = Ctx {
                now,
                env: &self.env,
                notices: notices.about(is_several.then_some(&hand.label)),
            };
            let mut shared = Shared {
                settings: &mut *settings,
                trials: &mut *trials,
                poses: &*poses,
                records: self.records,
            };
            hand_tick::tick(hand, &mut shared, &mut ctx);
            self.quirk_notes.tick(hand, &mut ctx);
        }
        let lost = self.env.lost_steps.take();
        if lost > 0 {
            notices.push(now, NoticeKind::StepsLost(lost));
        }
        let has = |hand: &Hand, id| hand.running.series().is_some_and(|run| run.session == id);
        let told = trials.close_broken_off(|id| hands.iter().any(|hand| has(hand, id)));
        told.into_iter().for_each(|told| notices.push(now, told));
        scan.drain();
        fleet.drain();
        leading::stop_mirrored(&mut self.state);
        hands::drop_removed(&mut self.state);
        if self.closing.is_none() {
            hands::remember_open(&mut self.state);
        }
        self.exhibit.tick(&mut self.state, now);
        let told = self.jobs.tick(&mut self.state, &self.env);
        told.into_iter().for_each(|told| self.notify(told, now));
        self.recorded.tick(&mut self.state, &self.env);
        if self.state.exhibit.is_some() {
            // A replay would cover the page, and offer a way out of it.
            self.recorded.player = None;
        }
        let told = self.saved.tick(&self.state, now);
        told.into_iter().for_each(|told| self.notify(told, now));
    }

    /// Carries out one user action.
    pub fn act(&mut self, action: Action, now: Moment) {
        let action = match &mut self.recorded.player {
            Some(player) => match player.pass(action) {
                Some(action) => action,
                None => return,
            },
            None => action,
        };
        self.state.now = now;
        if self.state.exhibit.is_some() && !action.effect().passes_in_exhibit() {
            return;
        }
        if self.state.hand().runs_series() && !action.effect().passes_in_series() {
            self.notify(NoticeKind::SeriesRuns, now);
            return;
        }
        self.record_act(&action, now);
        self.carry_out(action);
    }

    #[expect(clippy::too_many_lines, reason = "one list of all actions")]
    fn carry_out(&mut self, action: Action) {
        let (state, env) = (&mut self.state, &self.env);
        match action {
            Action::Stop => self.stop(),
            Action::Arm if self.closing.is_some() => {}
            Action::Arm => {
                hands::with_shown(state, env, |hand, _, ctx| hand.arm(ctx));
            }
            Action::Disarm => {
                let now = state.now;
                state.hand_mut().disarm(now);
            }
            Action::HoldToRun(on) => hand_actions::set_hold_to_run(state, on),
            Action::DisarmIdle(on) => state.settings.disarm_idle = on,
            Action::HoldKey(_) if self.closing.is_some() => {}
            Action::HoldKey(key) => hands::hold_key(state, key, env),
            Action::Target(dof, angle) => state
                .hand_mut()
                .change_joint(dof, JointChange::Target(angle)),
            Action::Force(dof, force) => {
                each(dof).for_each(|dof| {
                    state
                        .hand_mut()
                        .change_joint(dof, JointChange::Force(force))
                });
            }
            Action::Speed(dof, speed) => {
                each(dof).for_each(|dof| {
                    state
                        .hand_mut()
                        .change_joint(dof, JointChange::Speed(speed))
                });
            }
            Action::Lock(dof, locked) => state
                .hand_mut()
                .change_joint(dof, JointChange::Lock(locked)),
            Action::Preset(preset) => pose_actions::preset(state.hand_mut(), preset),
            Action::Pinch(gap) => pinch::pinch(state, gap, env),
            Action::MeasureBlock(size_mm) => pinch::measure_block(state, size_mm),
            Action::ForgetBlocks => pinch::forget_blocks(state),
            Action::Hold(action) => {
                hands::with_shown(state, env, |hand, settings, ctx| {
                    hold::hold(hand, action, settings, ctx);
                });
            }
            Action::Scale(action) => {
                hands::with_shown(state, env, |hand, _, ctx| scale::scale(hand, action, ctx));
            }
            Action::Gesture(gesture) => hands::with_shown(state, env, |hand, settings, ctx| {
                hand.gesture(gesture, settings.gesture_route, ctx);
            }),
            Action::Capture(name) => pose_actions::capture(state, &name),
            Action::Recapture(id) => pose_actions::recapture(state, id),
            Action::Library(edit) => state.poses.edit(edit),
            Action::Recall(id) => pose_actions::recall(state, id, env),
            Action::Play(play) => pose_actions::play(state, play, env),
            Action::HideShipped(name, hide) => pose_actions::hide_shipped(state, name, hide),
            Action::DryRun(sequence) => pose_actions::dry_run(state, sequence),
            Action::Recording(action) => {
                let on = [
                    RecordingAction::Record(true),
                    RecordingAction::RecordSimulated(true),
                ];
                // A user action overrides the start option.
                self.records |= on.contains(&action);
                self.recorded.act(action, state, env);
            }
            Action::Exhibit(action) => self.leaves |= self.exhibit.act(action, state, env),
            Action::Input(action) => inputs::act(state, action, env),
            Action::Trial(action) => self.jobs.trial_action(action, state, env),
            Action::Checkup(action) => hand_actions::checkup(state, action, env),
            Action::ImportPoses(typed) => self.jobs.import_poses(typed, state, env),
            Action::ExportPoses => {
                let library = state.poses.library.clone();
                self.jobs.export(Export::Poses(library), env);
            }
            Action::NameGesture(gesture, name) => state.settings.name_gesture(gesture, &name),
            Action::GestureRoute(route) => state.settings.gesture_route = route,
            // An open card clears errors itself, or must not be disturbed.
            Action::ClearErrors if state.hand().procedures.card.is_some() => {}
            Action::ClearErrors => {
                hands::with_shown(state, env, |hand, _, ctx| {
                    hand.request(RequestKind::ClearErrors, HandCommand::ClearErrors, ctx);
                });
            }
            Action::ChangePlace(id, wanted) => {
                let hand = state.hand_mut();
                let (connection, params) = (&hand.connection, &hand.params);
                hand.procedures
                    .open_place_change(id, wanted, connection, params);
            }
            Action::FactoryReset => {
                let hand = state.hand_mut();
                hand.procedures.open_reset(&hand.connection);
            }
            Action::CalibrateForce => {
                let hand = state.hand_mut();
                hand.procedures.open_calibration(&hand.connection);
            }
            Action::Procedure(action) => hands::with_shown(state, env, |hand, _, ctx| {
                let sample = hand.readings.sample;
                hand.procedures.act(action, &hand.connection, &sample, ctx);
            }),
            Action::Answer(question, yes) => state.hand_mut().answer(&question, yes),
            Action::Connect(endpoint) => hand_actions::connect(state, Some(endpoint), env),
            Action::Disconnect => hand_actions::connect(state, None, env),
            Action::Hands(action) => hands::act(state, action, env),
            Action::FindPorts => self.jobs.find_ports(env),
            Action::Scan(wish) => {
                let held = state.hands.iter();
                let held = held
                    .filter_map(|hand| hand.connection.endpoint.clone())
                    .collect();
                state.scan.begin(wish, held, env);
            }
            Action::CancelScan => state.scan.cancel(),
            Action::FindShared(interface) => state.fleet.listen(interface, env),
            Action::SeenFault(dof, what) => state.hand_mut().readings.faults.see_one(dof, what),
            Action::SeenFaults => state.hand_mut().readings.faults.see_all(),
            Action::Save(content) => self.jobs.export(content, env),
            // The shell draws the picture, and then requests saving its file.
            Action::SavePicture(_) => {}
            Action::Stay => state.leave = None,
            Action::Leave => (self.leaves, state.leave) = (true, None),
            Action::Dismiss(id) => state.notices.dismiss(id),
            Action::Theme(theme) => state.settings.theme = theme,
            Action::Side(side) => hand_actions::set_side(state, side),
            Action::Language(language) => state.settings.language = language,
            Action::Layout(layout) => state.settings.layout = layout,
            Action::Zoom(zoom) => state.settings.zoom = zoom,
            Action::ReadFirst(first) => state.settings.read_first = first,
            Action::AngleUnit(unit) => state.settings.angle_unit = unit,
            Action::PlotWindow(window) => state.settings.plot_window = window,
            Action::ShowPlot(kind, on) => state.settings.plots.set(kind, on),
            Action::GrowPlot(kind) => state.settings.tall_plots.grow(kind),
            Action::Note(at, words) => hand_actions::note(state, at, &words),
            Action::RemoveMark(mark) => hand_actions::remove_mark(state, &mark),
            Action::Tare(finger) => taring::tare(state, finger, env),
            Action::UndoTare => taring::undo(state, env),
            Action::TakeKeptTare => taring::restore(state, env),
            Action::Stage(id, value) => state.hand_mut().params.stage(id, value),
            Action::Param(action) => self.jobs.param_action(action, state, env),
        }
    }

    /// Records a user action with each hand that it affects.
    fn record_act(&mut self, action: &Action, now: Moment) {
        let State { hands, poses, .. } = &mut self.state;
        let goes_to_all = matches!(action, Action::Recall(_) | Action::Play(Play::Start(_)));
        for hand in hands.with_shown(|hand| goes_to_all && accepts_poses(hand)) {
            if let Some(done) = action.user_act(hand.connection.is_armed(), poses) {
                record_event(hand, now, EventKind::Person, done.words());
                hand.measured.recorder.record_user_act(done, now);
            }
        }
    }

    /// Stops (holds) every hand, shown or not.
    fn stop(&mut self) {
        hands::stop_all(&mut self.state, &self.env);
        if let Some(exhibit) = &mut self.state.exhibit {
            exhibit.wish(ExhibitWish::Stop);
        }
    }

    /// Reads further wire traffic. Called only while the user views it.
    pub fn read_traffic(&mut self, now: Moment) {
        let (state, now) = match &mut self.recorded.player {
            Some(player) => {
                let at = player.state.now;
                (&mut player.state, at)
            }
            None => (&mut self.state, now),
        };
        export::read_on(&mut state.hand_mut().connection.traffic, now);
    }

    /// Reads the persistent parameters while the user views them; sends requests only when they are due. Writes nothing.
    pub fn read_params_if_due(&mut self, now: Moment) {
        if self.recorded.player.is_some() {
            return;
        }
        let hand = self.state.hands.shown_mut();
        let of = ParamsHand {
            connection: &hand.connection,
            overshoot: &hand.overshoot.map,
            env: &self.env,
        };
        hand.params.read_if_due(of, now);
    }

    /// Reads the stored check-ups of the shown hand while the user views them.
    pub fn read_checkups(&mut self) {
        let State {
            hands, settings, ..
        } = &mut self.state;
        let hand = hands.shown_mut();
        let is_checked = hand.running.checkup_run().is_some();
        if self.recorded.player.is_none()
            && !is_checked
            && let Some(endpoint) = &hand.connection.endpoint
        {
            let files = files(endpoint, settings, &self.env);
            hand.checkup.read_last(files, &self.env);
        }
    }

    /// True if trials were run and the shown hand is idle, so that reading its persistent parameters disturbs nothing.
    pub fn may_keep_tried(&self) -> bool {
        let hand = self.state.hand();
        let is_free = hand.activity() == Activity::Idle && !hand.connection.is_armed();
        is_free && !self.state.trials.sessions.is_empty()
    }

    /// Shows an exhibition in place of the window. Nothing moves before staff arm.
    pub fn enter_exhibit(&mut self, start: Exhibition, now: Moment) {
        self.exhibit.enter(start, &mut self.state, &self.env, now);
    }

    /// Notes that a frame was drawn, so that STOP can be seen and pressed. An exhibition continues only while this is called.
    pub fn drawn(&self, now: Moment) {
        if let Some(exhibit) = &self.state.exhibit {
            exhibit.drawn.mark(now);
        }
    }

    /// Handles a request to close the window. True if work would be lost and the question is shown first, with the live hand.
    pub fn asks_before_closing(&mut self) -> bool {
        // An exhibition ends only with the PIN.
        if let Some(exhibit) = &mut self.state.exhibit {
            exhibit.ask(self.state.now);
            return true;
        }
        if self.leaves {
            return false;
        }
        self.state.leave = LeaveQuestion::of(&self.state.hands);
        let asks = self.state.leave.is_some();
        if asks {
            self.recorded.player = None;
        }
        asks
    }

    /// True once the user confirmed that the window should close, regardless of unsaved work.
    pub const fn leaves(&self) -> bool {
        self.leaves
    }

    /// Prepares closing the window. A hand that is armed, or that this program set in motion, is stopped first. True once the window
    /// may close: the hand rests, or 600 ms have passed, and all results are in files, or ten seconds have passed. Called each
    /// frame until then.
    pub fn close(&mut self, now: Moment) -> bool {
        let state = &mut self.state;
        let closing = *self
            .closing
            .get_or_insert_with(|| Closing::begin(state, &self.env, now));
        let saved = self.saved.flush(state, now);
        let rests = closing.is_at_rest(&state.hands);
        let reported = self.exhibit.flush(state, now);
        let trials = &state.trials;
        let checks = state
            .hands
            .iter()
            .any(|hand| hand.running.checkup_run().is_some());
        let tried =
            checks || trials.running.is_some() || !trials.to_keep.is_empty() || self.jobs.keeps();
        let is_kept = reported && !tried && self.recorded.is_written();
        let waited = now.since(closing.since);
        let goes =
            (saved && rests || waited >= REST_TIMEOUT) && (is_kept || waited >= SAVE_TIMEOUT);
        if goes {
            // A further frame must not start a file.
            self.records = false;
            let hands = state.hands.iter_mut();
            hands
                .filter_map(|hand| hand.recording.take())
                .for_each(HandRecording::end);
        }
        goes
    }
}

/// Opens the given hand, else the remembered one, else the built-in one.
pub(super) fn open(state: &mut State, endpoint: Option<Endpoint>, env: &Env, now: Moment) {
    let endpoint = endpoint
        .or_else(|| remembered(state, now))
        .unwrap_or_else(Endpoint::sim);
    state.now = now;
    hands::with_shown(state, env, |hand, settings, ctx| {
        hand.go(Some(endpoint), ctx);
        hand.apply_settings(settings);
    });
}

/// Opens further hands, each in its own slot; the first stays shown.
pub(super) fn open_beside(state: &mut State, endpoints: Vec<Endpoint>, env: &Env, now: Moment) {
    let first = state.hand().label.slot;
    for endpoint in endpoints {
        state.now = now;
        let is_new = !hands::is_open_elsewhere(state, &endpoint, None);
        if is_new && state.hands.has_room() {
            state.hands.add(now);
            open(state, Some(endpoint), env, now);
        }
    }
    state.hands.show(first);
}

fn remembered(state: &mut State, now: Moment) -> Option<Endpoint> {
    let text = state.settings.endpoint.clone()?;
    match text.parse() {
        Ok(endpoint) => Some(endpoint),
        Err(_) => {
            state
                .notices
                .push(now, NoticeKind::EndpointIgnored { text });
            None
        }
    }
}
