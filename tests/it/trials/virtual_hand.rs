//! Searches for settings on simulated hands without a link, in virtual time: what a search comes to, whether its claim holds in
//! closes to come, and how it compares with the best that there is. Used by the tests and by the bench.

use super::other_hand::OtherHand;
use handscope::hand::impact::RIGID_G_PER_COUNT;
use handscope::hand::{
    Angle, ArmEpoch, Dof, Finger, Force, Group, HandCommand, HandSample, Moment, PerDof, Reply,
    Setpoints, Span, Speed,
};
use handscope::link::LinkStatus;
use handscope::motion::program::{Order, Program, Seen};
use handscope::motion::series::SeriesProgram;
use handscope::record::Abort;
use handscope::record::LinkState;
use handscope::sim::body_params::JointBody;
use handscope::sim::body_params::random::random;
use handscope::sim::body_params::run_on::{MetThreshold, run_on_g};
use handscope::sim::{
    BodyParams, ForceCompared, Object, Obstacle, Personality, Scenario, SimConfig, SimHand,
};
use handscope::trials::search::tolerance::{Assurance, tolerance_factor};
use handscope::trials::search::{Claim, Finding, FoundApproach, SearchGoal, SettingsSearch};
use handscope::trials::{Approach, Trial, TrialGrid, TrialPlan, TrialSeries, TrialSetting, Until};
use std::time::Duration;

const EPOCH: ArmEpoch = ArmEpoch(1);
/// As a line at 115200 baud allows.
const EACH: Duration = Duration::from_millis(10);
/// What is read seldom.
const SELDOM: u64 = 20;
const JOINT: Dof = Dof::Index;
/// A force that stops a drive and that no noise reaches, g.
const STOPS_LEAST_G: i16 = 30;
/// The object's place, units of ANGLE_ACT.
const PLACE: f64 = 550.0;
/// g for each position count: from a soft ball to the published block.
#[allow(dead_code, reason = "the bench uses it")]
pub(crate) const STIFFNESSES: [f64; 5] = [3.0, 7.0, 13.0, 25.0, RIGID_G_PER_COUNT];

/// A hand that answers for its registers in virtual time.
pub(crate) trait RegisterHand {
    fn read(&mut self, span: Span, now: Moment) -> Vec<u8>;
    fn write(&mut self, address: u16, bytes: &[u8], now: Moment);
}

impl RegisterHand for SimHand {
    fn read(&mut self, span: Span, now: Moment) -> Vec<u8> {
        SimHand::read(self, span, now).unwrap()
    }

    fn write(&mut self, address: u16, bytes: &[u8], now: Moment) {
        SimHand::write(self, address, bytes, now).unwrap();
    }
}

impl RegisterHand for OtherHand {
    fn read(&mut self, span: Span, now: Moment) -> Vec<u8> {
        OtherHand::read(self, span, now)
    }

    fn write(&mut self, address: u16, bytes: &[u8], now: Moment) {
        OtherHand::write(self, address, bytes, now);
    }
}

/// A hand and what was read of it.
pub(crate) struct VirtualHand<H = SimHand> {
    pub(crate) hand: H,
    now: Moment,
    sample: HandSample,
    round: u64,
    /// The series let no setpoint pass any more.
    pub(crate) disarmed: bool,
}

impl VirtualHand {
    /// A simulated hand of this body whose drives compare their thresholds with loads.
    pub(crate) fn new(body: BodyParams, seed: u64, object: &Object) -> Self {
        Self::with(ForceCompared::Load, (body, seed), object)
    }

    /// One whose drives compare them with FORCE_ACT as read, as the manual says (2.6.12).
    pub(crate) fn counting(body: BodyParams, seed: u64, object: &Object) -> Self {
        Self::with(ForceCompared::AsRead, (body, seed), object)
    }

