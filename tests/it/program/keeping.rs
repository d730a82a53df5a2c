//! What is kept from one start to the next, what is told of a start, and what another window may not do.

use crate::program::Bench;
use crate::setup::program::{env, start};
use handscope::app::action::Action;
use handscope::app::env::Env;
use handscope::app::files::settings_file::load;
use handscope::app::hand::list::HandsAction;
use handscope::app::notices::NoticeKind;
use handscope::app::params::state::ParamAction;
use handscope::app::program::App;
use handscope::app::settings::{Settings, Theme};
use handscope::app::state::State;
use handscope::app::trials::TrialAction;
use handscope::hand::{Angle, Dof, Force, Speed};
use handscope::history::Trace;
use handscope::link::{Clock, LinkTrouble};
use handscope::record::LinkState;
use handscope::transport::TransportError;
use handscope::trials::plan::TrialPlan;
use handscope::trials::plan_settings;
use std::path::{Path, PathBuf};
use tokio::time::{Duration, sleep};

async fn run(app: &mut App, clock: Clock, millis: u64) {
    for _ in 0..millis / 10 {
        sleep(Duration::from_millis(10)).await;
        app.logic(clock.now());
    }
}

async fn close(app: &mut App, clock: Clock) {
    while !app.close(clock.now()) {
        run(app, clock, 10).await;
    }
}

/// A program in front of the built-in hand, with settings in this file.
async fn begun(path: Option<PathBuf>, settings: Settings) -> (App, Clock) {
    let env = Env {
        settings_path: path,
        ..env()
    };
    let clock = env.clock;
    let mut app = start(env, settings, None);
    run(&mut app, clock, 1000).await;
    (app, clock)
}

fn told(app: &App) -> Vec<NoticeKind> {
    let notices = app.state().notices.iter();
    notices.map(|notice| notice.what.clone()).collect()
}

#[tokio::test(start_paused = true)]
async fn the_first_start_shows_the_simulated_hand_live_and_writes_nothing() {
    use handscope::hand::Quantity;
    use handscope::history::Series;
    let (app, _) = begun(None, Settings::default()).await;
    let (state, hand) = (app.state(), app.state().hand());
    assert_eq!(hand.connection.status.state, LinkState::Monitoring);
    assert!(hand.connection.is_simulated());
    assert_eq!(hand.connection.stats.writes, 0);
    assert!(
        hand.connection.stats.state_hz > 50.0,
        "{:?}",
        hand.connection.stats
    );
    assert_eq!(state.settings.endpoint, None, "a start is not a choice");
    let mut line = Trace::default();
    let series = Series::Joint(Quantity::Angle, Dof::Index);
    hand.measured
        .history
        .trace(series, 0.0, 1.0, 800, &mut line);
    assert_eq!(line.segments.len(), 1);
    assert!(line.points().count() > 50);
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_cannot_be_reached_is_told_in_words() {
    let settings = Settings {
        endpoint: Some("warp:9".into()),
        ..Settings::default()
    };
    let env = env();
    let clock = env.clock;
    let mut app = start(env, settings, Some("rs485:/nowhere/hand"));
    run(&mut app, clock, 200).await;
    let unknown = |what: &NoticeKind| {
        let gone = TransportError::Missing {
            place: "/nowhere/hand".into(),
        };
        *what == NoticeKind::NoLink(LinkTrouble::Transport(gone))
    };
    assert!(told(&app).iter().any(unknown), "{:?}", told(&app));
    app.open(None, clock.now());
    run(&mut app, clock, 10).await;
    let text = "warp:9".into();
    assert!(told(&app).contains(&NoticeKind::EndpointIgnored { text }));
}

#[tokio::test(start_paused = true)]
async fn settings_are_kept_and_setpoints_never() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let (mut app, clock) = begun(Some(path.clone()), Settings::default()).await;
    app.act(Action::Arm, clock.now());
    run(&mut app, clock, 100).await;
    for action in [
        Action::Target(Dof::Index, Angle::nearest(777)),
        Action::Force(Some(Dof::Index), Force::nearest(888)),
        Action::Speed(Some(Dof::Index), Speed::nearest(111)),
        Action::Lock(Dof::Ring, true),
        Action::Theme(Theme::Light),
    ] {
        app.act(action, clock.now());
    }
    run(&mut app, clock, 100).await;
    close(&mut app, clock).await;
    let text = std::fs::read_to_string(&path).unwrap();
    let table: toml::Table = text.parse().unwrap();
    let mut keys: Vec<_> = table.keys().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(
        keys,
        [
            "angle_unit",
            "disarm_idle",
            "first_client_moves",
            "follow",
            "gesture_names",
            "gesture_route",
            "hidden_poses",
            "hold_to_run",
            "language",
            "layout",
            "plot_window",
            "plots",
            "read_first",
            "recent",
            "sessions",
            "side",
            "tall_plots",
            "tares",
            "theme",
            "zoom"
        ]
    );
    let setpoints = ["777", "888", "111"];
    assert!(
        !setpoints.iter().any(|value| text.contains(value)),
        "{text}"
    );
}

