//! A recording as a Parquet table: one row for each reading, null for values that were not part of it. Units, the hand and events
//! are in the file's metadata.

use crate::hand::column::{channel_column, grip_columns, joint_column, newton_column, tip_column};
use crate::hand::grip::Grip;
use crate::hand::newtons::newtons;
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, PerDof, Quantity, TactileBlock};
use crate::hand::{Timed, Touch};
use crate::record::export::arrow_schema::{ARROW_SCHEMA, arrow_schema};
use crate::record::export::columns::{self, ParquetCell, ParquetColumn, Values};
use crate::record::export::csv::UNDOCUMENTED;
use crate::record::export::output::{Destination, ExportError, Exported, Sink, Unfinished};
use crate::record::export::source::ExportSource;
use crate::record::file::format::opening::nanos_of;
use crate::record::grip;
use crate::record::{Entry, Record};
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde_json::{Map, json};
use std::io::BufWriter;
use std::sync::Arc;

/// Rows written at once: 6 MB.
const GROUP_ROWS: u64 = 8192;
/// Number of channels of a fingertip.
const CHANNELS: u8 = 8;

/// Writes a time range. Times are seconds from the recording's start, and nanoseconds since 1970.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub(crate) fn write(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    let output = Unfinished::new(to)?;
    let error = |error: ParquetError| output.parquet_error(error);
    let mut table = ParquetTable::new(source, output.file()?).map_err(error)?;
    let grip = source.grip_before();
    let mut follower = grip.map_err(|error| error.of(&output))?;
    let damage = source.without_wire().entries(|entry| {
        let grip = follower.apply(&entry);
        if let Entry::Heard(Record::Reading { sample, fresh }) = &entry {
            table.grip(&grip.unwrap_or_default());
            table.reading(entry.at(), sample, *fresh)?;
        }
        Ok(())
    });
    let damage = damage.map_err(|error| error.of(&output))?;
    let (rows, to) = table.end().map_err(error)?;
    output.sync(to)?;
    output.finish(rows)?;
    Ok(Exported {
        rows,
        readings: None,
        damage,
    })
}

struct ParquetTable {
    /// The last column names values outside the manual's ranges; those before it hold the grip.
    columns: Vec<ParquetColumn>,
    /// Joints with a column in newtons.
    newtons_per_g: Vec<(Dof, f64)>,
    to: SerializedFileWriter<BufWriter<Sink>>,
    start: Moment,
    base_nanos: u64,
    rows: u64,
}

