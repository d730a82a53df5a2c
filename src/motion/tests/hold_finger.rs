//! One finger that holds, on a spring: the hand acts 70 ms late, and its force sensor is noisy.

use crate::hand::Moment;
use crate::hand::grip::TightenCause;
use crate::motion::hold_finger::{
    FingerHold, FingerReading, ForceRange, HoldStep, MARGIN, TipForces, USUAL_FRICTION,
};
use std::collections::VecDeque;
use std::time::Duration;

const READING: Duration = Duration::from_millis(10);
const READINGS_PER_TIP: u64 = 3;
const LATENCY: Duration = Duration::from_millis(70);
const NOISE_G: f64 = 5.0;
/// By how much a zero drifts towards less at most.
const DRIFT_G: f64 = 120.0;
const BEFORE_IT_RELAXES: Duration = Duration::from_millis(300);
/// Time constant of an object that gives way.
const GIVES_WAY_S: f64 = 3.0;
const RANGE: ForceRange = ForceRange {
    least_g: 150.0,
    most_g: 600.0,
};

struct Bench {
    hold: FingerHold,
    now: Moment,
    readings: u64,
    chance: fastrand::Rng,
    /// g per unit of angle, and the angle at which the spring is touched.
    stiffness: f64,
    touched: f64,
    angle: f64,
    /// Target and units a second, from this time on.
    orders: VecDeque<(Moment, f64, f64)>,
    /// Reading of the force sensor for a gram.
    reading_per_g: f64,
    /// By how much its zero drifts in a second, g.
    drift_g_s: f64,
    load_g: f64,
    /// Tangential force for each gram with which the finger presses.
    drag: f64,
    /// Share of its force that an object loses in the course of time, and what it has lost.
    gives_way: f64,
    lost_g: f64,
    peak_g: f64,
    is_warm: bool,
    steps: Vec<HoldStep>,
}

impl Bench {
    /// Presses with `force_g` on a spring that the close measured.
    fn pressing(force_g: f64, stiffness: f64) -> Self {
        let angle = 500.0;
        let now = Moment::ZERO.plus(Duration::from_secs(1));
        let mut hold = FingerHold::new(RANGE, NOISE_G, 500, now);
        hold.know_stiffness(stiffness);
        Self {
            hold,
            now,
            readings: 0,
            chance: fastrand::Rng::with_seed(7),
            stiffness,
            touched: angle + force_g / stiffness,
            angle,
            orders: VecDeque::new(),
            reading_per_g: 1.0,
            drift_g_s: 0.0,
            load_g: 0.0,
            drag: 0.0,
            gives_way: 0.0,
            lost_g: 0.0,
            peak_g: 0.0,
            is_warm: false,
            steps: Vec::new(),
        }
    }

    fn force_g(&self) -> f64 {
        (self.spring_g() - self.lost_g).max(0.0)
    }

    fn zero_g(&self) -> f64 {
        (self.drift_g_s * self.now.secs()).max(-DRIFT_G)
    }

    fn spring_g(&self) -> f64 {
        ((self.touched - self.angle) * self.stiffness).max(0.0)
    }

