//! The program: opens and leaves hands, carries out actions, keeps settings. The rules of motion are in `act`.

use crate::app::action::Action;
use crate::app::calendar::{since_1970, stamp};
use crate::app::config::Saver;
use crate::app::desk::Desk;
use crate::app::device::keeper::DeviceKeeper;
use crate::app::device::wish::DeviceWish;
use crate::app::guard::keeper::Guarding;
use crate::app::notices::NoticeKind;
use crate::app::params::file::ParamsFile;
use crate::app::poses::book::PoseBook;
use crate::app::poses::library::Library;
use crate::app::poses::store::{self, Reading};
use crate::app::recorder::Deed;
use crate::app::save::{self, ChooseFile, Content, Saving};
use crate::app::scan::Scanner;
use crate::app::settings::Settings;
use crate::app::sheet_keeper::SheetKeeper;
use crate::app::state::{PortChoice, State};
use crate::app::tuner::TrialWish;
use crate::app::tuner::files::Files;
use crate::app::tuner::kept;
use crate::hand::Moment;
use crate::link::{self, Clock, LinkConfig, PollRates, Wake};
use crate::transport::{Dial, Endpoint, PortFound, ports};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::oneshot;

/// A hand that was told to hold gets this long to show that it rests, before its link is closed anyway: the
/// time after which the link itself gives the alarm, and a little.
const REST_WITHIN: Duration = Duration::from_millis(600);

/// What the program stands on.
#[derive(Clone)]
pub struct Env {
    /// Where links live and files are written.
    pub runtime: tokio::runtime::Handle,
    /// The program's clock.
    pub clock: Clock,
    /// How wires are opened.
    pub dial: Arc<dyn Dial>,
    /// Called when something new is there.
    pub wake: Wake,
    /// How a person is asked where a file should go.
    pub files: Arc<dyn ChooseFile>,
    /// Where settings are kept; `None` = nowhere.
    pub settings_path: Option<PathBuf>,
}

/// A hand that is being left: it was told to hold.
struct Leaving {
    /// Where to go then; `None` = nowhere.
    to: Option<Endpoint>,
    told: Moment,
}

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
    desk: Desk,
    saver: Saver<Settings>,
    pose_saver: Saver<Library>,
    reading: Option<Reading>,
    sheets: SheetKeeper,
    params: DeviceKeeper,
    guarding: Guarding,
    leaving: Option<Leaving>,
    closing: Option<Closing>,
    ports: Option<oneshot::Receiver<Vec<PortFound>>>,
    saving: Option<Saving>,
    sessions: Option<Files>,
    scanner: Scanner,
}

impl App {
    /// Connects to nothing by itself.
    #[must_use]
    pub fn new(env: Env, settings: Settings) -> Self {
        let saver = Saver::new(
            env.settings_path.clone(),
            env.runtime.clone(),
            settings.clone(),
        );
        let mut desk = Desk::new(settings);
        match kept::draft(desk.state.settings.trial_plan.as_ref()) {
            Ok(draft) => desk.state.tuner.draft = draft,
            Err(error) => {
                let message = error.to_string();
                let what = NoticeKind::PlanIgnored { message };
                desk.state.notices.push(Moment::ZERO, what);
            }
        }
        let pose_path = env.settings_path.as_deref().map(store::path_beside);
        let (library, notice) = pose_path.as_deref().map(store::load).unwrap_or_default();
        if let Some(what) = notice {
            desk.state.notices.push(Moment::ZERO, what);
        }
        let pose_saver = Saver::new(pose_path, env.runtime.clone(), library.clone());
        desk.state.poses = PoseBook::new(library);
        let sheets = SheetKeeper::new(env.settings_path.as_deref(), env.runtime.clone());
        let params = DeviceKeeper::new(
            env.settings_path.as_deref(),
            env.runtime.clone(),
            Arc::clone(&env.wake),
        );
        let guarding = Guarding::new(
            env.settings_path.as_deref(),
            env.runtime.clone(),
            Wake::clone(&env.wake),
        );
        Self {
            guarding,
            env,
            desk,
            saver,
            pose_saver,
            reading: None,
            sheets,
            params,
            leaving: None,
            closing: None,
            ports: None,
            saving: None,
            sessions: None,
            scanner: Scanner::default(),
        }
    }

    /// At start: the given hand, else the remembered one, else the built-in one. Remembers nothing.
    pub fn open(&mut self, endpoint: Option<Endpoint>, now: Moment) {
        let endpoint = endpoint
            .or_else(|| self.remembered(now))
            .unwrap_or_else(Endpoint::sim);
        self.go(Some(endpoint), now);
    }