impl ParquetTable {
    fn new(source: ExportSource<'_>, to: BufWriter<Sink>) -> Result<Self, ParquetError> {
        let newtons_per_g = source.newtons_per_g();
        let columns = all_columns(&newtons_per_g);
        let fields: Result<Vec<_>, _> = columns.iter().map(ParquetColumn::schema).collect();
        let schema = Type::group_type_builder("reading").with_fields(fields?);
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_created_by(format!("handscope {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(metadata(source, &columns)));
        let to =
            SerializedFileWriter::new(to, Arc::new(schema.build()?), Arc::new(properties.build()))?;
        Ok(Self {
            columns,
            newtons_per_g,
            to,
            start: source.file.first(),
            base_nanos: source.file.opening().base_nanos,
            rows: 0,
        })
    }

    fn grip(&mut self, grip: &Grip) {
        let columns = self.columns.iter_mut().rev().skip(1);
        for (column, state) in columns.zip(grip::states(grip).into_iter().rev()) {
            match grip::cell(state) {
                Some(state) => column.push_text(state),
                None => column.push(ParquetCell::Null),
            }
        }
    }

    fn reading(
        &mut self,
        at: Moment,
        sample: &HandSample,
        fresh: Groups,
    ) -> Result<(), ParquetError> {
        let asked = Group::ALL
            .into_iter()
            .filter(|group| fresh.contains(*group));
        let asked = asked
            .filter_map(|group| sample.times(group))
            .map(|(asked, _)| asked)
            .min();
        let nanos = |at: Moment| {
            let nanos = nanos_of(self.base_nanos, at);
            ParquetCell::Long(i64::try_from(nanos).unwrap_or(i64::MAX))
        };
        let head = [
            ParquetCell::Double(at.since(self.start).as_secs_f64()),
            nanos(at),
            asked.map_or(ParquetCell::Null, nanos),
        ];
        if let Some((last, columns)) = self.columns.split_last_mut() {
            let cells = head
                .into_iter()
                .chain(cells(sample, fresh, &self.newtons_per_g));
            for (column, cell) in columns.iter_mut().zip(cells) {
                column.push(cell);
            }
            let words: Vec<String> = sample
                .undocumented(fresh)
                .map(|one| one.to_string())
                .collect();
            if words.is_empty() {
                last.push(ParquetCell::Null)
            } else {
                last.push_text(&words.join(" "))
            }
        }
        self.rows += 1;
        if self.rows.is_multiple_of(GROUP_ROWS) {
            self.put()
        } else {
            Ok(())
        }
    }

    fn put(&mut self) -> Result<(), ParquetError> {
        let group = self.to.next_row_group()?;
        columns::put(&mut self.columns, group)
    }

    fn end(mut self) -> Result<(u64, BufWriter<Sink>), ParquetError> {
        if !self.rows.is_multiple_of(GROUP_ROWS) {
            self.put()?;
        }
        Ok((self.rows, self.to.into_inner()?))
    }
}

/// Metadata of the file: the columns' units, the recording, the events.
fn metadata(source: ExportSource<'_>, columns: &[ParquetColumn]) -> Vec<KeyValue> {
    let ExportSource { file, stretch, .. } = source;
    let opening = file.opening();
    let units: Map<String, serde_json::Value> = columns
        .iter()
        .filter(|column| !column.unit.is_empty())
        .map(|column| (column.name.clone(), column.unit.into()))
        .collect();
    let marks = file.overview().marks.iter();
    let events = marks.filter(|mark| (stretch.from..=stretch.to).contains(&mark.at));
    let events = events.map(|mark| {
        let time_s = mark.at.since(file.first()).as_secs_f64();
        json!({ "time_s": time_s, "kind": mark.kind.key(), "words": mark.words })
    });
    let recording = json!({
        "hand": opening.hand,
        "simulated": opening.simulated,
        "version": opening.version,
    });
    let mut all = vec![
        ("units", json!(units).to_string()),
        ("session", recording.to_string()),
        ("events", events.collect::<serde_json::Value>().to_string()),
    ];
    let schema = arrow_schema(columns, &all);
    all.push((ARROW_SCHEMA, schema));
    let all = all.into_iter();
    all.map(|(key, value)| KeyValue::new(key.to_owned(), value))
        .collect()
}

fn all_columns(newtons_per_g: &[(Dof, f64)]) -> Vec<ParquetColumn> {
    let mut all = vec![
        ParquetColumn::new("time_s", "s", Values::Double(Vec::new())),
        ParquetColumn::new("received", "", Values::Time(Vec::new())),
        ParquetColumn::new("asked", "", Values::Time(Vec::new())),
    ];
    for quantity in Quantity::ALL {
        let of = |dof| (joint_column(quantity, dof), quantity.row().unit);
        let six = Dof::ALL.map(of);
        all.extend(six.map(|(name, unit)| ParquetColumn::new(name, unit, Values::Int(Vec::new()))));
    }
    for (name, unit) in [
        ("force_threshold", "g"),
        ("target_speed", ""),
        ("position", ""),
        ("faults", ""),
        ("status", ""),
    ] {
        let ending = if unit.is_empty() { "" } else { "_g" };
        let six = Dof::ALL.map(|dof| format!("{name}_{}{ending}", dof.name()));
        all.extend(six.map(|name| ParquetColumn::new(name, unit, Values::Int(Vec::new()))));
    }
    for finger in Finger::ALL {
        for touch in Touch::ALL {
            let name = tip_column(touch, finger);
            all.push(ParquetColumn::new(
                name,
                touch.row().unit,
                Values::Float(Vec::new()),
            ));
        }
        let name = finger.name();
        let direction = format!("direction_{name}_deg");
        all.push(ParquetColumn::new(
            direction,
            "deg",
            Values::Int(Vec::new()),
        ));
        let proximity = format!("proximity_{name}");
        all.push(ParquetColumn::new(proximity, "", Values::Int(Vec::new())));
        let check = format!("check_ok_{name}");
        all.push(ParquetColumn::new(check, "", Values::Bool(Vec::new())));
        let channels = (0..CHANNELS).map(|channel| channel_column(channel, finger));
        all.extend(channels.map(|name| ParquetColumn::new(name, "", Values::Long(Vec::new()))));
    }
    let in_newtons = newtons_per_g.iter().map(|(dof, _)| newton_column(*dof));
    all.extend(in_newtons.map(|name| ParquetColumn::new(name, "N", Values::Double(Vec::new()))));
    all.extend(grip_columns().map(|name| ParquetColumn::new(name, "", Values::Text(Vec::new()))));
    all.push(ParquetColumn::new(
        UNDOCUMENTED,
        "",
        Values::Text(Vec::new()),
    ));
    all
}

/// Cells of a row between its times and its texts, in the order of the columns.
fn cells(
    sample: &HandSample,
    fresh: Groups,
    newtons_per_g: &[(Dof, f64)],
) -> impl Iterator<Item = ParquetCell> {
    let measured = Quantity::ALL.into_iter().flat_map(move |quantity| {
        let six = quantity.documented(sample);
        six_cells(six.filter(|_| fresh.contains(quantity.group())), |value| {
            value.map(i32::from)
        })
    });
    let is = move |group| fresh.contains(group);
    let force = sample.force_set.filter(|_| is(Group::ForceSet));
    let speed = sample.speed_set.filter(|_| is(Group::SpeedSet));
    let position = sample.position.filter(|_| is(Group::Position));
    let faults = sample.faults.filter(|_| is(Group::Faults));
    let status = sample.status.filter(|_| is(Group::Status));
    let others = [
        six_cells(force, |force| Some(i32::from(force?.get()))),
        six_cells(speed, |speed| Some(i32::from(speed?.get()))),
        six_cells(position, |position| position.documented().map(i32::from)),
        six_cells(faults, |faults| Some(i32::from(faults.raw()))),
        six_cells(status, |status| Some(i32::from(status.raw()))),
    ];
    let tips = Finger::ALL.into_iter().flat_map(move |finger| {
        let block = sample.tactile[finger].filter(|_| is(Group::Tactile(finger)));
        tip_cells(block.map(|block| block.value))
    });
    let forces = Quantity::Force.documented(sample);
    let forces = forces.filter(|_| is(Group::Force));
    let in_newtons = newtons_per_g.iter().map(move |(dof, per_g)| {
        let force_g = forces.and_then(|six| six.value[*dof]);
        force_g.map_or(ParquetCell::Null, |force_g| {
            ParquetCell::Double(newtons(force_g.into(), *per_g))
        })
    });
    measured
        .chain(others.into_iter().flatten())
        .chain(tips)
        .chain(in_newtons)
}

fn six_cells<T: Copy>(
    six: Option<Timed<PerDof<T>>>,
    value: impl Fn(T) -> Option<i32>,
) -> [ParquetCell; Dof::ALL.len()] {
    Dof::ALL.map(|dof| {
        let value = six.and_then(|six| value(six.value[dof]));
        value.map_or(ParquetCell::Null, ParquetCell::Int)
    })
}

fn tip_cells(block: Option<TactileBlock>) -> impl Iterator<Item = ParquetCell> {
    let block = block.as_ref();
    let float = |value: Option<f32>| value.map_or(ParquetCell::Null, ParquetCell::Float);
    let direction = block.and_then(TactileBlock::direction_deg);
    let head = [
        float(block.and_then(TactileBlock::normal)),
        float(block.and_then(TactileBlock::tangential)),
        direction.map_or(ParquetCell::Null, |degrees| {
            ParquetCell::Int(i32::from(degrees))
        }),
        block.map_or(ParquetCell::Null, |block| ParquetCell::Int(block.proximity)),
        block.map_or(ParquetCell::Null, |block| {
            ParquetCell::Bool(block.check_ok())
        }),
    ];
    let raw = block.map(|block| block.raw);
    let channels = (0..usize::from(CHANNELS)).map(move |channel| {
        let count = raw.and_then(|raw| raw.get(channel).copied());
        count.map_or(ParquetCell::Null, |count| {
            ParquetCell::Long(i64::from(count))
        })
    });
    head.into_iter().chain(channels)
}
