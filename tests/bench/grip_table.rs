//! Grasps of random bodies and objects in virtual time, and how often the told state of the grip is not the true one. The truth is
//! the simulated object's: loads, what turns and what slides. Used by the bench and, in a small form, by the tests.

use handscope::hand::grip::{Grip, GripEstimator, GripState, GripThresholds};
use handscope::hand::register::{ANGLE_SET, FORCE_SET, SPEED_SET, STATE, TOUCH};
use handscope::hand::{Dof, Finger, Groups, HandSample, Moment, PerDof, PerFinger, Reply, Span};
use handscope::sim::body_params::random;
use handscope::sim::object::{Friction, Loads, PullLoad, RandomPulls, listed};
use handscope::sim::{Object, ObjectLoss, Obstacle, Scenario, SimConfig, SimHand};

/// What happened to what was held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EventKind {
    /// Nothing, or nothing that slides.
    Calm,
    /// The wrist turned.
    WristTurn,
    /// It slid, and was lost.
    Slip,
}

/// Grasps of one body.
const GRASPS: u64 = 20;
/// When the fingers close, when they open, and the end, ms into a grasp.
const CLOSES_MS: u64 = 700;
const OPENS_MS: u64 = 8500;
const ENDS_MS: u64 = 10_500;
/// A state is steady once it lasted so long, ms.
const STEADY_MS: u64 = 400;
/// Loads between these are neither contact nor none, g.
const TOUCHES_G: std::ops::Range<f64> = 5.0..31.0;
/// Loads between these are neither too hard nor not, g.
const TOO_HARD_G: std::ops::Range<f64> = 1750.0..2100.0;
/// Angles between these are neither open nor closed.
const OPEN_FROM: std::ops::Range<f64> = 895.0..905.0;
/// Length of a pull that is meant to pull the object out, ms.
const PULL_OUT_MS: f64 = 2000.0;
const STATES: usize = GripState::ALL.len();

/// What was counted.
#[derive(Debug, Clone, Default)]
pub(crate) struct GripTable {
    /// Readings in steady states of fingers: what was true, and what was told.
    pub(crate) fingers: [[u64; STATES]; STATES],
    /// The same for the grasp.
    pub(crate) grasps: [[u64; STATES]; STATES],
    /// How late each loss of a finger was told, ms; `None` if it was not.
    pub(crate) losses: Vec<Option<u64>>,
    /// Objects that slid and were lost, and those of which slipping was told before.
    pub(crate) slides: u64,
    pub(crate) slides_told: u64,
    /// Grasps with a lasting hold in which nothing slid, and those in which slipping was told all the same.
    pub(crate) calm: u64,
    pub(crate) calm_slips: u64,
    /// Fingers that held while the wrist turned, and those of which slipping was told.
    pub(crate) turns: u64,
    pub(crate) turn_slips: u64,
    pub(crate) count: u64,
}

impl GripTable {
    /// Share of the readings in steady states that tell another state. That nothing is known is no state.
    pub(crate) fn wrong(table: &[[u64; STATES]; STATES]) -> f64 {
        let all: u64 = table.iter().flatten().sum();
        let right: u64 = (0..STATES).map(|at| table[at][at]).sum();
        let unknown = Self::unknown(table) * all as f64;
        ((all - right) as f64 - unknown) / all.max(1) as f64
    }

    /// Share of the readings in steady states that tell that nothing is known.
    pub(crate) fn unknown(table: &[[u64; STATES]; STATES]) -> f64 {
        let all: u64 = table.iter().flatten().sum();
        let rows = (0..STATES).filter(|at| *at != GripState::Unknown as usize);
        let unknown: u64 = rows.map(|at| table[at][GripState::Unknown as usize]).sum();
        unknown as f64 / all.max(1) as f64
    }

