//! `follow`: a hand follows another program (JSON lines or DDS), a gamepad or another hand, once the user permits it.

use crate::cli::consent::{self, ConsentFrom};
use crate::cli::hold;
use crate::cli::inputs::source::{Allowed, FollowSource, SourceArgs};
use crate::cli::out::{AlreadyReported, Out, ReaderGone, WrongUsage, notify};
use crate::cli::parse::{self, number};
use crate::cli::recordings::beside::SideRecording;
use crate::cli::session;
use crate::hand::{DriveHeat, Force, HandSample, Moment, PerDof, Speed};
use crate::link::{ArmRequest, Clock, LinkHandle, Owner, PollRates, Records};
use crate::motion::follow::step::{FollowLimits, FollowPhase};
use crate::motion::follow::{FollowHold, FollowStart, FollowTerms, FollowView, follow};
use crate::motion::hold::{HoldEnd, HoldPhase};
use crate::motion::program::Ended;
use crate::record::{Abort, Disarmed, Record};
use crate::shell::interrupt::Interrupt;
use crate::transport::Endpoint;
use anyhow::{anyhow, bail};
use serde_json::json;
use std::cell::Cell;
use std::convert::Infallible;
use std::path::PathBuf;
use std::pin::pin;
use std::time::Duration;
use tokio::sync::watch;
use tokio::time::{Instant, sleep, timeout};

/// Interval of progress reports.
const REPORT_INTERVAL: Duration = Duration::from_secs(1);
/// Polling interval for senders.
const POLL_INTERVAL: Duration = Duration::from_millis(20);
/// Maximum time until the hand reports its position.
const READY_TIMEOUT: Duration = Duration::from_secs(5);

#[derive(Debug, clap::Args)]
pub(crate) struct FollowArgs {
    /// The hand that follows
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    hand: Endpoint,
    #[command(flatten)]
    from: SourceArgs,
    /// Move the hand. Make sure that nothing is in its way and the 24 V switch is in reach. Without this option what arrives is only shown
    #[arg(long)]
    arm: bool,
    /// How far a target may be ahead of its joint, 20 to 500 counts of 1000
    #[arg(long, value_name = "COUNTS", default_value_t = FollowLimits::default().lead, value_parser = lead)]
    lead: u16,
    /// How fast a target may go, 50 to 1700 counts a second
    #[arg(long, value_name = "COUNTS", default_value_t = FollowLimits::default().rate, value_parser = rate)]
    rate: u16,
    /// Speed of the drives, 1 to 1000 [default: a quarter more than --rate needs]
    #[arg(long, value_parser = parse::moving_speed)]
    speed: Option<Speed>,
    /// Force threshold of all joints, 0 to 2000 g [default: gentle]
    #[arg(long, value_parser = parse::rated_force)]
    force: Option<Force>,
    /// Take a line of standard input for an answer, also where that is no terminal: one that comes after the question
    #[arg(long, value_name = "FROM", requires = "arm")]
    consent: Option<ConsentFrom>,
    /// Record meanwhile, as 'handscope record' does; every write is recorded as it was sent
    #[arg(long, value_name = "FILE.mcap")]
    record: Option<PathBuf>,
    /// Print JSON: an object a second, and one at each change
    #[arg(long)]
    json: bool,
}

fn lead(text: &str) -> Result<u16, String> {
    let (least, most) = FollowLimits::LEAD;
    number(text, least..=most, "a lead of 20 to 500 counts")
}

fn rate(text: &str) -> Result<u16, String> {
    let (least, most) = FollowLimits::RATE;
    number(text, least..=most, "a rate of 50 to 1700 counts a second")
}

impl FollowArgs {
    fn terms(&self) -> FollowTerms {
        FollowTerms {
            limits: FollowLimits {
                lead: self.lead,
                rate: self.rate,
            },
            ..FollowTerms::default()
        }
    }

