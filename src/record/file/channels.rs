//! The channels and schemas of a file, matched by name: channel numbers differ between programs.

use crate::record::file::format::topic::Topic;
use mcap::records::Record;
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of definitions of each kind read from one file. Ours have sixteen.
const DEFINITIONS_MAX: usize = 1024;
/// Maximum characters of a name, and of a schema's text.
const NAME_MAX: usize = 200;
const FIELDS_MAX: usize = 4096;
/// Encodings of our messages and schemas.
const MESSAGES_IN: &str = "cdr";
const SCHEMAS_IN: &str = "ros2msg";

/// A schema as a file defines it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct FileSchema {
    name: String,
    encoding: String,
    fields: String,
}

/// A channel as a file defines it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Channel {
    schema: u16,
    topic: String,
    encoding: String,
}

/// Messages that are not read, and the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SkippedTopic {
    pub topic: String,
    /// Name of its schema; empty if it has none.
    pub schema: String,
    /// Encoding of its messages.
    pub encoding: String,
    /// Number of messages.
    pub messages: u64,
    pub why: SkipReason,
}

/// Reason why messages are not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkipReason {
    /// The topic is not one of Handscope's.
    Unknown,
    /// The topic is known, but its schema or encoding differs.
    OtherSchema,
    /// The schema has the right name, but different fields.
    OtherFields,
    /// The file does not define the channel.
    Undefined,
    /// The file defines the channel twice, differently.
    Contradicted,
}

impl SkippedTopic {
    /// True if the topic is Handscope's, so that part of the recording is missing.
    pub const fn is_ours(&self) -> bool {
        !matches!(self.why, SkipReason::Unknown)
    }
}

impl std::fmt::Display for SkippedTopic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            topic,
            schema,
            encoding,
            messages,
            why,
        } = self;
        let why = match why {
            SkipReason::Unknown => "not Handscope's",
            SkipReason::OtherSchema => "Handscope's has another schema or encoding",
            SkipReason::OtherFields => "Handscope's schema of that name has other fields",
            SkipReason::Undefined => "no channel describes them",
            SkipReason::Contradicted => "the file defines this channel twice, differently",
        };
        write!(
            f,
            "skipped: topic {topic} with schema '{schema}' in '{encoding}', {messages} messages: {why}"
        )
    }
}

/// All definitions of a file, and the number of messages of each channel.
#[derive(Debug, Clone, Default)]
pub(crate) struct Definitions {
    schemas: BTreeMap<u16, FileSchema>,
    channels: BTreeMap<u16, Channel>,
    contradicted: BTreeMap<u16, ()>,
    counts: BTreeMap<u16, u64>,
}

impl Definitions {
    /// Adds the record of a schema or a channel.
    pub(crate) fn push(&mut self, code: u8, record: &[u8]) {
        match mcap::parse_record(code, record) {
            Ok(Record::Schema { header, data }) => {
                let schema = FileSchema {
                    name: clipped(&header.name, NAME_MAX),
                    encoding: clipped(&header.encoding, NAME_MAX),
                    fields: fields(&String::from_utf8_lossy(&data)),
                };
                if self.schemas.len() < DEFINITIONS_MAX {
                    self.schemas.entry(header.id).or_insert(schema);
                }
            }
            Ok(Record::Channel(read)) => {
                let channel = Channel {
                    schema: read.schema_id,
                    topic: clipped(&read.topic, NAME_MAX),
                    encoding: clipped(&read.message_encoding, NAME_MAX),
                };
                let is_other = |there: &Channel| *there != channel;
                if self.channels.get(&read.id).is_some_and(is_other) {
                    self.contradicted.insert(read.id, ());
                } else if self.channels.len() < DEFINITIONS_MAX {
                    self.channels.insert(read.id, channel);
                }
            }
            _ => {}
        }
    }

    pub(crate) fn count(&mut self, channel: u16) {
        *self.counts.entry(channel).or_default() += 1;
    }

    /// True if the file defines this channel.
    pub(crate) fn has(&self, channel: u16) -> bool {
        self.channels.contains_key(&channel)
    }

    /// True if there are no definitions and no counted messages.
    pub(crate) fn is_empty(&self) -> bool {
        self.channels.is_empty() && self.counts.is_empty()
    }

    /// Number of counted messages.
    pub(crate) fn messages(&self) -> u64 {
        self.counts.values().sum()
    }

