//! Estimated duration of trials. Pure; a rough number for the user, never a rule.

use crate::hand::{Angle, Speed};
use crate::trials::plan::{Approach, TrialPlan, TrialSetting, Until};
use crate::trials::runner::QUIET;
use std::time::Duration;

/// Dead times, reading back the limits, the stop, and recording after the release.
const BESIDES: Duration = Duration::from_millis(1500);

/// Estimated duration of one trial with the rest after it, if the joints meet nothing: the upper bound.
fn trial(plan: &TrialPlan, setting: TrialSetting) -> Duration {
    let way = longest_way(plan);
    let fast_way = match plan.approach {
        Approach::OneStage => 0.0,
        Approach::TwoStage { until, .. } => way_before(plan, until, way),
    };
    let fast = match plan.approach {
        Approach::OneStage => setting.speed,
        Approach::TwoStage { fast, .. } => fast,
    };
    let closing = seconds(fast_way, fast) + seconds(way - fast_way, setting.speed);
    let back = 2.0 * seconds(way, Speed::GENTLE);
    let moving = Duration::try_from_secs_f64(closing + back).unwrap_or_default();
    QUIET + moving + plan.dwell + BESIDES + plan.grid.rest
}

/// Number of trials in a series, and its estimated duration.
pub fn series(plan: &TrialPlan) -> (usize, Duration) {
    let settings = plan.grid.settings();
    let all: Duration = settings.iter().map(|own| trial(plan, *own)).sum();
    if !plan.measures_contact() {
        return (settings.len(), all);
    }
    let one_stage = TrialPlan {
        approach: Approach::OneStage,
        ..plan.clone()
    };
    let probe = plan.grid.forces.first().map_or(Duration::ZERO, |force| {
        let speed = Speed::SLOWEST_MEASURED;
        let force = *force;
        trial(&one_stage, TrialSetting { speed, force })
    });
    (settings.len() + 1, all + probe)
}

fn longest_way(plan: &TrialPlan) -> f64 {
    let ways = plan.joints().filter_map(|dof| {
        let start = plan.start[dof].unwrap_or(Angle::MAX).get();
        Some(start - plan.close[dof]?.get())
    });
    f64::from(ways.max().unwrap_or(0).max(0))
}

/// The contact is unknown: half of the way is as good a guess as any.
fn way_before(plan: &TrialPlan, until: Until, way: f64) -> f64 {
    let Until::Angle(at) = until else {
        return way / 2.0;
    };
    let starts = plan.joints().filter_map(|dof| plan.start[dof]);
    let start = starts.max().unwrap_or(Angle::MAX);
    f64::from(start.get() - at.get()).clamp(0.0, way)
}

fn seconds(way: f64, speed: Speed) -> f64 {
    way / speed.angle_per_s()
}

#[cfg(test)]
mod tests {
    use crate::hand::{Angle, Force, Speed};
    use crate::trials::estimate::series;
    use crate::trials::plan::{Approach, TrialPlan, Until};

    #[test]
    fn a_grid_takes_as_long_as_its_trials_and_a_fast_approach_less() {
        let mut plan = TrialPlan::default();
        let (count, slow) = series(&plan);
        assert_eq!(count, 1);
        // The full stroke at speed 25 takes 24 s by the manual's formula, 26 s as measured.
        assert!((32.0..42.0).contains(&slow.as_secs_f64()), "{slow:?}");
        let fast_until = |until| Approach::TwoStage {
            fast: Speed::nearest(250),
            until,
        };
        plan.approach = fast_until(Until::Angle(Angle::nearest(500)));
        let (_, fast) = series(&plan);
        assert!(fast < slow);
        plan.approach = fast_until(Until::Measured { margin: 40 });
        plan.grid.forces = vec![Force::nearest(300), Force::nearest(600)];
        plan.grid.speeds.push(Speed::nearest(50));
        plan.grid.repeats = 3;
        let (count, long) = series(&plan);
        assert_eq!(count, 13, "with the one that looks for the contact");
        assert!(long > 6 * fast);
    }
}
