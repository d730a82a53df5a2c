//! Proves the whole program against the built-in hand, over its wire, in virtual time.

#![allow(clippy::unwrap_used, reason = "a test may")]

use crate::app::action::Action;
use crate::app::connect::SimDial;
use crate::app::history::{Quantity, Series, Trace};
use crate::app::notices::NoticeKind;
use crate::app::program::{App, Env};
use crate::app::save::NoChoice;
use crate::app::settings::{Settings, Theme};
use crate::hand::{Angle, Dof, Force, Speed};
use crate::link::{Clock, Hold, LinkState};
use crate::transport::{Endpoint, TransportError};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

struct Bench {
    app: App,
    clock: Clock,
}

impl Bench {
    fn new(settings_path: Option<PathBuf>, settings: Settings) -> Self {
        let clock = Clock::start();
        let env = Env {
            runtime: tokio::runtime::Handle::current(),
            clock,
            dial: Arc::new(SimDial::new(clock)),
            wake: Arc::new(|| {}),
            files: Arc::new(NoChoice),
            settings_path,
        };
        Self {
            app: App::new(env, settings),
            clock,
        }
    }

    async fn live() -> Self {
        let mut bench = Self::new(None, Settings::default());
        bench.app.open(None, bench.clock.now());
        bench.run(1000).await;
        bench
    }

    async fn run(&mut self, millis: u64) {
        for _ in 0..millis / 10 {
            tokio::time::sleep(Duration::from_millis(10)).await;
            self.app.logic(self.clock.now());
        }
    }

    fn act(&mut self, action: Action) {
        self.app.act(action, self.clock.now());
    }

    fn angle(&self, dof: Dof) -> i16 {
        self.app.state().sample.angle.unwrap().value[dof].raw()
    }
}

#[tokio::test(start_paused = true)]
async fn the_first_start_shows_the_simulated_hand_live_and_writes_nothing() {
    let bench = Bench::live().await;
    let state = bench.app.state();
    assert_eq!(state.link.state, LinkState::Monitoring);
    assert!(state.is_simulated());
    assert_eq!(state.stats.writes, 0);
    assert!(state.stats.state_hz > 50.0, "{:?}", state.stats);
    assert_eq!(state.settings.endpoint, None, "a start is not a choice");
    let mut line = Trace::default();
    state.history.trace(
        Series::Joint(Quantity::Angle, Dof::Index),
        0.0,
        1.0,
        800,
        &mut line,
    );
    assert_eq!(line.segments.len(), 1);
    assert!(line.points().count() > 50);
}

#[tokio::test(start_paused = true)]
async fn an_armed_joint_moves_and_stop_holds_it() {
    let mut bench = Bench::live().await;
    let start = bench.angle(Dof::Index);
    bench.act(Action::Arm);
    bench.run(100).await;
    assert!(bench.app.state().is_armed());
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(700).await;
    let under_way = bench.angle(Dof::Index);
    assert!(
        under_way < start - 50 && under_way > 100,
        "{start} {under_way}"
    );
    bench.act(Action::Stop);
    assert!(!bench.app.state().is_armed());
    bench.run(1500).await;
    let state = bench.app.state();
    assert!(
        matches!(state.link.hold, Hold::Confirmed { .. }),
        "{:?}",
        state.link
    );
    assert!(
        state
            .notices
            .iter()
            .any(|notice| matches!(notice.what, NoticeKind::HoldConfirmed { .. }))
    );
    let rest = bench.angle(Dof::Index);
    bench.run(500).await;
    assert!((bench.angle(Dof::Index) - rest).abs() <= 3);
    assert_eq!(
        bench.app.state().joints[Dof::Index].target,
        Angle::new(bench.angle(Dof::Index)).ok()
    );
}

#[tokio::test(start_paused = true)]
async fn closing_holds_an_armed_hand_first_and_ends_in_time() {
    let mut bench = Bench::live().await;
    bench.act(Action::Arm);
    bench.run(100).await;
    bench.act(Action::Speed(Dof::Index, Speed::MAX));
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(150).await;
    let asked = bench.clock.now();
    assert!(!bench.app.close(asked), "the hand is under way");
    while !bench.app.close(bench.clock.now()) {
        bench.run(10).await;
    }
    assert!(bench.clock.now().since(asked) <= Duration::from_millis(620));
    assert_ne!(bench.app.state().link.hold, Hold::None);
    let mut idle = Bench::live().await;
    let now = idle.clock.now();
    assert!(
        idle.app.close(now),
        "a hand that was only watched is left at once"
    );
    idle.run(100).await;
    assert_eq!(idle.app.state().stats.writes, 0);
}

