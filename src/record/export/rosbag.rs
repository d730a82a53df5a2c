//! A session as a rosbag2 folder: a copy of the stretch, and beside it the `metadata.yaml` that ROS 2 reads first.

use crate::record::export::cut::copy;
use crate::record::export::output::{ExportError, Exported, Unfinished, unreadable};
use crate::record::file::SessionFile;
use crate::record::file::reader::Stretch;
use crate::record::file::topic::Topic;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::{self, BufWriter};
use std::path::Path;

/// The version of `metadata.yaml`: the oldest that names each file's own times; newer readers take it.
const VERSION: u32 = 5;

/// Writes a stretch as a folder.
///
/// # Errors
/// [`ExportError`]; then there is no folder.
pub fn write(file: &SessionFile, stretch: Stretch, path: &Path) -> Result<Exported, ExportError> {
    let output = Unfinished::new(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = format!("{name}_0.mcap");
    let folder = output.folder()?;
    let error = |error: io::Error| output.error(&error);
    let bag = folder.join(&name);
    let made = fs::File::create_new(&bag).map_err(error)?;
    let (mut exported, to) =
        copy(file, stretch, BufWriter::new(made), |_| None).map_err(|error| error.of(&output))?;
    output.sync(to)?;
    let counted = Counted::of(&bag)?;
    fs::write(folder.join("metadata.yaml"), counted.yaml(&name)).map_err(error)?;
    exported.rows = counted.messages();
    output.finish()?;
    Ok(exported)
}

/// What is in the copy.
struct Counted {
    topics: BTreeMap<u16, (Topic, u64)>,
    first_nanos: u64,
    last_nanos: u64,
}

impl Counted {
    fn of(bag: &Path) -> Result<Self, ExportError> {
        let copy = SessionFile::open(bag).map_err(|error| ExportError::Unreadable {
            message: error.to_string(),
        })?;
        let mut counted = Self {
            topics: BTreeMap::new(),
            first_nanos: u64::MAX,
            last_nanos: 0,
        };
        let all = copy.messages(
            Stretch::WHOLE.from,
            Stretch::WHOLE.to,
            |topic, (received, _), _| {
                let (_, count) = counted.topics.entry(topic.channel()).or_insert((topic, 0));
                *count += 1;
                counted.first_nanos = counted.first_nanos.min(received);
                counted.last_nanos = counted.last_nanos.max(received);
            },
        );
        all.map_err(|error| unreadable(&error))?;
        counted.first_nanos = counted.first_nanos.min(counted.last_nanos);
        Ok(counted)
    }

    fn messages(&self) -> u64 {
        self.topics.values().map(|(_, count)| count).sum()
    }

    fn yaml(&self, name: &str) -> String {
        let (first, messages) = (self.first_nanos, self.messages());
        let length = self.last_nanos - self.first_nanos;
        // A name in single quotes is a text whatever it holds.
        let name = name.replace('\'', "''");
        let mut topics = String::new();
        for (topic, count) in self.topics.values() {
            // Writing to a string cannot fail.
            let _done = write!(
                topics,
                "    - topic_metadata:
        name: {}
        type: {}
        serialization_format: cdr
        offered_qos_profiles: ''
      message_count: {count}
",
                topic.name(),
                topic.schema().name
            );
        }
        format!(
            "rosbag2_bagfile_information:
  version: {VERSION}
  storage_identifier: mcap
  duration:
    nanoseconds: {length}
  starting_time:
    nanoseconds_since_epoch: {first}
  message_count: {messages}
  topics_with_message_count:
{topics}  compression_format: ''
  compression_mode: ''
  relative_file_paths:
    - '{name}'
  files:
    - path: '{name}'
      starting_time:
        nanoseconds_since_epoch: {first}
      duration:
        nanoseconds: {length}
      message_count: {messages}
"
        )
    }
}
