//! Settings, SAVE and reset over every wire, in virtual time, against a hand and a line that fail in every way: what is said
//! of a write is true of the hand.

use crate::setup::line::{Dialled, IP, Line, Trouble, some_save_answer};
use crate::setup::link::{self, Client, ended, pass};
use crate::setup::soak;
use handscope::hand::{Dof, HandId, PerDof, SerialSpeed, Setting, Speed};
use handscope::hand::{Force, Refusal, Span, register};
use handscope::link::RequestError;
use handscope::params::backups::Backups;
use handscope::params::values::Params;
use handscope::record::{
    ArmRefusal, Calibrated, Doubt, LinkState, NotSent, Record, Reset, SaveDoubt, Saved, Verdict,
    Written,
};
use handscope::sim::{DefaultsWrite, FlashWrite, Personality, SaveAnswer};
use std::sync::Arc;
use tokio::time::{Duration, Instant, sleep, timeout};

const WIRES: [&str; 4] = ["rs485:x", "rtu:x", "tcp:x", "can:x"];
const SPEEDS: u16 = register::DEFAULT_SPEED_SET.address;
const SAVE: u16 = register::SAVE.address;

fn line_to(personality: Personality, address: u16, trouble: Trouble) -> Arc<Line> {
    Arc::new(Line::new(personality, address, trouble))
}

/// A live link to the hand at the end of a line.
async fn open(line: &Arc<Line>, wire: &str) -> Client {
    let mut link = link::connect(wire, Arc::new(Dialled(Arc::clone(line))));
    live(&mut link).await;
    link
}

async fn live(link: &mut Client) {
    let soon = Duration::from_secs(5);
    link::until(link, soon, |status| status.state == LinkState::Monitoring).await;
    pass(link, Duration::from_millis(300)).await;
}

async fn set(link: &mut Client, setting: Setting) -> Written {
    ended(link.set_kept(setting)).await.unwrap()
}

async fn save(link: &mut Client) -> Saved {
    ended(link.save()).await.unwrap()
}

fn speeds(speed: i16) -> Setting {
    Setting::DefaultSpeeds(PerDof::splat(Some(Speed::nearest(speed))))
}

fn shorts(value: i16) -> Vec<u8> {
    value.to_le_bytes().repeat(6)
}

#[tokio::test(start_paused = true)]
async fn whatever_becomes_of_the_answer_the_verdict_is_what_the_hand_holds() {
    for wire in WIRES {
        let late = Trouble::Late(Duration::from_millis(130));
        for trouble in [Trouble::None, Trouble::LoseAnswer, late] {
            let line = line_to(Personality::default(), SPEEDS, trouble);
            let mut link = open(&line, wire).await;
            let written = set(&mut link, speeds(700)).await;
            let expected = Written {
                span: register::DEFAULT_SPEED_SET.span(),
                verdict: Verdict::Applied,
                holds: Some(shorts(700)),
            };
            assert_eq!(written, expected, "{wire} {trouble:?}");
            assert_eq!(
                line.wakes_up_with(SPEEDS),
                1000,
                "nothing is saved by itself"
            );
        }
    }
}

