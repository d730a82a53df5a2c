//! What the plots need between frames.

use crate::app::settings::PlotKind;
use crate::hand::PerDof;
use crate::ui::plots::cursors::Cursors;
use crate::ui::plots::lines::PlotLines;
use crate::ui::plots::range::Ranges;
use crate::ui::plots::reach::Reach;
use crate::ui::plots::sight::Sight;
use std::collections::BTreeMap;

/// What the plots need between frames.
#[derive(Debug, Default)]
pub(crate) struct PlotView {
    /// Joints whose curves are hidden.
    pub(crate) hidden: PerDof<bool>,
    /// Whether thresholds are shown.
    pub(crate) thresholds: bool,
    /// Which stretch of time is shown.
    pub(crate) sight: Sight,
    /// The two cursors.
    pub(crate) cursors: Cursors,
    /// Number of the plot whose figures are told.
    pub(crate) chosen: usize,
    /// True while the plots fill the view.
    pub(crate) large: bool,
    /// True if a note was asked for in this frame.
    pub(crate) note_asked: bool,
    /// Width and height of the card in points, for a picture of it.
    pub(crate) size: (u32, u32),
    /// Rows that were copied last, while the menu is open.
    pub(crate) copied: Option<usize>,
    /// The stretch that is being marked to zoom into.
    pub(crate) reach: Reach,
    /// The scales that a person chose.
    pub(crate) ranges: Ranges,
    /// The lines of each plot.
    pub(crate) lines: BTreeMap<PlotKind, PlotLines>,
}
