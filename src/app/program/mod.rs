//! The program: carries out actions, lets hands and files go on. The rules of motion are with the hand.

mod closing;
mod hand_actions;
mod jobs;
mod pose_actions;
mod saved;
mod start;

use crate::app::action::Action;
use crate::app::env::Env;
use crate::app::exhibit::Exhibition;
use crate::app::exhibit::work::ExhibitWork;
use crate::app::files::export::{self, Export};
use crate::app::files::quirk_notes::QuirkNotes;
use crate::app::hand::HandState;
use crate::app::hand::connection::REST_WITHIN;
use crate::app::hand::sequence::Play;
use crate::app::notices::NoticeKind;
use crate::app::program::closing::Closing;
use crate::app::program::hand_actions::each;
use crate::app::program::jobs::Jobs;
use crate::app::program::saved::SavedFiles;
use crate::app::sessions::SessionAction;
use crate::app::sessions::recording::HandRecording;
use crate::app::sessions::work::SessionWork;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::exhibit::run::ExhibitWish;
use crate::hand::Moment;
use crate::record::EventKind;
use crate::transport::Endpoint;
use std::time::Duration;

/// A series is over and written long before, on a disk that works.
const KEPT_WITHIN: Duration = Duration::from_secs(10);

/// The whole program without its window.
pub struct App {
    env: Env,
    state: State,
    saved: SavedFiles,
    quirk_notes: QuirkNotes,
    closing: Option<Closing>,
    jobs: Jobs,
    exhibit: ExhibitWork,
    recorded: SessionWork,
    records: bool,
    leaves: bool,
}

impl App {
    /// Connects to nothing by itself.
    pub fn new(env: Env, settings: Settings) -> Self {
        let (saved, state) = SavedFiles::load(settings, &env);
        Self {
            quirk_notes: QuirkNotes::new(env.settings_path.as_deref()),
            env,
            state,
            saved,
            closing: None,
            jobs: Jobs::default(),
            exhibit: ExhibitWork::default(),
            recorded: SessionWork::default(),
            records: true,
            leaves: false,
        }
    }

    /// At start: the given hand, else the remembered one, else the built-in one. Remembers nothing.
    pub fn open(&mut self, endpoint: Option<Endpoint>, now: Moment) {
        self.state.open(endpoint, &self.env, now);
    }

    /// At start: further hands, each in a slot of its own; the first stays shown. Remembers nothing.
    pub fn open_beside(&mut self, endpoints: Vec<Endpoint>, now: Moment) {
        self.state.open_beside(endpoints, &self.env, now);
    }

    /// Records nothing in this run, whatever the settings say.
    pub fn record_nothing(&mut self) {
        self.records = false;
    }

    /// Tells the person something that was found elsewhere, such as an unreadable settings file.
    pub fn tell(&mut self, what: NoticeKind, now: Moment) {
        if let Some(player) = &mut self.recorded.player {
            player.tell(what.clone());
        }
        self.state.notices.about(None);
        self.state.notices.push(now, what);
    }

    /// Everything the window shows: the live hands, or the session that is replayed.
    pub fn state(&self) -> &State {
        let replayed = self.recorded.player.as_ref();
        replayed.map_or(&self.state, |player| &player.state)
    }

    /// The live hands, whatever is shown.
    pub const fn live(&self) -> &State {
        &self.state
    }

