//! Another hand of this window that is watched, so that this one can follow it.

use crate::app::slot::SlotId;
use crate::inputs::mirror::{MirrorScale, MirrorSource, MirrorView};
use crate::link::{LinkHandle, LinkStopper};

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
