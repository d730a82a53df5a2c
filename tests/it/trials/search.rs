//! The search for the fastest close under a limit, on bodies that it does not know, and what keeps it from one.

use crate::setup::hand;
use crate::setup::link;
use crate::setup::soak;
use crate::trials::other_hand::{OtherBody, OtherHand, best_close_s, drawn};
use crate::trials::virtual_hand::{Run, VirtualHand, case, object};
use futures::future::ready;
use futures::{StreamExt as _, stream};
use handscope::hand::{Angle, Dof, Fault, HandSample, PerDof};
use handscope::link::{LinkConfig, Owner, Stop};
use handscope::motion::drive::{Armed, EndReport};
use handscope::motion::program::Progress;
use handscope::motion::series::{RATES, SeriesEvent, SeriesProgress, arm_limits, trials};
use handscope::record::Abort;
use handscope::record::{LinkState, Record};
use handscope::sim::body_params::random::random;
use handscope::sim::{BodyParams, Object, Obstacle, Scenario, SimConfig, SimHand};
use handscope::trials::TrialSeries;
use handscope::trials::search::{
    Finding, NoClaim, SearchGoal, SearchStage, SettingsSearch, ThresholdReference,
};
use std::time::Duration;
use tokio::sync::oneshot;

const LIMIT: i16 = 500;

fn goal() -> SearchGoal {
    SearchGoal::new(&[Dof::Index], LIMIT)
}

/// With few closes, where what happens in a search does not hang on their number.
fn quick() -> SearchGoal {
    SearchGoal {
        closes: 10,
        ..goal()
    }
}

#[test]
fn a_claim_holds_and_its_close_is_about_as_quick_as_the_best() {
    let (mut above, mut checked) = (0, 0);
    // The second one is missed: on a stiff object the search stays with two stages where one fast stage would do.
    for (seed, stiffness, slower) in [
        (0, 13.0, 1.15),
        (5, 40.0, 1.5),
        (11, 3.0, 1.15),
        (14, 25.0, 1.15),
    ] {
        let case = case(seed, stiffness, (&goal(), 20));
        assert!(case.claims, "{case:?}");
        assert!(case.close_s < slower * case.best_s, "{case:?}");
        assert!(case.highest_g < 1.1 * f64::from(LIMIT), "{case:?}");
        assert!(case.trials <= 90 && case.took_s < 420.0, "{case:?}");
        above += case.above;
        checked += case.checked;
    }
    assert_eq!(checked, 80);
    assert!(above <= 4, "{above} of {checked}");
}

#[test]
fn a_fragile_object_is_never_broken() {
    for seed in 0..3 {
        let mut hand = VirtualHand::counting(random(seed), seed, &object(20.0, Some(700.0)));
        let run = hand.tune(&goal());
        let highest = highest_g(&run);
        assert!(run.finding.unwrap().result.is_ok());
        assert!(highest < 650.0, "{highest}");
    }
}

/// Whether a search kept an object whole, what its highest true peak was of the limit, and what it came to.
struct OtherSearch {
    broke: bool,
    highest: f64,
    finding: Option<Finding>,
}

fn on_other_hand(body: OtherBody, seed: u64) -> OtherSearch {
    let mut hand = VirtualHand::of(OtherHand::new(body, seed));
    let run = hand.tune(&goal());
    OtherSearch {
        broke: hand.hand.broke(),
        highest: hand.hand.highest_g() / f64::from(LIMIT),
        finding: run.finding,
    }
}

/// Drives that count the offset of their sensor and drives that do not, soft and stiff objects that break just above the limit.
fn other_bodies() -> Vec<OtherBody> {
    let offsets = [-60.0, -20.0, 25.0, 90.0, 146.0, 230.0];
    let bodies = offsets.into_iter().flat_map(|offset| {
        [6.0, 25.0, 50.0].map(|stiffness| OtherBody {
            offset,
            stiffness: (stiffness, 1.0),
            breaks_at_g: 1.15 * f64::from(LIMIT),
            ..OtherBody::default()
        })
    });
    let both = bodies.flat_map(|body| {
        [true, false].map(|counts_offset| OtherBody {
            counts_offset,
            ..body
        })
    });
    both.collect()
}

