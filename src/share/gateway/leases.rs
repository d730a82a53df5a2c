//! Control of the hand by gateway clients, from the grant to its end, and their writes. Every end of control stops the hand,
//! whatever its cause: the hand must not continue to a target of a program that has gone.

use crate::hand::register::{ANGLE_ACT, FORCE_SET, Register, SPEED_SET};
use crate::hand::{Angle, Dof, Force, HandCommand, OutOfRange, PerDof, Speed};
use crate::link::{
    ArmRequest, Lease, LeaseRefusal, LinkHandle, Owner, RecentReads, Records, RequestError,
};
use crate::record::{ArmRefusal, Disarmed, LinkState, Record, WriteCause, WriteFate};
use crate::share::gateway::allowed;
use crate::share::gateway::clients::{
    ClientId, ClientLease, ClientTable, Holder, MoverChange, SharedClientTable,
};
use crate::share::gateway::refusal::WriteRefusal;
use std::time::Duration;
use tokio::time::{Instant, sleep_until, timeout};

/// The manual's "no action" (2.6.11).
const NO_ACTION: i16 = -1;
/// Distance from the present angles up to which targets are a stop, counts: the joints moved on after the client read them.
const STAY_TOLERANCE: u16 = 150;
/// Time for which a client that stopped the hand may repeat the stop, until it sees the hand at rest.
const STOP_REPEATS: Duration = Duration::from_secs(2);
/// Time within which a client is answered whether the hand accepted its stop, and the poll interval for that.
const STOP_TAKES: Duration = Duration::from_secs(1);
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Clients that can get control of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Writers {
    /// Only the client to which the user grants it.
    Granted,
    /// The first client that writes while no one has control, without a further grant.
    First,
}

/// Reason for acquiring control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LeaseClaim {
    Wrote,
    /// The user chose the client.
    Chosen,
}

/// Control of the hand, among the clients of one gateway.
#[derive(Debug, Clone)]
pub(crate) struct ClientLeases {
    pub(crate) link: LinkHandle,
    pub(crate) reads: RecentReads,
    pub(crate) table: SharedClientTable,
    writers: Writers,
    silence: Duration,
}

impl ClientLeases {
    pub(crate) fn new(link: LinkHandle, writers: Writers, silence: Duration) -> Self {
        Self {
            reads: RecentReads::of(&link),
            link,
            table: SharedClientTable::default(),
            writers,
            silence,
        }
    }

    /// Writes the command of a client that has control or can acquire it now. Completes once the hand acknowledged it.
    pub(crate) async fn write(
        &self,
        client: ClientId,
        command: HandCommand,
        request: &[u8],
    ) -> Result<(), WriteRefusal> {
        let lease = match self.lease(client) {
            ClientLease::Held(lease) => lease,
            // A fault has ended every lease, and no client can get one before it is cleared. Clearing gives no control.
            _ if command == HandCommand::ClearErrors && self.is_free() && self.is_shut() => {
                return Ok(self.link.write(command).await?);
            }
            // A client without control may stop the hand while another controller moves it.
            lease => match self.handle_stop(client, request).await {
                Some(done) => return done,
                None if lease == ClientLease::Never => {
                    self.acquire(client, LeaseClaim::Wrote).await?
                }
                None => return Err(WriteRefusal::Over),
            },
        };
        let turn = self
            .table
            .with(|table| table.turn(&command, Instant::now()));
        sleep_until(turn).await;
        let written = self.link.write_as(lease, command).await;
        let is_taken =
            |error: &RequestError| matches!(error, RequestError::NotOwner(LeaseRefusal::Taken(_)));
        if written.as_ref().is_err_and(|error| !is_taken(error)) {
            // A stop that did not reach the hand stays pending.
            let _sent = self.handle_stop(client, request).await;
        }
        Ok(written?)
    }

    /// Acquires control for this client, to which the user granted it.
    pub(crate) async fn granted(&self, client: ClientId) {
        if let Err(refusal) = self.acquire(client, LeaseClaim::Chosen).await {
            self.table
                .with(|table| table.row(client).map(|row| row.not_granted(refusal)));
        }
    }

    /// Ends the lease of a silent client, or one that the link has already ended.
    pub(crate) fn end_stale_lease(&self) {
        let Some(holder) = self.table.with(|table| table.holder()) else {
            return;
        };
        let is_silent = self.link.clock().now().since(holder.last_request) > self.silence;
        if is_silent || self.link.check(holder.lease).is_err() {
            self.end(holder, Disarmed::Silent);
        }
    }

    /// Ends a lease for this reason, which stops the hand, unless it ended earlier for another.
    fn end(&self, holder: Holder, why: Disarmed) {
        let end = self.end_lease(holder, why);
        self.table
            .with(|table| table.mover(holder.client, MoverChange::Ended(end)));
    }

    fn end_lease(&self, holder: Holder, why: Disarmed) -> LeaseRefusal {
        let end = match self.link.give_back(holder.lease, why) {
            Ok(()) => LeaseRefusal::Ended(why),
            Err(end) => end,
        };
        self.mark(holder.client, ClientLease::Ended(end));
        end
    }