    /// One whose drives compare them so.
    pub(crate) fn with(
        force_compared: ForceCompared,
        (body, seed): (BodyParams, u64),
        object: &Object,
    ) -> Self {
        let mut hand = SimHand::new(SimConfig {
            seed,
            scenario: Scenario::Free,
            body,
            personality: Personality {
                force_compared,
                ..Personality::default()
            },
            ..SimConfig::default()
        });
        hand.set_object(object);
        Self::of(hand)
    }
}

impl<H: RegisterHand> VirtualHand<H> {
    pub(crate) fn of(hand: H) -> Self {
        Self {
            hand,
            now: Moment::ZERO.plus(EACH),
            sample: HandSample::default(),
            round: 0,
            disarmed: false,
        }
    }

    /// Runs trials to their end. `meanwhile` may interfere after each reading.
    pub(crate) fn run_trials(
        &mut self,
        series: TrialSeries,
        mut meanwhile: impl FnMut(&mut H, &mut TrialSeries),
    ) -> Run {
        let mut trials = Vec::new();
        let (program, stopped) = self.run(SeriesProgram::new(series), |hand, program| {
            while let Some(trial) = program.series.finished() {
                trials.push(trial);
            }
            meanwhile(hand, &mut program.series);
        });
        let series = program.series;
        Run {
            finding: series.settings_search().and_then(SettingsSearch::finding),
            aborted: series.aborted(),
            stopped,
            trials,
        }
    }

    /// Runs a series to its end, and whether it ended in a stop.
    pub(crate) fn run<P: Program>(
        &mut self,
        mut program: P,
        mut meanwhile: impl FnMut(&mut H, &mut P),
    ) -> (P, bool) {
        let status = LinkStatus {
            state: LinkState::Armed,
            armed: Some(EPOCH),
            ..LinkStatus::default()
        };
        let mut stopped = false;
        self.disarmed = false;
        while program.ended().is_none() {
            self.read(&mut program);
            let seen = Seen {
                status: &status,
                sample: &self.sample,
                stall: None,
                now: self.now,
            };
            match program.tick(&seen) {
                Some(Order::Set(setpoints)) => {
                    assert!(!self.disarmed, "{setpoints:?}");
                    self.set(&setpoints);
                }
                Some(Order::Stop) => stopped = true,
                Some(Order::Disarm) => self.disarmed = true,
                order => assert_eq!(order, None, "the hand is armed once"),
            }
            meanwhile(&mut self.hand, &mut program);
        }
        let is_early = program.ended().is_some_and(|end| end.is_err());
        (program, stopped || is_early)
    }

    fn read(&mut self, program: &mut impl Program) {
        self.now = self.now.plus(EACH);
        self.round += 1;
        let often = [Group::Angle, Group::Force, Group::Current, Group::Status];
        let seldom = [
            Group::Position,
            Group::Faults,
            Group::Temperature,
            Group::SpeedSet,
            Group::ForceSet,
        ];
        let is_seldom = self.round % SELDOM == 1;
        let tip = match self.round % 8 {
            1 => Finger::Little,
            3 => Finger::Ring,
            5 => Finger::Middle,
            7 => Finger::Thumb,
            _ => Finger::Index,
        };
        let tactile = [Group::Tactile(tip)];
        let groups = often
            .into_iter()
            .chain(seldom.into_iter().filter(|_| is_seldom))
            .chain(tactile);
        for group in groups {
            let span = group.span();
            let bytes = self.hand.read(span, self.now);
            let fresh = self.sample.apply(&Reply {
                span,
                bytes: &bytes,
                asked: self.now,
                received: self.now,
            });
            program.read(&self.sample, fresh, self.now);
        }
    }

    fn set(&mut self, setpoints: &Setpoints) {
        let commands = setpoints.commands();
        for write in commands.iter().flat_map(HandCommand::writes) {
            let span = write.span();
            self.hand.write(span.address, write.bytes(), self.now);
        }
    }

