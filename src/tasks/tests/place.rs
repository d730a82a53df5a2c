//! Every order of losses, power cuts and answers in a change of place, on a hand of three facts: what is said in the end was seen.

use crate::fake::{Asked, FakeHand, Fate};
use crate::hand::ModbusException;
use crate::link::RequestError;
use crate::params::backups::Backups;
use crate::params::place::{Moved, PlacePair, WhichPlace};
use crate::params::rows::{ParamId, Value};
use crate::record::Saved;
use crate::tasks::place::{CONFIRM_TIMEOUT, PlaceChange, PlaceEnd, PlaceReport, change_place};
use crate::tasks::tests::reach::{FakeReach, place_write};
use crate::tasks::{Question, TaskError, TaskStep, User};
use crate::transport::Endpoint;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tempfile::TempDir;
use tokio::time::Instant;

const OLD: Value = Value::Number(1);
const NEW: Value = Value::Number(7);
const THIRD: Value = Value::Number(3);

/// When a hand acts on a new id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moves {
    Now,
    AfterSave,
    AfterPower,
}

/// Whether the wire finds the hand by what is changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Follows {
    Wire,
    No,
}

/// Decisions one after the other: those of a run before, and then the first of each kind, or any by chance.
#[derive(Debug, Default)]
struct Choices {
    made: Vec<(usize, usize)>,
    at: usize,
    chance: Option<fastrand::Rng>,
}

impl Choices {
    fn pick(&mut self, of: usize) -> usize {
        if self.at == self.made.len() {
            let first = self.chance.as_mut().map_or(0, |rng| rng.usize(..of));
            self.made.push((first, of));
        }
        let (pick, known) = self.made[self.at];
        assert_eq!(known, of, "a run can be repeated");
        self.at += 1;
        pick
    }

    /// Goes on to the next order of decisions; false if there is none.
    fn next(&mut self) -> bool {
        self.at = 0;
        if self.chance.is_some() {
            self.made.clear();
            return true;
        }
        while let Some((pick, of)) = self.made.pop() {
            if pick + 1 < of {
                self.made.push((pick + 1, of));
                return true;
            }
        }
        false
    }
}

/// What goes on around one change.
struct World {
    hand: FakeHand,
    moves: Moves,
    places: PlacePair,
    id: ParamId,
    choices: Choices,
    /// Answers, writes and acknowledgements that may still get lost.
    losses: usize,
    lost: usize,
    cuts: usize,
    attempts: Vec<(WhichPlace, bool)>,
    writes: usize,
    steps: usize,
}

impl World {
    fn place(&self) -> WhichPlace {
        let (holds, flash) = (self.hand.holds(self.id), self.hand.in_flash(self.id));
        match holds {
            _ if self.places.old == self.places.new => WhichPlace::Old,
            Some(NEW) if self.moves == Moves::Now => WhichPlace::New,
            Some(NEW) if self.moves == Moves::AfterSave && flash == Some(NEW) => WhichPlace::New,
            _ => WhichPlace::Old,
        }
    }

    /// Something is about to be done: power may go first.
    fn step(&mut self) {
        self.steps += 1;
        assert!(self.steps < 80, "it comes to an end");
        let differs = self.hand.holds(self.id) != self.hand.in_flash(self.id);
        if self.cuts > 0 && differs && self.choices.pick(2) == 1 {
            self.cuts -= 1;
            self.hand.power_cycle();
        }
    }

    /// Nothing is lost, or it gets lost in one of so many ways.
    fn loss(&mut self, ways: usize) -> usize {
        if self.losses == 0 {
            return 0;
        }
        let way = self.choices.pick(ways + 1);
        self.losses -= way.min(1);
        self.lost += way.min(1);
        way
    }

    fn reach(&mut self, at: &Endpoint) -> bool {
        self.step();
        let is_new = *at == self.places.new && self.places.old != self.places.new;
        let at = if is_new {
            WhichPlace::New
        } else {
            WhichPlace::Old
        };
        let is_seen = self.place() == at && self.loss(1) == 0;
        self.attempts.push((at, is_seen));
        is_seen
    }

