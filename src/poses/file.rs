//! The library as TOML, version 1 (assets/manual/files.md). A file is accepted as a whole or rejected; unknown keys are preserved.

use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::poses::grip_row::{GripRow, ThresholdsRow, read_thresholds, thresholds_row, unplaced};
use crate::poses::library::{
    ENTRIES_MAX, EntryKey, LibraryPose, Millis, NAME_CHARS_MAX, PoseId, PoseLibrary, Reaction,
    ReactionId, Retries, STEPS_MAX, Sequence, SequenceId, SequenceStep, StepGoal, TAGS_MAX,
    UntilHolding, clean,
};
use crate::poses::reaction::TouchForce;
use crate::store::toml_file::VERSION;
use crate::store::{FileCause, FileError, FileText};
use serde::{Deserialize, Serialize};
use toml::Spanned;

/// The `format` value of a pose file.
pub const FORMAT: &str = "handscope-poses";
#[derive(Serialize, Deserialize)]
struct FileRow {
    format: String,
    version: i64,
    #[serde(default, rename = "pose")]
    poses: Vec<PoseRow>,
    #[serde(default, rename = "sequence")]
    sequences: Vec<SequenceRow>,
    #[serde(default, rename = "reaction", skip_serializing_if = "Vec::is_empty")]
    reactions: Vec<ReactionRow>,
    #[serde(flatten)]
    others: toml::Table,
}

#[derive(Serialize, Deserialize)]
struct PoseRow {
    name: Spanned<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name_zh: Option<Spanned<String>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    key: Option<EntryKey>,
    #[serde(default)]
    tags: Vec<String>,
    speed: Speed,
    force: Force,
    #[serde(default)]
    leave: Option<Spanned<Vec<Dof>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    angles: Option<AnglesRow>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    grip: Option<GripRow>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    grip_thresholds: Option<ThresholdsRow>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hold: Option<HoldForces>,
    #[serde(flatten)]
    others: toml::Table,
}

/// Exactly six joints; a pose of another hand is rejected.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AnglesRow {
    little: Angle,
    ring: Angle,
    middle: Angle,
    index: Angle,
    thumb_bend: Angle,
    thumb_rotate: Angle,
}

#[derive(Serialize, Deserialize)]
struct SequenceRow {
    name: Spanned<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name_zh: Option<Spanned<String>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    key: Option<EntryKey>,
    #[serde(default, rename = "loop")]
    looped: bool,
    #[serde(default, rename = "step")]
    steps: Vec<Spanned<StepRow>>,
    #[serde(flatten)]
    others: toml::Table,
}

/// A step goes to a pose, or to a grip by size with its force, or holds what the hand has. Unknown keys are rejected, since ignoring one would change the step.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StepRow {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pose: Option<Spanned<String>>,
    speed: Speed,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    force: Option<Force>,
    dwell_ms: Millis,
    limit_ms: Millis,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    grip: Option<GripRow>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    until: Option<UntilRow>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hold: Option<HoldForces>,
}

/// Condition that ends a step. Unknown grips are rejected, since a step that does not wait is a different one.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct UntilRow {
    grip: WaitedGrip,
    within_ms: Millis,
    #[serde(default)]
    retries: Retries,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum WaitedGrip {
    Holding,
}

#[derive(Serialize, Deserialize)]
struct ReactionRow {
    name: Spanned<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name_zh: Option<Spanned<String>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    key: Option<EntryKey>,
    rest: Spanned<String>,
    touched: Spanned<String>,
    threshold_n: TouchForce,
    #[serde(flatten)]
    others: toml::Table,
}

/// The library as TOML text.
///
/// # Errors
/// An error of the TOML writer; a library built by this program never causes one.
pub fn write(library: &PoseLibrary) -> Result<String, toml::ser::Error> {
    let poses = library.poses.iter().map(pose_row).collect();
    let sequences = library.sequences.iter();
    let sequences = sequences.map(|sequence| sequence_row(library, sequence));
    let reactions = library.reactions.iter();
    let reactions = reactions.filter_map(|reaction| reaction_row(library, reaction));
    toml::to_string(&FileRow {
        format: FORMAT.into(),
        version: VERSION,
        poses,
        sequences: sequences.collect(),
        reactions: reactions.collect(),
        others: library.others.clone(),
    })
}

