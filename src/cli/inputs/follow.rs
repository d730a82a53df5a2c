//! `follow`: a hand follows what another program sends, as lines of JSON or over DDS, a gamepad or another hand, once a person lets it.

use crate::cli::inputs::source::{FollowSource, SourceArgs};
use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, WrongUsage, say};
use crate::cli::parse::{self, number};
use crate::cli::session;
use crate::hand::{Force, HandSample, Moment, PerDof, Speed};
use crate::inputs::follow::{FollowLimits, FollowPhase};
use crate::link::{ArmRequest, Clock, LinkHandle, Owner, PollRates, Records};
use crate::record::{Disarmed, Record};
use crate::tasks::follow::{FollowEnd, FollowStart, FollowTerms, FollowView, follow};
use crate::transport::Endpoint;
use anyhow::bail;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep, timeout};

/// How often it is told how it goes.
const TELL_EACH: Duration = Duration::from_secs(1);
/// How often it is looked whether somebody sends.
const LOOK_EACH: Duration = Duration::from_millis(20);
/// How long the hand may take to say where it is.
const READY_WITHIN: Duration = Duration::from_secs(5);

#[derive(Debug, clap::Args)]
pub(crate) struct FollowArgs {
    /// The hand that follows
    #[arg(long, value_name = "URL")]
    hand: Endpoint,
    #[command(flatten)]
    from: SourceArgs,
    /// Move the hand: nothing is in its way, and the 24 V switch is in reach. Without, what arrives is only shown
    #[arg(long)]
    arm: bool,
    /// How far a target may be ahead of its joint, 20 to 500 counts of 1000
    #[arg(long, value_name = "COUNTS", default_value_t = FollowLimits::default().lead, value_parser = lead)]
    lead: u16,
    /// How fast a target may go, 50 to 1700 counts a second
    #[arg(long, value_name = "COUNTS", default_value_t = FollowLimits::default().rate, value_parser = rate)]
    rate: u16,
    /// Speed of the drives, 1 to 1000 [default: a quarter more than --rate needs]
    #[arg(long, value_parser = parse::speed)]
    speed: Option<Speed>,
    /// Force threshold of all joints, g [default: gentle]
    #[arg(long, value_parser = parse::force)]
    force: Option<Force>,
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

/// Follows until a person ends it.
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
    let source = tokio::select! {
        biased;
        () = interrupt.wished() => return Ok(()),
        source = FollowSource::open(&args.from, &args.hand, (&link, clock), args.arm_request()) => source?,
    };
    out.line(&source.ready())?;
    out.flush()?;
    let mut at = AtHand {
        link,
        seen,
        clock,
        args,
        source: &source,
        teller: Teller {
            out,
            json: args.json,
            told: None,
        },
    };
    tokio::select! {
        biased;
        () = interrupt.wished() => {}
        ended = at.go_on() => ended?,
    }
    match args.arm {
        true => session::stopped(&at.link, &mut records).await,
        false => Ok(()),
    }
}

/// Waits until the hand says where it is.
async fn known(
    link: &LinkHandle,
    records: &mut Records,
    hand: &Endpoint,
) -> anyhow::Result<HandSample> {
    session::answered(link, hand).await?;
    let until = Instant::now() + READY_WITHIN;
    while Instant::now() < until {
        if let Ok(Some(Record::Reading { sample, .. })) = timeout(LOOK_EACH, records.next()).await
            && sample.angle.is_some()
            && sample.faults.is_some()
        {
            return Ok(*sample);
        }
    }
    bail!("the hand at {hand} does not tell its angles and faults")
}

struct AtHand<'a> {
    link: LinkHandle,
    seen: HandSample,
    clock: Clock,
    args: &'a FollowArgs,
    source: &'a FollowSource,
    teller: Teller<'a>,
}

