//! The whole program changes where a hand is found, while one thing of everything goes wrong: the card, the files and the hand
//! agree in the end, or the card says what is not known, and the hand is found where the card says. Virtual time, seeded.

use crate::setup::hand::{numbered, shared};
use crate::setup::line::{Dialled, IP, Line, Trouble, some_save_answer};
use crate::setup::program::{env, start};
use crate::setup::soak;
use handscope::app::action::Action;
use handscope::app::env::Env;
use handscope::app::params::state::ParamAction;
use handscope::app::procedures::{PlaceProcedure, Procedure, ProcedureAction, ProcedureStage};
use handscope::app::program::App;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::hand::Span;
use handscope::link::Clock;
use handscope::params::backups::{Backups, Known, folder_beside};
use handscope::params::place::{PlacePair, WhichPlace};
use handscope::params::rows::{ParamId, Value};
use handscope::record::{LinkState, Saved};
use handscope::sim::{BaudEffect, Effect, FlashWrite, Personality};
use handscope::tasks::Question;
use handscope::tasks::place::{PlaceEnd, PlaceReport};
use handscope::transport::Endpoint;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use tempfile::TempDir;
use tokio::time::{Duration, Instant, sleep};

const SAVE: u16 = 1005;
/// Nobody looks at a card for longer.
const ENDS_WITHIN: Duration = Duration::from_secs(240);
const STEP: Duration = Duration::from_millis(20);
/// The wire, the row, what the hand holds and what it is to hold.
const CASES: [(&str, ParamId, u8); 8] = [
    ("rs485:/dev/hand?baud=115200&id=1", ParamId::HandId, 7),
    ("rtu:/dev/hand?baud=115200&id=1", ParamId::HandId, 7),
    ("can:can0?id=1", ParamId::HandId, 7),
    ("rs485:/dev/hand?baud=115200&id=1", ParamId::ReduRatio, 2),
    ("rtu:/dev/hand?baud=115200&id=1", ParamId::ReduRatio, 2),
    ("tcp:192.168.11.210:6000", ParamId::IpAddress, 20),
    ("rs485:/dev/hand?baud=115200&id=1", ParamId::IpAddress, 20),
    ("tcp:192.168.11.210:6000", ParamId::HandId, 7),
];

fn span(id: ParamId) -> Span {
    match id {
        ParamId::HandId => Span::new(1000, 1),
        ParamId::ReduRatio => Span::new(1002, 1),
        _ => IP,
    }
}

fn value(id: ParamId, last: u8) -> Value {
    match id {
        ParamId::IpAddress => Value::Address([192, 168, 11, last].into()),
        _ => Value::Number(last.into()),
    }
}

fn bytes(value: Value) -> Vec<u8> {
    match value {
        Value::Address(address) => address.octets().into(),
        Value::Number(number) => vec![u8::try_from(number).unwrap()],
    }
}

/// The program in front of the line.
struct Program {
    app: App,
    clock: Clock,
    line: Arc<Line>,
    folder: TempDir,
}

impl Program {
    async fn open(line: Line, hand: &str) -> Self {
        let line = Arc::new(line);
        let folder = TempDir::new().unwrap();
        let env = Env {
            dial: Arc::new(Dialled(Arc::clone(&line))),
            settings_path: Some(folder.path().join("settings.toml")),
            ..env()
        };
        let clock = env.clock;
        let app = start(env, Settings::default(), Some(hand));
        let mut program = Self {
            app,
            clock,
            line,
            folder,
        };
        assert!(
            program.is_live_within(Duration::from_secs(5)).await,
            "{hand}"
        );
        program.pass(Duration::from_secs(1)).await;
        program.act(Action::Param(ParamAction::Read));
        program.pass(Duration::from_secs(1)).await;
        program
    }

    fn act(&mut self, action: Action) {
        self.app.act(action, self.clock.now());
    }

