//! A series on a real link: samples in, setpoints out, Ctrl-C is a stop, and every stop is looked after until feedback
//! shows rest. Decides nothing about trials.

use crate::app::QuirkSheet;
use crate::app::calendar::{day, since_1970};
use crate::app::trial::session::{Head, Keeper};
use crate::app::trial::{self, Abort, LinkView, Order, Series, Trial, TrialPlan};
use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, say};
use crate::cli::session;
use crate::cli::trial::args::TrialArgs;
use crate::cli::trial::{Outcome, Stop, told};
use crate::hand::{Force, HandSample, PerDof, Speed};
use crate::link::{ArmEpoch, ArmRequest, Clock, Hold, LinkEvent, LinkHandle};
use anyhow::{Context as _, anyhow, bail};
use std::path::Path;
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::Duration;
use tokio::time::{Instant, sleep, timeout};

/// How often time is looked at where nothing is read.
const TICK: Duration = Duration::from_millis(5);
/// How long the hand may take to tell of itself, and to acknowledge its limits.
const READY_WITHIN: Duration = Duration::from_secs(5);
/// How long feedback may take to show rest; the link raises its alarm after half a second.
const REST_WITHIN: Duration = Duration::from_secs(3);
/// Trials that wait to be written while the next runs.
const WRITES_MAX: usize = 16;

/// Runs the plan on the hand.
pub(crate) async fn drive(
    out: &mut Out,
    args: &TrialArgs,
    plan: &TrialPlan,
) -> anyhow::Result<Outcome> {
    let mut interrupt = Interrupt::listen()?;
    let clock = Clock::start();
    let link = session::open(&args.hand, trial::RATES, clock);
    let mut bench = Bench {
        link,
        clock,
        sample: HandSample::default(),
    };
    let armed = tokio::select! {
        biased;
        () = interrupt.wished() => None,
        armed = bench.make_ready(args, plan) => Some(armed?),
    };
    let Some(epoch) = armed else {
        // Arming may have been under way.
        let stop = bench.stop().await;
        bail!(
            "ended by a person before anything moved{}",
            told::stop_words(Some(stop))
        );
    };
    // The folder is made only now: nothing is left behind by a hand that is not there.
    let writer = match Writer::start(args, plan, &bench.link) {
        Ok(writer) => writer,
        Err(error) => {
            bench.link.disarm();
            sleep(TICK).await;
            return Err(error);
        }
    };
    let mut run = Run {
        bench,
        series: Series::start(plan.clone(), epoch, clock.now())?,
        trials: Vec::new(),
        stop: None,
        writer,
    };
    let ran = run.play(out, args, &mut interrupt).await;
    run.end(ran).await
}

/// The link and what was read last.
struct Bench {
    link: LinkHandle,
    clock: Clock,
    sample: HandSample,
}

impl Bench {
    /// Waits until the hand tells where it is, and arms it as the person asked for.
    async fn make_ready(&mut self, args: &TrialArgs, plan: &TrialPlan) -> anyhow::Result<ArmEpoch> {
        session::answered(&self.link, &args.hand).await?;
        let until = Instant::now() + READY_WITHIN;
        let known = |sample: &HandSample| {
            sample.faults.is_some() && sample.angle.is_some() && sample.temperature.is_some()
        };
        while !known(&self.sample) {
            self.news().await?;
            if Instant::now() >= until {
                bail!(
                    "the hand at {} does not tell its angles, faults and temperatures",
                    args.hand
                );
            }
        }
        let least = plan.grid.forces.iter().min().copied();
        let gentle = least.map_or(Force::GENTLE, |least| least.min(Force::GENTLE));
        self.link.arm(ArmRequest {
            speed: PerDof::splat(Speed::GENTLE),
            force: PerDof::splat(gentle),
        });
        loop {
            if let Some(epoch) = self.link.status().armed {
                return Ok(epoch);
            }
            self.news().await?;
            if Instant::now() >= until {
                bail!("the hand at {} could not be armed in time", args.hand);
            }
        }
    }

    /// Takes the next event, or lets a moment pass.
    async fn news(&mut self) -> anyhow::Result<()> {
        match timeout(TICK, self.link.event()).await {
            Ok(Some(LinkEvent::Sample { sample, .. })) => self.sample = *sample,
            Ok(Some(LinkEvent::ArmRefused { reason, .. })) => {
                bail!("the hand cannot be armed: {reason}")
            }
            Ok(None) => bail!("the link ended"),
            Ok(Some(_)) | Err(_) => {}
        }
        Ok(())
    }

    /// Holds, and waits for what feedback says of it.
    async fn stop(&mut self) -> Stop {
        self.link.stop();
        let begun = Instant::now();
        while begun.elapsed() < REST_WITHIN {
            let status = self.link.status();
            if !status.state.is_live() {
                return Stop::LinkLost;
            }
            if let Hold::Confirmed { at, rest } = status.hold
                && status.armed.is_none()
            {
                let after_s = rest.since(at).as_secs_f64();
                return Stop::Confirmed { after_s };
            }
            let _event = timeout(TICK, self.link.event()).await;
        }
        Stop::NotConfirmed
    }
}