impl AtHand<'_> {
    /// Follows whoever sends, each time that a person lets it.
    async fn go_on(&mut self) -> anyhow::Result<()> {
        let mut entered = entered_lines();
        loop {
            let (owner, sender) = self.sender().await?;
            let (offers, lease) = (self.source.follow(), self.link.grant(owner));
            let start = FollowStart {
                lease,
                terms: watch::Sender::new(self.args.terms()).subscribe(),
                arm: self.args.arm_request(),
                seen: self.seen,
                clock: self.clock,
            };
            let (source, teller, clock) = (self.source, &mut self.teller, self.clock);
            let mut trouble = None;
            let tell = |view| {
                let told = teller.tell(source, Some(view), clock.now());
                trouble = trouble.take().or(told.err());
            };
            let end = follow(&self.link, start, offers, tell).await;
            if let Some(trouble) = trouble {
                return Err(trouble);
            }
            let why = match end {
                FollowEnd::Silent | FollowEnd::Gone => format!("{sender} fell silent"),
                FollowEnd::Lease(_) => self.lease_end(),
            };
            say(&format!(
                "{why}: the hand was stopped; press Enter to let it move again, Ctrl-C to leave"
            ));
            self.teller.tell(self.source, None, clock.now())?;
            if entered.recv().await.is_none() {
                bail!("{why}, and nobody can press Enter here");
            }
        }
    }

    fn lease_end(&self) -> String {
        let why = match self.link.status().disarmed {
            Some(Disarmed::Stop) => "it was told to stop",
            Some(Disarmed::Fault) => "a drive reports a fault",
            Some(Disarmed::LinkLost) => "the link was lost",
            Some(Disarmed::Stale) => "feedback grew old",
            Some(Disarmed::Resume) => "this computer slept",
            Some(Disarmed::OtherController) => "another controller talks to the hand",
            _ => "it may not be moved any more",
        };
        why.to_owned()
    }

    /// Waits until there is somebody to follow; for ever if the hand is not to move.
    async fn sender(&mut self) -> anyhow::Result<(Owner, String)> {
        loop {
            let now = self.clock.now();
            self.teller.tell(self.source, None, now)?;
            if let Some(owner) = self.source.owner(now).filter(|_| self.args.arm) {
                return Ok(owner);
            }
            sleep(LOOK_EACH).await;
        }
    }
}

/// A message for each line that a person enters, until there can be no more.
fn entered_lines() -> mpsc::Receiver<()> {
    let (entered, lines) = mpsc::channel(1);
    // Reading a terminal blocks, and ends with the program.
    std::thread::spawn(move || {
        let mut line = String::new();
        while matches!(std::io::stdin().read_line(&mut line), Ok(1..)) {
            line.clear();
            if entered.blocking_send(()).is_err() {
                return;
            }
        }
    });
    lines
}

/// Prints how it goes: at each change, and each second.
struct Teller<'a> {
    out: &'a mut Out,
    json: bool,
    told: Option<(Option<FollowPhase>, Moment)>,
}

impl Teller<'_> {
    fn tell(
        &mut self,
        source: &FollowSource,
        follow: Option<FollowView>,
        now: Moment,
    ) -> anyhow::Result<()> {
        let phase = follow.map(|view| view.phase);
        let is_due = |(told, at): (_, Moment)| told != phase || now.since(at) >= TELL_EACH;
        if !self.told.is_none_or(is_due) {
            return Ok(());
        }
        self.told = Some((phase, now));
        let phase = phase.map_or("waiting", phase_word);
        let (words, mut object) = source.told(now);
        match object.as_object_mut().filter(|_| self.json) {
            Some(fields) => {
                fields.insert("t_s".into(), now.since(Moment::ZERO).as_secs_f64().into());
                fields.insert("phase".into(), phase.into());
                let lead = follow.map(|view| view.lead);
                fields.insert("lead".into(), lead.into());
                let delay = follow.and_then(|view| view.delay_p99);
                let delay = delay.map(|delay| delay.as_secs_f64() * 1e3);
                fields.insert("delay_p99_ms".into(), delay.into());
                self.out.object(&object)?;
            }
            None => self.out.line(&format!("{phase:<9} {words}"))?,
        }
        self.out.flush()
    }
}

const fn phase_word(phase: FollowPhase) -> &'static str {
    match phase {
        FollowPhase::Waiting => "arming",
        FollowPhase::Following => "following",
        FollowPhase::Frozen => "frozen",
        FollowPhase::Silent => "silent",
        FollowPhase::Released => "released",
    }
}
