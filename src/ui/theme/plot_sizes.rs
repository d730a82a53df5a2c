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
/// Room above, below and beside a number of a value axis.
pub(crate) const AXIS_MARGIN: f32 = 6.0;
/// Height of a number of a value axis.
pub(crate) const AXIS_NUMBER: f32 = 12.0;
/// Room of a number of the time axis.
pub(crate) const AXIS_TIME: egui::Vec2 = egui::vec2(64.0, 14.0);
/// Where the middle of a cursor's flag is below the plots.
pub(crate) const CURSOR_FLAG_AT: f32 = 9.0;
/// Least and greatest width of the names in the cursors' table.
pub(crate) const CURSOR_NAMES: (f32, f32) = (44.0, 110.0);
/// Room between its columns.
pub(crate) const CURSOR_COLUMN_GAP: f32 = 3.0;
/// Width of the button of the plots' menu.
pub(crate) const PLOT_MENU_BUTTON: f32 = 26.0;
/// Width of the button of the cursors.
pub(crate) const PLOT_CURSOR_BUTTON: f32 = 34.0;
/// Width of a button with a word at the plots' head.
pub(crate) const PLOT_BUTTON: f32 = 64.0;
/// What the dashes add to the words beside them.
pub(crate) const LEGEND_DASHES: f32 = 26.0;
/// Room of a line's mark before its name.
pub(crate) const LEGEND_MARK: f32 = 20.0;
/// What mark and margin add to a name.
pub(crate) const LEGEND_NAME: f32 = 21.0;
/// Where the middle of a mark is.
pub(crate) const LEGEND_MARK_AT: f32 = 9.0;
/// A piece of a line before its name.
pub(crate) const LEGEND_LINE: egui::Vec2 = egui::vec2(10.0, 3.0);
/// Room that the words of an event keep from the edge.
pub(crate) const MARK_MARGIN: f32 = 6.0;
/// A field for the end of a value axis.
pub(crate) const RANGE_FIELD: egui::Vec2 = egui::vec2(96.0, 24.0);
/// What tells the reach of a marked time.
pub(crate) const REACH_NOTE: egui::Vec2 = egui::vec2(72.0, 16.0);
/// Where the sign of a lane begins, left of it.
pub(crate) const LANE_SIGN_AT: f32 = 10.0;
/// Width of the sign of a lane.
pub(crate) const LANE_SIGN: f32 = 6.0;
/// Width of the line that a recording is of.
pub(crate) const LINE_STRONG: f32 = 1.8;
/// Room that a plot's caption leaves to the words beside it.
pub(crate) const RECORDING_WORDS: f32 = 90.0;
/// Width of a button with an icon at the plots' head.
pub(crate) const PLOT_ICON_BUTTON: f32 = 28.0;
/// Width of the choice of the time that is shown, where there is no room for buttons.
pub(crate) const PLOT_WINDOW_CHOICE: f32 = 84.0;
/// Greatest width of one of its buttons.
pub(crate) const PLOT_WINDOW_BUTTON: f32 = 52.0;
/// Below this width its words are short.
pub(crate) const PLOT_WINDOW_SHORT: f32 = 46.0;
/// Where the name of a line begins.
pub(crate) const LEGEND_WORDS: f32 = 17.0;
/// From where to where the dashes of a threshold go.
pub(crate) const LEGEND_DASH: [(f32, f32); 2] = [(4.0, 8.0), (11.0, 15.0)];
/// Below this width a mark has no name.
pub(crate) const LEGEND_LEAST: f32 = 24.0;
/// Times nearer to the left edge are left out.
pub(crate) const AXIS_TIME_LEAST: f32 = 20.0;
