//! Poses and sequences as plain values. How they are changed is in `edit`, how they are written in `file`.

use crate::hand::gap::Gap;
use crate::hand::grip::GripThresholds;
use crate::hand::{Angle, Force, PerDof, Speed};
use crate::poses::reaction::TouchForce;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Poses and sequences that a library holds, each: more than the user finds again.
pub const ENTRIES_MAX: usize = 500;
/// Steps of a sequence.
pub const STEPS_MAX: usize = 200;
/// Characters of a name or tag: what fits a tile.
pub const NAME_CHARS_MAX: usize = 32;
/// The tag of poses that only demos need.
pub const DEMO: &str = "demo";
/// Tags of one pose.
pub const TAGS_MAX: usize = 8;

/// A pose for as long as the program runs; files know it by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PoseId(pub u64);

/// A sequence for as long as the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SequenceId(pub u64);

/// A reaction for as long as the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ReactionId(pub u64);

/// An entry of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EntryId {
    Pose(PoseId),
    Sequence(SequenceId),
    Reaction(ReactionId),
}

impl EntryId {
    /// True if both are poses, both sequences, or both reactions.
    pub fn is_same_kind(self, other: Self) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }
}

/// The key that, with Shift, starts an entry of the library: a letter that means nothing else with Shift, or a digit from 1 on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct EntryKey(char);

/// A text that is no such key.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{got}\" is not a letter from A to Z but A, C, H, O and T, or a digit from 1 to 9")]
pub struct BadKey {
    /// What was given.
    pub got: String,
}

impl EntryKey {
    /// A capital letter or a digit.
    pub const fn get(self) -> char {
        self.0
    }
}

impl TryFrom<String> for EntryKey {
    type Error = BadKey;
    fn try_from(got: String) -> Result<Self, BadKey> {
        let mut letters = got.chars();
        match (letters.next(), letters.next()) {
            (Some('A' | 'C' | 'H' | 'O' | 'T'), None) => Err(BadKey { got }),
            (Some(key @ ('A'..='Z' | '1'..='9')), None) => Ok(Self(key)),
            _ => Err(BadKey { got }),
        }
    }
}

impl From<EntryKey> for String {
    fn from(key: EntryKey) -> Self {
        key.0.into()
    }
}

/// What an entry of the library is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EntryNames<'a> {
    /// In English, or in the user's own words.
    pub text: &'a str,
    /// In Chinese; empty if there is no other name.
    pub zh: &'a str,
    /// The key that, with Shift, starts it.
    pub key: Option<EntryKey>,
}

/// A time in milliseconds, 0 to ten minutes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "i64", into = "i64")]
pub struct Millis(u32);

/// A time that no step may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{got} ms is outside 0 to {}", Millis::MAX)]
pub struct BadTime {
    /// What was given.
    pub got: i64,
}

impl Millis {
    /// Longest time: ten minutes.
    pub const MAX: u32 = 600_000;
    /// How long a step waits at a pose at first.
    pub const DWELL: Self = Self(500);
    /// How long a step waits for arrival at first: the full way at a gentle speed takes 3 s.
    pub const LIMIT: Self = Self(5000);

    /// Milliseconds.
    pub const fn get(self) -> u32 {
        self.0
    }

    /// As a duration.
    pub const fn duration(self) -> Duration {
        Duration::from_millis(self.0 as u64)
    }
}

impl TryFrom<i64> for Millis {
    type Error = BadTime;
    fn try_from(got: i64) -> Result<Self, BadTime> {
        match u32::try_from(got) {
            Ok(millis) if millis <= Self::MAX => Ok(Self(millis)),
            _ => Err(BadTime { got }),
        }
    }
}

impl From<Millis> for i64 {
    fn from(time: Millis) -> Self {
        time.0.into()
    }
}

/// How often a step that closed on nothing opens and closes again, 0 to 20.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(try_from = "i64", into = "i64")]
pub struct Retries(u8);

/// A number of retries that no step may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{got} retries is outside 0 to {}", Retries::MAX)]
pub struct BadRetries {
    /// What was given.
    pub got: i64,
}

impl Retries {
    /// More than that, and the object is not where the hand closes.
    pub const MAX: u8 = 20;

    /// The number.
    pub const fn get(self) -> u8 {
        self.0
    }
}

impl TryFrom<i64> for Retries {
    type Error = BadRetries;
    fn try_from(got: i64) -> Result<Self, BadRetries> {
        match u8::try_from(got) {
            Ok(retries) if retries <= Self::MAX => Ok(Self(retries)),
            _ => Err(BadRetries { got }),
        }
    }
}

