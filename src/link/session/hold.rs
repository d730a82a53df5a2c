//! Decides when a stopped hand is at rest. Pure: samples and time in, a verdict out.

use crate::hand::{AngleReading, Dof, Group, Groups, HandSample, Moment, PerDof, Target};
use std::time::Duration;

/// Longest interval between hold frames until rest is detected.
pub(crate) const HOLD_REPEAT: Duration = Duration::from_millis(40);
/// The hold follows the newest pose for this long after the request, then freezes: a hand reacts about 64 ms late, and
/// a target that follows it forever makes it oscillate forever.
const HOLD_FOLLOWS: Duration = Duration::from_millis(120);
/// The alarm is raised if the hand does not rest within this time.
pub(crate) const HOLD_ALARM_DELAY: Duration = Duration::from_millis(500);
/// A joint rests if it moves at most this many counts …
const REST_COUNTS: i32 = 2;
/// … over at least this time.
const REST_OVER: Duration = Duration::from_millis(100);
/// A hand that moved when it was stopped does not count as at rest before this has passed since the first hold frame.
/// Should feedback have frozen around the stop, the joints move on for the dead time and return to where they were seen
/// last; they have arrived by then.
const MOVED_REST_DELAY: Duration = Duration::from_millis(250);
/// A doubted joint is commanded to its estimated position for this long, counted in acknowledged frames. If it obeys,
/// it has arrived by then; if it is unresponsive and its angle is true, any further frame would move it once it
/// recovers.
const DOUBTED_HOLD: Duration = Duration::from_millis(250);

/// One stop, from the request until feedback shows rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HoldWatch {
    pub(crate) at: Moment,
    pub(crate) sent: u32,
    pub(crate) alarmed: bool,
    /// Time at which the current run of frames began.
    follows_from: Moment,
    pose: PerDof<Target>,
    /// The pose was read; until then it is estimated from the commands.
    is_read: bool,
    /// Time of the first frame with a target for any joint; a frame without targets holds nothing.
    first_held: Option<Moment>,
    last_sent: Option<Moment>,
    still_since: Option<(Moment, PerDof<AngleReading>)>,
    /// Rest is not accepted before this has passed since the first frame.
    rest_after: Duration,
    /// The pose was read since the last frame, or the attempt failed.
    pose_read: bool,
    /// The first and the newest acknowledged frame for doubted joints.
    doubted_acknowledged: Option<(Moment, Moment)>,
    /// Frames have ceased: doubted joints were sent their hold targets, and the others rest.
    has_ceased: bool,
}

/// A stop that is pending without a link.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PendingStop {
    /// Time of the request.
    pub(crate) at: Moment,
    /// A hand that answers before this is stopped first.
    pub(crate) until: Moment,
}

impl HoldWatch {
    /// A stop requested now; `moved`: the hand is known to be moving. `way_back`: the time its joints need from their
    /// estimated positions to where they were seen last.
    pub(crate) fn new(at: Moment, moved: bool, way_back: Duration) -> Self {
        let rest_after = match moved {
            true => way_back.max(MOVED_REST_DELAY),
            false => way_back,
        };
        Self {
            at,
            sent: 0,
            alarmed: false,
            follows_from: at,
            pose: PerDof::splat(Target::Leave),
            is_read: false,
            first_held: None,
            last_sent: None,
            still_since: None,
            rest_after,
            pose_read: true,
            doubted_acknowledged: None,
            has_ceased: false,
        }
    }

    /// A stop that was requested at `at` over a link that was lost, of a hand that answers again now.
    pub(crate) fn resumed(at: Moment, now: Moment) -> Self {
        Self {
            follows_from: now,
            pose_read: false,
            ..Self::new(at, true, Duration::ZERO)
        }
    }

    /// Restarts the same stop after a joint's position became known.
    pub(crate) fn again(&self, now: Moment) -> Self {
        Self {
            sent: self.sent,
            alarmed: self.alarmed,
            follows_from: now,
            ..Self::new(self.at, true, Duration::ZERO)
        }
    }

    /// Time of the next hold frame; `None` once frames have ceased.
    pub(crate) fn next_frame(&self, now: Moment) -> Option<Moment> {
        let next = self.last_sent.map_or(now, |sent| sent.plus(HOLD_REPEAT));
        (!self.has_ceased).then_some(next)
    }

    /// Records that the hand acknowledged a frame while joints were doubted.
    pub(crate) fn doubted_acknowledged(&mut self, now: Moment) {
        let (_, newest) = self.doubted_acknowledged.get_or_insert((now, now));
        *newest = now;
    }

    /// Records that the trusted joints rest: frames cease once the doubted ones were commanded for long enough.
    pub(crate) fn trusted_rest(&mut self) {
        let doubted = self.doubted_acknowledged;
        self.has_ceased |=
            doubted.is_some_and(|(first, newest)| newest.since(first) >= DOUBTED_HOLD);
    }

    /// True once frames have ceased, though rest was not confirmed.
    pub(crate) const fn has_ceased(&self) -> bool {
        self.has_ceased
    }