#[tokio::test(start_paused = true)]
async fn the_plan_of_trials_is_kept_and_moves_nothing_when_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let (mut app, clock) = begun(Some(path.clone()), Settings::default()).await;
    let mut plan = TrialPlan::default();
    plan.grid.repeats = 7;
    let write = Action::Trial(TrialAction::Plan(Box::new(plan.clone())));
    app.act(write, clock.now());
    close(&mut app, clock).await;
    let settings = load(&path).settings;
    let (app, _) = begun(None, settings.clone()).await;
    let state = app.state();
    assert_eq!(state.trials.plan, plan);
    assert!(!state.hand().connection.is_armed() && state.hand().running.series().is_none());
    assert_eq!(state.hand().connection.stats.writes, 0);
    let newer: toml::Table = "repeats = \"as often as it takes\"".parse().unwrap();
    let newer = Settings {
        trial_plan: Some(newer.into()),
        ..settings
    };
    let app = App::new(env(), newer.clone());
    let state = app.state();
    assert_eq!(state.trials.plan, TrialPlan::default());
    let ignored = |what: &NoticeKind| matches!(what, NoticeKind::PlanIgnored { .. });
    assert!(told(&app).iter().any(ignored));
    assert_eq!(
        state.settings.trial_plan, newer.trial_plan,
        "it stays until another is written"
    );
    assert!(plan_settings::from_settings(state.settings.trial_plan.as_ref()).is_err());
}

/// Turns a path into a folder, so that no file can be written there.
fn block(path: &Path) {
    std::fs::create_dir_all(path.with_extension("new.toml")).unwrap();
}

#[tokio::test(start_paused = true)]
async fn settings_are_written_when_they_change_and_a_failure_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let (mut app, clock) = begun(Some(path.clone()), Settings::default()).await;
    assert!(!path.exists(), "nothing changed");
    app.act(Action::Theme(Theme::Light), clock.now());
    run(&mut app, clock, 2000).await;
    assert_eq!(load(&path).settings.theme, Theme::Light);
    block(&path);
    app.act(Action::Theme(Theme::Dark), clock.now());
    run(&mut app, clock, 2000).await;
    let failed = |what: &NoticeKind| matches!(what, NoticeKind::NotSaved { .. });
    assert!(told(&app).iter().any(failed), "{:?}", told(&app));
    assert_eq!(
        load(&path).settings.theme,
        Theme::Light,
        "the old one is whole"
    );
    let begun = clock.now();
    close(&mut app, clock).await;
    assert!(
        clock.now().since(begun) < Duration::from_secs(1),
        "what cannot be written holds nobody up"
    );
}

#[tokio::test(start_paused = true)]
async fn another_hand_at_the_same_address_is_said_and_a_simulated_one_is_not_kept() {
    use crate::setup::hand::{numbered, shared};
    use crate::setup::link::to_hand;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let book = handscope::link::quirks::book::QuirkBook::path(&path);
    let (_app, _) = begun(Some(path.clone()), Settings::default()).await;
    assert!(!book.exists());
    let differs = |what: &NoticeKind| matches!(what, NoticeKind::HandDiffers { .. });
    let not_kept = |what: &NoticeKind| matches!(what, NoticeKind::NotSaved { .. });
    for (id, expected) in [(1, false), (1, false), (2, true), (2, false)] {
        // Over Modbus TCP any id answers.
        let env = Env {
            dial: to_hand(shared(numbered(id))),
            settings_path: Some(path.clone()),
            ..env()
        };
        let clock = env.clock;
        let mut app = start(env, Settings::default(), Some("tcp:127.0.0.1"));
        run(&mut app, clock, 3000).await;
        let kept = std::fs::read_to_string(&book).unwrap();
        assert!(kept.contains(&format!("hand_id = {id}")), "{kept}");
        let said = told(&app).into_iter().filter(differs).count();
        assert_eq!(said, usize::from(expected), "once is enough");
    }
    std::fs::write(&book, "version = ").unwrap();
    let env = Env {
        dial: to_hand(shared(numbered(3))),
        settings_path: Some(path.clone()),
        ..env()
    };
    let clock = env.clock;
    let mut app = start(env, Settings::default(), Some("tcp:127.0.0.1"));
    run(&mut app, clock, 3000).await;
    assert!(told(&app).iter().any(not_kept), "{:?}", told(&app));
}

#[tokio::test(start_paused = true)]
async fn staged_rows_of_one_hand_are_not_those_of_another() {
    use handscope::params::rows::{ParamId, Value};
    let mut bench = Bench::live().await;
    let id = ParamId::DefaultSpeed(Dof::Index);
    bench.act(Action::Stage(id, Some(Value::Number(50))));
    bench.act(Action::Connect("rs485:y".parse().unwrap()));
    bench.run(1000).await;
    assert!(bench.hand().params.all_staged().is_empty());
}