fn pose_row(pose: &LibraryPose) -> PoseRow {
    let angles = &pose.angles;
    let left = Dof::ALL.into_iter().filter(|dof| pose.leave[*dof]);
    PoseRow {
        name: unplaced(pose.name.clone()),
        name_zh: chinese(&pose.name_zh),
        key: pose.key,
        tags: pose.tags.clone(),
        speed: pose.speed,
        force: pose.force,
        leave: Some(unplaced(left.collect())),
        angles: pose.gap.is_none().then(|| AnglesRow {
            little: angles[Dof::Little],
            ring: angles[Dof::Ring],
            middle: angles[Dof::Middle],
            index: angles[Dof::Index],
            thumb_bend: angles[Dof::ThumbBend],
            thumb_rotate: angles[Dof::ThumbRotate],
        }),
        grip: pose.gap.map(GripRow::of),
        grip_thresholds: pose.thresholds.as_ref().map(thresholds_row),
        hold: pose.hold,
        others: pose.others.clone(),
    }
}

fn sequence_row(library: &PoseLibrary, sequence: &Sequence) -> SequenceRow {
    let steps = sequence.steps.iter().filter_map(|step| {
        let (pose, gap, hold) = match step.goal {
            StepGoal::Pose(id) => {
                let name = library.pose(id)?.name.clone();
                (Some(unplaced(name)), None, step.hold)
            }
            StepGoal::Gap { gap, force } => (None, Some((gap, force)), step.hold),
            StepGoal::Hold(forces) => (None, None, Some(forces)),
        };
        Some(unplaced(StepRow {
            pose,
            speed: step.speed,
            force: gap.map(|(_, force)| force),
            dwell_ms: step.dwell,
            limit_ms: step.limit,
            until: step.until.map(|until| UntilRow {
                grip: WaitedGrip::Holding,
                within_ms: until.within,
                retries: until.retries,
            }),
            grip: gap.map(|(gap, _)| GripRow::of(gap)),
            hold,
        }))
    });
    SequenceRow {
        name: unplaced(sequence.name.clone()),
        name_zh: chinese(&sequence.name_zh),
        key: sequence.key,
        looped: sequence.looped,
        steps: steps.collect(),
        others: sequence.others.clone(),
    }
}

fn reaction_row(library: &PoseLibrary, reaction: &Reaction) -> Option<ReactionRow> {
    let name = |pose| Some(unplaced(library.pose(pose)?.name.clone()));
    Some(ReactionRow {
        name: unplaced(reaction.name.clone()),
        name_zh: chinese(&reaction.name_zh),
        key: reaction.key,
        rest: name(reaction.rest)?,
        touched: name(reaction.touched)?,
        threshold_n: reaction.threshold,
        others: reaction.others.clone(),
    })
}

fn chinese(name: &str) -> Option<Spanned<String>> {
    (!name.is_empty()).then(|| unplaced(name.to_owned()))
}

/// Parses a library.
///
/// # Errors
/// [`FileError`] with line and field; a bad text is rejected as a whole.
pub fn read(text: &str) -> Result<PoseLibrary, FileError> {
    read_into(PoseLibrary::default(), text)
}

/// As [`read`], into an empty library with its own numbering of entries.
pub(crate) fn read_into(empty: PoseLibrary, text: &str) -> Result<PoseLibrary, FileError> {
    let source = FileText::of(text, FORMAT)?;
    PoseReader(source).library(empty, source.parse()?)
}

/// Builds a library from a parsed text.
#[derive(Clone, Copy)]
struct PoseReader<'a>(FileText<'a>);