    fn arm_request(&self) -> ArmRequest {
        // 1000 is the full stroke in 600 ms (manual 2.6.13).
        let needed = Speed::nearest(i64::from(self.rate) * 6 / 10 * 5 / 4);
        ArmRequest {
            speed: PerDof::splat(self.speed.unwrap_or(needed)),
            force: PerDof::splat(self.force.unwrap_or(Force::GENTLE)),
        }
    }
}

/// Follows until the user ends it.
pub(crate) async fn run(out: &mut Out, args: &FollowArgs) -> anyhow::Result<()> {
    if let Some(why) = args.from.wrong(&args.hand) {
        return Err(WrongUsage::error(why));
    }
    let mut interrupt = Interrupt::listen()?;
    let clock = Clock::start();
    let (link, mut records) = session::open_with_records(&args.hand, PollRates::default(), clock);
    let seen = tokio::select! {
        biased;
        () = interrupt.wished() => return Ok(()),
        seen = known(&link, &mut records, &args.hand) => seen?,
    };
    let allowed = Allowed {
        limits: args.arm_request(),
        moves: args.arm,
    };
    let source = tokio::select! {
        biased;
        () = interrupt.wished() => return Ok(()),
        source = FollowSource::open(&args.from, &args.hand, (&link, clock), allowed) => source?,
    };
    let recording = args.record.as_deref();
    let recording = SideRecording::begin(recording, &link, &args.hand, args.from.side())?;
    let mut at = FollowCommand {
        link: link.clone(),
        records,
        seen,
        clock,
        args,
        source: &source,
        printer: ProgressPrinter {
            out,
            json: args.json,
            question: None,
            heat: None,
            odd_stops: 0,
            printed: None,
        },
    };
    let ended = tokio::select! {
        biased;
        () = interrupt.wished() => Ok(()),
        Err(ended) = at.run() => Err(ended),
    };
    drop(at);
    let done = if args.arm {
        leave(ended, session::stopped(&link).await)
    } else {
        ended
    };
    drop((source, link));
    SideRecording::and(done, recording.end().await)
}

/// Combines the results at the end of a command that could move the hand. The hand has been stopped if that was
/// possible.
fn leave(ended: anyhow::Result<()>, stopped: anyhow::Result<()>) -> anyhow::Result<()> {
    let Err(why) = ended else { return stopped };
    if why.is::<ReaderGone>() {
        let words = match stopped {
            Ok(()) => "the hand was stopped".to_owned(),
            Err(not) => not.to_string(),
        };
        notify(&format!("the output is no longer read: {words}"));
        return Err(AlreadyReported.into());
    }
    if let Err(not) = stopped {
        notify(&not.to_string());
    }
    Err(why)
}

/// Waits until the hand has reported its angles and faults.
async fn known(
    link: &LinkHandle,
    records: &mut Records,
    hand: &Endpoint,
) -> anyhow::Result<HandSample> {
    session::answered(link, hand).await?;
    let until = Instant::now() + READY_TIMEOUT;
    while Instant::now() < until {
        if let Ok(Some(Record::Reading { sample, .. })) =
            timeout(POLL_INTERVAL, records.next()).await
            && sample.angle.is_some()
            && sample.faults.is_some()
        {
            return Ok(*sample);
        }
    }
    bail!("the hand at {hand} does not report its angles and faults")
}

struct FollowCommand<'a> {
    link: LinkHandle,
    records: Records,
    seen: HandSample,
    clock: Clock,
    args: &'a FollowArgs,
    source: &'a FollowSource,
    printer: ProgressPrinter<'a>,
}

