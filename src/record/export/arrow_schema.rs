//! The schema of a table in Arrow's format, from which pyarrow and others read a column's unit: `schema.field(name).metadata`.
//! Parquet itself has no place for it. The bytes are a flatbuffer (Arrow's `Message.fbs` and `Schema.fbs`), in base64.

use crate::record::export::columns::{ParquetColumn, Values};

/// Metadata key under which Parquet readers look for the schema.
pub(crate) const ARROW_SCHEMA: &str = "ARROW:schema";
/// Version 5 of the format, since Arrow 1.0.
const VERSION: i16 = 4;
/// Message type of a schema.
const SCHEMA: u8 = 1;

/// A value in a flatbuffer.
enum Flat {
    Absent,
    Byte(u8),
    Short(i16),
    Int(i32),
    Text(String),
    Table(Vec<Self>),
    List(Vec<Self>),
}

/// The schema of these columns. It repeats the table's metadata, because Arrow then reads no other.
pub(crate) fn arrow_schema(columns: &[ParquetColumn], metadata: &[(&str, String)]) -> String {
    let fields = columns.iter().map(field).collect();
    let metadata = metadata.iter().map(|(key, value)| pair(key, value));
    let metadata = Flat::List(metadata.collect());
    let schema = Flat::Table(vec![Flat::Short(0), Flat::List(fields), metadata]);
    let message = Flat::Table(vec![Flat::Short(VERSION), Flat::Byte(SCHEMA), schema]);
    let mut bytes = FlatBytes(vec![0; 4]);
    bytes.refer(0, &message);
    bytes.align(8);
    let length = u32::try_from(bytes.0.len()).unwrap_or_default();
    let head = [u32::MAX.to_le_bytes(), length.to_le_bytes()].concat();
    base64(&[head, bytes.0].concat())
}

/// One column: name, nullability, type, children, and metadata.
fn field(column: &ParquetColumn) -> Flat {
    let (kind, parameters) = match column.values() {
        Values::Int(_) => (2, vec![Flat::Int(32), Flat::Byte(1)]),
        Values::Long(_) => (2, vec![Flat::Int(64), Flat::Byte(1)]),
        Values::Time(_) => (10, vec![Flat::Short(3), Flat::Text("UTC".into())]),
        Values::Float(_) | Values::Floats(..) => (3, vec![Flat::Short(1)]),
        Values::Double(_) => (3, vec![Flat::Short(2)]),
        Values::Bool(_) => (6, Vec::new()),
        Values::Text(_) | Values::Texts(_) => (5, Vec::new()),
    };
    let metadata = match column.unit {
        "" => Flat::Absent,
        unit => Flat::List(vec![pair("unit", unit)]),
    };
    Flat::Table(vec![
        Flat::Text(column.name.clone()),
        Flat::Byte(1),
        Flat::Byte(kind),
        Flat::Table(parameters),
        Flat::Absent,
        Flat::List(Vec::new()),
        metadata,
    ])
}

fn pair(key: &str, value: &str) -> Flat {
    Flat::Table(vec![Flat::Text(key.into()), Flat::Text(value.into())])
}

/// A flatbuffer under construction: references precede their targets.
struct FlatBytes(Vec<u8>);

impl FlatBytes {
    fn align(&mut self, to: usize) {
        self.0.resize(self.0.len().next_multiple_of(to), 0);
    }

    fn put(&mut self, place: usize, bytes: &[u8]) {
        if let Some(there) = self.0.get_mut(place..place + bytes.len()) {
            there.copy_from_slice(bytes);
        }
    }

    /// Appends a value, and writes its offset at `place`.
    fn refer(&mut self, place: usize, value: &Flat) {
        self.align(4);
        let at = match value {
            Flat::Text(text) => {
                let at = self.0.len();
                self.0.extend(int(text.len()));
                self.0.extend(text.as_bytes());
                self.0.push(0);
                at
            }
            Flat::List(all) => {
                let at = self.0.len();
                self.0.extend(int(all.len()));
                let first = self.0.len();
                self.0.resize(first + 4 * all.len(), 0);
                for (number, one) in all.iter().enumerate() {
                    self.refer(first + 4 * number, one);
                }
                at
            }
            Flat::Table(fields) => self.table(fields),
            Flat::Absent | Flat::Byte(_) | Flat::Short(_) | Flat::Int(_) => return,
        };
        self.put(place, &int(at - place));
    }

    /// Writes a table: each field occupies four bytes; before them is a vtable with the offset of each, 0 for an absent one.
    fn table(&mut self, fields: &[Flat]) -> usize {
        let (list_len, table_len) = (4 + 2 * fields.len(), 4 + 4 * fields.len());
        while !(self.0.len() + list_len).is_multiple_of(4) {
            self.0.push(0);
        }
        self.0.extend(short(list_len));
        self.0.extend(short(table_len));
        for (number, field) in fields.iter().enumerate() {
            let is_there = !matches!(field, Flat::Absent);
            self.0
                .extend(short(if is_there { 4 + 4 * number } else { 0 }));
        }
        let at = self.0.len();
        self.0.extend(int(list_len));
        self.0.resize(at + table_len, 0);
        for (number, field) in fields.iter().enumerate() {
            let place = at + 4 + 4 * number;
            match field {
                Flat::Byte(value) => self.put(place, &[*value]),
                Flat::Short(value) => self.put(place, &value.to_le_bytes()),
                Flat::Int(value) => self.put(place, &value.to_le_bytes()),
                reference => self.refer(place, reference),
            }
        }
        at
    }
}

fn int(number: usize) -> [u8; 4] {
    u32::try_from(number).unwrap_or_default().to_le_bytes()
}

fn short(number: usize) -> [u8; 2] {
    u16::try_from(number).unwrap_or_default().to_le_bytes()
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let byte = |place: usize| u32::from(three.get(place).copied().unwrap_or_default());
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let letter = LETTERS.get((bits >> (18 - 6 * place) & 63) as usize);
            let letter = letter.filter(|_| place <= three.len());
            text.push(letter.map_or('=', |letter| char::from(*letter)));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_rfc_4648() {
        let rows = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (text, wanted) in rows {
            assert_eq!(base64(text.as_bytes()), wanted);
        }
    }
}
