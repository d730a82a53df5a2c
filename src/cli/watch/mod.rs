//! `watch`: prints the hand's reports as they arrive, and at the end the statistics of the link. Writes nothing to the
//! hand.
mod args;
mod datagrams;
pub(crate) mod telemetry;
mod wire;

pub(crate) use args::WatchArgs;

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, notify};
use crate::cli::session;
use crate::cli::watch::datagrams::Datagrams;
use crate::cli::watch::telemetry::{sample_text, stats_json, stats_text, watch_json};
use crate::cli::watch::wire::FramePrinter;
use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{Group, Moment, PerDof};
use crate::link::{Clock, LinkHandle, LinkTrouble, Records};
use crate::record::Record;
use crate::shell::interrupt::Interrupt;
use anyhow::bail;
use serde_json::Value;
use std::pin::pin;
use std::time::Duration;
use tokio::time::{MissedTickBehavior, interval};

/// Interval at which the link and the output are checked, and frames printed.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Minimum interval of text lines: users read at most ten lines per second.
const TEXT_LINE_INTERVAL: Duration = Duration::from_millis(100);

/// Watches until the time is up or the user ends it. Fails if nothing was read, and if the link is lost at the end.
pub(crate) async fn run(out: &mut Out, args: &WatchArgs) -> anyhow::Result<()> {
    let interrupt = Interrupt::listen()?;
    WatchRun::new(out, args)?.run(interrupt).await
}

struct WatchRun<'a> {
    args: &'a WatchArgs,
    out: &'a mut Out,
    clock: Clock,
    link: LinkHandle,
    records: Records,
    /// Sends samples instead of printing them.
    datagrams: Option<Datagrams>,
    /// Prints frames instead of values.
    frames: Option<FramePrinter>,
    /// Grip estimate from all readings.
    grip: GripEstimator,
    /// Newtons of a gram of each joint, where they are known.
    newtons_per_g: PerDof<Option<f64>>,
    /// Number of state reads so far; each of them is a line of JSON, unless frames are printed.
    taken: u64,
    last_text: Option<Moment>,
    answered: bool,
    reported: Option<LinkTrouble>,
}

impl<'a> WatchRun<'a> {
    fn new(out: &'a mut Out, args: &'a WatchArgs) -> anyhow::Result<Self> {
        let datagrams = args.udp.map(Datagrams::to).transpose()?;
        let clock = Clock::start();
        let (link, records) = session::open_with_records(&args.hand, args.rates(), clock);
        Ok(Self {
            datagrams,
            frames: args.wire.then(|| FramePrinter::new(args, &link)),
            link,
            records,
            args,
            out,
            clock,
            grip: session::grip_estimator(&args.hand),
            newtons_per_g: session::newtons_per_g(&args.hand),
            taken: 0,
            last_text: None,
            answered: false,
            reported: None,
        })
    }

    async fn run(mut self, mut interrupt: Interrupt) -> anyhow::Result<()> {
        let mut tick = interval(POLL_INTERVAL);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut end = pin!(self.args.over());
        loop {
            let record = tokio::select! {
                biased;
                () = interrupt.wished() => break,
                () = &mut end => break,
                _ = tick.tick() => {
                    self.tick()?;
                    continue;
                }
                record = self.records.next() => record,
            };
            match record {
                Some(record) => self.apply(record)?,
                None => break,
            }
        }
        self.finish()
    }

    fn elapsed(&self) -> Duration {
        self.clock.now().since(Moment::ZERO)
    }

    /// Checks the output, and reports changes of the link.
    fn tick(&mut self) -> anyhow::Result<()> {
        if let Some(frames) = &mut self.frames {
            frames.print(self.out, self.clock.now())?;
        }
        self.out.flush()?;
        let status = self.link.status();
        if status.state.is_live() {
            if self.reported.take().is_some() {
                notify(&answers_again(status.moved_to.as_deref()));
            }
            self.answered = true;
            return Ok(());
        }
        if let Some(trouble) = session::trouble(&status) {
            self.report_trouble(trouble)
        } else if !self.answered
            && self.reported.is_none()
            && self.elapsed() >= session::patience(&status)
        {
            self.give_up(&session::unanswered(&self.args.hand))
        } else {
            Ok(())
        }
    }