impl From<Retries> for i64 {
    fn from(retries: Retries) -> Self {
        retries.0.into()
    }
}

/// A step that is over once the hand holds something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UntilHolding {
    /// The sequence ends if nothing is held so long after the pose counts as reached.
    pub within: Millis,
    /// How often the hand opens and closes again where it closed on nothing.
    pub retries: Retries,
}

impl UntilHolding {
    /// What the user starts from.
    pub const FIRST: Self = Self {
        within: Millis(3000),
        retries: Retries(0),
    };
}

/// Six angles under a name, and how to go there.
#[derive(Debug, Clone, PartialEq)]
pub struct LibraryPose {
    /// To find it.
    pub id: PoseId,
    /// No two poses of a library have the same.
    pub name: String,
    /// The same in Chinese; empty if there is none.
    pub name_zh: String,
    /// The key that, with Shift, takes it.
    pub key: Option<EntryKey>,
    /// Words to find it by.
    pub tags: Vec<String>,
    /// Where the joints go, 0 bent to 1000 open.
    pub angles: PerDof<Angle>,
    /// The gap of a pose by size. Its angles are those of the gap, and thumb and index go there along the path on which they meet.
    pub gap: Option<Gap>,
    /// What its grip is told by while it is what was asked for last; `None` for the usual.
    pub thresholds: Option<GripThresholds>,
    /// Joints that are left alone although an angle is known.
    pub leave: PerDof<bool>,
    /// Speed of the joints that move.
    pub speed: Speed,
    /// Force threshold of the joints that move.
    pub force: Force,
    /// Keys of a newer version, kept as they are.
    pub others: toml::Table,
}

impl LibraryPose {
    /// True if only demos need it: it is not offered by itself.
    pub fn is_for_demos(&self) -> bool {
        self.tags.iter().any(|tag| tag == DEMO)
    }

    /// True if these words, in lower case, stand in its name or in one of its tags. No words stand everywhere.
    pub fn has(&self, words: &str) -> bool {
        let names = [&self.name, &self.name_zh];
        let names = names.into_iter().chain(&self.tags);
        let mut names = names.map(|name| name.to_lowercase());
        names.any(|name| name.contains(words))
    }

    /// Makes it a pose by size, or one of its angles again. Thumb and index of a pose by size take part.
    pub fn set_gap(&mut self, gap: Option<Gap>) {
        self.gap = gap;
        if let Some(gap) = gap {
            self.angles = gap.angles();
            for dof in Gap::JOINTS {
                self.leave[dof] = false;
            }
        }
    }

    /// Where each joint goes; `None` for those that are left alone.
    pub fn targets(&self) -> PerDof<Option<Angle>> {
        PerDof::from_fn(|dof| (!self.leave[dof]).then_some(self.angles[dof]))
    }
}

/// Where a step goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepGoal {
    /// To a pose of the library.
    Pose(PoseId),
    /// To a gap between the pads of thumb and index; what is between them is gripped.
    Gap {
        /// The gap.
        gap: Gap,
        /// Force threshold of the joints.
        force: Force,
    },
}

impl StepGoal {
    /// True if it is this pose.
    pub fn is_pose(self, id: PoseId) -> bool {
        self == Self::Pose(id)
    }
}

/// One pose, or grip by size, on a timeline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SequenceStep {
    pub goal: StepGoal,
    /// Speed on the way there; the pose's own is for recalling it alone.
    pub speed: Speed,
    /// Time at the pose before the next step.
    pub dwell: Millis,
    /// Time after which a pose that is not reached counts as reached.
    pub limit: Millis,
    /// The grip that it waits for before its dwell, if any.
    pub until: Option<UntilHolding>,
}

/// Poses one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence {
    /// To find it.
    pub id: SequenceId,
    /// No two sequences of a library have the same.
    pub name: String,
    /// The same in Chinese; empty if there is none.
    pub name_zh: String,
    /// The key that, with Shift, starts it.
    pub key: Option<EntryKey>,
    /// Whether the first step follows the last.
    pub looped: bool,
    /// In order.
    pub steps: Vec<SequenceStep>,
    /// Keys of a newer version, kept as they are.
    pub others: toml::Table,
}

