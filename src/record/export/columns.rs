//! Columns of a Parquet file: collected row by row, written a row group at a time.

use parquet::basic::{LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DoubleType, FloatType, Int32Type, Int64Type,
};
use parquet::errors::ParquetError;
use parquet::file::writer::{SerializedColumnWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::Write;
use std::sync::Arc;

/// The non-null values of one column.
#[derive(Debug, Clone)]
pub(crate) enum Values {
    Int(Vec<i32>),
    Long(Vec<i64>),
    /// Nanoseconds since 1970, UTC.
    Time(Vec<i64>),
    Float(Vec<f32>),
    Double(Vec<f64>),
    Bool(Vec<bool>),
    Text(Vec<ByteArray>),
    /// Lists of one text each.
    Texts(Vec<ByteArray>),
    /// Lists of this many numbers.
    Floats(usize, Vec<f32>),
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum ParquetCell {
    Int(i32),
    Long(i64),
    Float(f32),
    Double(f64),
    Bool(bool),
    /// Not read, or unknown.
    Null,
}

#[derive(Debug, Clone)]
pub(crate) struct ParquetColumn {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    values: Values,
    /// Definition level: 1 for each row with a value, 0 for each without; 1 for each value of a list.
    there: Vec<i16>,
    /// Repetition level: 0 for the first value of a list, 1 for the others.
    further: Vec<i16>,
}

impl ParquetColumn {
    pub(crate) fn new(name: impl Into<String>, unit: &'static str, values: Values) -> Self {
        Self {
            name: name.into(),
            unit,
            values,
            there: Vec::new(),
            further: Vec::new(),
        }
    }

    /// Values collected so far, which also define the column's type.
    pub(crate) const fn values(&self) -> &Values {
        &self.values
    }

    /// Adds a row. A value of another type than the column's becomes null.
    pub(crate) fn push(&mut self, cell: ParquetCell) {
        match (&mut self.values, cell) {
            (Values::Int(all), ParquetCell::Int(value)) => all.push(value),
            (Values::Long(all) | Values::Time(all), ParquetCell::Long(value)) => all.push(value),
            (Values::Float(all), ParquetCell::Float(value)) => all.push(value),
            (Values::Double(all), ParquetCell::Double(value)) => all.push(value),
            (Values::Bool(all), ParquetCell::Bool(value)) => all.push(value),
            (_, cell) => {
                debug_assert!(
                    matches!(cell, ParquetCell::Null),
                    "a value of the wrong type"
                );
                self.there.push(0);
                return;
            }
        }
        self.there.push(1);
    }

    /// Adds a row to a column of text, or of lists of one text.
    pub(crate) fn push_text(&mut self, text: &str) {
        if let Values::Text(all) | Values::Texts(all) = &mut self.values {
            all.push(text.into());
            self.there.push(1);
            self.further.push(0);
        }
    }

    /// Adds a row to a column of lists; the list must have the column's length.
    pub(crate) fn push_list(&mut self, list: &[f32]) {
        if let Values::Floats(width, all) = &mut self.values {
            debug_assert_eq!(*width, list.len(), "a list of the column's length");
            all.extend(list);
            self.there.extend(list.iter().map(|_| 1));
            self.further
                .extend((0..list.len()).map(|place| i16::from(place > 0)));
        }
    }

    /// Parquet type of the column.
    pub(crate) fn schema(&self) -> Result<Arc<Type>, ParquetError> {
        let (physical, logical) = match self.values {
            Values::Int(_) => (Physical::INT32, None),
            Values::Long(_) => (Physical::INT64, None),
            Values::Time(_) => (
                Physical::INT64,
                Some(LogicalType::timestamp(true, TimeUnit::NANOS)),
            ),
            Values::Float(_) => (Physical::FLOAT, None),
            Values::Double(_) => (Physical::DOUBLE, None),
            Values::Bool(_) => (Physical::BOOLEAN, None),
            Values::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Values::Texts(_) => {
                return list(&self.name, Physical::BYTE_ARRAY, Some(LogicalType::String));
            }
            Values::Floats(..) => return list(&self.name, Physical::FLOAT, None),
        };
        let column = Type::primitive_type_builder(&self.name, physical);
        let column = column.with_repetition(Repetition::OPTIONAL);
        column.with_logical_type(logical).build().map(Arc::new)
    }

    /// Writes the collected values and clears them.
    fn put(&mut self, mut to: SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
        let there = Some(self.there.as_slice());
        match &mut self.values {
            Values::Int(all) => {
                to.typed::<Int32Type>().write_batch(all, there, None)?;
                all.clear();
            }
            Values::Long(all) | Values::Time(all) => {
                to.typed::<Int64Type>().write_batch(all, there, None)?;
                all.clear();
            }
            Values::Float(all) => {
                to.typed::<FloatType>().write_batch(all, there, None)?;
                all.clear();
            }
            Values::Double(all) => {
                to.typed::<DoubleType>().write_batch(all, there, None)?;
                all.clear();
            }
            Values::Text(all) => {
                to.typed::<ByteArrayType>().write_batch(all, there, None)?;
                all.clear();
            }
            Values::Texts(all) => {
                let further = Some(self.further.as_slice());
                to.typed::<ByteArrayType>()
                    .write_batch(all, there, further)?;
                all.clear();
            }
            Values::Floats(_, all) => {
                let further = Some(self.further.as_slice());
                to.typed::<FloatType>().write_batch(all, there, further)?;
                all.clear();
            }
            Values::Bool(all) => {
                to.typed::<BoolType>().write_batch(all, there, None)?;
                all.clear();
            }
        }
        self.there.clear();
        self.further.clear();
        to.close()
    }
}

/// A column of lists without null lists or elements.
fn list(
    name: &str,
    physical: Physical,
    logical: Option<LogicalType>,
) -> Result<Arc<Type>, ParquetError> {
    let element = Type::primitive_type_builder("element", physical);
    let element = element.with_repetition(Repetition::REQUIRED);
    let element = element.with_logical_type(logical).build()?;
    let inner = Type::group_type_builder("list").with_repetition(Repetition::REPEATED);
    let inner = inner.with_fields(vec![Arc::new(element)]).build()?;
    let outer = Type::group_type_builder(name).with_repetition(Repetition::REQUIRED);
    let outer = outer.with_logical_type(Some(LogicalType::List));
    let outer = outer.with_fields(vec![Arc::new(inner)]);
    outer.build().map(Arc::new)
}

/// Writes a row group.
pub(crate) fn put<W: Write + Send>(
    columns: &mut [ParquetColumn],
    mut group: SerializedRowGroupWriter<'_, W>,
) -> Result<(), ParquetError> {
    for column in columns {
        if let Some(to) = group.next_column()? {
            column.put(to)?;
        }
    }
    group.close().map(|_written| ())
}
