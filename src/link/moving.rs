//! Whether the hand moves, as far as feedback and what was written tell. Pure; decides nothing about reading.

use crate::hand::{AngleReading, Dof, Group, Groups, HandSample, Moment, PerDof, Status};
use std::time::Duration;

/// After the last sign of motion the hand counts as moving for this long: a person who drags pauses, and a hand acts
/// late.
const MOVES_FOR: Duration = Duration::from_secs(1);
/// A joint that is no more than this many counts from where it was rests: readings swing by so much.
const REST_COUNTS: i32 = 2;

/// Watches for motion.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MoveWatch {
    /// Where the joints were when they were last seen to have moved.
    from: Option<PerDof<AngleReading>>,
    seen: Option<Moment>,
}

impl MoveWatch {
    /// A motion was commanded.
    pub(crate) const fn commanded(&mut self, now: Moment) {
        self.seen = Some(now);
    }

    /// Takes what was read.
    pub(crate) fn take(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        if fresh.contains(Group::Angle)
            && let Some(angle) = sample.angle
        {
            match self.from {
                Some(from) if near(&from, &angle.value) => {}
                Some(_) => {
                    self.from = Some(angle.value);
                    self.seen = Some(now);
                }
                None => self.from = Some(angle.value),
            }
        }
        let says_so = |status: Status| matches!(status, Status::Releasing | Status::Grasping);
        if fresh.contains(Group::Status)
            && let Some(status) = sample.status
            && Dof::ALL.iter().any(|dof| says_so(status.value[*dof]))
        {
            self.seen = Some(now);
        }
    }

    /// True if something moves, or did just now.
    pub(crate) fn moves(&self, now: Moment) -> bool {
        self.seen.is_some_and(|seen| now.since(seen) < MOVES_FOR)
    }
}

fn near(a: &PerDof<AngleReading>, b: &PerDof<AngleReading>) -> bool {
    let apart = |dof: Dof| (i32::from(a[dof].raw()) - i32::from(b[dof].raw())).abs();
    Dof::ALL.iter().all(|dof| apart(*dof) <= REST_COUNTS)
}