    fn fate(&mut self, asked: &Asked) -> Fate {
        let address = ParamId::HandId.register().address;
        match asked {
            Asked::SetUnread(_) => {
                self.step();
                let way = self.loss(4);
                self.writes += usize::from(way < 2);
                let not_connected = Fate::Fails(RequestError::NotConnected);
                let refused = Fate::Fails(RequestError::Refused {
                    address,
                    reason: ModbusException::Failure.into(),
                });
                [
                    Fate::Answered,
                    Fate::AnswerLost,
                    Fate::Unheard,
                    refused,
                    not_connected,
                ][way]
                    .clone()
            }
            Asked::Save => {
                self.step();
                let not_connected = Fate::Fails(RequestError::NotConnected);
                [
                    Fate::Answered,
                    Fate::AnswerLost,
                    Fate::Unheard,
                    not_connected,
                ][self.loss(3)]
                .clone()
            }
            _ => Fate::Answered,
        }
    }
}

/// A user, who may not answer whether the change is kept.
struct Someone {
    keeps: Option<bool>,
    saves: bool,
    asked: Vec<(Question, Instant)>,
}

impl Someone {
    fn new(keeps: Option<bool>, saves: bool) -> Self {
        Self {
            keeps,
            saves,
            asked: Vec::new(),
        }
    }
}

impl User for Someone {
    async fn ask(&mut self, question: Question) -> bool {
        self.asked.push((question.clone(), Instant::now()));
        match (&question, self.keeps) {
            (Question::KeepPlace(_), Some(keeps)) => keeps,
            (Question::KeepPlace(_), None) => std::future::pending().await,
            (Question::SavePlace(_), _) => self.saves,
            (Question::Apply(_) | Question::Save(_), _) => panic!("not asked here: {question:?}"),
        }
    }
}

fn change(follows: Follows) -> PlaceChange {
    let old: Endpoint = "rs485:/dev/x?id=1".parse().unwrap();
    let new = match follows {
        Follows::Wire => "rs485:/dev/x?id=7".parse().unwrap(),
        Follows::No => old.clone(),
    };
    PlaceChange {
        id: ParamId::HandId,
        before: OLD,
        wanted: NEW,
        places: PlacePair { old, new },
        is_followed: follows == Follows::Wire,
    }
}

/// One change in one world; its end, or why nothing began.
async fn run(
    world: &Arc<Mutex<World>>,
    change: &PlaceChange,
    folder: &Path,
) -> Result<PlaceReport, TaskError> {
    let hand = world.lock().unwrap().hand.clone();
    let script = Arc::clone(world);
    hand.script(move |asked| script.lock().unwrap().fate(asked));
    let shared = Arc::clone(world);
    let mut reach = FakeReach {
        hand,
        is_there: move |place: &Endpoint| shared.lock().unwrap().reach(place),
    };
    let mut person = {
        let choices = &mut world.lock().unwrap().choices;
        Someone::new(
            [Some(true), Some(false), None][choices.pick(3)],
            choices.pick(2) == 0,
        )
    };
    let backups = Backups::new(folder, &change.places.old);
    change_place(&mut reach, change, &backups, &mut person, |_| ()).await
}

fn check(world: &World, end: &PlaceEnd) {
    let holds = world.hand.holds(world.id).unwrap();
    let last = world.attempts.last().unwrap().1;
    match end {
        PlaceEnd::NotWritten | PlaceEnd::Occupied => assert_eq!((world.writes, holds), (0, OLD)),
        // What is said was seen, or power took it back meanwhile.
        PlaceEnd::NotTaken { .. } | PlaceEnd::Back => assert_eq!(holds, OLD),
        PlaceEnd::NotBack(at) => assert!(world.attempts.contains(&(*at, true))),
        PlaceEnd::Kept { at, saved } => {
            assert!(world.attempts.contains(&(*at, true)));
            if *saved == Some(Saved::Confirmed) {
                assert_eq!(world.hand.in_flash(world.id), Some(holds));
            }
        }
        PlaceEnd::Unseen(_) | PlaceEnd::Nowhere => {
            assert!(!last);
            assert!(world.lost >= 3, "a hand that is there is found");
        }
    }
}

fn kind(end: &PlaceEnd) -> String {
    let name = format!("{end:?}");
    name.split([' ', '(']).next().unwrap().to_owned()
}

