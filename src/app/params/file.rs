//! Parameters as TOML, version 1 (README, "Parameters"). A file is taken whole or not at all; keys that are not known are kept
//! and named.

use crate::app::params::table::{DEFAULT_FORCE, DEFAULT_SPEED, ParamId, Value};
use crate::app::params::values::Params;
use crate::hand::Dof;
use std::io::Read as _;
use std::path::Path;
use toml::Table;

/// What a file of parameters says it is.
pub const FORMAT: &str = "handscope-params";
/// The version that is written, and the only one that is read.
pub const VERSION: i64 = 1;
/// A file of parameters is a page of text; anything longer is not ours.
pub const FILE_LEN_MAX: u64 = 64 * 1024;

/// Why a file of parameters was not taken. Nothing of it was.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParamsFileError {
    /// Not TOML.
    #[error("{0}")]
    Toml(String),
    /// A field that is missing.
    #[error("`{field}` is missing")]
    Missing {
        /// Its name.
        field: &'static str,
    },
    /// Another kind of file.
    #[error("this is no file of parameters: its `format` is {got}, not \"{FORMAT}\"")]
    Format {
        /// What it says it is.
        got: String,
    },
    /// Written by another version.
    #[error("`version` is {got}: only {VERSION} can be read")]
    Version {
        /// What it says.
        got: String,
    },
    /// A value that may not be written to a hand.
    #[error("`{field}` is {got}: it must be {allowed}")]
    Value {
        /// The field.
        field: String,
        /// What stands there.
        got: String,
        /// What may.
        allowed: String,
    },
    /// A file without a single parameter.
    #[error("it holds no parameter")]
    Empty,
    /// Longer than a file of parameters can be.
    #[error("{got} bytes are too long for a file of parameters: {FILE_LEN_MAX} at most")]
    TooLong {
        /// Its length.
        got: u64,
    },
    /// The system could not read it.
    #[error("it cannot be read: {0}")]
    Unreadable(String),
}

/// A file of parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParamsFile {
    /// Where the values were read, as an endpoint; empty if nowhere.
    pub hand: String,
    /// When, in UTC; empty if it is not known.
    pub at: String,
    /// Why it was written: `dump`, `before save`, …
    pub why: String,
    /// For what was saved: what is known of the SAVE.
    pub verdict: String,
    /// The values.
    pub params: Params,
    /// Keys of a later version, kept as they are.
    pub others: Table,
}

impl ParamsFile {
    /// The text of the file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut table = Table::new();
        table.insert("format".into(), FORMAT.into());
        table.insert("version".into(), VERSION.into());
        for (key, text) in self.words() {
            if !text.is_empty() {
                table.insert(key.into(), text.clone().into());
            }
        }
        let mut groups = [(DEFAULT_SPEED, Table::new()), (DEFAULT_FORCE, Table::new())];
        for (id, value) in self.params.iter() {
            let [(_, speeds), (_, forces)] = &mut groups;
            let (into, key) = match id {
                ParamId::DefaultSpeed(dof) => (speeds, dof.name().to_owned()),
                ParamId::DefaultForce(dof) => (forces, dof.name().to_owned()),
                _ => (&mut table, id.name()),
            };
            into.insert(key, toml_of(value));
        }
        for (name, group) in groups {
            if !group.is_empty() {
                table.insert(name.into(), group.into());
            }
        }
        merge(&mut table, &self.others);
        // A table of text, numbers and tables can always be written.
        toml::to_string(&table).unwrap_or_default()
    }

    const fn words(&self) -> [(&'static str, &String); 4] {
        [
            ("hand", &self.hand),
            ("at", &self.at),
            ("why", &self.why),
            ("verdict", &self.verdict),
        ]
    }

    /// The names of keys that are not known, groups spelt out.
    #[must_use]
    pub fn unknown_keys(&self) -> Vec<String> {
        let keys = self.others.iter().flat_map(|(key, value)| match value {
            toml::Value::Table(inner) if [DEFAULT_SPEED, DEFAULT_FORCE].contains(&key.as_str()) => {
                inner.keys().map(|inner| format!("{key}.{inner}")).collect()
            }
            _ => vec![key.clone()],
        });
        keys.collect()
    }
}

/// Values that are not known stay out of the file, so a table takes only new keys.
fn merge(table: &mut Table, others: &Table) {
    for (key, value) in others {
        match (table.get_mut(key), value) {
            (Some(toml::Value::Table(inner)), toml::Value::Table(more)) => merge(inner, more),
            (Some(_), _) => {}
            (None, _) => {
                table.insert(key.clone(), value.clone());
            }
        }
    }
}

