//! What four live viewers of a hand cost, and how late they see it: a thousand messages of a kilobyte a second over loopback.

use crate::clock::{Sorted, cpu_ms};
use crate::cycles::count;
use crate::report::{Aim, Failure, Report};
use futures::{SinkExt as _, StreamExt as _};
use handscope::hand::Moment;
use handscope::hand::kinematics::Side;
use handscope::record::file::Opening;
use handscope::record::file::format::encode::EncodedMessage;
use handscope::record::file::format::topic::Topic;
use handscope::share::foxglove::{FoxgloveConfig, FoxgloveServer, Outlet};
use std::net::SocketAddr;
use std::thread;
use std::time::{Duration, Instant};
use tokio::net::TcpStream;
use tokio::runtime::Builder;
use tokio::task::JoinSet;
use tokio::time::{MissedTickBehavior, interval, sleep};
use tokio_tungstenite::client_async;
use tokio_tungstenite::tungstenite::Message as Frame;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::http::HeaderValue;

const VIEWERS: usize = 4;
const MESSAGES: u32 = 5000;
const BYTES: usize = 1024;
/// Before the message: a one, the subscription and the time.
const HEAD: usize = 13;
const LATE_MS: f64 = 1.0;
const OF_A_CORE: f64 = 15.0;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let runtime = Builder::new_current_thread().enable_all().build()?;
    let config = FoxgloveConfig {
        address: ([127, 0, 0, 1], 0).into(),
        opening: Opening::begin(
            "sim:".into(),
            (Moment::ZERO, Duration::from_secs(1)),
            Side::Right,
        ),
    };
    let server = FoxgloveServer::open(config, runtime.handle())?;
    let (address, begun) = (server.address(), Instant::now());
    let viewers = thread::spawn(move || view_all(address, begun));
    runtime.block_on(async {
        while server
            .viewers()
            .iter()
            .filter(|viewer| viewer.topics > 0)
            .count()
            < VIEWERS
        {
            sleep(Duration::from_millis(1)).await;
        }
    });
    let published = Instant::now();
    // The server and what it is given run on this thread, so its time is theirs.
    let (cpu, ()) = cpu_ms(|| runtime.block_on(publish(server.outlet(), begun)));
    let took = published.elapsed().as_secs_f64() * 1000.0;
    drop(server);
    runtime.block_on(tokio::task::yield_now());
    let late = viewers.join().map_err(|_panicked| "a viewer panicked")??;
    let came = count(late.len().try_into()?);
    let all = f64::from(MESSAGES) * count(VIEWERS.try_into()?);
    let what = "1000 messages of 1 kB a second to 4 viewers: came";
    report.row(what, came / all * 100.0, "%", Aim::AtLeast(100.0))?;
    let late = Sorted::new(late);
    report.row("  late, median", late.median(), "ms", Aim::None)?;
    let worst = late.percentile(99);
    report.row("  late, 99 of 100", worst, "ms", Aim::AtMost(LATE_MS))?;
    let share = cpu / took * 100.0;
    report.row(
        "  CPU of the server",
        share,
        "% core",
        Aim::AtMost(OF_A_CORE),
    )
}

/// Publishes at a steady pace, each message with its moment, and lets the last of them leave.
async fn publish(outlet: &Outlet, begun: Instant) {
    let mut tick = interval(Duration::from_millis(1));
    tick.set_missed_tick_behavior(MissedTickBehavior::Burst);
    for _ in 0..MESSAGES {
        tick.tick().await;
        let mut bytes = vec![0; BYTES];
        let nanos = u64::try_from(begun.elapsed().as_nanos()).unwrap_or(u64::MAX);
        if let Some(place) = bytes.first_chunk_mut() {
            *place = nanos.to_le_bytes();
        }
        outlet.publish(EncodedMessage {
            topic: Topic::State,
            log_nanos: nanos,
            publish_nanos: nanos,
            bytes,
        });
    }
    sleep(Duration::from_millis(100)).await;
}

/// How late each message came to each viewer, in milliseconds.
fn view_all(address: SocketAddr, begun: Instant) -> Result<Vec<f64>, String> {
    let runtime = Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| error.to_string())?;
    runtime.block_on(async {
        let mut viewers = JoinSet::new();
        for _ in 0..VIEWERS {
            viewers.spawn(view(address, begun));
        }
        let late: Result<Vec<Vec<f64>>, String> = viewers.join_all().await.into_iter().collect();
        late.map(|late| late.concat())
    })
}

async fn view(address: SocketAddr, begun: Instant) -> Result<Vec<f64>, String> {
    let told = |error: &dyn std::error::Error| error.to_string();
    let stream = TcpStream::connect(address)
        .await
        .map_err(|error| told(&error))?;
    let mut request = "ws://hand"
        .into_client_request()
        .map_err(|error| told(&error))?;
    let name = HeaderValue::from_static("foxglove.sdk.v1");
    request.headers_mut().insert("sec-websocket-protocol", name);
    let shaken = client_async(request, stream).await;
    let (mut socket, _) = shaken.map_err(|error| told(&error))?;
    let wanted = format!(
        r#"{{"op":"subscribe","subscriptions":[{{"id":1,"channelId":{}}}]}}"#,
        Topic::State.channel()
    );
    let sent = socket.send(Frame::text(wanted)).await;
    sent.map_err(|error| told(&error))?;
    let mut late = Vec::new();
    while let Some(Ok(frame)) = socket.next().await {
        let Frame::Binary(data) = frame else { continue };
        if let Some(nanos) = data.get(HEAD..).and_then(<[u8]>::first_chunk) {
            let published = Duration::from_nanos(u64::from_le_bytes(*nanos));
            let waited = begun.elapsed().saturating_sub(published);
            late.push(waited.as_secs_f64() * 1000.0);
        }
    }
    Ok(late)
}