/// Searches on all bodies of one kind of drive: nothing breaks, no close is more than twice as fast as the fastest before, and the
/// finding says what the drive compares.
fn is_tuned_whatever_its_offset(counts_offset: bool) {
    let right = if counts_offset {
        ThresholdReference::AsRead
    } else {
        ThresholdReference::AboveRest
    };
    let (mut tried, mut claims, mut told) = (0, 0, 0);
    for (seed, body) in (0..).zip(other_bodies()) {
        // Each offset with one stiffness, or with all.
        let (offset, stiffness) = (seed / 6, seed / 2 % 3);
        let is_tried = soak::is_full() || offset % 3 == stiffness;
        if body.counts_offset != counts_offset || !is_tried {
            continue;
        }
        let search = on_other_hand(body, seed);
        tried += 1;
        let (broke, highest) = (search.broke, search.highest);
        assert!(!broke && highest < 1.1, "{seed} {body:?}: {highest}");
        let finding = search.finding.unwrap();
        claims += usize::from(finding.result.is_ok());
        let compared = finding.compared[0].compared;
        let is_wrong = compared.is_some_and(|own| own != right);
        assert!(
            !is_wrong || body.offset.abs() < 30.0,
            "{seed} {body:?}: {compared:?}"
        );
        told += usize::from(compared == Some(right));
        let speeds = finding.tried.iter().map(|own| own.setting.speed.get());
        let speeds: Vec<i16> = speeds.collect();
        let mut fastest = speeds[0];
        for speed in speeds {
            assert!(speed <= 2 * fastest, "{seed}: {speed} after {fastest}");
            fastest = fastest.max(speed);
        }
    }
    let words = format!("{claims} claims, {told} told, of {tried}");
    println!("{words}");
    assert!(
        tried >= 6 && 18 * claims >= 17 * tried && 18 * told >= 13 * tried,
        "{words}"
    );
}

#[test]
fn a_drive_that_counts_the_offset_breaks_nothing_and_is_told() {
    is_tuned_whatever_its_offset(true);
}

#[test]
fn a_drive_that_does_not_count_the_offset_breaks_nothing_and_is_told() {
    is_tuned_whatever_its_offset(false);
}

#[test]
fn hands_that_nothing_was_tuned_on_break_nothing() {
    for seed in 1000..1000 + soak::times_at_least(3, 8) {
        let search = on_other_hand(drawn(seed, LIMIT.into()), seed);
        assert!(
            !search.broke && search.highest < 1.15,
            "{seed}: {}",
            search.highest
        );
        assert!(search.finding.is_some(), "{seed}");
    }
}

#[test]
fn a_drive_that_stops_in_the_air_by_its_offset_gets_a_higher_threshold() {
    let body = OtherBody {
        offset: 230.0,
        stops_in_air: true,
        ..OtherBody::default()
    };
    let search = on_other_hand(body, 3);
    assert!(search.highest < 1.1, "{}", search.highest);
    let finding = search.finding.unwrap();
    assert!(finding.result.is_ok(), "{:?}", finding.result);
    assert_eq!(
        finding.compared[0].compared,
        Some(ThresholdReference::AsRead)
    );
    let words = finding.compared[0].to_string();
    assert!(
        words.contains("FORCE_ACT as read") && words.contains("g at rest"),
        "{words}"
    );
}

#[test]
fn a_hand_that_moves_within_one_reading_of_the_command_is_tuned() {
    let body = OtherBody {
        latency: (0.0, 0.0),
        ..OtherBody::default()
    };
    let finding = on_other_hand(body, 1).finding.unwrap();
    assert!(finding.result.is_ok(), "{:?}", finding.result);
}

#[test]
fn the_threshold_is_below_what_is_to_be_held_where_the_drive_keeps_what_it_ran_past_it() {
    for seed in 0..3 {
        let finding = on_other_hand(OtherBody::default(), seed).finding.unwrap();
        let claim = finding.result.unwrap();
        let (threshold, holds) = (claim.setting.force.get(), claim.joints[0].hold_g);
        assert!(threshold < 120 && holds >= 200.0, "{threshold} {holds}");
    }
}