    /// Removes a client and ends its lease.
    pub(crate) fn disconnect(&self, client: ClientId) {
        let holder = self.table.with(|table| table.holder());
        if let Some(holder) = holder.filter(|holder| holder.client == client) {
            let change = match self.end_lease(holder, Disarmed::Released) {
                LeaseRefusal::Ended(Disarmed::Released) => MoverChange::Left,
                other => MoverChange::Ended(other),
            };
            self.table.with(|table| table.mover(client, change));
        }
        self.table.with(|table| table.disconnect(client));
    }

    /// Ends the current lease; called when the gateway closes.
    pub(crate) fn close(&self) {
        if let Some(holder) = self.table.with(|table| table.holder()) {
            self.end(holder, Disarmed::Released);
        }
    }

    fn lease(&self, client: ClientId) -> ClientLease {
        let lease = self
            .table
            .with(|table| table.row(client).map(|row| *row.lease()));
        lease.unwrap_or(ClientLease::Never)
    }

    fn mark(&self, client: ClientId, lease: ClientLease) {
        self.table.with(|table| {
            if let Some(row) = table.row(client) {
                *row.lease() = lease;
            }
        });
    }

    /// True if a client may acquire control by writing.
    fn is_free(&self) -> bool {
        self.writers == Writers::First && self.link.status().holder.is_none()
    }

    /// Stops the hand if a request is a stop, even one that is invalid as a write; `None` if it is no stop. Without a live
    /// hand the stop stays pending, and the client gets an error.
    pub(crate) async fn handle_stop(
        &self,
        client: ClientId,
        request: &[u8],
    ) -> Option<Result<(), WriteRefusal>> {
        let angles = allowed::all_angles(request)?;
        let mut records = self.link.records();
        if !self.stops(client, &angles).await {
            return None;
        }
        let has_none = !self.link.status().state.is_live();
        let stop = self.stop_acknowledged(&mut records);
        Some(match timeout(STOP_TAKES, stop).await {
            _ if has_none => Err(RequestError::NotConnected.into()),
            Ok(true) => Ok(()),
            Ok(false) | Err(_) => Err(RequestError::LinkLost.into()),
        })
    }

    /// Returns true once the hand acknowledged the hold command, or once it may no longer move; false if the link is lost.
    async fn stop_acknowledged(&self, records: &mut Records) -> bool {
        let mut sent = None;
        loop {
            let status = self.link.status();
            if !status.state.is_live() {
                return false;
            }
            if !status.may_move {
                return true;
            }
            match timeout(POLL_INTERVAL, records.next()).await {
                Ok(Some(Record::Sent {
                    cause: WriteCause::Hold,
                    number,
                    ..
                })) => sent = Some(number),
                Ok(Some(Record::Answered { number, fate, .. })) if sent == Some(number) => {
                    if fate == WriteFate::Acknowledged {
                        return true;
                    }
                }
                Ok(None) => return false,
                Ok(Some(_)) | Err(_) => {}
            }
        }
    }

    /// Stops the hand if the targets are a stop of a client's motion, or its repetition: some joints stay about where they are,
    /// and none moves elsewhere. Returns true if so.
    async fn stops(&self, client: ClientId, targets: &PerDof<i16>) -> bool {
        let now = Instant::now();
        let stopped = |table: &mut ClientTable| table.row(client).and_then(|row| row.stopped);
        let stopped = self.table.with(stopped);
        let status = self.link.status();
        let may_stop = status.may_continue()
            || status.state == LinkState::Holding
            || stopped.is_some_and(|at| now.duration_since(at) < STOP_REPEATS);
        let is_own = match self.lease(client) {
            ClientLease::Held(_) => true,
            ClientLease::Ended(LeaseRefusal::Ended(why)) => {
                matches!(why, Disarmed::LinkLost | Disarmed::Resume)
            }
            ClientLease::Never | ClientLease::Ended(_) => false,
        };
        if !is_own && self.writers != Writers::First || !may_stop {
            return false;
        }
        let stops = self.pose().await.is_some_and(|pose| stays(targets, &pose));
        if stops {
            if self.link.status().may_continue() {
                self.link.stop();
            }
            self.table
                .with(|table| table.row(client).map(|row| row.stopped = Some(now)));
        }
        stops
    }

    /// Last read angles: a client stops a hand that falls silent at the angles that it saw.
    async fn pose(&self) -> Option<PerDof<i16>> {
        match self.reads.newest(ANGLE_ACT.span()) {
            Some(bytes) => values(&bytes, Ok::<i16, OutOfRange>).ok(),
            None => self.values(&ANGLE_ACT, Ok::<i16, OutOfRange>).await.ok(),
        }
    }

    /// True if no client can get control now: a drive reports a fault, or the hold that it caused is in progress.
    fn is_shut(&self) -> bool {
        matches!(
            self.link.status().state,
            LinkState::Fault | LinkState::Holding
        )
    }

