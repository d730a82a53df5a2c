//! Every action there is, judged by what reached the hand: none moves or writes that does not say so, and none passes where it must
//! not.

use crate::program::{ANGLE_SET, Bench, shorts};
use crate::setup::recorded;
use handscope::app::action::Action;
use handscope::app::checkup::CheckupAction;
use handscope::app::controls::HoldKey;
use handscope::app::effect::ActionEffect;
use handscope::app::exhibit::ExhibitAction;
use handscope::app::files::export::{Export, TrafficForm};
use handscope::app::hand::hold::HoldAction;
use handscope::app::hand::list::HandsAction;
use handscope::app::hand::scale::ScaleAction;
use handscope::app::inputs::InputAction;
use handscope::app::layout::Layout;
use handscope::app::params::ParamAction;
use handscope::app::procedures::ProcedureAction;
use handscope::app::readings::faults::FaultKind;
use handscope::app::recordings::{RecordingAction, RecordingExport};
use handscope::app::scan::ScanTarget;
use handscope::app::settings::{AngleUnit, Language, PlotKind, PlotWindow, Theme, Zoom};
use handscope::app::trials::{SeriesKind, SessionId, TrialAction};
use handscope::checkup::CheckupPlan;
use handscope::exhibit::stage::ExhibitWish;
use handscope::hand::gap::Gap;
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::kinematics::Side;
use handscope::hand::newtons::ForceUnit;
use handscope::hand::register::{Persistence, by_address};
use handscope::hand::{Angle, Dof, Fault, Force, Gesture, GestureRoute, Moment, Speed};
use handscope::history::{Mark, MarkKind};
use handscope::inputs::pad::PadMap;
use handscope::link::PollPriority;
use handscope::motion::follow::step::FollowLimits;
use handscope::motion::hold::HoldClose;
use handscope::motion::source::SourceKind;
use handscope::params::place::WhichPlace;
use handscope::params::rows::{ParamId, Value};
use handscope::params::values::Params;
use handscope::poses::edit::LibraryEdit;
use handscope::poses::library::{EntryId, PoseId, SequenceId};
use handscope::poses::{Play, Preset};
use handscope::record::export::ExportFormat;
use handscope::sim::JournalEntry;
use handscope::tasks::{Question, Risks};
use handscope::transport::Endpoint;
use std::collections::BTreeSet;
use std::time::Duration;
use strum::VariantNames;

const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);

/// The pose, the sequence and the files that the actions are about.
#[derive(Clone, Copy)]
struct Things {
    pose: PoseId,
    sequence: SequenceId,
}

fn inputs() -> Vec<InputAction> {
    vec![
        InputAction::Listen(None),
        InputAction::ReadPad(false),
        InputAction::Share(None),
        InputAction::Show(None),
        InputAction::JoinDds(None),
        InputAction::Mirror(None),
        InputAction::Grant(SourceKind::Stream),
        InputAction::Grant(SourceKind::Dds),
        InputAction::Grant(SourceKind::Pad),
        InputAction::Grant(SourceKind::Mirror),
        InputAction::GrantClient(Default::default()),
        InputAction::TakeBack,
        InputAction::Limit(FollowLimits::default()),
        InputAction::Map(PadMap::usual()),
    ]
}

fn params() -> Vec<ParamAction> {
    vec![
        ParamAction::Read,
        ParamAction::Apply,
        ParamAction::Undo,
        ParamAction::Save,
        ParamAction::SaveWith(Params::default()),
        ParamAction::CopyLive,
        ParamAction::UnstageAll,
        ParamAction::Dump,
        ParamAction::Open(Some("/dev/null/none".into())),
        ParamAction::Tick(INDEX),
        ParamAction::StageTicked,
        ParamAction::CloseFile,
    ]
}

fn procedures() -> Vec<ProcedureAction> {
    vec![ProcedureAction::Begin, ProcedureAction::Close]
}

