//! A hand as live viewers meet it: over a protocol and with a crate that are not ours, in virtual time, and through viewers of
//! bad manners. What they get is a recording's, and what they say changes nothing.

use crate::setup::{hand, link};
use crate::share::place::until;
use futures::{SinkExt as _, StreamExt as _};
use handscope::hand::kinematics::Side;
use handscope::hand::{Dof, Fault};
use handscope::link::{LinkHandle, Records};
use handscope::record::LinkState;
use handscope::record::file::Opening;
use handscope::record::file::format::cdr;
use handscope::record::file::format::encode::EncodedMessage;
use handscope::record::file::format::message::{
    EventMessage, JointState, StateMessage, TouchMessage,
};
use handscope::record::file::format::topic::Topic;
use handscope::share::foxglove::protocol::SUBPROTOCOLS;
use handscope::share::foxglove::viewer::{HANDSHAKE_TIMEOUT, SILENT_MAX, WRITE_TIMEOUT};
use handscope::share::foxglove::{BACKLOG_MAX, FoxgloveConfig, FoxgloveServer, VIEWERS_MAX};
use handscope::sim::SharedHand;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::runtime::Handle;
use tokio::time::{Instant, sleep, timeout};
use tokio_tungstenite::tungstenite::Message as Frame;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::http::HeaderValue;
use tokio_tungstenite::{WebSocketStream, client_async};

const SINCE_1970: Duration = Duration::from_secs(1_800_000_000);
/// The beginning of every WebSocket, of which half is no request.
const HELLO: &str = "GET / HTTP/1.1\r\nHost: hand\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
    Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\
    Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n";

/// A live hand that is shown.
struct Stage {
    hand: SharedHand,
    link: LinkHandle,
    server: FoxgloveServer,
    _records: Records,
}

async fn stage() -> Stage {
    let hand = hand::plain();
    let config = link::config("tcp:hand", link::to_hand(hand.clone()));
    let moments = (config.clock.now(), SINCE_1970);
    let (link, records) = handscope::link::open(config, &Handle::current());
    let config = FoxgloveConfig {
        address: ([127, 0, 0, 1], 0).into(),
        opening: Opening::begin("sim:".into(), moments, Side::Right),
    };
    let mut server = FoxgloveServer::open(config, &Handle::current()).unwrap();
    server.show(&link);
    until(|| link.status().state == LinkState::Monitoring).await;
    Stage {
        hand,
        link,
        server,
        _records: records,
    }
}

/// A viewer of good manners.
pub(crate) struct Client(WebSocketStream<TcpStream>);

impl Client {
    /// Connects, and takes the greeting.
    pub(crate) async fn of(server: &FoxgloveServer) -> (Self, [Value; 2]) {
        let stream = TcpStream::connect(server.address()).await.unwrap();
        let mut client = Self::over(stream, SUBPROTOCOLS[0]).await.unwrap();
        let greeting = [client.told().await, client.told().await];
        (client, greeting)
    }

    async fn over(stream: TcpStream, subprotocol: &str) -> Result<Self, String> {
        let mut request = "ws://hand".into_client_request().unwrap();
        let value = HeaderValue::from_str(subprotocol).unwrap();
        request
            .headers_mut()
            .insert("sec-websocket-protocol", value);
        let shaken = client_async(request, stream).await;
        let (socket, _) = shaken.map_err(|error| error.to_string())?;
        Ok(Self(socket))
    }

    async fn say(&mut self, what: Value) {
        self.0.send(Frame::text(what.to_string())).await.unwrap();
    }

    /// Subscribes to these, each under the number of its channel and a hundred.
    pub(crate) async fn subscribe(&mut self, topics: impl IntoIterator<Item = Topic>) {
        let wanted =
            |topic: Topic| json!({ "id": 100 + topic.channel(), "channelId": topic.channel() });
        let all: Vec<Value> = topics.into_iter().map(wanted).collect();
        self.say(json!({ "op": "subscribe", "subscriptions": all }))
            .await;
    }

    /// The next text.
    async fn told(&mut self) -> Value {
        loop {
            if let Frame::Text(text) = self.0.next().await.unwrap().unwrap() {
                return serde_json::from_str(&text).unwrap();
            }
        }
    }

