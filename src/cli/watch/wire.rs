//! `watch --wire`: the frames on the wire, with their errors.

use crate::cli::out::Out;
use crate::cli::watch::args::WatchArgs;
use crate::hand::Moment;
use crate::link::traffic::frame::{Frame, Kind};
use crate::link::{LinkHandle, Traffic};
use crate::record::Direction;
use std::sync::Arc;
use std::time::Duration;

/// Time after which a request has its reply or is known to have none.
const DECISION_TIMEOUT: Duration = Duration::from_millis(1100);

/// Prints each frame once.
pub(crate) struct FramePrinter {
    traffic: Traffic,
    json: bool,
    printed: u64,
}

impl FramePrinter {
    pub(crate) fn new(args: &WatchArgs, link: &LinkHandle) -> Self {
        Self {
            traffic: Traffic::of(link.tap(), &args.hand),
            json: args.json,
            printed: 0,
        }
    }

    /// Prints new frames. Must be called often enough that the tap's ring never overflows.
    pub(crate) fn print(&mut self, out: &mut Out, now: Moment) -> anyhow::Result<()> {
        while self.traffic.read_some(now) {
            self.lines(out, now)?;
        }
        self.lines(out, now)?;
        out.flush()
    }

    /// Prints the remaining frames at the end, including unanswered requests.
    pub(crate) fn print_rest(&mut self, out: &mut Out, now: Moment) -> anyhow::Result<()> {
        self.print(out, now.plus(DECISION_TIMEOUT))
    }

    fn lines(&mut self, out: &mut Out, now: Moment) -> anyhow::Result<()> {
        let fresh = self.traffic.frames().iter();
        let mut fresh: Vec<_> = fresh.filter(|frame| frame.number > self.printed).collect();
        fresh.sort_by_key(|frame| frame.number);
        let open = fresh.iter().rposition(|frame| is_request(frame));
        let open = open.filter(|at| is_open(fresh.get(*at..).unwrap_or_default(), now));
        fresh.truncate(open.unwrap_or(fresh.len()));
        for frame in &fresh {
            if self.json {
                out.stream_json(&frame.json_line())?;
            } else {
                out.stream_line(&frame.text_line())?;
            }
        }
        self.printed = fresh.last().map_or(self.printed, |frame| frame.number);
        Ok(())
    }
}

fn is_request(frame: &Frame) -> bool {
    frame.direction == Direction::ToHand && matches!(frame.kind, Kind::Read | Kind::Write)
}

/// True if the first frame is a request whose outcome is still open: its line is delayed until the outcome is known.
fn is_open(frames: &[&Arc<Frame>], now: Moment) -> bool {
    let [request, later @ ..] = frames else {
        return false;
    };
    request.wrong.is_none()
        && now.since(request.at) < DECISION_TIMEOUT
        && later.iter().all(|frame| frame.took.is_none())
}
