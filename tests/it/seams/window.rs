//! Rows of the table that the window moves: the whole program without its display, in virtual time, in front of the hand of a cell.

use crate::pad::setup::{self as pad, PAD};
use crate::seams::hand::{HandKind, InMemory, SeamHand};
use crate::seams::mover::Mover;
use crate::setup::body::Protocol;
use crate::setup::hand;
use crate::setup::link::{self, Client};
use crate::setup::program::{Program, env};
use crate::setup::time::Time;
use handscope::app::action::Action;
use handscope::app::checkup::CheckupAction;
use handscope::app::env::Env;
use handscope::app::exhibit::{ExhibitAction, Exhibition};
use handscope::app::hand::hold::HoldAction;
use handscope::app::hand::list::HandsAction;
use handscope::app::hand::scale::ScaleAction;
use handscope::app::inputs::InputAction;
use handscope::app::procedures::procedure::ProcedureAction;
use handscope::app::settings::Settings;
use handscope::app::trials::{SeriesKind, TrialAction};
use handscope::checkup::CheckupPlan;
use handscope::exhibit::file;
use handscope::exhibit::pin::Pin;
use handscope::exhibit::plan::{ExhibitPlan, MotionLimits};
use handscope::exhibit::stage::ExhibitWish;
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::{Angle, Dof, Force, PerDof, Setpoints, Speed, Target};
use handscope::inputs::mirror::MirrorScale;
use handscope::inputs::pad::device::{OpenPads, PadReader};
use handscope::inputs::pad::{PadNews, PadReport};
use handscope::motion::hold::HoldClose;
use handscope::motion::source::SourceKind;
use handscope::poses::Play;
use handscope::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use handscope::poses::library::{EntryId, PoseId, SequenceStep};
use handscope::record::LinkState;
use handscope::sim::SharedHand;
use handscope::transport::Endpoint;
use handscope::trials::search::SearchGoal;
use handscope::trials::{Limits, TrialGrid, TrialPlan, TrialSetting};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::mpsc;

/// One frame of the window.
const FRAME: Duration = Duration::from_millis(20);
/// About 160 counts a second: six seconds for the whole way.
fn slow() -> Speed {
    Speed::nearest(100)
}

/// Frames in which a person pulls the triggers of a gamepad from end to end.
const TRIGGER_STEPS: u16 = 300;
const LEADER: &str = "tcp:10.0.0.2:6000";

/// The program with its window, in front of the hand of a cell.
pub(super) struct Window {
    program: Program,
    hand: Arc<SeamHand>,
    leader: SharedHand,
    is_frozen: bool,
    closes: bool,
    /// Another program at the same hand.
    second: Option<Client>,
    /// What its gamepad says.
    pad: mpsc::Sender<PadReport>,
    /// How far its triggers are pulled, once it is there.
    pulled: Option<u16>,
}

impl Window {
    /// Connected, with nothing asked of it yet.
    pub(super) fn live(protocol: Protocol, kind: HandKind) -> Self {
        let mut hands = None;
        let (pad, reports) = mpsc::channel(64);
        let reports = Mutex::new(Some(reports));
        let program = Program::start(Time::Virtual, None, || {
            let (hand, leader) = (SeamHand::in_memory(protocol, kind), hand::plain());
            hands = Some((Arc::clone(&hand), leader.clone()));
            let place: Endpoint = LEADER.parse().unwrap();
            let others = vec![(place, leader)];
            let dial = Arc::new(InMemory { hand, others });
            let read = move |_| Ok(PadReader::of(reports.lock().unwrap().take().unwrap()));
            let pads: OpenPads = Arc::new(read);
            (
                Env {
                    dial,
                    pads,
                    ..env()
                },
                Settings::default(),
            )
        });
        let (hand, leader) = hands.unwrap();
        let mut window = Self {
            program,
            hand,
            leader,
            is_frozen: false,
            closes: false,
            second: None,
            pad,
            pulled: None,
        };
        let place = window.hand.endpoint.parse().unwrap();
        window.act(Action::Connect(place));
        window.until("live", |window| window.state() == LinkState::Monitoring);
        window.run(1500);
        window
    }