    /// The next message, whole.
    async fn data(&mut self) -> Vec<u8> {
        loop {
            if let Frame::Binary(data) = self.0.next().await.unwrap().unwrap() {
                assert_eq!(data[0], 1);
                return data.to_vec();
            }
        }
    }

    /// The next message: its topic, its time and its bytes.
    pub(crate) async fn message(&mut self) -> (Topic, u64, Vec<u8>) {
        let data = self.data().await;
        let number = u32::from_le_bytes(data[1..5].try_into().unwrap());
        let nanos = u64::from_le_bytes(data[5..13].try_into().unwrap());
        let topic = Topic::by_channel(u16::try_from(number).unwrap() - 100);
        (topic.unwrap(), nanos, data[13..].to_vec())
    }
}

async fn connect(address: SocketAddr) -> TcpStream {
    TcpStream::connect(address).await.unwrap()
}

/// True once the other side hung up.
async fn is_closed(stream: &mut TcpStream, within: Duration) -> bool {
    let mut bytes = [0; 4096];
    let closed = timeout(within, async {
        while !matches!(stream.read(&mut bytes).await, Ok(0) | Err(_)) {}
    });
    closed.await.is_ok()
}

/// A message of so many bytes.
fn large(bytes: usize) -> EncodedMessage {
    EncodedMessage {
        topic: Topic::State,
        log_nanos: 1,
        publish_nanos: 1,
        bytes: vec![0; bytes],
    }
}

/// A viewer of good manners is shown the hand.
async fn shows(stage: &Stage) {
    let (mut client, _) = Client::of(&stage.server).await;
    client.subscribe([Topic::State]).await;
    let (_, _, bytes) = client.message().await;
    let state: StateMessage = cdr::decode(&bytes).unwrap();
    assert!(state.received.nanos() >= state.asked.nanos(), "{state:?}");
}

#[tokio::test(start_paused = true)]
async fn a_viewer_is_told_the_topics_and_definitions_of_a_recording() {
    let stage = stage().await;
    for name in SUBPROTOCOLS {
        let stream = connect(stage.server.address()).await;
        let mut client = Client::over(stream, &format!("other, {name}"))
            .await
            .unwrap();
        let info = client.told().await;
        assert_eq!(info["op"], "serverInfo");
        assert_eq!(info["name"], "Handscope sim: (SIMULATED)");
        assert_eq!(info["capabilities"], json!([]));
        let told = client.told().await;
        assert_eq!(told["op"], "advertise");
        let channels = told["channels"].as_array().unwrap();
        assert_eq!(channels.len(), Topic::all().count());
        for (channel, topic) in channels.iter().zip(Topic::all()) {
            assert_eq!(channel["id"], topic.channel());
            assert_eq!(channel["topic"], topic.name());
            assert_eq!(channel["schemaName"], topic.schema().name);
            assert_eq!(channel["schema"], topic.schema().text);
            assert_eq!(channel["encoding"], "cdr");
            assert_eq!(channel["schemaEncoding"], "ros2msg");
        }
    }
    let refused = Client::over(connect(stage.server.address()).await, "mqtt").await;
    assert!(refused.err().unwrap().contains("400"));
}

#[tokio::test(start_paused = true)]
async fn all_topics_come_as_they_happen_in_the_bytes_of_a_recording() {
    let stage = stage().await;
    let (mut client, _) = Client::of(&stage.server).await;
    client.subscribe(Topic::all()).await;
    until(|| stage.server.viewers()[0].topics == Topic::all().count()).await;
    stage.link.stop();
    stage
        .hand
        .with(|hand, _| hand.inject_fault(Dof::Ring, Fault::OverCurrent));
    let begun = Instant::now();
    let mut seen: BTreeMap<&str, Vec<(u64, Vec<u8>)>> = BTreeMap::new();
    while begun.elapsed() < Duration::from_secs(2) {
        let (topic, nanos, bytes) = client.message().await;
        seen.entry(topic.name()).or_default().push((nanos, bytes));
    }
    let names: Vec<&str> = seen.keys().copied().collect();
    let mut all: Vec<&str> = Topic::all().map(Topic::name).collect();
    all.sort_unstable();
    assert_eq!(names, all, "a stop is a command, and has a fate");
    let mut states = seen["/handscope/state"].iter();
    let angles = states.find_map(|(_, bytes)| {
        let state: StateMessage = cdr::decode(bytes).unwrap();
        (!state.angle.is_empty()).then_some(state.angle)
    });
    assert_eq!(angles.unwrap(), [1000; 6]);
    let (nanos, joints) = &seen["/joint_states"][9];
    let joints: JointState = cdr::decode(joints).unwrap();
    assert_eq!((joints.name.len(), joints.position.len()), (12, 12));
    assert_eq!(joints.header.stamp.nanos(), *nanos);
    assert_eq!(nanos / 1_000_000_000, SINCE_1970.as_secs());
    let touch: TouchMessage = cdr::decode(&seen["/handscope/touch/index"][0].1).unwrap();
    assert_eq!(touch.raw.len(), 58);
    let events = seen["/handscope/event"].iter();
    let kinds: Vec<String> = events
        .map(|(_, bytes)| cdr::decode::<EventMessage>(bytes).unwrap().kind)
        .collect();
    assert_eq!(kinds, ["stop", "fault"], "what a file derives is seen, too");
    let states = seen["/handscope/state"].len();
    assert!((150..=250).contains(&states), "{states} in two seconds");
}

