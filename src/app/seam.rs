//! What the program needs of a link, so that its rules can be proven without a wire.

use crate::link::{
    ArmRequest, LinkEvent, LinkHandle, LinkStats, LinkStatus, PollRates, Request, RequestError,
    Setpoints, Ticket, WireTap,
};

/// One open link. Dropping it closes it.
pub(crate) trait Link: Send {
    /// Where it stands.
    fn status(&self) -> LinkStatus;
    /// What it measured of itself.
    fn stats(&self) -> LinkStats;
    /// Holds before anything else.
    fn stop(&self);
    /// Asks to arm.
    fn arm(&self, request: ArmRequest);
    /// Lets no setpoint pass any more.
    fn disarm(&self);
    /// Sets targets and limits.
    fn set(&self, setpoints: &Setpoints);
    /// Reads at other rates.
    fn read_at(&self, rates: PollRates);
    /// Asks for one thing.
    fn ask(&self, request: Request) -> Result<Ticket, RequestError>;
    /// The next event, if one waits.
    fn try_event(&mut self) -> Option<LinkEvent>;
    /// What goes over its wire.
    fn tap(&self) -> WireTap;
}

impl Link for LinkHandle {
    fn status(&self) -> LinkStatus {
        Self::status(self)
    }

    fn stats(&self) -> LinkStats {
        Self::stats(self)
    }

    fn stop(&self) {
        Self::stop(self);
    }

    fn arm(&self, request: ArmRequest) {
        Self::arm(self, request);
    }

    fn disarm(&self) {
        Self::disarm(self);
    }

    fn set(&self, setpoints: &Setpoints) {
        Self::set(self, setpoints);
    }

    fn read_at(&self, rates: PollRates) {
        Self::read_at(self, rates);
    }

    fn ask(&self, request: Request) -> Result<Ticket, RequestError> {
        Self::ask(self, request)
    }

    fn try_event(&mut self) -> Option<LinkEvent> {
        Self::try_event(self)
    }

    fn tap(&self) -> WireTap {
        Self::tap(self)
    }
}
