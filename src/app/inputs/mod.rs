//! What besides the window may move a hand, and who reads it: streams, gamepads, the gateway. Each is opened by the user, and
//! belongs to one connection with one hand.

mod grant;
mod work;

use crate::app::env::running::Running;
use crate::app::slot::SlotId;
use crate::inputs::dds::source::{DdsSource, DdsView};
use crate::inputs::follow::FollowLimits;
use crate::inputs::mirror::{MirrorScale, MirrorSource, MirrorView};
use crate::inputs::pad::source::{PadSource, PadView};
use crate::inputs::pad::{PadMap, PadTrouble};
use crate::inputs::stream::{StreamPlace, StreamSource, StreamView};
use crate::link::{LinkHandle, LinkStopper, Owner};
use crate::motion::follow::{FollowEnd, FollowTerms, FollowView};
use crate::motion::program::Ended;
use crate::share::dds::{DdsCounts, SharedOnDds};
use crate::share::fleet::{FleetCard, OtherFollowers};
use crate::share::foxglove::FoxgloveServer;
use crate::share::gateway::{ClientId, Gateway, GatewayClient};
use crate::system::SystemError;
use crate::transport::dds::DdsError;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use tokio::sync::watch;

/// What the user asks of inputs and of the gateway.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum InputAction {
    /// Listen for lines here, or no more.
    Listen(Option<StreamPlace>),
    /// Read the gamepad, or no more.
    ReadPad(bool),
    /// Let clients use the hand at this address, or no more.
    Share(Option<SocketAddr>),
    /// Show the hand to viewers at this address, or no more.
    Show(Option<SocketAddr>),
    /// Tell the hand on DDS and listen to programs there, at this interface, or no more.
    JoinDds(Option<String>),
    /// Watch the hand of this slot, of which this share would be followed, or none any more. Only reads it.
    Mirror(Option<(SlotId, MirrorScale)>),
    /// Let this source move the hand.
    Grant(InputSource),
    /// Let a client of the gateway move the hand.
    GrantClient(ClientId),
    /// Whoever moves the hand from outside may no more; it is stopped.
    TakeBack,
    /// How far and how fast a hand follows.
    Limit(FollowLimits),
    /// What the gamepad's controls do.
    Map(PadMap),
}

/// A source that the user may let move the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputSource {
    /// Whoever sends lines.
    Stream,
    /// The program that sends over DDS.
    Dds,
    Pad,
    /// Another hand of this window.
    Mirror,
}

/// What can be opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputKind {
    /// Lines of another program.
    Stream,
    /// The gamepad.
    Pad,
    Gateway,
    Viewers,
    Dds,
}

/// Why something was not opened.
#[derive(Debug)]
pub enum OpenRefusal {
    /// The system's error.
    System(SystemError),
    /// Gamepads are not read.
    Pad(PadTrouble),
    /// DDS does not come up.
    Dds(DdsError),
}

impl From<io::Error> for OpenRefusal {
    fn from(error: io::Error) -> Self {
        Self::System(error.into())
    }
}

/// The inputs and the gateway of one connection. Dropped with it, they are closed.
#[derive(Debug, Default)]
pub struct HandInputs {
    pub(crate) stream: Option<StreamSource>,
    pub(crate) pad: Option<PadSource>,
    pub(crate) gateway: Option<Gateway>,
    pub(crate) foxglove: Option<FoxgloveServer>,
    pub(crate) dds: Option<JoinedDds>,
    /// The other hand that is watched.
    pub mirror: Option<HandMirror>,
    /// Where lines are listened for.
    pub stream_at: Option<SocketAddr>,
    /// What came in.
    pub stream_view: StreamView,
    /// What is known of the gamepad, while it is read.
    pub pad_view: Option<PadView>,
    /// Where the gateway is, and who uses it.
    pub gateway_at: Option<SocketAddr>,
    pub clients: Vec<GatewayClient>,
    /// Where viewers are served, and how many there are.
    pub foxglove_at: Option<(SocketAddr, usize)>,
    /// What is known of DDS, while it is joined.
    pub dds_view: Option<DdsState>,
    /// What was to be opened last and was not, and why.
    pub refused: Option<(InputKind, OpenRefusal)>,
}