#[tokio::test(start_paused = true)]
async fn a_dialog_that_was_cancelled_changes_nothing_and_the_next_one_opens() {
    let folder = tempfile::tempdir().unwrap();
    let typed = folder.path().join("poses.toml");
    let (mut app, clock) = begun(None, Settings::default()).await;
    let before = app.state().settings.clone();
    let opens = |path: Option<PathBuf>| {
        [
            Action::ImportPoses(path.clone()),
            Action::Param(ParamAction::Open(path.clone())),
            Action::Trial(TrialAction::Open(path)),
        ]
    };
    for open in opens(None) {
        app.act(open, clock.now());
        run(&mut app, clock, 100).await;
    }
    assert_eq!(told(&app), [NoticeKind::NoFileChosen]);
    assert_eq!(app.state().settings, before);
    assert!(app.state().trials.sessions.is_empty());
    // What is typed then is looked for: nothing waits for the dialog that is gone.
    let [typed, ..] = opens(Some(typed));
    app.act(typed, clock.now());
    run(&mut app, clock, 100).await;
    let told = told(&app);
    assert!(
        matches!(told[..], [NoticeKind::FileRefused { .. }, _]),
        "{told:?}"
    );
}

#[tokio::test(start_paused = true)]
async fn a_frame_after_the_end_begins_no_recording() {
    let mut bench = Bench::live().await;
    assert!(bench.hand().recording.is_some());
    while !bench.app.close(bench.clock.now()) {
        bench.run(10).await;
    }
    bench.run(100).await;
    assert!(
        bench.hand().recording.is_none(),
        "it would be a file of nothing"
    );
}

#[tokio::test(start_paused = true)]
async fn a_recording_that_finds_no_disk_says_so_until_it_does() {
    let mut bench = Bench::live().await;
    bench.block_documents();
    let place = bench.folder.path().join("documents");
    let stalls = |state: &State| {
        let mut notices = state.notices.iter();
        notices.any(|notice| matches!(notice.what, NoticeKind::RecordingStalled { .. }))
    };
    // The disk is written to by a thread, which lives in real time.
    let mut wait = 0;
    while !stalls(bench.state()) {
        std::thread::sleep(Duration::from_millis(10));
        bench.run(50).await;
        wait += 1;
        assert!(wait < 3000, "not told");
    }
    std::fs::remove_file(place).unwrap();
    while stalls(bench.state()) {
        std::thread::sleep(Duration::from_millis(10));
        bench.run(50).await;
        wait += 1;
        assert!(wait < 6000, "still told");
    }
}

#[tokio::test(start_paused = true)]
async fn the_hands_that_a_user_opened_are_open_at_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let endpoints = ["sim:?seed=1", "sim:?seed=2", "sim:?seed=3"].map(|text| text.parse().unwrap());
    let open = |app: &App| -> Vec<String> {
        let hands = app.state().hands.iter();
        let endpoints = hands.filter_map(|hand| hand.connection.endpoint.as_ref());
        endpoints.map(ToString::to_string).collect()
    };
    let (mut app, clock) = begun(Some(path.clone()), Settings::default()).await;
    for (n, endpoint) in endpoints.into_iter().enumerate() {
        if n > 0 {
            app.act(Action::Hands(HandsAction::Add), clock.now());
        }
        app.act(Action::Connect(endpoint), clock.now());
        run(&mut app, clock, 300).await;
    }
    let before = open(&app);
    assert_eq!(before.len(), 3, "{before:?}");
    close(&mut app, clock).await;

    let kept = load(&path).settings;
    let (mut app, clock) = begun(Some(path.clone()), kept.clone()).await;
    run(&mut app, clock, 300).await;
    // In their order, with the last one shown; each is only read.
    assert_eq!(open(&app), before);
    let shown = app.state().hand().connection.endpoint.as_ref();
    assert_eq!(shown.map(ToString::to_string).as_ref(), before.last());
    for hand in app.state().hands.iter() {
        let connection = &hand.connection;
        assert_eq!(connection.status.state, LinkState::Monitoring);
        assert_eq!(connection.stats.writes, 0);
    }

    // One that the user leaves is not opened again.
    app.act(Action::Disconnect, clock.now());
    run(&mut app, clock, 300).await;
    close(&mut app, clock).await;
    let kept = load(&path).settings;
    assert_eq!(kept.open, before[..2]);

    // An address on the command line opens that hand alone, and changes nothing of the next start.
    let env = env();
    let clock = env.clock;
    let mut app = start(env, kept.clone(), Some("sim:?seed=9"));
    run(&mut app, clock, 300).await;
    assert_eq!(open(&app).len(), 1);
    assert_eq!(app.state().settings.open, kept.open);
}