    /// True, once, for a hand that answers again or for the first time, if no pose is known that a frame could hold it
    /// at: the pose is then read first. A stop over a live link is sent first in any case.
    pub(crate) fn needs_pose(&mut self, newest: &PerDof<Target>) -> bool {
        let nothing = PerDof::splat(Target::Leave);
        let is_blind = self.pose == nothing && *newest == nothing;
        is_blind && !std::mem::replace(&mut self.pose_read, true)
    }

    /// The targets of the hold frame that is sent at `now`. `newest` is the pose, and `read` the time it was requested;
    /// `None` if the pose is estimated. An estimated pose is replaced by the first that is read, however late.
    /// `way_back` as for [`Self::new`], at `now`.
    pub(crate) fn frame(
        &mut self,
        newest: &PerDof<Target>,
        read: Option<Moment>,
        way_back: Duration,
        now: Moment,
    ) -> PerDof<Target> {
        let is_first_read = read.is_some() && !self.is_read;
        let is_soon = is_first_read || now.since(self.follows_from) <= HOLD_FOLLOWS;
        // An older pose is the one that the first frame used, or precedes it.
        let is_newer = |first: Moment| read.is_some_and(|asked| asked >= first);
        let follows = is_soon && self.first_held.is_none_or(is_newer);
        self.is_read |= read.is_some();
        for (dof, target) in self.pose.iter_mut() {
            if follows || *target == Target::Leave {
                *target = newest[dof];
            }
        }
        self.sent = self.sent.saturating_add(1);
        if self.first_held.is_none() && self.pose != PerDof::splat(Target::Leave) {
            self.first_held = Some(now);
            self.rest_after = self.rest_after.max(way_back);
        }
        self.last_sent = Some(now);
        self.pose
    }

    /// True if the alarm must be raised now.
    pub(crate) fn alarm_due(&self, now: Moment) -> bool {
        !self.alarmed && now.since(self.follows_from) >= HOLD_ALARM_DELAY
    }

    /// Applies a sample; true if it shows that all joints but the doubted ones rest. Only angles requested after the
    /// first frame with a target count, and an implausible angle is not at rest.
    pub(crate) fn rests(
        &mut self,
        sample: &HandSample,
        fresh: Groups,
        doubted: &PerDof<bool>,
    ) -> bool {
        let (Some(first_held), Some(angle)) = (self.first_held, sample.angle) else {
            return false;
        };
        if !fresh.contains(Group::Angle) || angle.asked < first_held {
            return false;
        }
        if Dof::ALL
            .iter()
            .any(|dof| !doubted[*dof] && angle.value[*dof].hold().is_none())
        {
            self.still_since = None;
            return false;
        }
        match self.still_since {
            Some((since, from)) if near(&from, &angle.value, doubted) => {
                let is_back = angle.asked.since(first_held) >= self.rest_after;
                angle.asked.since(since) >= REST_OVER && is_back
            }
            _ => {
                self.still_since = Some((angle.received, angle.value));
                false
            }
        }
    }
}