    async fn tick(&mut self) {
        sleep(STEP).await;
        self.app.logic(self.clock.now());
    }

    async fn pass(&mut self, length: Duration) {
        let over = Instant::now() + length;
        while Instant::now() < over {
            self.tick().await;
        }
    }

    async fn is_live_within(&mut self, length: Duration) -> bool {
        let over = Instant::now() + length;
        while self.app.state().hand().connection.status.state != LinkState::Monitoring {
            if Instant::now() >= over {
                return false;
            }
            self.tick().await;
        }
        true
    }

    fn files(&self, hand: &Endpoint) -> Backups {
        let folder = folder_beside(&self.folder.path().join("settings.toml"));
        Backups::new(&folder, hand)
    }
}

fn card(state: &State) -> Option<&PlaceProcedure> {
    match state.hand().procedures.card.as_ref()? {
        Procedure::Place(card) => Some(card),
        _ => None,
    }
}

/// What a person does, decided before.
#[derive(Debug, Clone, Copy)]
struct Person {
    /// Keeps it, takes it back, or does nothing.
    keeps: Option<bool>,
    after: Duration,
    saves: bool,
}

impl Person {
    fn of(rng: &mut fastrand::Rng) -> Self {
        Self {
            keeps: [Some(true), Some(true), Some(true), Some(false), None][rng.usize(..5)],
            after: Duration::from_millis(rng.u64(..9000)),
            saves: rng.u8(..4) > 0,
        }
    }
}

/// Runs a change to its end as this person would; how it ended, or none where no backup could be made.
async fn run(program: &mut Program, person: Person, case: &str) -> Option<PlaceReport> {
    let over = Instant::now() + ENDS_WITHIN;
    let mut keeping = None;
    loop {
        assert!(Instant::now() < over, "{case}: it comes to an end");
        program.tick().await;
        let state = program.app.state();
        let is_live = state.hand().connection.status.state.is_live();
        let card = card(state).unwrap_or_else(|| panic!("{case}: no card"));
        match &card.stage {
            ProcedureStage::Doing(..) => {}
            ProcedureStage::Over(Ok(report)) => return Some(report.clone()),
            ProcedureStage::Over(Err(_)) => return None,
            ProcedureStage::Asking => panic!("{case}: it did not begin"),
        }
        let question = card.question().map(|(question, _)| question.clone());
        let yes = match question {
            Some(Question::KeepPlace(_)) => {
                let began = *keeping.get_or_insert_with(Instant::now);
                let due = began.elapsed() >= person.after;
                person.keeps.filter(|yes| due && (is_live || !yes))
            }
            Some(_) => Some(person.saves),
            None => None,
        };
        if let Some((question, yes)) = question.zip(yes) {
            program.act(Action::Answer(question, yes));
        }
    }
}

fn some_trouble(rng: &mut fastrand::Rng, at_row: bool) -> Trouble {
    let ms = |rng: &mut fastrand::Rng, most| Duration::from_millis(rng.u64(1..most));
    match rng.u8(..if at_row { 10 } else { 7 }) {
        0 => Trouble::None,
        1 => Trouble::LoseAnswer,
        2 => Trouble::Late(ms(rng, 400)),
        3 => Trouble::Mute,
        4 => Trouble::Cut,
        5 => Trouble::Gone(ms(rng, 30_000)),
        6 => Trouble::PowerCut(ms(rng, 1200)),
        7 | 8 => Trouble::Dropped,
        _ => Trouble::Takes(3),
    }
}

fn some_personality(rng: &mut fastrand::Rng) -> Personality {
    Personality {
        id_effect: [
            Effect::Now,
            Effect::Now,
            Effect::AfterSave,
            Effect::AfterPower,
        ][rng.usize(..4)],
        baud_effect: [
            BaudEffect::AfterPower,
            BaudEffect::Now,
            BaudEffect::AfterSave,
        ][rng.usize(..3)],
        flash: [FlashWrite::AtOnce, FlashWrite::Slowly][rng.usize(..2)],
        save_frame: some_save_answer(rng),
        ..Personality::default()
    }
}