#[derive(Debug)]
pub(crate) struct JoinedDds {
    pub(crate) shared: SharedOnDds,
    pub(crate) others: OtherFollowers,
    pub(crate) source: DdsSource,
}

/// What is known of DDS.
#[derive(Debug, Clone, PartialEq)]
pub struct DdsState {
    /// The address of its interface.
    pub at: Ipv4Addr,
    pub told: DdsCounts,
    /// What came in.
    pub view: DdsView,
    /// Another hand that follows the same sender.
    pub other: Option<FleetCard>,
}

/// A hand that follows a source.
#[derive(Debug)]
pub struct FollowRun {
    /// Who moves the hand.
    pub owner: Owner,
    /// How it goes.
    pub view: Option<FollowView>,
    pub(crate) terms: watch::Sender<FollowTerms>,
    pub(crate) task: Running<FollowView, FollowOutcome>,
}

/// How following ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FollowOutcome {
    pub(crate) end: Ended<FollowEnd>,
    /// The hand that led was told to stop, too.
    pub(crate) leader_stopped: bool,
}

impl HandInputs {
    /// Takes in what came and who is there.
    pub(crate) fn look(&mut self) {
        self.stream_at = self.stream.as_ref().map(StreamSource::local);
        let lines = self.stream.as_ref().map(StreamSource::view);
        self.stream_view = lines.unwrap_or_default();
        self.gateway_at = self.gateway.as_ref().map(Gateway::address);
        self.pad_view = self.pad.as_ref().map(PadSource::view);
        let clients = self.gateway.as_ref().map(Gateway::clients);
        self.clients = clients.unwrap_or_default();
        let viewed = |server: &FoxgloveServer| (server.address(), server.viewers().len());
        self.foxglove_at = self.foxglove.as_ref().map(viewed);
        self.mirror.take_if(|mirror| mirror.is_over());
        if let Some(mirror) = &mut self.mirror {
            mirror.look();
        }
        self.dds_view = self.dds.as_ref().map(|joined| DdsState {
            at: joined.shared.node.address(),
            told: joined.shared.counts(),
            view: joined.source.view(),
            other: joined.others.now(),
        });
    }

    /// Whether another hand obeys the same sender on DDS.
    pub(crate) fn other_follows_dds(&self) -> bool {
        let mut joined = self.dds.iter();
        joined.any(|joined| joined.others.now().is_some())
    }

    /// True while something from outside is listened to or served: a badge says so.
    pub const fn is_open(&self) -> bool {
        let is_served = self.gateway_at.is_some() || self.foxglove_at.is_some();
        is_served || self.stream_at.is_some() || self.pad_view.is_some() || self.dds_view.is_some()
    }
}

/// Another hand of this window that is watched. Closed with its link.
#[derive(Debug)]
pub struct HandMirror {
    pub leader: SlotId,
    /// Which share of its bends would be followed.
    pub scale: MirrorScale,
    /// What is known of it.
    pub view: MirrorView,
    pub(crate) source: MirrorSource,
    pub(crate) stopper: LinkStopper,
}

impl HandMirror {
    /// Watches from now on. Must be called within a tokio runtime.
    pub(crate) fn open(leader: SlotId, link: &LinkHandle, scale: MirrorScale) -> Self {
        Self {
            leader,
            scale,
            view: MirrorView::default(),
            source: MirrorSource::open(link.records(), scale),
            stopper: link.stopper(),
        }
    }

    pub(crate) fn look(&mut self) {
        self.view = self.source.view();
    }

    /// True once its link was closed.
    pub(crate) fn is_over(&self) -> bool {
        self.source.is_over()
    }
}