#[tokio::test(start_paused = true)]
async fn the_model_comes_once_to_whoever_asks_and_its_joints_are_those_that_move() {
    let stage = stage().await;
    let (mut client, [_, topics]) = Client::of(&stage.server).await;
    let channel = topics["channels"].as_array().unwrap().last().unwrap();
    assert_eq!(channel["topic"], "/robot_description");
    assert_eq!(channel["schemaName"], "std_msgs/msg/String");
    let subscribe = json!({ "op": "subscribe", "subscriptions": [
        { "id": 7, "channelId": channel["id"] }, { "id": 8, "channelId": channel["id"] },
    ] });
    client.say(subscribe).await;
    let data = client.data().await;
    assert_eq!(data[..5], [1, 7, 0, 0, 0]);
    let model: String = cdr::decode(&data[13..]).unwrap();
    assert_eq!(client.told().await["level"], 1, "twice is ignored");
    client.subscribe([Topic::Joints]).await;
    let joints: JointState = cdr::decode(&client.message().await.2).unwrap();
    for name in joints.name {
        assert!(
            model.contains(&format!("<joint name=\"{name}\" type=\"revolute\"")),
            "{name}"
        );
    }
}

#[test]
fn the_layouts_name_topics_and_fields_that_there_are() {
    let is_path = |word: &&str| word.starts_with('/') && !word.starts_with("/>");
    let quoted = |text: &'static str| text.split('"').filter(is_path);
    let foxglove = include_str!("../../../assets/layouts/foxglove.json");
    let plotjuggler = include_str!("../../../assets/layouts/plotjuggler.xml");
    serde_json::from_str::<Value>(foxglove).unwrap();
    let paths: Vec<_> = quoted(foxglove).map(|path| (path, '.')).collect();
    let curves: Vec<_> = quoted(plotjuggler).map(|path| (path, '/')).collect();
    assert!(paths.len() > 20 && curves.len() > 20);
    for (path, before_field) in [paths, curves].concat() {
        let is_shown = |topic: &Topic| {
            let Some(rest) = path.strip_prefix(topic.name()) else {
                return false;
            };
            let field = rest.strip_prefix(before_field);
            let field = field.map(|field| field.split('[').next().unwrap_or_default());
            let has = |field| {
                let mut lines = topic.schema().text.lines();
                lines.any(|line| line.ends_with(&format!(" {field}")))
            };
            rest.is_empty() || field.is_some_and(has)
        };
        assert!(Topic::all().any(|topic| is_shown(&topic)), "{path}");
    }
}

#[tokio::test(start_paused = true)]
async fn only_what_was_subscribed_to_comes_and_it_ends_with_the_subscription() {
    let stage = stage().await;
    let (mut client, _) = Client::of(&stage.server).await;
    let quiet = timeout(Duration::from_secs(1), client.message()).await;
    assert!(quiet.is_err(), "{quiet:?}");
    client.subscribe([Topic::Joints]).await;
    for _ in 0..50 {
        assert_eq!(client.message().await.0, Topic::Joints);
    }
    let ids = [100 + Topic::Joints.channel()];
    client
        .say(json!({ "op": "unsubscribe", "subscriptionIds": ids }))
        .await;
    until(|| stage.server.viewers()[0].topics == 0).await;
    let rest = timeout(Duration::from_secs(1), async {
        loop {
            client.message().await;
        }
    });
    let _over = rest.await;
    let sent = stage.server.viewers()[0].sent;
    sleep(Duration::from_secs(1)).await;
    assert_eq!(stage.server.viewers()[0].sent, sent);
}

