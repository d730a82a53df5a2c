//! Parameters as TOML, version 1 (assets/manual/files.md). A file is accepted as a whole or rejected; unknown keys are preserved
//! and listed.

use crate::params::rows::{DEFAULT_FORCE, DEFAULT_SPEED, ParamId};
use crate::params::values::Params;
use crate::record::{SaveDoubt, Saved};
use crate::store::toml_file::{self, VERSION};
use crate::store::{FileCause, FileError, FileText};
use std::path::Path;
use toml::Table;

/// The suggested name of a parameter file.
pub const FILE_NAME: &str = "handscope-params.toml";

/// The `format` value of a parameter file.
pub const FORMAT: &str = "handscope-params";
/// Maximum size; a parameter file is about a page of text.
pub const FILE_LEN_MAX: u64 = 64 * 1024;

/// The tables with one line per joint.
const GROUPS: [&str; 2] = [DEFAULT_SPEED, DEFAULT_FORCE];

#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParamsFile {
    /// Endpoint from which the values were read; empty if there is none.
    pub hand: String,
    /// Date and time in UTC; empty if unknown.
    pub at: String,
    /// Reason for the file: `dump`, `before save`, …
    pub why: String,
    /// Result of the SAVE, in a record of saved values.
    pub verdict: Option<SaveVerdict>,
    pub params: Params,
    /// Keys of a later version, preserved.
    pub others: Table,
}

/// Result of a SAVE. Files and JSON hold its `Display` text, which `FromStr` parses.
#[derive(Debug, Clone, PartialEq, Eq, strum::Display, strum::EnumString)]
#[strum(serialize_all = "snake_case")]
pub enum SaveVerdict {
    Confirmed,
    ReadBack,
    Failed,
    Refused,
    NotSent,
    /// About to be sent; the program ended before the result.
    #[strum(serialize = "unknown: under way")]
    UnderWay,
    #[strum(serialize = "unknown: no result")]
    NoResult,
    #[strum(serialize = "unknown: not acknowledged")]
    Unanswered,
    #[strum(serialize = "unknown: not read back")]
    NotReadBack,
    #[strum(serialize = "unknown: link lost")]
    LinkLost,
    /// A text of another version of this program.
    #[strum(default)]
    Other(String),
}

impl SaveVerdict {
    /// True if flash may or may not hold the values.
    pub const fn is_in_doubt(&self) -> bool {
        !matches!(
            self,
            Self::Confirmed | Self::ReadBack | Self::Failed | Self::Refused | Self::NotSent
        )
    }
}

impl From<&Saved> for SaveVerdict {
    fn from(saved: &Saved) -> Self {
        match saved {
            Saved::Confirmed => Self::Confirmed,
            Saved::ReadBack => Self::ReadBack,
            Saved::Failed { .. } => Self::Failed,
            Saved::Unknown { why } => match why {
                SaveDoubt::NoResult => Self::NoResult,
                SaveDoubt::Unanswered => Self::Unanswered,
                SaveDoubt::NotReadBack => Self::NotReadBack,
                SaveDoubt::LinkLost => Self::LinkLost,
            },
            Saved::Refused { .. } => Self::Refused,
            Saved::NotSent(_) => Self::NotSent,
        }
    }
}

impl ParamsFile {
    /// Result of the SAVE as text; empty if there is none.
    pub fn verdict_text(&self) -> String {
        let verdict = self.verdict.as_ref();
        verdict.map(SaveVerdict::to_string).unwrap_or_default()
    }

    /// The file as TOML text.
    pub fn to_toml(&self) -> String {
        let mut table = Table::new();
        put(&mut table, "format", FORMAT);
        put(&mut table, "version", VERSION);
        let words = [
            ("hand", &self.hand),
            ("at", &self.at),
            ("why", &self.why),
            ("verdict", &self.verdict_text()),
        ];
        for (key, text) in words.into_iter().filter(|(_, text)| !text.is_empty()) {
            put(&mut table, key, text.as_str());
        }
        for (id, value) in self.params.iter() {
            put(&mut table, &id.name(), value);
        }
        for (key, value) in &self.others {
            match (table.get_mut(key), value) {
                (Some(toml::Value::Table(known)), toml::Value::Table(others)) => {
                    known.extend(others.clone());
                }
                (Some(_), _) => {}
                (None, _) => {
                    table.insert(key.clone(), value.clone());
                }
            }
        }
        // A table of texts, numbers and tables always serializes.
        toml::to_string(&table).unwrap_or_default()
    }

    /// Names of unknown keys, with their group as a prefix.
    pub fn unknown_keys(&self) -> Vec<String> {
        let keys = self.others.iter().flat_map(|(key, value)| match value {
            toml::Value::Table(inner) if GROUPS.contains(&key.as_str()) => {
                inner.keys().map(|inner| format!("{key}.{inner}")).collect()
            }
            _ => vec![key.clone()],
        });
        keys.collect()
    }
}

