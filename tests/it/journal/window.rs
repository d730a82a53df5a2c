//! The window's program in front of a line, without a window and in virtual time. It is driven through `App::act`,
//! `App::logic` and `App::state` only, and all that is known of it stands in this file.

use crate::journal::line::{Line, named};
use crate::journal::page::{Case, Outcome, masked, write_file};
use crate::setup::program::InFolder;
use futures::FutureExt as _;
use futures::future::{BoxFuture, ready};
use handscope::app::action::Action;
use handscope::app::env::Env;
use handscope::app::files::reveal::no_reveal;
use handscope::app::hand::{Play, Preset};
use handscope::app::params::action::ParamAction;
use handscope::app::params::state::SaveEnd;
use handscope::app::procedures::{Procedure, ProcedureAction, ProcedureStage};
use handscope::app::program::App;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::app::trials::TrialAction;
use handscope::hand::{Angle, Dof, Force, Gesture, GestureRoute, Speed};
use handscope::link::Clock;
use handscope::params::backups::saved_name;
use handscope::params::rows::{ParamId, Value};
use handscope::params::values::Params;
use handscope::record::{LinkState, Saved};
use handscope::tasks::TaskError;
use handscope::tasks::place::PlaceStep;
use handscope::tasks::reset::ResetEnd;
use handscope::transport::{BoxedWire, Dial, Endpoint, TransportError, pair};
use handscope::trials::plan::{Approach, TrialPlan, Until};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;
use tokio::time::{Instant, sleep};

/// One frame.
const FRAME: Duration = Duration::from_millis(20);
/// Nothing that is waited for takes longer.
const PATIENCE: Duration = Duration::from_secs(300);

/// Dials the line; at another address, or before the hand acts on a new one, nobody answers.
struct Dialled(Arc<Line>);

impl Dial for Dialled {
    fn dial(&self, place: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let (line, heard_by) = (Arc::clone(&self.0), Arc::clone(&self.0));
        line.note(format!("open {place}"));
        if !line.is_at(place) {
            let place = place.to_string();
            return ready(Err(TransportError::Missing { place })).boxed();
        }
        let ((near, ours), at) = (pair(), place.clone());
        let is_heard = move || match &at {
            Endpoint::Rs485(at) | Endpoint::Rtu(at) => heard_by.is_heard_at(at.baud),
            _ => true,
        };
        tokio::spawn(line.carry(place.clone(), ours, is_heard));
        ready(Ok(Box::new(near) as BoxedWire)).boxed()
    }
}

/// The program.
struct Program {
    app: App,
    clock: Clock,
    line: Arc<Line>,
    hand: Endpoint,
    /// Notices that were told already.
    told: usize,
}

/// Runs a case on one wire.
pub(crate) fn run(case: &Case, wire: &str) -> Vec<Outcome> {
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_all().start_paused(true).build().unwrap();
    runtime.block_on(play(case, wire))
}

async fn play(case: &Case, wire: &str) -> Vec<Outcome> {
    let folder = TempDir::new().unwrap();
    let line = Line::new(&case.ids, case.config, &case.upsets);
    let mut program = None;
    let mut outcomes = Vec::new();
    let mut acted = false;
    for step in case.steps() {
        let words: Vec<&str> = step.split(' ').collect();
        let mut outcome = Outcome::default();
        match (words[0], &words[1..]) {
            ("file", words) => write_file(folder.path(), words),
            ("hand", words) => line.event(words),
            ("open", []) => program = Some(Program::open(&line, wire, &folder)),
            ("begin", [millis]) => {
                let mut opened = Program::open(&line, wire, &folder);
                opened.pass(millis.parse().unwrap()).await;
                program = Some(opened);
                // How a hand is found stands in a case of its own.
                line.take_settled();
            }
            (verb, words) => {
                let program = program.as_mut().expect("it is open");
                // Two decisions of a person never come within one frame.
                if std::mem::replace(&mut acted, verb == "act") && verb == "act" {
                    program.frame().await;
                }
                match verb {
                    "act" => program.act(words),
                    "wait" => program.pass(words[0].parse().unwrap()).await,
                    "until" => program.until(words).await,
                    "tell" => outcome.said = program.tell(),
                    other => panic!("no step: {other}"),
                }
            }
        }
        let names = [(folder.path().to_str().unwrap(), "DIR")];
        let mask = |line: String| masked(&line, &names, &case.hides);
        outcome.said = outcome.said.into_iter().map(mask).collect();
        outcome.passed = case.lines(&line.take_settled());
        outcomes.push(outcome);
    }
    outcomes
}

