//! A session as a LeRobot v3.0 data set without video: frames at an even rate, each with the newest reading before its time. What was
//! not read is never filled in: a silence ends the episode.

use crate::hand::kinematics::Side;
use crate::record::export::columns::{self, ParquetCell, ParquetColumn, Values};
use crate::record::export::frames::{DatasetFrame, DatasetFrames, FRAME_WIDTHS, has_touch};
use crate::record::export::output::{ExportError, Exported, Unfinished, unreadable};
use crate::record::export::statistics::Statistics;
use crate::record::file::SessionFile;
use crate::record::file::reader::Stretch;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde_json::{Map, Value, json};
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// DatasetFrames that an episode keeps in memory: half an hour at 30 a second. A longer one is written as several groups of rows.
const GROUP_FRAMES: u64 = 65_536;
/// Names of what a frame holds, in the order of [`FRAME_WIDTHS`].
const PARTS: [&str; 4] = [
    "observation.state",
    "action",
    "observation.force",
    "observation.touch",
];
/// Files of one kind; LeRobot counts them with three digits.
const FILE: &str = "chunk-000/file-000.parquet";

/// How frames are made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeRobotPlan {
    /// DatasetFrames a second.
    pub fps: u32,
    /// What the hand does, in words.
    pub task: String,
}

/// Writes a stretch as a folder.
///
/// # Errors
/// [`ExportError`]; then there is no folder.
pub fn write(
    file: &SessionFile,
    stretch: Stretch,
    path: &Path,
    plan: &LeRobotPlan,
) -> Result<Exported, ExportError> {
    let output = Unfinished::new(path)?;
    let folder = output.folder()?.to_owned();
    let error = |error: io::Error| output.error(&error);
    let parquet_error = |failed: ParquetError| error(io::Error::other(failed));
    for part in ["data/chunk-000", "meta/episodes/chunk-000"] {
        fs::create_dir_all(folder.join(part)).map_err(error)?;
    }
    let data = folder.join("data").join(FILE);
    let data = BufWriter::new(File::create_new(data).map_err(error)?);
    let mut set = DataSet::new(data, parts(file)).map_err(parquet_error)?;
    let mut frames = DatasetFrames::new(file, plan.fps);
    let mut done = Ok(());
    let no_wire = Stretch {
        wire: false,
        ..stretch
    };
    let damage = file.entries(no_wire, |entry| {
        frames.take(&entry, |frame| {
            if done.is_ok() {
                done = set.frame(frame);
            }
        });
        match done {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    });
    let damage = damage.map_err(|error| unreadable(&error))?;
    done.map_err(parquet_error)?;
    let ended = set.end().map_err(parquet_error)?;
    if ended.index == 0 {
        return Err(ExportError::Empty);
    }
    output.sync(ended.data)?;
    let meta = Meta {
        file,
        plan,
        frames: ended.index,
        episodes: &ended.episodes,
    };
    meta.write(&folder.join("meta"), &ended.statistics)
        .map_err(error)?;
    output.finish()?;
    Ok(Exported {
        rows: meta.frames,
        damage,
    })
}

/// How many of [`PARTS`] there are: fingertips that were hardly read are left out.
fn parts(file: &SessionFile) -> usize {
    match has_touch(file) {
        true => PARTS.len(),
        false => PARTS.len() - 1,
    }
}

/// The frames as they are written.
struct DataSet {
    to: SerializedFileWriter<BufWriter<File>>,
    columns: Vec<ParquetColumn>,
    parts: usize,
    statistics: Statistics,
    /// DatasetFrames of each episode.
    episodes: Vec<u64>,
    index: u64,
    waiting: u64,
}

/// What was written.
struct Ended {
    data: BufWriter<File>,
    statistics: Statistics,
    episodes: Vec<u64>,
    index: u64,
}

impl DataSet {
    fn new(to: BufWriter<File>, parts: usize) -> Result<Self, ParquetError> {
        let lists = PARTS.into_iter().zip(FRAME_WIDTHS).take(parts);
        let lists =
            lists.map(|(name, width)| ParquetColumn::new(name, "", Values::Floats(width, vec![])));
        let mut columns: Vec<ParquetColumn> = lists.collect();
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
            statistics: Statistics::new(PARTS.into_iter().zip(FRAME_WIDTHS).take(parts)),
            parts,
            episodes: Vec::new(),
            index: 0,
            waiting: 0,
        })
    }

    fn frame(&mut self, frame: &DatasetFrame) -> Result<(), ParquetError> {
        if frame.number == 0 {
            self.put()?;
            self.episodes.push(0);
        } else if self.waiting >= GROUP_FRAMES {
            self.put()?;
        }
        let episode = self.episodes.len().saturating_sub(1);
        let long = |number: u64| ParquetCell::Long(i64::try_from(number).unwrap_or(i64::MAX));
        let scalars = [
            ParquetCell::Float(frame.time_s),
            long(frame.number),
            ParquetCell::Long(i64::try_from(episode).unwrap_or(i64::MAX)),
            long(self.index),
            ParquetCell::Long(0),
        ];
        let (lists, rest) = self.columns.split_at_mut(self.parts);
        for (column, values) in lists.iter_mut().zip(frame.parts()) {
            column.push_list(values);
        }
        for (column, cell) in rest.iter_mut().zip(scalars) {
            column.push(cell);
        }
        self.statistics.take(&frame.parts());
        self.index += 1;
        self.waiting += 1;
        if let Some(length) = self.episodes.last_mut() {
            *length += 1;
        }
        Ok(())
    }

    fn put(&mut self) -> Result<(), ParquetError> {
        if self.waiting == 0 {
            return Ok(());
        }
        self.waiting = 0;
        let group = self.to.next_row_group()?;
        columns::put(&mut self.columns, group)
    }

    fn end(mut self) -> Result<Ended, ParquetError> {
        self.put()?;
        Ok(Ended {
            data: self.to.into_inner()?,
            statistics: self.statistics,
            episodes: self.episodes,
            index: self.index,
        })
    }
}

