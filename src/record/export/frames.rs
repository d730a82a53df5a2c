//! Frames at an even rate, from readings and commands that arrive at any time.

use crate::hand::grip::Grip;
use crate::hand::newtons::newtons;
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, Quantity};
use crate::record::export::targets::CommandedTargets;
use crate::record::file::RecordingFile;
use crate::record::grip::{GripFollower, states};
use crate::record::{Entry, Record, WriteFate};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// Maximum age of a reading in a frame.
const MIN_GAP: Duration = Duration::from_millis(500);
/// Maximum age of targets read from the hand, which are read about twice a second.
const MIN_TARGET_GAP: Duration = Duration::from_secs(3);
/// Angles are 0 to 1000.
const FULL_SCALE: f32 = 1000.0;
/// Minimum read rate of the fingertips in Hz; at a lower rate they are omitted, because every frame would be a gap.
const TOUCH_HZ_MIN: f64 = 4.0;
/// Values of the fingertips: normal, then tangential forces.
const TOUCH_WIDTH: usize = 10;
/// Values of the joints' force sensors, which precede the fingertips.
const FORCE_WIDTH: usize = 6;
/// States of the grip: the grasp's, then the fingers'.
const GRIP_WIDTH: usize = 6;

/// The known state at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct DatasetFrame {
    /// Number within its episode, from 0.
    pub(crate) number: u64,
    pub(crate) at: Moment,
    /// Time since the episode's first frame, in seconds.
    pub(crate) time_s: f32,
    /// The note that began the episode.
    pub(crate) note: Option<Arc<str>>,
    /// True if a target was set by anything other than the recorded writes.
    pub(crate) is_read_back: bool,
    /// True if a target was sent, or set by anything else during the recording.
    pub(crate) is_commanded: bool,
    pub(crate) state: [f32; 6],
    pub(crate) action: [f32; 6],
    /// Forces of the joints, then of the fingertips, if included.
    pub(crate) environment: [f32; FORCE_WIDTH + TOUCH_WIDTH],
    /// Forces in newtons of the joints for which they are known.
    pub(crate) force_n: Vec<f32>,
    /// State numbers of the grasp and the fingers.
    pub(crate) grip: [f32; GRIP_WIDTH],
}

/// Values that only some recordings contain.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FrameExtras {
    /// True if a frame requires the fingertips.
    pub(crate) with_touch: bool,
    /// Joints whose forces are also in newtons.
    pub(crate) in_newtons: Vec<Dof>,
}

/// Names and lengths of the parts of a frame.
pub(crate) fn frame_parts(extras: &FrameExtras) -> Vec<(&'static str, usize)> {
    let touch = if extras.with_touch { TOUCH_WIDTH } else { 0 };
    let mut parts = vec![
        ("observation.state", 6),
        ("action", 6),
        ("observation.environment_state", FORCE_WIDTH + touch),
        ("observation.force", FORCE_WIDTH),
    ];
    if extras.with_touch {
        parts.push(("observation.touch", TOUCH_WIDTH));
    }
    if !extras.in_newtons.is_empty() {
        parts.push(("observation.force_n", extras.in_newtons.len()));
    }
    parts.push(("observation.grip", GRIP_WIDTH));
    parts
}

