//! A recording as a rosbag2 folder: a copy of the time range, and beside it the `metadata.yaml` that ROS 2 reads first.

use crate::record::export::cut::{Copied, copy};
use crate::record::export::output::{Destination, ExportError, Exported, Sink, Unfinished};
use crate::record::export::source::ExportSource;
use crate::record::file::format::topic::{QUALITY, Topic};
use crate::record::file::writer::Counted;
use std::fmt::Write as _;
use std::fs;
use std::io::{self, BufWriter};

/// Version of `metadata.yaml`: the oldest with the times of each file; newer readers accept it.
const VERSION: u32 = 5;

/// Writes a time range as a folder.
///
/// # Errors
/// [`ExportError`]; then there is no folder.
pub(crate) fn write(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    let name = to
        .folder_path()?
        .file_name()
        .unwrap_or_default()
        .to_string_lossy();
    let name = format!("{name}_0.mcap");
    let output = Unfinished::new(to)?;
    let folder = output.folder()?;
    let error = |error: io::Error| output.error(&error);
    let made = Sink::File(fs::File::create_new(folder.join(&name)).map_err(error)?);
    let copied = copy(source, BufWriter::new(made), |_| None);
    let Copied {
        exported,
        counted,
        to,
    } = copied.map_err(|error| error.of(&output))?;
    output.sync(to)?;
    fs::write(folder.join("metadata.yaml"), metadata(&counted, &name)).map_err(error)?;
    let rows = counted.all();
    output.finish(rows)?;
    Ok(Exported { rows, ..exported })
}

/// Content of `metadata.yaml` for a file of this name.
fn metadata(counted: &Counted, name: &str) -> String {
    let (first, last) = counted.times;
    let (length, messages) = (last - first, counted.all());
    // In YAML a name in single quotes is always text.
    let name = name.replace('\'', "''");
    let mut topics = String::new();
    let counts = Topic::all().map(|topic| (topic, counted.messages.get(&topic.channel())));
    for (topic, count) in counts.filter_map(|(topic, count)| Some((topic, count?))) {
        // The same as in the file, or some readers find no messages.
        let quality = topic.quality().unwrap_or_default().replace('\n', "\\n");
        // Writing to a string cannot fail.
        let _done = write!(
            topics,
            "    - topic_metadata:
        name: {}
        type: {}
        serialization_format: cdr
        {QUALITY}: \"{quality}\"
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