    /// One line with all of it.
    pub(crate) fn line(&self) -> String {
        let percent = |share: f64| format!("{:.3} %", 100.0 * share);
        format!(
            "{} grasps; fingers wrong {}, unknown {}; grasps wrong {}, unknown {}; losses {} in time {}; slides {} told {}; calm {} slips {}; turns {} slips {}",
            self.count,
            percent(Self::wrong(&self.fingers)),
            percent(Self::unknown(&self.fingers)),
            percent(Self::wrong(&self.grasps)),
            percent(Self::unknown(&self.grasps)),
            self.losses.len(),
            percent(self.losses_in_time()),
            self.slides,
            self.slides_told,
            self.calm,
            self.calm_slips,
            self.turns,
            self.turn_slips,
        )
    }

    /// Share of the losses that were told within 150 ms.
    pub(crate) fn losses_in_time(&self) -> f64 {
        let in_time = |late: &&Option<u64>| late.is_some_and(|late| late <= 150);
        self.losses.iter().filter(in_time).count() as f64 / self.losses.len().max(1) as f64
    }

    /// A table of confusion as lines of text; rows are what was true.
    pub(crate) fn text(table: &[[u64; STATES]; STATES]) -> String {
        let mut lines = vec![format!("{:>10}", "true\\told")];
        for state in GripState::ALL {
            lines[0] += &format!("{:>10}", state.name());
        }
        for (truth, row) in GripState::ALL.iter().zip(table) {
            let cells: String = row.iter().map(|count| format!("{count:>10}")).collect();
            lines.push(format!("{:>10}{cells}", truth.name()));
        }
        lines.join("\n")
    }
}

/// Grasps of so many bodies, each with a number of random objects.
pub(crate) fn grasps(bodies: std::ops::Range<u64>) -> GripTable {
    let mut table = GripTable::default();
    for seed in bodies {
        let mut chance = fastrand::Rng::with_seed(seed ^ 0x6121);
        let mut hand = SimHand::new(SimConfig {
            seed,
            scenario: Scenario::Free,
            body: random::random(seed),
            ..SimConfig::default()
        });
        let mut reader = Reader::of(&mut chance);
        for at in 0..GRASPS {
            grasp(
                &mut hand,
                &mut reader,
                at * ENDS_MS,
                &mut chance,
                &mut table,
            );
        }
    }
    table
}

/// What reads the hand, and what it makes of it.
struct Reader {
    state_each: u64,
    touch_each: u64,
    sample: HandSample,
    estimator: GripEstimator,
}

impl Reader {
    fn of(chance: &mut fastrand::Rng) -> Self {
        // A network, or a serial line at 115200.
        let (state_each, touch_each) = if chance.bool() { (10, 33) } else { (25, 50) };
        Self {
            state_each,
            touch_each,
            sample: HandSample::default(),
            estimator: GripEstimator::new(GripThresholds::default()),
        }
    }

    fn read(&mut self, hand: &mut SimHand, ms: u64) -> Option<Grip> {
        let mut fresh = Groups::default();
        let mut take = |span: Span| {
            let bytes = hand.read(span, at(ms)).unwrap();
            let reply = Reply {
                span,
                bytes: &bytes,
                asked: at(ms.saturating_sub(3)),
                received: at(ms),
            };
            fresh = self.sample.apply(&reply);
        };
        if ms % self.touch_each == 1 {
            take(TOUCH);
        } else if ms.is_multiple_of(self.state_each) {
            take(STATE);
        } else {
            return None;
        }
        Some(self.estimator.apply(&self.sample, fresh, at(ms)))
    }
}

fn at(ms: u64) -> Moment {
    Moment::from_micros(ms * 1000)
}

/// What is gripped, and how.
struct Plan {
    object: Object,
    targets: PerDof<i16>,
    speed: i16,
    force: i16,
    opens: i16,
}

/// Loads of an object that is held by so much normal force, g, with this friction: some pull it out, some only pull, some take it away.
fn loads(chance: &mut fastrand::Rng, normal_g: f64, friction: f64) -> Loads {
    let mut loads = Loads {
        lift_after_s: Some(1.0),
        ..Loads::NONE
    };
    let event = chance.u8(..10);
    let mut pull = |share: f64, lasts_ms: f64| {
        loads.pulls = listed(&[PullLoad {
            at_s: 1.0 + chance.f64(),
            force_g: share * normal_g,
            direction_deg: 360.0 * chance.f64(),
            rise_ms: 150.0 + 750.0 * chance.f64(),
            lasts_ms,
        }]);
    };
    match event {
        0..=3 => pull(1.6 * friction, PULL_OUT_MS),
        4..=5 => pull(0.03, 300.0),
        6 => loads.taken_away_at_s = Some(2.0),
        7 => {
            loads.random_pulls = Some(RandomPulls {
                every_s: 0.8,
                force_g: [0.0, 0.03 * normal_g],
                rise_ms: [50.0, 500.0],
            })
        }
        _ => {}
    }
    loads
}

