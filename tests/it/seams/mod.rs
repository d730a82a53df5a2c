//! The seams between what moves a hand and what happens meanwhile: one table, every cell tried over the wires, or a word why it
//! cannot be; one test an event. The hand's own journal and joints judge. `HANDSCOPE_SEAMS=whole` tries every cell on every wire; any
//! other text tries the cells in whose names it is found, on every wire, with every mover of the row; `HANDSCOPE_SEAMS_MOVER` names one.

mod event;
mod hand;
mod judge;
mod mover;
mod process;
mod table;
mod window;

use crate::seams::event::Witness;
use crate::seams::hand::HandKind;
use crate::seams::judge::{Seen, Verdict};
use crate::seams::process::{Place, Process};
use crate::seams::table::{Cell, Column, Row, cell, cell_on};
use crate::seams::window::Window;
use crate::setup::body::Protocol;
use crate::setup::busy::unless_busy;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Cells at a time, unless `HANDSCOPE_SEAMS_AT_A_TIME` says otherwise: nearly all of their time they wait, but a slow guest is late then.
const AT_A_TIME: usize = 4;
/// One try: a cell on a wire.
#[derive(Debug, Clone, Copy)]
struct Try {
    row: Row,
    column: Column,
    protocol: Protocol,
    number: usize,
}

impl Try {
    fn name(&self) -> String {
        let (row, column) = (self.row.name(), self.column.name());
        format!("{row} / {column} / {}", hand::name(self.protocol))
    }

    fn hand(&self) -> HandKind {
        match (self.row, self.column) {
            (_, Column::RestsShort) => HandKind::RestsShort,
            (Row::Params, _) => HandKind::Slow,
            _ => HandKind::Usual,
        }
    }

