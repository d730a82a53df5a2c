//! A hundred shared hands on DDS, told by thirteen programs' worth of participants in this process: what all of it takes of a core
//! while nothing changes, and how soon the list is right after a change.

use crate::clock::{Sorted, wall_and_cpu_ms};
use crate::report::{Aim, Failure, Report};
use handscope::app::connect::SimDial;
use handscope::hand::kinematics::Side;
use handscope::link::{self, Clock, LinkConfig, LinkHandle, PollRates};
use handscope::share::fleet::{FleetAnnouncer, FleetCard, FleetHand, FleetList};
use handscope::transport::Endpoint;
use handscope::transport::dds::{DdsNode, DdsPlace};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::runtime::Builder;
use tokio::time::{sleep, timeout};

/// A domain for this alone.
const DOMAIN: u16 = 77;
const PROGRAMS: usize = 13;
const HANDS: usize = 100;
const CHANGES: usize = 20;
const LENGTH: Duration = Duration::from_secs(10);
const PATIENCE: Duration = Duration::from_secs(30);
const AIM_CPU: f64 = 20.0;
const AIM_MS: f64 = 2000.0;

/// The hand itself is hardly read: it is not what is measured.
const RATES: PollRates = PollRates {
    state_hz: 1.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

/// Whoever tells of some of the hands.
struct Program {
    _node: DdsNode,
    hands: Vec<FleetAnnouncer>,
}

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let runtime = Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()?;
    let _inside = runtime.enter();
    let clock = Clock::start();
    let config = LinkConfig {
        endpoint: Endpoint::sim(),
        rates: RATES,
        clock,
        dial: Arc::new(SimDial::new(clock)),
        wake: Arc::new(|| ()),
    };
    let (link, _records) = link::open(config, runtime.handle());
    let node = node()?;
    let mut list = FleetList::open(&node, clock, Arc::new(|| ()));
    let programs = (0..PROGRAMS).map(|program| start(program, &link));
    let mut programs: Vec<Program> = programs.collect::<Result<_, _>>()?;
    let all = |hands: &[FleetHand]| hands.len() == HANDS;
    runtime.block_on(right(&mut list, all))?;
    let ([wall, cpu], ()) = wall_and_cpu_ms(|| std::thread::sleep(LENGTH));
    let mut late = Vec::new();
    for change in 0..CHANGES {
        let begun = Instant::now();
        let name = format!("renamed {change}");
        for hand in programs.iter().flat_map(|program| &program.hands) {
            hand.announce(card(&name));
        }
        let is_right = |hands: &[FleetHand]| {
            hands.len() == HANDS && hands.iter().all(|hand| hand.card.name == name)
        };
        late.push(
            runtime
                .block_on(right(&mut list, is_right))
                .map(|()| ms(begun))?,
        );
        runtime.block_on(sleep(Duration::from_millis(100)));
    }
    let begun = Instant::now();
    let gone = programs.pop().map_or(0, |program| program.hands.len());
    let without = |hands: &[FleetHand]| hands.len() == HANDS - gone;
    runtime.block_on(right(&mut list, without))?;
    let left = ms(begun);
    let begun = Instant::now();
    programs.push(start(PROGRAMS - 1, &link)?);
    runtime.block_on(right(&mut list, all))?;
    let came = ms(begun);
    let what = "a hundred shared hands of 13 programs, and their list: CPU of all";
    report.row(what, cpu / wall * 100.0, "% core", Aim::AtMost(AIM_CPU))?;
    let slowest = Sorted::new(late).percentile(100);
    report.row(
        "  all renamed: right after, slowest",
        slowest,
        "ms",
        Aim::AtMost(AIM_MS),
    )?;
    report.row(
        "  a program gone: right after",
        left,
        "ms",
        Aim::AtMost(AIM_MS),
    )?;
    report.row(
        "  a program come: right after",
        came,
        "ms",
        Aim::AtMost(AIM_MS),
    )?;
    Ok(())
}

fn node() -> Result<DdsNode, Failure> {
    let interface = "127.0.0.1".into();
    Ok(DdsNode::open(&DdsPlace {
        interface,
        domain: DOMAIN,
    })?)
}

fn start(program: usize, link: &LinkHandle) -> Result<Program, Failure> {
    let node = node()?;
    let own = (0..HANDS).filter(|hand| hand % PROGRAMS == program);
    let hands = own.map(|hand| FleetAnnouncer::open(&node, link, card(&format!("hand {hand}"))));
    Ok(Program {
        hands: hands.collect(),
        _node: node,
    })
}

fn card(name: &str) -> FleetCard {
    FleetCard {
        host: "lab".into(),
        name: name.into(),
        side: Side::Right,
        at: None,
        first_may_move: false,
        follows: false,
    }
}

/// Waits until the list is right.
async fn right(list: &mut FleetList, wanted: impl Fn(&[FleetHand]) -> bool) -> Result<(), Failure> {
    let waited = timeout(PATIENCE, async {
        while let Some(hands) = list.changed().await {
            if wanted(&hands) {
                return;
            }
        }
    });
    Ok(waited.await?)
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1000.0
}