struct Run {
    bench: Bench,
    series: Series,
    trials: Vec<Trial>,
    stop: Option<Stop>,
    writer: Option<Writer>,
}

impl Run {
    async fn play(
        &mut self,
        out: &mut Out,
        args: &TrialArgs,
        interrupt: &mut Interrupt,
    ) -> anyhow::Result<()> {
        while !self.series.is_over() {
            let event = tokio::select! {
                biased;
                () = interrupt.wished() => {
                    self.abort(Abort::Person).await;
                    None
                }
                event = timeout(TICK, self.bench.link.event()) => event.ok().flatten(),
            };
            if let Some(LinkEvent::Sample { sample, fresh }) = event {
                self.bench.sample = *sample;
                self.series.take(&sample, fresh);
            }
            let view = LinkView::from(&self.bench.link.status());
            let now = self.bench.clock.now();
            match self.series.tick(&self.bench.sample, view, now) {
                Some(Order::Set(setpoints)) => self.bench.link.set(&setpoints),
                Some(Order::Stop) => self.stop = Some(self.bench.stop().await),
                None => {}
            }
            self.tell(out, args)?;
        }
        Ok(())
    }

    async fn abort(&mut self, why: Abort) {
        let now = self.bench.clock.now();
        if self.series.end(why, now).is_some() {
            self.stop = Some(self.bench.stop().await);
        }
    }

    /// Shows and keeps the trials that are over.
    fn tell(&mut self, out: &mut Out, args: &TrialArgs) -> anyhow::Result<()> {
        while let Some(trial) = self.series.finished() {
            if args.json {
                out.line(&told::trial_json(&trial, args.out.is_some()).to_string())?;
            } else {
                for line in told::trial_lines(&trial, self.series.progress().1) {
                    out.line(&line)?;
                }
            }
            out.flush()?;
            let mut kept = trial;
            if let Some(writer) = &self.writer {
                writer.keep(kept.clone())?;
            }
            kept.recording = crate::app::trial::Recording::default();
            self.trials.push(kept);
        }
        Ok(())
    }

    /// Whatever ended it, the hand is left disarmed, and at rest as far as it can be told.
    async fn end(mut self, ran: anyhow::Result<()>) -> anyhow::Result<Outcome> {
        if ran.is_err() {
            self.abort(Abort::NotKept).await;
        }
        if self.stop == Some(Stop::NotConfirmed) {
            say("STOP NOT CONFIRMED: the hand may still move; switch off its 24 V supply");
        }
        self.bench.link.disarm();
        let until = Instant::now() + READY_WITHIN;
        while self.bench.link.status().armed.is_some() && Instant::now() < until {
            sleep(TICK).await;
        }
        let aborted = self.series.aborted();
        let written = self
            .writer
            .take()
            .map_or(Ok(()), |writer| writer.end(aborted));
        ran?;
        written?;
        Ok(Outcome {
            trials: self.trials,
            aborted: aborted.map(|why| format!("ended early: {why}")),
            stop: self.stop,
        })
    }
}

/// Files are written on a thread of their own: a slow disk must not make the hand's feedback old.
struct Writer {
    trials: mpsc::SyncSender<Trial>,
    thread: JoinHandle<std::io::Result<Keeper>>,
}

impl Writer {
    /// Makes the folder, if one is asked for.
    fn start(
        args: &TrialArgs,
        plan: &TrialPlan,
        link: &LinkHandle,
    ) -> anyhow::Result<Option<Self>> {
        let Some(folder) = &args.out else {
            return Ok(None);
        };
        let begun = since_1970();
        let head = Head {
            hand: args.hand.to_string(),
            simulated: args.hand.is_sim(),
            begun,
            note: args.note.clone(),
            tags: args.tags.clone(),
            quirks: Some(QuirkSheet::new(
                &args.hand,
                &link.status().quirks,
                &day(begun),
            )),
        };
        let mut keeper = Keeper::create(folder, &head, plan, args.criterion())
            .with_context(|| unwritable(folder))?;
        let (trials, waiting) = mpsc::sync_channel::<Trial>(WRITES_MAX);
        let thread = std::thread::spawn(move || {
            for trial in waiting {
                keeper.keep(&trial)?;
            }
            Ok(keeper)
        });
        Ok(Some(Self { trials, thread }))
    }

    fn keep(&self, trial: Trial) -> anyhow::Result<()> {
        self.trials.try_send(trial).map_err(|_gone| {
            anyhow!("the trials cannot be written as fast as they come, or at all")
        })
    }

    fn end(self, aborted: Option<Abort>) -> anyhow::Result<()> {
        drop(self.trials);
        let ended = self.thread.join();
        let keeper = ended.map_err(|_panic| anyhow!("writing the trials failed"))?;
        let closed = keeper.and_then(|keeper| keeper.close(aborted));
        closed.context("cannot write the trials")
    }
}

fn unwritable(folder: &Path) -> String {
    format!("cannot keep the trials in {}", folder.display())
}
