//! Decides when a stopped hand is at rest. Pure: samples and time in, a verdict out.

use crate::hand::{AngleReading, Dof, Group, Groups, HandSample, Moment, PerDof, Target};
use std::time::Duration;

/// Hold frames are at most this far apart until rest is seen.
pub(crate) const HOLD_REPEAT: Duration = Duration::from_millis(40);
/// Hold follows the newest pose for this long after the press, then keeps the pose: a hand acts about 64 ms late, and
/// a target that follows it for ever makes it swing for ever.
const HOLD_FOLLOWS: Duration = Duration::from_millis(120);
/// Without rest by then, the alarm is raised.
pub(crate) const HOLD_ALARM_DELAY: Duration = Duration::from_millis(500);
/// A joint rests if it moves no more than this many counts …
const REST_COUNTS: i32 = 2;
/// … over at least this time.
const REST_OVER: Duration = Duration::from_millis(100);
/// A hand that moved when it was stopped is not called at rest before this has passed since the first hold frame. Should feedback
/// have frozen around the stop, the joints go on for the dead time and come back to where they were seen last: by then they are there.
const MOVED_REST_DELAY: Duration = Duration::from_millis(250);
/// A joint in doubt is told where it must be for this long, counted in acknowledged frames. If it obeys, it stands there by then; if
/// it is deaf and its angle is true, any further frame would move it once it wakes.
const DOUBTED_HOLD: Duration = Duration::from_millis(250);

/// One stop, from the press until feedback shows rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HoldWatch {
    pub(crate) at: Moment,
    pub(crate) sent: u32,
    pub(crate) alarmed: bool,
    /// When the frames began that go on now.
    follows_from: Moment,
    pose: PerDof<Target>,
    /// The pose was read; until then it is where the joints must be by what they were told.
    is_read: bool,
    /// The first frame that told a joint where to stay; one without a target holds nothing.
    first_held: Option<Moment>,
    last_sent: Option<Moment>,
    still_since: Option<(Moment, PerDof<AngleReading>)>,
    /// No rest is believed before this has passed since the first frame.
    rest_after: Duration,
    /// The pose was read, or tried to, since the last frame.
    looked: bool,
    /// The first frame for joints in doubt that the hand acknowledged, and the newest.
    doubted_acknowledged: Option<(Moment, Moment)>,
    /// All that can be done was done: joints in doubt were told where to stay, and the others rest.
    has_ceased: bool,
}

/// A stop without a link.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PendingStop {
    /// When it was asked for.
    pub(crate) at: Moment,
    /// A hand that answers until then is stopped first.
    pub(crate) until: Moment,
}

impl HoldWatch {
    /// A stop that is asked for now, of a hand that moves or does not as far as is known. `way_back`: how long its joints need from
    /// where they must be by now to where they were seen last.
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
            looked: true,
            doubted_acknowledged: None,
            has_ceased: false,
        }
    }

    /// A stop that was asked for at `at` over a link that was lost, of a hand that answers again now.
    pub(crate) fn resumed(at: Moment, now: Moment) -> Self {
        Self {
            follows_from: now,
            looked: false,
            ..Self::new(at, true, Duration::ZERO)
        }
    }

    /// The same stop, begun anew: it became known where a joint is.
    pub(crate) fn again(&self, now: Moment) -> Self {
        Self {
            sent: self.sent,
            alarmed: self.alarmed,
            follows_from: now,
            ..Self::new(self.at, true, Duration::ZERO)
        }
    }

    /// When the next hold frame is due; `None` once none is.
    pub(crate) fn next_frame(&self, now: Moment) -> Option<Moment> {
        let next = self.last_sent.map_or(now, |sent| sent.plus(HOLD_REPEAT));
        (!self.has_ceased).then_some(next)
    }

    /// The hand acknowledged a frame while joints were in doubt.
    pub(crate) fn doubted_acknowledged(&mut self, now: Moment) {
        let (_, newest) = self.doubted_acknowledged.get_or_insert((now, now));
        *newest = now;
    }

    /// The joints that are trusted rest: nothing more is sent once the others were told for long enough where to stay.
    pub(crate) fn trusted_rest(&mut self) {
        let told = self.doubted_acknowledged;
        self.has_ceased |= told.is_some_and(|(first, newest)| newest.since(first) >= DOUBTED_HOLD);
    }

    /// True once nothing more is sent, though rest was not seen.
    pub(crate) const fn has_ceased(&self) -> bool {
        self.has_ceased
    }

    /// True, once, for a hand that answers again or for the first time, if nothing is known that a frame could hold it to: the pose is
    /// read first. A stop over a live link goes first whatever is known.
    pub(crate) fn needs_pose(&mut self, newest: &PerDof<Target>) -> bool {
        let nothing = PerDof::splat(Target::Leave);
        let is_blind = self.pose == nothing && *newest == nothing;
        is_blind && !std::mem::replace(&mut self.looked, true)
    }

    /// The targets of the hold frame that leaves at `now`, given where the joints are, and when that was asked for; `None` if it is
    /// expected. A pose that was expected is replaced by the first that is read, however late. `way_back` as for [`Self::new`], by
    /// now.
    pub(crate) fn frame(
        &mut self,
        newest: &PerDof<Target>,
        read: Option<Moment>,
        way_back: Duration,
        now: Moment,
    ) -> PerDof<Target> {
        let is_first_read = read.is_some() && !self.is_read;
        let is_soon = is_first_read || now.since(self.follows_from) <= HOLD_FOLLOWS;
        // An older pose is that of the first frame, or what it went by.
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

    /// True if the alarm is to be raised now.
    pub(crate) fn alarm_due(&self, now: Moment) -> bool {
        !self.alarmed && now.since(self.follows_from) >= HOLD_ALARM_DELAY
    }

    /// Applies a sample; true if it shows that all joints but those in doubt rest. Only angles that were asked for
    /// after the first frame that holds count, and an angle that makes no sense is not at rest.
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

    /// Feeds an angle each 10 ms and gives the time at which rest was seen.
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
        // What it was seen at last is as far as 480 ms away.
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
        // Three counts each 100 ms.
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
