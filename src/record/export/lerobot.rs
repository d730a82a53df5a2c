//! Recordings as a LeRobot v3.0 data set without video: frames at an even rate, each with the newest reading before its time.
//! Missing values are never filled in: a silence ends the episode.

use crate::hand::grip::GripState;
use crate::hand::kinematics::Side;
use crate::hand::{Dof, Moment};
use crate::record::EventKind;
use crate::record::export::columns::{self, ParquetCell, ParquetColumn, Values};
use crate::record::export::frames::{
    DatasetFrame, DatasetFrames, FrameExtras, FramePlan, frame_parts, has_touch,
};
use crate::record::export::output::{
    Destination, EpisodeCounts, ExportError, ExportSummary, Exported, Sink, Unfinished,
};
use crate::record::export::source::{Broken, ExportSource};
use crate::record::export::statistics::Statistics;
use crate::record::export::unfollowed::UnfollowedMotion;
use crate::record::file::RecordingFile;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde_json::{Map, Value, json};
use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

/// Default frame rate in frames per second; typical for cameras.
const FPS: u32 = 30;
/// Maximum number of frames of an episode in memory: half an hour at 30 a second. A longer one is written as several row groups.
const GROUP_FRAMES: u64 = 65_536;
/// Path of each kind's only file; LeRobot numbers files with three digits.
const FILE: &str = "chunk-000/file-000.parquet";
/// Warning in the metadata of a set with read-back actions.
const READ_BACK: &str = "in action_read_back_frames frames a target was set by something other than the writes of the recording: another controller, or the hand itself for a gesture; the action is what the hand held when it was read, up to half a second late";
/// Warning in the metadata of a set with episodes without a command.
const UNCOMMANDED: &str = "in episodes without action_commanded_frames no joint was commanded: the action there is what the hand held before, and says nothing about what moved it";
/// Warning in the metadata of a set with joints that move by themselves.
const UNFOLLOWED: &str = "in action_unfollowed_frames frames a joint of action_unfollowed_joints has moved away from an action that stands still: something moved it that the recording does not show";
/// Default task of a hand.
const TASK: &str = "grasp";

/// Start of an episode. A silence ends it in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EpisodeStart {
    /// At the start of a recording, and after each silence.
    Gap,
    /// At each note by the user; frames before the first are omitted.
    Note,
}

/// Options of the data set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeRobotPlan {
    /// Frames per second.
    pub fps: u32,
    /// The hand's task; `None` if the note at the start of an episode names it.
    pub task: Option<String>,
    pub episodes: EpisodeStart,
    /// True if a set in which no joint was commanded is written nevertheless.
    pub uncommanded: bool,
}

impl Default for LeRobotPlan {
    fn default() -> Self {
        Self {
            fps: FPS,
            task: None,
            episodes: EpisodeStart::Gap,
            uncommanded: false,
        }
    }
}