fn trials() -> Vec<TrialAction> {
    let id = SessionId(0);
    vec![
        TrialAction::Plan(Box::default()),
        TrialAction::Start(SeriesKind::Grid),
        TrialAction::ArmAndStart(SeriesKind::Grid),
        TrialAction::Goal(Box::default()),
        TrialAction::Start(SeriesKind::Search),
        TrialAction::ArmAndStart(SeriesKind::Search),
        TrialAction::Note(id, "note".into()),
        TrialAction::Tags(id, "tag".into()),
        TrialAction::Forget(id),
        TrialAction::ConfirmForget,
        TrialAction::CancelForget,
        TrialAction::ForgetOvershoot,
        TrialAction::ExportOvershoot,
        TrialAction::Open(Some("/dev/null/none".into())),
        TrialAction::Save(id, None),
    ]
}

fn checkups() -> [CheckupAction; 2] {
    let plan = CheckupPlan { press: true };
    [CheckupAction::Start(plan), CheckupAction::ArmAndStart(plan)]
}

fn sessions() -> Vec<RecordingAction> {
    let (path, at) = (|| "/dev/null/none.mcap".into(), Moment::ZERO);
    vec![
        RecordingAction::Record(true),
        RecordingAction::RecordSimulated(false),
        // Below a file no folder can be.
        RecordingAction::ChooseFolder(Some("/dev/null/none".into())),
        RecordingAction::DefaultFolder,
        RecordingAction::Refresh,
        RecordingAction::Open(path()),
        RecordingAction::OpenAt(path(), (at, at)),
        RecordingAction::Close,
        RecordingAction::Reveal(path()),
        RecordingAction::Export(RecordingExport {
            path: path(),
            format: ExportFormat::Csv,
            stretch: None,
            uncommanded: false,
        }),
        RecordingAction::Name(path(), "name".into()),
        RecordingAction::Star(path(), true),
        RecordingAction::AskDelete(path()),
        RecordingAction::Delete,
        RecordingAction::KeepIt,
        RecordingAction::MakeRoom,
        RecordingAction::KeepPlanned,
        RecordingAction::Seek(at),
        RecordingAction::Run(true),
        RecordingAction::Pace(1.0),
        RecordingAction::Step(true),
        RecordingAction::Loop(None),
        RecordingAction::Beside(None),
        RecordingAction::Align(at, at),
        RecordingAction::EditNote(at, "note".into()),
    ]
}

fn exhibits() -> Vec<ExhibitAction> {
    vec![
        ExhibitAction::Enter,
        ExhibitAction::EnterFile,
        ExhibitAction::Wish(ExhibitWish::Arm),
        ExhibitAction::Wish(ExhibitWish::Press(0)),
        ExhibitAction::AskPin,
        ExhibitAction::Pin("1234".into()),
        ExhibitAction::CloseStaff,
        ExhibitAction::Leave,
    ]
}

fn hands() -> Vec<HandsAction> {
    let slot = Default::default();
    vec![
        HandsAction::Add,
        HandsAction::Show(slot),
        HandsAction::Remove(slot),
        HandsAction::Name(slot, "name".into()),
        HandsAction::StopOne(slot),
        HandsAction::PosesForAll(false),
    ]
}

fn plays(things: Things) -> Vec<Play> {
    vec![
        Play::Start(EntryId::Sequence(things.sequence)),
        Play::Step(things.sequence),
        Play::Pause,
        Play::Resume,
        Play::End,
    ]
}

const KEYS: [HoldKey; 3] = [HoldKey::Pressed, HoldKey::Held, HoldKey::LetGo];