    /// True if each topic has Handscope's channel number, and nothing else is defined. Older files lack the later topics.
    pub(crate) fn are_own(&self) -> bool {
        let is_defined = |topic: Topic| self.channels.contains_key(&topic.channel());
        let is_own = |(number, channel): (&u16, &Channel)| {
            let topic = Topic::by_channel(*number);
            topic.is_some_and(|topic| channel.topic == topic.name())
        };
        let mut since_the_first = Topic::all().filter(|topic| !topic.is_later());
        since_the_first.all(is_defined) && self.channels.iter().all(is_own)
    }

    /// Topics of the channels, and the skipped ones.
    pub(crate) fn topics(&self) -> (BTreeMap<u16, Topic>, Vec<SkippedTopic>) {
        let (mut topics, mut skipped) = (BTreeMap::new(), Vec::new());
        let numbers: BTreeSet<u16> = self
            .counts
            .keys()
            .chain(self.channels.keys())
            .copied()
            .collect();
        for number in numbers {
            let messages = self.counts.get(&number).copied().unwrap_or_default();
            match self.topic(number) {
                Ok(topic) if topic.is_stamped() => {
                    topics.insert(number, topic);
                }
                // Nothing is read of them, and where the log has no time, they have none either.
                Ok(_) => {}
                Err(why) if messages > 0 => skipped.push(self.skipped(number, messages, why)),
                Err(_) => {}
            }
        }
        (topics, skipped)
    }

    /// Namespaces that another program has put before our topics: one for each hand.
    pub(crate) fn namespaces(&self) -> BTreeSet<&str> {
        let ours = self.channels.iter().filter_map(|(number, channel)| {
            // Every robot has joint states and frames; ours are only a copy.
            let topic = self
                .topic(*number)
                .ok()
                .filter(|topic| !topic.is_common())?;
            namespace(&channel.topic, topic)
        });
        ours.collect()
    }

    fn topic(&self, number: u16) -> Result<Topic, SkipReason> {
        let channel = self.channels.get(&number).ok_or(SkipReason::Undefined)?;
        if self.contradicted.contains_key(&number) {
            return Err(SkipReason::Contradicted);
        }
        let topic = Topic::all().find(|topic| namespace(&channel.topic, *topic).is_some());
        let topic = topic.ok_or(SkipReason::Unknown)?;
        let schema = self.schemas.get(&channel.schema);
        let schema = schema.ok_or(SkipReason::OtherSchema)?;
        let is_ours = schema.name == topic.schema().name
            && schema.encoding == SCHEMAS_IN
            && channel.encoding == MESSAGES_IN;
        // Every robot has joint states and frames of that name; they add nothing to State.
        let other = |why| {
            if topic.is_common() {
                SkipReason::Unknown
            } else {
                why
            }
        };
        if !is_ours {
            Err(other(SkipReason::OtherSchema))
        } else if schema.fields == fields(topic.schema().text) {
            Ok(topic)
        } else {
            Err(other(SkipReason::OtherFields))
        }
    }

    fn skipped(&self, number: u16, messages: u64, why: SkipReason) -> SkippedTopic {
        let channel = self.channels.get(&number);
        let schema = channel.and_then(|channel| self.schemas.get(&channel.schema));
        SkippedTopic {
            topic: channel.map_or_else(|| format!("of channel {number}"), |one| one.topic.clone()),
            schema: schema.map_or_else(String::new, |schema| schema.name.clone()),
            encoding: channel.map_or_else(String::new, |one| one.encoding.clone()),
            messages,
            why,
        }
    }
}

/// Prefix of a topic's name: empty, or a namespace by which ROS 2 separates several robots; `None` for other names.
fn namespace(name: &str, topic: Topic) -> Option<&str> {
    let before = name.strip_suffix(topic.name())?;
    (before.is_empty() || before.starts_with('/')).then_some(before)
}

fn clipped(text: &str, letters: usize) -> String {
    text.chars().take(letters).collect()
}

/// Fields of a definition, one a line, without comments and nested definitions. Type names are normalised, as two spellings exist.
fn fields(text: &str) -> String {
    let lines = text.lines().take_while(|line| !line.starts_with("==="));
    let lines = lines.filter_map(|line| {
        let bare = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = bare.split_whitespace().collect();
        (!words.is_empty()).then(|| words.join(" ").replace("/msg/", "/"))
    });
    clipped(&lines.collect::<Vec<_>>().join("\n"), FIELDS_MAX)
}
