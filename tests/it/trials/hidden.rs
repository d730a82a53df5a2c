//! Claims about a series of trials behind a window that is not drawn: no frame comes, and every reading counts.

use crate::setup::program::{env, start};
use handscope::app::action::Action;
use handscope::app::program::App;
use handscope::app::settings::Settings;
use handscope::app::trials::{SeriesKind, TrialAction};
use handscope::hand::{Angle, Dof, Force, PerDof, Speed};
use handscope::link::Clock;
use handscope::record::Abort;
use handscope::trials::{EarlyEnd, Limits, TrialGrid, TrialPlan};
use std::time::Duration;
use tokio::time::sleep;

/// A program in front of a hand with a hard block in it. Between [`Hidden::start`] and [`Hidden::look`] no frame comes.
struct Hidden {
    app: App,
    clock: Clock,
}

impl Hidden {
    async fn new() -> Self {
        let env = env();
        let clock = env.clock;
        let app = start(env, Settings::default(), Some("sim:?scenario=rigid"));
        let mut hidden = Self { app, clock };
        hidden.draw(Duration::from_secs(1)).await;
        hidden
    }

    async fn draw(&mut self, time: Duration) {
        let step = Duration::from_millis(20);
        for _ in 0..time.as_millis() / step.as_millis() {
            sleep(step).await;
            self.look();
        }
    }

    fn look(&mut self) {
        self.app.logic(self.clock.now());
    }

    fn act(&mut self, action: Action) {
        self.app.act(action, self.clock.now());
    }

    /// Begins a series, armed by a person; from then on nothing is drawn.
    async fn start(&mut self, plan: TrialPlan) {
        self.act(Action::Trial(TrialAction::Plan(Box::new(plan))));
        self.act(Action::Arm);
        self.draw(Duration::from_millis(400)).await;
        self.act(Action::Trial(TrialAction::Start(SeriesKind::Grid)));
        assert!(self.app.state().hand().running.series().is_some());
    }
}

fn plan(speed: i16, ceiling_g: i16) -> TrialPlan {
    let index = |angle| PerDof::from_fn(|dof| (dof == Dof::Index).then_some(angle));
    TrialPlan {
        start: index(Angle::nearest(620)),
        close: index(Angle::nearest(300)),
        grid: TrialGrid {
            speeds: vec![Speed::nearest(speed)],
            forces: vec![Force::nearest(500)],
            repeats: 2,
            rest: Duration::ZERO,
        },
        limits: Limits {
            ceiling_g,
            ..Limits::default()
        },
        ..TrialPlan::default()
    }
}

#[tokio::test(start_paused = true)]
async fn a_series_runs_to_its_end_though_no_frame_comes() {
    let mut hidden = Hidden::new().await;
    hidden.start(plan(100, 4000)).await;
    sleep(Duration::from_secs(40)).await;
    hidden.look();
    let state = hidden.app.state();
    assert!(state.hand().running.series().is_none());
    let session = &state.trials.sessions[0];
    assert_eq!((session.trials.len(), &session.head.aborted), (2, &None));
    assert!(!state.hand().connection.is_armed());
}

#[tokio::test(start_paused = true)]
async fn the_first_reading_above_the_ceiling_ends_it_though_no_frame_comes() {
    let mut hidden = Hidden::new().await;
    hidden.start(plan(250, 700)).await;
    sleep(Duration::from_secs(20)).await;
    hidden.look();
    let state = hidden.app.state();
    assert!(state.hand().running.series().is_none());
    let session = &state.trials.sessions[0];
    let Some(EarlyEnd::Here(Abort::Ceiling { grams, .. })) = session.head.aborted else {
        panic!("{:?}", session.head.aborted);
    };
    let trial = &session.trials[0];
    let rest = trial.summary.joints[0].rest_force_g.unwrap();
    let forces = trial.recording.rows().iter();
    let forces = forces.filter_map(|row| Some(f64::from(row.force?[Dof::Index]) - rest));
    let above = forces.filter(|force| *force >= 700.0).count();
    assert_eq!(above, 1, "nothing is read after it, {grams} g");
}