#[tokio::test(start_paused = true)]
async fn nothing_that_a_viewer_asks_for_beside_topics_is_done() {
    let stage = stage().await;
    let (mut client, _) = Client::of(&stage.server).await;
    for (said, level) in [
        (
            json!({ "op": "advertise", "channels": [{ "id": 1, "topic": "/cmd", "encoding": "cdr", "schemaName": "x" }] }),
            1,
        ),
        (
            json!({ "op": "setParameters", "parameters": [{ "name": "speed", "value": 1000 }] }),
            1,
        ),
        (
            json!({ "op": "subscribe", "subscriptions": [{ "id": 1, "channelId": 99 }] }),
            2,
        ),
        (json!({ "op": "subscribe" }), 2),
        (json!(["subscribe"]), 2),
    ] {
        client.say(said.clone()).await;
        let told = client.told().await;
        assert_eq!(
            (&told["op"], &told["level"]),
            (&json!("status"), &json!(level)),
            "{said}"
        );
    }
    // A message for a topic, and a call of a service.
    for opcode in [1, 2] {
        let data = vec![opcode, 1, 0, 0, 0, 9];
        client.0.send(Frame::Binary(data.into())).await.unwrap();
        assert_eq!(client.told().await["level"], 1);
    }
    client.subscribe([Topic::State, Topic::State]).await;
    assert_eq!(client.told().await["level"], 1, "twice is ignored");
    assert_eq!(client.message().await.0, Topic::State);
    assert_eq!(stage.hand.with(|hand, _| hand.journal().len()), 0);
}

#[tokio::test(start_paused = true)]
async fn a_viewer_that_is_too_slow_misses_the_oldest_and_that_is_counted() {
    let stage = stage().await;
    let (mut client, _) = Client::of(&stage.server).await;
    client.subscribe([Topic::State]).await;
    client.message().await;
    let before = stage.server.viewers()[0].missed;
    for number in 0..3000 {
        let message = EncodedMessage {
            log_nanos: number,
            ..large(8)
        };
        stage.server.outlet().publish(message);
    }
    let first = loop {
        let (_, nanos, _) = client.message().await;
        if nanos < 3000 {
            break nanos;
        }
    };
    let missed = stage.server.viewers()[0].missed - before;
    let backlog = u64::try_from(BACKLOG_MAX).unwrap();
    assert!(first >= 3000 - backlog, "{first}");
    assert!(missed >= 3000 - backlog, "{missed}");
    for number in first + 1..3000 {
        let (_, nanos, _) = client.message().await;
        assert_eq!(nanos, number, "none of those that were kept is lost");
    }
}

/// States that the link reads in so long.
async fn pace(stage: &Stage) -> u64 {
    let before = stage.link.stats().state_reads;
    sleep(Duration::from_secs(20)).await;
    stage.link.stats().state_reads - before
}