/// The hand rests in one pose; a finger whose tip is touched goes to where another pose has it, and back once it is let go.
#[derive(Debug, Clone, PartialEq)]
pub struct Reaction {
    /// To find it.
    pub id: ReactionId,
    /// No two reactions of a library have the same.
    pub name: String,
    /// The same in Chinese; empty if there is none.
    pub name_zh: String,
    /// The key that, with Shift, starts it.
    pub key: Option<EntryKey>,
    /// Where a finger is that nobody touches.
    pub rest: PoseId,
    /// Where a touched finger goes.
    pub touched: PoseId,
    /// Normal force from which a fingertip counts as touched, beyond what it felt at the start.
    pub threshold: TouchForce,
    /// Keys of a newer version, kept as they are.
    pub others: toml::Table,
}

/// All poses and sequences, in the user's order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PoseLibrary {
    pub poses: Vec<LibraryPose>,
    /// The sequences. Their steps name poses of this library only.
    pub sequences: Vec<Sequence>,
    /// The reactions. They name poses of this library only.
    pub reactions: Vec<Reaction>,
    /// Keys of a newer version, kept as they are.
    pub others: toml::Table,
    next: u64,
}

impl PoseLibrary {
    /// The pose with this id.
    pub fn pose(&self, id: PoseId) -> Option<&LibraryPose> {
        self.poses.iter().find(|pose| pose.id == id)
    }

    /// The place of a pose among all, 0 the first.
    pub fn place(&self, id: PoseId) -> Option<usize> {
        self.poses.iter().position(|pose| pose.id == id)
    }

    /// The pose with this name.
    pub fn pose_named(&self, name: &str) -> Option<&LibraryPose> {
        self.poses.iter().find(|pose| pose.name == name)
    }

    /// The sequence with this id.
    pub fn sequence(&self, id: SequenceId) -> Option<&Sequence> {
        self.sequences.iter().find(|sequence| sequence.id == id)
    }

    /// The reaction with this id.
    pub fn reaction(&self, id: ReactionId) -> Option<&Reaction> {
        self.reactions.iter().find(|reaction| reaction.id == id)
    }

    /// All of it: poses, sequences, reactions.
    pub fn entries(&self) -> impl Iterator<Item = EntryId> {
        let poses = self.poses.iter().map(|own| EntryId::Pose(own.id));
        let sequences = self.sequences.iter();
        let sequences = sequences.map(|own| EntryId::Sequence(own.id));
        let reactions = self.reactions.iter();
        let reactions = reactions.map(|own| EntryId::Reaction(own.id));
        poses.chain(sequences).chain(reactions)
    }

    /// What an entry is called; `None` if it is not in this library.
    pub fn named(&self, entry: EntryId) -> Option<EntryNames<'_>> {
        let (text, zh, key) = match entry {
            EntryId::Pose(id) => {
                let own = self.pose(id)?;
                (&own.name, &own.name_zh, own.key)
            }
            EntryId::Sequence(id) => {
                let own = self.sequence(id)?;
                (&own.name, &own.name_zh, own.key)
            }
            EntryId::Reaction(id) => {
                let own = self.reaction(id)?;
                (&own.name, &own.name_zh, own.key)
            }
        };
        Some(EntryNames { text, zh, key })
    }

    /// True if there is nothing in it.
    pub const fn is_empty(&self) -> bool {
        self.poses.is_empty() && self.sequences.is_empty() && self.reactions.is_empty()
    }

    /// An empty library whose ids begin after this number, so that no other library has them.
    pub(crate) fn numbered_after(number: u64) -> Self {
        Self {
            next: number,
            ..Self::default()
        }
    }

    /// A number that nothing in this library has.
    pub(crate) const fn fresh(&mut self) -> u64 {
        self.next += 1;
        self.next
    }
}

/// A name as it is kept: one line, cut at [`NAME_CHARS_MAX`] characters. Empty if nothing is left.
pub fn clean(name: &str) -> String {
    let line = name.chars().map(|c| if c.is_control() { ' ' } else { c });
    let line: String = line.collect();
    let cut: String = line.trim().chars().take(NAME_CHARS_MAX).collect();
    cut.trim_end().to_owned()
}

/// `wanted`, or the first of "wanted 2", "wanted 3", … that is not taken.
pub fn free_name(wanted: &str, is_taken: impl Fn(&str) -> bool) -> String {
    if !is_taken(wanted) {
        return wanted.to_owned();
    }
    let room = NAME_CHARS_MAX - 4;
    let short: String = wanted.chars().take(room).collect();
    let numbered = (2..=2 * ENTRIES_MAX).map(|number| format!("{} {number}", short.trim_end()));
    let mut free = numbered.filter(|name| !is_taken(name));
    free.next().unwrap_or_else(|| wanted.to_owned())
}