#[test]
fn however_answers_and_power_are_lost_the_end_is_true() {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .start_paused(true)
        .build()
        .unwrap();
    let folder = TempDir::new().unwrap();
    let (mut ends, mut kinds) = (0_u32, BTreeSet::new());
    for (follows, moves) in [
        (Follows::Wire, Moves::Now),
        (Follows::Wire, Moves::AfterSave),
        (Follows::Wire, Moves::AfterPower),
        (Follows::No, Moves::AfterPower),
    ] {
        for (losses, cuts, runs) in LOSSES {
            let change = change(follows);
            let mut choices = Choices {
                chance: (losses > 1).then(|| fastrand::Rng::with_seed(7)),
                ..Choices::default()
            };
            for _run in 0..runs {
                let world = World {
                    hand: runtime.block_on(async { FakeHand::new() }),
                    moves,
                    places: change.places.clone(),
                    id: change.id,
                    choices: std::mem::take(&mut choices),
                    losses,
                    lost: 0,
                    cuts,
                    attempts: Vec::new(),
                    writes: 0,
                    steps: 0,
                };
                let world = Arc::new(Mutex::new(world));
                let own = folder.path().join(ends.to_string());
                let end = runtime.block_on(run(&world, &change, &own));
                let mut world = world.lock().unwrap();
                assert!(world.writes <= 2, "there and back");
                match end {
                    Ok(report) => {
                        check(&world, &report.end);
                        kinds.insert(kind(&report.end));
                    }
                    Err(error) => assert_eq!((world.writes, error), (0, TaskError::NotReached)),
                }
                ends += 1;
                choices = std::mem::take(&mut world.choices);
                if !choices.next() {
                    break;
                }
            }
        }
    }
    assert!(ends > 200, "{ends}");
    for kind in [
        "NotWritten",
        "NotTaken",
        "Back",
        "Kept",
        "NotBack",
        "Nowhere",
    ] {
        assert!(kinds.contains(kind), "{kinds:?}");
    }
}

/// Losses and power cuts that may be, and the most orders that are tried of them: all of few losses, some of many.
const LOSSES: [(usize, usize, usize); 3] = [(0, 1, 1000), (1, 0, 40), (7, 1, 250)];

/// A change without any trouble but this script, and the user who wants this.
async fn run_change(
    change: &PlaceChange,
    hand: &FakeHand,
    is_there: impl FnMut(&Endpoint) -> bool + Send,
    mut person: Someone,
) -> (
    PlaceReport,
    Vec<(TaskStep, Instant)>,
    Vec<(Question, Instant)>,
) {
    let folder = TempDir::new().unwrap();
    let backups = Backups::new(folder.path(), &change.places.old);
    let mut reach = FakeReach {
        hand: hand.clone(),
        is_there,
    };
    let mut steps = Vec::new();
    let end = change_place(&mut reach, change, &backups, &mut person, |step| {
        steps.push((step, Instant::now()));
    });
    let report = end.await.unwrap();
    (report, steps, person.asked)
}

/// Where a hand that acts at once answers.
fn at_its_place(
    hand: &FakeHand,
    places: &PlacePair,
) -> impl FnMut(&Endpoint) -> bool + Send + use<> {
    let (hand, places) = (hand.clone(), places.clone());
    move |place| match hand.holds(ParamId::HandId) {
        Some(NEW) => *place == places.new,
        _ => *place == places.old,
    }
}

#[tokio::test(start_paused = true)]
async fn without_an_answer_it_goes_back_after_fifteen_seconds_and_not_before() {
    let (change, hand) = (change(Follows::Wire), FakeHand::new());
    let there = at_its_place(&hand, &change.places);
    let nobody = Someone::new(None, true);
    let (report, steps, asked) = run_change(&change, &hand, there, nobody).await;
    assert_eq!(
        (report.moved, report.end),
        (Some(Moved::There), PlaceEnd::Back)
    );
    let returns = steps.iter().find(|(step, _)| *step == TaskStep::Returning);
    let [(Question::KeepPlace(WhichPlace::New), since)] = asked[..] else {
        panic!("asked once: {asked:?}");
    };
    let waited = returns.unwrap().1 - since;
    assert!(waited >= CONFIRM_TIMEOUT && waited < CONFIRM_TIMEOUT + Duration::from_millis(5));
    let words: Vec<_> = steps.into_iter().map(|(step, _)| step).collect();
    let back = words.iter().position(|step| *step == TaskStep::Returning);
    assert_eq!(
        words[back.unwrap() + 1..],
        [
            TaskStep::Looking(WhichPlace::New),
            TaskStep::Looking(WhichPlace::Old),
            TaskStep::Writing(WhichPlace::New),
            TaskStep::Looking(WhichPlace::Old),
        ],
        "is the old id free, before it is taken"
    );
    assert_eq!(hand.holds(ParamId::HandId), Some(OLD));
}

