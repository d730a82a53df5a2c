//! Lengths of the plots in points: axes, captions, cursors, names of lines. No colours, no fonts.

/// Height of a row of the table.
pub(crate) const CURSOR_ROW: f32 = 15.0;
/// Height of the table's own line.
pub(crate) const CURSOR_HEAD: f32 = 22.0;
/// Width of a cursor's flag.
pub(crate) const CURSOR_FLAG: f32 = 16.0;
/// Room right of the plots.
pub(crate) const PLOT_ENDS: f32 = 32.0;
/// From the plot to the name.
pub(crate) const END_LEAD: f32 = 5.0;
/// Where names come closer than their height, every other one stands aside by this.
pub(crate) const END_ASIDE: f32 = 10.0;
/// Lines that end this near to each other end together.
pub(crate) const END_TOGETHER: f32 = 5.0;
/// Height of a name; in less room they come closer.
pub(crate) const END_NAME: f32 = 11.0;
/// Height of a row of the legend.
pub(crate) const PLOT_NAMES_ROW: f32 = 20.0;
/// Free room beside the title below which the switches are drawn short.
pub(crate) const PLOT_HEAD_NARROW: f32 = 440.0;
/// Room that the row of windows needs; in less it becomes a list.
pub(crate) const PLOT_WINDOWS: f32 = 270.0;
/// Width of the menu.
pub(crate) const PLOT_MENU: f32 = 250.0;
/// Points of the wheel that halve or double what is shown.
pub(crate) const PLOT_WHEEL: f32 = 180.0;
/// A marked stretch that is narrower was not meant.
pub(crate) const PLOT_MARKED_LEAST: f32 = 6.0;
/// Room for the numbers of the vertical axis.
pub(crate) const PLOT_AXIS: f32 = 40.0;
/// Room for the numbers of the time axis.
pub(crate) const PLOT_TIME_AXIS: f32 = 20.0;
/// Room for a plot's title.
pub(crate) const PLOT_CAPTION: f32 = 18.0;
/// Height that a number on the vertical axis needs.
pub(crate) const PLOT_NUMBER: f32 = 22.0;
/// A plot less high than this says nothing: while figures are read, only the one they are of is shown then.
pub(crate) const PLOT_LEAST: f32 = 62.0;
/// Room for a plot's title.
pub(crate) const RECORDING_CAPTION: f32 = 17.0;
/// Height of one drive's lane, with its gap.
pub(crate) const RECORDING_LANE: f32 = 8.0;
/// A plot less high than this says nothing.
pub(crate) const RECORDING_LEAST: f32 = 46.0;
/// Room for a time on the time axis.
pub(crate) const RECORDING_TIME: f32 = 60.0;