fn writer(
    to: BufWriter<File>,
    columns: &[ParquetColumn],
    metadata: Vec<KeyValue>,
) -> Result<SerializedFileWriter<BufWriter<File>>, ParquetError> {
    let fields: Result<Vec<_>, _> = columns.iter().map(ParquetColumn::schema).collect();
    let schema = Type::group_type_builder("schema").with_fields(fields?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata((!metadata.is_empty()).then_some(metadata));
    SerializedFileWriter::new(to, Arc::new(schema.build()?), Arc::new(properties.build()))
}

/// What stands beside the frames.
struct Meta<'a> {
    file: &'a SessionFile,
    plan: &'a LeRobotPlan,
    frames: u64,
    episodes: &'a [u64],
}

impl Meta<'_> {
    fn write(&self, folder: &Path, statistics: &Statistics) -> io::Result<()> {
        let json = |name: &str, value: &Value| {
            let text = serde_json::to_string_pretty(value).map_err(io::Error::other)?;
            fs::write(folder.join(name), text)
        };
        json("info.json", &self.info())?;
        json("stats.json", &statistics.json())?;
        let place = folder.join("episodes").join(FILE);
        let file = BufWriter::new(File::create_new(place)?);
        self.episodes(file).map_err(io::Error::other)?;
        let file = BufWriter::new(File::create_new(folder.join("tasks.parquet"))?);
        self.tasks(file).map_err(io::Error::other)
    }

    fn info(&self) -> Value {
        let episodes = self.episodes.len();
        let opening = self.file.opening();
        json!({
            "codebase_version": "v3.0",
            "robot_type": "ftp_tactile_hand",
            "total_episodes": episodes,
            "total_frames": self.frames,
            "total_tasks": 1,
            "chunks_size": 1000,
            "data_files_size_in_mb": 100,
            "video_files_size_in_mb": 200,
            "fps": self.plan.fps,
            "splits": { "train": format!("0:{episodes}") },
            "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
            "video_path": null,
            "features": self.features(),
            "handscope": {
                "hand": opening.hand,
                "simulated": opening.simulated,
                "version": opening.version,
                "resampling": "each frame holds the newest reading received before its time",
                "gaps": "a silence of more than 0.5 s is not filled; it ends the episode",
                "action": "ANGLE_SET as sent or read back; the angle itself for a joint that is left alone",
            },
        })
    }

    fn features(&self) -> Value {
        let side = match self.file.opening().side {
            Side::Left => "kLeftHand",
            Side::Right => "kRightHand",
        };
        let joints = [
            "Pinky",
            "Ring",
            "Middle",
            "Index",
            "ThumbBend",
            "ThumbRotation",
        ]
        .map(|joint| format!("{side}{joint}"));
        let tips = ["Pinky", "Ring", "Middle", "Index", "Thumb"];
        let tip = |what: &str| tips.map(|tip| format!("{side}{tip}{what}"));
        let touch = [tip("Normal"), tip("Tangential")].concat();
        let names = [joints.to_vec(), joints.to_vec(), joints.to_vec(), touch];
        let mut features = Map::new();
        let parts = PARTS.iter().zip(FRAME_WIDTHS).take(parts(self.file));
        for ((part, width), names) in parts.zip(names) {
            let feature = json!({ "dtype": "float32", "shape": [width], "names": names });
            features.insert((*part).to_owned(), feature);
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
        let long = |name: &str| ParquetColumn::new(name, "", Values::Long(Vec::new()));
        let mut columns = vec![ParquetColumn::new("tasks", "", Values::Texts(Vec::new()))];
        columns.extend(
            [
                "episode_index",
                "length",
                "dataset_from_index",
                "dataset_to_index",
                "data/chunk_index",
                "data/file_index",
                "meta/episodes/chunk_index",
                "meta/episodes/file_index",
            ]
            .map(long),
        );
        let mut from = 0;
        for (number, length) in (0..).zip(self.episodes) {
            let length = i64::try_from(*length).unwrap_or(i64::MAX);
            let row = [number, length, from, from + length, 0, 0, 0, 0];
            from += length;
            let (tasks, numbers) = columns.split_at_mut(1);
            tasks
                .iter_mut()
                .for_each(|column| column.push_text(&self.plan.task));
            for (column, value) in numbers.iter_mut().zip(row) {
                column.push(ParquetCell::Long(value));
            }
        }
        finish(writer(to, &columns, Vec::new())?, columns)
    }

    /// pandas takes the words for the index of the table only where the file says so.
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
        let mut number = ParquetColumn::new("task_index", "", Values::Long(Vec::new()));
        number.push(ParquetCell::Long(0));
        let mut words = ParquetColumn::new(INDEX, "", Values::Text(Vec::new()));
        words.push_text(&self.plan.task);
        let columns = vec![number, words];
        let pandas = KeyValue::new("pandas".to_owned(), pandas.to_string());
        finish(writer(to, &columns, vec![pandas])?, columns)
    }
}

/// Writes a table of a few rows.
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
