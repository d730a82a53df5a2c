//! Operations at rest with exclusive use of the line: persistent settings, SAVE, reset, calibration. One at a time; a
//! stop precedes each exchange. `watch::save` decides what a late frame means.

use crate::hand::register::{DEFAULT_FORCE_SET, DEFAULT_SPEED_SET, SAVE};
use crate::hand::{Moment, Refusal, Setting, Span, Trigger};
use crate::link::bus::{Bus, BusError, ResultFrame};
use crate::link::request::{Answer, Request, RequestError};
use crate::link::session::conversation::{Session, WireEnd, unless_lost};
use crate::link::session::requests::request_error;
use crate::link::session::watch::save::{Ack, Next};
use crate::link::wanted::PendingControl;
use crate::record::{
    Calibrated, Doubt, LinkState, NotSent, Reset, Rest, SaveDoubt, Saved, Verdict, WriteCause,
    Written,
};
use std::sync::Arc;
use std::time::Duration;
use tokio::time::sleep_until;

/// Maximum reads to verify one write: one lost reply must not leave it unverified, and a value that differs is read twice.
const READS: u8 = 3;
/// Maximum other reads to flush a duplicate of the last reply.
const CLEARINGS: u8 = 3;
/// Maximum reads of the pose if it is unknown whether the hand rests.
const REST_CHECKS: u8 = 2;
/// Range compared before and after a SAVE on wires without a result frame: the two default groups, which are adjacent.
const PARAMETERS: Span = Span::new(
    DEFAULT_SPEED_SET.address,
    DEFAULT_SPEED_SET.len + DEFAULT_FORCE_SET.len,
);
/// While the line is reserved for the hand, the session checks for other events at this interval.
const LISTEN_DURATION: Duration = Duration::from_millis(100);
/// Longest time from a calibration request to its end without a result frame. Manual: 2.6.6 gives no time; hands in use
/// took 2 to 6 s.
pub(crate) const CALIBRATION_TAKES: Duration = Duration::from_secs(8);

/// Remaining reads to verify with.
struct Tries {
    reads: u8,
    clearings: u8,
}

impl Tries {
    const fn new() -> Self {
        Self {
            reads: READS,
            clearings: CLEARINGS,
        }
    }
}

impl Session {
    /// Runs one of these requests to its end and answers it. If the link is lost meanwhile, the answer is the state
    /// known then, sent once the lost link was published.
    pub(crate) async fn alone(
        &mut self,
        bus: &mut dyn Bus,
        request: Request,
    ) -> Result<(), WireEnd> {
        match request {
            Request::Set(setting, answer) => {
                let end = self.write_setting(bus, setting).await;
                let lost = Written {
                    span: setting.span(),
                    verdict: Verdict::Unverified {
                        why: Doubt::LinkLost,
                    },
                    holds: None,
                };
                self.conclude(answer, end.map(Ok), Ok(lost))
            }
            Request::SetUnread(setting, answer) => {
                let end = self.write_unread(bus, setting).await;
                self.conclude(answer, end, Err(RequestError::LinkLost))
            }
            Request::Save(answer) => {
                let end = self.save_parameters(bus).await;
                let lost = match &end {
                    Err(_) => self.saving.lost().ok_or(RequestError::LinkLost),
                    Ok(_) => Err(RequestError::LinkLost),
                };
                self.conclude(answer, end.map(Ok), lost)
            }
            Request::Reset(answer) => {
                let end = self.reset_parameters(bus).await;
                self.conclude(answer, end.map(Ok), Ok(Reset::Unanswered))
            }
            Request::Calibrate(answer) => {
                let end = self.calibrate_forces(bus).await;
                let why = SaveDoubt::LinkLost;
                self.conclude(answer, end.map(Ok), Ok(Calibrated::Unknown { why }))
            }
            Request::Command(..) | Request::Read(..) => Ok(()),
        }
    }