    /// How long it has been running, s of virtual time.
    #[allow(dead_code, reason = "the bench uses it")]
    pub(crate) fn now_s(&self) -> f64 {
        self.now.since(Moment::ZERO).as_secs_f64()
    }

    /// Searches.
    pub(crate) fn tune(&mut self, goal: &SearchGoal) -> Run {
        let search = SettingsSearch::new(goal.clone()).unwrap();
        self.run_trials(TrialSeries::search(search, EPOCH, self.now), |_, _| ())
    }

    pub(crate) fn search(&self, goal: &SearchGoal) -> TrialSeries {
        TrialSeries::search(SettingsSearch::new(goal.clone()).unwrap(), EPOCH, self.now)
    }

    /// The same setting so many times more.
    pub(crate) fn repeat(&mut self, claim: &Claim, goal: &SearchGoal, times: usize) -> Vec<Trial> {
        let fast = match claim.approach {
            FoundApproach::OneStage => None,
            FoundApproach::TwoStage { fast_speed, margin } => {
                let at = claim.joints[0].contact_angle.round() as i64 + i64::from(margin);
                Some((Speed::nearest(fast_speed), Angle::nearest(at)))
            }
        };
        self.closes(claim.setting, fast, (goal, times))
    }

    fn closes(
        &mut self,
        setting: TrialSetting,
        fast: Option<(Speed, Angle)>,
        (goal, times): (&SearchGoal, usize),
    ) -> Vec<Trial> {
        let plan = TrialPlan {
            grid: TrialGrid {
                repeats: times,
                rest: Duration::from_millis(300),
                ..TrialGrid::once(setting)
            },
            dwell: Duration::from_millis(700),
            approach: match fast {
                None => Approach::OneStage,
                Some((fast, at)) => Approach::TwoStage {
                    fast,
                    until: Until::Angle(at),
                },
            },
            start: goal.start,
            close: goal.close,
            limits: handscope::trials::Limits {
                ceiling_g: 4000,
                ..goal.limits
            },
            ..TrialPlan::default()
        };
        let series = TrialSeries::start(plan, EPOCH, self.now).unwrap();
        let run = self.run_trials(series, |_, _| ());
        assert_eq!(run.aborted, None);
        run.trials
    }
}

/// A series that is over.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) finding: Option<Finding>,
    pub(crate) aborted: Option<Abort>,
    pub(crate) stopped: bool,
    pub(crate) trials: Vec<Trial>,
}

pub(crate) fn object(stiffness: f64, breaks_at_g: Option<f64>) -> Object {
    Object {
        contacts: PerDof::splat(Some(Obstacle {
            breaks_at_g,
            ..Obstacle::at(PLACE, stiffness)
        })),
        ..Object::none()
    }
}

/// What one search came to, against the truth.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    /// Seed of the body, stiffness, and the claim's words, or why there is none.
    pub(crate) words: String,
    pub(crate) claims: bool,
    /// Closes to come that were above the bound, of so many.
    pub(crate) above: usize,
    pub(crate) checked: usize,
    /// The time of the close, and that of the best, s.
    pub(crate) close_s: f64,
    pub(crate) best_s: f64,
    /// The highest peak of the search, g; and closes in it.
    pub(crate) highest_g: f64,
    pub(crate) trials: usize,
    /// How long it took, s of virtual time.
    pub(crate) took_s: f64,
    /// Each close in words.
    pub(crate) tried: Vec<String>,
}