    /// Every way in which this row moves a hand.
    fn movers(&self) -> &'static [(&'static str, Start)] {
        match self.row {
            Row::Slider => &[("slider", Start::Window(Window::slider))],
            Row::Pose => &[
                ("pose", Start::Window(Window::pose)),
                ("sequence", Start::Window(Window::sequence)),
                ("held_step", Start::Window(Window::held_step)),
            ],
            Row::Series => &[
                ("series", Start::Window(Window::series)),
                ("armed_series", Start::Window(Window::armed_series)),
                ("search", Start::Window(Window::search)),
                ("checkup", Start::Window(Window::checkup)),
                ("hold", Start::Window(Window::hold)),
                ("scale", Start::Window(Window::scale)),
            ],
            Row::Exhibition => &[("exhibition", Start::Window(Window::exhibition))],
            Row::Calibration => &[("calibration", Start::Window(Window::calibration))],
            Row::Gamepad => &[("gamepad", Start::Window(Window::gamepad))],
            Row::Leading => match self.column {
                Column::Signal
                | Column::Killed
                | Column::ReaderGone
                | Column::OutputUnread
                | Column::HolderKilled
                | Column::HolderFrozen
                | Column::Busy
                | Column::NoDescriptors => &[("led", Start::Process(Place::led))],
                Column::Panic
                | Column::Frozen
                | Column::DisplayLost
                | Column::Asleep
                | Column::LinkLost
                | Column::Replugged
                | Column::PowerCycled
                | Column::FeedbackFrozen
                | Column::OddReplies
                | Column::Disobeys
                | Column::SecondMaster
                | Column::SecondHandscope
                | Column::GatewayRefuses
                | Column::StopThenLost
                | Column::RepliesSlow
                | Column::RestsShort
                | Column::JointFrozen
                | Column::OddStop
                | Column::GrantedAgain
                | Column::FaultOrHeat => &[("led", Start::Window(Window::led))],
            },
            // The index of a grip has no farther to go than a drive may rest beside its target: it may have arrived.
            Row::Trial if self.column == Column::JointFrozen => &[
                ("trial", Start::Process(Place::trial)),
                ("tune", Start::Process(Place::tune)),
                ("hold", Start::Process(Place::hold)),
                ("scale", Start::Process(Place::scale)),
            ],
            Row::Trial => &[
                ("trial", Start::Process(Place::trial)),
                ("tune", Start::Process(Place::tune)),
                ("grip", Start::Process(Place::grip)),
                ("hold", Start::Process(Place::hold)),
                ("scale", Start::Process(Place::scale)),
            ],
            Row::Stdio => &[
                ("stdio_move", Start::Process(Place::stdio_move)),
                ("stdio_follow", Start::Process(Place::stdio_follow)),
            ],
            Row::Follow => &[
                ("follow_udp", Start::Process(Place::follow_udp)),
                ("follow_tcp", Start::Process(Place::follow_tcp)),
                ("follow_hold", Start::Process(Place::follow_hold)),
            ],
            Row::FollowDds => &[("follow_dds", Start::Process(Place::follow_dds))],
            Row::Share => &[("share", Start::Process(Place::share))],
            Row::Params => &[("params", Start::Process(Place::params))],
        }
    }

    fn see(&self, start: Start) -> Seen {
        let moves = !matches!(self.row, Row::Params | Row::Calibration);
        let watch = |mover: &mut dyn mover::Mover| {
            let mut witness = Witness::of(mover, self.number, moves);
            match self.row {
                Row::Params => witness.happens_to_writes(self.column),
                _ => witness.happens(self.column),
            }
            witness.seen()
        };
        match start {
            Start::Window(start) => watch(&mut start(Window::live(self.protocol, self.hand()))),
            Start::Process(start) => {
                let number = u8::try_from(self.number % 250).unwrap();
                watch(&mut start(Place::new(self.protocol, number, self.hand())))
            }
        }
    }

    /// Tries it: what is wrong, if something is.
    fn run(&self, whole: bool) -> Result<(), String> {
        let Cell::Tried(verdict, words) = cell_on(self.row, self.column, self.protocol) else {
            return Ok(());
        };
        let all = self.movers();
        // One way suffices in an ordinary run; which one differs from cell to cell.
        let one = &all[self.number % all.len()..][..1];
        let wanted = std::env::var("HANDSCOPE_SEAMS_MOVER").unwrap_or_default();
        let starts = if whole { all } else { one }.iter();
        for (name, start) in starts.filter(|(name, _)| name.contains(&wanted)) {
            told(|| {
                let seen = begun(|| self.see(*start));
                let judged = seen.judge(verdict, words);
                judged.unwrap_or_else(|why| panic!("{name}: {why}\n    {}", seen.summary()));
            })?;
        }
        Ok(())
    }
}

/// So often a hand is brought into motion, where that fails.
const BEGINS: usize = 3;

/// On a machine with other work a sender may fall silent before anything moves, or a link be lost: only what moves is judged.
fn begun(cell: impl Fn() -> Seen) -> Seen {
    let tried = || catch_unwind(AssertUnwindSafe(&cell)).ok();
    (1..BEGINS).find_map(|_| tried()).unwrap_or_else(&cell)
}

/// Tries a cell, again where this computer was busy meanwhile: what is wrong, if something is.
fn told(cell: impl FnMut()) -> Result<(), String> {
    let tried = catch_unwind(AssertUnwindSafe(|| unless_busy(cell)));
    tried.map_err(|panic| {
        let words = panic.downcast_ref::<String>().cloned();
        words.unwrap_or_else(|| "it did not come so far".into())
    })
}

/// How a row is brought to move a hand.
#[derive(Clone, Copy)]
enum Start {
    Window(fn(Window) -> Window),
    Process(fn(Place) -> Process),
}

