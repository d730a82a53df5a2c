//! Full cycles a second - one motion state and one sweep over all fingertips - as fast as the link goes.

use crate::report::{Aim, Failure, Report};
use handscope::app::connect::SimDial;
use handscope::link::{Clock, LinkConfig, LinkStats, PollRates, Records, open};
use handscope::sim::serve::modbus_tcp;
use handscope::sim::{Scenario, SharedHand, SimConfig, SimHand};
use handscope::transport::Endpoint;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;

/// Until the rate is steady.
const WARM: Duration = Duration::from_millis(500);
/// How long is counted.
const COUNTED: Duration = Duration::from_secs(3);
/// How often the events are taken, more often than a window would.
const LOOK_EACH: Duration = Duration::from_millis(5);
/// A server that is not there by then will not come.
const SERVER_WITHIN: Duration = Duration::from_secs(5);

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let server = Server::tcp()?;
    row(
        report,
        "state + tactile over tcp loopback",
        &server.endpoint,
        1000.0,
    )?;
    drop(server);
    pseudo_terminal(report)?;
    // No wire at all: what link and hand cost by themselves. Far too fast for a window to take every sample.
    let measured = measure(&Endpoint::sim(), WARM, COUNTED)?;
    let what = "state + tactile over sim:, hand and link on one thread";
    report.row(what, measured.cycles, "cycles/s", Aim::None)
}

#[cfg(unix)]
fn pseudo_terminal(report: &mut Report) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let server = Server::rs485(&folder.path().join("hand"))?;
    row(
        report,
        "state + tactile over a pseudo-terminal",
        &server.endpoint,
        500.0,
    )
}

#[cfg(not(unix))]
fn pseudo_terminal(report: &mut Report) -> Result<(), Failure> {
    report.absent(
        "state + tactile over a pseudo-terminal",
        "not on this system",
    )
}

fn row(report: &mut Report, what: &str, endpoint: &Endpoint, aim: f64) -> Result<(), Failure> {
    let measured = measure(endpoint, WARM, COUNTED)?;
    report.row(what, measured.cycles, "cycles/s", Aim::AtLeast(aim))?;
    let [median, slow] = measured.round_trip_us();
    report.row("  round trip, median", median, "us", Aim::None)?;
    report.row("  round trip, 99 of 100", slow, "us", Aim::None)?;
    let what = "  requests that failed";
    report.row(what, measured.failed, "", Aim::AtMost(0.0))?;
    // At many times the rate that a window asks for, and more where other programs hold this one up.
    let what = "  samples that the looking thread came too late for";
    report.row(what, measured.dropped, "", Aim::None)
}

/// What a link did in a while.
pub(crate) struct Measured {
    /// Full cycles a second.
    pub(crate) cycles: f64,
    /// As it was in the end.
    pub(crate) stats: LinkStats,
    /// Requests in that time that failed. Before it, a link may find a reply that the one before it asked for.
    pub(crate) failed: f64,
    /// Samples in that time that nobody took.
    dropped: f64,
}

impl Measured {
    /// Median, and 99 of 100.
    fn round_trip_us(&self) -> [f64; 2] {
        [self.stats.rtt_p50, self.stats.rtt_p99]
            .map(|time| time.unwrap_or_default().as_secs_f64() * 1e6)
    }
}

/// Opens a link, lets it settle and counts what it does.
pub(crate) fn measure(
    endpoint: &Endpoint,
    warm: Duration,
    counted: Duration,
) -> Result<Measured, Failure> {
    let runtime = Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()?;
    let clock = runtime.block_on(async { Clock::start() });
    let config = LinkConfig {
        endpoint: endpoint.clone(),
        rates: PollRates::FULL,
        clock,
        dial: Arc::new(SimDial::new(clock)),
        wake: Arc::new(|| ()),
    };
    let (link, mut records) = open(config, runtime.handle());
    listen(&mut records, warm);
    let (before, lost, begun) = (link.stats(), records.lost(), Instant::now());
    listen(&mut records, counted);
    let (after, took) = (link.stats(), begun.elapsed());
    if after.state_reads == before.state_reads {
        return Err(format!("{endpoint} gives nothing: {:?}", link.status()).into());
    }
    let state = count(after.state_reads - before.state_reads);
    let tactile = count(after.tactile_reads - before.tactile_reads);
    Ok(Measured {
        cycles: state.min(tactile) / took.as_secs_f64(),
        failed: count(failed(&after) - failed(&before)),
        dropped: count(records.lost() - lost),
        stats: after,
    })
}

