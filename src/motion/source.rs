//! Sources outside the window and the command line that a hand can follow: opened by the user, read from then on, and followed once
//! the user grants them control.

use crate::hand::Moment;
use crate::inputs::Offer;
use crate::inputs::dds::source::{DdsCommands, DdsSource};
use crate::inputs::mirror::{MirrorScale, MirrorSource};
use crate::inputs::offer::SourceSite;
use crate::inputs::pad::source::PadSource;
use crate::inputs::stream::StreamSource;
use crate::link::{ArmRequest, LinkHandle, LinkStopper, Owner};
use crate::share::dds::SharedOnDds;
use crate::share::fleet::{FleetCard, OtherFollowers};
use crate::transport::dds::DdsNode;
use tokio::sync::mpsc;

/// Kind of a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SourceKind {
    /// A program that sends lines.
    Stream,
    /// A program that sends over DDS.
    Dds,
    /// A gamepad of this computer.
    Pad,
    /// Another hand.
    Mirror,
}

impl SourceKind {
    /// True if a source of this kind is this owner.
    pub const fn is(self, owner: Owner) -> bool {
        match self {
            Self::Stream => matches!(owner, Owner::Stream(_)),
            Self::Dds => matches!(owner, Owner::Dds),
            Self::Pad => matches!(owner, Owner::Gamepad),
            Self::Mirror => matches!(owner, Owner::Mirror),
        }
    }
}

/// An open source, until dropped.
#[derive(Debug)]
pub enum Source {
    /// Lines of programs.
    Stream(StreamSource),
    /// Programs on DDS.
    Dds(JoinedDds),
    /// A gamepad.
    Pad(PadSource),
    /// Another hand, and the means to stop it.
    Mirror(MirrorSource, LinkStopper),
}

impl Source {
    /// Watches another hand, which is only read; does not keep its link open. Must be called within a tokio runtime.
    pub fn mirror(leader: &LinkHandle, scale: MirrorScale) -> Self {
        let source = MirrorSource::open(leader.records(), scale);
        Self::Mirror(source, leader.stopper())
    }

    /// Kind of this source.
    pub const fn kind(&self) -> SourceKind {
        match self {
            Self::Stream(_) => SourceKind::Stream,
            Self::Dds(_) => SourceKind::Dds,
            Self::Pad(_) => SourceKind::Pad,
            Self::Mirror(..) => SourceKind::Mirror,
        }
    }

    /// Owner as which it would control the hand at `now`; `None` while it is not present, or its data is old.
    pub fn owner(&self, now: Moment) -> Option<Owner> {
        match self {
            Self::Stream(source) => source.view().owner(now),
            Self::Dds(joined) => joined.source.view().owner(now),
            Self::Pad(source) => source.view().owner(),
            Self::Mirror(source, _) => source.view().owner(now),
        }
    }

    /// Receives its targets from now on; replaces the previous follower.
    pub fn follow(&self) -> mpsc::Receiver<Offer> {
        match self {
            Self::Stream(source) => source.follow(),
            Self::Dds(joined) => joined.source.follow(),
            Self::Pad(source) => source.follow(),
            Self::Mirror(source, _) => source.follow(),
        }
    }

    /// True once it has ended: the link of the leading hand was closed.
    pub fn is_over(&self) -> bool {
        match self {
            Self::Mirror(source, _) => source.is_over(),
            Self::Stream(_) | Self::Dds(_) | Self::Pad(_) => false,
        }
    }

    /// Another hand that follows the same sender, so that this one must not.
    pub fn other_follower(&self) -> Option<FleetCard> {
        match self {
            Self::Dds(joined) => joined.others.now(),
            Self::Stream(_) | Self::Pad(_) | Self::Mirror(..) => None,
        }
    }

    /// Waits for another hand that follows the same sender.
    pub async fn other_follower_appears(&self) -> FleetCard {
        match self {
            Self::Dds(joined) => joined.others.appears().await,
            Self::Stream(_) | Self::Pad(_) | Self::Mirror(..) => std::future::pending().await,
        }
    }

    /// The means to stop the leading hand, for a source that is another hand.
    pub fn leader(&self) -> Option<LinkStopper> {
        match self {
            Self::Mirror(_, stopper) => Some(stopper.clone()),
            Self::Stream(_) | Self::Dds(_) | Self::Pad(_) => None,
        }
    }
}

/// DDS, joined for one hand: commands in, states out.
#[derive(Debug)]
pub struct JoinedDds {
    /// Published states.
    pub shared: SharedOnDds,
    /// Received commands.
    pub source: DdsSource,
    others: OtherFollowers,
}

impl JoinedDds {
    /// Publishes a hand and receives commands for it, limited to `allowed`. `others` has listened on this node since it was opened.
    /// Must be called within a tokio runtime.
    pub fn open(
        (node, others): (DdsNode, OtherFollowers),
        card: FleetCard,
        allowed: ArmRequest,
        site: SourceSite,
        link: &LinkHandle,
    ) -> Self {
        let commands = DdsCommands::of(&node, card.side);
        Self {
            source: DdsSource::open(allowed, site, commands),
            shared: SharedOnDds::open(node, link, card),
            others,
        }
    }
}