    fn remembered(&mut self, now: Moment) -> Option<Endpoint> {
        let text = self.desk.state.settings.endpoint.clone()?;
        match text.parse() {
            Ok(endpoint) => Some(endpoint),
            Err(_) => {
                self.tell(NoticeKind::EndpointIgnored { text }, now);
                None
            }
        }
    }

    /// Tells the person something that was found elsewhere, such as an unreadable settings file.
    pub fn tell(&mut self, what: NoticeKind, now: Moment) {
        self.desk.state.notices.push(now, what);
    }

    /// Everything the window shows.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.desk.state
    }

    /// Takes in what happened since the last call. Runs also while the window is hidden.
    pub fn logic(&mut self, now: Moment) {
        self.desk.drain(now);
        self.desk.state.record();
        if let Some(leaving) = self.leaving.take_if(|leaving| {
            now.since(leaving.told) >= REST_WITHIN || self.desk.is_at_rest(leaving.told)
        }) {
            self.go(leaving.to, now);
        }
        if let Some(place) = self.guarding.tick(&mut self.desk, now) {
            self.go(Some(place), now);
        }
        self.take_ports();
        if let Some(end) = self.saving.as_mut().and_then(Saving::ended) {
            self.saving = None;
            self.tell(end, now);
        }
        self.take_session(now);
        self.scanner.drain(&mut self.desk.state.scan);
        if let Some(told) = self.sheets.tick(&mut self.desk.state) {
            self.tell(told, now);
        }
        if let Some(told) = self.params.tick(&mut self.desk) {
            self.tell(told, now);
        }
        self.take_poses(now);
        let failed = self.saver.tick(&self.desk.state.settings, now);
        let poses = &self.desk.state.poses.library;
        for failed in failed.into_iter().chain(self.pose_saver.tick(poses, now)) {
            self.tell(failed, now);
        }
    }

    /// Carries out one thing that a person asked for.
    pub fn act(&mut self, action: Action, now: Moment) {
        self.desk.state.now = now;
        if self.desk.state.tuner.is_running() && action.disturbs_series() {
            self.tell(NoticeKind::SeriesRuns, now);
            return;
        }
        if let Some(deed) = Deed::of(&action, &self.desk.state) {
            self.desk.state.recorder.deed(deed, now);
        }
        let desk = &mut self.desk;
        match action {
            Action::Stop => desk.stop(now),
            // A hand that is being left is not set in motion again.
            Action::Arm if self.leaving.is_some() || self.closing.is_some() => {}
            // Nor is one that something is done to under a card.
            Action::Arm | Action::ClearErrors if desk.state.guard.is_some() => {}
            Action::Arm => desk.arm(now),
            Action::Disarm => desk.disarm(now),
            Action::Target(dof, angle) => desk.target(dof, angle),
            Action::Force(dof, force) => desk.force(dof, force),
            Action::Speed(dof, speed) => desk.speed(dof, speed),
            Action::Lock(dof, locked) => desk.lock(dof, locked),
            Action::Preset(preset) => desk.preset(preset),
            Action::ForceOfAll(force) => desk.force_of_all(force),
            Action::SpeedOfAll(speed) => desk.speed_of_all(speed),
            Action::Gesture(gesture) => desk.gesture(gesture, now),
            Action::ClearErrors => desk.clear_errors(now),
            Action::ChangePlace(id, wanted) => self.guarding.change(desk, id, wanted),
            Action::FactoryReset => self.guarding.reset(desk),
            Action::CalibrateForce => self.guarding.calibrate(desk),
            Action::Guard(step) => self.guarding.step(desk, step, now),
            Action::Connect(endpoint) => self.connect(endpoint, now),
            Action::Disconnect => {
                self.guarding.leave(desk);
                self.leave(None, now);
            }
            Action::FindPorts => self.find_ports(),
            Action::Save(content) => self.save(content),
            Action::Scan(wish) => {
                let held = desk.state.endpoint.clone();
                self.scanner
                    .begin(wish, held, &self.env, &mut desk.state.scan);
            }
            Action::CancelScan => self.scanner.cancel(&mut desk.state.scan),
            Action::Tare(finger) => desk.tare(finger),
            Action::UndoTare => desk.state.tare.undo(),
            Action::SeenFault(dof, what) => desk.state.faults.see_one(dof, what),
            Action::SeenFaults => desk.state.faults.see_all(),
            Action::OpenedRecording(id) => desk.state.recorder.opened(id),
            Action::ForgetFaults => desk.state.faults.forget(),
            Action::Note(at, words) => desk.note(at, &words),
            Action::Dismiss(id) => desk.state.notices.dismiss(id),
            Action::Trial(wish) => self.act_on_trials(wish, now),
            Action::ImportPoses => self.import_poses(),
            Action::ExportPoses => self.save(Content::Poses(self.desk.state.poses.library.clone())),
            Action::Stage(id, value) => desk.stage(id, value),
            Action::Device(wish) => self.device(wish, now),
            action => self.act_on_poses(action, now),
        }
    }

    /// What is done with files is begun here, all else at the desk.
    fn device(&mut self, wish: DeviceWish, now: Moment) {
        match wish {
            DeviceWish::Dump => self.dump(),
            DeviceWish::Open => self.params.open(self.env.files.as_ref()),
            DeviceWish::OpenBackup(path) => self.params.open_backup(path),
            wish => self.desk.device(&wish, now),
        }
    }

    /// Asks where the rows should go that were read.
    fn dump(&mut self) {
        let params = self.desk.state.device.live_params();
        if params.is_empty() {
            return;
        }
        let file = ParamsFile {
            hand: self.desk.state.hand_name(),
            at: stamp(since_1970()),
            why: "dump".into(),
            params,
            ..ParamsFile::default()
        };
        self.save(Content::Params(Box::new(file)));
    }

    /// Poses, sequences, and what the hand itself has stored.
    fn act_on_poses(&mut self, action: Action, now: Moment) {
        let desk = &mut self.desk;
        match action {
            Action::StoreGesture(gesture, angles) => desk.store_gesture(gesture, angles, now),
            Action::ReadGesture(gesture) => desk.read_gesture(gesture, now),
            Action::Capture(name) => desk.capture(&name, now),
            Action::Recapture(id) => desk.recapture(id, now),
            Action::Library(edit) => desk.state.poses.edit(edit),
            Action::Recall(id) => desk.recall(id),
            Action::TryAngles(angles) => desk.try_angles(angles),
            Action::Play(play) => desk.play(play, now),
            kept => self.keep(kept),
        }
    }

    /// What is kept from one start to the next.
    fn keep(&mut self, action: Action) {
        let State {
            settings, gestures, ..
        } = &mut self.desk.state;
        match action {
            Action::NameGesture(gesture, name) => {
                gestures.set_name(gesture, &name);
                settings.gesture_names = gestures.kept_names();
            }
            Action::GestureRoute(route) => {
                gestures.route = route;
                settings.gesture_route = route;
            }
            Action::GestureStore(store) => settings.gesture_store = store,
            Action::Theme(theme) => settings.theme = theme,
            Action::Layout(layout) => settings.layout = layout,
            Action::Language(language) => settings.language = language,
            Action::AngleUnit(unit) => settings.angle_unit = unit,
            Action::PlotWindow(window) => settings.plot_window = window,
            Action::ShowPlot(kind, on) => settings.plots.set(kind, on),
            // Standing plots are the view's own matter, and all others were carried out before.
            _ => {}
        }
    }

    fn connect(&mut self, endpoint: Endpoint, now: Moment) {
        self.guarding.leave(&mut self.desk);
        // A scan may still ask further ids on the port that is wanted.
        self.scanner.cancel(&mut self.desk.state.scan);
        self.desk.state.settings.endpoint = Some(endpoint.to_string());
        self.leave(Some(endpoint), now);
    }

    /// Leaves the hand of now. One that may be moving is told to hold first and gets time to.
    fn leave(&mut self, to: Option<Endpoint>, now: Moment) {
        if let Some(leaving) = &mut self.leaving {
            leaving.to = to;
        } else if self.desk.may_move() {
            self.desk.stop(now);
            self.leaving = Some(Leaving { to, told: now });
        } else {
            self.go(to, now);
        }
    }

    fn go(&mut self, to: Option<Endpoint>, now: Moment) {
        // The old link goes first: a serial port has room for one.
        self.desk.replace(None, None, now);
        let Some(endpoint) = to else { return };
        let config = LinkConfig {
            endpoint: endpoint.clone(),
            rates: PollRates::default(),
            clock: self.env.clock,
            dial: Arc::clone(&self.env.dial),
            wake: Arc::clone(&self.env.wake),
        };
        let link = link::open(config, &self.env.runtime);
        self.desk.replace(Some(endpoint), Some(Box::new(link)), now);
    }

    /// Reads on what went over the wire. Called while somebody looks at it, and only then.
    pub fn read_traffic(&mut self, now: Moment) {
        save::read_on(&mut self.desk.state.traffic, now);
    }

    /// Reads what the hand keeps because somebody looks at it. Called while they do; asks only when it is due. Writes nothing.
    pub fn look_at_device(&mut self, now: Moment) {
        if self.desk.state.device.look(now) {
            self.desk.device(&DeviceWish::Read, now);
        }
    }

    /// One file at a time: while a dialog is open, another is not opened.
    fn save(&mut self, content: Content) {
        if self.saving.is_some() {
            return;
        }
        let (files, wake) = (&self.env.files, Arc::clone(&self.env.wake));
        let saving = Saving::start(content, files.as_ref(), &self.env.runtime, wake);
        self.saving = Some(saving);
    }

    fn act_on_trials(&mut self, wish: TrialWish, now: Moment) {
        let (files, runtime) = (self.env.files.as_ref(), &self.env.runtime);
        let wake = Arc::clone(&self.env.wake);
        match wish {
            TrialWish::Open | TrialWish::Save(..) if self.sessions.is_some() => {}
            TrialWish::Open => self.sessions = Some(Files::open(files, runtime, wake)),
            TrialWish::Save(id, criterion) => {
                let session = self.desk.state.tuner.session(id);
                let save = |session| Files::save(session, criterion, files, runtime, wake);
                self.sessions = session.and_then(save);
            }
            wish => {
                self.desk.trial_wish(wish, since_1970(), now);
            }
        }
    }

    fn take_session(&mut self, now: Moment) {
        if let Some(end) = self.sessions.as_mut().and_then(Files::ended) {
            self.sessions = None;
            let told = self.desk.state.tuner.take(end);
            self.tell(told, now);
        }
    }

    fn import_poses(&mut self) {
        if self.reading.is_none() {
            let (files, wake) = (&self.env.files, Arc::clone(&self.env.wake));
            self.reading = Some(Reading::start(files.as_ref(), &self.env.runtime, wake));
        }
    }

    /// A file of poses was read: all of it is added, or nothing.
    fn take_poses(&mut self, now: Moment) {
        let Some(end) = self.reading.as_mut().and_then(Reading::ended) else {
            return;
        };
        self.reading = None;
        let told = end.map(|library| {
            let (poses, sequences) = (library.poses.len(), library.sequences.len());
            self.desk.state.poses.import(library);
            NoticeKind::PosesImported { poses, sequences }
        });
        self.tell(told.unwrap_or_else(|refused| refused), now);
    }

    fn find_ports(&mut self) {
        if self.ports.is_some() {
            return;
        }
        let (found, asked) = oneshot::channel();
        let wake = Arc::clone(&self.env.wake);
        self.env.runtime.spawn_blocking(move || {
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = found.send(ports());
            wake();
        });
        self.ports = Some(asked);
    }

    fn take_ports(&mut self) {
        let Some(asked) = &mut self.ports else { return };
        match asked.try_recv() {
            Ok(found) => self.desk.state.ports = found.into_iter().map(choice).collect(),
            Err(oneshot::error::TryRecvError::Empty) => return,
            Err(oneshot::error::TryRecvError::Closed) => {}
        }
        self.ports = None;
    }

    /// The window wants to close. A hand that is armed or that this program set in motion is told to hold first.
    /// True once the window may go: the hand rests, or 600 ms have passed. Call it each frame until then.
    pub fn close(&mut self, now: Moment) -> bool {
        let closing = *self.closing.get_or_insert_with(|| {
            let held = self.desk.may_move();
            if held {
                self.desk.stop(now);
            }
            Closing { since: now, held }
        });
        let poses = self.pose_saver.flush(&self.desk.state.poses.library, now);
        let saved = self.saver.flush(&self.desk.state.settings, now) && poses;
        let rests = !closing.held || self.desk.is_at_rest(closing.since);
        saved && rests || now.since(closing.since) >= REST_WITHIN
    }
}

fn choice(found: PortFound) -> PortChoice {
    let about = found.usb.map(|usb| {
        let words = [usb.maker, usb.product, usb.serial]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" ");
        if words.is_empty() {
            format!("USB {:04x}:{:04x}", usb.vendor_id, usb.product_id)
        } else {
            words
        }
    });
    PortChoice {
        path: found.path,
        about,
    }
}