#[tokio::test(start_paused = true)]
async fn leaving_an_armed_hand_holds_it_first() {
    let mut bench = Bench::live().await;
    bench.act(Action::Arm);
    bench.run(100).await;
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(300).await;
    bench.act(Action::Disconnect);
    assert!(bench.app.state().endpoint.is_some());
    bench.run(700).await;
    assert_eq!(bench.app.state().endpoint, None);
    bench.act(Action::Connect(Endpoint::sim()));
    bench.run(500).await;
    assert_eq!(bench.app.state().link.state, LinkState::Monitoring);
    let rest = bench.angle(Dof::Index);
    assert!(rest > 300, "the same hand, where it was held: {rest}");
    bench.run(500).await;
    assert!((bench.angle(Dof::Index) - rest).abs() <= 3);
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_cannot_be_reached_is_told_in_words() {
    let settings = Settings {
        endpoint: Some("warp:9".into()),
        ..Settings::default()
    };
    let mut bench = Bench::new(None, settings);
    let nowhere = Endpoint::Sim {
        seed: 1,
        scenario: "party".into(),
    };
    bench.app.open(Some(nowhere), bench.clock.now());
    bench.run(200).await;
    let told: Vec<_> = bench
        .app
        .state()
        .notices
        .iter()
        .map(|notice| notice.what.clone())
        .collect();
    let unknown = |what: &NoticeKind| {
        matches!(
            what,
            NoticeKind::NoLink(crate::link::LinkTrouble::Transport(
                TransportError::Io { .. }
            ))
        )
    };
    assert!(told.iter().any(unknown), "{told:?}");
    bench.app.open(None, bench.clock.now());
    bench.run(10).await;
    let text = "warp:9".to_owned();
    assert!(
        bench
            .app
            .state()
            .notices
            .iter()
            .any(|notice| notice.what == NoticeKind::EndpointIgnored { text: text.clone() })
    );
}

#[tokio::test(start_paused = true)]
async fn settings_are_kept_and_setpoints_never() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let mut bench = Bench::new(Some(path.clone()), Settings::default());
    bench.app.open(None, bench.clock.now());
    bench.run(1000).await;
    bench.act(Action::Arm);
    bench.run(100).await;
    bench.act(Action::Target(Dof::Index, Angle::nearest(777)));
    bench.act(Action::Force(Dof::Index, Force::nearest(888)));
    bench.act(Action::Speed(Dof::Index, Speed::nearest(111)));
    bench.act(Action::Lock(Dof::Ring, true));
    bench.act(Action::Theme(Theme::Light));
    bench.run(100).await;
    while !bench.app.close(bench.clock.now()) {
        bench.run(10).await;
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let table: toml::Table = text.parse().unwrap();
    let mut keys: Vec<_> = table.keys().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(
        keys,
        [
            "angle_unit",
            "gesture_names",
            "gesture_route",
            "gesture_store",
            "language",
            "layout",
            "plot_window",
            "plots",
            "theme"
        ]
    );
    assert!(
        !["777", "888", "111"]
            .iter()
            .any(|value| text.contains(value)),
        "{text}"
    );
}

#[tokio::test(start_paused = true)]
async fn the_plan_of_trials_is_kept_and_moves_nothing_when_it_is_read() {
    use crate::app::tuner::{Draft, TrialWish, kept};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("settings.toml");
    let mut bench = Bench::new(Some(path.clone()), Settings::default());
    bench.app.open(None, bench.clock.now());
    bench.run(1000).await;
    let plan = Draft {
        repeats: 7,
        ..Draft::default()
    };
    bench.act(Action::Trial(TrialWish::Draft(Box::new(plan.clone()))));
    while !bench.app.close(bench.clock.now()) {
        bench.run(10).await;
    }
    let settings = crate::app::config::load(&path).settings;
    let mut bench = Bench::new(None, settings.clone());
    bench.app.open(None, bench.clock.now());
    bench.run(1000).await;
    let state = bench.app.state();
    assert_eq!(state.tuner.draft, plan);
    assert!(!state.is_armed() && !state.tuner.is_running());
    let newer = Settings {
        trial_plan: Some(
            "repeats = \"as often as it takes\""
                .parse::<toml::Table>()
                .unwrap()
                .into(),
        ),
        ..settings
    };
    let bench = Bench::new(None, newer.clone());
    let state = bench.app.state();
    assert_eq!(state.tuner.draft, Draft::default());
    let told = |what: &NoticeKind| matches!(what, NoticeKind::PlanIgnored { .. });
    assert!(state.notices.iter().any(|notice| told(&notice.what)));
    assert_eq!(
        state.settings.trial_plan, newer.trial_plan,
        "it stays until another is written"
    );
    assert!(kept::draft(state.settings.trial_plan.as_ref()).is_err());
}