#[test]
fn its_close_is_about_as_quick_as_the_best_of_a_grid_on_another_hand() {
    for (seed, stiffness, counts_offset) in [(1, 25.0, true), (2, 12.0, false), (3, 45.0, true)] {
        let body = OtherBody {
            offset: 120.0,
            counts_offset,
            stiffness: (stiffness, 1.0),
            ..OtherBody::default()
        };
        let claim = on_other_hand(body, seed).finding.unwrap().result.unwrap();
        let best = best_close_s(body, f64::from(LIMIT), 200.0);
        assert!(
            claim.close_s < 1.12 * best,
            "{seed}: {} {best}",
            claim.close_s
        );
    }
}

#[test]
fn an_object_too_strong_for_the_limit_is_never_told_with_a_peak_under_it() {
    for (seed, hold_g) in [(1, 390), (2, 400), (3, 400)] {
        let body = OtherBody {
            offset: 206.0,
            stiffness: (60.0, 1.0),
            noise: 9.0,
            ..OtherBody::default()
        };
        let mut hand = VirtualHand::of(OtherHand::new(body, seed));
        let run = hand.tune(&SearchGoal { hold_g, ..goal() });
        if let Err(NoClaim::TooStrong { peak_g, .. }) = run.finding.unwrap().result {
            assert!(peak_g > f64::from(LIMIT), "{peak_g}");
        }
    }
}

fn highest_g(run: &Run) -> f64 {
    let joints = run.trials.iter().flat_map(|trial| &trial.summary.joints);
    let peaks = joints.filter_map(|joint| joint.peak_force_g);
    peaks.fold(0.0, f64::max)
}

#[test]
fn a_slip_ends_the_search_or_narrows_it_to_what_is_slower() {
    let mut body = random(1);
    body.joints[Dof::Index].force_zero_g = 0.0;
    let mut hand = VirtualHand::new(body, 1, &object(13.0, None));
    let run = hand.tune(&quick());
    assert!(run.finding.unwrap().result.is_ok());
    let (mut ended, mut narrowed) = (0, 0);
    for slips_at in 0..run.trials.len() {
        let mut search = SettingsSearch::new(quick()).unwrap();
        for (number, trial) in run.trials[..=slips_at].iter().enumerate() {
            let mut trial = trial.clone();
            if number == slips_at {
                trial.summary.joints[0].slip_count = Some(1);
            }
            search.learn(&trial);
        }
        let slipped = search.tried().last().unwrap().setting.speed;
        match (search.finding(), search.next()) {
            (Some(finding), None) => {
                let dof = Dof::Index;
                assert_eq!(finding.result, Err(NoClaim::Slips { dof }), "{slips_at}");
                ended += 1;
            }
            (None, Some(next)) => {
                assert!(next.setting.speed < slipped, "{slips_at}: {slipped:?}");
                narrowed += 1;
            }
            other => panic!("{slips_at}: {other:?}"),
        }
    }
    assert!(ended >= 1 && narrowed >= 10, "{ended} {narrowed}");
}

/// Searches while something happens after so many closes.
fn meanwhile(
    body: BodyParams,
    before: &Object,
    goal: &SearchGoal,
    mut happens: impl FnMut(&mut SimHand, usize),
) -> Run {
    let mut hand = VirtualHand::new(body, 3, before);
    let series = hand.search(goal);
    let mut last = usize::MAX;
    hand.run_trials(series, |hand, series: &mut TrialSeries| {
        let number = series.view().number;
        if number != last {
            last = number;
            happens(hand, number);
        }
    })
}

fn none(run: Run) -> NoClaim {
    assert_eq!(run.aborted, None);
    assert!(!run.stopped);
    run.finding.unwrap().result.unwrap_err()
}