/// One change from its question to its end; then what the card says, the files and the hand are compared. A word for the end.
async fn schedule(seed: u64) -> String {
    let mut rng = fastrand::Rng::with_seed(seed);
    let (hand, id, last) = CASES[rng.usize(..CASES.len())];
    let row = span(id);
    let at_row = rng.u8(..3) > 0;
    let address = if at_row { row.address } else { SAVE };
    let trouble = some_trouble(&mut rng, at_row);
    let personality = some_personality(&mut rng);
    let mut line = Line::new(personality, address, trouble);
    line.nth = if at_row { rng.usize(1..3) } else { 1 };
    let has_other = id == ParamId::HandId && !hand.starts_with("tcp") && rng.u8(..8) == 0;
    if has_other {
        line.other = Some(shared(numbered(last)));
    }
    let person = Person::of(&mut rng);
    let case = format!(
        "seed {seed}: {hand} {id:?} {trouble:?} at {address}, {person:?}, another: {has_other}, {personality:?}"
    );
    let mut program = Program::open(line, hand).await;
    let before = program.line.holds(row);
    let wanted = value(id, last);
    program.act(Action::ChangePlace(id, wanted));
    program.act(Action::Procedure(ProcedureAction::Begin));
    let end = run(&mut program, person, &case).await;
    program.pass(Duration::from_secs(1)).await;
    let Some(PlaceReport { end, .. }) = end else {
        assert_eq!(program.line.writes_to(row.address), 0, "{case}");
        return "no backup".into();
    };
    check(&mut program, &case, &end, (row, &before, &bytes(wanted))).await;
    let word = format!("{end:?}");
    let word = word.split([' ', '(']).next().unwrap();
    match end {
        PlaceEnd::Kept {
            saved: Some(saved), ..
        } => format!("{word} {}", told(&saved)),
        _ => word.to_owned(),
    }
}

const fn told(saved: &Saved) -> &'static str {
    match saved {
        Saved::Confirmed => "confirmed",
        Saved::ReadBack => "read back",
        Saved::Unknown { .. } => "unknown",
        _ => "not saved",
    }
}