impl Program {
    fn open(line: &Arc<Line>, wire: &str, folder: &TempDir) -> Self {
        let hand = match wire {
            "tcp" => "tcp:192.168.11.210:6000".parse(),
            _ => format!("{wire}:/dev/hand").parse(),
        };
        let (hand, clock): (Endpoint, _) = (hand.unwrap(), Clock::start());
        let env = Env {
            runtime: tokio::runtime::Handle::current(),
            clock,
            dial: Arc::new(Dialled(Arc::clone(line))),
            wake: Arc::new(|| ()),
            reveal: no_reveal(),
            files: Arc::new(InFolder(folder.path().into())),
            settings_path: Some(folder.path().join("settings.toml")),
            documents: None,
        };
        let mut app = App::new(env, Settings::default());
        app.open(Some(hand.clone()), clock.now());
        let line = Arc::clone(line);
        Self {
            app,
            clock,
            line,
            hand,
            told: 0,
        }
    }

    async fn frame(&mut self) {
        sleep(FRAME).await;
        self.app.logic(self.clock.now());
    }

    async fn pass(&mut self, millis: u64) {
        let over = Instant::now() + Duration::from_millis(millis);
        while Instant::now() < over {
            self.frame().await;
        }
    }

    async fn until(&mut self, words: &[&str]) {
        let over = Instant::now() + PATIENCE;
        // A task takes an answer in the frame after it was given, and tells its next step in the one after that.
        if words == ["decision"] {
            self.frame().await;
            self.frame().await;
        }
        while !self.is(words) {
            assert!(Instant::now() < over, "{words:?} does not come");
            self.frame().await;
        }
    }

    fn is(&self, words: &[&str]) -> bool {
        let state = self.app.state();
        match words {
            ["live"] => state.hand().link.state.is_live(),
            ["lost"] => !state.hand().link.state.is_live(),
            ["armed"] => state.hand().link.state == LinkState::Armed,
            // Files are listed on a thread, which knows nothing of virtual time.
            ["idle"] => !state.hand().params.is_busy() && state.hand().params.files.is_some(),
            ["decision"] => {
                let decides = decides(state.hand().procedure.as_ref().expect("a card"));
                decides && state.hand().params.files.is_some()
            }
            ["series", "over"] => !state.hand().runs_series(),
            ["sequence", "over"] => !state
                .hand()
                .sequence
                .as_ref()
                .is_some_and(handscope::app::hand::sequence::SequenceRun::is_running),
            [dof, "below", angle] => self.line.angle(named(dof)) <= angle.parse().unwrap(),
            [dof, "above", angle] => self.line.angle(named(dof)) >= angle.parse().unwrap(),
            other => panic!("nothing to wait for: {other:?}"),
        }
    }

    fn act(&mut self, words: &[&str]) {
        let action = match words {
            ["connect"] => Action::Connect(self.hand.clone()),
            words => action(words, self.app.state()),
        };
        self.app.act(action, self.clock.now());
    }

    /// What a person is told.
    fn tell(&mut self) -> Vec<String> {
        let state = self.app.state();
        let book = &state.hand().params;
        let mut said = vec![format!("link {:?}", state.hand().link.state)];
        said.extend((!book.live_params().is_empty()).then(|| live(&book.live_params())));
        let staged = rows(book.all_staged());
        said.extend((!staged.is_empty()).then(|| format!("staged {}", staged.join(" "))));
        let ends = ParamId::all().into_iter().filter_map(|id| book.outcome(id));
        said.extend(ends.map(|end| format!("row {} {}", end.id.name(), end.verdict.name())));
        said.extend(book.question.as_ref().map(|question| {
            let joints: Vec<_> = question
                .dangers
                .iter()
                .map(|danger| danger.dof.name())
                .collect();
            format!("question {} {}", word(&question.what), joints.join(" "))
        }));
        said.extend(
            book.trouble
                .as_ref()
                .map(|error| format!("trouble {error}")),
        );
        said.extend(
            book.save
                .as_ref()
                .map(|(end, _)| format!("save {}", save(end))),
        );
        let (saved, doubtful) = (&book.known.saved, &book.known.doubtful);
        said.extend(saved.iter().map(|file| format!("flash {}", file.verdict)));
        said.extend(
            doubtful
                .iter()
                .map(|file| format!("doubtful {}", file.verdict)),
        );
        let backups = book.backups.iter().flat_map(|backup| &backup.file);
        said.extend(backups.map(|file| format!("backup {}", file.why)));
        said.extend(
            state
                .hand()
                .procedure
                .as_ref()
                .map(|of| format!("card {}", card(of))),
        );
        let player = state.hand().sequence.as_ref().map(|run| &run.view);
        said.extend(player.map(|it| format!("sequence {} {}", it.at, word(it.phase))));
        let trials = state
            .trials
            .sessions
            .iter()
            .flat_map(|session| &session.trials);
        said.extend(trials.map(|it| {
            format!(
                "trial {:?} {:?}",
                it.summary.setting,
                it.summary.aborted.is_some()
            )
        }));
        let notices: Vec<_> = state.notices.log().skip(self.told).collect();
        self.told += notices.len();
        said.extend(
            notices
                .iter()
                .map(|notice| format!("notice {}", word(&notice.what))),
        );
        said
    }
}