#[test]
fn what_keeps_it_from_a_claim_is_said() {
    let usual = BodyParams::default();
    let block = object(13.0, None);
    let dof = Dof::Index;
    let no_object = meanwhile(usual, &Object::none(), &quick(), |_, _| ());
    assert_eq!(none(no_object), NoClaim::NoContact { dof });
    let mut short = quick();
    short.close[dof] = Some(Angle::nearest(700));
    let out_of_reach = meanwhile(usual, &block, &short, |_, _| ());
    assert_eq!(none(out_of_reach), NoClaim::NoContact { dof });
    let at_start = Object {
        contacts: PerDof::splat(Some(Obstacle::at(1002.0, 13.0))),
        ..Object::none()
    };
    let touching = none(meanwhile(usual, &at_start, &quick(), |_, _| ()));
    assert_eq!(touching, NoClaim::Touching { dof });
    let mut noisy = usual;
    noisy.joints[dof].force_noise_g = 60.0;
    let low = SearchGoal::new(&[dof], 200);
    let noise = none(meanwhile(noisy, &block, &low, |_, _| ()));
    assert!(matches!(noise, NoClaim::Noise { .. }), "{noise}");
    let dead = none(meanwhile(usual, &block, &quick(), |hand, number| {
        hand.set_dead(dof, number >= 1);
    }));
    assert_eq!(dead, NoClaim::Dead { dof });
    let taken = none(meanwhile(usual, &block, &quick(), |hand, number| {
        if number == 6 {
            hand.set_object(&Object::none());
        }
    }));
    assert_eq!(taken, NoClaim::Lost { dof });
    let gives = none(meanwhile(usual, &block, &quick(), |hand, number| {
        if number == 6 {
            hand.set_object(&object(4.0, None));
        }
    }));
    assert!(matches!(gives, NoClaim::Gives { .. }), "{gives}");
    for own in [dead, noise, gives, taken] {
        let words = own.to_string();
        assert!(words.contains("index") && words.contains(':'), "{words}");
    }
}

#[test]
fn a_fault_midway_and_a_locked_joint_stop_the_hand_and_keep_what_was_tried() {
    let usual = BodyParams::default();
    let block = object(13.0, None);
    let fault = meanwhile(usual, &block, &quick(), |hand, number| {
        if number == 5 {
            hand.inject_fault(Dof::Middle, Fault::OverCurrent);
        }
    });
    assert!(matches!(
        fault.aborted,
        Some(Abort::Fault {
            joint: Some((Dof::Middle, _))
        })
    ));
    assert!(fault.stopped && fault.finding.is_none());
    assert_eq!(fault.trials.len(), 5);
    let locked = meanwhile(usual, &block, &quick(), |hand, _| {
        hand.set_jam(Dof::Index, Some(800.0));
    });
    assert!(matches!(
        locked.aborted,
        Some(Abort::Fault {
            joint: Some((Dof::Index, _))
        })
    ));
    assert!(locked.stopped);
}

#[test]
fn two_joints_share_a_setting_and_each_has_its_bound() {
    let both = SearchGoal::new(&[Dof::Index, Dof::ThumbBend], 600);
    let mut hand = VirtualHand::new(random(2), 2, &object(13.0, None));
    let claim = hand.tune(&both).finding.unwrap().result.unwrap();
    assert_eq!(claim.joints.len(), 2);
    assert!(claim.joints.iter().all(|joint| joint.peak_bound_g <= 600.0));
    let words = claim.to_string();
    assert!(
        words.starts_with("Index and Thumb bend on this object: close in"),
        "{words}"
    );
}

#[test]
fn without_a_distribution_the_bound_is_the_largest_of_22_closes() {
    let free = SearchGoal {
        closes: 22,
        distribution_free: true,
        ..goal()
    };
    let mut hand = VirtualHand::new(random(1), 1, &object(25.0, None));
    let finding = hand.tune(&free).finding.unwrap();
    let claim = finding.result.unwrap();
    assert!(
        claim.closes >= 22 && claim.assurance.coverage == 0.9,
        "{claim}"
    );
    let peaks = &claim.joints[0].peaks_g;
    let highest = peaks.iter().copied().fold(0.0, f64::max);
    let bound = claim.peak_bound_g();
    assert!(
        (highest..1.1 * highest).contains(&bound),
        "{claim} {peaks:?}"
    );
    assert!(claim.here >= 10 && claim.here == peaks.len());
    let confirm = finding.tried.iter().filter(|own| own.confirms).count();
    assert_eq!(confirm, claim.here);
}