    fn act(&mut self, action: Action) {
        self.program.act(action);
    }

    fn state(&self) -> LinkState {
        self.program.state().hand().connection.status.state
    }

    fn run(&mut self, ms: u64) {
        for _ in 0..ms.div_ceil(20) {
            self.pass(FRAME);
        }
    }

    fn until(&mut self, what: &str, so: impl Fn(&Self) -> bool) {
        for _ in 0..1500 {
            if so(self) {
                return;
            }
            self.run(20);
        }
        panic!("{what}: {}", self.said());
    }

    fn arm(&mut self) {
        self.act(Action::Speed(None, slow()));
        self.act(Action::Arm);
        self.until("armed", |window| window.state() == LinkState::Armed);
    }

    /// A slider pulled to the fist.
    pub(super) fn slider(mut self) -> Self {
        self.arm();
        for dof in FINGERS {
            self.act(Action::Target(dof, Angle::MIN));
        }
        self
    }

    /// A pose of its own, in which all fingers are bent.
    fn fist(&mut self) -> PoseId {
        self.act(Action::Capture("Slow fist".into()));
        let id = self.program.state().poses.newest.unwrap();
        let mut edit = |edit| self.act(Action::Library(LibraryEdit::Pose(id, edit)));
        edit(PoseEdit::Speed(slow()));
        for dof in FINGERS {
            edit(PoseEdit::Angle(dof, Angle::MIN));
        }
        id
    }

    pub(super) fn pose(mut self) -> Self {
        let fist = self.fist();
        self.arm();
        self.act(Action::Recall(fist));
        self
    }

    /// The fist, and the next step after it.
    pub(super) fn sequence(mut self) -> Self {
        let fist = self.fist();
        self.act(Action::Library(LibraryEdit::NewSequence("S".into())));
        let own = self.program.state().poses.newest_sequence.unwrap();
        for _ in 0..2 {
            let add = LibraryEdit::Sequence(own, SequenceEdit::Add(fist));
            self.act(Action::Library(add));
        }
        self.arm();
        self.act(Action::Play(Play::Start(EntryId::Sequence(own))));
        self
    }

    /// A step that closes for a hold, and the next step after it.
    pub(super) fn held_step(mut self) -> Self {
        let fist = self.fist();
        self.act(Action::Library(LibraryEdit::NewSequence("S".into())));
        let own = self.program.state().poses.newest_sequence.unwrap();
        let forces = HoldForces::nearest(Force::nearest(150), Force::nearest(400));
        for at in 0..2 {
            let add = LibraryEdit::Sequence(own, SequenceEdit::Add(fist));
            self.act(Action::Library(add));
            let step = self.program.state().poses.library.sequences[0].steps[at];
            let hold = Some(forces);
            let change = SequenceEdit::Change(at, SequenceStep { hold, ..step });
            self.act(Action::Library(LibraryEdit::Sequence(own, change)));
        }
        self.arm();
        self.act(Action::Play(Play::Start(EntryId::Sequence(own))));
        self
    }

    /// A hold that closes.
    pub(super) fn hold(mut self) -> Self {
        self.arm();
        let targets = PerDof::splat(Some(Angle::MIN));
        let close = HoldAction::Start(HoldClose::To(targets));
        self.act(Action::Hold(close));
        self
    }

    /// The index presses a scale, which it looks for.
    pub(super) fn scale(mut self) -> Self {
        self.arm();
        let press = ScaleAction::Start(Dof::Index, Force::nearest(400));
        self.act(Action::Scale(press));
        self
    }

    pub(super) fn series(self) -> Self {
        self.trials(|window| {
            window.arm();
            window.act(Action::Trial(TrialAction::Start(SeriesKind::Grid)));
        })
    }