impl FollowCommand<'_> {
    /// Follows senders, each time with the user's permission.
    async fn run(&mut self) -> anyhow::Result<Infallible> {
        self.printer.out.line(&self.source.ready())?;
        self.printer.out.flush()?;
        loop {
            let (owner, sender) = self.sender().await?;
            let end = tokio::select! {
                biased;
                why = self.source.must_end(), if self.args.arm => bail!("{why}: the hand was stopped"),
                end = self.follow(owner) => end?,
            };
            let why = ended(end, &sender);
            self.request_consent(&why).await?;
        }
    }

    /// Follows until that ends; a failed progress report ends it as well.
    async fn follow(&mut self, owner: Owner) -> anyhow::Result<Ended<()>> {
        let offers = self.source.follow();
        let start = FollowStart {
            lease: self.link.grant(owner),
            terms: watch::Sender::new(self.args.terms()).subscribe(),
            arm: self.args.arm_request(),
            grip: session::grip_estimator(&self.args.hand),
            overshoot: hold::overshoot(&self.args.hand),
            blocks: session::size_blocks(&self.args.hand),
            seen: self.seen,
            clock: self.clock,
        };
        let (source, printer, clock) = (self.source, &mut self.printer, self.clock);
        let seen = Cell::new(None);
        let printing = async {
            loop {
                printer.print(source, seen.get(), clock.now())?;
                sleep(POLL_INTERVAL).await;
            }
        };
        tokio::select! {
            biased;
            Err::<Infallible, anyhow::Error>(error) = printing => Err(error),
            end = follow(&self.link, start, offers, |view| seen.set(Some(view))) => Ok(end),
        }
    }

    /// Asks the user for permission to move the hand again, and waits for the answer.
    async fn request_consent(&mut self, why: &str) -> anyhow::Result<()> {
        let earlier = consent::forget_earlier(self.args.consent);
        let earlier = self.reporting_meanwhile(earlier).await?;
        earlier.map_err(|nobody| anyhow!("{why}, and {nobody}"))?;
        let how = match self.args.consent {
            None => "press Enter to let it move again, Ctrl-C to leave",
            Some(ConsentFrom::Stdin) => "enter a line to let it move again",
        };
        notify(&format!("{why}; {how}"));
        self.printer.question = Some(why.to_owned());
        let given = self.reporting_meanwhile(consent::answer()).await?;
        self.printer.question = None;
        given.map_err(|nobody| anyhow!("{why}, and {nobody}"))
    }

    /// Continues progress reports while waiting.
    async fn reporting_meanwhile<T>(&mut self, wait: impl Future<Output = T>) -> anyhow::Result<T> {
        let mut wait = pin!(wait);
        loop {
            self.poll()?;
            if let Ok(done) = timeout(POLL_INTERVAL, &mut wait).await {
                return Ok(done);
            }
        }
    }

    /// Waits for a sender to follow; forever if the hand must not move.
    async fn sender(&mut self) -> anyhow::Result<(Owner, String)> {
        loop {
            self.poll()?;
            let owner = self.source.owner(self.clock.now());
            if let Some(owner) = owner.filter(|_| self.args.arm) {
                return Ok(owner);
            }
            sleep(POLL_INTERVAL).await;
        }
    }

    /// Applies readings while nothing is followed, and reports the progress.
    fn poll(&mut self) -> anyhow::Result<()> {
        while let Some(record) = self.records.try_next() {
            if let Record::Reading { sample, .. } = record {
                self.seen = *sample;
            }
        }
        self.printer.heat = self.link.status().heat;
        self.printer.print(self.source, None, self.clock.now())
    }
}

/// Reason why following ended, and its effect on the hand.
fn ended(end: Ended<()>, sender: &str) -> String {
    let why = match end {
        Ok(()) => format!("{sender} fell silent"),
        Err(why @ Abort::TakenOver) => return why.to_string(),
        Err(Abort::LinkLost) => {
            let why = Disarmed::LinkLost;
            return format!("{why}: nothing reached the hand, which may still finish its move");
        }
        Err(Abort::Disarmed { why: Some(why) }) => match why {
            Disarmed::Resume => {
                return format!(
                    "{why}: nothing reached the hand, which may have finished its move"
                );
            }
            Disarmed::FrozenFeedback => {
                return format!("{why}: the hand is held at its estimated position, check it");
            }
            Disarmed::Person => return format!("{why}, and continues to its last target"),
            _ => why.to_string(),
        },
        Err(why @ Abort::OtherController { .. }) => return format!("{why}, and may move the hand"),
        Err(why) => why.to_string(),
    };
    format!("{why}: the hand was stopped")
}

