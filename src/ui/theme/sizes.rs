//! Every length of the window in points: spacing, radii, strokes, widths and heights with a name. No colours, no fonts.

use egui::Margin;

/// Space between cards, and the step of the grid twice.
pub(crate) const GAP: f32 = 8.0;
/// A gap at one side of a panel.
pub(crate) const GAP_LEFT: Margin = Margin {
    left: 8,
    ..Margin::ZERO
};
pub(crate) const GAP_RIGHT: Margin = Margin {
    right: 8,
    ..Margin::ZERO
};
pub(crate) const GAP_TOP: Margin = Margin {
    top: 8,
    ..Margin::ZERO
};
/// Half a gap: the step of the grid.
pub(crate) const STEP: f32 = 4.0;
/// Space inside a card.
pub(crate) const PAD: f32 = 12.0;
/// Height of the top bar.
pub(crate) const TOP_BAR: f32 = 48.0;
/// Height of a button or field.
pub(crate) const CONTROL: f32 = 24.0;
/// Height of a button that matters.
pub(crate) const CONTROL_LARGE: f32 = 32.0;
/// Corner radius of cards.
pub(crate) const ROUND: u8 = 8;
/// Corner radius of controls.
pub(crate) const ROUND_SMALL: u8 = 5;
/// Radius of a status lamp.
pub(crate) const LAMP: f32 = 4.0;
/// Width of a plotted line.
pub(crate) const LINE: f32 = 1.4;
/// Corner radius of bars and badges.
pub(crate) const ROUND_TINY: u8 = 2;
/// Width of the bar in a joint's colour.
pub(crate) const BAR: f32 = 3.0;
/// Width of a line that is to be seen.
pub(crate) const STRONG: f32 = 2.0;

/// Width of the ring around what has the keyboard.
pub(crate) const FOCUS_LINE: f32 = 1.5;
/// What a lamp shines beyond its edge; the dot in a handle.
pub(crate) const HALO: f32 = 2.5;
/// Height of a sign in a row.
pub(crate) const SIGN_SMALL: f32 = 12.0;
/// Where a lamp's middle is in its row.
pub(crate) const LAMP_AT: f32 = 6.0;
/// A line of a paragraph.
pub(crate) const TEXT_LINE: f32 = 16.0;
/// A line of a list.
pub(crate) const LIST_LINE: f32 = 17.0;
pub(crate) const FIGURE_ROW: f32 = 18.0;

/// The first line of an entry.
pub(crate) const TITLE_LINE: f32 = 20.0;
/// Width of a number field.
pub(crate) const FIELD: f32 = 52.0;
/// A word and a number on a track.
pub(crate) const OTHER: f32 = 62.0;
/// Room inside a number field.
pub(crate) const NUMBER_INSET: Margin = Margin::symmetric(6, 0);
/// Room inside a text field.
pub(crate) const FIELD_INSET: Margin = Margin::symmetric(8, 2);
/// Points of the wheel that halve or double what is shown.
pub(crate) const PLOT_WHEEL: f32 = 180.0;
/// Room for the numbers of the vertical axis.
pub(crate) const PLOT_AXIS: f32 = 48.0;
/// Room for the half of a word below the right edge.
pub(crate) const PLOT_END: f32 = 12.0;
/// Room for the numbers of the time axis.
pub(crate) const PLOT_TIME_AXIS: f32 = 20.0;
/// Room for a plot's title.
pub(crate) const PLOT_CAPTION: f32 = 18.0;
/// Height that a number on the vertical axis needs.
pub(crate) const PLOT_NUMBER: f32 = 22.0;
/// Width of the sign of a line in a legend.
pub(crate) const KEY_SIGN: f32 = 20.0;
