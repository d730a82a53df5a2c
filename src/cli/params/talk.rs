//! One conversation about parameters: reads, settings, SAVE, reset, each to its end. Prints nothing and decides nothing.

use crate::app::params::table::ParamId;
use crate::app::params::values::{Params, SPANS};
use crate::cli::session::{self, ANSWER_WITHIN};
use crate::hand::{HandCommand, Setting, Span};
use crate::link::{
    Clock, LinkEvent, LinkHandle, NotSent, Outcome, PollRates, Request, RequestError, Reset, Saved,
    Ticket, Verdict, Written,
};
use crate::transport::Endpoint;
use anyhow::{anyhow, bail};
use std::time::Duration;
use tokio::time::{Instant, sleep, timeout};

/// Often enough to see whether the hand moves.
const ONLY_THE_STATE: PollRates = PollRates {
    state_hz: 20.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};
/// Longer than any request takes: a SAVE waits for its result for 3 s, and a link that is lost shows within 2.
const END_WITHIN: Duration = Duration::from_secs(8);
/// A hand that moves is waited for this long.
const RESTS_WITHIN: Duration = Duration::from_secs(3);
/// Between giving up a port and taking it again.
const PORT_RESTS: Duration = Duration::from_millis(300);
/// So often it is asked again.
const AGAIN_EACH: Duration = Duration::from_millis(200);
/// Tries to read a group: a late answer may have to be waited out, and a lost link comes back.
const READ_TRIES: u32 = 4;

/// A link and the hand at its end.
pub(crate) struct Talk {
    link: LinkHandle,
    hand: Endpoint,
}

impl Talk {
    /// Opens the link and waits for the hand. Must be called within a tokio runtime.
    pub(crate) async fn open(hand: &Endpoint) -> anyhow::Result<Self> {
        let link = session::open(hand, ONLY_THE_STATE, Clock::start());
        session::answered(&link, hand).await?;
        Ok(Self {
            link,
            hand: hand.clone(),
        })
    }

    /// The same on a port that another link was just given up on: it takes a moment to be free.
    pub(crate) async fn open_next(hand: &Endpoint) -> anyhow::Result<Self> {
        sleep(PORT_RESTS).await;
        Self::open(hand).await
    }

    /// Waits until the hand answers again, if the link was lost.
    pub(crate) async fn back(&self) -> anyhow::Result<()> {
        let until = Instant::now() + ANSWER_WITHIN;
        while Instant::now() < until {
            if self.link.status().state.is_live() {
                return Ok(());
            }
            sleep(Duration::from_millis(20)).await;
        }
        session::answered(&self.link, &self.hand).await
    }

    /// Reads all rows. Those that could not be read are missing, and the reason is given.
    pub(crate) async fn read(&mut self) -> anyhow::Result<(Params, Vec<String>)> {
        let mut params = Params::default();
        let mut troubles = Vec::new();
        for span in SPANS {
            match self.read_span(span).await {
                Ok(bytes) => params.take(span, &bytes),
                Err(error) => troubles.push(error.to_string()),
            }
        }
        if params.is_empty() {
            let why = troubles.pop().unwrap_or_default();
            bail!("cannot read any parameter of {}: {why}", self.hand);
        }
        Ok((params, troubles))
    }

    /// Reads all rows; a row that could not be read is an error.
    pub(crate) async fn read_whole(&mut self) -> anyhow::Result<Params> {
        let (params, troubles) = self.read().await?;
        let missing = ParamId::all()
            .into_iter()
            .find(|id| params.get(*id).is_none());
        match missing {
            None => Ok(params),
            Some(id) => {
                let why = troubles.first().cloned().unwrap_or_default();
                Err(anyhow!("cannot read {}: {why}", id.name()))
            }
        }
    }

    /// Reads a group once more; nothing if it cannot be read.
    pub(crate) async fn read_again(&mut self, span: Span) -> Option<Vec<u8>> {
        self.read_span(span).await.ok()
    }

    async fn read_span(&mut self, span: Span) -> Result<Vec<u8>, RequestError> {
        let mut tries = READ_TRIES;
        loop {
            tries -= 1;
            match self.ask(Request::Read(span)).await {
                Ok(Outcome::Memory { bytes, .. }) => return Ok(bytes),
                Err(error @ (RequestError::Refused { .. } | RequestError::TooLong { .. })) => {
                    return Err(error);
                }
                Err(error) if tries == 0 => return Err(error),
                Err(_) | Ok(_) => {
                    sleep(AGAIN_EACH).await;
                    // If it does not come back, the next try says so.
                    let _back = self.back().await;
                }
            }
        }
    }

    /// Writes a setting and reads it back.
    pub(crate) async fn set(&mut self, setting: Setting) -> anyhow::Result<Written> {
        match self.rested(Request::Set(setting)).await? {
            Outcome::Written(written) => Ok(written),
            other => Err(unexpected(&other)),
        }
    }

    /// Tells the hand something once; the reason if it was refused. A missing answer is no refusal.
    pub(crate) async fn tell(&mut self, command: HandCommand) -> Option<String> {
        match self.ask(Request::Command(command)).await {
            Err(RequestError::Refused { reason, .. }) => Some(reason),
            _ => None,
        }
    }

    /// Writes the parameters to flash.
    pub(crate) async fn save(&mut self) -> anyhow::Result<Saved> {
        match self.rested(Request::Save).await? {
            Outcome::Saved(saved) => Ok(saved),
            other => Err(unexpected(&other)),
        }
    }

    /// Returns to the factory's parameters.
    pub(crate) async fn reset(&mut self) -> anyhow::Result<Reset> {
        match self.rested(Request::Reset).await? {
            Outcome::Reset(reset) => Ok(reset),
            other => Err(unexpected(&other)),
        }
    }

    /// Asks, and asks again for a while where the hand still moves or an earlier SAVE is too near.
    async fn rested(&mut self, request: Request) -> anyhow::Result<Outcome> {
        let until = Instant::now() + RESTS_WITHIN;
        loop {
            let outcome = self.ask(request).await?;
            let wait = match outcome {
                Outcome::Saved(Saved::NotSent(why))
                | Outcome::Reset(Reset::NotSent(why))
                | Outcome::Written(Written {
                    verdict: Verdict::NotSent(why),
                    ..
                }) => match why {
                    NotSent::TooSoon { wait } => wait,
                    NotSent::Moving | NotSent::Holding => AGAIN_EACH,
                    NotSent::Armed => return Ok(outcome),
                },
                _ => return Ok(outcome),
            };
            if Instant::now() >= until {
                return Ok(outcome);
            }
            sleep(wait).await;
        }
    }

    async fn ask(&mut self, request: Request) -> Result<Outcome, RequestError> {
        let ticket = self.link.ask(request)?;
        match timeout(END_WITHIN, self.end_of(ticket)).await {
            Ok(end) => end,
            Err(_elapsed) => Err(RequestError::LinkLost),
        }
    }

    async fn end_of(&mut self, asked: Ticket) -> Result<Outcome, RequestError> {
        while let Some(event) = self.link.event().await {
            match event {
                LinkEvent::Done { ticket, result } if ticket == asked => return result,
                _ => {}
            }
        }
        Err(RequestError::LinkLost)
    }
}

fn unexpected(outcome: &Outcome) -> anyhow::Error {
    anyhow!("the link answered something else than was asked: {outcome:?}")
}