/// The tries of one event. An ordinary run takes each cell on one wire, so that every row and every event meets every wire.
fn tries(column: Column, wanted: &str) -> Vec<Try> {
    let wires = [
        Protocol::Rs485,
        Protocol::Rtu,
        Protocol::Tcp,
        Protocol::Slcan,
    ];
    let has_can = Path::new("/sys/class/net/vcan0").exists();
    let at_column = Column::ALL.iter().position(|one| *one == column).unwrap();
    let mut all = Vec::new();
    for (at_row, row) in Row::ALL.into_iter().enumerate() {
        let can_be = |protocol| matches!(cell_on(row, column, protocol), Cell::Tried(..));
        let open: Vec<Protocol> = wires.into_iter().filter(|wire| can_be(*wire)).collect();
        let turn = (at_row + at_column) % open.len().max(1);
        let turn = open.get(turn).copied();
        let all_wires = wires.into_iter().chain(has_can.then_some(Protocol::Can));
        for (at_wire, protocol) in all_wires.enumerate() {
            let one = Try {
                row,
                column,
                protocol,
                number: (at_column * Row::ALL.len() + at_row) * 5 + at_wire,
            };
            // Another program is another thing on a port than on a socket.
            let is_other = column == Column::SecondHandscope;
            let is_other = is_other || column == Column::SecondMaster;
            let is_its_turn = turn == Some(protocol) || is_other && protocol == Protocol::Tcp;
            let is_wanted = match wanted {
                "" => is_its_turn,
                "whole" => true,
                part => one.name().contains(part),
            };
            if is_wanted && can_be(protocol) {
                all.push(one);
            }
        }
    }
    all
}

/// One column of the table, as it was found.
fn printed(column: Column, failed: &[(String, String)]) -> String {
    let mut text = String::new();
    for row in Row::ALL {
        let name = format!("{} / {}", row.name(), column.name());
        let failed = failed.iter().find(|(which, _)| which.starts_with(&name));
        let found = match (cell(row, column), failed) {
            (_, Some((which, why))) => format!("WRONG on {which}: {why}"),
            (Cell::Tried(verdict, _), None) => format!("ok: {verdict:?}"),
            (Cell::By(test), None) => format!("tried by {test}"),
            (Cell::CannotBe(why), None) => format!("cannot be: {why}"),
        };
        text.push_str(&format!("{name}: {found}\n"));
    }
    text
}