/// True where a card waits for a person, or is over.
fn decides(card: &Procedure) -> bool {
    use ProcedureStage::{Doing, Over};
    match card {
        Procedure::Place(card) => matches!(
            card.stage,
            Doing(PlaceStep::Keeping(_) | PlaceStep::Offering(_), _) | Over(_)
        ),
        Procedure::Reset(card) => card.stage.end().is_some(),
        Procedure::Calibrate(card) => card.stage.end().is_some(),
    }
}

/// Where a card stands: a step, or how it ended.
fn card(card: &Procedure) -> String {
    use ProcedureStage::{Asking, Doing, Over};
    match card {
        Procedure::Place(card) => match &card.stage {
            Asking => "Asking".into(),
            Doing(PlaceStep::Keeping(at), _) => format!("Keeping {at:?}"),
            Doing(step, _) => format!("{step:?}"),
            Over(Ok(report)) => format!("Over({:?})", report.end),
            Over(Err(error)) => not_done(error),
        },
        Procedure::Reset(card) => match &card.stage {
            Asking => "Asking".into(),
            Doing(step, _) => format!("{step:?}"),
            Over(Ok(report)) => match &report.end {
                ResetEnd::Found { at, left, .. } => {
                    format!("Over(Found {{ at: {at:?}, left: {left:?} }})")
                }
                end => format!("Over({end:?})"),
            },
            Over(Err(error)) => not_done(error),
        },
        Procedure::Calibrate(card) => match &card.stage {
            Asking => "Asking".into(),
            Doing(..) => "None".into(),
            Over(report) => format!("{:?}", report.end.as_ref().ok()),
        },
    }
}

fn not_done(error: &TaskError) -> String {
    let why = match error {
        TaskError::NotRead { why, .. } => why.to_string(),
        error => error.to_string(),
    };
    format!("NoBackup {{ why: {why:?} }}")
}

fn rows(all: &Params) -> Vec<String> {
    let row = |(id, value): (ParamId, Value)| format!("{}={value}", id.name());
    all.iter().map(row).collect()
}

/// What was read, without what is as at delivery; six joints alike stand there once.
fn live(all: &Params) -> String {
    let delivered = |id: ParamId| id.factory().unwrap_or(Value::Number(1000));
    let mut others = rows(&all.only(|id| all.get(id) != Some(delivered(id))));
    for group in ["default_speed", "default_force"] {
        let of_group = others.iter().filter_map(|row| row.split_once('='));
        let of_group = of_group.filter(|(name, _)| name.starts_with(group));
        let six: Vec<String> = of_group.map(|(_, value)| value.into()).collect();
        if six.len() == 6 && six.iter().all(|other| *other == six[0]) {
            others.retain(|row| !row.starts_with(group));
            others.push(format!("{group}={}", six[0]));
        }
    }
    format!("live {} rows {}", all.iter().count(), others.join(" "))
}

fn save(end: &SaveEnd) -> String {
    match end {
        SaveEnd::Told(Saved::NotSent(why)) => format!("not sent: {why}"),
        SaveEnd::Told(saved) => saved_name(saved).into(),
        SaveEnd::NoBackup { .. } => "no backup".into(),
        SaveEnd::NotAsked(error) => format!("not asked: {error}"),
        SaveEnd::NotApplied => "not applied".into(),
        SaveEnd::NotNoted(saved, _) => format!("{}, not noted", saved_name(saved)),
    }
}

/// The name of a variant, without what it carries.
fn word(of: impl std::fmt::Debug) -> String {
    format!("{of:?}")
        .split([' ', '(', '{'])
        .next()
        .unwrap()
        .to_owned()
}

fn number(word: &str) -> i64 {
    word.parse().unwrap()
}

/// A row and a value for it.
fn value(name: &str, word: &str) -> (ParamId, Value) {
    match ParamId::named(name)[0] {
        id @ ParamId::IpAddress => (id, Value::Address(word.parse().unwrap())),
        id => (id, Value::Number(word.parse().unwrap())),
    }
}

