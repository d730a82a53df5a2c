//! Complete searches against the hand physics of another author (a spring with relaxation, a drive that stops some time after its
//! threshold, read every ten milliseconds), without a wire: counts the claims that future closes refute.

use crate::hand::Dof;
use crate::trials::plan::{Approach, Until};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::Claim;
use crate::trials::search::goal::SearchGoal;
use crate::trials::search::settings_search::{NextClose, SettingsSearch};

const LIMIT_G: i16 = 500;
/// Future closes that check a claim.
const CHECKS: u32 = 1500;
/// Mean and deviation of the contact, units of ANGLE_ACT, and stiffness, g per unit.
const CONTACT: f64 = 500.0;
const CONTACT_SD: f64 = 3.75;
const STIFFNESS: f64 = 25.0;
/// Share of the force that relaxes, and its time constant, ms.
const RELAXES: f64 = 0.08;
const RELAXES_MS: f64 = 150.0;
/// Counts per millisecond for each unit of speed.
const RATE: f64 = 0.00152;
const NOISE_G: f64 = 3.0;
const DEAD_S: f64 = 0.064;

/// Delays of stops, ms.
#[derive(Debug, Clone, Copy)]
struct Stops {
    mean: f64,
    sd: f64,
    /// Share of stops that are later, and the mean of their exponential extra delay.
    tail: (f64, f64),
}

const fn stops(sd: f64, tail: (f64, f64)) -> Stops {
    Stops {
        mean: 60.0,
        sd,
        tail,
    }
}

struct LateHand {
    stops: Stops,
    rng: fastrand::Rng,
}

struct Close {
    /// Highest force, g, and highest reading.
    peak_g: f64,
    read_g: f64,
    steady_g: f64,
    contact: f64,
    /// From the contact to the stop, s.
    stop_s: f64,
}