/// Tries one event on everything that moves a hand.
fn try_all(column: Column) {
    let wanted = std::env::var("HANDSCOPE_SEAMS").unwrap_or_default();
    let (begun, all) = (Instant::now(), tries(column, &wanted));
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let at_a_time = std::env::var("HANDSCOPE_SEAMS_AT_A_TIME");
    let at_a_time = at_a_time.map_or(AT_A_TIME, |number| number.parse().unwrap());
    std::thread::scope(|scope| {
        for _ in 0..at_a_time {
            scope.spawn(|| {
                while let Some(one) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Err(why) = one.run(!wanted.is_empty()) {
                        println!("WRONG: {}: {why}", one.name());
                        failed.lock().unwrap().push((one.name(), why));
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().unwrap();
    println!("{}", printed(column, &failed));
    println!("{} tries in {:?}", all.len(), begun.elapsed());
    assert!(failed.is_empty(), "{} are wrong: {failed:#?}", failed.len());
}

/// One test an event, named as the event is in `handscope help safety`.
macro_rules! events {
    ($($test:ident $column:ident,)+) => {
        $(
            #[test]
            fn $test() {
                try_all(Column::$column);
            }
        )+

        /// The test of each event.
        const EVENTS: &[(&str, Column)] = &[$((stringify!($test), Column::$column),)+];
    };
}

events! {
    the_program_is_ended Signal,
    the_program_is_killed Killed,
    there_is_an_internal_error Panic,
    the_window_is_frozen Frozen,
    the_display_is_lost DisplayLost,
    the_computer_sleeps Asleep,
    the_link_is_lost LinkLost,
    the_adapter_is_unplugged Replugged,
    the_hand_is_power_cycled PowerCycled,
    feedback_freezes FeedbackFrozen,
    replies_are_late_or_wrong OddReplies,
    the_hand_disobeys Disobeys,
    another_controller_writes SecondMaster,
    another_handscope_moves_it SecondHandscope,
    a_joint_has_a_fault FaultOrHeat,
    the_output_is_closed ReaderGone,
    the_output_is_not_read OutputUnread,
    the_holder_is_killed HolderKilled,
    the_holder_is_frozen HolderFrozen,
    the_gateway_refuses GatewayRefuses,
    a_stop_meets_a_lost_link StopThenLost,
    replies_are_slow RepliesSlow,
    the_hand_rests_short RestsShort,
    the_computer_is_busy Busy,
    no_descriptor_is_left NoDescriptors,
    one_joint_reads_the_same JointFrozen,
    a_stop_is_irregular OddStop,
    control_is_given_again GrantedAgain,
}

#[test]
fn the_window_is_closed() {
    for (number, (start, protocol)) in [
        (Window::slider as fn(Window) -> Window, Protocol::Rs485),
        (Window::pose, Protocol::Rtu),
        (Window::sequence, Protocol::Tcp),
        (Window::series, Protocol::Slcan),
        (Window::led, Protocol::Can),
    ]
    .into_iter()
    .enumerate()
    {
        let mut window = start(Window::live(protocol, HandKind::Usual));
        let mut witness = Witness::of(&mut window, number, true);
        witness.closes();
        let seen = witness.seen();
        let judged = seen.judge(Verdict::Held(300), "");
        judged.unwrap_or_else(|why| panic!("{number}: {why} {}", seen.summary()));
    }
}

/// What moves a hand, on a wire, the temperature that a drive then reads, and what is said of it.
type HotCell = (&'static str, Start, Protocol, u8, &'static str);

/// One rule for whatever moves the hand.
const HOT: &[HotCell] = &[
    (
        "trial",
        Start::Process(Place::trial),
        Protocol::Tcp,
        75,
        "75 °C",
    ),
    (
        "grip",
        Start::Process(Place::grip),
        Protocol::Rtu,
        101,
        "101 °C",
    ),
    (
        "follow",
        Start::Process(Place::follow_udp),
        Protocol::Tcp,
        75,
        "75 °C",
    ),
    (
        "follow",
        Start::Process(Place::follow_tcp),
        Protocol::Rs485,
        255,
        "255 °C",
    ),
    (
        "mirror",
        Start::Process(Place::led),
        Protocol::Tcp,
        130,
        "130 °C",
    ),
    (
        "share",
        Start::Process(Place::share),
        Protocol::Tcp,
        75,
        "75 °C",
    ),
    (
        "share",
        Start::Process(Place::share),
        Protocol::Rtu,
        101,
        "101 °C",
    ),
    (
        "stdio",
        Start::Process(Place::stdio_move),
        Protocol::Rs485,
        75,
        "75 °C",
    ),
    (
        "stdio",
        Start::Process(Place::stdio_move),
        Protocol::Tcp,
        255,
        "heat_unknown",
    ),
    (
        "slider",
        Start::Window(Window::slider),
        Protocol::Rtu,
        75,
        "Hot",
    ),
    (
        "pose",
        Start::Window(Window::pose),
        Protocol::Rs485,
        255,
        "HeatUnknown",
    ),
    (
        "led",
        Start::Window(Window::led),
        Protocol::Rtu,
        101,
        "HeatUnknown",
    ),
    (
        "series",
        Start::Window(Window::series),
        Protocol::Tcp,
        130,
        "",
    ),
    (
        "exhibition",
        Start::Window(Window::exhibition),
        Protocol::Tcp,
        255,
        "",
    ),
];

#[test]
fn a_drive_is_hot() {
    let next = AtomicUsize::new(0);
    let wrong = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..AT_A_TIME {
            scope.spawn(|| {
                while let Some(cell) = HOT.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Err(why) = is_held_hot(cell) {
                        wrong.lock().unwrap().push(why);
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().unwrap();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn is_held_hot((name, start, protocol, celsius, words): &HotCell) -> Result<(), String> {
    let watch = |mover: &mut dyn mover::Mover| {
        let mut witness = Witness::of(mover, 0, true);
        witness.grows_hot(*celsius);
        witness.seen()
    };
    let tried = || match start {
        Start::Window(start) => watch(&mut start(Window::live(*protocol, HandKind::Usual))),
        Start::Process(start) => {
            let place = Place::new(*protocol, 200 + celsius % 50, HandKind::Usual);
            watch(&mut start(place))
        }
    };
    let held = told(|| {
        let seen = begun(tried);
        let judged = seen.judge(Verdict::Held(3000), words);
        judged.unwrap_or_else(|why| panic!("{why} {}", seen.summary()));
    });
    held.map_err(|why| format!("{name} at {celsius}: {why}"))
}

#[test]
fn a_drive_that_is_hot_before_anything_moves_is_named_as_the_cause() {
    let place = Place::new(Protocol::Tcp, 251, HandKind::Usual).reads_temperature(80);
    let mut process: Process = place.trial();
    let begun = Instant::now();
    while !mover::Mover::has_ended(&mut process) {
        assert!(begun.elapsed() < Duration::from_secs(30));
        std::thread::sleep(Duration::from_millis(20));
    }
    let said = mover::Mover::said(&mut process);
    assert!(said.contains("a drive is too hot"), "{said}");
    assert!(!said.contains("person"), "{said}");
}

/// All tests, as text.
fn sources(folder: &Path) -> String {
    let mut text = String::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            text.push_str(&sources(&path));
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            text.push_str(&std::fs::read_to_string(path).unwrap());
        }
    }
    text
}

/// A link measures its time by clocks that nobody sets, and so does whatever tells it where the hand shall go.
#[test]
fn the_clock_is_set() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for folder in [
        "hand", "link", "inputs", "trials", "checkup", "poses", "exhibit",
    ] {
        let text = sources(&source.join(folder));
        for clock in ["SystemTime", "Utc::now", "Local::now", "CLOCK_REALTIME"] {
            assert!(!text.contains(clock), "{folder} asks {clock}");
        }
    }
    // A backup is as old as its file.
    let tasks = sources(&source.join("tasks"));
    let save = std::fs::read_to_string(source.join("tasks/save.rs")).unwrap();
    assert!(!tasks.replace(&save, "").contains("SystemTime"));
}

#[test]
fn every_cell_is_tried_or_says_why_it_cannot_be() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let all = sources(&root.join("tests/it")) + &sources(&root.join("src"));
    let mut tried = 0;
    for row in Row::ALL {
        for column in Column::ALL {
            match cell(row, column) {
                Cell::Tried(..) => tried += 1,
                Cell::By(test) => {
                    let there = all.contains(&format!("fn {test}("));
                    assert!(there, "{row:?} {column:?}: there is no test {test}");
                }
                Cell::CannotBe(why) => assert!(why.len() > 10, "{row:?} {column:?}"),
            }
        }
    }
    let events = Column::ALL.map(|column| EVENTS.iter().filter(|(_, one)| *one == column).count());
    assert_eq!(events, [1; Column::ALL.len()], "one test an event");
    println!(
        "{tried} of {} cells are tried here",
        Row::ALL.len() * Column::ALL.len()
    );
}

#[test]
fn each_row_of_the_table_of_the_manual_is_a_test_by_that_name() {
    let page = handscope::manual::topic("safety").unwrap().text;
    let rows = page.lines().filter_map(|line| line.strip_prefix("| "));
    let rows = rows.filter_map(|line| Some(line.split_once('|')?.0.trim()));
    let mut told: Vec<String> = rows.skip(1).map(|event| event.replace(' ', "_")).collect();
    let mut tests: Vec<&str> = EVENTS.iter().map(|(test, _)| *test).collect();
    tests.extend(["the_window_is_closed", "a_drive_is_hot", "the_clock_is_set"]);
    told.sort();
    tests.sort_unstable();
    assert_eq!(told, tests);
}
