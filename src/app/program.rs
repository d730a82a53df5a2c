//! The program: carries out actions, lets hands and files go on, keeps settings. The rules of motion are with the hand.

use crate::app::action::Action;
use crate::app::env::Env;
use crate::app::exhibit::Exhibition;
use crate::app::exhibit::work::ExhibitWork;
use crate::app::files::export::{self, Export};
use crate::app::files::open::open;
use crate::app::files::pose_file;
use crate::app::files::quirk_notes::QuirkNotes;
use crate::app::files::settings_file;
use crate::app::hand::HandState;
use crate::app::hand::connection::REST_WITHIN;
use crate::app::hand::sequence::Play;
use crate::app::notices::NoticeKind;
use crate::app::params::ParamAction;
use crate::app::poses::PoseState;
use crate::app::sessions::SessionAction;
use crate::app::sessions::recording::HandRecording;
use crate::app::sessions::work::SessionWork;
use crate::app::settings::Settings;
use crate::app::state::{LeaveQuestion, State};
use crate::app::trials::TrialAction;
use crate::app::trials::files::{self, FilesEnd};
use crate::exhibit::run::ExhibitWish;
use crate::hand::{Dof, Moment};
use crate::history::MarkKind;
use crate::params::file::ParamsFile;
use crate::poses::library::{EntryId, LibraryPose, PoseLibrary};
use crate::poses::preview::Preview;
use crate::record::EventKind;
use crate::store::calendar::{since_1970, stamp};
use crate::store::{BackgroundJob, Saver, on_thread};
use crate::transport::{Endpoint, PortFound, ports};
use crate::trials::plan_settings::from_settings;
use std::path::PathBuf;
use std::time::Duration;

/// A series is over and written long before, on a disk that works.
const KEPT_WITHIN: Duration = Duration::from_secs(10);

/// The window is closing.
#[derive(Clone, Copy)]
struct Closing {
    since: Moment,
    /// The hand was told to hold, and that is waited for.
    held: bool,
}

/// The whole program without its window.
pub struct App {
    env: Env,
    state: State,
    settings_saver: Saver<Settings>,
    pose_saver: Saver<PoseLibrary>,
    quirk_notes: QuirkNotes,
    closing: Option<Closing>,
    finding_ports: Option<BackgroundJob<Vec<PortFound>>>,
    exporting: Option<BackgroundJob<NoticeKind>>,
    importing: Option<BackgroundJob<Result<PoseLibrary, NoticeKind>>>,
    exhibit: ExhibitWork,
    sessions: Option<BackgroundJob<FilesEnd>>,
    keeping: Option<BackgroundJob<FilesEnd>>,
    recorded: SessionWork,
    records: bool,
    leaves: bool,
}

impl App {
    /// Connects to nothing by itself.
    #[must_use]
    pub fn new(env: Env, settings: Settings) -> Self {
        let (path, runtime) = (env.settings_path.clone(), env.runtime.clone());
        let settings_saver = Saver::new(path, runtime, settings.clone(), settings_file::text);
        let mut state = State {
            settings,
            ..State::default()
        };
        match from_settings(state.settings.trial_plan.as_ref()) {
            Ok(plan) => state.trials.plan = plan,
            Err(error) => {
                let message = error.to_string();
                state
                    .notices
                    .push(Moment::ZERO, NoticeKind::PlanIgnored { message });
            }
        }
        let pose_path = env.settings_path.as_deref().map(pose_file::path_beside);
        let (library, notice) = pose_path
            .as_deref()
            .map(pose_file::load)
            .unwrap_or_default();
        if let Some(what) = notice {
            state.notices.push(Moment::ZERO, what);
        }
        let runtime = env.runtime.clone();
        let pose_saver = Saver::new(pose_path, runtime, library.clone(), pose_file::text);
        state.poses = PoseState::new(library);
        Self {
            quirk_notes: QuirkNotes::new(env.settings_path.as_deref()),
            env,
            state,
            settings_saver,
            pose_saver,
            closing: None,
            finding_ports: None,
            exporting: None,
            importing: None,
            exhibit: ExhibitWork::default(),
            sessions: None,
            keeping: None,
            recorded: SessionWork::default(),
            records: true,
            leaves: false,
        }
    }

    /// At start: the given hand, else the remembered one, else the built-in one. Remembers nothing.
    pub fn open(&mut self, endpoint: Option<Endpoint>, now: Moment) {
        let endpoint = endpoint
            .or_else(|| self.remembered(now))
            .unwrap_or_else(Endpoint::sim);
        let State {
            hands,
            notices,
            settings,
            ..
        } = &mut self.state;
        let hand = hands.shown_mut();
        hand.now = now;
        hand.go(Some(endpoint), &self.env, notices);
        hand.know(settings);
    }