    /// The same by the one button that arms and starts.
    pub(super) fn armed_series(self) -> Self {
        self.trials(|window| window.act(Action::Trial(TrialAction::ArmAndStart(SeriesKind::Grid))))
    }

    /// A search that closes and closes.
    pub(super) fn search(mut self) -> Self {
        let goal = SearchGoal {
            closes: 100,
            ..SearchGoal::new(&FINGERS, 2000)
        };
        self.act(Action::Trial(TrialAction::Goal(Box::new(goal))));
        self.act(Action::Trial(TrialAction::ArmAndStart(SeriesKind::Search)));
        self.until("it closes", |window| window.hand.angles()[3] < 980);
        self
    }

    /// A check-up by the one button that arms and starts; the index has its turn late.
    pub(super) fn checkup(mut self) -> Self {
        let plan = CheckupPlan::default();
        self.act(Action::Checkup(CheckupAction::ArmAndStart(plan)));
        // Three joints have their turn before it.
        self.run(30_000);
        self.until("it closes", |window| window.hand.angles()[3] < 980);
        self
    }

    fn trials(mut self, start: impl FnOnce(&mut Self)) -> Self {
        let setting = TrialSetting {
            speed: slow(),
            force: Force::GENTLE,
        };
        let plan = TrialPlan {
            grid: TrialGrid {
                repeats: 3,
                ..TrialGrid::once(setting)
            },
            limits: Limits {
                ceiling_g: 4000,
                ..Limits::default()
            },
            close: PerDof::from_fn(|dof| FINGERS.contains(&dof).then_some(Angle::MIN)),
            start: PerDof::from_fn(|dof| FINGERS.contains(&dof).then_some(Angle::MAX)),
            ..TrialPlan::default()
        };
        self.act(Action::Trial(TrialAction::Plan(Box::new(plan))));
        start(&mut self);
        self.until("it closes", |window| window.hand.angles()[3] < 980);
        self
    }

    /// Another hand leads this one, and somebody closes that.
    pub(super) fn led(mut self) -> Self {
        let follower = self.program.state().hand().label.slot;
        self.act(Action::Hands(HandsAction::Add));
        self.act(Action::Connect(LEADER.parse().unwrap()));
        self.run(1500);
        let leader = self.program.state().hand().label.slot;
        self.act(Action::Hands(HandsAction::Show(follower)));
        let wanted = Some((leader, MirrorScale::WHOLE));
        self.act(Action::Input(InputAction::Mirror(wanted)));
        self.run(300);
        self.act(Action::Input(InputAction::Grant(SourceKind::Mirror)));
        self.until("led", |window| window.state() == LinkState::Armed);
        self.leader.with(|hand, now| {
            let speeds = slow().get().to_le_bytes().repeat(6);
            hand.write(1522, &speeds, now).unwrap();
            hand.write(1486, &[0; 8], now).unwrap();
        });
        self
    }

    /// A person pulls both triggers of a gamepad slowly, its dead-man held.
    pub(super) fn gamepad(mut self) -> Self {
        self.act(Action::Input(InputAction::ReadPad(true)));
        let (facts, now) = (pad::facts(pad::XBOX), Vec::new());
        self.tells(PadNews::Found {
            pad: PAD,
            facts,
            now,
        });
        self.pulled = Some(0);
        self.run(200);
        self.grant(true);
        self.run(200);
        self.presses("BTN_TL", 1);
        self.pulled = Some(1);
        self
    }

    fn tells(&self, news: PadNews) {
        let at = self.program.now();
        // A gamepad that nobody reads any more says nothing.
        let _unread = self.pad.try_send(PadReport { at, news });
    }

    fn presses(&self, control: &str, value: i32) {
        let event = pad::event(control, value);
        self.tells(PadNews::Moved { pad: PAD, event });
    }

