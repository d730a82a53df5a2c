//! Inputs from outside the window that may move a hand, and readers of its state: streams, gamepads, the gateway. Each is opened by
//! the user, and belongs to one connection with one hand.

mod grant;
mod work;

use crate::app::env::running::Running;
use crate::app::slot::SlotId;
use crate::inputs::dds::source::DdsView;
use crate::inputs::mirror::{MirrorScale, MirrorView};
use crate::inputs::pad::source::PadView;
use crate::inputs::pad::{PadMap, PadTrouble};
use crate::inputs::stream::{StreamPlace, StreamView};
use crate::link::Owner;
use crate::motion::follow::step::FollowLimits;
use crate::motion::follow::{FollowTerms, FollowView};
use crate::motion::program::Ended;
use crate::motion::source::{Source, SourceKind};
use crate::share::dds::DdsCounts;
use crate::share::fleet::FleetCard;
use crate::share::foxglove::FoxgloveServer;
use crate::share::gateway::{ClientId, Gateway, GatewayClient};
use crate::system::SystemError;
use crate::transport::dds::DdsError;
use std::collections::BTreeMap;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use tokio::sync::watch;

/// User actions on inputs and the gateway.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum InputAction {
    /// Listen for lines here; `None` stops listening.
    Listen(Option<StreamPlace>),
    /// Start or stop reading the gamepad.
    ReadPad(bool),
    /// Share the hand with clients at this address; `None` stops sharing.
    Share(Option<SocketAddr>),
    /// Show the hand to viewers at this address; `None` stops that.
    Show(Option<SocketAddr>),
    /// Publish the hand on DDS and receive commands there, on this interface; `None` leaves DDS.
    JoinDds(Option<String>),
    /// Watch the hand of this slot, to follow it at this scale; `None` stops watching. Only reads that hand.
    Mirror(Option<(SlotId, MirrorScale)>),
    /// Grant control to this source.
    Grant(SourceKind),
    /// Grant control to a client of the gateway.
    GrantClient(ClientId),
    /// End the control of the party outside this window; the hand is stopped.
    TakeBack,
    /// Set lead and rate of following.
    Limit(FollowLimits),
    /// Assign functions to the gamepad's controls.
    Map(PadMap),
}

/// Inputs and outlets that the user can open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputKind {
    Source(SourceKind),
    Gateway,
    Viewers,
}

/// Reason why an input or outlet was not opened.
#[derive(Debug)]
pub enum InputError {
    /// The system's error.
    System(SystemError),
    /// Gamepads cannot be read.
    Pad(PadTrouble),
    /// DDS failed to start.
    Dds(DdsError),
}

impl From<io::Error> for InputError {
    fn from(error: io::Error) -> Self {
        Self::System(error.into())
    }
}

impl From<PadTrouble> for InputError {
    fn from(trouble: PadTrouble) -> Self {
        Self::Pad(trouble)
    }
}

impl From<DdsError> for InputError {
    fn from(error: DdsError) -> Self {
        Self::Dds(error)
    }
}

/// The inputs and the gateway of one connection. Dropping it closes them.
#[derive(Debug, Default)]
pub struct HandInputs {
    /// Open sources, at most one of each kind.
    sources: BTreeMap<SourceKind, Source>,
    pub(crate) gateway: Option<Gateway>,
    pub(crate) foxglove: Option<FoxgloveServer>,
    /// The watched hand.
    pub mirror: Option<HandMirror>,
    /// Address at which lines are received.
    pub stream_at: Option<SocketAddr>,
    /// State of the stream.
    pub stream_view: StreamView,
    /// State of the gamepad, while it is read.
    pub pad_view: Option<PadView>,
    /// Address of the gateway; `None` while it is closed.
    pub gateway_at: Option<SocketAddr>,
    pub clients: Vec<GatewayClient>,
    /// Address at which viewers are served, and their number.
    pub foxglove_at: Option<(SocketAddr, usize)>,
    /// State of DDS, while it is joined.
    pub dds_view: Option<DdsState>,
    /// The last failed opening, with its reason.
    pub refused: Option<(InputKind, InputError)>,
}

/// State of DDS.
#[derive(Debug, Clone, PartialEq)]
pub struct DdsState {
    /// Address of its interface.
    pub at: Ipv4Addr,
    pub told: DdsCounts,
    /// State of its source.
    pub view: DdsView,
    /// Another hand that follows the same sender.
    pub other: Option<FleetCard>,
}

/// Another hand of this window that is watched. Closed with its link.
#[derive(Debug)]
pub struct HandMirror {
    pub leader: SlotId,
    /// Scale of its bends for following.
    pub scale: MirrorScale,
    /// Newest state of the watched hand.
    pub view: MirrorView,
}

/// A hand that follows a source.
#[derive(Debug)]
pub struct FollowRun {
    /// Party that moves the hand.
    pub owner: Owner,
    /// Newest state of following; `None` before the first report.
    pub view: Option<FollowView>,
    pub(crate) terms: watch::Sender<FollowTerms>,
    pub(crate) task: Running<FollowView, FollowOutcome>,
}

/// Result of following.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FollowOutcome {
    pub(crate) end: Ended<()>,
    /// The leading hand was stopped, too.
    pub(crate) leader_stopped: bool,
}

impl HandInputs {
    /// Updates the state of all inputs and outlets.
    pub(crate) fn refresh(&mut self) {
        (self.stream_at, self.pad_view, self.dds_view) = (None, None, None);
        self.stream_view = StreamView::default();
        self.sources.retain(|_, source| !source.is_over());
        for source in self.sources.values() {
            match source {
                Source::Stream(source) => {
                    self.stream_at = Some(source.local());
                    self.stream_view = source.view();
                }
                Source::Pad(source) => self.pad_view = Some(source.view()),
                Source::Dds(joined) => {
                    self.dds_view = Some(DdsState {
                        at: joined.shared.node.address(),
                        told: joined.shared.counts(),
                        view: joined.source.view(),
                        other: source.other_follower(),
                    });
                }
                Source::Mirror(source, _) => {
                    if let Some(mirror) = &mut self.mirror {
                        mirror.view = source.view();
                    }
                }
            }
        }
        if !self.sources.contains_key(&SourceKind::Mirror) {
            self.mirror = None;
        }
        self.gateway_at = self.gateway.as_ref().map(Gateway::address);
        let clients = self.gateway.as_ref().map(Gateway::clients);
        self.clients = clients.unwrap_or_default();
        let viewed = |server: &FoxgloveServer| (server.address(), server.viewers().len());
        self.foxglove_at = self.foxglove.as_ref().map(viewed);
    }

    /// The open source of this kind.
    pub(crate) fn source(&self, kind: SourceKind) -> Option<&Source> {
        self.sources.get(&kind)
    }

    /// True while an input or outlet is open; a badge shows that.
    pub const fn is_open(&self) -> bool {
        let is_served = self.gateway_at.is_some() || self.foxglove_at.is_some();
        is_served || self.stream_at.is_some() || self.pad_view.is_some() || self.dds_view.is_some()
    }
}
