//! Messages of the Foxglove WebSocket protocol needed by a read-only server: server info, topics, and messages of subscribed topics.
//! The topics are those of a recording.
//!
//! <https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md>

use crate::record::file::Opening;
use crate::record::file::format::encode::{EncodedMessage, EntryEncoder};
use crate::record::file::format::topic::Topic;
use serde::Deserialize;
use serde_json::json;

/// Names of the subprotocol, the newer one first. Foxglove and PlotJuggler use the newer one, Lichtblick and older clients the
/// other; the messages used here are the same under both.
pub const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// Opcode of a topic's message.
const MESSAGE_DATA: u8 = 1;
/// Levels of a status.
const WARNING: u8 = 1;
const ERROR: u8 = 2;

/// A viewer's request.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
pub(crate) enum ViewerRequest {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    /// A request that this server does not offer.
    #[serde(other)]
    Other,
}

/// A viewer's subscription to a channel, under an id of its own choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Subscription {
    pub(crate) id: u32,
    pub(crate) channel_id: u64,
}

impl Subscription {
    /// Topic of the channel; `None` if there is none with this number.
    pub(crate) fn topic(self) -> Option<Topic> {
        Topic::by_channel(u16::try_from(self.channel_id).ok()?)
    }
}

/// Messages that each viewer receives at the start.
#[derive(Debug)]
pub(crate) struct Greeting {
    /// Server info and topics, sent first.
    pub(crate) texts: [String; 2],
    /// Messages that do not change: the model, and its fixed frames.
    lasting: [EncodedMessage; 2],
}

impl Greeting {
    pub(crate) fn new(opening: &Opening) -> Self {
        Self {
            texts: texts(opening),
            lasting: EntryEncoder::live(opening).lasting(opening.began),
        }
    }

    /// Message with which a subscription to this topic begins; `None` if it comes as the hand is read.
    pub(crate) fn lasting(&self, topic: Topic) -> Option<&EncodedMessage> {
        self.lasting.iter().find(|message| message.topic == topic)
    }
}

/// Server info of the hand, and the topics of its recording.
fn texts(opening: &Opening) -> [String; 2] {
    let badge = if opening.simulated {
        " (SIMULATED)"
    } else {
        ""
    };
    let info = json!({
        "op": "serverInfo",
        "name": format!("Handscope {}{badge}", opening.hand),
        // Publishing, services, parameters and assets are not offered.
        "capabilities": [],
        "metadata": { "version": opening.version, "simulated": opening.simulated.to_string() },
        "sessionId": opening.began_since_1970().as_nanos().to_string(),
    });
    let channel = |topic: Topic| {
        let schema = topic.schema();
        json!({
            "id": topic.channel(),
            "topic": topic.name(),
            "encoding": "cdr",
            "schemaName": schema.name,
            "schemaEncoding": "ros2msg",
            "schema": schema.text,
        })
    };
    let channels: Vec<_> = Topic::all().map(channel).collect();
    let topics = json!({ "op": "advertise", "channels": channels });
    [info, topics].map(|message| message.to_string())
}

/// Encodes a message for this subscription.
pub(crate) fn message_data(subscription: u32, message: &EncodedMessage) -> Vec<u8> {
    let mut data = Vec::with_capacity(13 + message.bytes.len());
    data.push(MESSAGE_DATA);
    data.extend(subscription.to_le_bytes());
    data.extend(message.log_nanos.to_le_bytes());
    data.extend(&message.bytes);
    data
}

/// Status message: a request was ignored.
pub(crate) fn warning(words: &str) -> String {
    status(WARNING, words)
}

/// Status message: a request was not understood.
pub(crate) fn error(words: &str) -> String {
    status(ERROR, words)
}

fn status(level: u8, words: &str) -> String {
    json!({ "op": "status", "level": level, "message": words }).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Finger;

    #[test]
    fn what_viewers_ask_is_understood_and_the_rest_is_said_to_be_other() {
        let wanted = |id, channel_id| Subscription { id, channel_id };
        for (text, meant) in [
            (
                r#"{"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":12,"new":0}]}"#,
                ViewerRequest::Subscribe {
                    subscriptions: vec![wanted(7, 1), wanted(8, 12)],
                },
            ),
            (
                r#"{"op":"unsubscribe","subscriptionIds":[7]}"#,
                ViewerRequest::Unsubscribe {
                    subscription_ids: vec![7],
                },
            ),
            (r#"{"op":"advertise","channels":[]}"#, ViewerRequest::Other),
            (r#"{"op":"getParameters"}"#, ViewerRequest::Other),
        ] {
            assert_eq!(serde_json::from_str::<ViewerRequest>(text).unwrap(), meant);
        }
        for nonsense in [
            "",
            "[]",
            "{}",
            r#"{"op":1}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}"#,
        ] {
            assert!(
                serde_json::from_str::<ViewerRequest>(nonsense).is_err(),
                "{nonsense}"
            );
        }
        assert_eq!(wanted(0, 12).topic(), Some(Topic::Touch(Finger::Thumb)));
        for none in [0, 17, 65537, u64::MAX] {
            assert_eq!(wanted(0, none).topic(), None);
        }
    }

    #[test]
    fn a_message_is_a_one_the_number_the_time_and_the_bytes() {
        let message = EncodedMessage {
            topic: Topic::State,
            log_nanos: 0x0102_0304_0506_0708,
            publish_nanos: 0,
            bytes: vec![0, 1, 0, 0, 9],
        };
        let data = message_data(0x0A0B_0C0D, &message);
        let head = [1, 0x0D, 0x0C, 0x0B, 0x0A, 8, 7, 6, 5, 4, 3, 2, 1];
        assert_eq!(data, [&head[..], &[0, 1, 0, 0, 9]].concat());
    }
}
