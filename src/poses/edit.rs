//! User edits of the library. Every edit keeps it consistent: names are unique, and steps name existing poses.

use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::poses::library::{
    ENTRIES_MAX, EntryId, LibraryPose, Millis, PoseId, PoseLibrary, Reaction, ReactionId,
    STEPS_MAX, Sequence, SequenceId, SequenceStep, StepGoal, TAGS_MAX, clean, free_name,
};

/// An edit of a pose.
#[derive(Debug, Clone, PartialEq)]
pub enum PoseEdit {
    /// A new name; an empty one is ignored, a taken one gets a number.
    Rename(String),
    /// Tags, separated by commas.
    Tags(String),
    /// The target of one joint; ignored for a pose by size, whose angles follow from its gap.
    Angle(Dof, Angle),
    /// The gap of a pose by size; `None` turns it back into a pose of angles.
    Gap(Option<Gap>),
    /// True leaves a joint where it is when the pose is recalled.
    Leave(Dof, bool),
    /// Speed of recall.
    Speed(Speed),
    /// Force threshold of recall.
    Force(Force),
    /// Forces of the hold in which it ends; `None` for none.
    Hold(Option<HoldForces>),
    /// Moves it to this position, from 0; the poses between shift.
    Move(usize),
    /// Inserts a copy after it.
    Duplicate,
    /// Deletes it, with the steps and reactions that name it.
    Delete,
}

/// An edit of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub enum SequenceEdit {
    /// A new name; an empty one is ignored, a taken one gets a number.
    Rename(String),
    /// True to repeat the sequence from its first step.
    Loop(bool),
    /// Appends a step to a pose.
    Add(PoseId),
    /// Appends a step with a grip by size.
    AddGap(Gap),
    /// Appends a step that holds what the hand has.
    AddHold(HoldForces),
    /// Removes a step.
    Remove(usize),
    /// Moves a step from one position to another; the steps between shift.
    Move(usize, usize),
    /// Replaces a step.
    Change(usize, SequenceStep),
    /// Deletes the sequence.
    Delete,
}

/// An edit of the library.
#[derive(Debug, Clone, PartialEq)]
pub enum LibraryEdit {
    Pose(PoseId, PoseEdit),
    /// A new sequence without steps, under this name or the next free one.
    NewSequence(String),
    Sequence(SequenceId, SequenceEdit),
    /// New poses; two or more also form a sequence with the name of the last.
    Add(Vec<LibraryPose>),
    /// A copy of a shipped pose, or of a shipped sequence with the poses it needs.
    Copy(EntryId),
    /// Reverts the last deletion or import.
    Undo,
}

impl PoseLibrary {
    /// Appends a pose; `None` if the library is full.
    pub fn add_pose(&mut self, name: &str, mut pose: LibraryPose) -> Option<PoseId> {
        if self.poses.len() >= ENTRIES_MAX {
            return None;
        }
        pose.id = PoseId(self.fresh());
        pose.name = free_name(&clean(name), |name| self.pose_named(name).is_some());
        let id = pose.id;
        self.poses.push(pose);
        Some(id)
    }

    /// Appends a sequence; `None` if the library is full.
    pub fn add_sequence(&mut self, name: &str) -> Option<SequenceId> {
        if self.sequences.len() >= ENTRIES_MAX {
            return None;
        }
        let id = SequenceId(self.fresh());
        let name = self.free_sequence_name(&clean(name), id);
        self.sequences.push(Sequence {
            id,
            name,
            name_zh: String::new(),
            key: None,
            looped: false,
            steps: Vec::new(),
            others: toml::Table::new(),
        });
        Some(id)
    }

    /// True if there is room for the poses of a grasp and their sequence.
    pub const fn has_room(&self) -> bool {
        self.poses.len() + 2 <= ENTRIES_MAX && self.sequences.len() < ENTRIES_MAX
    }

    /// Appends poses; two or more also form a sequence with the name of the last and steps at the poses' own speeds. `None`, and nothing
    /// added, if the library is full.
    pub fn add_all(&mut self, poses: Vec<LibraryPose>) -> Option<EntryId> {
        if self.poses.len() + poses.len() > ENTRIES_MAX || self.sequences.len() >= ENTRIES_MAX {
            return None;
        }
        let name = poses.last()?.name.clone();
        let mut steps = Vec::new();
        for pose in poses {
            let (own, speed) = (pose.name.clone(), pose.speed);
            let goal = StepGoal::Pose(self.add_pose(&own, pose)?);
            steps.push(SequenceStep::new(goal, speed));
        }
        if let [
            SequenceStep {
                goal: StepGoal::Pose(only),
                ..
            },
        ] = steps.as_slice()
        {
            return Some(EntryId::Pose(*only));
        }
        let id = self.add_sequence(&name)?;
        self.sequences.last_mut()?.steps = steps;
        Some(EntryId::Sequence(id))
    }

