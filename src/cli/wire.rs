//! `watch --wire`: what goes over the wire, frame by frame, with what is wrong about it. Writes nothing to the hand.

use crate::cli::args::WatchArgs;
use crate::cli::interrupt::Interrupt;
use crate::cli::out::Out;
use crate::cli::session::{self, ANSWER_WITHIN};
use crate::hand::Moment;
use crate::link::tap::Direction;
use crate::link::traffic::frame::{Frame, Kind};
use crate::link::{Clock, LinkHandle, PollRates, Traffic};
use anyhow::bail;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{MissedTickBehavior, interval};

/// Frames show after this at the latest: far sooner than the tap's ring is full at any rate.
const LOOK_EACH: Duration = Duration::from_millis(50);

/// By then a request has its reply, or is known to have none.
const DECIDED_WITHIN: Duration = Duration::from_millis(1100);

/// Prints frames until the time is over or the person ends it. Fails if the hand never answered, after what was heard.
pub(crate) fn run(out: &mut Out, args: &WatchArgs) -> anyhow::Result<()> {
    session::runtime()?.block_on(async {
        let mut interrupt = Interrupt::listen()?;
        let rates = if args.full_rate {
            PollRates::FULL
        } else {
            PollRates::default()
        };
        let clock = Clock::start();
        let mut link = session::open(&args.hand, rates, clock);
        let mut printer = Printer::new(args, &link);
        let mut tick = interval(LOOK_EACH);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut answered = false;
        loop {
            let ended = tokio::select! {
                biased;
                () = interrupt.wished() => true,
                _ = tick.tick() => false,
            };
            // Samples are not wanted here, and must not fill the queue.
            while link.try_event().is_some() {}
            answered |= link.status().state.is_live();
            let now = clock.now();
            let over = args
                .length
                .is_some_and(|length| now.since(Moment::ZERO) >= length);
            let waited = args.length.is_none() && now.since(Moment::ZERO) >= ANSWER_WITHIN;
            let last = ended || over || (waited && !answered);
            // What is still open at the end is shown as it is.
            let by = if last { now.plus(DECIDED_WITHIN) } else { now };
            printer.print(out, by)?;
            if last {
                break;
            }
        }
        end(&link, args, answered)
    })
}

fn end(link: &LinkHandle, args: &WatchArgs, answered: bool) -> anyhow::Result<()> {
    if answered {
        return Ok(());
    }
    match &link.status().trouble {
        Some(trouble) => bail!(session::no_hand(&args.hand, trouble)),
        None => bail!(session::unanswered(&args.hand)),
    }
}

/// Prints each frame once.
struct Printer {
    traffic: Traffic,
    json: bool,
    printed: u64,
}

impl Printer {
    fn new(args: &WatchArgs, link: &LinkHandle) -> Self {
        Self {
            traffic: Traffic::of(link.tap(), &args.hand),
            json: args.json,
            printed: 0,
        }
    }

    fn print(&mut self, out: &mut Out, now: Moment) -> anyhow::Result<()> {
        while self.traffic.read_some(now) {
            self.lines(out, now)?;
        }
        self.lines(out, now)?;
        out.flush()
    }

    fn lines(&mut self, out: &mut Out, now: Moment) -> anyhow::Result<()> {
        let fresh = self.traffic.frames().iter();
        let mut fresh: Vec<_> = fresh.filter(|frame| frame.number > self.printed).collect();
        fresh.sort_by_key(|frame| frame.number);
        let open = fresh.iter().rposition(|frame| is_request(frame));
        let open = open.filter(|at| is_open(fresh.get(*at..).unwrap_or_default(), now));
        fresh.truncate(open.unwrap_or(fresh.len()));
        for frame in &fresh {
            let line = if self.json {
                frame.json_line()
            } else {
                frame.text_line()
            };
            out.line(&line)?;
        }
        self.printed = fresh.last().map_or(self.printed, |frame| frame.number);
        Ok(())
    }
}

fn is_request(frame: &Frame) -> bool {
    frame.direction == Direction::ToHand && matches!(frame.kind, Kind::Read | Kind::Write)
}

/// Whether the first of these is a request of which it is still open how it ends: its line waits until that is known.
fn is_open(frames: &[&Arc<Frame>], now: Moment) -> bool {
    let [request, later @ ..] = frames else {
        return false;
    };
    request.wrong.is_none()
        && now.since(request.at) < DECIDED_WITHIN
        && later.iter().all(|frame| frame.took.is_none())
}