impl Plan {
    fn draw(chance: &mut fastrand::Rng) -> Self {
        let angle = f64::from(chance.u16(350..750));
        let stiffness = 40f64.powf(chance.f64()) * 1.0;
        let breaks_at_g = (chance.u8(..6) == 0).then_some(700.0);
        let kind = chance.u8(..6);
        let contacts = PerDof::from_fn(|dof| {
            let misses = kind == 0 || dof == Dof::ThumbRotate || chance.u8(..5) == 0;
            let own = angle + f64::from(chance.i16(-40..40));
            (!misses).then_some(Obstacle {
                breaks_at_g,
                ..Obstacle::at(own, stiffness)
            })
        });
        let bends = chance.i16(0..300);
        let targets = PerDof::from_fn(|dof| match dof {
            Dof::ThumbRotate => 500,
            _ if chance.u8(..8) == 0 => 1000,
            _ => bends,
        });
        let force = match chance.u8(..10) {
            0 => chance.i16(2400..2900),
            _ => chance.i16(80..800),
        };
        let touching = Dof::ALL.into_iter().filter(|dof| {
            contacts[*dof].is_some_and(|contact| f64::from(targets[*dof]) < contact.angle)
        });
        // A relaxed grip keeps nine tenths of the threshold.
        let normal_g = 0.9 * f64::from(force) * touching.map(|_| 1.0).sum::<f64>();
        let sticking = 0.4 + 0.5 * chance.f64();
        Self {
            object: Object {
                mass_g: (normal_g * (0.02 + 0.05 * chance.f64())).max(1.0),
                friction: Friction {
                    sticking,
                    sliding_ratio: 0.7 + 0.25 * chance.f64(),
                    // Some objects shoot out, others creep.
                    drag_per_mm_s: 0.02 * chance.f64(),
                    scatter: 0.05,
                },
                taper_per_mm: 0.04 * chance.f64(),
                loads: loads(chance, normal_g, sticking),
                ..Object::touched_at(contacts)
            },
            targets,
            speed: chance.i16(150..1000),
            force,
            opens: chance.i16(500..1000),
        }
    }
}

impl Plan {
    fn pulls_out(&self) -> bool {
        let mut pulls = self.object.loads.pulls.iter().flatten();
        pulls.any(|pull| pull.lasts_ms >= PULL_OUT_MS)
    }
}

fn write(hand: &mut SimHand, address: u16, values: PerDof<i16>, ms: u64) {
    let bytes = values
        .as_array()
        .iter()
        .flat_map(|value| value.to_le_bytes());
    let bytes: Vec<u8> = bytes.collect();
    hand.write(address, &bytes, at(ms)).unwrap();
}

fn grasp(
    hand: &mut SimHand,
    reader: &mut Reader,
    begins: u64,
    chance: &mut fastrand::Rng,
    table: &mut GripTable,
) {
    let plan = Plan::draw(chance);
    hand.set_object(&plan.object);
    let mut truth = Truth::default();
    let mut seen = Seen::default();
    for ms in begins..begins + ENDS_MS {
        hand.advance_to(at(ms));
        match ms - begins {
            CLOSES_MS => {
                write(hand, SPEED_SET.address, PerDof::splat(plan.speed), ms);
                write(hand, FORCE_SET.address, PerDof::splat(plan.force), ms);
                write(hand, ANGLE_SET.address, plan.targets, ms);
            }
            OPENS_MS => {
                write(hand, SPEED_SET.address, PerDof::splat(plan.opens), ms);
                write(hand, ANGLE_SET.address, PerDof::splat(1000), ms);
            }
            _ => {}
        }
        truth.step(hand, ms, ms - begins >= OPENS_MS);
        if let Some(grip) = reader.read(hand, ms) {
            seen.take(&grip, &truth, ms, table);
        }
    }
    seen.end(&truth, plan.pulls_out(), table);
    table.count += 1;
}