    /// The triggers come a little closer: six seconds for the whole way.
    fn pull(&mut self) {
        let Some(pulled) = &mut self.pulled else {
            return;
        };
        if *pulled > 0 {
            *pulled = (*pulled + 1).min(TRIGGER_STEPS);
        }
        let raw = i32::from(*pulled) * 255 / i32::from(TRIGGER_STEPS);
        self.tells(PadNews::Alive(PAD));
        for trigger in ["ABS_Z", "ABS_RZ"] {
            self.presses(trigger, raw);
        }
    }

    /// A visitor presses *Fist*, once staff armed.
    pub(super) fn exhibition(mut self) -> Self {
        let plan = ExhibitPlan {
            pin: Some(Pin::try_from("4711".to_owned()).unwrap()),
            limits: MotionLimits {
                speed: slow(),
                force: Force::GENTLE,
            },
            ..file::built_in().unwrap()
        };
        self.program.exhibit(Exhibition {
            plan: Arc::new(plan),
            logo: None,
            ends_program: false,
        });
        self.run(600);
        let mut act = |action| self.act(Action::Exhibit(action));
        act(ExhibitAction::AskPin);
        act(ExhibitAction::Pin("4711".into()));
        act(ExhibitAction::Wish(ExhibitWish::Arm));
        self.run(6000);
        let mut act = |action| self.act(Action::Exhibit(action));
        act(ExhibitAction::CloseStaff);
        act(ExhibitAction::Wish(ExhibitWish::Press(1)));
        self
    }

    pub(super) fn calibration(mut self) -> Self {
        self.act(Action::CalibrateForce);
        self.run(6000);
        self.act(Action::Procedure(ProcedureAction::Begin));
        self
    }
}

const FINGERS: [Dof; 4] = [Dof::Little, Dof::Ring, Dof::Middle, Dof::Index];

impl Mover for Window {
    fn hand(&self) -> &Arc<SeamHand> {
        &self.hand
    }

    fn pass(&mut self, step: Duration) {
        self.pull();
        match self.is_frozen {
            true => self.program.pass_unseen(step),
            false => self.program.tick(step),
        }
        if self.closes {
            self.program.close();
        }
    }

    fn said(&mut self) -> String {
        let state = self.program.state();
        let notices: Vec<String> = state
            .notices
            .iter()
            .map(|notice| format!("{:?}", notice.what))
            .collect();
        let link = &state.hand().connection.status;
        let stage = state.exhibit.as_ref().map(|exhibit| exhibit.view.stage);
        format!("{notices:?} {link:?} {stage:?}")
    }

    fn stop(&mut self) {
        self.act(Action::Stop);
    }

    fn stop_oddly(&mut self) {
        let event = pad::event("BTN_EAST", 1);
        self.tells(PadNews::Doubtful { pad: PAD, event });
    }

    fn grant(&mut self, may: bool) {
        let source = match self.program.state().hand().inputs.pad_view {
            Some(_) => SourceKind::Pad,
            None => SourceKind::Mirror,
        };
        self.act(Action::Input(match may {
            true => InputAction::Grant(source),
            false => InputAction::TakeBack,
        }));
    }

    fn close(&mut self) {
        self.closes = true;
    }

    fn freeze(&mut self) {
        self.is_frozen = true;
    }

    fn sleep(&mut self, length: Duration) {
        self.program.skip(length);
    }

    fn second_handscope(&mut self) {
        let dial = {
            let hand = Arc::clone(&self.hand);
            Arc::new(InMemory {
                hand,
                others: Vec::new(),
            })
        };
        let other = {
            let _inside = self.program.enter();
            link::connect(&self.hand.endpoint, dial)
        };
        self.run(1500);
        {
            let _inside = self.program.enter();
            other.arm(link::gentle());
        }
        self.run(300);
        if let Some(epoch) = other.status().armed {
            let mut open = Setpoints::none(epoch);
            open.angle[Dof::Index] = Some(Target::Go(Angle::MAX));
            let _inside = self.program.enter();
            other.set(&open);
        }
        self.second = Some(other);
    }
}