#[tokio::test(start_paused = true)]
async fn an_id_that_another_hand_has_is_not_written_over_it_on_the_way_there_or_back() {
    let keeper = || Someone::new(Some(true), true);
    let (change, hand) = (change(Follows::Wire), FakeHand::new());
    let (report, ..) = run_change(&change, &hand, |_| true, keeper()).await;
    assert_eq!(report.end, PlaceEnd::Occupied);
    assert!(!hand.asked().iter().any(is_write));

    // Another hand comes to the old id while the user thinks.
    let hand = FakeHand::new();
    let mut own = at_its_place(&hand, &change.places);
    let asked = hand.clone();
    let there = move |place: &Endpoint| own(place) || asked.holds(ParamId::HandId) == Some(NEW);
    let leaver = Someone::new(Some(false), false);
    let (report, ..) = run_change(&change, &hand, there, leaver).await;
    assert_eq!(report.end, PlaceEnd::NotBack(WhichPlace::New));
    let writes = hand.asked().into_iter().filter(is_write);
    assert!(writes.eq([place_write(ParamId::HandId, NEW)]));
}

fn is_write(asked: &Asked) -> bool {
    matches!(asked, Asked::SetUnread(_))
}

#[tokio::test(start_paused = true)]
async fn a_third_value_is_put_back_before_anybody_can_save_it() {
    for (first, then, expected) in [
        (Fate::Takes(3), Fate::Answered, PlaceEnd::Back),
        (
            Fate::Takes(3),
            Fate::Takes(3),
            PlaceEnd::NotBack(WhichPlace::Old),
        ),
    ] {
        let (change, hand) = (change(Follows::No), FakeHand::new());
        let mut writes = 0;
        let (first, then) = (first.clone(), then.clone());
        hand.script(move |asked| {
            if !is_write(asked) {
                return Fate::Answered;
            }
            writes += 1;
            if writes == 1 {
                first.clone()
            } else {
                then.clone()
            }
        });
        let keeper = Someone::new(Some(true), true);
        let (report, steps, asked) = run_change(&change, &hand, |_| true, keeper).await;
        assert_eq!(report.end, expected);
        let saves = steps.iter().any(|(step, _)| *step == TaskStep::Saving);
        assert!(asked.is_empty() && !saves);
        let holds = hand.holds(ParamId::HandId);
        assert_eq!(holds == Some(THIRD), expected != PlaceEnd::Back);
    }
}

/// Runs a change where these answer: at the new place before the write, and at each look after it.
async fn moved(
    follows: Follows,
    before: Option<Value>,
    refused: bool,
    after: &[(Option<Value>, Option<Value>)],
) -> (Moved, usize) {
    let (change, hand) = (change(follows), FakeHand::new());
    let written = Arc::new(Mutex::new(false));
    let fate = Arc::clone(&written);
    hand.script(move |asked| {
        if !is_write(asked) {
            return Fate::Answered;
        }
        *fate.lock().unwrap() = true;
        if refused {
            Fate::Fails(RequestError::Refused {
                address: 1000,
                reason: ModbusException::Failure.into(),
            })
        } else {
            Fate::Unheard
        }
    });
    let places = change.places.clone();
    let answering = hand.clone();
    let (mut rounds, mut round) = (after.iter().copied(), (None, None));
    let mut old_looks = 0;
    let is_there = move |place: &Endpoint| {
        let is_new = follows == Follows::Wire && *place == places.new;
        let is_written = *written.lock().unwrap();
        let holds = match (is_written, is_new) {
            (false, true) => before,
            (false, false) => Some(OLD),
            (true, true) => {
                round = rounds.next().unwrap_or_default();
                round.0
            }
            (true, false) if follows == Follows::No || refused && old_looks == 0 => {
                round = rounds.next().unwrap_or_default();
                old_looks += 1;
                round.1
            }
            (true, false) => round.1,
        };
        if let Some(value) = holds {
            answering.put(ParamId::HandId, value);
        }
        holds.is_some()
    };
    let keeper = Someone::new(Some(true), false);
    let (report, ..) = run_change(&change, &hand, is_there, keeper).await;
    let writes = hand.asked().into_iter().filter(is_write).count();
    (report.moved.unwrap(), writes)
}