    fn free_sequence_name(&self, wanted: &str, but: SequenceId) -> String {
        let others = self.sequences.iter().filter(|other| other.id != but);
        free_name(wanted, |name| {
            others.clone().any(|other| other.name == name)
        })
    }

    /// Appends a copy of another library's pose or sequence. Poses it needs are matched by name with this library's own, else copied.
    pub fn copy_from(&mut self, other: &Self, entry: EntryId) -> Option<EntryId> {
        Some(match entry {
            EntryId::Pose(id) => {
                let pose = other.pose(id)?.clone();
                EntryId::Pose(self.add_pose(&pose.name.clone(), pose)?)
            }
            EntryId::Sequence(id) => {
                let mut copy = other.sequence(id)?.clone();
                for step in &mut copy.steps {
                    if let StepGoal::Pose(pose) = &mut step.goal {
                        *pose = self.needed_from(other, *pose)?;
                    }
                }
                copy.id = self.add_sequence(&copy.name)?;
                let own = self.sequences.last_mut()?;
                copy.name.clone_from(&own.name);
                *own = copy;
                EntryId::Sequence(own.id)
            }
            // A copied reaction could not be edited or deleted here.
            EntryId::Reaction(_) => return None,
        })
    }

    fn needed_from(&mut self, other: &Self, id: PoseId) -> Option<PoseId> {
        let pose = other.pose(id)?;
        match self.pose_named(&pose.name) {
            Some(own) => Some(own.id),
            None => self.add_pose(&pose.name, pose.clone()),
        }
    }

    /// Appends a reaction; `None` if the library is full.
    fn add_reaction(&mut self, mut reaction: Reaction) -> Option<ReactionId> {
        if self.reactions.len() >= ENTRIES_MAX {
            return None;
        }
        let taken = |name: &str| self.reactions.iter().any(|own| own.name == name);
        reaction.name = free_name(&reaction.name, taken);
        let id = ReactionId(self.fresh());
        reaction.id = id;
        self.reactions.push(reaction);
        Some(id)
    }

    /// Appends all entries of another library. Taken names get a number.
    pub fn merge(&mut self, other: Self) {
        let mut ids = Vec::new();
        for pose in other.poses {
            let (was, name) = (pose.id, pose.name.clone());
            ids.extend(self.add_pose(&name, pose).map(|id| (was, id)));
        }
        for mut sequence in other.sequences {
            let Some(id) = self.add_sequence(&sequence.name) else {
                return;
            };
            sequence.steps.retain_mut(|step| {
                let StepGoal::Pose(pose) = &mut step.goal else {
                    return true;
                };
                let known = ids.iter().find(|(was, _)| was == pose);
                known.inspect(|(_, id)| *pose = *id).is_some()
            });
            if let Some(own) = self.sequences.iter_mut().find(|own| own.id == id) {
                sequence.id = id;
                sequence.name.clone_from(&own.name);
                *own = sequence;
            }
        }
        for mut reaction in other.reactions {
            let known = |pose| ids.iter().find(|(was, _)| *was == pose).map(|(_, id)| *id);
            if let (Some(rest), Some(touched)) = (known(reaction.rest), known(reaction.touched)) {
                (reaction.rest, reaction.touched) = (rest, touched);
                self.add_reaction(reaction);
            }
        }
        for (key, value) in other.others {
            self.others.entry(key).or_insert(value);
        }
    }

    pub fn edit_pose(&mut self, id: PoseId, edit: PoseEdit) {
        let Some(at) = self.place(id) else {
            return;
        };
        let Some(pose) = self.poses.get_mut(at) else {
            return;
        };
        match edit {
            PoseEdit::Tags(text) => pose.tags = tags(&text),
            PoseEdit::Angle(dof, angle) => {
                if pose.gap.is_none() {
                    pose.angles[dof] = angle;
                }
            }
            PoseEdit::Gap(gap) => pose.set_gap(gap),
            PoseEdit::Leave(dof, leave) => {
                pose.leave[dof] = leave && !(pose.gap.is_some() && Gap::JOINTS.contains(&dof));
            }
            PoseEdit::Speed(speed) => pose.speed = speed,
            PoseEdit::Force(force) => pose.force = force,
            PoseEdit::Hold(forces) => pose.hold = forces,
            PoseEdit::Move(to) => put(&mut self.poses, at, to),
            PoseEdit::Duplicate => self.duplicate(at),
            PoseEdit::Delete => {
                self.poses.remove(at);
                for sequence in &mut self.sequences {
                    sequence.steps.retain(|step| !step.goal.is_pose(id));
                }
                self.reactions
                    .retain(|reaction| reaction.rest != id && reaction.touched != id);
            }
            PoseEdit::Rename(name) => {
                let others = self.poses.iter().filter(|pose| pose.id != id);
                let taken = |name: &str| others.clone().any(|pose| pose.name == name);
                let name = free_name(&clean(&name), taken);
                if let Some(pose) = self.poses.get_mut(at).filter(|_| !name.is_empty()) {
                    (pose.name, pose.name_zh) = (name, String::new());
                }
            }
        }
    }