fn toml_of(value: Value) -> toml::Value {
    match value {
        Value::Number(number) => i64::from(number).into(),
        Value::Address(address) => address.to_string().into(),
    }
}

/// Takes a file from its text.
///
/// # Errors
/// The first thing that is wrong, with the field's name.
pub fn read(text: &str) -> Result<ParamsFile, ParamsFileError> {
    let mut table: Table = text.parse().map_err(|error: toml::de::Error| {
        let line = error.span().map_or(1, |span| line_of(text, span.start));
        ParamsFileError::Toml(format!("line {line}: {}", error.message()))
    })?;
    head(&mut table)?;
    let mut file = ParamsFile {
        hand: word(&mut table, "hand")?,
        at: word(&mut table, "at")?,
        why: word(&mut table, "why")?,
        verdict: word(&mut table, "verdict")?,
        ..ParamsFile::default()
    };
    for id in [ParamId::HandId, ParamId::ReduRatio, ParamId::IpAddress] {
        take(&mut table, &id.name(), id, &mut file.params)?;
    }
    group(
        &mut table,
        DEFAULT_SPEED,
        ParamId::DefaultSpeed,
        &mut file.params,
    )?;
    group(
        &mut table,
        DEFAULT_FORCE,
        ParamId::DefaultForce,
        &mut file.params,
    )?;
    if file.params.is_empty() {
        return Err(ParamsFileError::Empty);
    }
    file.others = table;
    Ok(file)
}

/// Reads a file that a person chose.
///
/// # Errors
/// The first thing that is wrong.
pub fn load(path: &Path) -> Result<ParamsFile, ParamsFileError> {
    let unreadable = |error: std::io::Error| ParamsFileError::Unreadable(error.to_string());
    let about = std::fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        return Err(ParamsFileError::Unreadable("it is not a file".into()));
    }
    if about.len() > FILE_LEN_MAX {
        return Err(ParamsFileError::TooLong { got: about.len() });
    }
    let mut text = String::new();
    let opened = std::fs::File::open(path).map_err(unreadable)?;
    let mut bounded = opened.take(FILE_LEN_MAX);
    bounded.read_to_string(&mut text).map_err(unreadable)?;
    read(&text)
}

fn line_of(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or(text);
    before.matches('\n').count() + 1
}

fn head(table: &mut Table) -> Result<(), ParamsFileError> {
    let field = "format";
    let got = table
        .remove(field)
        .ok_or(ParamsFileError::Missing { field })?;
    if got.as_str() != Some(FORMAT) {
        let got = got.to_string();
        return Err(ParamsFileError::Format { got });
    }
    let field = "version";
    let got = table
        .remove(field)
        .ok_or(ParamsFileError::Missing { field })?;
    if got.as_integer() != Some(VERSION) {
        let got = got.to_string();
        return Err(ParamsFileError::Version { got });
    }
    Ok(())
}

fn word(table: &mut Table, field: &str) -> Result<String, ParamsFileError> {
    match table.remove(field) {
        None => Ok(String::new()),
        Some(toml::Value::String(text)) => Ok(text),
        Some(other) => Err(ParamsFileError::Value {
            field: field.into(),
            got: other.to_string(),
            allowed: "text in quotes".into(),
        }),
    }
}

fn group(
    table: &mut Table,
    name: &str,
    row: fn(Dof) -> ParamId,
    into: &mut Params,
) -> Result<(), ParamsFileError> {
    let mut inner = match table.remove(name) {
        None => return Ok(()),
        Some(toml::Value::Table(inner)) => inner,
        Some(other) => {
            return Err(ParamsFileError::Value {
                field: name.into(),
                got: other.to_string(),
                allowed: format!("a table, [{name}], with a line for each joint"),
            });
        }
    };
    for dof in Dof::ALL {
        take(&mut inner, dof.name(), row(dof), into)?;
    }
    if !inner.is_empty() {
        table.insert(name.into(), inner.into());
    }
    Ok(())
}