    fn run(&mut self, duration: Duration) {
        let end = self.now.plus(duration);
        while self.now < end {
            self.now = self.now.plus(READING);
            self.readings += 1;
            self.drive();
            let to_lose_g = self.gives_way * self.spring_g() - self.lost_g;
            self.lost_g += to_lose_g * READING.as_secs_f64() / GIVES_WAY_S;
            let force_g = self.force_g();
            self.peak_g = self.peak_g.max(force_g);
            if self.readings.is_multiple_of(READINGS_PER_TIP) {
                self.hold.feel(TipForces {
                    at: self.now,
                    normal_g: force_g,
                    tangential_g: self.load_g + self.drag * force_g,
                    spot_mm: None,
                });
            }
            let noise_g = NOISE_G * (self.chance.f64() - 0.5);
            let step = self.hold.apply(FingerReading {
                at: self.now,
                force_g: force_g * self.reading_per_g + noise_g + self.zero_g(),
                angle: self.hand_angle(),
                is_warm: self.is_warm,
            });
            if let Some(step) = step {
                let speed = f64::from(step.speed.get()) * 3.04 / 2.0;
                let due = self.now.plus(LATENCY);
                self.orders.push_back((due, step.to.get().into(), speed));
                self.steps.push(step);
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "0..=1000")]
    fn hand_angle(&self) -> i16 {
        self.angle.round() as i16
    }

    /// Moves towards the newest target that has arrived.
    fn drive(&mut self) {
        while self.orders.get(1).is_some_and(|next| next.0 <= self.now) {
            self.orders.pop_front();
        }
        if let Some((_, to, speed)) = self.orders.front().filter(|own| own.0 <= self.now) {
            let way = speed * READING.as_secs_f64();
            self.angle += (to - self.angle).clamp(-way, way);
        }
    }

    fn causes(&self) -> Vec<Option<TightenCause>> {
        self.steps.iter().map(|step| step.cause).collect()
    }
}

#[test]
fn a_drive_whose_zero_drifts_towards_less_does_not_press_harder() {
    for drift_g_s in [-10.0, -3.0, -0.5] {
        let mut bench = Bench::pressing(160.0, 12.0);
        bench.drift_g_s = drift_g_s;
        for _ in 0..60 {
            bench.run(Duration::from_secs(2));
            let force_g = bench.force_g();
            assert!(force_g >= RANGE.least_g - NOISE_G, "{drift_g_s}: {force_g}");
        }
        assert!(
            bench.peak_g < 1.6 * RANGE.least_g,
            "{drift_g_s}: {}",
            bench.peak_g
        );
    }
}

#[test]
fn a_quiet_finger_relaxes_to_at_least_and_then_rests() {
    for stiffness in [3.0, 12.0, 40.0] {
        let mut bench = Bench::pressing(400.0, stiffness);
        bench.run(Duration::from_secs(10));
        let force_g = bench.force_g();
        let highest = RANGE.least_g + 1.5 * stiffness + 20.0;
        assert!(
            (RANGE.least_g - 5.0..highest).contains(&force_g),
            "{force_g}"
        );
        let settled = bench.steps.len();
        bench.run(Duration::from_secs(60));
        assert_eq!(bench.steps.len(), settled, "stiffness {stiffness}");
        assert!(bench.causes().iter().all(Option::is_none), "no reversal");
    }
}

#[test]
fn noise_of_the_sensor_moves_nothing() {
    let mut bench = Bench::pressing(152.0, 10.0);
    bench.run(Duration::from_secs(60));
    assert!(bench.steps.is_empty(), "{:?}", bench.steps);
}

#[test]
fn a_force_that_falls_below_at_least_is_corrected_once_it_has_settled() {
    let mut bench = Bench::pressing(135.0, 10.0);
    bench.run(Duration::from_secs(10));
    assert_eq!(bench.causes(), [Some(TightenCause::TooLittle)]);
    assert!(bench.force_g() >= RANGE.least_g, "{}", bench.force_g());
}

#[test]
fn a_hand_that_reads_less_than_the_fingertip_feels_presses_as_hard_as_the_load_needs() {
    for reading_per_g in [0.6, 1.0, 1.5] {
        let mut bench = Bench::pressing(250.0 / reading_per_g, 10.0 / reading_per_g);
        bench.reading_per_g = reading_per_g;
        bench.run(BEFORE_IT_RELAXES);
        bench.load_g = 80.0;
        // It holds at the ratio at which the load meets it, and so that is known.
        let shown = bench.load_g / bench.force_g();
        let most = shown.max(USUAL_FRICTION) * (1.0 - MARGIN);
        bench.run(Duration::from_secs(8));
        let ratio = bench.load_g / bench.force_g();
        assert!((0.2..=most).contains(&ratio), "{reading_per_g}: {ratio}");
    }
}

#[test]
fn a_load_that_rises_is_answered_at_once_and_only_by_pressing_harder() {
    for stiffness in [4.0, 40.0] {
        let mut bench = Bench::pressing(200.0, stiffness);
        bench.run(BEFORE_IT_RELAXES);
        bench.load_g = 180.0;
        bench.run(READING * 4);
        assert_eq!(bench.causes().first(), Some(&Some(TightenCause::Load)));
        bench.run(Duration::from_millis(600));
        assert!(
            bench.causes().iter().all(Option::is_some),
            "{:?}",
            bench.steps
        );
        assert!(bench.force_g() > 450.0, "{}", bench.force_g());
    }
}

/// Reductions of the force in the pauses of a load that comes and goes `times` times, for half of `period` each.
fn reductions(times: u32, period: Duration, is_warm: bool) -> usize {
    let mut bench = Bench::pressing(200.0, 10.0);
    bench.is_warm = is_warm;
    bench.run(Duration::from_secs(1));
    let mut reduced = 0;
    for _ in 0..times {
        bench.load_g = 120.0;
        bench.run(period / 2);
        bench.load_g = 10.0;
        let before = bench.steps.len();
        bench.run(period / 2);
        let steps = bench.steps.iter().skip(before);
        reduced += steps.filter(|step| step.cause.is_none()).count();
    }
    reduced
}

#[test]
fn the_oftener_the_load_comes_the_longer_a_finger_waits_before_it_presses_less() {
    let rare = reductions(4, Duration::from_secs(12), false);
    assert!(rare >= 4, "{rare}");
    let often = reductions(12, Duration::from_millis(1300), false);
    assert!(often <= 4, "{often}");
    let warm = reductions(12, Duration::from_millis(1300), true);
    assert!(warm >= 8, "a warm drive rests: {warm}");
}

#[test]
fn a_reduction_that_was_taken_back_is_tried_again_once_the_load_has_changed() {
    let mut bench = Bench::pressing(400.0, 10.0);
    bench.run(Duration::from_secs(5));
    // The object gives way: the finger presses harder again without a new load.
    bench.touched -= 6.0;
    bench.run(Duration::from_secs(3));
    assert!(
        bench.causes().iter().any(Option::is_some),
        "{:?}",
        bench.steps
    );
    bench.load_g = 100.0;
    bench.run(Duration::from_secs(2));
    bench.load_g = 10.0;
    let pressed_g = bench.force_g();
    bench.run(Duration::from_secs(10));
    assert!(bench.force_g() < 0.7 * pressed_g, "{} g", bench.force_g());
}

#[test]
fn what_a_finger_drags_by_pressing_harder_is_no_load() {
    let mut bench = Bench::pressing(100.0, 10.0);
    bench.drag = 0.25;
    bench.run(Duration::from_secs(10));
    let causes = bench.causes();
    assert!(
        !causes.is_empty() && !causes.contains(&Some(TightenCause::Load)),
        "{causes:?}"
    );
    assert!(bench.peak_g < 1.2 * RANGE.least_g, "{} g", bench.peak_g);
}

#[test]
fn an_object_that_gives_way_slowly_is_not_pressed_beyond_at_most() {
    for (stiffness, gives_way) in [(10.0, 0.6), (25.0, 0.4), (25.0, 0.6)] {
        let mut bench = Bench::pressing(150.0, stiffness);
        bench.gives_way = gives_way;
        for load_g in [60.0, 120.0, 180.0, 240.0] {
            bench.run(Duration::from_secs(2));
            bench.load_g = load_g;
        }
        bench.run(Duration::from_secs(30));
        // How fast it gives way is not known while the first load comes.
        let most_g = 1.1 * RANGE.most_g + stiffness;
        assert!(
            bench.peak_g <= most_g,
            "{stiffness} {gives_way}: {} g",
            bench.peak_g
        );
    }
}
