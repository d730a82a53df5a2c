//! Claims about a series of trials behind a window that is not drawn: no frame comes, and every reading counts.
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may"
)]

use handscope::app::action::Action;
use handscope::app::program::{App, Env};
use handscope::app::settings::Settings;
use handscope::app::trial::{Abort, Limits};
use handscope::app::tuner::{Draft, Ended, TrialWish};
use handscope::app::{NoChoice, SimDial};
use handscope::hand::{Angle, Dof, Force, PerDof, Speed};
use handscope::link::Clock;
use handscope::shell::Cockpit;
use handscope::shell::pulse::{Pulse, Shared, hold};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::time::sleep;

/// A program in front of a hand with a hard block in it. It is drawn until [`Hidden::start`], and then no more.
struct Hidden {
    cockpit: Shared,
    clock: Clock,
}

impl Hidden {
    async fn new(pulse: &Pulse) -> Self {
        let clock = Clock::start();
        let env = Env {
            runtime: tokio::runtime::Handle::current(),
            clock,
            dial: Arc::new(SimDial::new(clock)),
            wake: pulse.wake(|| {}),
            files: Arc::new(NoChoice),
            settings_path: None,
        };
        let mut app = App::new(env, Settings::default());
        app.open(Some("sim:?scenario=rigid".parse().unwrap()), clock.now());
        let cockpit = Arc::new(Mutex::new(Cockpit::new(app)));
        tokio::spawn(pulse.follow(&cockpit, clock));
        let hidden = Self { cockpit, clock };
        hidden.draw(Duration::from_secs(1)).await;
        hidden
    }

    async fn draw(&self, time: Duration) {
        let step = Duration::from_millis(20);
        for _ in 0..time.as_millis() / step.as_millis() {
            sleep(step).await;
            hold(&self.cockpit).logic(self.clock.now());
        }
    }

    /// Begins a series, armed by a person; from then on nothing is drawn.
    async fn start(&self, draft: Draft) {
        let act = |action| hold(&self.cockpit).app().act(action, self.clock.now());
        act(Action::Trial(TrialWish::Draft(Box::new(draft))));
        act(Action::Arm);
        self.draw(Duration::from_millis(400)).await;
        act(Action::Trial(TrialWish::Start));
        assert!(self.runs());
    }

    fn runs(&self) -> bool {
        hold(&self.cockpit).state().tuner.is_running()
    }
}

fn draft(speed: i16, ceiling_g: i16) -> Draft {
    Draft {
        start: PerDof::from_fn(|dof| (dof == Dof::Index).then_some(Angle::nearest(620))),
        close: PerDof::splat(Angle::nearest(300)),
        speeds: vec![Speed::nearest(speed)],
        forces: vec![Force::nearest(500)],
        repeats: 2,
        rest: Duration::ZERO,
        limits: Limits {
            ceiling_g,
            ..Limits::default()
        },
        ..Draft::default()
    }
}

#[tokio::test(start_paused = true)]
async fn a_series_runs_to_its_end_though_no_frame_comes() {
    let hidden = Hidden::new(&Pulse::new()).await;
    hidden.start(draft(100, 4000)).await;
    sleep(Duration::from_secs(40)).await;
    assert!(!hidden.runs());
    let cockpit = hold(&hidden.cockpit);
    let session = &cockpit.state().tuner.sessions[0];
    assert_eq!((session.trials.len(), &session.ended), (2, &None));
    assert!(!cockpit.state().is_armed());
}

#[tokio::test(start_paused = true)]
async fn the_first_reading_above_the_ceiling_ends_it_though_no_frame_comes() {
    let hidden = Hidden::new(&Pulse::new()).await;
    hidden.start(draft(250, 700)).await;
    sleep(Duration::from_secs(20)).await;
    assert!(!hidden.runs());
    let cockpit = hold(&hidden.cockpit);
    let session = &cockpit.state().tuner.sessions[0];
    let Some(Ended::Here(Abort::Ceiling { grams, .. })) = session.ended else {
        panic!("{:?}", session.ended);
    };
    let trial = session.trials[0].whole.clone().unwrap();
    let rest = trial.metrics.joints[0].rest_force_g.unwrap();
    let forces = trial.recording.rows().iter();
    let forces = forces.filter_map(|row| Some(f64::from(row.force?[Dof::Index]) - rest));
    let above = forces.filter(|force| *force >= 700.0).count();
    assert_eq!(above, 1, "nothing is read after it, {grams} g");
}

#[tokio::test(start_paused = true)]
async fn where_no_series_runs_all_waits_for_the_frame() {
    let hidden = Hidden::new(&Pulse::new()).await;
    let seen = || hold(&hidden.cockpit).state().now;
    let before = seen();
    sleep(Duration::from_secs(5)).await;
    assert_eq!(before, seen());
}
