//! Lengths of the plots in points: axes, captions, cursors, names of lines. No colours, no fonts.

/// Width of a cursor's flag.
pub(crate) const CURSOR_FLAG: f32 = 16.0;
/// Height of a row of the legend.
pub(crate) const PLOT_NAMES_ROW: f32 = 20.0;
/// Free room beside the title below which the switches are drawn short.
pub(crate) const PLOT_HEAD_NARROW: f32 = 440.0;
/// Width of the menu.
pub(crate) const PLOT_MENU: f32 = 250.0;
/// Points of the wheel that halve or double what is shown.
pub(crate) const PLOT_WHEEL: f32 = 180.0;
/// Room for the numbers of the vertical axis.
pub(crate) const PLOT_AXIS: f32 = 46.0;
/// Room for the numbers of the time axis.
pub(crate) const PLOT_TIME_AXIS: f32 = 20.0;
/// Room for a plot's title.
pub(crate) const PLOT_CAPTION: f32 = 18.0;
/// Height that a number on the vertical axis needs.
pub(crate) const PLOT_NUMBER: f32 = 22.0;
/// A plot less high than this says nothing: while figures are read, only the one they are of is shown then.
pub(crate) const PLOT_LEAST: f32 = 62.0;
/// Height of one drive's lane, with its gap.
pub(crate) const RECORDING_LANE: f32 = 8.0;
/// A plot less high than this says nothing.
pub(crate) const RECORDING_LEAST: f32 = 46.0;
/// Width of the names in the cursors' table.
pub(crate) const CURSOR_NAMES: f32 = 84.0;
/// Width of the choice of the time that is shown.
pub(crate) const PLOT_WINDOW: f32 = 68.0;
/// How strong the curves behind the chosen one are.
pub(crate) const CURVE_BEHIND: f32 = 0.3;
/// A line this near to the pointer is the one that is meant.
pub(crate) const LINE_NEAR: f32 = 9.0;
/// Width of the sign of a line in the legend.
pub(crate) const KEY_SIGN: f32 = 20.0;