fn near(a: &PerDof<AngleReading>, b: &PerDof<AngleReading>, doubted: &PerDof<bool>) -> bool {
    let apart = |dof: Dof| (i32::from(a[dof].raw()) - i32::from(b[dof].raw())).abs();
    Dof::ALL
        .iter()
        .all(|dof| doubted[*dof] || apart(*dof) <= REST_COUNTS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Angle, Timed};

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    fn sample(asked: Moment, angle: i16) -> (HandSample, Groups) {
        let value = PerDof::splat(AngleReading::new(angle));
        let angle = Some(Timed {
            value,
            asked,
            received: asked.plus(Duration::from_millis(5)),
        });
        let mut fresh = Groups::NONE;
        fresh.insert(Group::Angle);
        (
            HandSample {
                angle,
                ..HandSample::default()
            },
            fresh,
        )
    }

    /// Feeds an angle every 10 ms and returns the time at which rest was detected.
    fn rest_at(angle_at: impl Fn(u64) -> i16, sent: u64) -> Option<u64> {
        rest_of(HoldWatch::new(ms(0), false, Duration::ZERO), angle_at, sent)
    }

    fn rest_of(mut watch: HoldWatch, angle_at: impl Fn(u64) -> i16, sent: u64) -> Option<u64> {
        (0..200).map(|n| n * 10).find(|t| {
            if *t == sent {
                let pose = PerDof::splat(Target::Go(Angle::nearest(500)));
                watch.frame(&pose, Some(ms(*t)), Duration::ZERO, ms(*t));
            }
            let (sample, fresh) = sample(ms(*t), angle_at(*t));
            watch.rests(&sample, fresh, &PerDof::splat(false))
        })
    }

    #[test]
    fn a_still_hand_rests_after_the_window_and_not_before_the_first_frame() {
        let seen = rest_at(|_| 500, 0).unwrap();
        assert!((100..=130).contains(&seen), "{seen}");
        assert!(rest_at(|_| 500, 300).unwrap() >= 400);
    }

    #[test]
    fn a_hand_that_moved_rests_only_once_it_may_be_back_from_where_it_was_not_seen() {
        let moved = || HoldWatch::new(ms(0), true, Duration::ZERO);
        let frozen = rest_of(moved(), |_| 500, 0).unwrap();
        assert!((250..=280).contains(&frozen), "{frozen}");
        let late = rest_of(moved(), |t| 500 - i16::try_from(t.min(300)).unwrap(), 0).unwrap();
        assert!((400..=430).contains(&late), "{late}");
        // The joint needs up to 480 ms back to where it was seen last.
        for moved in [true, false] {
            let slow = HoldWatch::new(ms(0), moved, Duration::from_millis(480));
            let back = rest_of(slow, |_| 500, 0).unwrap();
            assert!((480..=510).contains(&back), "{back}");
        }
    }

    #[test]
    fn rest_counts_from_the_first_frame_that_holds_and_by_the_way_back_of_then() {
        let mut watch = HoldWatch::new(ms(0), true, Duration::ZERO);
        let pose = PerDof::splat(Target::Go(Angle::nearest(500)));
        let rests = (0..200).map(|n| n * 10).find(|t| {
            match *t {
                0 => watch.frame(&PerDof::splat(Target::Leave), None, Duration::ZERO, ms(*t)),
                300 => watch.frame(&pose, Some(ms(*t)), Duration::from_millis(400), ms(*t)),
                _ => pose,
            };
            let (sample, fresh) = sample(ms(*t), 500);
            watch.rests(&sample, fresh, &PerDof::splat(false))
        });
        assert_eq!(rests, Some(700));
    }

    #[test]
    fn a_slow_creep_is_not_rest() {
        // Three counts per 100 ms.
        assert_eq!(
            rest_at(|t| 500 + i16::try_from(t * 3 / 100).unwrap(), 0),
            None
        );
    }

    #[test]
    fn an_angle_that_makes_no_sense_is_never_rest() {
        assert_eq!(rest_at(|_| 2000, 0), None);
    }

    #[test]
    fn the_alarm_is_due_after_half_a_second() {
        let watch = HoldWatch::new(ms(0), false, Duration::ZERO);
        assert!(!watch.alarm_due(ms(499)));
        assert!(watch.alarm_due(ms(500)));
    }

    #[test]
    fn frames_are_due_at_once_and_then_each_forty_milliseconds() {
        let mut watch = HoldWatch::new(ms(7), false, Duration::ZERO);
        assert_eq!(watch.next_frame(ms(7)), Some(ms(7)));
        watch.frame(
            &PerDof::splat(Target::Leave),
            Some(ms(9)),
            Duration::ZERO,
            ms(9),
        );
        assert_eq!(watch.next_frame(ms(10)), Some(ms(49)));
    }

    #[test]
    fn frames_for_joints_in_doubt_cease_once_the_hand_had_time_to_obey_and_the_others_rest() {
        let mut watch = HoldWatch::new(ms(0), true, Duration::ZERO);
        for t in (0..=240).step_by(40) {
            watch.frame(
                &PerDof::splat(Target::Leave),
                Some(ms(t)),
                Duration::ZERO,
                ms(t),
            );
            watch.doubted_acknowledged(ms(t));
            watch.trusted_rest();
        }
        assert!(!watch.has_ceased());
        watch.doubted_acknowledged(ms(280));
        assert_eq!(watch.next_frame(ms(270)), Some(ms(280)), "others may move");
        watch.trusted_rest();
        assert_eq!(watch.next_frame(ms(300)), None);
    }

    #[test]
    fn the_pose_is_read_once_before_a_frame_that_would_hold_nothing_and_never_over_a_live_link() {
        let pose = |angle| PerDof::splat(Target::Go(Angle::nearest(angle)));
        let unknown = PerDof::splat(Target::Leave);
        assert!(!HoldWatch::new(ms(0), true, Duration::ZERO).needs_pose(&unknown));
        let mut watch = HoldWatch::resumed(ms(0), ms(60));
        assert!(!watch.needs_pose(&pose(500)));
        assert!(watch.needs_pose(&unknown));
        assert!(!watch.needs_pose(&unknown), "it could not be read");
    }

    #[test]
    fn hold_follows_the_hand_first_and_then_keeps_its_pose() {
        let pose = |angle| PerDof::splat(Target::Go(Angle::nearest(angle)));
        let mut watch = HoldWatch::new(ms(0), false, Duration::ZERO);
        assert_eq!(
            watch.frame(&pose(500), Some(ms(0)), Duration::ZERO, ms(0)),
            pose(500)
        );
        assert_eq!(
            watch.frame(&pose(480), Some(ms(40)), Duration::ZERO, ms(40)),
            pose(480)
        );
        assert_eq!(
            watch.frame(&pose(470), Some(ms(160)), Duration::ZERO, ms(160)),
            pose(480)
        );
        let mut blind = HoldWatch::new(ms(0), false, Duration::ZERO);
        let unknown = PerDof::splat(Target::Leave);
        assert_eq!(
            blind.frame(&unknown, Some(ms(0)), Duration::ZERO, ms(0)),
            unknown
        );
        assert_eq!(
            blind.frame(&pose(300), Some(ms(200)), Duration::ZERO, ms(200)),
            pose(300)
        );
    }
}
