//! A dry run of a sequence on the drawn hand only. Nothing here can reach a hand.

use crate::hand::{Dof, Moment, PerDof};
use crate::poses::library::{PoseLibrary, SequenceId};
use crate::poses::player::{Cue, cues};
use crate::poses::way::WayPart;
use std::time::Duration;

#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    pub sequence: SequenceId,
    pub since: Moment,
    cues: Vec<Cue>,
    looped: bool,
    from: PerDof<f64>,
}

/// The drawn hand at one moment of a dry run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreviewFrame {
    /// Openness of each joint, 0 bent to 1 open.
    pub shares: PerDof<Option<f32>>,
    /// Index of the step, from 0.
    pub step: usize,
    /// True once the dwell of the last pose is over.
    pub over: bool,
}

impl Preview {
    /// Starts at the current angles `from`; a joint of unknown angle starts at its angle in the first pose. `None` if the sequence has
    /// no steps.
    pub fn of(
        library: &PoseLibrary,
        sequence: SequenceId,
        from: PerDof<Option<i16>>,
        now: Moment,
    ) -> Option<Self> {
        let cues = cues(library, sequence);
        let first = cues.first()?.targets;
        let target = |dof: Dof| first[dof].map(|target| f64::from(target.get()));
        let from =
            PerDof::from_fn(|dof| from[dof].map(f64::from).or(target(dof)).unwrap_or(1000.0));
        Some(Self {
            sequence,
            since: now,
            cues,
            looped: library.sequence(sequence)?.looped,
            from,
        })
    }

    /// The drawn hand at this moment.
    pub fn at(&self, now: Moment) -> PreviewFrame {
        let mut left = now.since(self.since).as_secs_f64();
        let mut angles = self.from;
        let (round, after) = self.round(angles);
        if self.looped && left >= round {
            // From the second round on, each starts where the previous one ended and takes the same time.
            left -= round;
            angles = after;
            let (round, _) = self.round(angles);
            left = if round > 0.0 { left % round } else { 0.0 };
        }
        for (step, cue) in self.cues.iter().enumerate() {
            for part in parts(cue, &angles) {
                let way = way_s(&part, &angles, cue.limit);
                if left < way {
                    let moved = |dof: Dof| moved(&part, dof, angles[dof], left);
                    return shown(PerDof::from_fn(moved), step, false);
                }
                angles = PerDof::from_fn(|dof| moved(&part, dof, angles[dof], way));
                left -= way;
            }
            let dwell = cue.dwell.as_secs_f64();
            if left < dwell {
                return shown(angles, step, false);
            }
            left -= dwell;
        }
        shown(
            angles,
            self.cues.len().saturating_sub(1),
            !self.looped || round <= 0.0,
        )
    }

    /// Duration of one round from these angles, s, and the angles at its end.
    fn round(&self, mut angles: PerDof<f64>) -> (f64, PerDof<f64>) {
        let mut seconds = 0.0;
        for cue in &self.cues {
            for part in parts(cue, &angles) {
                let way = way_s(&part, &angles, cue.limit);
                seconds += way;
                angles = PerDof::from_fn(|dof| moved(&part, dof, angles[dof], way));
            }
            seconds += cue.dwell.as_secs_f64();
        }
        (seconds, angles)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "an angle of 0 to 1000")]
fn parts(cue: &Cue, from: &PerDof<f64>) -> Vec<WayPart> {
    cue.parts(&from.map(|angle| Some(angle.round() as i16)))
}

/// Seconds until every joint arrives, at most the limit of the step.
fn way_s(part: &WayPart, from: &PerDof<f64>, limit: Duration) -> f64 {
    let limit = limit.as_secs_f64();
    let takes = |dof: Dof| {
        let far = (f64::from(part.targets[dof]?.get()) - from[dof]).abs();
        Some(match far {
            0.0 => 0.0,
            far => far / part.speeds[dof].angle_per_s(),
        })
    };
    let longest = Dof::ALL.into_iter().filter_map(takes);
    longest.fold(0.0, f64::max).min(limit)
}

fn moved(part: &WayPart, dof: Dof, from: f64, seconds: f64) -> f64 {
    let Some(to) = part.targets[dof].map(|to| f64::from(to.get())) else {
        return from;
    };
    let reach = part.speeds[dof].angle_per_s() * seconds;
    from + (to - from).clamp(-reach, reach)
}

#[expect(clippy::cast_possible_truncation, reason = "a share between 0 and 1")]
fn shown(angles: PerDof<f64>, step: usize, over: bool) -> PreviewFrame {
    PreviewFrame {
        shares: angles.map(|angle| Some((angle / 1000.0) as f32)),
        step,
        over,
    }
}