    async fn acquire(&self, client: ClientId, claim: LeaseClaim) -> Result<Lease, WriteRefusal> {
        if claim == LeaseClaim::Wrote && self.writers != Writers::First {
            return Err(WriteRefusal::NotGranted);
        }
        let begun = self.table.with(|table| table.begin_taking(client));
        let owner = Owner::Gateway(begun.ok_or(WriteRefusal::Taken)?);
        let taken = self.arm(client, owner, claim).await;
        self.table.with(|table| table.end_taking());
        taken
    }

    /// Arms the hand with its present speeds and forces, and grants it.
    async fn arm(
        &self,
        client: ClientId,
        owner: Owner,
        claim: LeaseClaim,
    ) -> Result<Lease, WriteRefusal> {
        let refused = match self.link.status().state {
            LinkState::Offline | LinkState::Identifying => Some(ArmRefusal::Offline),
            LinkState::Holding => Some(ArmRefusal::Holding),
            LinkState::Fault => Some(ArmRefusal::Fault),
            // Armed without a holder: a stop is on its way.
            LinkState::Armed if self.link.status().holder.is_none() => Some(ArmRefusal::Holding),
            LinkState::Monitoring | LinkState::Armed => None,
        };
        if let Some(reason) = refused {
            return Err(WriteRefusal::NotArmed(reason));
        }
        let request = self.limits().await?;
        if claim == LeaseClaim::Wrote && !self.is_free() {
            return Err(WriteRefusal::Taken);
        }
        // The client that had control loses it.
        if let Some(before) = self.table.with(|table| table.holder()) {
            let taken = LeaseRefusal::Taken(owner);
            self.mark(before.client, ClientLease::Ended(taken));
            self.table
                .with(|table| table.mover(before.client, MoverChange::Ended(taken)));
        }
        let lease = self.link.grant(owner);
        self.mark(client, ClientLease::Held(lease));
        let armed = match self.link.arm(lease, request) {
            Ok(arming) => arming.await,
            Err(_ended) => Err(ArmRefusal::Offline),
        };
        if let Err(reason) = armed {
            // Nothing was moved, so there is nothing to stop.
            if self.link.check(lease).is_ok() {
                self.link.disarm();
            }
            self.mark(client, ClientLease::Never);
            return Err(WriteRefusal::NotArmed(reason));
        }
        self.table
            .with(|table| table.mover(client, MoverChange::Began));
        Ok(lease)
    }

    async fn limits(&self) -> Result<ArmRequest, WriteRefusal> {
        Ok(ArmRequest {
            speed: self.values(&SPEED_SET, Speed::new).await?,
            force: self.values(&FORCE_SET, Force::new).await?,
        })
    }

    async fn values<T>(
        &self,
        register: &Register,
        check: fn(i16) -> Result<T, OutOfRange>,
    ) -> Result<PerDof<T>, WriteRefusal> {
        values(&self.reads.read(register.span()).await?, check)
    }
}

/// Decodes and checks the values of six joints.
fn values<T>(
    bytes: &[u8],
    check: fn(i16) -> Result<T, OutOfRange>,
) -> Result<PerDof<T>, WriteRefusal> {
    let (pairs, _) = bytes.as_chunks::<2>();
    let values = pairs.iter().map(|pair| check(i16::from_le_bytes(*pair)));
    let values: Result<Vec<T>, OutOfRange> = values.collect();
    let values = values.map_err(|_range| WriteRefusal::Limits)?;
    let values: [T; 6] = values.try_into().map_err(|_few| WriteRefusal::Limits)?;
    Ok(PerDof::new(values))
}

/// True if targets keep some joint about where it is and send none elsewhere. Values that are no targets are ignored.
fn stays(targets: &PerDof<i16>, angles: &PerDof<i16>) -> bool {
    let is_near = |dof: Dof, to: i16| to.abs_diff(angles[dof]) <= STAY_TOLERANCE;
    let goes = |dof: Dof, to: i16| Angle::new(to).is_ok() && !is_near(dof, to);
    let mut all = targets.iter();
    all.any(|(dof, to)| *to != NO_ACTION && is_near(dof, *to))
        && !targets.iter().any(|(dof, to)| goes(dof, *to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_keeps_joints_where_they_are_and_sends_none_elsewhere() {
        let at = PerDof::new([1003, 998, -3, 700, 400, 0]);
        for (targets, stops) in [
            ([1003, 998, -3, 700, 400, 0], true),
            ([1003, 998, -3, 840, 260, 150], true),
            ([-1, -1, -1, 700, -1, -1], true),
            // What is no target at all.
            ([1003, 998, -3, 700, 400, i16::MAX], true),
            ([i16::MIN, 998, 2000, 700, 400, 0], true),
            ([1003, 998, -3, 851, 400, 0], false),
            ([1000, 1000, 0, 700, 400, 151], false),
            ([-1; 6], false),
            ([0; 6], false),
            ([i16::MAX; 6], false),
        ] {
            assert_eq!(stays(&PerDof::new(targets), &at), stops, "{targets:?}");
        }
    }
}