/// Writes time ranges of recordings as one folder.
///
/// # Errors
/// [`ExportError`]; then there is no folder.
pub(crate) fn write(
    sources: &[ExportSource<'_>],
    to: &Destination,
    plan: &LeRobotPlan,
) -> Result<ExportSummary, ExportError> {
    let mut sides = sources.iter().map(|source| source.file.opening().side);
    let side = sides.next().unwrap_or(Side::Right);
    if sides.any(|other| other != side) {
        return Err(ExportError::BothSides);
    }
    let output = Unfinished::new(to)?;
    let folder = output.folder()?.to_owned();
    let error = |error: io::Error| output.error(&error);
    for part in ["data/chunk-000", "meta/episodes/chunk-000"] {
        fs::create_dir_all(folder.join(part)).map_err(error)?;
    }
    let data = folder.join("data").join(FILE);
    let data = Sink::File(File::create_new(data).map_err(error)?);
    let is_known = |dof: &Dof| {
        let known = |source: &ExportSource<'_>| source.file.opening().newtons_per_g[*dof];
        sources.iter().all(|source| known(source).is_some())
    };
    let extras = FrameExtras {
        with_touch: sources.iter().all(|source| has_touch(source.file)),
        in_newtons: Dof::ALL.into_iter().filter(is_known).collect(),
    };
    let set = DataSet::new(BufWriter::new(data), extras.clone());
    let mut set = set.map_err(|error| output.parquet_error(error))?;
    let mut recordings = Vec::new();
    for (number, source) in sources.iter().enumerate() {
        set.recording = number;
        let recording = add(&mut set, source, plan).map_err(|error| error.of(&output))?;
        recordings.push(recording);
    }
    let ended = set.end().map_err(|error| output.parquet_error(error))?;
    if ended.index == 0 {
        let has_note = sources.iter().any(|source| !notes(source).is_empty());
        return Err(match plan.episodes {
            EpisodeStart::Note if !has_note => ExportError::NoNotes,
            _ => ExportError::Empty,
        });
    }
    let counts = ended.counts();
    if counts.uncommanded == counts.episodes && !plan.uncommanded {
        return Err(ExportError::NeverCommanded);
    }
    let meta = Meta {
        sources,
        side,
        extras,
        plan,
        ended: &ended,
    };
    meta.write(&folder.join("meta")).map_err(error)?;
    output.sync(ended.data)?;
    output.finish(ended.index)?;
    Ok(ExportSummary {
        recordings,
        episodes: Some(counts),
    })
}

/// Adds the frames of one recording. It is read from its start, because earlier commands are still in effect in the range.
fn add(
    set: &mut DataSet,
    source: &ExportSource<'_>,
    plan: &LeRobotPlan,
) -> Result<Exported, Broken> {
    let mut frames = DatasetFrames::new(FramePlan {
        fps: plan.fps,
        with_touch: set.extras.with_touch,
        newtons_per_g: {
            let newtons = source.file.opening().newtons();
            newtons
                .filter(|(dof, _)| set.extras.in_newtons.contains(dof))
                .collect()
        },
        from: source.stretch.from,
        notes: match plan.episodes {
            EpisodeStart::Gap => None,
            EpisodeStart::Note => Some(notes(source)),
        },
    });
    let mut whole = source.without_wire();
    whole.stretch.from = Moment::ZERO;
    let before = set.index;
    let damage = whole.entries(|entry| {
        let mut done = Ok(());
        frames.apply(&entry, |frame| {
            if done.is_ok() {
                done = set.frame(frame, source.file.first(), plan);
            }
        });
        Ok(done?)
    })?;
    Ok(Exported {
        rows: set.index - before,
        readings: None,
        damage,
    })
}

/// The user's notes in the time range.
fn notes(source: &ExportSource<'_>) -> VecDeque<(Moment, Arc<str>)> {
    let within = source.stretch.from..=source.stretch.to;
    let marks = source.file.overview().marks.iter();
    let notes = marks.filter(|mark| mark.kind == EventKind::Note && within.contains(&mark.at));
    notes
        .map(|mark| (mark.at, mark.words.as_str().into()))
        .collect()
}

struct Episode {
    frames: u64,
    /// Index of its task.
    task: usize,
    /// Index of its recording, and its start within that, in seconds.
    recording: usize,
    from_s: f64,
    commanded: u64,
    read_back: u64,
    unfollowed: u64,
}

/// The frames being written.
struct DataSet {
    to: SerializedFileWriter<BufWriter<Sink>>,
    columns: Vec<ParquetColumn>,
    extras: FrameExtras,
    statistics: Statistics,
    tasks: Vec<String>,
    episodes: Vec<Episode>,
    unfollowed: UnfollowedMotion,
    /// Index of the recording being read.
    recording: usize,
    index: u64,
    waiting: u64,
}

/// Result of the written frames.
struct WrittenFrames {
    data: BufWriter<Sink>,
    statistics: Statistics,
    tasks: Vec<String>,
    episodes: Vec<Episode>,
    unfollowed: UnfollowedMotion,
    index: u64,
}

impl WrittenFrames {
    fn counts(&self) -> EpisodeCounts {
        let uncommanded = self.episodes.iter().filter(|one| one.commanded == 0);
        let number = |count: usize| u64::try_from(count).unwrap_or(u64::MAX);
        EpisodeCounts {
            episodes: number(self.episodes.len()),
            uncommanded: number(uncommanded.count()),
            read_back: self.episodes.iter().map(|one| one.read_back).sum(),
            unfollowed: self.episodes.iter().map(|one| one.unfollowed).sum(),
            unfollowed_joints: self.unfollowed.joints,
        }
    }
}

fn long(number: impl TryInto<i64>) -> ParquetCell {
    ParquetCell::Long(number.try_into().unwrap_or(i64::MAX))
}

impl DataSet {
    fn new(to: BufWriter<Sink>, extras: FrameExtras) -> Result<Self, ParquetError> {
        let parts = frame_parts(&extras);
        let list = |(name, width): &(&str, usize)| {
            ParquetColumn::new(*name, "", Values::Floats(*width, vec![]))
        };
        let mut columns: Vec<ParquetColumn> = parts.iter().map(list).collect();
        columns.push(ParquetColumn::new(
            "timestamp",
            "",
            Values::Float(Vec::new()),
        ));
        for name in ["frame_index", "episode_index", "index", "task_index"] {
            columns.push(ParquetColumn::new(name, "", Values::Long(Vec::new())));
        }
        Ok(Self {
            to: writer(to, &columns, Vec::new())?,
            columns,
            statistics: Statistics::new(parts.into_iter()),
            extras,
            tasks: Vec::new(),
            episodes: Vec::new(),
            unfollowed: UnfollowedMotion::new(),
            recording: 0,
            index: 0,
            waiting: 0,
        })
    }

    /// Adds a frame of a recording that began at `began`.
    fn frame(
        &mut self,
        frame: &DatasetFrame,
        began: Moment,
        plan: &LeRobotPlan,
    ) -> Result<(), ParquetError> {
        if frame.number == 0 {
            self.put()?;
            let note = frame.note.as_deref().filter(|note| !note.trim().is_empty());
            let task = plan.task.as_deref().or(note).unwrap_or(TASK);
            let task = self.task(task);
            self.episodes.push(Episode {
                frames: 0,
                task,
                recording: self.recording,
                from_s: frame.at.since(began).as_secs_f64(),
                commanded: 0,
                read_back: 0,
                unfollowed: 0,
            });
        } else if self.waiting >= GROUP_FRAMES {
            self.put()?;
        }
        let number = self.episodes.len().saturating_sub(1);
        let mut task = 0;
        if let Some(episode) = self.episodes.last_mut() {
            episode.frames += 1;
            episode.commanded += u64::from(frame.is_commanded);
            episode.read_back += u64::from(frame.is_read_back);
            episode.unfollowed += u64::from(self.unfollowed.apply(frame));
            task = episode.task;
        }
        let scalars = [
            ParquetCell::Float(frame.time_s),
            long(frame.number),
            long(number),
            long(self.index),
            long(task),
        ];
        let parts = frame.parts(self.extras.with_touch);
        let (lists, rest) = self.columns.split_at_mut(parts.len());
        for (column, values) in lists.iter_mut().zip(&parts) {
            column.push_list(values);
        }
        for (column, cell) in rest.iter_mut().zip(scalars) {
            column.push(cell);
        }
        self.statistics.push(&parts);
        self.index += 1;
        self.waiting += 1;
        Ok(())
    }

    /// Index of a task, which is added if it is new.
    fn task(&mut self, words: &str) -> usize {
        let known = self.tasks.iter().position(|task| task == words);
        known.unwrap_or_else(|| {
            self.tasks.push(words.to_owned());
            self.tasks.len() - 1
        })
    }

    fn put(&mut self) -> Result<(), ParquetError> {
        if self.waiting == 0 {
            return Ok(());
        }
        self.waiting = 0;
        let group = self.to.next_row_group()?;
        columns::put(&mut self.columns, group)
    }

    fn end(mut self) -> Result<WrittenFrames, ParquetError> {
        self.put()?;
        Ok(WrittenFrames {
            data: self.to.into_inner()?,
            statistics: self.statistics,
            tasks: self.tasks,
            episodes: self.episodes,
            unfollowed: self.unfollowed,
            index: self.index,
        })
    }
}

fn writer<W: Write + Send>(
    to: W,
    columns: &[ParquetColumn],
    metadata: Vec<KeyValue>,
) -> Result<SerializedFileWriter<W>, ParquetError> {
    let fields: Result<Vec<_>, _> = columns.iter().map(ParquetColumn::schema).collect();
    let schema = Type::group_type_builder("schema").with_fields(fields?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata((!metadata.is_empty()).then_some(metadata));
    SerializedFileWriter::new(to, Arc::new(schema.build()?), Arc::new(properties.build()))
}

/// Metadata files of the set.
struct Meta<'a> {
    sources: &'a [ExportSource<'a>],
    side: Side,
    extras: FrameExtras,
    plan: &'a LeRobotPlan,
    ended: &'a WrittenFrames,
}

