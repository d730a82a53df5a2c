//! DatasetFrames at an even rate, made of readings that come when they come.

use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, PerDof, Quantity, Target};
use crate::record::file::SessionFile;
use crate::record::{Entry, Record, WrittenMemory};
use std::time::Duration;

/// A reading that is older is not taken for what holds now.
const GAP_AFTER: Duration = Duration::from_millis(500);
/// The same for targets, which are read about twice a second.
const TARGET_GAP_AFTER: Duration = Duration::from_secs(3);
/// Angles are 0 to 1000.
const FULL_SCALE: f32 = 1000.0;
/// Fingertips that are read less often than so many times a second are left out: each frame would be a silence.
const TOUCH_HZ_MIN: f64 = 4.0;
/// How many values the parts of a frame have: angles, targets, forces, normal and tangential forces of the fingertips.
pub(crate) const FRAME_WIDTHS: [usize; 4] = [6, 6, 6, 10];

/// What was known at one time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DatasetFrame {
    /// In its episode, from 0.
    pub(crate) number: u64,
    /// Since the episode's first, s.
    pub(crate) time_s: f32,
    state: [f32; 6],
    action: [f32; 6],
    force: [f32; 6],
    touch: [f32; 10],
}

impl DatasetFrame {
    /// Its parts, as [`FRAME_WIDTHS`] counts them; the last means nothing where the fingertips are left out.
    pub(crate) fn parts(&self) -> [&[f32]; 4] {
        [&self.state, &self.action, &self.force, &self.touch]
    }
}

/// Whether the fingertips of a session were read often enough to be in frames.
pub(crate) fn has_touch(file: &SessionFile) -> bool {
    #[expect(clippy::cast_precision_loss, reason = "far below 2^53 sweeps")]
    let sweeps = file.overview().counts.touch_sweeps() as f64;
    let length_s = file.last().since(file.first()).as_secs_f64();
    sweeps > 0.0 && sweeps >= TOUCH_HZ_MIN * length_s
}

/// Makes frames of entries.
#[derive(Debug)]
pub(crate) struct DatasetFrames {
    fps: u32,
    /// Whether a frame needs the fingertips.
    with_touch: bool,
    sample: HandSample,
    /// Targets, newer than those that were read back.
    sent: PerDof<Option<(Moment, i16)>>,
    began: Option<Moment>,
    number: u64,
}

impl DatasetFrames {
    pub(crate) fn new(file: &SessionFile, fps: u32) -> Self {
        Self {
            fps: fps.max(1),
            with_touch: has_touch(file),
            sample: HandSample::default(),
            sent: PerDof::splat(None),
            began: None,
            number: 0,
        }
    }

    /// Gives the frames before this entry, and takes it in.
    pub(crate) fn take(&mut self, entry: &Entry, mut give: impl FnMut(&DatasetFrame)) {
        let now = entry.at();
        while let Some((began, at)) = self.next_at().filter(|(_, at)| *at < now) {
            match self.frame(began, at) {
                Some(frame) => give(&frame),
                None => {
                    self.began = None;
                    break;
                }
            }
            self.number += 1;
        }
        match entry {
            Entry::Heard(Record::Reading { sample, fresh }) => self.reading(sample, *fresh),
            Entry::Heard(Record::Sent { at, write, .. }) => self.sent(*at, write),
            Entry::Heard(Record::State { state, .. }) if !state.is_live() => {
                self.sample = HandSample::default();
                self.sent = PerDof::splat(None);
                self.began = None;
            }
            _ => {}
        }
        if self.began.is_none() && self.frame(now, now).is_some() {
            self.began = Some(now);
            self.number = 0;
        }
    }

    /// When the next frame is due.
    fn next_at(&self) -> Option<(Moment, Moment)> {
        let began = self.began?;
        let micros = self.number.saturating_mul(1_000_000) / u64::from(self.fps);
        Some((began, began.plus(Duration::from_micros(micros))))
    }

    fn reading(&mut self, sample: &HandSample, fresh: Groups) {
        self.sample = *sample;
        if let Some(read) = sample.angle_set.filter(|_| fresh.contains(Group::AngleSet)) {
            for (_, sent) in self.sent.iter_mut() {
                if sent.is_some_and(|(at, _)| at <= read.asked) {
                    *sent = None;
                }
            }
        }
    }