#[tokio::test(start_paused = true)]
async fn what_a_hand_drops_clamps_or_refuses_is_told_with_what_it_holds() {
    for wire in WIRES {
        for (defaults, holds) in [
            (DefaultsWrite::Drop, 1000),
            (DefaultsWrite::Clamp, 500),
            (DefaultsWrite::Exception, 1000),
        ] {
            let personality = Personality {
                defaults,
                ..Personality::default()
            };
            let line = line_to(personality, 0, Trouble::None);
            let mut link = open(&line, wire).await;
            let written = set(&mut link, speeds(700)).await;
            assert_eq!(written.holds, Some(shorts(holds)), "{wire} {defaults:?}");
            let has_no = wire.starts_with("rtu") || wire.starts_with("tcp");
            match written.verdict {
                Verdict::Refused { reason } => {
                    assert!(has_no && defaults == DefaultsWrite::Exception);
                    assert!(matches!(reason, Refusal::Exception(_)), "{reason}");
                }
                Verdict::Differs => assert!(!has_no || defaults != DefaultsWrite::Exception),
                other => panic!("{wire} {defaults:?} {other:?}"),
            }
            assert_eq!(link.status().state, LinkState::Monitoring);
        }
    }
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_falls_silent_or_a_wire_that_breaks_leaves_a_setting_unverified() {
    for wire in WIRES {
        let late = Trouble::Late(Duration::from_millis(900));
        for trouble in [Trouble::Mute, Trouble::Cut, late] {
            let line = line_to(Personality::default(), SPEEDS, trouble);
            let mut link = open(&line, wire).await;
            let written = set(&mut link, speeds(700)).await;
            let unknown = matches!(
                written.verdict,
                Verdict::Unverified {
                    why: Doubt::LinkLost | Doubt::NotReadBack
                }
            );
            assert!(unknown && written.holds.is_none(), "{wire} {written:?}");
            // Once it is there again, what it holds can be asked for, and nothing was sent twice.
            live(&mut link).await;
            assert_eq!(line.writes_to(SPEEDS), 1, "{wire} {trouble:?}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn only_the_joints_that_are_given_are_written() {
    for wire in WIRES {
        let line = line_to(Personality::default(), 0, Trouble::None);
        let mut link = open(&line, wire).await;
        let mut forces = PerDof::splat(None);
        forces[Dof::Ring] = Some(Force::GENTLE);
        forces[Dof::ThumbRotate] = Some(Force::RATED);
        let written = set(&mut link, Setting::DefaultForces(forces)).await;
        let held: Vec<u8> = [1000i16, 500, 1000, 1000, 1000, 2000]
            .map(i16::to_le_bytes)
            .concat();
        assert_eq!(written.verdict, Verdict::Applied, "{wire}");
        assert_eq!(written.holds, Some(held), "{wire}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_save_is_confirmed_by_its_frame_or_by_reading_back_and_the_hand_wakes_up_so() {
    for wire in WIRES {
        let line = line_to(Personality::default(), 0, Trouble::None);
        let mut link = open(&line, wire).await;
        set(&mut link, speeds(700)).await;
        let began = Instant::now();
        let saved = save(&mut link).await;
        let is_rs485 = wire.starts_with("rs485");
        let expected = if is_rs485 {
            Saved::Confirmed
        } else {
            Saved::ReadBack
        };
        assert_eq!(saved, expected, "{wire}");
        let took = began.elapsed();
        assert!((Duration::from_secs(1)..Duration::from_secs(2)).contains(&took));
        assert_eq!(link.status().state, LinkState::Monitoring, "no silence");
        assert_eq!(line.writes_to(SAVE), 1);
        assert_eq!(line.wakes_up_with(SPEEDS), 700);
    }
}

/// Why the hand cannot be armed.
async fn refused_arming(link: &mut Client) -> ArmRefusal {
    link.arm(link::gentle());
    let refused = timeout(Duration::from_millis(90), async {
        loop {
            if let Record::ArmRefused { reason, .. } = link.records.next().await.unwrap() {
                return reason;
            }
        }
    });
    refused.await.expect("it is said at once")
}

#[tokio::test(start_paused = true)]
async fn the_line_is_left_to_a_hand_that_saves() {
    let line = line_to(Personality::default(), 0, Trouble::None);
    let mut link = open(&line, "rs485:x").await;
    let before = link.stats().state_reads;
    drop(link.begin(|link| async move { link.save().await }));
    pass(&mut link, Duration::from_millis(900)).await;
    let during = link.stats().state_reads - before;
    assert!(during <= 4, "{during} reads while the hand saves");
    assert_eq!(
        refused_arming(&mut link).await,
        ArmRefusal::HandBusy,
        "it is not the pose"
    );
    pass(&mut link, Duration::from_millis(900)).await;
    assert!(
        link.stats().state_reads > before + 20,
        "and reading goes on"
    );
}

#[tokio::test(start_paused = true)]
async fn every_answer_to_a_save_has_its_own_verdict_and_the_next_waits() {
    for (save_frame, expected) in [
        (SaveAnswer::Command11, Saved::Confirmed),
        (SaveAnswer::Twice, Saved::Confirmed),
        (SaveAnswer::Failed, Saved::Failed { code: 255 }),
        (
            SaveAnswer::Never,
            Saved::Unknown {
                why: SaveDoubt::NoResult,
            },
        ),
        (
            SaveAnswer::Late,
            Saved::Unknown {
                why: SaveDoubt::NoResult,
            },
        ),
    ] {
        let personality = Personality {
            save_frame,
            ..Personality::default()
        };
        let line = line_to(personality, 0, Trouble::None);
        let mut link = open(&line, "rs485:x").await;
        set(&mut link, speeds(700)).await;
        let began = Instant::now();
        assert_eq!(save(&mut link).await, expected, "{save_frame:?}");
        assert!(began.elapsed() < Duration::from_millis(3300));
        let again = save(&mut link).await;
        let too_soon = matches!(again, Saved::NotSent(NotSent::TooSoon { .. }));
        assert!(too_soon, "{again:?}");
        // The late frame comes while another write waits for its answer, and is not taken for it.
        for speed in (0..40).map(|n| 600 + n) {
            let verdict = set(&mut link, speeds(speed)).await.verdict;
            assert_eq!(verdict, Verdict::Applied, "{save_frame:?}");
            pass(&mut link, Duration::from_millis(80)).await;
        }
        pass(&mut link, Duration::from_secs(3)).await;
        assert_eq!(line.writes_to(SAVE), 1);
        assert_eq!(save(&mut link).await, expected, "{save_frame:?}");
        assert_eq!(line.writes_to(SAVE), 2);
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_passes_while_the_hand_saves_and_the_result_is_still_told() {
    for wire in WIRES {
        let line = line_to(Personality::default(), 0, Trouble::None);
        let mut link = open(&line, wire).await;
        set(&mut link, speeds(700)).await;
        let saving = link.begin(|link| async move { link.save().await });
        pass(&mut link, Duration::from_millis(500)).await;
        assert_eq!(line.writes_to(1486), 0);
        let pressed = Instant::now();
        link.stop();
        while line.writes_to(1486) == 0 {
            sleep(Duration::from_millis(1)).await;
        }
        assert!(pressed.elapsed() <= Duration::from_millis(10), "{wire}");
        let end = saving.await.unwrap();
        let told = matches!(end, Ok(Saved::Confirmed | Saved::ReadBack));
        assert!(told, "{wire} {end:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn what_is_not_known_of_a_save_is_said() {
    for wire in WIRES {
        for (trouble, flash) in [
            (Trouble::Cut, FlashWrite::AtOnce),
            (Trouble::Mute, FlashWrite::AtOnce),
            (
                Trouble::PowerCut(Duration::from_millis(400)),
                FlashWrite::Slowly,
            ),
        ] {
            let personality = Personality {
                flash,
                ..Personality::default()
            };
            let line = line_to(personality, SAVE, trouble);
            let mut link = open(&line, wire).await;
            set(&mut link, speeds(700)).await;
            let saved = save(&mut link).await;
            assert!(
                matches!(saved, Saved::Unknown { .. }),
                "{wire} {trouble:?} {saved:?}"
            );
            assert_eq!(line.writes_to(SAVE), 1, "nothing is sent twice");
            if flash == FlashWrite::Slowly {
                assert_eq!(line.wakes_up_with(SPEEDS), 1000, "it was not in flash");
            }
        }
        let line = line_to(Personality::default(), SAVE, Trouble::LoseAnswer);
        let mut link = open(&line, wire).await;
        let saved = save(&mut link).await;
        if wire.starts_with("rs485") {
            assert_eq!(saved, Saved::Confirmed, "the result tells all");
        } else {
            let why = SaveDoubt::Unanswered;
            assert_eq!(saved, Saved::Unknown { why }, "{wire}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn nothing_is_set_saved_or_reset_while_armed() {
    let line = line_to(Personality::default(), 0, Trouble::None);
    let mut link = open(&line, "rs485:x").await;
    link.arm(link::gentle());
    while link.status().state != LinkState::Armed {
        sleep(Duration::from_millis(1)).await;
    }
    let armed = NotSent::Armed;
    assert_eq!(
        set(&mut link, speeds(700)).await.verdict,
        Verdict::NotSent(armed)
    );
    assert_eq!(save(&mut link).await, Saved::NotSent(armed));
    let reset = ended(link.reset()).await;
    assert_eq!(reset, Ok(Reset::NotSent(armed)));
    let moved = link.set_unread(Setting::Id(HandId::nearest(7))).await;
    assert_eq!(moved, Err(RequestError::NotNow(armed)));
    assert_eq!(
        line.writes_to(SPEEDS) + line.writes_to(SAVE) + line.writes_to(1000),
        0
    );
}

#[tokio::test(start_paused = true)]
async fn a_reset_returns_to_the_factorys_parameters() {
    for wire in WIRES {
        let line = line_to(Personality::default(), 0, Trouble::None);
        let mut link = open(&line, wire).await;
        set(&mut link, speeds(700)).await;
        let reset = ended(link.reset()).await;
        assert_eq!(reset, Ok(Reset::Acknowledged), "{wire}");
        assert_eq!(line.wakes_up_with(SPEEDS), 1000);
    }
}

#[tokio::test(start_paused = true)]
async fn a_new_id_may_be_acknowledged_by_the_new_or_by_the_old_one() {
    use handscope::sim::{ChangeAck, Effect};
    for change_ack in [ChangeAck::New, ChangeAck::Old] {
        let personality = Personality {
            change_ack,
            id_effect: Effect::AfterSave,
            ..Personality::default()
        };
        let line = line_to(personality, 0, Trouble::None);
        let mut link = open(&line, "rs485:x").await;
        let timeouts = link.stats().timeouts;
        let written = set(&mut link, Setting::Id(HandId::nearest(7))).await;
        assert_eq!(written.verdict, Verdict::Applied);
        assert_eq!(written.holds, Some(vec![7]));
        assert_eq!(link.stats().timeouts, timeouts, "{change_ack:?}");
    }
}

/// What is said in a schedule of faults, as a word for the count.
fn word(written: &Written, saved: Option<&Saved>) -> &'static str {
    match (&written.verdict, saved) {
        (Verdict::NotSent(_), _) => "not sent",
        (Verdict::Refused { .. }, _) => "refused",
        (Verdict::Differs, _) => "differs",
        (Verdict::Unverified { .. }, _) => "unverified",
        (Verdict::Applied, None) => "applied",
        (Verdict::Applied, Some(Saved::Confirmed)) => "confirmed",
        (Verdict::Applied, Some(Saved::ReadBack)) => "read back",
        (Verdict::Applied, Some(Saved::Failed { .. })) => "failed",
        (Verdict::Applied, Some(Saved::Unknown { .. })) => "unknown",
        (Verdict::Applied, Some(_)) => "save not sent",
    }
}

/// A row, what is written to it, and what it held.
struct Row {
    span: Span,
    setting: Setting,
    wanted: Vec<u8>,
    before: Vec<u8>,
}

fn some_row(rng: &mut fastrand::Rng) -> Row {
    match rng.u8(..5) {
        0 => Row {
            span: register::HAND_ID.span(),
            setting: Setting::Id(HandId::nearest(7)),
            wanted: vec![7],
            before: vec![1],
        },
        1 => Row {
            span: register::REDU_RATIO.span(),
            setting: Setting::SerialSpeed(SerialSpeed::Baud19200),
            wanted: vec![2],
            before: vec![0],
        },
        2 => Row {
            span: IP,
            setting: Setting::IpAddress([192, 168, 11, 20].into()),
            wanted: vec![192, 168, 11, 20],
            before: vec![192, 168, 11, 210],
        },
        _ => Row {
            span: register::DEFAULT_SPEED_SET.span(),
            setting: speeds(700),
            wanted: shorts(700),
            before: shorts(1000),
        },
    }
}

fn some_trouble(rng: &mut fastrand::Rng, at_place: bool) -> Trouble {
    let ms = |rng: &mut fastrand::Rng, most| Duration::from_millis(rng.u64(1..most));
    match rng.u8(..if at_place { 9 } else { 7 }) {
        0 | 1 => Trouble::None,
        2 => Trouble::LoseAnswer,
        3 => Trouble::Late(ms(rng, 400)),
        4 => Trouble::Mute,
        5 => Trouble::Cut,
        6 => Trouble::PowerCut(ms(rng, 1200)),
        7 => Trouble::Dropped,
        _ => Trouble::Takes(3),
    }
}

fn some_personality(rng: &mut fastrand::Rng) -> Personality {
    Personality {
        defaults: [
            DefaultsWrite::Take,
            DefaultsWrite::Take,
            DefaultsWrite::Drop,
            DefaultsWrite::Clamp,
            DefaultsWrite::Exception,
        ][rng.usize(..5)],
        flash: [FlashWrite::AtOnce, FlashWrite::Slowly][rng.usize(..2)],
        save_frame: some_save_answer(rng),
        ..Personality::default()
    }
}

/// Writes one group and saves it, while one thing of everything goes wrong; then compares what was said, the file and the hand.
async fn schedule(seed: u64) -> &'static str {
    let mut rng = fastrand::Rng::with_seed(seed);
    let wire = WIRES[rng.usize(..WIRES.len())];
    let row = some_row(&mut rng);
    let strikes_save = rng.bool();
    let is_place = row.span.address != SPEEDS;
    let trouble = some_trouble(&mut rng, is_place && !strikes_save);
    let address = if strikes_save { SAVE } else { row.span.address };
    let personality = some_personality(&mut rng);
    let setting = row.setting;
    let case = format!("seed {seed}: {wire} {setting:?} {trouble:?} at {address} {personality:?}");
    let line = line_to(personality, address, trouble);
    let mut link = open(&line, wire).await;
    let written = set(&mut link, row.setting).await;
    let loses_power = matches!(trouble, Trouble::PowerCut(_));
    if let Some(holds) = written
        .holds
        .clone()
        .filter(|_| strikes_save || !loses_power)
    {
        assert_eq!(holds, line.holds(row.span), "{case}");
        assert_eq!(
            holds == row.wanted,
            written.verdict == Verdict::Applied,
            "{case}"
        );
    }
    assert_eq!(
        written.holds.is_none(),
        matches!(written.verdict, Verdict::Unverified { .. }),
        "{case}: what was not read is not said"
    );
    if written.verdict != Verdict::Applied {
        drop(link);
        line.power_cycle();
        assert_eq!(
            line.holds(row.span),
            row.before,
            "{case}: nothing is saved by itself"
        );
        return word(&written, None);
    }
    // As the program does it: the file says that it is not known before SAVE goes out.
    let folder = tempfile::tempdir().unwrap();
    let backups = Backups::new(folder.path(), &wire.parse().unwrap());
    let mut params = Params::default();
    params.apply(row.span, &row.wanted);
    backups
        .note_attempt(&params, Duration::from_secs(1))
        .unwrap();
    if !link.status().state.is_live() {
        return "save not sent";
    }
    let saved = match link.save().await {
        Ok(saved) => saved,
        Err(RequestError::NotConnected | RequestError::LinkLost) => return "save not sent",
        Err(error) => panic!("{case}: {error:?}"),
    };
    backups.note_result(&saved).unwrap();
    pass(&mut link, Duration::from_secs(2)).await;
    let told = backups.known().unwrap();
    line.power_cycle();
    let in_flash = line.holds(row.span);
    match &saved {
        Saved::Confirmed if !loses_power => assert_eq!(in_flash, row.wanted, "{case}"),
        Saved::Failed { .. } | Saved::Refused { .. } | Saved::NotSent(_) => {
            assert_eq!(in_flash, row.before, "{case} {saved:?}");
        }
        _ => {}
    }
    let is_taken = matches!(saved, Saved::Confirmed | Saved::ReadBack);
    let is_unknown = matches!(saved, Saved::Unknown { .. });
    assert_eq!(told.saved.is_some(), is_taken, "{case} {saved:?}");
    assert_eq!(told.doubtful.is_some(), is_unknown, "{case} {saved:?}");
    if in_flash == row.wanted {
        assert!(is_taken || is_unknown, "{case}: nobody is told {saved:?}");
    }
    word(&written, Some(&saved))
}

#[tokio::test(start_paused = true)]
async fn after_every_fault_what_is_said_the_file_and_the_hand_agree_or_it_is_said_to_be_unknown() {
    let mut seen = std::collections::BTreeMap::new();
    for seed in 0..soak::times_at_least(60, 900) {
        *seen.entry(schedule(seed).await).or_insert(0) += 1;
    }
    // Few schedules come to few ends.
    let least = if soak::is_full() { 5 } else { 0 };
    assert!(seen.len() > 3, "{seen:?}");
    for kind in [
        "refused",
        "differs",
        "unverified",
        "confirmed",
        "read back",
        "failed",
        "unknown",
    ] {
        assert!(
            seen.get(kind).copied().unwrap_or(0) >= least,
            "{kind}: {seen:?}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn a_calibration_is_told_by_its_frame_or_by_quiet_and_nothing_arms_meanwhile() {
    for wire in WIRES {
        let line = line_to(Personality::default(), 0, Trouble::None);
        let mut link = open(&line, wire).await;
        let calibrating = link.begin(|link| async move { link.calibrate().await });
        pass(&mut link, Duration::from_secs(1)).await;
        link.arm(link::gentle());
        pass(&mut link, Duration::from_secs(1)).await;
        assert_ne!(link.status().state, LinkState::Armed, "{wire}");
        assert_eq!(line.writes_to(register::SPEED_SET.address), 0, "{wire}");
        link.stop();
        while line.writes_to(register::ANGLE_SET.address) == 0 {
            sleep(Duration::from_millis(1)).await;
        }
        let end = calibrating.await.unwrap();
        let expected = if wire == "rs485:x" {
            Calibrated::Finished
        } else {
            Calibrated::Quiet
        };
        assert_eq!(end, Ok(expected), "{wire}");
        assert_eq!(
            line.writes_to(register::GESTURE_FORCE_CLB.address),
            1,
            "{wire}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn what_is_not_known_of_a_calibration_is_said() {
    let clb = register::GESTURE_FORCE_CLB.address;
    for wire in WIRES {
        for (trouble, why) in [
            (Trouble::Cut, SaveDoubt::LinkLost),
            (Trouble::Mute, SaveDoubt::Unanswered),
        ] {
            let line = line_to(Personality::default(), clb, trouble);
            let link = open(&line, wire).await;
            let end = ended(link.calibrate()).await;
            let unknown = Calibrated::Unknown { why };
            assert_eq!(end, Ok(unknown), "{wire} {trouble:?}");
        }
        let line = line_to(Personality::default(), 0, Trouble::None);
        let mut link = open(&line, wire).await;
        link.arm(link::gentle());
        pass(&mut link, Duration::from_millis(500)).await;
        let end = ended(link.calibrate()).await;
        let refused = Calibrated::NotSent(NotSent::Armed);
        assert_eq!(end, Ok(refused), "{wire}");
        assert_eq!(line.writes_to(clb), 0);
    }
}