impl PoseReader<'_> {
    fn library(self, mut library: PoseLibrary, file: FileRow) -> Result<PoseLibrary, FileError> {
        few(file.poses.len(), ENTRIES_MAX)?;
        few(file.sequences.len(), ENTRIES_MAX)?;
        few(file.reactions.len(), ENTRIES_MAX)?;
        library.others = file.others;
        for row in file.poses {
            self.pose(&mut library, row)?;
        }
        for row in file.sequences {
            self.sequence(&mut library, row)?;
        }
        for row in file.reactions {
            self.reaction(&mut library, row)?;
        }
        Ok(library)
    }

    fn name(self, name: &Spanned<String>, taken: bool) -> Result<String, FileError> {
        let text = name.get_ref().clone();
        if text.is_empty() || clean(&text) != text {
            return Err(self.0.blame(name.span(), "name", bad_name(&text)));
        }
        if taken {
            let cause = FileCause::Twice { name: text };
            return Err(self.0.blame(name.span(), "name", cause));
        }
        Ok(text)
    }

    fn chinese(self, name: Option<&Spanned<String>>) -> Result<String, FileError> {
        let Some(name) = name else {
            return Ok(String::new());
        };
        let text = name.get_ref();
        if text.is_empty() || clean(text) != *text {
            Err(self.0.blame(name.span(), "name_zh", bad_name(text)))
        } else {
            Ok(text.clone())
        }
    }

    fn pose(self, library: &mut PoseLibrary, row: PoseRow) -> Result<(), FileError> {
        let name = self.name(&row.name, library.pose_named(row.name.get_ref()).is_some())?;
        few(row.tags.len(), TAGS_MAX)?;
        if let Some(bad) = row
            .tags
            .iter()
            .find(|tag| tag.is_empty() || clean(tag) != **tag)
        {
            return Err(self.0.blame(row.name.span(), "tags", bad_name(bad)));
        }
        let gap = row
            .grip
            .as_ref()
            .map(|grip| grip.read(self.0))
            .transpose()?;
        let angles = match (row.angles, gap) {
            (Some(angles), None) => angles.all(),
            (None, Some(gap)) => gap.angles(),
            (None, None) => {
                return Err(self.0.blame(row.name.span(), "angles", FileCause::Missing));
            }
            (Some(_), Some(_)) => {
                let cause = FileCause::Both { other: "angles" };
                return Err(self.0.blame(row.name.span(), "grip", cause));
            }
        };
        let leave = self.left(row.leave, gap)?;
        let thresholds = row.grip_thresholds.as_ref();
        let thresholds = thresholds.map(|row| read_thresholds(row, self.0));
        let id = PoseId(library.fresh());
        library.poses.push(LibraryPose {
            id,
            name,
            name_zh: self.chinese(row.name_zh.as_ref())?,
            key: row.key,
            tags: row.tags,
            angles,
            gap,
            thresholds: thresholds.transpose()?,
            leave: PerDof::from_fn(|dof| leave.contains(&dof)),
            speed: row.speed,
            force: row.force,
            hold: row.hold,
            others: row.others,
        });
        Ok(())
    }

    /// The joints that stay where they are; a grip by size cannot leave out thumb or index.
    fn left(self, row: Option<Spanned<Vec<Dof>>>, gap: Option<Gap>) -> Result<Vec<Dof>, FileError> {
        let Some(row) = row else {
            return Ok(Vec::new());
        };
        let left = row.get_ref().iter();
        let bad = left
            .clone()
            .find(|dof| gap.is_some() && Gap::JOINTS.contains(dof));
        if let Some(dof) = bad {
            let cause = FileCause::Pinches { dof: *dof };
            return Err(self.0.blame(row.span(), "leave", cause));
        }
        Ok(row.into_inner())
    }

    fn sequence(self, library: &mut PoseLibrary, row: SequenceRow) -> Result<(), FileError> {
        let mut known = library.sequences.iter();
        let taken = known.any(|sequence| sequence.name == *row.name.get_ref());
        let name = self.name(&row.name, taken)?;
        few(row.steps.len(), STEPS_MAX)?;
        let steps = row.steps.into_iter().map(|step| self.step(library, step));
        let steps = steps.collect::<Result<Vec<SequenceStep>, FileError>>()?;
        let id = SequenceId(library.fresh());
        library.sequences.push(Sequence {
            id,
            name,
            name_zh: self.chinese(row.name_zh.as_ref())?,
            key: row.key,
            looped: row.looped,
            steps,
            others: row.others,
        });
        Ok(())
    }

    fn reaction(self, library: &mut PoseLibrary, row: ReactionRow) -> Result<(), FileError> {
        let mut known = library.reactions.iter();
        let taken = known.any(|reaction| reaction.name == *row.name.get_ref());
        let name = self.name(&row.name, taken)?;
        let id = ReactionId(library.fresh());
        library.reactions.push(Reaction {
            id,
            name,
            name_zh: self.chinese(row.name_zh.as_ref())?,
            key: row.key,
            rest: self.named(library, "rest", &row.rest)?,
            touched: self.named(library, "touched", &row.touched)?,
            threshold: row.threshold_n,
            others: row.others,
        });
        Ok(())
    }

    /// The pose with this name, which a field of the file refers to.
    fn named(
        self,
        library: &PoseLibrary,
        field: &str,
        name: &Spanned<String>,
    ) -> Result<PoseId, FileError> {
        let Some(pose) = library.pose_named(name.get_ref()) else {
            let cause = FileCause::Absent {
                name: name.get_ref().chars().take(40).collect(),
            };
            return Err(self.0.blame(name.span(), field, cause));
        };
        Ok(pose.id)
    }

    fn step(self, library: &PoseLibrary, row: Spanned<StepRow>) -> Result<SequenceStep, FileError> {
        let (place, row) = (row.span(), row.into_inner());
        let gap = row
            .grip
            .as_ref()
            .map(|grip| grip.read(self.0))
            .transpose()?;
        let wrong = |field, cause| Err(self.0.blame(place, field, cause));
        let goal = match (&row.pose, gap, row.force) {
            (Some(name), None, None) => StepGoal::Pose(self.named(library, "pose", name)?),
            (None, Some(gap), Some(force)) => StepGoal::Gap { gap, force },
            (Some(_), Some(_), _) => return wrong("grip", FileCause::Both { other: "pose" }),
            (Some(_), None, Some(_)) => return wrong("force", FileCause::Both { other: "pose" }),
            (None, Some(_), None) => return wrong("force", FileCause::Missing),
            (None, None, Some(_)) if row.hold.is_some() => {
                return wrong("force", FileCause::Both { other: "hold" });
            }
            (None, None, None) if let Some(forces) = row.hold => StepGoal::Hold(forces),
            (None, None, _) => return wrong("pose", FileCause::Missing),
        };
        if row.hold.is_some() && row.until.is_some() {
            return wrong("until", FileCause::Both { other: "hold" });
        }
        let is_hold = matches!(goal, StepGoal::Hold(_));
        Ok(SequenceStep {
            goal,
            speed: row.speed,
            dwell: row.dwell_ms,
            limit: row.limit_ms,
            until: row.until.map(|until| match until.grip {
                WaitedGrip::Holding => UntilHolding {
                    within: until.within_ms,
                    retries: until.retries,
                },
            }),
            hold: row.hold.filter(|_| !is_hold),
        })
    }
}

impl AnglesRow {
    const fn all(&self) -> PerDof<Angle> {
        PerDof::new([
            self.little,
            self.ring,
            self.middle,
            self.index,
            self.thumb_bend,
            self.thumb_rotate,
        ])
    }
}

fn bad_name(name: &str) -> FileCause {
    let start: String = name.chars().take(40).collect();
    FileCause::Value {
        got: format!("\"{start}\""),
        allowed: format!("a name of 1 to {NAME_CHARS_MAX} characters on one line"),
    }
}

fn few(got: usize, limit: usize) -> Result<(), FileError> {
    if got > limit {
        return Err(FileCause::TooMany { got, limit }.into());
    }
    Ok(())
}