    fn duplicate(&mut self, at: usize) {
        let Some(copy) = self.poses.get(at).cloned() else {
            return;
        };
        let last = self.poses.len();
        let copy = LibraryPose { key: None, ..copy };
        self.add_pose(&copy.name.clone(), copy);
        put(&mut self.poses, last, at + 1);
    }

    pub fn edit_sequence(&mut self, id: SequenceId, edit: SequenceEdit) {
        if edit == SequenceEdit::Delete {
            self.sequences.retain(|sequence| sequence.id != id);
            return;
        }
        let name = match &edit {
            SequenceEdit::Rename(name) => self.free_sequence_name(&clean(name), id),
            _ => String::new(),
        };
        let speed = match &edit {
            SequenceEdit::Add(pose) => self.pose(*pose).map(|pose| pose.speed),
            SequenceEdit::AddGap(_) | SequenceEdit::AddHold(_) => Some(Speed::GENTLE),
            _ => None,
        };
        let Some(sequence) = self.sequences.iter_mut().find(|own| own.id == id) else {
            return;
        };
        match edit {
            SequenceEdit::Rename(_) if !name.is_empty() => {
                (sequence.name, sequence.name_zh) = (name, String::new());
            }
            SequenceEdit::Loop(looped) => sequence.looped = looped,
            SequenceEdit::Add(pose) => sequence.push(StepGoal::Pose(pose), speed),
            SequenceEdit::AddGap(gap) => {
                let force = Force::GENTLE;
                sequence.push(StepGoal::Gap { gap, force }, speed);
            }
            SequenceEdit::AddHold(forces) => sequence.push(StepGoal::Hold(forces), speed),
            SequenceEdit::Remove(at) if at < sequence.steps.len() => {
                sequence.steps.remove(at);
            }
            SequenceEdit::Move(from, to) => put(&mut sequence.steps, from, to),
            SequenceEdit::Change(at, step) => {
                if let Some(own) = sequence.steps.get_mut(at) {
                    *own = step;
                }
            }
            SequenceEdit::Rename(_) | SequenceEdit::Remove(_) | SequenceEdit::Delete => {}
        }
    }
}

impl Sequence {
    /// Appends a step, if `speed` is known and there is room.
    fn push(&mut self, goal: StepGoal, speed: Option<Speed>) {
        if let Some(speed) = speed.filter(|_| self.steps.len() < STEPS_MAX) {
            self.steps.push(SequenceStep::new(goal, speed));
        }
    }
}

impl SequenceStep {
    /// A step with default waiting times.
    pub const fn new(goal: StepGoal, speed: Speed) -> Self {
        Self {
            goal,
            speed,
            dwell: Millis::DWELL,
            limit: Millis::LIMIT,
            until: None,
            hold: None,
        }
    }
}

impl LibraryPose {
    /// A pose with gentle limits that moves every joint. Its name and id are assigned when it is added.
    pub fn at(angles: PerDof<Angle>) -> Self {
        Self {
            id: PoseId(0),
            name: String::new(),
            name_zh: String::new(),
            key: None,
            tags: Vec::new(),
            angles,
            gap: None,
            thresholds: None,
            leave: PerDof::splat(false),
            speed: Speed::GENTLE,
            force: Force::GENTLE,
            hold: None,
            others: toml::Table::new(),
        }
    }
}

/// Tags of a comma-separated list, without duplicates.
pub(crate) fn tags(text: &str) -> Vec<String> {
    let mut tags: Vec<String> = Vec::new();
    for tag in text.split([',', '，']).map(clean) {
        if !tag.is_empty() && !tags.contains(&tag) && tags.len() < TAGS_MAX {
            tags.push(tag);
        }
    }
    tags
}

/// Moves an element to another position. Positions out of range are ignored.
fn put<T>(row: &mut [T], from: usize, to: usize) {
    let between = from.min(to)..=from.max(to);
    if let Some(between) = row.get_mut(between) {
        if from < to {
            between.rotate_left(1);
        } else {
            between.rotate_right(1);
        }
    }
}