    fn sent(&mut self, at: Moment, write: &WrittenMemory) {
        for (dof, angle) in write.angle_targets().iter() {
            if let Some(angle) = angle {
                self.sent[dof] = Some((at, angle.get()));
            }
        }
    }

    /// The frame of a time; `None` if something in it is not known or too old.
    fn frame(&self, began: Moment, at: Moment) -> Option<DatasetFrame> {
        let fresh = |received: Moment, within: Duration| at.since(received) <= within;
        let angle = Quantity::Angle.documented(&self.sample)?;
        let force = Quantity::Force.documented(&self.sample)?;
        let target = self.sample.angle_set?;
        if !fresh(angle.received, GAP_AFTER)
            || !fresh(force.received, GAP_AFTER)
            || !fresh(target.received, TARGET_GAP_AFTER)
        {
            return None;
        }
        let mut frame = DatasetFrame {
            number: self.number,
            time_s: at.since(began).as_secs_f32(),
            state: [0.0; 6],
            action: [0.0; 6],
            force: [0.0; 6],
            touch: [0.0; 10],
        };
        for (dof, ((state, action), grams)) in Dof::ALL.into_iter().zip(
            frame
                .state
                .iter_mut()
                .zip(&mut frame.action)
                .zip(&mut frame.force),
        ) {
            let angle = angle.value[dof]?;
            let held = target.value[dof]
                .and_then(Target::angle)
                .map(|angle| angle.get());
            let sent = self.sent[dof].map(|(_, value)| value);
            *state = f32::from(angle) / FULL_SCALE;
            *action = f32::from(sent.or(held).unwrap_or(angle)) / FULL_SCALE;
            *grams = f32::from(force.value[dof]?);
        }
        if self.with_touch {
            let (normal, tangential) = frame.touch.split_at_mut(Finger::ALL.len());
            for (finger, (normal, tangential)) in Finger::ALL
                .into_iter()
                .zip(normal.iter_mut().zip(tangential))
            {
                let block = self.sample.tactile[finger]?;
                if !fresh(block.received, GAP_AFTER) {
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
    use crate::hand::{Angle, Span};
    use crate::record::WriteCause;
    use std::sync::Arc;

    fn empty() -> DatasetFrames {
        DatasetFrames {
            fps: 10,
            with_touch: false,
            sample: HandSample::default(),
            sent: PerDof::splat(None),
            began: None,
            number: 0,
        }
    }

    fn millis(millis: u64) -> Moment {
        Moment::from_micros(1000 * millis)
    }

    /// A reading of everything about the joints, all angles and targets of which are `angle`.
    fn reading(sample: &mut HandSample, at: Moment, angle: i16) -> Entry {
        let all: Vec<u8> = (0..69).flat_map(|_| angle.to_le_bytes()).collect();
        let fresh = sample.take(&Reply {
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
            frames.take(&entry, |frame| all.push(frame.clone()));
        }
        let told: Vec<(u64, i32)> = all
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
        assert_eq!(told, [&first[..], &second].concat());
        assert!((all[3].time_s - 0.3).abs() < 1e-6);
    }

    #[test]
    fn an_action_is_what_was_sent_before_it_is_read_back() {
        let (mut frames, mut sample) = (empty(), HandSample::default());
        let mut all = Vec::new();
        let command = HandCommand::Angles(PerDof::splat(Target::Go(Angle::new(900).unwrap())));
        let sent = Entry::Heard(Record::Sent {
            at: millis(150),
            number: 1,
            cause: WriteCause::Setpoint,
            write: command.writes().first().unwrap().into(),
        });
        let first = reading(&mut sample, millis(0), 300);
        let last = reading(&mut sample, millis(320), 400);
        for entry in [first, sent, last] {
            frames.take(&entry, |frame| all.push(frame.clone()));
        }
        let actions: Vec<i32> = all
            .iter()
            .map(|frame| (frame.action[5] * FULL_SCALE).round() as i32)
            .collect();
        assert_eq!(actions, [300, 300, 900, 900]);
    }
}