#[tokio::test(start_paused = true)]
async fn every_end_of_a_change_is_told_as_it_is_and_nothing_is_written_twice() {
    let reason = ModbusException::Failure.into();
    for (before, refused, after, expected, writes) in [
        (Some(NEW), false, &[][..], Moved::Occupied, 0),
        (None, false, &[(Some(NEW), None)], Moved::There, 1),
        (None, false, &[(None, Some(NEW))], Moved::Waits, 1),
        (None, false, &[(None, Some(OLD))], Moved::Stayed, 1),
        (
            None,
            false,
            &[(None, None), (None, None), (Some(NEW), None)],
            Moved::There,
            1,
        ),
        (
            None,
            false,
            &[(None, None), (None, Some(OLD))],
            Moved::Stayed,
            1,
        ),
        (None, false, &[], Moved::Nowhere, 1),
        (
            None,
            true,
            &[(None, Some(OLD))],
            Moved::Refused { reason },
            1,
        ),
        (None, true, &[(None, Some(NEW))], Moved::Waits, 1),
    ] {
        let end = moved(Follows::Wire, before, refused, after).await;
        assert_eq!(end, (expected, writes), "{before:?} {refused} {after:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn whoever_answers_in_whatever_order_the_end_is_true() {
    let answers = [None, Some(OLD), Some(NEW)];
    let mut ends = 0;
    for new in answers {
        for old in answers {
            for later_new in answers {
                for later_old in answers {
                    let after = [(new, old), (later_new, later_old)];
                    let (moved, writes) = moved(Follows::Wire, None, false, &after).await;
                    assert_eq!(writes, 1);
                    let heard_new = new.is_some() || old.is_none() && later_new.is_some();
                    assert_eq!(moved == Moved::There, heard_new, "{after:?}");
                    ends += 1;
                }
            }
        }
    }
    assert_eq!(ends, 81);
}

#[tokio::test(start_paused = true)]
async fn a_change_that_waits_for_power_is_looked_for_only_where_the_hand_is() {
    for (holds, expected) in [
        (Some(NEW), Moved::Waits),
        (Some(OLD), Moved::Stayed),
        (None, Moved::Nowhere),
    ] {
        let after = [(None, holds); 3];
        let (moved, writes) = moved(Follows::No, None, false, &after).await;
        assert_eq!((moved, writes), (expected, 1));
    }
}

#[tokio::test(start_paused = true)]
async fn nothing_is_written_where_no_backup_can_be_made_or_no_hand_answers() {
    let (change, hand) = (change(Follows::Wire), FakeHand::new());
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    for (folder, is_there) in [(file.as_path(), true), (folder.path(), false)] {
        let backups = Backups::new(folder, &change.places.old);
        let mut reach = FakeReach {
            hand: hand.clone(),
            is_there: move |_: &_| is_there,
        };
        let mut keeper = Someone::new(Some(true), true);
        let end = change_place(&mut reach, &change, &backups, &mut keeper, |_| ()).await;
        assert!(
            matches!(end, Err(TaskError::NoBackup { .. } | TaskError::NotReached)),
            "{end:?}"
        );
        assert!(!hand.asked().iter().any(is_write));
    }
}

#[tokio::test(start_paused = true)]
async fn what_is_taken_back_is_what_the_hand_held_and_not_what_a_person_was_shown() {
    let hand = FakeHand::new();
    let shown = PlaceChange {
        before: THIRD,
        ..change(Follows::Wire)
    };
    let there = at_its_place(&hand, &shown.places);
    let leaver = Someone::new(Some(false), false);
    let (report, ..) = run_change(&shown, &hand, there, leaver).await;
    assert_eq!(report.end, PlaceEnd::Back);
    assert_eq!(hand.holds(ParamId::HandId), Some(OLD));
}