/// One of each, and of those that have more than one effect one of each effect.
fn all(things: Things) -> Vec<Action> {
    let endpoint = || "rs485:y".parse::<Endpoint>().unwrap();
    let note = Mark {
        at: Moment::ZERO,
        kind: MarkKind::note("note").unwrap(),
    };
    let mut all = vec![
        Action::Stop,
        Action::Arm,
        Action::Disarm,
        Action::HoldToRun(true),
        Action::DisarmIdle(false),
        Action::HoldToRun(false),
        Action::Target(Dof::Index, Angle::nearest(500)),
        Action::Force(None, Force::RATED),
        Action::Speed(None, Speed::MAX),
        Action::Lock(Dof::Ring, true),
        Action::Preset(Preset::Close),
        Action::Pinch(Gap::MAX),
        Action::Hold(HoldAction::Forces(
            ForceUnit::Grams,
            HoldForces::nearest(Force::MIN, Force::RATED),
        )),
        Action::Hold(HoldAction::Unit(ForceUnit::Newtons)),
        Action::Hold(HoldAction::Start(HoldClose::Pinch(Gap::MIN))),
        Action::Hold(HoldAction::Repeat("egg".into())),
        Action::Hold(HoldAction::Save),
        Action::Hold(HoldAction::End),
        Action::Scale(ScaleAction::Start(Dof::Index, Force::nearest(400))),
        Action::Scale(ScaleAction::Reading(120.0)),
        Action::Scale(ScaleAction::Again),
        Action::Scale(ScaleAction::Skip),
        Action::Scale(ScaleAction::Finish),
        Action::Scale(ScaleAction::Forget(Dof::Index)),
        Action::MeasureBlock(30.0),
        Action::ForgetBlocks,
        Action::Gesture(Gesture::MIN),
        Action::Capture("captured".into()),
        Action::Recapture(things.pose),
        Action::Library(LibraryEdit::NewSequence("new".into())),
        Action::Recall(things.pose),
        Action::HideShipped("Fist".into(), true),
        Action::DryRun(Some(things.sequence)),
        Action::ImportPoses(Some("/dev/null/none".into())),
        Action::ExportPoses,
        Action::NameGesture(Gesture::MIN, "name".into()),
        Action::GestureRoute(GestureRoute::ActionLibrary),
        Action::ClearErrors,
        Action::ChangePlace(ParamId::HandId, Value::Number(7)),
        Action::FactoryReset,
        Action::CalibrateForce,
        Action::Connect(endpoint()),
        Action::Disconnect,
        Action::FindPorts,
        Action::Scan(ScanTarget::Hosts("127.0.0.1".parse().unwrap())),
        Action::CancelScan,
        Action::FindShared(None),
        Action::SeenFault(Dof::Index, FaultKind::Fault(Fault::Stall)),
        Action::SeenFaults,
        Action::Save(Export::Traffic(TrafficForm::Csv, Vec::new())),
        Action::SavePicture((100, 100)),
        Action::Stay,
        Action::Leave,
        Action::Dismiss(0),
        Action::Theme(Theme::Light),
        Action::Side(Side::Left),
        Action::Language(Language::Zh),
        Action::Layout(Layout::default()),
        Action::Zoom(Zoom::from(1.5)),
        Action::ReadFirst(PollPriority::Force),
        Action::AngleUnit(AngleUnit::Degrees),
        Action::PlotWindow(PlotWindow::S5),
        Action::ShowPlot(PlotKind::Force, true),
        Action::GrowPlot(PlotKind::Current),
        Action::Note(Moment::ZERO, "note".into()),
        Action::RemoveMark(note),
        Action::Tare(None),
        Action::UndoTare,
        Action::TakeKeptTare,
        Action::Stage(INDEX, Some(Value::Number(123))),
    ];
    all.extend(KEYS.map(Action::HoldKey));
    all.extend(plays(things).into_iter().map(Action::Play));
    all.extend(inputs().into_iter().map(Action::Input));
    all.extend(params().into_iter().map(Action::Param));
    all.extend(procedures().into_iter().map(Action::Procedure));
    let questions = [
        Question::Apply(Risks::default()),
        Question::Save(Risks::default()),
        Question::KeepPlace(WhichPlace::New),
        Question::SavePlace(WhichPlace::New),
    ];
    for question in questions {
        all.extend([true, false].map(|yes| Action::Answer(question.clone(), yes)));
    }
    all.extend(trials().into_iter().map(Action::Trial));
    all.extend(checkups().map(Action::Checkup));
    all.extend(sessions().into_iter().map(Action::Recording));
    all.extend(exhibits().into_iter().map(Action::Exhibit));
    all.extend(hands().into_iter().map(Action::Hands));
    all
}

#[test]
fn each_action_there_is_is_tried() {
    fn check<T: VariantNames + Into<&'static str>>(tried: impl IntoIterator<Item = T>) {
        let tried: BTreeSet<&str> = tried.into_iter().map(Into::into).collect();
        assert_eq!(tried, T::VARIANTS.iter().copied().collect());
    }
    let things = Things {
        pose: PoseId(1),
        sequence: SequenceId(1),
    };
    check(all(things));
    check(KEYS);
    check(plays(things));
    check(inputs());
    check(params());
    check(procedures());
    check(trials());
    check(checkups());
    check(sessions());
    check(exhibits());
    check(hands());
}