/// How a search over a link ended.
struct SearchEnd {
    series: EndReport,
    finding: Option<Finding>,
    tried: usize,
}

/// A search over a link; it ends when the person sends.
async fn over_a_link(ends_after: Option<usize>) -> (SearchEnd, Vec<SeriesProgress>, LinkState) {
    let hand = hand::shared(SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    });
    let config = LinkConfig {
        rates: RATES,
        ..link::config("rs485:test", link::to_hand(hand))
    };
    let clock = config.clock;
    let (link, mut records) = handscope::link::open(config, &tokio::runtime::Handle::current());
    let mut seen = HandSample::default();
    while seen.faults.is_none() || seen.angle.is_none() || seen.temperature.is_none() {
        if let Some(Record::Reading { sample, .. }) = records.next().await {
            seen = *sample;
        }
    }
    let mut goal = quick();
    goal.start[Dof::Index] = Some(Angle::nearest(620));
    let search = SettingsSearch::new(goal).unwrap();
    let lease = link.grant(Owner::Task);
    link.arm(lease, arm_limits(&search.plan())).unwrap();
    while link.status().armed.is_none() {
        let _record = records.next().await;
    }
    let epoch = link.status().armed.unwrap();
    let series = TrialSeries::search(search, epoch, clock.now());
    let armed = Armed {
        epoch,
        lease,
        seen,
        clock,
    };
    let (person, ended) = oneshot::channel();
    let mut person = Some(person);
    let ends = stream::once(ended).filter_map(|sent| ready(sent.ok().map(|()| Abort::Person)));
    let ends = ends.chain(stream::pending());
    let mut steps = Vec::new();
    let driven = trials(&link, armed, series, ends, |step| {
        let trials = |step: &SeriesProgress| matches!(step, Progress::Event(SeriesEvent::Trial(_)));
        steps.push(step);
        let count = steps.iter().filter(|own| trials(own)).count();
        if ends_after.is_some_and(|after| count >= after)
            && let Some(person) = person.take()
        {
            person.send(()).unwrap();
        }
        true
    })
    .await;
    tokio::time::sleep(Duration::from_millis(200)).await;
    let search = driven.program.series.settings_search().unwrap();
    let end = SearchEnd {
        series: driven.report(),
        finding: search.finding(),
        tried: search.tried().len(),
    };
    (end, steps, link.status().state)
}

#[tokio::test(start_paused = true)]
async fn over_a_link_it_claims_tells_its_progress_and_disarms() {
    let (report, steps, state) = over_a_link(None).await;
    assert_eq!(report.series.aborted, None);
    let claim = report.finding.unwrap().result.unwrap();
    assert!(claim.peak_bound_g() <= f64::from(LIMIT));
    assert_eq!(state, LinkState::Monitoring);
    let stages: Vec<SearchStage> = steps
        .iter()
        .filter_map(|step| match step {
            Progress::Event(SeriesEvent::Search(progress)) => Some(progress.stage),
            Progress::View(_) | Progress::Sent(_) | Progress::Event(SeriesEvent::Trial(_)) => None,
        })
        .collect();
    assert_eq!(stages.first(), Some(&SearchStage::Probing));
    assert!(
        stages.contains(&SearchStage::Confirming { done: 9, of: 10 }),
        "{stages:?}"
    );
    assert_eq!(stages.last(), Some(&SearchStage::Over));
}

#[tokio::test(start_paused = true)]
async fn a_person_ends_it_at_once_and_the_hand_is_held() {
    let (report, _, state) = over_a_link(Some(3)).await;
    assert_eq!(report.series.aborted, Some(Abort::Person));
    assert!(matches!(report.series.stop, Some(Stop::Confirmed { .. })));
    assert!(report.finding.is_none());
    assert_eq!(report.tried, 3);
    assert_ne!(state, LinkState::Armed);
}