/// What is true of one finger.
#[derive(Debug, Clone, Copy, Default)]
struct FingerTruth {
    /// `None` where neither answer would be wrong.
    state: Option<GripState>,
    since: u64,
    angle: f64,
    moved: u64,
    was_held: bool,
    lost_at: Option<u64>,
}

/// What is true of a hand.
#[derive(Debug, Default)]
pub(crate) struct Truth {
    fingers: PerFinger<FingerTruth>,
    grasp: Option<GripState>,
    since: u64,
    slid: bool,
    dropped: bool,
}

impl Truth {
    fn step(&mut self, hand: &SimHand, ms: u64, opens: bool) {
        let angles = hand.true_angles();
        let loads = hand.true_loads();
        let slides = hand.object_slides();
        // What the opening fingers let go slides and falls, too.
        let held = hand.held();
        let one_slides = held.fingers.iter().any(|(_, finger)| finger.slides);
        self.slid |= one_slides && !opens;
        self.dropped |= held.lost == Some(ObjectLoss::Dropped) && !opens;
        for (finger, truth) in self.fingers.iter_mut() {
            let angle = match finger {
                // Both joints of the thumb move it.
                Finger::Thumb => angles[Dof::ThumbBend] + angles[Dof::ThumbRotate],
                _ => angles[finger.bend()],
            };
            let state = truth.now(
                angle,
                angles[finger.bend()],
                loads[finger],
                ms,
                slides,
                opens,
            );
            truth.set(state, ms);
        }
        self.set_grasp(ms);
    }

    /// This is true of the fingers at this moment.
    pub(crate) fn set(&mut self, fingers: &PerFinger<Option<GripState>>, ms: u64) {
        for (finger, truth) in self.fingers.iter_mut() {
            truth.set(fingers[finger], ms);
        }
        self.set_grasp(ms);
    }

    fn set_grasp(&mut self, ms: u64) {
        let grasp = self.of_grasp();
        if grasp != self.grasp {
            self.grasp = grasp;
            self.since = ms;
        }
    }

    fn of_grasp(&self) -> Option<GripState> {
        use GripState::{Empty, Holding, Lost, Moving, Open, Slipping, TooHard, Touching};
        let states: Option<Vec<GripState>> = self
            .fingers
            .as_array()
            .iter()
            .map(|finger| finger.state)
            .collect();
        let states = states?;
        let holding = states.iter().filter(|state| **state == Holding).count();
        let first = [Slipping, TooHard, Lost, Moving, Holding, Empty, Open]
            .into_iter()
            .find(|state| states.contains(state) && !(*state == Lost && holding > 0));
        match first {
            Some(Holding) if holding == 1 => Some(Touching),
            other => other,
        }
    }
}

impl FingerTruth {
    fn set(&mut self, state: Option<GripState>, ms: u64) {
        if self.state != state {
            self.state = state;
            self.since = ms;
        }
        if state == Some(GripState::Lost) {
            self.lost_at.get_or_insert(ms);
        }
        self.was_held |= state == Some(GripState::Holding);
    }

    #[allow(clippy::too_many_arguments, reason = "one call")]
    fn now(
        &mut self,
        angle: f64,
        bend: f64,
        load: f64,
        ms: u64,
        slides: bool,
        opens: bool,
    ) -> Option<GripState> {
        if (angle - self.angle).abs() > 0.002 {
            self.moved = ms;
        }
        self.angle = angle;
        let moves = ms - self.moved < 2;
        self.was_held &= !opens;
        if TOO_HARD_G.contains(&load) || TOUCHES_G.contains(&load) {
            return None;
        }
        if load > TOUCHES_G.end && slides {
            return Some(GripState::Slipping);
        }
        if load > TOO_HARD_G.end {
            self.was_held |= !moves;
            return Some(GripState::TooHard);
        }
        if load > TOUCHES_G.start {
            // What was just pressed in still creeps.
            if moves {
                return None;
            }
            self.was_held = true;
            return Some(GripState::Holding);
        }
        if self.was_held {
            self.lost_at.get_or_insert(ms);
            return Some(GripState::Lost);
        }
        match bend {
            _ if moves => Some(GripState::Moving),
            bend if OPEN_FROM.contains(&bend) => None,
            bend if bend >= OPEN_FROM.end => Some(GripState::Open),
            _ => Some(GripState::Empty),
        }
    }
}