const fn failed(stats: &LinkStats) -> u64 {
    stats.timeouts
        + stats.checksum_errors
        + stats.resyncs
        + stats.foreign_replies
        + stats.refusals
        + stats.reconnects
}

pub(crate) fn count(many: u64) -> f64 {
    u32::try_from(many).map_or(f64::INFINITY, f64::from)
}

/// Takes what comes, as the window does.
fn listen(records: &mut Records, length: Duration) {
    let begun = Instant::now();
    while begun.elapsed() < length {
        while records.try_next().is_some() {}
        thread::sleep(LOOK_EACH);
    }
}

/// Waits until a server's link is there.
#[cfg(unix)]
pub(crate) fn wait_for(path: &std::path::Path) {
    let begun = Instant::now();
    while !path.exists() && begun.elapsed() < SERVER_WITHIN {
        thread::sleep(LOOK_EACH);
    }
}

/// A hand behind a wire, on a thread and a runtime of its own. Ends when dropped.
pub(crate) struct Server {
    pub(crate) endpoint: Endpoint,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<thread::JoinHandle<()>>,
}

impl Server {
    pub(crate) fn tcp() -> Result<Self, Failure> {
        let listener = std::net::TcpListener::bind("127.0.0.1:0")?;
        listener.set_nonblocking(true)?;
        let endpoint = Endpoint::Tcp {
            host: "127.0.0.1".into(),
            port: listener.local_addr()?.port(),
            unit: 255,
            packing: None,
        };
        Self::start(endpoint, async move |hand| {
            let listener = tokio::net::TcpListener::from_std(listener)?;
            Ok(modbus_tcp::serve(hand, listener).await?)
        })
    }

    #[cfg(unix)]
    fn rs485(path: &std::path::Path) -> Result<Self, Failure> {
        use handscope::sim::serve::pty;
        let endpoint = format!("rs485:{}", path.display()).parse()?;
        let made = path.to_path_buf();
        let server = Self::start(endpoint, async move |hand| {
            pty::serve_rs485(hand, &made, None)?.await;
            Ok(())
        })?;
        wait_for(path);
        Ok(server)
    }

    pub(crate) fn start<S>(endpoint: Endpoint, serve: S) -> Result<Self, Failure>
    where
        S: AsyncFnOnce(SharedHand) -> Result<(), Failure> + Send + 'static,
    {
        let runtime: Runtime = Builder::new_current_thread().enable_all().build()?;
        let (stop, stopped) = oneshot::channel();
        let work = move || {
            runtime.block_on(async {
                let config = SimConfig {
                    // At rest: while something moves, reads are shorter and a cycle takes longer, by choice.
                    scenario: Scenario::Idle,
                    ..SimConfig::default()
                };
                let hand = SharedHand::new(SimHand::new(config), tokio::time::Instant::now());
                tokio::select! {
                    served = serve(hand) => {
                        if let Err(failure) = served {
                            crate::report::complain(&failure);
                        }
                    }
                    _ = stopped => {}
                }
            });
        };
        Ok(Self {
            endpoint,
            stop: Some(stop),
            thread: Some(thread::spawn(work)),
        })
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        if let Some(stop) = self.stop.take() {
            // A server that is gone already needs no word.
            let _gone = stop.send(());
        }
        if let Some(thread) = self.thread.take() {
            // Its panic was printed; the figure shows it too.
            let _panicked = thread.join();
        }
    }
}
