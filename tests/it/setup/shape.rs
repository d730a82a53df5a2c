//! The JSON of each command is a contract: its keys and the types of their values stand in `shapes/`, one file for each command.
//! Every line that a test reads of a command is compared. `HANDSCOPE_WRITE_SHAPES=1` adds what is new, for a change that is meant;
//! what went has to be removed by hand.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;

/// What may stand at a path.
#[derive(Debug, Default, Clone, PartialEq)]
struct Place {
    types: BTreeSet<String>,
    /// Keys that each object there has; `None` while no object was seen.
    always: Option<BTreeSet<String>>,
}

/// All paths of the lines of a command. A line with one key is of the kind of that key; all others are of one kind.
#[derive(Debug, Default, Clone, PartialEq)]
struct Shape(BTreeMap<String, Place>);

/// The lines of a command that was not killed have the shape of its file: no key more, none less, and no value of another type.
pub(crate) fn check_shape(command: &str, lines: &[Value]) {
    let mut got = Shape::default();
    lines.iter().for_each(|line| got.add_line(line));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/cli/shapes");
    let path = folder.join(format!("{command}.txt"));
    let known = || Shape::parse(&std::fs::read_to_string(&path).unwrap_or_default());
    if std::env::var_os("HANDSCOPE_WRITE_SHAPES").is_some() {
        static FILES: Mutex<()> = Mutex::new(());
        let _one = FILES.lock().unwrap();
        std::fs::write(&path, known().joined(&got).print()).unwrap();
        return;
    }
    // Not under a lock: a test that fails here and is tried again must not fail the others.
    let wrong = known().differs(&got);
    assert!(
        wrong.is_empty(),
        "the JSON of {command} changed:\n{}",
        wrong.join("\n")
    );
}

impl Shape {
    fn add_line(&mut self, line: &Value) {
        match line.as_object() {
            Some(keys) if keys.len() == 1 => {
                for (key, value) in keys {
                    self.add(key, value);
                }
            }
            _ => self.add("", line),
        }
    }

    fn add(&mut self, path: &str, value: &Value) {
        let place = self.0.entry(path.into()).or_default();
        let kind = match value {
            Value::Null => "null",
            Value::Bool(_) => "bool",
            Value::Number(_) => "number",
            Value::String(_) => "string",
            Value::Array(_) => "array",
            Value::Object(_) => "object",
        };
        place.types.insert(kind.into());
        match value {
            Value::Array(items) => {
                for item in items {
                    self.add(&format!("{path}[]"), item);
                }
            }
            Value::Object(keys) => {
                let own = keys.keys().cloned().collect();
                place.always = Some(match place.always.take() {
                    Some(before) => &before & &own,
                    None => own,
                });
                for (key, value) in keys {
                    self.add(&format!("{path}.{key}"), value);
                }
            }
            _ => {}
        }
    }

    fn joined(mut self, other: &Self) -> Self {
        for (path, new) in &other.0 {
            let known = self.0.entry(path.clone()).or_default();
            known.types.extend(new.types.iter().cloned());
            known.always = match (known.always.take(), new.always.clone()) {
                (Some(known), Some(new)) => Some(&known & &new),
                (known, new) => known.or(new),
            };
        }
        self
    }

    /// What of another is not as here.
    fn differs(&self, other: &Self) -> Vec<String> {
        let mut wrong = Vec::new();
        for (path, got) in &other.0 {
            let kind = path.split(['.', '[']).next().unwrap_or_default();
            if !self.0.contains_key(kind) {
                // Lines of a kind that comes seldom.
                continue;
            }
            let Some(known) = self.0.get(path) else {
                wrong.push(format!("new: {path} {:?}", got.types));
                continue;
            };
            // Any value may be unknown.
            let kinds = got.types.difference(&known.types);
            let kinds: Vec<&String> = kinds.filter(|kind| *kind != "null").collect();
            let was_known = known.types.iter().any(|kind| kind != "null");
            if was_known && !kinds.is_empty() {
                wrong.push(format!("{path}: {kinds:?} besides {:?}", known.types));
            }
            let missing = known.always.iter().zip(&got.always);
            for key in missing.flat_map(|(known, got)| known - got) {
                wrong.push(format!("missing: {path}.{key}"));
            }
        }
        wrong
    }

    /// A line for each path, with `?` where a key is not in each object.
    fn print(&self) -> String {
        let mut text = String::new();
        for (path, place) in &self.0 {
            let types: Vec<&str> = place.types.iter().map(String::as_str).collect();
            let parent = path.rsplit_once('.');
            let parent = parent.and_then(|(parent, key)| Some((self.0.get(parent)?, key)));
            let always =
                parent.and_then(|(parent, key)| Some(parent.always.as_ref()?.contains(key)));
            let mark = if always == Some(false) { "?" } else { "" };
            writeln!(text, "{path}{mark}: {}", types.join("|")).unwrap();
        }
        text
    }

    fn parse(text: &str) -> Self {
        let mut shape = Self::default();
        for line in text.lines() {
            let (path, types) = line.split_once(": ").unwrap();
            let (path, is_always) = match path.strip_suffix('?') {
                Some(path) => (path, false),
                None => (path, true),
            };
            let types: BTreeSet<String> = types.split('|').map(str::to_owned).collect();
            let always = types.contains("object").then(BTreeSet::new);
            shape.0.insert(path.into(), Place { types, always });
            if let Some((parent, key)) = path.rsplit_once('.').filter(|_| is_always)
                && let Some(Place {
                    always: Some(keys), ..
                }) = shape.0.get_mut(parent)
            {
                keys.insert(key.into());
            }
        }
        shape
    }
}

#[test]
fn a_key_more_a_key_less_and_another_type_are_noticed() {
    let shape = |lines: &[&str]| {
        let mut shape = Shape::default();
        for line in lines {
            shape.add_line(&serde_json::from_str(line).unwrap());
        }
        shape
    };
    let known = shape(&[
        r#"{"grip": {"end": "held", "gap": {"mm": 1.0}}}"#,
        r#"{"grip": {"end": "held", "gap": {"mm": null, "why": "old"}}}"#,
        r#"{"t": 1, "all": [1, 2]}"#,
    ]);
    assert_eq!(Shape::parse(&known.print()), known);
    for (line, is_known) in [
        (r#"{"grip": {"end": "late", "gap": {"mm": null}}}"#, true),
        (r#"{"grip": {"end": "late", "gap": {"mm": 2}}}"#, true),
        (r#"{"grip": {"end": "late"}}"#, false),
        (r#"{"grip": {"end": "late", "gap": {"mm": "2"}}}"#, false),
        (
            r#"{"grip": {"end": "late", "gap": {"mm": 2, "x": 0}}}"#,
            false,
        ),
        (r#"{"t": 1, "all": []}"#, true),
        (r#"{"t": null, "all": [null]}"#, true),
        (r#"{"t": 1, "all": ["2"]}"#, false),
        (r#"{"t": 1, "other": 1}"#, false),
        (r#"{"seldom": 1}"#, true),
    ] {
        let wrong = known.differs(&shape(&[line]));
        assert_eq!(wrong.is_empty(), is_known, "{line}: {wrong:?}");
    }
}
