//! What besides the window may move a hand, and who reads it: streams, gamepads, the gateway. Each is opened by a person, and
//! belongs to one connection with one hand.

mod work;

use crate::app::running::Running;
use crate::inputs::follow::FollowLimits;
use crate::inputs::pad::PadMap;
use crate::inputs::pad::source::{PadSource, PadView};
use crate::inputs::stream::{StreamPlace, StreamSource, StreamView};
use crate::link::Owner;
use crate::share::gateway::{ClientId, Gateway, GatewayClient};
use crate::tasks::follow::{FollowEnd, FollowTerms, FollowView};
use std::net::SocketAddr;
use tokio::sync::watch;

/// What a person asks of inputs and of the gateway.
#[derive(Debug, Clone, PartialEq)]
pub enum InputAction {
    /// Listen for lines here, or no more.
    Listen(Option<StreamPlace>),
    /// Read the gamepad, or no more.
    ReadPad(bool),
    /// Let clients use the hand at this address, or no more.
    Share(Option<SocketAddr>),
    /// Let whoever sends lines move the hand.
    GrantStream,
    /// Let the gamepad move the hand.
    GrantPad,
    /// Let a client of the gateway move the hand.
    GrantClient(ClientId),
    /// Whoever moves the hand from outside may no more; it is stopped.
    TakeBack,
    /// How far and how fast a hand follows.
    Limit(FollowLimits),
    /// What the gamepad's controls do.
    Map(PadMap),
}

/// The inputs and the gateway of one connection. Dropped with it, they are closed.
#[derive(Debug, Default)]
pub struct HandInputs {
    pub(crate) stream: Option<StreamSource>,
    pub(crate) pad: Option<PadSource>,
    pub(crate) gateway: Option<Gateway>,
    /// Where lines are listened for.
    pub stream_at: Option<SocketAddr>,
    /// What came in.
    pub stream_view: StreamView,
    /// What is known of the gamepad, while it is read.
    pub pad_view: Option<PadView>,
    /// Where the gateway is, and who uses it.
    pub gateway_at: Option<SocketAddr>,
    /// Its clients.
    pub clients: Vec<GatewayClient>,
    /// Why the last thing that was to be opened was not.
    pub refused: Option<String>,
    /// What the hand follows.
    pub follow: Option<FollowRun>,
}

/// A hand that follows a source.
#[derive(Debug)]
pub struct FollowRun {
    /// Who moves the hand.
    pub owner: Owner,
    /// How it goes.
    pub view: Option<FollowView>,
    pub(crate) terms: watch::Sender<FollowTerms>,
    pub(crate) task: Running<FollowView, FollowEnd>,
}

impl HandInputs {
    /// True while something from outside is listened to or served: a badge says so.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.stream_at.is_some() || self.pad_view.is_some() || self.gateway_at.is_some()
    }
}