/// Parses the text of a file.
///
/// # Errors
/// The first error, with the name of the field.
pub fn read(text: &str) -> Result<ParamsFile, FileError> {
    let mut table: Table = FileText::of(text, FORMAT)?.parse()?;
    for head in ["format", "version"] {
        table.remove(head);
    }
    let mut file = ParamsFile {
        hand: word(&mut table, "hand")?,
        at: word(&mut table, "at")?,
        why: word(&mut table, "why")?,
        // Parsing never fails: an unknown text is `Other`.
        verdict: Some(word(&mut table, "verdict")?)
            .filter(|text| !text.is_empty())
            .and_then(|text| text.parse().ok()),
        ..ParamsFile::default()
    };
    for name in GROUPS {
        let allowed = || format!("a table, [{name}], with a line for each joint");
        let group = table.get(name);
        if let Some(got) = group.filter(|group| !group.is_table()) {
            return Err(bad_value(name, got, allowed()));
        }
    }
    for id in ParamId::all() {
        let Some(got) = remove(&mut table, &id.name()) else {
            continue;
        };
        let value = got.clone().try_into().ok();
        let value = value.filter(|value| id.allows(*value));
        let value = value.ok_or_else(|| bad_value(&id.name(), &got, id.allowed()))?;
        file.params.put(id, value);
    }
    if file.params.is_empty() {
        return Err(FileCause::Empty.into());
    }
    table.retain(|name, value| {
        let is_empty = value.as_table().is_some_and(Table::is_empty);
        !(is_empty && GROUPS.contains(&name))
    });
    file.others = table;
    Ok(file)
}

/// Reads a file chosen by the user.
///
/// # Errors
/// The first error.
pub fn load(path: &Path) -> Result<ParamsFile, FileError> {
    toml_file::load(path, FILE_LEN_MAX, read)
}

fn word(table: &mut Table, field: &str) -> Result<String, FileError> {
    match remove(table, field) {
        None => Ok(String::new()),
        Some(toml::Value::String(text)) => Ok(text),
        Some(got) => Err(bad_value(field, &got, "text in quotes".into())),
    }
}

fn bad_value(field: &str, got: &toml::Value, allowed: String) -> FileError {
    FileError {
        line: None,
        field: Some(field.into()),
        cause: FileCause::Value {
            got: got.to_string(),
            allowed,
        },
    }
}

/// Removes and returns the value of a name; a dot separates group and key.
fn remove(table: &mut Table, name: &str) -> Option<toml::Value> {
    match name.split_once('.') {
        Some((group, key)) => table.get_mut(group)?.as_table_mut()?.remove(key),
        None => table.remove(name),
    }
}

/// Inserts a value under a name; a dot separates group and key.
fn put(table: &mut Table, name: &str, value: impl Into<toml::Value>) {
    let Some((group, key)) = name.split_once('.') else {
        table.insert(name.into(), value.into());
        return;
    };
    let group = table.entry(group).or_insert_with(|| Table::new().into());
    if let Some(group) = group.as_table_mut() {
        group.insert(key.into(), value.into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::rows::Value;
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
                "`default_speed.index`: 1001 is not a whole number from 0 to 1000",
            ),
            ("index = 300", "index = 3.5", "`default_speed.index`: 3.5"),
            (
                "index = 300",
                "index = \"300\"",
                "`default_speed.index`: \"300\"",
            ),
            ("index = 300", "index = nan", "`default_speed.index`: nan"),
            (
                "hand_id = 7",
                "hand_id = 0",
                "`hand_id`: 0 is not a whole number from 1 to 254",
            ),
            ("hand_id = 7", "redu_ratio = 4", "`redu_ratio`: 4"),
            (
                "10.0.0.9",
                "10.0.0.255",
                "`ip_address`: \"10.0.0.255\" is not an address of one computer",
            ),
            ("[default_force]", "[default_force.more]", "it holds"),
            (
                "version = 1",
                "version = 2",
                "line 2, `version`: version 2 cannot be read, only version 1",
            ),
            ("version = 1\n", "", "`version`: it is missing: add it"),
            (
                "handscope-params",
                "handscope-poses",
                "another kind of file",
            ),
            ("crew = 3", "crew = ", "line 3"),
            ("crew = 3", "why = 3", "`why`: 3 is not text in quotes"),
            ("crew = 3", "default_force = 3", "line 11"),
        ] {
            let text = TEXT.replace(from, to);
            match read(&text) {
                Err(error) => {
                    let told = error.to_string();
                    assert!(told.contains(words) && !told.contains('\n'), "{told}");
                }
                // A name that is not a joint is an unknown key.
                Ok(file) => assert!(
                    words == "it holds" && !file.unknown_keys().is_empty(),
                    "{to}"
                ),
            }
        }
        let empty = "format = \"handscope-params\"\nversion = 1\n";
        assert_eq!(read(empty), Err(FileCause::Empty.into()));
    }

    #[test]
    fn a_folder_a_long_file_and_none_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.toml");
        let is_unreadable = |path: &Path| {
            let error = load(path).unwrap_err();
            matches!(error.cause, FileCause::Unreadable(_))
        };
        assert!(is_unreadable(&path));
        assert!(is_unreadable(folder.path()));
        std::fs::write(&path, " ".repeat(70_000)).unwrap();
        let long = load(&path).unwrap_err().to_string();
        assert!(long.contains("70000") && long.contains("65536"), "{long}");
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