    fn conclude<T: Send + Sync + 'static>(
        &mut self,
        answer: Answer<T>,
        end: Result<Result<T, RequestError>, WireEnd>,
        lost: Result<T, RequestError>,
    ) -> Result<(), WireEnd> {
        self.leaves_line = false;
        match end {
            Ok(end) => {
                let _sent = answer.send(end);
                Ok(())
            }
            Err(end) => {
                self.broken_off = Some(Box::new(move || {
                    let _sent = answer.send(lost);
                }));
                Err(end)
            }
        }
    }

    /// Handles more urgent work first: control requests, and a stop until it is confirmed or has failed.
    async fn give_way(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        loop {
            self.wake_up()?;
            self.turn(bus).await?;
            if !self.urgent_step(bus).await? {
                let stopping = self.motion.hold.is_some_and(|hold| !hold.alarmed);
                match self.next_poll() {
                    Some(question) if stopping => self.poll(bus, &question).await?,
                    None if stopping => self.idle().await,
                    _ => return Ok(()),
                }
            }
            self.after_step(bus);
        }
    }

    /// Reason why the request must not be done now, if any. An unknown rest state is resolved by reading first.
    async fn refusal(&mut self, bus: &mut dyn Bus) -> Result<Option<NotSent>, WireEnd> {
        let mut rest_checks = REST_CHECKS;
        loop {
            self.give_way(bus).await?;
            let now = self.now();
            let why = match (self.status.state, self.rest_now(now)) {
                (LinkState::Armed, _) => NotSent::Armed,
                (LinkState::Holding, _) => NotSent::Holding,
                (_, Rest::Resting) => return Ok(None),
                (_, Rest::Moving) => NotSent::Moving,
                (_, Rest::Unknown) if rest_checks > 0 => {
                    rest_checks -= 1;
                    self.poll_motion(bus).await?;
                    continue;
                }
                (_, Rest::Unknown) => NotSent::RestUnknown,
            };
            return Ok(Some(why));
        }
    }

    /// The same, and also refuses while the result of an earlier SAVE may still come.
    async fn trigger_refusal(&mut self, bus: &mut dyn Bus) -> Result<Option<NotSent>, WireEnd> {
        let why = self.refusal(bus).await?;
        let wait = self.saving.may_send(self.now()).err();
        Ok(why.or(wait.map(|wait| NotSent::TooSoon { wait })))
    }

    async fn write_setting(
        &mut self,
        bus: &mut dyn Bus,
        setting: Setting,
    ) -> Result<Written, WireEnd> {
        let written = |verdict, holds| Written {
            span: setting.span(),
            verdict,
            holds,
        };
        if let Some(why) = self.refusal(bus).await? {
            return Ok(written(Verdict::NotSent(why), None));
        }
        // Writing the same value twice is harmless: after a missing reply it is sent a second time.
        for may_repeat in [true, false] {
            let (refused, is_unanswered) = self.write_group(bus, setting).await?;
            let mut tries = Tries::new();
            let mut held = None;
            loop {
                match self.read_back(bus, setting.span(), &mut tries).await? {
                    Err(why) => return Ok(written(Verdict::Unverified { why }, None)),
                    Ok(bytes) if setting.is_held_by(&bytes) => {
                        return Ok(written(Verdict::Applied, Some(bytes)));
                    }
                    // The line may have no effective checksum, so a value read once is read again.
                    Ok(bytes) if held.as_ref() != Some(&bytes) && tries.reads > 0 => {
                        held = Some(bytes);
                    }
                    Ok(_) if is_unanswered && may_repeat => break,
                    Ok(bytes) => {
                        let verdict = match refused {
                            Some(reason) => Verdict::Refused { reason },
                            None => Verdict::Differs,
                        };
                        return Ok(written(verdict, Some(bytes)));
                    }
                }
            }
        }
        let why = Doubt::NotReadBack;
        Ok(written(Verdict::Unverified { why }, None))
    }

    /// Writes a group once without reading it back: the hand may answer elsewhere afterwards, or not at all.
    async fn write_unread(
        &mut self,
        bus: &mut dyn Bus,
        setting: Setting,
    ) -> Result<Result<(), RequestError>, WireEnd> {
        if let Some(why) = self.refusal(bus).await? {
            return Ok(Err(RequestError::NotNow(why)));
        }
        for write in setting.writes() {
            self.give_way(bus).await?;
            if let Err(error) = self.write(bus, &write, WriteCause::Setting).await {
                self.failed(bus, &error).await?;
                return Ok(Err(request_error(&error, write.span())));
            }
        }
        Ok(Ok(()))
    }

    /// Sends all writes of a group; returns the first refusal, and true if a reply is missing. Over CAN the group may
    /// be written in part.
    async fn write_group(
        &mut self,
        bus: &mut dyn Bus,
        setting: Setting,
    ) -> Result<(Option<Refusal>, bool), WireEnd> {
        let (mut refused, mut is_unanswered) = (None, false);
        for write in setting.writes() {
            self.give_way(bus).await?;
            let Err(error) = self.write(bus, &write, WriteCause::Setting).await else {
                continue;
            };
            match &error {
                BusError::Refused { reason } => {
                    refused.get_or_insert(*reason);
                }
                _ => is_unanswered = true,
            }
            self.failed(bus, &error).await?;
        }
        Ok((refused, is_unanswered))
    }

    async fn save_parameters(&mut self, bus: &mut dyn Bus) -> Result<Saved, WireEnd> {
        if let Some(why) = self.trigger_refusal(bus).await? {
            return Ok(Saved::NotSent(why));
        }
        let frame = bus.save_result_frame();
        // Without the values from before there is nothing to compare with, which the result reports.
        let mut before = None;
        if frame == ResultFrame::None {
            let mut tries = Tries::new();
            before = self.read_back(bus, PARAMETERS, &mut tries).await?.ok();
            if let Some(why) = self.trigger_refusal(bus).await? {
                return Ok(Saved::NotSent(why));
            }
        }
        // Frames received until now belong to an earlier one.
        while bus.take_save_result().is_some() {}
        self.saving.send(self.now(), frame);
        self.leave_line();
        let sent = self.trigger(bus, Trigger::Save).await;
        self.saving.written(match &sent {
            Ok(()) => Ack::Acknowledged,
            Err(BusError::Refused { reason }) => Ack::Refused { reason: *reason },
            Err(_) => Ack::Unanswered,
        });
        // A hand may be mute while it writes its flash; that does not count as silence.
        if let Err(BusError::Lost(error)) = sent {
            return Err(WireEnd::Lost(error.into()));
        }
        let mut tries = Tries::new();
        loop {
            self.give_way(bus).await?;
            while let Some(result) = bus.take_save_result() {
                self.saving.result(result);
            }
            match self.saving.next(self.now()) {
                Next::Done(saved) => return Ok(saved),
                Next::Listen { until } => self.listen(bus, until).await?,
                Next::ReadBack => {
                    let after = self.read_back(bus, PARAMETERS, &mut tries).await?.ok();
                    self.saving.read_back(after.is_some() && after == before);
                }
            }
        }
    }

    async fn reset_parameters(&mut self, bus: &mut dyn Bus) -> Result<Reset, WireEnd> {
        if let Some(why) = self.trigger_refusal(bus).await? {
            return Ok(Reset::NotSent(why));
        }
        match self.trigger(bus, Trigger::ResetParameters).await {
            Ok(()) => Ok(Reset::Acknowledged),
            Err(BusError::Refused { reason }) => Ok(Reset::Refused { reason }),
            Err(BusError::Lost(error)) => Err(WireEnd::Lost(error.into())),
            Err(_) => Ok(Reset::Unanswered),
        }
    }

    /// Sends the calibration once, then reserves the line for the hand until its end frame comes or the time is over.
    async fn calibrate_forces(&mut self, bus: &mut dyn Bus) -> Result<Calibrated, WireEnd> {
        if let Some(why) = self.trigger_refusal(bus).await? {
            return Ok(Calibrated::NotSent(why));
        }
        // Frames received until now belong to an earlier one.
        let _earlier = bus.take_calibration_end();
        let over = self.now().plus(CALIBRATION_TAKES);
        self.leave_line();
        let is_acknowledged = match self.trigger(bus, Trigger::CalibrateForce).await {
            Ok(()) => true,
            Err(BusError::Refused { reason }) => return Ok(Calibrated::Refused { reason }),
            Err(BusError::Lost(error)) => return Err(WireEnd::Lost(error.into())),
            // A hand may be mute while it measures; that does not count as silence.
            Err(_) => false,
        };
        loop {
            self.give_way(bus).await?;
            if bus.take_calibration_end() {
                return Ok(Calibrated::Finished);
            }
            if self.now() >= over {
                let why = SaveDoubt::Unanswered;
                return Ok(if is_acknowledged {
                    Calibrated::Quiet
                } else {
                    Calibrated::Unknown { why }
                });
            }
            self.listen(bus, over).await?;
        }
    }

    /// Reserves the line for a hand that saves or calibrates.
    fn leave_line(&mut self) {
        self.leaves_line = true;
        self.publish_rest();
    }

    async fn trigger(&mut self, bus: &mut dyn Bus, what: Trigger) -> Result<(), BusError> {
        self.write(bus, &what.write(), WriteCause::Setting).await
    }

    /// Listens without sending a request; ends early for a control request.
    async fn listen(&mut self, bus: &mut dyn Bus, until: Moment) -> Result<(), WireEnd> {
        let now = self.now();
        let until = until.min(now.plus(LISTEN_DURATION));
        // An unconfirmed stop continues meanwhile.
        let until = self
            .motion
            .next_send(now)
            .map_or(until, |hold| until.min(hold));
        let mut wanted = self.ends.wanted.subscribe();
        let over = sleep_until(self.config.clock.instant(until));
        tokio::select! {
            biased;
            _ = wanted.wait_for(PendingControl::is_any) => Ok(()),
            result = bus.listen() => unless_lost(result),
            () = over => Ok(()),
        }
    }

    /// Reads a group in a shape that no late reply can answer.
    async fn read_back(
        &mut self,
        bus: &mut dyn Bus,
        span: Span,
        tries: &mut Tries,
    ) -> Result<Result<Vec<u8>, Doubt>, WireEnd> {
        while tries.reads > 0 {
            self.give_way(bus).await?;
            // The same bytes and a few more: each length is a distinct read.
            let shapes = [0, 2, 4, 6].map(|more| Span::new(span.address, span.len + more));
            let Some(shape) = bus.choose(&shapes) else {
                if tries.clearings == 0 {
                    return Ok(Err(Doubt::Ambiguous));
                }
                tries.clearings -= 1;
                self.poll_motion(bus).await?;
                continue;
            };
            let limit = self.reply_limit(bus, shape.len);
            let asked = self.now();
            let wanted = Arc::clone(&self.ends.wanted);
            let read = bus
                .read_unless(shape, limit, &|| wanted.borrow().stop)
                .await;
            match read {
                // A stop was requested meanwhile.
                Ok(None) => {}
                Ok(Some(bytes)) => {
                    tries.reads -= 1;
                    self.answered(self.now().since(asked));
                    let bytes = shape.slice(&bytes, span).map(<[u8]>::to_vec);
                    return Ok(bytes.ok_or(Doubt::NotReadBack));
                }
                Err(error) => {
                    tries.reads -= 1;
                    self.failed(bus, &error).await?;
                }
            }
        }
        Ok(Err(Doubt::NotReadBack))
    }

    /// True if the result of a SAVE could answer a read of this range.
    pub(crate) fn looks_like_save(&self, span: Span) -> bool {
        span == SAVE.span() && self.saving.is_claimed(self.now())
    }
}