#[tokio::test(start_paused = true)]
async fn viewers_that_stop_flood_or_talk_nonsense_change_the_links_pace_by_nothing() {
    let stage = stage().await;
    let alone = pace(&stage).await;
    let address = stage.server.address();
    // Subscribes to all, and never reads.
    let socket = TcpSocket::new_v4().unwrap();
    socket.set_recv_buffer_size(4096).unwrap();
    let stream = socket.connect(address).await.unwrap();
    let mut stopped = Client::over(stream, SUBPROTOCOLS[0]).await.unwrap();
    stopped.subscribe(Topic::all()).await;
    until(|| {
        stage
            .server
            .viewers()
            .iter()
            .any(|viewer| viewer.topics == Topic::all().count())
    })
    .await;
    for _ in 0..400 {
        stage.server.outlet().publish(large(64 * 1024));
    }
    // Half a request, and one that comes by the byte.
    let mut half = connect(address).await;
    half.write_all(&HELLO.as_bytes()[..60]).await.unwrap();
    let mut dripping = connect(address).await;
    let drips = tokio::spawn(async move {
        for byte in HELLO.bytes() {
            if dripping.write_all(&[byte]).await.is_err() {
                return;
            }
            sleep(Duration::from_millis(100)).await;
        }
    });
    // A frame that says it is a gigabyte, frames without a mask, and a flood that never ends.
    let mut floods = Vec::new();
    for begin in [
        &[0x82, 0xFF, 0, 0, 0, 0, 0x40, 0, 0, 0, 1, 2, 3, 4][..],
        &[0x81, 5, b'h', b'e', b'l', b'l', b'o'],
        &[0x00, 0x80, 0, 0, 0, 0],
        &[0x89, 0x80, 0, 0, 0, 0],
        &[0x82, 0x80, 0, 0, 0, 0],
    ] {
        let mut stream = connect(address).await;
        stream.write_all(HELLO.as_bytes()).await.unwrap();
        let flood = begin.repeat(2000);
        floods.push(tokio::spawn(async move {
            let (mut unread, mut says) = stream.split();
            let answers = async {
                let mut bytes = [0; 4096];
                while !matches!(unread.read(&mut bytes).await, Ok(0) | Err(_)) {}
            };
            let talk = async { while says.write_all(&flood).await.is_ok() {} };
            tokio::join!(answers, talk);
        }));
    }
    let beside = pace(&stage).await;
    assert!(
        alone.abs_diff(beside) <= 1,
        "{alone} alone, {beside} beside"
    );
    assert!(alone > 1900, "{alone}");
    // All of them were ended, at the latest at their deadlines.
    until(|| stage.server.viewers().is_empty()).await;
    assert!(is_closed(&mut half, WRITE_TIMEOUT).await);
    drips.await.unwrap();
    for flood in floods {
        flood.await.unwrap();
    }
    drop(stopped);
    shows(&stage).await;
    assert_eq!(stage.link.stats().reconnects, 0);
    assert_eq!(stage.hand.with(|hand, _| hand.journal().len()), 0);
}

#[tokio::test(start_paused = true)]
async fn half_a_request_and_a_viewer_that_is_not_there_end_at_their_deadlines() {
    let stage = stage().await;
    let begun = Instant::now();
    let mut half = connect(stage.server.address()).await;
    half.write_all(&HELLO.as_bytes()[..60]).await.unwrap();
    assert!(is_closed(&mut half, 4 * HANDSHAKE_TIMEOUT).await);
    assert!(begun.elapsed() >= HANDSHAKE_TIMEOUT);
    let (gone, _) = Client::of(&stage.server).await;
    let (mut there, _) = Client::of(&stage.server).await;
    let answers = tokio::spawn(async move { while there.0.next().await.is_some() {} });
    let begun = Instant::now();
    until(|| stage.server.viewers().len() == 2).await;
    while stage.server.viewers().len() == 2 {
        sleep(Duration::from_secs(1)).await;
        assert!(begun.elapsed() < 2 * SILENT_MAX);
    }
    assert!(begun.elapsed() >= SILENT_MAX, "{:?}", begun.elapsed());
    sleep(3 * SILENT_MAX).await;
    assert_eq!(stage.server.viewers().len(), 1, "who answers may stay");
    answers.abort();
    drop(gone);
}

#[tokio::test(start_paused = true)]
async fn a_storm_of_connections_is_turned_away_and_counted_and_the_old_viewers_stay() {
    let stage = stage().await;
    let (mut first, _) = Client::of(&stage.server).await;
    first.subscribe([Topic::State]).await;
    let mut storm = Vec::new();
    for _ in 0..100 {
        storm.push(connect(stage.server.address()).await);
    }
    until(|| stage.server.turned_away() >= 101 - VIEWERS_MAX as u64).await;
    assert!(stage.server.viewers().len() <= VIEWERS_MAX);
    first.message().await;
    drop(storm);
    until(|| stage.server.viewers().len() == 1).await;
    shows(&stage).await;
}

#[tokio::test(start_paused = true)]
async fn a_dropped_server_leaves_no_listener_and_no_connection_and_the_link_stays() {
    let Stage {
        link,
        server,
        _records,
        ..
    } = stage().await;
    let (mut client, _) = Client::of(&server).await;
    let address = server.address();
    drop(server);
    let over = async { while let Some(Ok(_)) = client.0.next().await {} };
    timeout(Duration::from_secs(5), over).await.unwrap();
    until(|| std::net::TcpStream::connect(address).is_err()).await;
    let before = link.stats().state_reads;
    until(|| link.stats().state_reads > before + 50).await;
}
