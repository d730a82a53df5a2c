//! Poses and sequences as plain values. Edits are in `edit`, the file format in `file`.

use crate::hand::gap::Gap;
use crate::hand::grip::GripThresholds;
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Force, PerDof, Speed};
use crate::poses::reaction::TouchForce;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Maximum number of poses, of sequences and of reactions: more than the user can find again.
pub const ENTRIES_MAX: usize = 500;
/// Maximum number of steps in a sequence.
pub const STEPS_MAX: usize = 200;
/// Maximum length of a name or tag, characters: the width of a tile.
pub const NAME_CHARS_MAX: usize = 32;
/// Tag of poses needed only by demos.
pub const DEMO: &str = "demo";
/// Maximum number of tags per pose.
pub const TAGS_MAX: usize = 8;

/// Id of a pose while the program runs; files use its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PoseId(pub u64);

/// Id of a sequence while the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SequenceId(pub u64);

/// Id of a reaction while the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ReactionId(pub u64);

/// Id of an entry.
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

/// Key that, with Shift, starts an entry: a letter that has no other meaning with Shift, or a digit from 1 on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct EntryKey(char);

/// A text that is not a valid key.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{got}\" is not a letter from A to Z but A, C, H, O and T, or a digit from 1 to 9")]
pub struct BadKey {
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

/// Names of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EntryNames<'a> {
    /// English, or the user's own text.
    pub text: &'a str,
    /// Chinese; empty if there is none.
    pub zh: &'a str,
    /// Key that, with Shift, starts it.
    pub key: Option<EntryKey>,
}

/// A time in milliseconds, 0 to ten minutes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "i64", into = "i64")]
pub struct Millis(u32);

/// A time outside the range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{got} ms is outside 0 to {}", Millis::MAX)]
pub struct BadTime {
    pub got: i64,
}

impl Millis {
    /// Longest time: ten minutes.
    pub const MAX: u32 = 600_000;
    /// Default dwell of a step.
    pub const DWELL: Self = Self(500);
    /// Default time limit of a step: the full stroke at a gentle speed takes 3 s.
    pub const LIMIT: Self = Self(5000);

    pub const fn get(self) -> u32 {
        self.0
    }

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

/// Retries of a step that closed on nothing, 0 to 20: the hand opens and closes again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(try_from = "i64", into = "i64")]
pub struct Retries(u8);

/// A number of retries outside the range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{got} retries is outside 0 to {}", Retries::MAX)]
pub struct BadRetries {
    pub got: i64,
}

impl Retries {
    /// After this many retries, the object is not where the hand closes.
    pub const MAX: u8 = 20;

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

/// Condition of a step that ends once the hand holds something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UntilHolding {
    /// The sequence ends if nothing is held this long after the pose counts as reached.
    pub within: Millis,
    /// Number of times the hand opens and closes again if it closed on nothing.
    pub retries: Retries,
}

impl UntilHolding {
    /// The default condition.
    pub const FIRST: Self = Self {
        within: Millis(3000),
        retries: Retries(0),
    };
}

/// Six named angles, and the limits for reaching them.
#[derive(Debug, Clone, PartialEq)]
pub struct LibraryPose {
    pub id: PoseId,
    /// Unique among the poses of a library.
    pub name: String,
    /// Chinese name; empty if there is none.
    pub name_zh: String,
    /// Key that, with Shift, recalls it.
    pub key: Option<EntryKey>,
    /// Search terms.
    pub tags: Vec<String>,
    /// Targets of the joints, 0 bent to 1000 open.
    pub angles: PerDof<Angle>,
    /// Gap of a pose by size. Its angles are those of the gap, and thumb and index move along the path on which they meet.
    pub gap: Option<Gap>,
    /// Grip detection thresholds while this pose is the last one commanded; `None` for the defaults.
    pub thresholds: Option<GripThresholds>,
    /// Joints that stay where they are although they have an angle.
    pub leave: PerDof<bool>,
    /// Speed of the joints that move.
    pub speed: Speed,
    /// Force threshold of the joints that move.
    pub force: Force,
    /// Forces of the hold in which it ends; `None` for none.
    pub hold: Option<HoldForces>,
    /// Keys of a newer version, preserved.
    pub others: toml::Table,
}

impl LibraryPose {
    /// True if only demos need it; it is then not listed by itself.
    pub fn is_for_demos(&self) -> bool {
        self.tags.iter().any(|tag| tag == DEMO)
    }

    /// True if its names or tags contain this text, which is in lower case. An empty text always matches.
    pub fn has(&self, words: &str) -> bool {
        let names = [&self.name, &self.name_zh];
        let names = names.into_iter().chain(&self.tags);
        let mut names = names.map(|name| name.to_lowercase());
        names.any(|name| name.contains(words))
    }

    /// Turns it into a pose by size, or with `None` back into a pose of angles. Thumb and index of a pose by size always move.
    pub fn set_gap(&mut self, gap: Option<Gap>) {
        self.gap = gap;
        if let Some(gap) = gap {
            self.angles = gap.angles();
            for dof in Gap::JOINTS {
                self.leave[dof] = false;
            }
        }
    }