/// What was told in one grasp.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    lost_at: PerFinger<Option<u64>>,
    fingers_slipped: PerFinger<Option<u64>>,
    slipped_at: Option<u64>,
}

impl Seen {
    /// Takes what is told.
    pub(crate) fn take(&mut self, grip: &Grip, truth: &Truth, ms: u64, table: &mut GripTable) {
        self.take_fingers(grip, &truth.fingers, ms, table);
        if grip.grasp.state == GripState::Slipping {
            self.slipped_at.get_or_insert(ms);
        }
        count(
            &mut table.grasps,
            truth.grasp,
            grip.grasp.state,
            ms - truth.since,
        );
    }

    fn take_fingers(
        &mut self,
        grip: &Grip,
        truth: &PerFinger<FingerTruth>,
        ms: u64,
        table: &mut GripTable,
    ) {
        for (finger, estimate) in grip.fingers.iter() {
            let known = &truth[finger];
            if estimate.state == GripState::Slipping {
                self.fingers_slipped[finger].get_or_insert(ms);
            }
            let is_lost = estimate.state == GripState::Lost && known.lost_at.is_some();
            if is_lost {
                self.lost_at[finger].get_or_insert(ms);
            }
            count(
                &mut table.fingers,
                known.state,
                estimate.state,
                ms - known.since,
            );
        }
    }

    /// Counts each finger of a grasp in which this happened.
    pub(crate) fn end_of_fingers(&self, truth: &Truth, event: EventKind, table: &mut GripTable) {
        for (finger, known) in truth.fingers.iter().filter(|(_, known)| known.was_held) {
            let slipped = self.fingers_slipped[finger];
            let slips = u64::from(slipped.is_some());
            if let Some(lost_at) = known.lost_at {
                let told = self.lost_at[finger].map(|told| told - lost_at);
                table.losses.push(told);
            }
            match event {
                EventKind::Calm => {
                    table.calm += 1;
                    table.calm_slips += slips;
                }
                EventKind::WristTurn => {
                    table.turns += 1;
                    table.turn_slips += slips;
                }
                EventKind::Slip => {
                    let before = slipped
                        .zip(known.lost_at)
                        .is_some_and(|(told, lost)| told < lost);
                    table.slides += 1;
                    table.slides_told += u64::from(before);
                }
            }
        }
    }

    fn end(&self, truth: &Truth, pulls_out: bool, table: &mut GripTable) {
        for (finger, known) in truth.fingers.iter() {
            if let Some(lost_at) = known.lost_at {
                let told = self.lost_at[finger].map(|told| told - lost_at);
                table.losses.push(told);
            }
        }
        let lost_at = truth
            .fingers
            .iter()
            .filter_map(|(_, finger)| finger.lost_at);
        match lost_at.min() {
            Some(lost_at) if truth.slid && truth.dropped => {
                table.slides += 1;
                table.slides_told += u64::from(self.slipped_at.is_some_and(|told| told < lost_at));
            }
            // A grip that withstood such a pull is not calm.
            _ if !truth.slid && !pulls_out => {
                table.calm += 1;
                table.calm_slips += u64::from(self.slipped_at.is_some());
            }
            _ => {}
        }
    }
}

/// Slipping has a beginning and an end, and is counted by itself.
fn count(
    table: &mut [[u64; STATES]; STATES],
    truth: Option<GripState>,
    told: GripState,
    lasted_ms: u64,
) {
    let steady = truth.filter(|state| *state != GripState::Slipping && lasted_ms >= STEADY_MS);
    if let Some(truth) = steady {
        table[truth as usize][told as usize] += 1;
    }
}