/// One search on one body and one stiffness.
pub(crate) fn case(seed: u64, stiffness: f64, (goal, checks): (&SearchGoal, usize)) -> Case {
    let body = random(seed);
    let object = object(stiffness, None);
    let mut hand = VirtualHand::counting(body, seed, &object);
    let begun = hand.now;
    let run = hand.tune(goal);
    let took_s = hand.now.since(begun).as_secs_f64();
    let peaks = run.trials.iter().filter_map(peak);
    let highest_g = peaks.fold(0.0, f64::max);
    let mut case = Case {
        words: format!("{seed} {stiffness}: {:?}", run.aborted),
        claims: false,
        above: 0,
        checked: 0,
        close_s: 0.0,
        best_s: f64::INFINITY,
        highest_g,
        trials: run.trials.len(),
        took_s,
        tried: Vec::new(),
    };
    let Some(finding) = run.finding else {
        return case;
    };
    case.tried = finding
        .tried
        .iter()
        .map(|own| {
            format!(
                "{} {:?} {:?} {:?}",
                own.setting, own.approach, own.peak_g, own.close_s
            )
        })
        .collect();
    match finding.result {
        Err(none) => case.words = format!("{seed} {stiffness}: {none}"),
        Ok(claim) => {
            case.words = format!(
                "{seed} {stiffness}: {claim}; {} {:?}",
                claim.setting, claim.approach
            );
            case.claims = true;
            case.close_s = claim.close_s;
            if checks > 0 {
                let more = hand.repeat(&claim, goal, checks);
                case.checked = more.len();
                let bound = claim.peak_bound_g();
                case.above = more
                    .iter()
                    .filter_map(peak)
                    .filter(|own| *own > bound)
                    .count();
            }
            case.best_s = best_s(&mut hand, &body.joints[JOINT], (stiffness, goal));
        }
    }
    case
}

fn peak(trial: &Trial) -> Option<f64> {
    trial.summary.joints[0].peak_force_g
}

/// The quickest close of a fine grid whose bound from so many closes is under the limit and that holds, by the body itself.
fn best_s(hand: &mut VirtualHand, body: &JointBody, (stiffness, goal): (f64, &SearchGoal)) -> f64 {
    let own = stiffness * body.stiffness_factor;
    let hold = f64::from(goal.hold_g);
    let limit = f64::from(goal.limit_g);
    let over = |speed: f64, threshold_g: f64| {
        let met = MetThreshold {
            speed: speed * body.counts_per_speed / (2000.0 / 600.0),
            threshold_g,
            came_fast: false,
        };
        run_on_g(met, body.run_on) * body.latency_ms / 64.0 * own / RIGID_G_PER_COUNT
    };
    let least = |speed: f64| {
        let holds = |threshold: &i16| {
            let threshold = f64::from(*threshold);
            0.92 * threshold + body.kept_overshoot * over(speed, threshold) >= hold
        };
        (STOPS_LEAST_G..2000_i16).find(holds).unwrap()
    };
    let k = tolerance_factor(goal.closes, Assurance::USUAL).unwrap();
    let scatter = k * body.latency_scatter_ms / body.latency_ms;
    let fits = |speed: &i16| {
        let threshold = least((*speed).into());
        let over = over((*speed).into(), threshold.into());
        f64::from(threshold) + over * (1.0 + scatter) + 0.6 * body.force_noise_g <= limit
    };
    let Some(speed) = (3..=1000).take_while(fits).last() else {
        return f64::INFINITY;
    };
    let setting = TrialSetting {
        speed: Speed::nearest(speed),
        // The drive counts what its sensor reads at rest, 2 g less than the body says on average.
        force: Force::nearest(i64::from(least(speed.into())) + (body.force_zero_g - 2.0) as i64),
    };
    let contact = PLACE - body.contact_offset / 2.0;
    let margin = 3.3 * body.contact_scatter / 2.0 + 2.0;
    let halt = Angle::nearest((contact + margin).ceil() as i64);
    let times = [None, Some((Speed::MAX, halt))].map(|fast| {
        let trials = hand.closes(setting, fast, (goal, 4));
        let times = trials
            .iter()
            .filter_map(|trial| trial.summary.joints[0].time_to_stop_s);
        times.sum::<f64>() / 4.0
    });
    times[0].min(times[1])
}