/// What reached the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Reached {
    /// A target where the joint is not, or a gesture.
    Motion,
    /// A speed or a force threshold.
    Limit,
    /// What the hand keeps, or does alone.
    Kept,
    /// Joints are told to stay.
    Hold,
    /// Errors are cleared.
    Cleared,
}

fn reached(entry: &JournalEntry, angles: [i16; 6]) -> Reached {
    match entry.address {
        1486..=1497 => {
            let first = usize::from(entry.address - ANGLE_SET) / 2;
            let moves = |(at, target): (usize, i16)| {
                target >= 0 && (target - angles[first + at]).abs() > 40
            };
            match shorts(entry).into_iter().enumerate().any(moves) {
                true => Reached::Motion,
                false => Reached::Hold,
            }
        }
        1008 | 2320 | 2322 => Reached::Motion,
        1498..=1509 | 1522..=1533 => Reached::Limit,
        1004 => Reached::Cleared,
        1005 | 1006 | 1009 => Reached::Kept,
        address => {
            let row = by_address(address).unwrap();
            assert_eq!(row.persistence, Persistence::Saved, "{row}");
            Reached::Kept
        }
    }
}

impl Bench {
    /// A pose and a sequence that move the hand.
    fn things(&mut self) -> Things {
        let (pose, sequence) = super::playing::library(self);
        Things { pose, sequence }
    }

    /// What reaches the hand because of this.
    async fn reached_by(&mut self, action: Action) -> BTreeSet<Reached> {
        self.forget();
        let sample = self.app.live().hand().readings.sample;
        let angles = Dof::ALL.map(|dof| sample.angle.unwrap().value[dof].raw());
        self.act(action);
        self.run(400).await;
        let written = self.written();
        let all = written.iter().map(|entry| reached(entry, angles));
        all.collect()
    }

    /// Files take real time.
    async fn replays(&mut self) {
        for _ in 0..400 {
            if self.state().timeline.is_some() {
                return;
            }
            std::thread::sleep(Duration::from_millis(5));
            self.run(20).await;
        }
        panic!("nothing is replayed");
    }

    /// A row that is read, and staged to be another.
    async fn staged(&mut self) {
        self.act(Action::Param(ParamAction::Read));
        self.run(1000).await;
        self.act(Action::Stage(INDEX, Some(Value::Number(123))));
        self.run(100).await;
    }
}

/// What may reach the hand because of an action of this effect.
fn may_reach(effect: ActionEffect) -> &'static [Reached] {
    match effect {
        ActionEffect::Motion => &[Reached::Motion, Reached::Limit, Reached::Hold],
        ActionEffect::Adjustment => &[Reached::Limit, Reached::Hold, Reached::Cleared],
        ActionEffect::PersistentWrite => &[Reached::Kept],
        // An armed hand that is left, or led from elsewhere, is held.
        ActionEffect::StopAll
        | ActionEffect::Stop
        | ActionEffect::Connection
        | ActionEffect::Exhibition => &[Reached::Hold],
        ActionEffect::Dialog
        | ActionEffect::LocalState
        | ActionEffect::Recording
        | ActionEffect::View
        | ActionEffect::Appearance => &[],
    }
}

