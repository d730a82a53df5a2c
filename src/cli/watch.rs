//! `watch`: what the hand says, as it says it, and at the end what the link measured. Writes nothing to the hand.

use crate::cli::args::WatchArgs;
use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, say};
use crate::cli::session::{self, ANSWER_WITHIN};
use crate::cli::telemetry::{sample_json, sample_text, stats_json, stats_text};
use crate::hand::{Group, Groups, HandSample, Moment};
use crate::link::{Clock, LinkEvent, LinkHandle, LinkTrouble, PollRates};
use anyhow::bail;
use std::pin::pin;
use std::time::Duration;
use tokio::time::{MissedTickBehavior, interval};

/// Lines show after this at the latest; gathering them lets a full-rate stream keep up.
const FLUSH_EACH: Duration = Duration::from_millis(50);
/// A person reads no more than ten lines a second.
const TEXT_LINE_EACH: Duration = Duration::from_millis(100);

/// Watches until the time is over or the person ends it. Fails if the hand never answered.
pub(crate) fn run(out: &mut Out, args: WatchArgs) -> anyhow::Result<()> {
    session::runtime()?.block_on(async {
        let interrupt = Interrupt::listen()?;
        Watch::new(out, args).run(interrupt).await
    })
}

struct Watch<'a> {
    args: WatchArgs,
    out: &'a mut Out,
    clock: Clock,
    link: LinkHandle,
    /// State reads taken so far; each of them is a line of JSON.
    taken: u64,
    last_text: Option<Moment>,
    answered: bool,
    told: Option<LinkTrouble>,
}

/// What the watch does next.
enum Step {
    Event(LinkEvent),
    Tick,
    End,
}

impl<'a> Watch<'a> {
    fn new(out: &'a mut Out, args: WatchArgs) -> Self {
        let rates = if args.full_rate {
            PollRates::FULL
        } else {
            PollRates::default()
        };
        let clock = Clock::start();
        Self {
            link: session::open(&args.hand, rates, clock),
            args,
            out,
            clock,
            taken: 0,
            last_text: None,
            answered: false,
            told: None,
        }
    }

    async fn run(mut self, mut interrupt: Interrupt) -> anyhow::Result<()> {
        let mut tick = interval(FLUSH_EACH);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut end = pin!(over(self.args.length));
        loop {
            let step = tokio::select! {
                biased;
                () = interrupt.wished() => Step::End,
                () = &mut end => Step::End,
                _ = tick.tick() => Step::Tick,
                event = self.link.event() => event.map_or(Step::End, Step::Event),
            };
            match step {
                Step::Event(event) => self.take(event)?,
                Step::Tick => self.tick()?,
                Step::End => break,
            }
        }
        self.finish()
    }

    fn elapsed(&self) -> Duration {
        self.clock.now().since(Moment::ZERO)
    }

    /// Shows what was gathered, and tells what became of the link.
    fn tick(&mut self) -> anyhow::Result<()> {
        self.out.flush()?;
        let status = self.link.status();
        if status.state.is_live() {
            if self.told.take().is_some() {
                say(&answers_again(status.moved_to.as_deref()));
            }
            self.answered = true;
            return Ok(());
        }
        if let Some(trouble) = session::trouble(&status) {
            self.tell(trouble)
        } else if !self.answered && self.told.is_none() && self.elapsed() >= ANSWER_WITHIN {
            self.give_up(&session::unanswered(&self.args.hand))
        } else {
            Ok(())
        }
    }

    /// Each cause is told once, until the hand answers again.
    fn tell(&mut self, trouble: &LinkTrouble) -> anyhow::Result<()> {
        if self.told.as_ref() == Some(trouble) {
            return Ok(());
        }
        self.told = Some(trouble.clone());
        if self.answered {
            say(&format!(
                "link to {} lost: {trouble}; trying again",
                self.args.hand
            ));
            return Ok(());
        }
        self.give_up(&session::no_hand(&self.args.hand, trouble))
    }

    /// Without an end in sight, a hand that never answered is not waited for.
    fn give_up(&mut self, why: &str) -> anyhow::Result<()> {
        if self.args.length.is_some() {
            say(&format!("{why}; trying again"));
            return Ok(());
        }
        self.statistics()?;
        bail!("{why}")
    }

    fn take(&mut self, event: LinkEvent) -> anyhow::Result<()> {
        match event {
            LinkEvent::Sample { sample, fresh } => self.sample(&sample, fresh),
            LinkEvent::State { .. } | LinkEvent::ArmRefused { .. } | LinkEvent::Done { .. } => {
                Ok(())
            }
        }
    }

    fn sample(&mut self, sample: &HandSample, fresh: Groups) -> anyhow::Result<()> {
        let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) else {
            return Ok(());
        };
        self.answered = true;
        self.taken += 1;
        let at = angle.received;
        if self.args.json {
            return self.out.line(&sample_json(sample, at).to_string());
        }
        if self
            .last_text
            .is_some_and(|last| at.since(last) < TEXT_LINE_EACH)
        {
            return Ok(());
        }
        self.last_text = Some(at);
        self.out.line(&sample_text(sample, at))
    }

    fn finish(mut self) -> anyhow::Result<()> {
        self.answered |= self.link.status().state.is_live();
        self.statistics()?;
        if self.answered {
            return Ok(());
        }
        match self.told {
            Some(trouble) => bail!("the hand never answered; last: {trouble}"),
            None => bail!("the hand did not answer before the time was over"),
        }
    }

    /// The last line. What was read until now and still waits is shown first, so that lines and count agree.
    fn statistics(&mut self) -> anyhow::Result<()> {
        let elapsed = self.elapsed();
        let mut stats = self.link.stats();
        while self.taken < stats.state_reads
            && let Some(event) = self.link.try_event()
        {
            self.take(event)?;
        }
        // A sample is told before it is counted.
        stats.state_reads = stats.state_reads.max(self.taken);
        let line = if self.args.json {
            stats_json(&stats, elapsed).to_string()
        } else {
            stats_text(&stats, elapsed)
        };
        self.out.line(&line)?;
        self.out.flush()
    }
}

fn answers_again(moved_to: Option<&str>) -> String {
    let place = moved_to.map(|port| format!("; its adapter is now at {port}"));
    format!("the hand answers again{}", place.unwrap_or_default())
}

/// Resolves when the time is over; never if there is no end.
async fn over(length: Option<Duration>) {
    match length {
        Some(length) => tokio::time::sleep(length).await,
        None => std::future::pending().await,
    }
}