async fn check(
    program: &mut Program,
    case: &str,
    end: &PlaceEnd,
    (row, before, wanted): (Span, &[u8], &[u8]),
) {
    let places = card(program.app.state()).unwrap().change.places.clone();
    let PlacePair { old, new } = places.clone();
    let line = Arc::clone(&program.line);
    let lost_power = line.lost_power.load(Ordering::Relaxed);
    let case = format!("{case}: {end:?}");
    let holds = line.holds(row);
    let is_at = |place| line.is_at(places.endpoint(place));
    if let Some(other) = &line.other {
        let writes = other.with(|hand, _| hand.journal().len());
        assert_eq!((writes, line.writes_to(row.address)), (0, 0), "{case}");
        assert!(
            matches!(end, PlaceEnd::Occupied | PlaceEnd::NotWritten),
            "{case}"
        );
    }
    // What is said of the hand as it is now. A power cut in between is seen only by looking again.
    match end {
        PlaceEnd::NotWritten | PlaceEnd::Occupied => {
            assert_eq!(line.writes_to(row.address), 0, "{case}")
        }
        PlaceEnd::NotTaken { .. } | PlaceEnd::Back => assert_eq!(holds, before, "{case}"),
        PlaceEnd::NotBack(_) | PlaceEnd::Kept { .. } if lost_power => {}
        PlaceEnd::NotBack(_) => assert_ne!(holds, before, "{case}"),
        PlaceEnd::Kept { .. } => assert_eq!(holds, wanted, "{case}"),
        PlaceEnd::Unseen(_) | PlaceEnd::Nowhere => {}
    }
    if let Some(place) = end.place().filter(|_| !lost_power) {
        assert!(is_at(place), "{case}");
        let window = program.app.state().hand().connection.endpoint.as_ref();
        assert_eq!(
            window,
            Some(places.endpoint(place)),
            "{case}: it is with its hand"
        );
    }
    // What the files say.
    let saved = match end {
        PlaceEnd::Kept { saved, .. } => saved.clone(),
        PlaceEnd::Unseen(saved) => Some(saved.clone()),
        _ => None,
    };
    let noted_at = end.place().or(saved.is_some().then_some(WhichPlace::Old));
    let known = noted_at.map(|place| program.files(places.endpoint(place)).known().unwrap());
    let is_taken = matches!(saved, Some(Saved::Confirmed | Saved::ReadBack));
    let is_unknown = matches!(saved, Some(Saved::Unknown { .. }));
    let known = known.unwrap_or_default();
    assert_eq!(
        (known.saved.is_some(), known.doubtful.is_some()),
        (is_taken, is_unknown),
        "{case}"
    );
    if line.writes_to(row.address) > 0 {
        assert_eq!(program.files(&old).backups().unwrap().len(), 1, "{case}");
    }
    if let PlaceEnd::Kept { at, .. } = end {
        let there = program.files(places.endpoint(*at));
        assert_eq!(
            there.backups().unwrap().len(),
            1,
            "{case}: the way back is found there"
        );
    }
    // What is said of the hand once it is switched off and on.
    line.power_cycle();
    let in_flash = line.holds(row);
    assert!(
        in_flash == before || is_taken || is_unknown,
        "{case}: nobody is told of {in_flash:?}"
    );
    if saved == Some(Saved::Confirmed) && !lost_power {
        assert_eq!(in_flash, wanted, "{case}");
    }
    let named = match saved {
        Some(Saved::Confirmed) if !lost_power => vec![&new],
        Some(Saved::Confirmed | Saved::ReadBack | Saved::Unknown { .. }) => vec![&old, &new],
        _ => vec![&old],
    };
    assert!(
        named.iter().any(|place| line.is_at(place)),
        "{case}: it is not where it is said"
    );
    if is_taken || is_unknown {
        let all = [&old, &new].into_iter().filter(|place| line.is_at(place));
        for place in all {
            let known = program.files(place).known().unwrap();
            assert_ne!(known, Known::default(), "{case}: its record is at {place}");
        }
    }
    let mut is_found = false;
    for place in named {
        program.act(Action::Connect(place.clone()));
        is_found |= program.is_live_within(Duration::from_secs(45)).await;
        if is_found {
            break;
        }
    }
    assert!(is_found, "{case}: nobody can reach it");
    assert!(
        program.app.state().hand().procedures.card.is_none(),
        "{case}"
    );
}

async fn all(seeds: std::ops::Range<u64>) -> std::collections::BTreeMap<String, u32> {
    let mut seen = std::collections::BTreeMap::new();
    for seed in seeds {
        *seen.entry(schedule(seed).await).or_insert(0) += 1;
    }
    seen
}

#[tokio::test(start_paused = true)]
async fn after_every_fault_the_card_the_files_and_the_hand_agree_and_the_hand_is_found_where_it_is_said()
 {
    let seen = all(0..soak::times_at_least(12, 200)).await;
    // Few schedules come to few ends.
    let least = if soak::is_full() { 2 } else { 0 };
    assert!(seen.len() > 3, "{seen:?}");
    for end in [
        "Occupied",
        "NotTaken",
        "NotBack",
        "Back",
        "Nowhere",
        "Kept",
        "Kept confirmed",
        "Kept read back",
        "Kept unknown",
        "Kept not saved",
    ] {
        assert!(
            seen.get(end).copied().unwrap_or(0) >= least,
            "{end}: {seen:?}"
        );
    }
}