/// Phase of following, phase and end of its hold, and true while a question awaits an answer: a change of these is printed at once.
type PrintedState = (
    Option<FollowPhase>,
    Option<(HoldPhase, Option<HoldEnd>)>,
    bool,
);

/// Prints the progress: at each change, and every second.
struct ProgressPrinter<'a> {
    out: &'a mut Out,
    json: bool,
    /// Question that awaits the user's answer: the reason why the hand does not move.
    question: Option<String>,
    /// The warmest drive, if one is warm.
    heat: Option<DriveHeat>,
    /// Number of irregular stops reported.
    odd_stops: u64,
    printed: Option<(PrintedState, Moment)>,
}

impl ProgressPrinter<'_> {
    fn print(
        &mut self,
        source: &FollowSource,
        follow: Option<FollowView>,
        now: Moment,
    ) -> anyhow::Result<()> {
        // A reader that has gone is noticed before the next line is due.
        self.out.flush()?;
        if let Some(view) = follow {
            self.heat = view.heat;
        }
        let phase = follow.map(|view| view.phase);
        let hold = follow.and_then(|view| view.hold);
        let step = hold.map(|hold| (hold.view.phase, hold.end));
        let state = (phase, step, self.question.is_some());
        let is_due =
            |(printed, at): (_, Moment)| printed != state || now.since(at) >= REPORT_INTERVAL;
        if !self.printed.is_none_or(is_due) {
            return Ok(());
        }
        self.printed = Some((state, now));
        if let Some((count, words)) = source.odd_stops()
            && count != std::mem::replace(&mut self.odd_stops, count)
        {
            notify(&words);
        }
        let phase = phase.map_or("waiting", phase_word);
        let (words, mut object) = source.progress(now);
        match object.as_object_mut().filter(|_| self.json) {
            Some(fields) => {
                fields.insert("t_s".into(), now.since(Moment::ZERO).as_secs_f64().into());
                fields.insert("phase".into(), phase.into());
                let lead = follow.map(|view| view.lead);
                fields.insert("lead".into(), lead.into());
                let delay = follow.and_then(|view| view.delay_p99);
                let delay = delay.map(|delay| delay.as_secs_f64() * 1e3);
                fields.insert("delay_p99_ms".into(), delay.into());
                fields.insert("question".into(), self.question.clone().into());
                let heat = self.heat;
                let heat =
                    heat.map(|heat| json!({"joint": heat.dof.name(), "celsius": heat.celsius}));
                fields.insert("heat".into(), heat.into());
                fields.insert("hold".into(), serde_json::to_value(hold)?);
                self.out.stream_object(&object)?;
            }
            None => {
                let heat = self
                    .heat
                    .map_or_else(String::new, |heat| format!("  {heat}"));
                let hold = hold.map_or_else(String::new, hold_words);
                self.out
                    .stream_line(&format!("{phase:<9} {words}{hold}{heat}"))?;
            }
        }
        self.out.flush()
    }
}

/// State of a hold, to be appended to a line.
fn hold_words(hold: FollowHold) -> String {
    let view = hold.view;
    let force = view.mean_g().map_or("-".into(), |g| g.to_string());
    match (hold.end, view.phase) {
        (Some(HoldEnd::Nothing | HoldEnd::Held), _) => "  the hand holds nothing".into(),
        (Some(HoldEnd::Lost), _) => "  the object left the hand".into(),
        (Some(HoldEnd::Late), _) => "  the hand did not get there in time".into(),
        (None, HoldPhase::Measuring) => "  measuring".into(),
        (None, HoldPhase::Closing) => "  closing".into(),
        (None, HoldPhase::Holding) => format!("  with {force} g"),
        (None, HoldPhase::CannotHold) => format!("  CANNOT HOLD: with {force} g"),
    }
}

const fn phase_word(phase: FollowPhase) -> &'static str {
    match phase {
        FollowPhase::Waiting => "arming",
        FollowPhase::Following => "following",
        FollowPhase::Frozen => "frozen",
        FollowPhase::Holding => "holding",
        FollowPhase::Silent => "silent",
        FollowPhase::Released => "released",
    }
}
