//! `watch --wire`: the frames on the wire, with what is wrong with them. Writes nothing to the hand.

use crate::cli::interrupt::Interrupt;
use crate::cli::out::Out;
use crate::cli::session::{self, ANSWER_WITHIN};
use crate::cli::watch::args::WatchArgs;
use crate::hand::Moment;
use crate::link::tap::Direction;
use crate::link::traffic::frame::{Frame, Kind};
use crate::link::{Clock, LinkHandle, Traffic};
use anyhow::anyhow;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{MissedTickBehavior, interval};

/// Frames show after this at the latest: long before the tap's ring is full, at any rate.
const LOOK_EACH: Duration = Duration::from_millis(50);

/// After this, a request has its reply or is known to have none.
const DECIDED_WITHIN: Duration = Duration::from_millis(1100);

/// Prints frames until the time is up or a person ends it. Fails at the end if the hand never answered.
pub(crate) async fn watch(
    out: &mut Out,
    args: &WatchArgs,
    mut interrupt: Interrupt,
) -> anyhow::Result<()> {
    let clock = Clock::start();
    let link = session::open(&args.hand, args.rates(), clock);
    let mut printer = Printer::new(args, &link);
    let mut tick = interval(LOOK_EACH);
    tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut over = pin!(args.over());
    let mut is_answered = false;
    loop {
        let is_over = tokio::select! {
            biased;
            () = interrupt.wished() => true,
            () = &mut over => true,
            _ = tick.tick() => false,
        };
        is_answered |= link.status().state.is_live();
        let now = clock.now();
        let is_endless = args.length.is_none();
        let is_in_vain = !is_answered && is_endless && now.since(Moment::ZERO) >= ANSWER_WITHIN;
        if !is_over && !is_in_vain {
            printer.print(out, now)?;
            continue;
        }
        // What is still open at the end is shown as it is.
        printer.print(out, now.plus(DECIDED_WITHIN))?;
        return match link.status().trouble {
            _ if is_answered => Ok(()),
            Some(trouble) => Err(anyhow!(session::no_hand(&args.hand, &trouble))),
            None => Err(anyhow!(session::unanswered(&args.hand))),
        };
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
            out.line(&match self.json {
                true => frame.json_line(),
                false => frame.text_line(),
            })?;
        }
        self.printed = fresh.last().map_or(self.printed, |frame| frame.number);
        Ok(())
    }
}

fn is_request(frame: &Frame) -> bool {
    frame.direction == Direction::ToHand && matches!(frame.kind, Kind::Read | Kind::Write)
}

/// Whether the first of these is a request whose outcome is still open: its line waits until that is known.
fn is_open(frames: &[&Arc<Frame>], now: Moment) -> bool {
    let [request, later @ ..] = frames else {
        return false;
    };
    request.wrong.is_none()
        && now.since(request.at) < DECIDED_WITHIN
        && later.iter().all(|frame| frame.took.is_none())
}