#[tokio::test(start_paused = true)]
async fn no_action_moves_a_hand_or_writes_what_it_keeps_that_does_not_say_so() {
    /// What the hand is before.
    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Before {
        Armed,
        Staged,
        CardOpen,
    }
    let mut found = BTreeSet::new();
    for before in [Before::Armed, Before::Staged, Before::CardOpen] {
        let things = Bench::live().await.things();
        for action in all(things) {
            let mut bench = Bench::live().await;
            assert_eq!(bench.things().pose, things.pose);
            match before {
                Before::Armed => bench.arm().await,
                Before::Staged => bench.staged().await,
                Before::CardOpen => {
                    bench.act(Action::CalibrateForce);
                    bench.run(100).await;
                }
            }
            let effect = action.effect();
            let reached = bench.reached_by(action.clone()).await;
            for one in reached {
                assert!(
                    may_reach(effect).contains(&one),
                    "{before:?}: {action:?}, which {effect:?}: {one:?}"
                );
                found.insert((format!("{effect:?}"), one));
            }
        }
    }
    // Otherwise nothing was tried.
    for (effect, one) in [
        (ActionEffect::Motion, Reached::Motion),
        (ActionEffect::Adjustment, Reached::Limit),
        (ActionEffect::PersistentWrite, Reached::Kept),
        (ActionEffect::StopAll, Reached::Hold),
        (ActionEffect::Stop, Reached::Hold),
    ] {
        assert!(found.contains(&(format!("{effect:?}"), one)), "{found:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn these_actions_pass_while_a_recording_is_shown_and_no_others() {
    let mut bench = Bench::live().await;
    let passes = all(bench.things()).into_iter();
    let passes = passes.filter(Action::passes_in_replay);
    let names: BTreeSet<&str> = passes.map(|action| (&action).into()).collect();
    let wanted = [
        "Stop",
        "Recording",
        "Note",
        "Dismiss",
        "Save",
        "SavePicture",
        "Theme",
        "Language",
        "Layout",
        "Zoom",
        "AngleUnit",
        "PlotWindow",
        "ShowPlot",
        "GrowPlot",
    ];
    assert_eq!(names, BTreeSet::from(wanted));
}

#[tokio::test(start_paused = true)]
async fn nothing_but_a_stop_reaches_a_hand_behind_a_recording() {
    let mut bench = Bench::live().await;
    let things = bench.things();
    let [recording, ..] = recorded::three(bench.folder.path());
    for action in all(things) {
        if bench.state().timeline.is_none() || !bench.app.live().hand().connection.is_armed() {
            bench.act(Action::Recording(RecordingAction::Close));
            bench.run(1000).await;
            bench.arm().await;
            bench.act(Action::Recording(RecordingAction::Open(recording.clone())));
            bench.replays().await;
        }
        let reached = bench.reached_by(action.clone()).await;
        let allowed: &[_] = match action.effect() {
            ActionEffect::StopAll => &[Reached::Hold],
            _ => &[],
        };
        assert!(
            reached.iter().all(|one| allowed.contains(one)),
            "{action:?}: {reached:?}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn nothing_but_a_stop_reaches_a_hand_behind_an_exhibition() {
    let mut bench = Bench::live().await;
    let things = bench.things();
    for action in all(things) {
        // Staff who close the panel before there is a PIN leave.
        if bench.state().exhibit.is_none() {
            bench.act(Action::Exhibit(ExhibitAction::Enter));
            bench.run(300).await;
        }
        let reached = bench.reached_by(action.clone()).await;
        assert!(reached.is_subset(&[Reached::Hold].into()), "{action:?}");
        let is_there = bench.state().exhibit.is_some();
        assert!(
            is_there || matches!(action, Action::Exhibit(_)),
            "{action:?}"
        );
        assert!(!bench.hand().connection.is_armed(), "{action:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn in_a_series_nothing_passes_that_would_come_between_it_and_the_hand() {
    let things = Bench::live().await.things();
    for action in all(things) {
        let effect = action.effect();
        if effect.passes_in_series() {
            continue;
        }
        let mut bench = Bench::armed().await;
        bench.things();
        bench.act(Action::Trial(TrialAction::Start(SeriesKind::Grid)));
        bench.run(300).await;
        let before = Dof::ALL.map(|dof| bench.hand().controls.joints[dof].speed);
        bench.act(action.clone());
        bench.run(300).await;
        assert!(bench.hand().running.series().is_some(), "{action:?}");
        let after = Dof::ALL.map(|dof| bench.hand().controls.joints[dof].speed);
        assert_eq!(before, after, "{action:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn nothing_that_passes_in_the_frame_of_a_stop_moves_the_hand() {
    let things = Bench::live().await.things();
    for action in all(things) {
        if !action.effect().passes_with_stop() {
            continue;
        }
        let mut bench = Bench::armed().await;
        bench.things();
        bench.act(Action::Preset(Preset::Close));
        bench.run(200).await;
        bench.act(Action::Stop);
        let reached = bench.reached_by(action.clone()).await;
        let allowed = [Reached::Hold, Reached::Cleared, Reached::Limit].into();
        assert!(reached.is_subset(&allowed), "{action:?}: {reached:?}");
        assert!(!bench.hand().connection.is_armed(), "{action:?}");
    }
}