fn take(
    table: &mut Table,
    key: &str,
    id: ParamId,
    into: &mut Params,
) -> Result<(), ParamsFileError> {
    let Some(got) = table.remove(key) else {
        return Ok(());
    };
    let value = match &got {
        toml::Value::Integer(number) => i32::try_from(*number).ok().map(Value::Number),
        toml::Value::String(text) => text.parse().ok().map(Value::Address),
        _ => None,
    };
    match value.filter(|value| id.allows(*value)) {
        Some(value) => {
            into.put(id, value);
            Ok(())
        }
        None => Err(ParamsFileError::Value {
            field: id.name(),
            got: got.to_string(),
            allowed: id.allowed(),
        }),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = "\
format = \"handscope-params\"
version = 1
crew = 3
hand_id = 7
ip_address = \"10.0.0.9\"

[default_speed]
index = 300
sixth = 9

[default_force]
thumb_bend = 800
";

    #[test]
    fn a_file_is_read_and_written_with_what_is_not_known() {
        let file = read(TEXT).unwrap();
        let rows: Vec<_> = file
            .params
            .iter()
            .map(|(id, value)| (id.name(), value))
            .collect();
        assert_eq!(
            rows,
            [
                ("hand_id".into(), Value::Number(7)),
                ("ip_address".into(), Value::Address([10, 0, 0, 9].into())),
                ("default_speed.index".into(), Value::Number(300)),
                ("default_force.thumb_bend".into(), Value::Number(800)),
            ]
        );
        assert_eq!(file.unknown_keys(), ["crew", "default_speed.sixth"]);
        assert_eq!(read(&file.to_toml()).unwrap(), file);
    }

    #[test]
    fn a_bad_file_is_told_in_one_sentence_that_names_the_field() {
        for (from, to, words) in [
            (
                "index = 300",
                "index = 1001",
                "`default_speed.index` is 1001: it must be a whole number from 0 to 1000",
            ),
            ("index = 300", "index = 3.5", "`default_speed.index` is 3.5"),
            (
                "index = 300",
                "index = \"300\"",
                "`default_speed.index` is \"300\"",
            ),
            ("index = 300", "index = nan", "`default_speed.index` is nan"),
            (
                "hand_id = 7",
                "hand_id = 0",
                "`hand_id` is 0: it must be a whole number from 1 to 254",
            ),
            ("hand_id = 7", "redu_ratio = 4", "`redu_ratio` is 4"),
            (
                "10.0.0.9",
                "10.0.0.255",
                "`ip_address` is \"10.0.0.255\": it must be an address of one computer",
            ),
            ("[default_force]", "[default_force.more]", "it holds"),
            (
                "version = 1",
                "version = 2",
                "`version` is 2: only 1 can be read",
            ),
            ("version = 1\n", "", "`version` is missing"),
            (
                "handscope-params",
                "handscope-poses",
                "no file of parameters",
            ),
            ("crew = 3", "crew = ", "line 3"),
            (
                "crew = 3",
                "why = 3",
                "`why` is 3: it must be text in quotes",
            ),
            ("crew = 3", "default_force = 3", "line 11"),
        ] {
            let text = TEXT.replace(from, to);
            match read(&text) {
                Err(error) => {
                    let told = error.to_string();
                    assert!(told.contains(words) && !told.contains('\n'), "{told}");
                }
                // What is not a joint is a key that is not known.
                Ok(file) => assert!(
                    words == "it holds" && !file.unknown_keys().is_empty(),
                    "{to}"
                ),
            }
        }
        let empty = "format = \"handscope-params\"\nversion = 1\n";
        assert_eq!(read(empty), Err(ParamsFileError::Empty));
    }

    #[test]
    fn a_folder_a_long_file_and_none_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.toml");
        assert!(matches!(load(&path), Err(ParamsFileError::Unreadable(_))));
        assert!(matches!(
            load(folder.path()),
            Err(ParamsFileError::Unreadable(_))
        ));
        std::fs::write(&path, " ".repeat(70_000)).unwrap();
        assert_eq!(load(&path), Err(ParamsFileError::TooLong { got: 70_000 }));
        std::fs::write(&path, TEXT).unwrap();
        assert_eq!(load(&path), read(TEXT));
    }

    proptest! {
        #[test]
        fn no_text_makes_the_reader_fall_and_what_it_takes_may_be_written(
            lines in prop::collection::vec("(hand_id|redu_ratio|ip_address|crew) = (-?[0-9]{1,12}|\"[0-9.]{0,16}\")", 0..4),
            joints in prop::collection::vec("(little|ring|middle|index|six) = -?[0-9]{1,6}", 0..4),
        ) {
            let text = format!("format = \"{FORMAT}\"\nversion = 1\n{}\n[default_speed]\n{}\n", lines.join("\n"), joints.join("\n"));
            if let Ok(file) = read(&text) {
                for (id, value) in file.params.iter() {
                    prop_assert!(id.allows(value));
                }
                prop_assert_eq!(read(&file.to_toml()), Ok(file));
            }
        }
    }
}