    /// Reports each cause once, until the hand answers again.
    fn report_trouble(&mut self, trouble: &LinkTrouble) -> anyhow::Result<()> {
        if self.reported.as_ref() == Some(trouble) {
            return Ok(());
        }
        self.reported = Some(trouble.clone());
        if self.answered {
            notify(&format!(
                "link to {} lost: {trouble}; trying again",
                self.args.hand
            ));
            return Ok(());
        }
        self.give_up(&session::no_hand(&self.args.hand, trouble))
    }

    /// Without a time limit, ends the wait for a hand that has never answered.
    fn give_up(&mut self, why: &str) -> anyhow::Result<()> {
        if let Some(length) = self.args.length {
            // Once the time is over, the end reports it.
            if self.elapsed() < length {
                notify(&format!("{why}; trying again"));
            }
            return Ok(());
        }
        self.statistics()?;
        Err(FailureKind::NoHand.error(why))
    }

    fn apply(&mut self, record: Record) -> anyhow::Result<()> {
        let Record::Reading { sample, fresh } = record else {
            return Ok(());
        };
        let read = sample.newest(fresh).unwrap_or_default();
        let mut grip = self.grip.apply(&sample, fresh, read);
        // Feedback that does not follow the commands says nothing about the grip.
        if self.link.status().feedback_in_doubt {
            grip = Grip::default();
        }
        let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) else {
            return Ok(());
        };
        self.answered = true;
        self.taken += 1;
        if self.frames.is_some() {
            return Ok(());
        }
        let at = angle.received;
        if let Some(datagrams) = &mut self.datagrams {
            datagrams.send(&watch_json(&sample, &grip, &self.newtons_per_g, at));
            return Ok(());
        }
        if self.args.json {
            let object = watch_json(&sample, &grip, &self.newtons_per_g, at);
            return self.out.stream_object(&object);
        }
        let is_soon = |last| at.since(last) < TEXT_LINE_INTERVAL;
        if self.last_text.is_some_and(is_soon) {
            return Ok(());
        }
        self.last_text = Some(at);
        self.out.stream_line(&sample_text(&sample, at))
    }

    fn finish(mut self) -> anyhow::Result<()> {
        let status = self.link.status();
        self.answered |= status.state.is_live();
        self.statistics()?;
        let hand = &self.args.hand;
        match (
            session::trouble(&status).or(self.reported.as_ref()),
            self.taken,
        ) {
            (Some(trouble), 1..) if !status.state.is_live() => {
                let words = format!("the link to {hand} is lost: {trouble}");
                Err(FailureKind::LinkLost.error(words))
            }
            (_, 1..) => Ok(()),
            (Some(trouble), 0) => {
                let words = format!("the hand never answered; last: {trouble}");
                Err(FailureKind::NoHand.error(words))
            }
            (None, 0) if self.answered => {
                bail!("{hand} answers, but no state of it was read: watch for longer")
            }
            (None, 0) => Err(FailureKind::NoHand.error("the hand did not answer in time")),
        }
    }

    /// The last line. Queued samples are printed first, so that lines and count agree.
    fn statistics(&mut self) -> anyhow::Result<()> {
        if let Some(frames) = &mut self.frames {
            return frames.print_rest(self.out, self.clock.now());
        }
        let elapsed = self.elapsed();
        let mut stats = self.link.stats();
        while self.taken < stats.state_reads
            && let Some(record) = self.records.try_next()
        {
            self.apply(record)?;
        }
        stats.dropped_events = self.records.lost();
        // A sample may be printed before it is counted.
        stats.state_reads = stats.state_reads.max(self.taken);
        if self.args.json {
            let mut line = stats_json(&stats, elapsed);
            let fields = line.get_mut("stats").and_then(Value::as_object_mut);
            if let (Some(datagrams), Some(fields)) = (&self.datagrams, fields) {
                fields.insert("udp".into(), datagrams.figures());
            }
            self.out.object(&line)?;
        } else {
            self.out.lines(stats_text(&stats, elapsed).lines())?
        }
        self.out.flush()
    }
}

fn answers_again(moved_to: Option<&str>) -> String {
    let place = moved_to.map(|port| format!("; its adapter is now at {port}"));
    format!("the hand answers again{}", place.unwrap_or_default())
}