/// What a person asks for.
fn action(words: &[&str], state: &State) -> Action {
    let (speed, force) = (
        |word| Speed::nearest(number(word)),
        |word| Force::nearest(number(word)),
    );
    let sequence = || state.poses.library.sequences[0].id;
    let pose = |name| state.poses.library.pose_named(name).expect("a pose").id;
    match words {
        ["read"] => Action::Param(ParamAction::Read),
        ["apply"] => Action::Param(ParamAction::Apply),
        ["undo"] => Action::Param(ParamAction::Undo),
        ["save"] => Action::Param(ParamAction::Save),
        ["agree"] => Action::Param(ParamAction::Agree),
        ["decline"] => Action::Param(ParamAction::Decline),
        ["dump"] => Action::Param(ParamAction::Dump),
        ["copy", "live"] => Action::Param(ParamAction::CopyLive),
        ["stage", name, word] => Action::Stage(value(name, word).0, Some(value(name, word).1)),
        ["place", name, word] => Action::ChangePlace(value(name, word).0, value(name, word).1),
        ["reset"] => Action::FactoryReset,
        ["calibrate"] => Action::CalibrateForce,
        ["begin"] => Action::Procedure(ProcedureAction::Begin),
        ["keep"] => Action::Procedure(ProcedureAction::Keep),
        ["go", "back"] => Action::Procedure(ProcedureAction::GoBack),
        ["save", "place"] => Action::Procedure(ProcedureAction::Save),
        ["leave", "unsaved"] => Action::Procedure(ProcedureAction::LeaveUnsaved),
        ["close"] => Action::Procedure(ProcedureAction::Close),
        ["arm"] => Action::Arm,
        ["disarm"] => Action::Disarm,
        ["stop"] => Action::Stop,
        ["clear"] => Action::ClearErrors,
        ["connect", place] => Action::Connect(place.parse().unwrap()),
        ["disconnect"] => Action::Disconnect,
        ["target", dof, angle] => Action::Target(named(dof), Angle::nearest(number(angle))),
        ["speed", "all", word] => Action::Speed(None, speed(word)),
        ["speed", dof, word] => Action::Speed(Some(named(dof)), speed(word)),
        ["force", "all", word] => Action::Force(None, force(word)),
        ["force", dof, word] => Action::Force(Some(named(dof)), force(word)),
        ["lock", dof] => Action::Lock(named(dof), true),
        ["free", dof] => Action::Lock(named(dof), false),
        ["preset", "open"] => Action::Preset(Preset::Open),
        ["preset", "half"] => Action::Preset(Preset::Half),
        ["preset", "close"] => Action::Preset(Preset::Close),
        ["gesture", of] => Action::Gesture(Gesture::nearest(number(of))),
        ["route", "library"] => Action::GestureRoute(GestureRoute::ActionLibrary),
        ["route", "off"] => Action::GestureRoute(GestureRoute::Off),
        ["recall", name] => Action::Recall(pose(name)),
        ["play", "start"] => Action::Play(Play::Start(
            handscope::poses::library::EntryId::Sequence(sequence()),
        )),
        ["play", "step"] => Action::Play(Play::Step(sequence())),
        ["play", "pause"] => Action::Play(Play::Pause),
        ["play", "resume"] => Action::Play(Play::Resume),
        ["play", "end"] => Action::Play(Play::End),
        ["plan", words @ ..] => Action::Trial(TrialAction::Plan(Box::new(plan(words)))),
        ["series"] => Action::Trial(TrialAction::Start),
        other => panic!("nobody asks so: {other:?}"),
    }
}

/// A series of the index finger: `speed=100,250 start=620 close=300 repeat=2 ceiling=700 fast=250 touch=20`.
fn plan(words: &[&str]) -> TrialPlan {
    let mut plan = TrialPlan::default();
    (plan.grid.rest, plan.dwell) = (Duration::ZERO, Duration::from_millis(500));
    plan.limits.ceiling_g = 4000;
    let mut fast = Speed::MAX;
    let mut until = None;
    for word in words {
        let (key, value) = word.split_once('=').unwrap();
        let speeds = || value.split(',').map(|word| Speed::nearest(number(word)));
        let short = || value.parse::<i16>().unwrap();
        match key {
            "speed" => plan.grid.speeds = speeds().collect(),
            "start" => plan.start[Dof::Index] = Some(Angle::nearest(short())),
            "close" => plan.close[Dof::Index] = Some(Angle::nearest(short())),
            "repeat" => plan.grid.repeats = value.parse().unwrap(),
            "ceiling" => plan.limits.ceiling_g = short(),
            "fast" => fast = Speed::nearest(short()),
            "measured" => until = Some(Until::Measured { margin: short() }),
            "angle" => until = Some(Until::Angle(Angle::nearest(short()))),
            "proximity" => until = Some(Until::Proximity(short().into())),
            "touch" => until = Some(Until::Touch(Force::nearest(short()))),
            other => panic!("no part of a plan: {other}"),
        }
    }
    if let Some(until) = until {
        plan.approach = Approach::TwoStage { fast, until };
    }
    plan
}