    /// Takes in what happened since the last call. Runs also while the window is hidden.
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
        let env = &self.env;
        let is_several = hands.is_several();
        for hand in hands.iter_mut() {
            hand.apply_settings(settings);
            notices.about(is_several.then_some(&hand.label));
            hand.take_news(notices, now);
            hand.tick_sequence();
            hand.tick_inputs(notices, settings, poses);
            hand.tick_hold(settings.hold_to_run);
            hand.tick_requests(notices);
            hand.tick_params(env, notices);
            hand.tick_series(trials, notices);
            hand.tick_procedure(env, settings, notices);
            hand.read_first(settings.read_first);
            hand.offer_tare(settings);
            hand.record();
            if self.records {
                hand.tick_recording(settings, env, notices);
            }
            hand.go_on_leaving(env, notices);
            self.quirk_notes.tick(hand, env, notices, now);
        }
        notices.about(None);
        let has = |hand: &HandState, id| hand.series.as_ref().is_some_and(|run| run.session == id);
        let told = trials.close_broken_off(|id| hands.iter().any(|hand| has(hand, id)));
        told.into_iter().for_each(|told| notices.push(now, told));
        scan.drain();
        fleet.drain();
        self.state.stop_mirrored();
        self.state.drop_removed();
        self.exhibit.tick(&mut self.state, &self.env, now);
        let told = self.jobs.tick(&mut self.state, &self.env);
        told.into_iter().for_each(|told| self.tell(told, now));
        self.recorded.tick(&mut self.state, &self.env);
        if self.state.exhibit.is_some() {
            // A replay would cover the page, and lead from it.
            self.recorded.player = None;
        }
        let told = self.saved.tick(&self.state, now);
        told.into_iter().for_each(|told| self.tell(told, now));
    }

    /// Carries out one thing that a person asked for.
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
        self.state.notices.about(None);
        let hand = self.state.hand_mut();
        hand.now = now;
        if hand.runs_series() && !action.effect().passes_in_series() {
            self.tell(NoticeKind::SeriesRuns, now);
            return;
        }
        self.record_act(&action, now);
        self.carry_out(action);
    }

    fn carry_out(&mut self, action: Action) {
        let (state, env) = (&mut self.state, &self.env);
        match action {
            Action::Stop => self.stop(),
            Action::Arm if self.closing.is_some() => {}
            Action::Arm => {
                let (hand, notices, _) = state.shown();
                hand.arm(notices);
            }
            Action::Disarm => state.hand_mut().disarm(),
            Action::HoldToRun(on) => state.set_hold_to_run(on),
            Action::HoldKey(_) if self.closing.is_some() => {}
            Action::HoldKey(key) => state.hold_key(key),
            Action::Target(dof, angle) => state.hand_mut().target(dof, angle),
            Action::Force(dof, force) => {
                each(dof).for_each(|dof| state.hand_mut().force(dof, force));
            }
            Action::Speed(dof, speed) => {
                each(dof).for_each(|dof| state.hand_mut().speed(dof, speed));
            }
            Action::Lock(dof, locked) => state.hand_mut().lock(dof, locked),
            Action::Preset(preset) => state.hand_mut().preset(preset),
            Action::Gesture(gesture) => state.gesture(gesture, env),
            Action::Capture(name) => state.capture(&name),
            Action::Recapture(id) => state.recapture(id),
            Action::Library(edit) => state.poses.edit(edit),
            Action::Recall(id) => state.recall(id, env),
            Action::Play(play) => state.play(play, env),
            Action::HideShipped(name, hide) => state.hide_shipped(name, hide),
            Action::DryRun(sequence) => state.dry_run(sequence),
            Action::Session(action) => {
                let on = [
                    SessionAction::Record(true),
                    SessionAction::RecordSimulated(true),
                ];
                // A press of a person counts more than how the program was started.
                self.records |= on.contains(&action);
                self.recorded.act(action, state, env);
            }
            Action::Exhibit(action) => self.leaves |= self.exhibit.act(action, state, env),
            Action::Input(action) => state.input_action(action, env),
            Action::Trial(action) => self.jobs.trial_action(action, state, env),
            Action::ImportPoses(typed) => self.jobs.import_poses(typed, state, env),
            Action::ExportPoses => {
                let library = state.poses.library.clone();
                self.jobs.export(Export::Poses(library), env);
            }
            Action::NameGesture(gesture, name) => state.settings.name_gesture(gesture, &name),
            Action::GestureRoute(route) => state.settings.gesture_route = route,
            // A card that is open clears them itself, or must not be disturbed.
            Action::ClearErrors if state.hand().procedure.is_some() => {}
            Action::ClearErrors => {
                let (hand, notices, _) = state.shown();
                hand.clear_errors(env, notices);
            }
            Action::ChangePlace(id, wanted) => state.hand_mut().open_place_change(id, wanted),
            Action::FactoryReset => state.hand_mut().open_reset(),
            Action::CalibrateForce => state.hand_mut().open_calibration(),
            Action::Procedure(action) => state.hand_mut().procedure_action(action, env),
            Action::Connect(endpoint) => state.connect(Some(endpoint), env),
            Action::Disconnect => state.connect(None, env),
            Action::Hands(action) => state.hands_action(action, env),
            Action::FindPorts => self.jobs.find_ports(env),
            Action::Scan(wish) => {
                let held = state.hands.iter();
                let held = held.filter_map(|hand| hand.endpoint.clone()).collect();
                state.scan.begin(wish, held, env);
            }
            Action::CancelScan => state.scan.cancel(),
            Action::FindShared(interface) => state.fleet.listen(interface, env),
            Action::SeenFault(dof, what) => state.hand_mut().faults.see_one(dof, what),
            Action::SeenFaults => state.hand_mut().faults.see_all(),
            Action::Save(content) => self.jobs.export(content, env),
            // The shell draws it, and asks for its file to be saved then.
            Action::SavePicture(_) => {}
            Action::Stay => state.leave = None,
            Action::Leave => (self.leaves, state.leave) = (true, None),
            Action::Dismiss(id) => state.notices.dismiss(id),
            Action::Theme(theme) => state.settings.theme = theme,
            Action::Side(side) => state.set_side(side),
            Action::Language(language) => state.settings.language = language,
            Action::Layout(layout) => state.settings.layout = layout,
            Action::Zoom(zoom) => state.settings.zoom = zoom,
            Action::ReadFirst(first) => state.settings.read_first = first,
            Action::AngleUnit(unit) => state.settings.angle_unit = unit,
            Action::PlotWindow(window) => state.settings.plot_window = window,
            Action::ShowPlot(kind, on) => state.settings.plots.set(kind, on),
            Action::Note(at, words) => state.note(at, &words),
            Action::RemoveMark(mark) => state.remove_mark(&mark),
            Action::Tare(finger) => state.tare(finger),
            Action::UndoTare => state.undo_tare(),
            Action::TakeKeptTare => {
                let (hand, notices, _) = state.shown();
                hand.take_kept_tare(notices);
            }
            Action::Stage(id, value) => state.hand_mut().params.stage(id, value),
            Action::Param(action) => self.jobs.param_action(action, state, env),
        }
    }

    /// Keeps with each hand what a person does to it.
    fn record_act(&mut self, action: &Action, now: Moment) {
        let State { hands, poses, .. } = &mut self.state;
        let goes_to_all = matches!(action, Action::Recall(_) | Action::Play(Play::Start(_)));
        for hand in hands.with_shown(|hand| goes_to_all && hand.takes_poses()) {
            if let Some(done) = action.person_act(hand.is_armed(), poses) {
                hand.record_event(now, EventKind::Person, done.words());
                hand.recorder.person(done, now);
            }
        }
    }

    /// Holds every hand, shown or not.
    fn stop(&mut self) {
        self.state.stop_all();
        if let Some(exhibit) = &mut self.state.exhibit {
            exhibit.wish(ExhibitWish::Stop);
        }
    }

    /// Reads on what went over the wire. Called while somebody looks at it, and only then.
    pub fn read_traffic(&mut self, now: Moment) {
        let (state, now) = match &mut self.recorded.player {
            Some(player) => {
                let at = player.state.now;
                (&mut player.state, at)
            }
            None => (&mut self.state, now),
        };
        export::read_on(&mut state.hand_mut().traffic, now);
    }

    /// Reads what the hand keeps because somebody looks at it. Called while they do; asks only when it is due. Writes nothing.
    pub fn look_at_params(&mut self, now: Moment) {
        if self.recorded.player.is_some() {
            return;
        }
        let hand = self.state.hands.shown_mut();
        hand.now = now;
        hand.look_at_params(&self.env);
    }

    /// Shows an exhibition in place of the window from now on. Nothing moves before staff arm.
    pub fn enter_exhibit(&mut self, start: Exhibition, now: Moment) {
        self.exhibit.enter(start, &mut self.state, &self.env, now);
    }

    /// A frame was drawn: whoever stands before it can see and press STOP. An exhibition goes on only while this is called.
    pub fn drawn(&self, now: Moment) {
        if let Some(exhibit) = &self.state.exhibit {
            exhibit.drawn.mark(now);
        }
    }

    /// A person wants to close the window. True if something would be lost and they are asked first; the live hand is shown then.
    pub fn asks_before_closing(&mut self) -> bool {
        // The way out of an exhibition is the PIN.
        if let Some(exhibit) = &mut self.state.exhibit {
            exhibit.ask(self.state.now);
            return true;
        }
        if self.leaves {
            return false;
        }
        self.state.leave = closing::question(&self.state.hands);
        let asks = self.state.leave.is_some();
        if asks {
            self.recorded.player = None;
        }
        asks
    }

    /// True once a person said that the window should close, whatever is lost.
    pub const fn leaves(&self) -> bool {
        self.leaves
    }

    /// The window is about to close. A hand that is armed, or that this program set in motion, is stopped first.
    /// True once the window may go: the hand rests, or 600 ms have passed, and what was tried is in files, or
    /// [`KEPT_WITHIN`] has passed. Call it each frame until then.
    pub fn close(&mut self, now: Moment) -> bool {
        let state = &mut self.state;
        let closing = *self
            .closing
            .get_or_insert_with(|| Closing::begin(state, now));
        let saved = self.saved.flush(state, now);
        let rests = closing.is_at_rest(&state.hands);
        let reported = self.exhibit.flush(state, now);
        let trials = &state.trials;
        let tried = trials.running.is_some() || !trials.to_keep.is_empty() || self.jobs.keeps();
        let is_kept = reported && !tried && self.recorded.is_written();
        let waited = now.since(closing.since);
        let goes = (saved && rests || waited >= REST_WITHIN) && (is_kept || waited >= KEPT_WITHIN);
        if goes {
            let hands = state.hands.iter_mut();
            hands
                .filter_map(|hand| hand.recording.take())
                .for_each(HandRecording::end);
        }
        goes
    }
}