impl Meta<'_> {
    fn write(&self, folder: &Path) -> io::Result<()> {
        let json = |name: &str, value: &Value| {
            let text = serde_json::to_string_pretty(value).map_err(io::Error::other)?;
            fs::write(folder.join(name), text)
        };
        json("info.json", &self.info())?;
        json("stats.json", &self.ended.statistics.json())?;
        let place = folder.join("episodes").join(FILE);
        let file = BufWriter::new(File::create_new(place)?);
        self.episodes(file).map_err(io::Error::other)?;
        let file = BufWriter::new(File::create_new(folder.join("tasks.parquet"))?);
        self.tasks(file).map_err(io::Error::other)
    }

    fn info(&self) -> Value {
        let episodes = self.ended.episodes.len();
        json!({
            "codebase_version": "v3.0",
            "robot_type": "ftp_tactile_hand",
            "total_episodes": episodes,
            "total_frames": self.ended.index,
            "total_tasks": self.ended.tasks.len(),
            "chunks_size": 1000,
            "data_files_size_in_mb": 100,
            "video_files_size_in_mb": 200,
            "fps": self.plan.fps,
            "splits": { "train": format!("0:{episodes}") },
            "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
            "video_path": null,
            "features": self.features(),
            "handscope": self.origin(),
        })
    }

    /// Origin of the set: the method and the recordings.
    fn origin(&self) -> Value {
        let recording = |file: &RecordingFile| {
            let opening = file.opening();
            json!({
                "file": file.path().file_name().unwrap_or_default().to_string_lossy(),
                "hand": opening.hand,
                "simulated": opening.simulated,
                "version": opening.version,
            })
        };
        let recordings = self.sources.iter().map(|source| recording(source.file));
        let episodes = &self.ended.episodes;
        let counts = self.ended.counts();
        let warnings = [
            (counts.uncommanded > 0, UNCOMMANDED),
            (counts.read_back > 0, READ_BACK),
            (counts.unfollowed > 0, UNFOLLOWED),
        ];
        let warnings = warnings.into_iter().filter(|(is_due, _)| *is_due);
        let warnings: Vec<&str> = warnings.map(|(_, words)| words).collect();
        let unfollowed = self.joints().into_iter().zip(Dof::ALL);
        let unfollowed = unfollowed.filter(|(_, dof)| counts.unfollowed_joints[*dof]);
        let unfollowed: Vec<String> = unfollowed.map(|(name, _)| name).collect();
        let mut origin = json!({
            "resampling": "each frame holds the newest reading received before its time",
            "gaps": "a silence of more than 0.5 s, or a value outside the manual's ranges, is not filled; it ends the episode",
            "action": "the newest target sent to each joint, stops and other programs' writes included; before the first, what the hand held (ANGLE_SET); the angle itself for a joint that was never commanded",
            "grip_states": GripState::ALL,
            "action_uncommanded_episodes": counts.uncommanded,
            "action_read_back_frames": counts.read_back,
            "action_unfollowed_frames": counts.unfollowed,
            "action_unfollowed_joints": unfollowed,
            "action_warning": (!warnings.is_empty()).then(|| warnings.join("; ")),
            "recordings": recordings.collect::<Vec<Value>>(),
            "episodes": episodes.iter().map(|episode| json!({
                "recording": episode.recording,
                "from_s": episode.from_s,
                "action_commanded_frames": episode.commanded,
                "action_read_back_frames": episode.read_back,
                "action_unfollowed_frames": episode.unfollowed,
            })).collect::<Vec<Value>>(),
        });
        if let (Some(first), Some(origin)) = (self.sources.first(), origin.as_object_mut())
            && let Value::Object(mut first) = recording(first.file)
        {
            first.remove("file");
            origin.append(&mut first);
        }
        origin
    }

    /// Start of the name of each joint and fingertip.
    const fn side(&self) -> &'static str {
        match self.side {
            Side::Left => "kLeftHand",
            Side::Right => "kRightHand",
        }
    }

    /// Names of the joints, in register order.
    fn joints(&self) -> [String; Dof::ALL.len()] {
        let side = self.side();
        [
            "Pinky",
            "Ring",
            "Middle",
            "Index",
            "ThumbBend",
            "ThumbRotation",
        ]
        .map(|joint| format!("{side}{joint}"))
    }

    fn features(&self) -> Value {
        let (side, joints) = (self.side(), self.joints());
        let tips = ["Pinky", "Ring", "Middle", "Index", "Thumb"];
        let tip = |what: &str| tips.map(|tip| format!("{side}{tip}{what}"));
        let touch = [tip("Normal"), tip("Tangential")].concat();
        let grip = [vec![format!("{side}Grip")], tip("Grip").to_vec()].concat();
        let mut environment = joints
            .each_ref()
            .map(|joint| format!("{joint}Force"))
            .to_vec();
        if self.extras.with_touch {
            environment.extend(touch.iter().cloned());
        }
        let in_newtons: Vec<String> = Dof::ALL
            .into_iter()
            .zip(joints.iter())
            .filter(|(dof, _)| self.extras.in_newtons.contains(dof))
            .map(|(_, joint)| joint.clone())
            .collect();
        let mut features = Map::new();
        for (part, width) in frame_parts(&self.extras) {
            let names = match part {
                "observation.environment_state" => environment.as_slice(),
                "observation.touch" => touch.as_slice(),
                "observation.force_n" => in_newtons.as_slice(),
                "observation.grip" => grip.as_slice(),
                _ => joints.as_slice(),
            };
            let feature = json!({ "dtype": "float32", "shape": [width], "names": names });
            features.insert(part.to_owned(), feature);
        }
        for (name, kind) in [
            ("timestamp", "float32"),
            ("frame_index", "int64"),
            ("episode_index", "int64"),
            ("index", "int64"),
            ("task_index", "int64"),
        ] {
            let feature = json!({ "dtype": kind, "shape": [1], "names": null });
            features.insert(name.to_owned(), feature);
        }
        features.into()
    }

    fn episodes(&self, to: BufWriter<File>) -> Result<(), ParquetError> {
        let column = |name: &str| ParquetColumn::new(name, "", Values::Long(Vec::new()));
        let mut words = ParquetColumn::new("tasks", "", Values::Texts(Vec::new()));
        let mut columns = [
            "episode_index",
            "length",
            "dataset_from_index",
            "dataset_to_index",
            "data/chunk_index",
            "data/file_index",
            "meta/episodes/chunk_index",
            "meta/episodes/file_index",
        ]
        .map(column);
        let mut from = 0;
        for (number, episode) in (0_u64..).zip(&self.ended.episodes) {
            let to = from + episode.frames;
            let row = [number, episode.frames, from, to, 0, 0, 0, 0];
            from = to;
            let task = self.ended.tasks.get(episode.task);
            words.push_text(task.map_or("", String::as_str));
            for (column, value) in columns.iter_mut().zip(row) {
                column.push(long(value));
            }
        }
        let mut all = vec![words];
        all.extend(columns);
        finish(writer(to, &all, Vec::new())?, all)
    }

    /// pandas uses the task names as the table's index only if the file says so.
    fn tasks(&self, to: BufWriter<File>) -> Result<(), ParquetError> {
        const INDEX: &str = "__index_level_0__";
        let column = |name: Value, field: &str, kind: &str, numpy: &str| json!({ "name": name, "field_name": field, "pandas_type": kind, "numpy_type": numpy, "metadata": null });
        let pandas = json!({
            "index_columns": [INDEX],
            "column_indexes": [{ "name": null, "field_name": null, "pandas_type": "unicode", "numpy_type": "object", "metadata": { "encoding": "UTF-8" } }],
            "columns": [
                column("task_index".into(), "task_index", "int64", "int64"),
                column(Value::Null, INDEX, "unicode", "object"),
            ],
            "creator": { "library": "handscope", "version": env!("CARGO_PKG_VERSION") },
            "pandas_version": "2.2.0",
        });
        let mut numbers = ParquetColumn::new("task_index", "", Values::Long(Vec::new()));
        let mut words = ParquetColumn::new(INDEX, "", Values::Text(Vec::new()));
        for (number, task) in self.ended.tasks.iter().enumerate() {
            numbers.push(long(number));
            words.push_text(task);
        }
        let columns = vec![numbers, words];
        let pandas = KeyValue::new("pandas".to_owned(), pandas.to_string());
        finish(writer(to, &columns, vec![pandas])?, columns)
    }
}

/// Writes a table with a few rows.
fn finish(
    mut to: SerializedFileWriter<BufWriter<File>>,
    mut all: Vec<ParquetColumn>,
) -> Result<(), ParquetError> {
    columns::put(&mut all, to.next_row_group()?)?;
    let file = to
        .into_inner()?
        .into_inner()
        .map_err(io::IntoInnerError::into_error);
    Ok(file?.sync_all()?)
}