impl DatasetFrame {
    /// Its parts, in the order of [`frame_parts`].
    pub(crate) fn parts(&self, with_touch: bool) -> Vec<&[f32]> {
        let (force, touch) = self.environment.split_at(FORCE_WIDTH);
        let mut parts: Vec<&[f32]> = vec![&self.state, &self.action];
        if with_touch {
            parts.extend([&self.environment, force, touch]);
        } else {
            parts.extend([force, force]);
        }
        if !self.force_n.is_empty() {
            parts.push(&self.force_n);
        }
        parts.push(&self.grip);
        parts
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a force in newtons")]
const fn single(value: f64) -> f32 {
    value as f32
}

/// True if the fingertips of a recording were read often enough for frames.
pub(crate) fn has_touch(file: &RecordingFile) -> bool {
    #[expect(clippy::cast_precision_loss, reason = "far below 2^53 sweeps")]
    let sweeps = file.overview().counts.touch_sweeps() as f64;
    let length_s = file.last().since(file.first()).as_secs_f64();
    sweeps > 0.0 && sweeps >= TOUCH_HZ_MIN * length_s
}

/// Options of the frames.
#[derive(Debug, Clone)]
pub(crate) struct FramePlan {
    pub(crate) fps: u32,
    /// True if a frame requires the fingertips.
    pub(crate) with_touch: bool,
    /// Joints whose forces are also in newtons, each with those of a gram.
    pub(crate) newtons_per_g: Vec<(Dof, f64)>,
    /// Time before which there are no frames; earlier entries only provide the commands.
    pub(crate) from: Moment,
    /// Starts of the episodes, ordered by time; `None` if an episode begins as soon as all values are known.
    pub(crate) notes: Option<VecDeque<(Moment, Arc<str>)>>,
}

/// Builds frames from entries.
#[derive(Debug)]
pub(crate) struct DatasetFrames {
    plan: FramePlan,
    sample: HandSample,
    targets: CommandedTargets,
    follower: GripFollower,
    grip: Grip,
    note: Option<Arc<str>>,
    began: Option<Moment>,
    number: u64,
}

impl DatasetFrames {
    pub(crate) fn new(plan: FramePlan) -> Self {
        Self {
            plan,
            sample: HandSample::default(),
            targets: CommandedTargets::UNKNOWN,
            follower: GripFollower::default(),
            grip: Grip::default(),
            note: None,
            began: None,
            number: 0,
        }
    }

    /// Passes on the frames before this entry, and then applies the entry.
    pub(crate) fn apply(&mut self, entry: &Entry, mut give: impl FnMut(&DatasetFrame)) {
        let now = entry.at();
        while let Some((at, note)) = self.next_note(now) {
            self.advance(at, &mut give);
            self.note = Some(note);
            self.begin(at);
        }
        self.advance(now, &mut give);
        if let Some(grip) = self.follower.apply(entry) {
            self.grip = grip;
        }
        match entry {
            Entry::Heard(Record::Reading { sample, fresh }) => self.reading(sample, *fresh),
            Entry::Heard(Record::Sent {
                at, number, write, ..
            }) => self.targets.sent(*at, *number, write),
            Entry::Heard(Record::Answered {
                number,
                fate: WriteFate::Refused { .. },
                ..
            }) => self.targets.refused(*number),
            Entry::Heard(Record::State { state, .. }) if !state.is_live() => {
                self.sample = HandSample::default();
                self.targets = CommandedTargets::UNKNOWN;
                self.began = None;
            }
            _ => {}
        }
        if self.began.is_none() {
            self.begin(now);
        }
    }

    /// Removes the next note up to `now`.
    fn next_note(&mut self, now: Moment) -> Option<(Moment, Arc<str>)> {
        let notes = self.plan.notes.as_mut()?;
        notes.front().filter(|(at, _)| *at <= now)?;
        notes.pop_front()
    }

    /// Begins an episode at `at`, if all values are known and the plan allows it.
    fn begin(&mut self, at: Moment) {
        let is_wanted = self.plan.notes.is_none() || self.note.is_some();
        let is_wanted = is_wanted && at >= self.plan.from;
        self.number = 0;
        self.began = Some(at).filter(|_| is_wanted && self.frame(at, at).is_some());
    }

    /// Passes on the frames that are due before `until`.
    fn advance(&mut self, until: Moment, give: &mut impl FnMut(&DatasetFrame)) {
        while let Some((began, at)) = self.next_at().filter(|(_, at)| *at < until) {
            match self.frame(began, at) {
                Some(frame) => give(&frame),
                None => {
                    self.began = None;
                    break;
                }
            }
            self.number += 1;
        }
    }

    /// Start of the episode, and time of the next frame.
    fn next_at(&self) -> Option<(Moment, Moment)> {
        let began = self.began?;
        let micros = self.number.saturating_mul(1_000_000) / u64::from(self.plan.fps.max(1));
        Some((began, began.plus(Duration::from_micros(micros))))
    }

    fn reading(&mut self, sample: &HandSample, fresh: Groups) {
        self.sample = *sample;
        if let Some(held) = sample.angle_set.filter(|_| fresh.contains(Group::AngleSet)) {
            self.targets.read(held);
        }
    }

    /// The frame at a time; `None` if a value is unknown or too old.
    fn frame(&self, began: Moment, at: Moment) -> Option<DatasetFrame> {
        let fresh = |received: Moment, within: Duration| at.since(received) <= within;
        let angle = Quantity::Angle.documented(&self.sample)?;
        let force = Quantity::Force.documented(&self.sample)?;
        if !fresh(angle.received, MIN_GAP) || !fresh(force.received, MIN_GAP) {
            return None;
        }
        if !self.targets.are_sent() && !fresh(self.sample.angle_set?.received, MIN_TARGET_GAP) {
            return None;
        }
        let mut frame = DatasetFrame {
            number: self.number,
            at,
            time_s: at.since(began).as_secs_f32(),
            note: self.note.clone(),
            is_read_back: self.targets.are_read_back(),
            is_commanded: self.targets.are_commanded(),
            state: [0.0; 6],
            action: [0.0; 6],
            environment: [0.0; FORCE_WIDTH + TOUCH_WIDTH],
            force_n: Vec::with_capacity(self.plan.newtons_per_g.len()),
            grip: states(&self.grip.at(at)).map(|state| state.number().into()),
        };
        let (forces, touch) = frame.environment.split_at_mut(FORCE_WIDTH);
        let joints = frame.state.iter_mut().zip(&mut frame.action).zip(forces);
        for (dof, ((state, action), grams)) in Dof::ALL.into_iter().zip(joints) {
            let angle = angle.value[dof]?;
            *state = f32::from(angle) / FULL_SCALE;
            *action = f32::from(self.targets.angle(dof).unwrap_or(angle)) / FULL_SCALE;
            *grams = f32::from(force.value[dof]?);
        }
        for (dof, per_g) in &self.plan.newtons_per_g {
            frame
                .force_n
                .push(single(newtons(force.value[*dof]?.into(), *per_g)));
        }
        if self.plan.with_touch {
            let (normal, tangential) = touch.split_at_mut(Finger::ALL.len());
            for (finger, (normal, tangential)) in Finger::ALL
                .into_iter()
                .zip(normal.iter_mut().zip(tangential))
            {
                let block = self.sample.tactile[finger]?;
                if !fresh(block.received, MIN_GAP) {
                    return None;
                }
                *normal = block.value.normal()?;
                *tangential = block.value.tangential()?;
            }
        }
        Some(frame)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::cast_possible_truncation, reason = "a test may")]
    use super::*;
    use crate::hand::Reply;
    use crate::hand::command::HandCommand;
    use crate::hand::register::ANGLE_SET;
    use crate::hand::{Angle, PerDof, Span, Target};
    use crate::record::WriteCause;

    fn empty() -> DatasetFrames {
        DatasetFrames::new(FramePlan {
            fps: 10,
            with_touch: false,
            newtons_per_g: Vec::new(),
            from: Moment::ZERO,
            notes: None,
        })
    }

    fn millis(millis: u64) -> Moment {
        Moment::from_micros(1000 * millis)
    }

    /// A reading of everything about the joints, all angles and targets of which are `angle`.
    fn reading(sample: &mut HandSample, at: Moment, angle: i16) -> Entry {
        let all: Vec<u8> = (0..69).flat_map(|_| angle.to_le_bytes()).collect();
        let fresh = sample.apply(&Reply {
            span: Span::new(ANGLE_SET.address, 138),
            bytes: &all,
            asked: at,
            received: at,
        });
        Entry::Heard(Record::Reading {
            sample: Arc::new(*sample),
            fresh,
        })
    }

    #[test]
    fn frames_hold_the_newest_reading_and_a_silence_ends_the_episode() {
        let (mut frames, mut sample) = (empty(), HandSample::default());
        let mut all = Vec::new();
        let readings = (0..10).map(|n| 40 * n).chain((0..5).map(|n| 2000 + 40 * n));
        for (angle, at) in (1..).zip(readings) {
            let entry = reading(&mut sample, millis(at), angle);
            frames.apply(&entry, |frame| all.push(frame.clone()));
        }
        let got: Vec<(u64, i32)> = all
            .iter()
            .map(|frame| (frame.number, (frame.state[0] * FULL_SCALE).round() as i32))
            .collect();
        // The last reading before the silence, at 360 ms, holds until 860 ms, and no longer.
        let first = [
            (0, 1),
            (1, 3),
            (2, 6),
            (3, 8),
            (4, 10),
            (5, 10),
            (6, 10),
            (7, 10),
            (8, 10),
        ];
        let second = [(0, 11), (1, 13)];
        assert_eq!(got, [&first[..], &second].concat());
        assert!((all[3].time_s - 0.3).abs() < 1e-6);
    }

    #[test]
    fn an_action_is_what_was_sent_before_it_is_read_back() {
        let (mut frames, mut sample) = (empty(), HandSample::default());
        let mut all = Vec::new();
        let command =
            HandCommand::Angles(PerDof::splat(Some(Target::Go(Angle::new(900).unwrap()))));
        let sent = Entry::Heard(Record::Sent {
            at: millis(150),
            number: 1,
            cause: WriteCause::Setpoint,
            write: command.writes().first().unwrap().into(),
        });
        let first = reading(&mut sample, millis(0), 300);
        let last = reading(&mut sample, millis(320), 400);
        for entry in [first, sent, last] {
            frames.apply(&entry, |frame| all.push(frame.clone()));
        }
        let actions: Vec<i32> = all
            .iter()
            .map(|frame| (frame.action[5] * FULL_SCALE).round() as i32)
            .collect();
        assert_eq!(actions, [300, 300, 900, 900]);
    }

    #[test]
    fn a_command_before_the_stretch_is_known_in_it_and_episodes_begin_at_notes() {
        let plan = FramePlan {
            from: millis(1000),
            notes: Some(
                [(1500, "pick"), (2200, "place")]
                    .map(|(at, words)| (millis(at), words.into()))
                    .into(),
            ),
            ..empty().plan
        };
        let (mut frames, mut sample) = (DatasetFrames::new(plan), HandSample::default());
        let command =
            HandCommand::Angles(PerDof::splat(Some(Target::Go(Angle::new(900).unwrap()))));
        let mut all = Vec::new();
        for n in 0..=60 {
            // Read 200 ms after the command, the hand still holds what it held before.
            let mut entries = vec![reading(&mut sample, millis(50 * n), 300)];
            if n == 18 {
                entries.push(Entry::Heard(Record::Sent {
                    at: millis(900),
                    number: 1,
                    cause: WriteCause::Hold,
                    write: command.writes().first().unwrap().into(),
                }));
            }
            for entry in entries {
                frames.apply(&entry, |frame| all.push(frame.clone()));
            }
        }
        let got: Vec<(u64, &str, u64)> = all
            .iter()
            .map(|frame| {
                assert!((frame.action[2] - 0.9).abs() < 1e-6, "{frame:?}");
                let note = frame.note.as_deref().unwrap();
                (frame.number, note, frame.at.micros() / 1000)
            })
            .collect();
        let first = (0..7).map(|n| (n, "pick", 1500 + 100 * n));
        let second = (0..8).map(|n| (n, "place", 2200 + 100 * n));
        assert_eq!(got, first.chain(second).collect::<Vec<_>>());
    }
}