    /// Targets of the joints; `None` for those that stay where they are.
    pub fn targets(&self) -> PerDof<Option<Angle>> {
        PerDof::from_fn(|dof| (!self.leave[dof]).then_some(self.angles[dof]))
    }
}

/// Goal of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepGoal {
    /// A pose of the library.
    Pose(PoseId),
    /// A gap between the pads of thumb and index; an object between them is gripped.
    Gap {
        gap: Gap,
        /// Force threshold of the joints.
        force: Force,
    },
    /// What the hand holds, held between these forces.
    Hold(HoldForces),
}

impl StepGoal {
    /// True for this pose.
    pub fn is_pose(self, id: PoseId) -> bool {
        self == Self::Pose(id)
    }
}

/// One step: a pose, a grip by size, or a hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SequenceStep {
    pub goal: StepGoal,
    /// Speed of the motion; the pose's own speed applies when it is recalled alone.
    pub speed: Speed,
    /// Time at the pose, or of the hold, before the next step.
    pub dwell: Millis,
    /// A pose not reached after this time counts as reached.
    pub limit: Millis,
    /// The grip to wait for before the dwell; `None` for none.
    pub until: Option<UntilHolding>,
    /// Forces of the hold in which a pose or a grip by size ends, which then waits for no other grip; `None` for those of the pose, if
    /// it has any.
    pub hold: Option<HoldForces>,
}

/// Poses played in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence {
    pub id: SequenceId,
    /// Unique among the sequences of a library.
    pub name: String,
    /// Chinese name; empty if there is none.
    pub name_zh: String,
    /// Key that, with Shift, starts it.
    pub key: Option<EntryKey>,
    /// True if it repeats.
    pub looped: bool,
    pub steps: Vec<SequenceStep>,
    /// Keys of a newer version, preserved.
    pub others: toml::Table,
}

/// The hand rests in one pose; a finger whose tip is touched moves to its angle in another pose, and back once released.
#[derive(Debug, Clone, PartialEq)]
pub struct Reaction {
    pub id: ReactionId,
    /// Unique among the reactions of a library.
    pub name: String,
    /// Chinese name; empty if there is none.
    pub name_zh: String,
    /// Key that, with Shift, starts it.
    pub key: Option<EntryKey>,
    /// Pose of untouched fingers.
    pub rest: PoseId,
    /// Pose of touched fingers.
    pub touched: PoseId,
    /// Normal force from which a fingertip counts as touched, above its reading at the start.
    pub threshold: TouchForce,
    /// Keys of a newer version, preserved.
    pub others: toml::Table,
}

/// All poses, sequences and reactions, in the user's order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PoseLibrary {
    pub poses: Vec<LibraryPose>,
    /// Their steps name poses of this library only.
    pub sequences: Vec<Sequence>,
    /// They name poses of this library only.
    pub reactions: Vec<Reaction>,
    /// Keys of a newer version, preserved.
    pub others: toml::Table,
    next: u64,
}

impl PoseLibrary {
    pub fn pose(&self, id: PoseId) -> Option<&LibraryPose> {
        self.poses.iter().find(|pose| pose.id == id)
    }

    /// The position of a pose, from 0.
    pub fn place(&self, id: PoseId) -> Option<usize> {
        self.poses.iter().position(|pose| pose.id == id)
    }

    pub fn pose_named(&self, name: &str) -> Option<&LibraryPose> {
        self.poses.iter().find(|pose| pose.name == name)
    }

    pub fn sequence(&self, id: SequenceId) -> Option<&Sequence> {
        self.sequences.iter().find(|sequence| sequence.id == id)
    }

    pub fn reaction(&self, id: ReactionId) -> Option<&Reaction> {
        self.reactions.iter().find(|reaction| reaction.id == id)
    }

    /// All entries: poses, sequences, reactions.
    pub fn entries(&self) -> impl Iterator<Item = EntryId> {
        let poses = self.poses.iter().map(|own| EntryId::Pose(own.id));
        let sequences = self.sequences.iter();
        let sequences = sequences.map(|own| EntryId::Sequence(own.id));
        let reactions = self.reactions.iter();
        let reactions = reactions.map(|own| EntryId::Reaction(own.id));
        poses.chain(sequences).chain(reactions)
    }

    /// The names of an entry; `None` if it is not in this library.
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

    pub const fn is_empty(&self) -> bool {
        self.poses.is_empty() && self.sequences.is_empty() && self.reactions.is_empty()
    }

    /// An empty library whose ids begin after this number, so that they differ from those of any other library.
    pub(crate) fn numbered_after(number: u64) -> Self {
        Self {
            next: number,
            ..Self::default()
        }
    }

    /// A new id.
    pub(crate) const fn fresh(&mut self) -> u64 {
        self.next += 1;
        self.next
    }
}

/// Normalizes a name: one line, trimmed and cut at [`NAME_CHARS_MAX`] characters. May be empty.
pub fn clean(name: &str) -> String {
    let line = name.chars().map(|c| if c.is_control() { ' ' } else { c });
    let line: String = line.collect();
    let cut: String = line.trim().chars().take(NAME_CHARS_MAX).collect();
    cut.trim_end().to_owned()
}

/// `wanted`, or the first free one of "wanted 2", "wanted 3", …
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
