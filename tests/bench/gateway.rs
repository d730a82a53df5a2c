//! What eight clients of a shared hand cost its link, and how long they wait, on a line that is full without them.

use crate::clock::Sorted;
use crate::cycles::count;
use crate::line;
use crate::report::{Aim, Failure, Report};
use handscope::app::connect::SimDial;
use handscope::link::{Clock, LinkConfig, LinkHandle, PollRates, Records, open};
use handscope::share::gateway::{Gateway, GatewayConfig, SILENCE, Writers};
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use tokio::runtime::Builder;
use tokio::task::JoinSet;
use tokio_modbus::client::{Reader as _, tcp};

const CLIENTS: usize = 8;
/// Until the link has learnt the turnaround and windows have their length.
const WARM: Duration = Duration::from_secs(3);
const COUNTED: Duration = Duration::from_secs(5);
/// How often records are taken.
const LOOK_EACH: Duration = Duration::from_millis(5);
/// What is left of the rate, and what an answer may take beyond a full cycle.
const SHARE: f64 = 95.0;
const BEYOND_MS: f64 = 2.0;
/// What each client reads in turn: the whole state, a fingertip, what the hand was told, and the id.
const READS: [(u16, u16); 4] = [(1546, 39), (3058, 29), (1486, 12), (1000, 1)];

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    for baud in [115_200, 921_600] {
        shared(report, baud)?;
    }
    Ok(())
}

fn shared(report: &mut Report, baud: u32) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let server = line::rs485(&folder.path().join("hand"), baud)?;
    let runtime = Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()?;
    let clock = runtime.block_on(async { Clock::start() });
    let config = LinkConfig {
        endpoint: server.endpoint.clone(),
        rates: PollRates::FULL,
        clock,
        dial: Arc::new(SimDial::new(clock)),
        wake: Arc::new(|| ()),
    };
    let (link, mut records) = open(config, runtime.handle());
    cycles(&link, &mut records, WARM);
    let alone = cycles(&link, &mut records, COUNTED);
    let gateway = GatewayConfig {
        address: ([127, 0, 0, 1], 0).into(),
        writers: Writers::Granted,
        silence: SILENCE,
    };
    let gateway = Gateway::open(link.clone(), gateway, runtime.handle())?;
    let (address, over) = (gateway.address(), Arc::new(AtomicBool::new(false)));
    let until = Arc::clone(&over);
    let clients = thread::spawn(move || ask_all(address, &until));
    let beside = cycles(&link, &mut records, COUNTED);
    over.store(true, Ordering::Relaxed);
    let waits = clients.join().map_err(|_panicked| "a client panicked")??;
    let what = format!("shared rs485 at {baud} baud, hand of 6 ms: cycles alone");
    report.row(&what, alone, "cycles/s", Aim::None)?;
    let what = "  beside 8 clients at full rate";
    report.row(what, beside, "cycles/s", Aim::None)?;
    let share = beside / alone * 100.0;
    report.row("  share of that", share, "%", Aim::AtLeast(SHARE))?;
    let answers = count(waits.len().try_into()?) / COUNTED.as_secs_f64();
    report.row("  answers to all of them", answers, "1/s", Aim::None)?;
    let waits = Sorted::new(waits);
    report.row("  answer, median", waits.median(), "ms", Aim::None)?;
    let cycle = 1000.0 / alone + BEYOND_MS;
    let what = "  answer of what is read in turn, 99 of 100";
    report.row(what, waits.percentile(99), "ms", Aim::AtMost(cycle))
}

/// Full cycles a second over a while.
fn cycles(link: &LinkHandle, records: &mut Records, length: Duration) -> f64 {
    let (before, begun) = (link.stats(), Instant::now());
    while begun.elapsed() < length {
        while records.try_next().is_some() {}
        thread::sleep(LOOK_EACH);
    }
    let (after, took) = (link.stats(), begun.elapsed().as_secs_f64());
    let state = count(after.state_reads - before.state_reads);
    let tactile = count(after.tactile_reads - before.tactile_reads);
    state.min(tactile) / took
}

/// All clients, each as fast as it is answered; how long each answer of what is read in turn took, in milliseconds.
fn ask_all(address: SocketAddr, over: &Arc<AtomicBool>) -> Result<Vec<f64>, String> {
    let runtime = Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| error.to_string())?;
    runtime.block_on(async {
        let mut clients = JoinSet::new();
        for _ in 0..CLIENTS {
            clients.spawn(ask(address, Arc::clone(over)));
        }
        let waits: Result<Vec<Vec<f64>>, String> = clients.join_all().await.into_iter().collect();
        waits.map(|waits| waits.concat())
    })
}

async fn ask(address: SocketAddr, over: Arc<AtomicBool>) -> Result<Vec<f64>, String> {
    let connected = tcp::connect(address).await;
    let mut client = connected.map_err(|error| error.to_string())?;
    let mut waits = Vec::new();
    while !over.load(Ordering::Relaxed) {
        for (at, words) in READS {
            let asked = Instant::now();
            let answer = client.read_holding_registers(at, words).await;
            let answer = answer.map_err(|error| error.to_string())?;
            answer.map_err(|exception| format!("{at}: {exception}"))?;
            if at > 1400 {
                waits.push(asked.elapsed().as_secs_f64() * 1000.0);
            }
        }
    }
    Ok(waits)
}