    /// At start: further hands, each in a slot of its own; the first stays shown. Remembers nothing.
    pub fn open_beside(&mut self, endpoints: Vec<Endpoint>, now: Moment) {
        let first = self.state.hand().label.slot;
        for endpoint in endpoints {
            self.state.now = now;
            let is_new = !self.state.is_open_elsewhere(&endpoint, None);
            if is_new && self.state.hands.has_room() {
                self.state.hands.add();
                self.open(Some(endpoint), now);
            }
        }
        self.state.hands.show(first);
    }

    fn remembered(&mut self, now: Moment) -> Option<Endpoint> {
        let text = self.state.settings.endpoint.clone()?;
        match text.parse() {
            Ok(endpoint) => Some(endpoint),
            Err(_) => {
                self.tell(NoticeKind::EndpointIgnored { text }, now);
                None
            }
        }
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
    #[must_use]
    pub fn state(&self) -> &State {
        let replayed = self.recorded.player.as_ref();
        replayed.map_or(&self.state, |player| &player.state)
    }

    /// The live hands, whatever is shown.
    #[must_use]
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
            scan,
            fleet,
            ..
        } = &mut self.state;
        let env = &self.env;
        let is_several = hands.is_several();
        for hand in hands.iter_mut() {
            hand.know(settings);
            notices.about(is_several.then_some(&hand.label));
            hand.take_news(notices, now);
            hand.tick_sequence();
            hand.tick_inputs(notices, settings);
            hand.tick_hold(settings.hold_to_run);
            hand.tick_requests(notices);
            hand.tick_params(env, notices);
            hand.tick_series(trials, notices);
            hand.tick_procedure(env, settings, notices);
            hand.read_first(settings.read_first);
            hand.offer_tare(settings);
            hand.record();
            if self.records {
                hand.tick_recording(settings, env);
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
        self.state.sweep();
        self.exhibit.tick(&mut self.state, &self.env, now);
        self.take_jobs(now);
        self.recorded.tick(&mut self.state, &self.env);
        if self.state.exhibit.is_some() {
            // A replay would cover the page, and lead from it.
            self.recorded.player = None;
        }
        self.save_changes(now);
    }

    fn take_jobs(&mut self, now: Moment) {
        if let Some(found) = BackgroundJob::take_from(&mut self.finding_ports) {
            self.state.ports = found;
        }
        if let Some(end) = BackgroundJob::take_from(&mut self.exporting) {
            self.tell(end, now);
        }
        let asked = BackgroundJob::take_from(&mut self.sessions);
        if let Some(end) = &asked {
            let trials = &mut self.state.trials;
            trials.asks_path = std::mem::take(&mut trials.is_opening) && end.is_err();
        }
        let kept = BackgroundJob::take_from(&mut self.keeping);
        for end in asked.into_iter().chain(kept) {
            let told = self.state.trials.take(end);
            self.tell(told, now);
        }
        while self.keeping.is_none()
            && let Some(id) = self.state.trials.to_keep.pop_front()
        {
            let session = self.state.trials.session(id);
            self.keeping = session.and_then(|session| files::keep(session, &self.env));
        }
        match BackgroundJob::take_from(&mut self.importing) {
            None => {}
            // All of it is added, or nothing.
            Some(Ok(library)) => {
                let (poses, sequences) = (library.poses.len(), library.sequences.len());
                self.state.poses.import(library);
                self.tell(NoticeKind::PosesImported { poses, sequences }, now);
            }
            Some(Err(refused)) => {
                self.state.poses.refused = Some(refused.clone());
                self.tell(refused, now);
            }
        }
    }

    fn save_changes(&mut self, now: Moment) {
        let at = now.since(Moment::ZERO);
        // What a visitor chooses is not what staff chose.
        let settings = match self.state.exhibit {
            Some(_) => Ok(()),
            None => self.settings_saver.tick(&self.state.settings, at),
        };
        let poses = self.pose_saver.tick(&self.state.poses.library, at);
        for (path, error) in [settings.err(), poses.err()].into_iter().flatten() {
            self.tell(NoticeKind::not_saved(path, &error), now);
        }
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
        if self.state.exhibit.is_some() && !action.passes_in_exhibit() {
            return;
        }
        self.state.notices.about(None);
        let hand = self.state.hand_mut();
        hand.now = now;
        if hand.runs_series() && action.disturbs_series() {
            self.tell(NoticeKind::SeriesRuns, now);
            return;
        }
        self.record_act(&action, now);
        match action {
            Action::Arm | Action::HoldKey(_) if self.closing.is_some() => {}
            Action::Session(action) => {
                let on = [
                    SessionAction::Record(true),
                    SessionAction::RecordSimulated(true),
                ];
                // A press of a person counts more than how the program was started.
                self.records |= on.contains(&action);
                self.recorded.act(action, &mut self.state, &self.env);
            }
            Action::Exhibit(action) => {
                self.leaves |= self.exhibit.act(action, &mut self.state, &self.env);
            }
            Action::Param(action) => self.param_action(action),
            Action::Trial(action) => self.trial_action(action),
            Action::Save(content) => self.export(content),
            Action::ImportPoses(typed) => self.import_poses(typed),
            Action::ExportPoses => self.export(Export::Poses(self.state.poses.library.clone())),
            Action::FindPorts => self.find_ports(),
            Action::Connect(endpoint) => self.connect(Some(endpoint)),
            Action::Disconnect => self.connect(None),
            Action::Hands(action) => self.state.hands_action(action, &self.env),
            Action::Stop => self.stop(),
            Action::HoldKey(key) => self.state.hold_key(key),
            Action::Scan(wish) => {
                let held = self.state.hands.iter();
                let held = held.filter_map(|hand| hand.endpoint.clone()).collect();
                self.state.scan.begin(wish, held, &self.env);
            }
            Action::CancelScan => self.state.scan.cancel(),
            Action::FindShared(interface) => self.state.fleet.listen(interface, &self.env),
            Action::Dismiss(id) => self.state.notices.dismiss(id),
            Action::Stay => self.state.leave = None,
            Action::Leave => (self.leaves, self.state.leave) = (true, None),
            action => self.hand_action(action, now),
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

    /// What is done with the hand that is shown.
    fn hand_action(&mut self, action: Action, now: Moment) {
        let State {
            hands,
            notices,
            settings,
            ..
        } = &mut self.state;
        if hands.is_several() {
            notices.about(Some(&hands.shown().label));
        }
        let (hand, env) = (hands.shown_mut(), &self.env);
        match action {
            Action::Arm => hand.arm(notices),
            Action::HoldToRun(on) => {
                settings.hold_to_run = on;
                hands.iter_mut().for_each(|hand| hand.tick_hold(on));
            }
            Action::Disarm => hand.disarm(),
            Action::Target(dof, angle) => hand.target(dof, angle),
            Action::Force(dof, force) => each(dof).for_each(|dof| hand.force(dof, force)),
            Action::Speed(dof, speed) => each(dof).for_each(|dof| hand.speed(dof, speed)),
            Action::Lock(dof, locked) => hand.lock(dof, locked),
            Action::Preset(preset) => hand.preset(preset),
            Action::Gesture(gesture) => {
                hand.gesture(gesture, settings.gesture_route, env, notices);
            }
            Action::ClearErrors if hand.procedure.is_none() => hand.clear_errors(env, notices),
            Action::ChangePlace(id, wanted) => hand.open_place_change(id, wanted),
            Action::FactoryReset => hand.open_reset(),
            Action::CalibrateForce => hand.open_calibration(),
            Action::Procedure(action) => hand.procedure_action(action, env),
            Action::Input(action) => hand.input_action(action, settings, env),
            Action::Tare(finger) => {
                hand.tare(finger, notices);
                hand.keep_tare(settings);
            }
            Action::UndoTare => {
                hand.tare.undo();
                hand.keep_tare(settings);
            }
            Action::TakeKeptTare => hand.take_kept_tare(notices),
            Action::SeenFault(dof, what) => hand.faults.see_one(dof, what),
            Action::SeenFaults => hand.faults.see_all(),
            Action::Note(at, words) => {
                if let Some(note) = MarkKind::note(&words) {
                    hand.record_event(at, EventKind::Note, words.trim().to_owned());
                    hand.history.mark(at, note);
                }
            }
            Action::RemoveMark(mark) => {
                if let MarkKind::Note(words) = &mark.kind {
                    hand.record_event(mark.at, EventKind::NoteRemoved, words.to_string());
                }
                hand.history.remove_mark(&mark);
            }
            Action::Stage(id, value) => hand.params.stage(id, value),
            action => self.pose_action(action, now),
        }
    }

    /// Poses and sequences.
    fn pose_action(&mut self, action: Action, now: Moment) {
        let State {
            hands,
            notices,
            poses,
            settings,
            ..
        } = &mut self.state;
        match action {
            Action::Capture(name) => match hands.shown().pose_now() {
                Some(angles) => {
                    poses.newest = poses.library.add_pose(&name, LibraryPose::at(angles))
                }
                None => notices.push(now, NoticeKind::PoseUnknown),
            },
            Action::Recapture(id) => match hands.shown().pose_now() {
                Some(angles) => {
                    let mut known = poses.library.poses.iter_mut();
                    if let Some(pose) = known.find(|pose| pose.id == id) {
                        pose.angles = angles;
                    }
                }
                None => notices.push(now, NoticeKind::PoseUnknown),
            },
            Action::Library(edit) => poses.edit(edit),
            Action::HideShipped(name, hide) => {
                let hidden = &mut settings.hidden_poses;
                match hide {
                    true => hidden.insert(name),
                    false => hidden.remove(&name),
                };
            }
            Action::Recall(id) => {
                let plan = poses.plan(EntryId::Pose(id));
                for hand in hands.with_shown(|hand| hand.takes_poses()) {
                    hand.now = now;
                    let plan = plan.clone();
                    if plan.is_some_and(|plan| hand.recall(plan, &self.env)) {
                        poses.recalled = Some(id);
                    }
                }
            }
            Action::DryRun(sequence) => {
                let angle = hands.shown().sample.angle;
                let from = crate::hand::PerDof::from_fn(|dof| {
                    angle.and_then(|angle| angle.value[dof].documented())
                });
                let preview = |id| Preview::of(poses.library_of(id), id, from, now);
                poses.preview = sequence.and_then(preview);
            }
            Action::Play(play) => {
                if matches!(play, Play::Start(_) | Play::Step(_)) {
                    poses.preview = None;
                }
                let entry = hands.shown().sequence.as_ref().map(|run| run.entry);
                for hand in hands.with_shown(|hand| hand.plays_along(play, entry)) {
                    hand.now = now;
                    hand.play(play, poses, &self.env);
                }
            }
            action => self.keep(action),
        }
    }

    /// What is kept from one start to the next.
    fn keep(&mut self, action: Action) {
        let State {
            hands, settings, ..
        } = &mut self.state;
        match action {
            Action::Side(side) => {
                if let Some(endpoint) = &hands.shown().endpoint {
                    settings.set_side_of(endpoint, side);
                }
                // Others of which nobody said a side have the one that was said last.
                if !hands.is_several() {
                    settings.side = side;
                }
                hands.shown_mut().know(settings);
            }
            Action::NameGesture(gesture, name) => settings.name_gesture(gesture, &name),
            Action::GestureRoute(route) => settings.gesture_route = route,
            Action::Theme(theme) => settings.theme = theme,
            Action::Layout(layout) => settings.layout = layout,
            Action::ReadFirst(first) => settings.read_first = first,
            Action::Zoom(zoom) => settings.zoom = zoom,
            Action::Language(language) => settings.language = language,
            Action::AngleUnit(unit) => settings.angle_unit = unit,
            Action::PlotWindow(window) => settings.plot_window = window,
            Action::ShowPlot(kind, on) => settings.plots.set(kind, on),
            // Standing plots are the view's own matter, and all others were carried out before.
            _ => {}
        }
    }

    fn connect(&mut self, to: Option<Endpoint>) {
        let slot = self.state.hand().label.slot;
        if let Some(endpoint) = &to {
            if self.state.is_open_elsewhere(endpoint, Some(slot)) {
                return;
            }
            // A scan may still ask further ids on the port that is wanted.
            self.state.scan.cancel();
            self.state.settings.remember(endpoint);
        }
        let State {
            hands,
            notices,
            settings,
            ..
        } = &mut self.state;
        if hands.is_several() {
            notices.about(Some(&hands.shown().label));
        }
        let hand = hands.shown_mut();
        hand.is_removed = false;
        hand.close_procedure();
        hand.leave(to, &self.env, notices);
        hand.know(settings);
    }

    /// What is done with files is begun here, all else with the hand.
    fn param_action(&mut self, action: ParamAction) {
        match action {
            ParamAction::Dump => {
                let hand = self.state.hand();
                let params = hand.params.live_params();
                if params.is_empty() {
                    return;
                }
                let file = ParamsFile {
                    hand: hand.name(),
                    at: stamp(since_1970()),
                    why: "dump".into(),
                    params,
                    ..ParamsFile::default()
                };
                self.export(Export::Params(Box::new(file)));
            }
            action => self.state.hands.shown_mut().param_action(action, &self.env),
        }
    }

    fn trial_action(&mut self, action: TrialAction) {
        let State {
            hands,
            trials,
            settings,
            ..
        } = &mut self.state;
        match action {
            TrialAction::Start => hands.shown_mut().start_series(trials, &self.env),
            TrialAction::Open(_) | TrialAction::Save(..) if self.sessions.is_some() => {}
            TrialAction::Open(typed) => {
                trials.is_opening = true;
                self.sessions = Some(files::open(typed, &self.env));
            }
            TrialAction::Save(id, criterion) => {
                let session = trials.session(id);
                let save = |session| files::save(session, criterion, &self.env);
                self.sessions = session.and_then(save);
            }
            action => trials.act(action, settings),
        }
    }

    /// One file at a time: while a dialog is open, another is not opened.
    fn export(&mut self, content: Export) {
        if self.exporting.is_none() {
            self.exporting = Some(export::save(content, &self.env));
        }
    }

    fn import_poses(&mut self, typed: Option<PathBuf>) {
        if self.importing.is_none() {
            self.state.poses.refused = None;
            let import = open(typed, pose_file::FILE_NAME, &self.env, pose_file::read);
            self.importing = Some(import);
        }
    }

    fn find_ports(&mut self) {
        if self.finding_ports.is_none() {
            let find = async { on_thread(|| Ok(ports())).await.unwrap_or_default() };
            self.finding_ports = Some(BackgroundJob::start(
                &self.env.runtime,
                &self.env.wake,
                find,
            ));
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

    /// A person wants to close the window. True if something would be lost and they are asked first; the live hand is shown then.
    pub fn asks_before_closing(&mut self) -> bool {
        // The way out of an exhibition is the PIN.
        if let Some(exhibit) = &mut self.state.exhibit {
            exhibit.ask(self.state.now);
            return true;
        }
        let series = self.state.hands.iter().any(HandState::runs_series);
        let staged = |hand: &HandState| hand.params.all_staged().iter().count();
        let edits = self.state.hands.iter().map(staged).sum();
        let asks = !self.leaves && (series || edits > 0);
        if asks {
            self.recorded.player = None;
            self.state.leave = Some(LeaveQuestion { series, edits });
        }
        asks
    }

    /// True once a person said that the window should close, whatever is lost.
    #[must_use]
    pub const fn leaves(&self) -> bool {
        self.leaves
    }

    /// The window is about to close. A hand that is armed, or that this program set in motion, is stopped first.
    /// True once the window may go: the hand rests, or 600 ms have passed, and what was tried is in files, or
    /// [`KEPT_WITHIN`] has passed. Call it each frame until then.
    pub fn close(&mut self, now: Moment) -> bool {
        let State { hands, notices, .. } = &mut self.state;
        let closing = *self.closing.get_or_insert_with(|| {
            let mut held = false;
            let is_several = hands.is_several();
            for hand in hands.iter_mut().filter(|hand| hand.may_move()) {
                hand.now = now;
                notices.about(is_several.then_some(&hand.label));
                hand.stop(notices);
                held = true;
            }
            Closing { since: now, held }
        });
        let at = now.since(Moment::ZERO);
        let poses = self.pose_saver.flush(&self.state.poses.library, at);
        let saved = self.settings_saver.flush(&self.state.settings, at) && poses;
        let is_held = |hand: &HandState| hand.is_held(closing.since);
        let rests = !closing.held || self.state.hands.iter().all(is_held);
        let trials = &self.state.trials;
        let is_kept = trials.running.is_none() && trials.to_keep.is_empty();
        let is_kept = self.exhibit.flush(&mut self.state, now) && is_kept;
        let is_kept = is_kept && self.keeping.is_none() && self.recorded.is_written();
        let waited = now.since(closing.since);
        let goes = (saved && rests || waited >= REST_WITHIN) && (is_kept || waited >= KEPT_WITHIN);
        if goes {
            let hands = self.state.hands.iter_mut();
            hands
                .filter_map(|hand| hand.recording.take())
                .for_each(HandRecording::end);
        }
        goes
    }
}

/// One joint, or all.
fn each(dof: Option<Dof>) -> impl Iterator<Item = Dof> {
    Dof::ALL
        .into_iter()
        .filter(move |own| dof.is_none_or(|dof| dof == *own))
}
