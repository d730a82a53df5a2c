//! Frames at an even rate, made of readings that come when they come.

use crate::hand::register::ANGLE_SET;
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
pub(crate) struct Frame {
    /// In its episode, from 0.
    pub(crate) number: u64,
    /// Since the episode's first, s.
    pub(crate) time_s: f32,
    state: [f32; 6],
    action: [f32; 6],
    force: [f32; 6],
    touch: [f32; 10],
}

impl Frame {
    /// Its parts, as [`FRAME_WIDTHS`] counts them; the last means nothing where the fingertips are left out.
    pub(crate) fn parts(&self) -> [&[f32]; 4] {
        [&self.state, &self.action, &self.force, &self.touch]
    }
}

/// Whether the fingertips of a session were read often enough to be in frames.
pub(crate) fn has_touch(file: &SessionFile) -> bool {
    #[expect(clippy::cast_precision_loss, reason = "far below 2^53 sweeps")]
    let sweeps = file.overview().counts.touch_blocks as f64 / 5.0;
    let length_s = file.last().since(file.first()).as_secs_f64();
    sweeps > 0.0 && sweeps >= TOUCH_HZ_MIN * length_s
}

/// Makes frames of entries.
#[derive(Debug)]
pub(crate) struct Frames {
    fps: u32,
    /// Whether a frame needs the fingertips.
    with_touch: bool,
    sample: HandSample,
    /// Targets, newer than those that were read back.
    sent: PerDof<Option<(Moment, i16)>>,
    began: Option<Moment>,
    number: u64,
}

impl Frames {
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
    pub(crate) fn take(&mut self, entry: &Entry, mut give: impl FnMut(&Frame)) {
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
        for dof in Dof::ALL {
            let place = 2 * dof.index() + usize::from(ANGLE_SET.address);
            let bytes = place
                .checked_sub(usize::from(write.address))
                .and_then(|begin| write.bytes.get(begin..)?.first_chunk());
            let value = bytes.map(|pair| i16::from_le_bytes(*pair));
            if let Some(value) = value.filter(|value| (0..=1000).contains(value)) {
                self.sent[dof] = Some((at, value));
            }
        }
    }

    /// The frame of a time; `None` if something in it is not known or too old.
    fn frame(&self, began: Moment, at: Moment) -> Option<Frame> {
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
        let mut frame = Frame {
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