impl LateHand {
    fn normal(&mut self, mean: f64, sd: f64) -> f64 {
        let u = self.rng.f64().max(f64::MIN_POSITIVE);
        let v = self.rng.f64();
        mean + sd * (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    fn stop_ms(&mut self) -> f64 {
        let Stops { mean, sd, tail } = self.stops;
        let late = if self.rng.f64() < tail.0 {
            -tail.1 * self.rng.f64().max(f64::MIN_POSITIVE).ln()
        } else {
            0.0
        };
        self.normal(mean, sd).max(0.0) + late
    }

    fn close(&mut self, speed: f64, threshold_g: f64) -> Close {
        let contact = self.normal(CONTACT, CONTACT_SD);
        let mut pressed = -self.rng.f64() * speed * RATE;
        let (mut relaxed, mut t, mut stop_at) = (0.0, 0.0, None);
        let mut next_reading = 10.0 * self.rng.f64();
        let mut noise = self.normal(0.0, NOISE_G);
        let (mut peak_g, mut read_g, mut steady_g): (f64, f64, f64) = (0.0, 0.0, 0.0);
        while stop_at.is_none_or(|at: f64| t < at + 600.0) {
            t += 1.0;
            if t % 5.0 == 0.0 {
                noise = self.normal(0.0, NOISE_G);
            }
            if stop_at.is_none_or(|at| t < at) {
                pressed += speed * RATE;
            }
            let elastic = STIFFNESS * pressed.max(0.0);
            relaxed += (RELAXES * elastic - relaxed) / RELAXES_MS;
            let force = (elastic - relaxed).max(0.0);
            if stop_at.is_none() && force + noise >= threshold_g && force > 2.0 {
                stop_at = Some(t + self.stop_ms());
            }
            peak_g = peak_g.max(force);
            if t >= next_reading {
                next_reading += 8.0 + 4.0 * self.rng.f64();
                steady_g = (force + noise).round();
                read_g = read_g.max(steady_g);
            }
        }
        Close {
            peak_g,
            read_g,
            steady_g,
            contact,
            stop_s: stop_at.unwrap_or(t) / 1000.0,
        }
    }

    fn facts(&mut self, next: &NextClose) -> (Close, CloseFacts) {
        let speed = f64::from(next.setting.speed.get());
        let close = self.close(speed, f64::from(next.setting.force.get()));
        let counts_per_s = 1000.0 * RATE;
        let (fast_s, way) = match next.plan.approach {
            Approach::OneStage => (0.0, 1000.0 - close.contact),
            Approach::TwoStage { fast, until } => {
                let Until::Measured { margin } = until else {
                    unreachable!("a search measures the contact");
                };
                let halt = f64::from(next.contact[Dof::Index].unwrap().get() + margin);
                let fast_s = (1000.0 - halt) / (f64::from(fast.get()) * counts_per_s);
                (fast_s + 0.1, (halt - close.contact).max(0.0))
            }
        };
        let to_contact_s = DEAD_S + fast_s + way / (speed * counts_per_s);
        let facts = CloseFacts {
            dof: Dof::Index,
            is_dead: false,
            stopped_by_force: true,
            touched_before: false,
            contact: Some(close.contact.round()),
            to_contact_s: Some(to_contact_s),
            dead_time_s: Some(DEAD_S),
            close_s: Some(to_contact_s + close.stop_s),
            slow_s: None,
            peak_g: Some(close.read_g),
            missed_g: 0.0,
            is_uncertain: false,
            offset_g: 0.0,
            is_clipped: false,
            steady_g: Some(close.steady_g),
            noise_g: NOISE_G,
            stiffness: Some(STIFFNESS),
            stiffness_at_least: None,
            slips: Some(0),
            reading_s: Some(0.01),
            longest_gap_s: Some(0.012),
        };
        (close, facts)
    }

    /// Runs a search; `None` if the force ceiling ended it.
    fn search(&mut self, goal: &SearchGoal) -> Option<(Claim, Vec<f64>)> {
        let ceiling = goal.plan(goal.first_setting()).limits.ceiling_g;
        let mut search = SettingsSearch::new(goal.clone()).unwrap();
        let mut peaks = Vec::new();
        while let Some(next) = search.next() {
            let (close, facts) = self.facts(&next);
            if close.read_g >= f64::from(ceiling) {
                return None;
            }
            peaks.push(close.peak_g);
            search.learn_facts(peaks.len(), &[facts]);
        }
        let claim = search.finding().unwrap().result.unwrap();
        Some((claim, peaks))
    }

    /// Share of future closes above a claim's bound.
    fn above(&mut self, claim: &Claim) -> f64 {
        let (speed, force) = (claim.setting.speed.get(), claim.setting.force.get());
        let bound = claim.peak_bound_g();
        let above = (0..CHECKS)
            .filter(|_| self.close(speed.into(), force.into()).peak_g > bound)
            .count();
        f64::from(u32::try_from(above).unwrap()) / f64::from(CHECKS)
    }
}

/// Counts of claims: all, false ones, and those that assume a normal distribution.
#[derive(Debug, Default)]
struct Count {
    searches: usize,
    claims: usize,
    falses: usize,
    normal: usize,
}

fn count(stops: Stops, goal: &SearchGoal, most: u64) -> Count {
    let searches = crate::soak::times_at_least(2, most);
    let mut count = Count::default();
    for seed in 0..searches {
        let rng = fastrand::Rng::with_seed(seed);
        let mut hand = LateHand { stops, rng };
        count.searches += 1;
        let Some((claim, _)) = hand.search(goal) else {
            continue;
        };
        count.claims += 1;
        count.normal += usize::from(!claim.distribution_free);
        count.falses += usize::from(hand.above(&claim) > 0.05);
    }
    println!("{stops:?}: {count:?}");
    count
}

#[test]
fn of_claims_on_hands_whose_stops_are_sometimes_late_few_are_false() {
    let goal = SearchGoal::new(&[Dof::Index], LIMIT_G);
    let (mut searches, mut claims, mut falses) = (0, 0, 0);
    for tail in [
        (0.0, 0.0),
        (0.05, 40.0),
        (0.1, 40.0),
        (0.15, 40.0),
        (0.1, 80.0),
    ] {
        let count = count(stops(2.0, tail), &goal, 5);
        assert_eq!(count.normal, 0, "{tail:?}");
        searches += count.searches;
        claims += count.claims;
        falses += count.falses;
    }
    for sd in [6.0, 12.0] {
        let count = count(stops(sd, (0.0, 0.0)), &goal, 3);
        searches += count.searches;
        claims += count.claims;
        falses += count.falses;
    }
    assert!(2 * claims > searches, "{claims} of {searches}");
    assert!(20 * falses <= claims + 20, "{falses} of {claims}");
}

/// Shares of late stops, and seeds.
const SEEDS: [(f64, &[u64]); 2] = [(0.1, &[18]), (0.15, &[1, 5, 8, 15])];

/// Hands on which a search without a reserve for later stops had a close over 1.15 of the limit.
#[test]
fn a_stop_later_than_all_before_seldom_goes_far_over_the_limit() {
    let goal = SearchGoal::new(&[Dof::Index], LIMIT_G);
    let far = 1.15 * f64::from(LIMIT_G);
    for (tail, seeds) in SEEDS {
        for seed in seeds {
            let rng = fastrand::Rng::with_seed(*seed);
            let stops = stops(2.0, (tail, 40.0));
            let mut hand = LateHand { stops, rng };
            let (claim, peaks) = hand.search(&goal).unwrap();
            let highest = peaks.iter().copied().fold(0.0, f64::max);
            assert!(highest < far, "{tail} {seed}: {highest} of {claim}");
        }
    }
}

#[test]
fn a_claim_of_few_closes_says_what_it_takes_for_granted_unless_a_stop_was_late() {
    let quick = SearchGoal {
        closes: 10,
        ..SearchGoal::new(&[Dof::Index], LIMIT_G)
    };
    let mut hand = LateHand {
        stops: stops(2.0, (0.0, 0.0)),
        rng: fastrand::Rng::with_seed(1),
    };
    let (claim, peaks) = hand.search(&quick).unwrap();
    assert!(!claim.distribution_free && claim.closes == 10);
    assert!(peaks.len() < 30, "{}", peaks.len());
    let words = claim.to_string();
    assert!(
        words.contains("95 % sure if the peaks vary normally"),
        "{words}"
    );
    // One stop in five is late, which ten closes show.
    let late = (0..5).find_map(|seed| {
        let mut hand = LateHand {
            stops: stops(2.0, (0.2, 20.0)),
            rng: fastrand::Rng::with_seed(seed),
        };
        hand.search(&quick)
    });
    let (claim, peaks) = late.unwrap();
    assert!(claim.distribution_free && claim.closes >= 59, "{claim}");
    assert!(peaks.len() >= 59);
    let words = claim.to_string();
    assert!(
        words.contains("95 % sure however the peaks vary"),
        "{words}"
    );
}
