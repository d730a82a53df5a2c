//! Decides whether the hand rests, from feedback and from what was written. Pure; does not schedule reads.

use crate::hand::{AngleReading, Dof, Group, Groups, HandSample, Moment, PerDof, Timed};
use crate::record::Rest;
use std::time::Duration;

/// The hand counts as moving for this long after the last sign of motion: a user who drags pauses, and a hand reacts late.
const MOTION_DURATION: Duration = Duration::from_secs(1);
/// A joint rests while it is within this many counts of where it was: readings fluctuate that much.
const REST_COUNTS: i32 = 2;
/// Feedback older than this does not show whether the hand rests now.
const MAX_AGE: Duration = Duration::from_millis(500);

/// Detects motion.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RestWatch {
    /// Joint angles at the last detected motion.
    from: Option<PerDof<AngleReading>>,
    /// Time of the first angles.
    watched_since: Option<Moment>,
    moved: Option<Moment>,
}

impl RestWatch {
    /// Records that motion was commanded.
    pub(crate) const fn commanded(&mut self, now: Moment) {
        self.moved = Some(now);
    }

    /// Applies a reading.
    pub(crate) fn apply(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        if fresh.contains(Group::Angle)
            && let Some(angle) = sample.angle
        {
            self.watched_since.get_or_insert(angle.received);
            match self.from {
                Some(from) if near(&from, &angle.value) => {}
                Some(_) => {
                    self.from = Some(angle.value);
                    self.moved = Some(now);
                }
                None => self.from = Some(angle.value),
            }
        }
        if fresh.contains(Group::Status)
            && let Some(status) = sample.status
            && status.value.iter().any(|(_, status)| status.is_moving())
        {
            self.moved = Some(now);
        }
    }

    /// True if the hand moves or moved just now.
    pub(crate) fn moves(&self, now: Moment) -> bool {
        self.moved
            .is_some_and(|moved| now.since(moved) < MOTION_DURATION)
    }

    /// Returns whether the hand rests. A status code that the manual does not list proves nothing: 255 was seen on
    /// joints at rest since power-up. In that case angles that are unchanged for [`MOTION_DURATION`] decide. `late`
    /// extends the maximum age of readings on a slow link.
    pub(crate) fn rest(&self, sample: &HandSample, now: Moment, late: Duration) -> Rest {
        if self.moves(now) {
            return Rest::Moving;
        }
        let within = MAX_AGE + late;
        let status = fresh(sample.status, now, within);
        let (Some(status), Some(angle)) = (status, fresh(sample.angle, now, within)) else {
            return Rest::Unknown;
        };
        let says_so = status.iter().all(|(_, status)| status.is_stopped());
        let is_sensible = angle.iter().all(|(_, angle)| angle.documented().is_some());
        let watched = self
            .watched_since
            .is_some_and(|since| now.since(since) >= MOTION_DURATION);
        if says_so || is_sensible && watched {
            Rest::Resting
        } else {
            Rest::Unknown
        }
    }
}

fn fresh<T>(group: Option<Timed<T>>, now: Moment, within: Duration) -> Option<T> {
    group
        .filter(|group| group.age(now) <= within)
        .map(|group| group.value)
}

fn near(a: &PerDof<AngleReading>, b: &PerDof<AngleReading>) -> bool {
    let apart = |dof: Dof| (i32::from(a[dof].raw()) - i32::from(b[dof].raw())).abs();
    Dof::ALL.iter().all(|dof| apart(*dof) <= REST_COUNTS)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::Status;

    fn ms(millis: u64) -> Moment {
        Moment::from_micros(millis * 1000)
    }

    fn sample(status: u8, angle: i16, at: Moment) -> HandSample {
        let timed = |value| Timed {
            value,
            asked: at,
            received: at,
        };
        HandSample {
            angle: Some(Timed {
                value: PerDof::splat(AngleReading::new(angle)),
                asked: at,
                received: at,
            }),
            status: Some(timed(PerDof::splat(Status::from_raw(status)))),
            ..HandSample::default()
        }
    }

    fn all() -> Groups {
        let mut groups = Groups::NONE;
        groups.insert(Group::Angle);
        groups.insert(Group::Status);
        groups
    }

    #[test]
    fn what_was_never_read_or_is_old_is_unknown() {
        let watch = RestWatch::default();
        assert_eq!(
            watch.rest(&HandSample::default(), ms(0), Duration::ZERO),
            Rest::Unknown
        );
        let mut watch = RestWatch::default();
        let seen = sample(2, 500, ms(0));
        watch.apply(&seen, all(), ms(0));
        assert_eq!(watch.rest(&seen, ms(500), Duration::ZERO), Rest::Resting);
        assert_eq!(watch.rest(&seen, ms(501), Duration::ZERO), Rest::Unknown);
        let without_status = HandSample {
            status: None,
            ..seen
        };
        assert_eq!(
            watch.rest(&without_status, ms(10), Duration::ZERO),
            Rest::Unknown
        );
    }

    #[test]
    fn status_angles_and_commands_each_show_motion_for_a_second() {
        let (mut sampled, mut seen, mut commanded) = <(RestWatch, RestWatch, RestWatch)>::default();
        sampled.apply(&sample(1, 500, ms(0)), all(), ms(0));
        seen.apply(&sample(2, 500, ms(0)), all(), ms(0));
        seen.apply(&sample(2, 503, ms(0)), all(), ms(0));
        commanded.commanded(ms(0));
        let now = sample(2, 503, ms(999));
        for mut watch in [sampled, seen, commanded] {
            assert_eq!(watch.rest(&now, ms(999), Duration::ZERO), Rest::Moving);
            watch.apply(&sample(2, 503, ms(1000)), all(), ms(1000));
        }
        assert_eq!(seen.rest(&now, ms(1001), Duration::ZERO), Rest::Resting);
    }

    #[test]
    fn an_unlisted_status_is_rest_only_with_angles_that_stood_still_for_a_second() {
        let mut watch = RestWatch::default();
        watch.apply(&sample(255, 500, ms(0)), all(), ms(0));
        assert_eq!(
            watch.rest(&sample(255, 500, ms(990)), ms(999), Duration::ZERO),
            Rest::Unknown
        );
        assert_eq!(
            watch.rest(&sample(255, 500, ms(990)), ms(1000), Duration::ZERO),
            Rest::Resting
        );
        assert_eq!(
            watch.rest(&sample(255, 30_000, ms(990)), ms(1000), Duration::ZERO),
            Rest::Unknown
        );
    }
}
