//! Named lengths of the window in points: spacing, radii, strokes, widths and heights. No colours, no fonts.

use egui::Margin;

/// Space between cards: two grid steps.
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
/// Height of an important button.
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
/// Width of an emphasised line.
pub(crate) const STRONG: f32 = 2.0;

/// Width of the focus ring.
pub(crate) const FOCUS_LINE: f32 = 1.5;
/// Width of a lamp's halo; radius of the dot in a handle.
pub(crate) const HALO: f32 = 2.5;
/// Height of an icon in a row.
pub(crate) const SIGN_SMALL: f32 = 12.0;
/// Distance of a lamp's centre from the start of its row.
pub(crate) const LAMP_AT: f32 = 6.0;
/// Height of a paragraph's line.
pub(crate) const TEXT_LINE: f32 = 16.0;
/// Height of a list's line.
pub(crate) const LIST_LINE: f32 = 17.0;
pub(crate) const FIGURE_ROW: f32 = 18.0;

/// Height of an entry's first line.
pub(crate) const TITLE_LINE: f32 = 20.0;
/// Width of a switch.
pub(crate) const SWITCH: f32 = 40.0;
/// Width of a number field.
pub(crate) const FIELD: f32 = 52.0;
/// Padding of a number field.
pub(crate) const NUMBER_INSET: Margin = Margin::symmetric(6, 0);
/// Padding of a text field.
pub(crate) const FIELD_INSET: Margin = Margin::symmetric(8, 2);
/// Wheel points that halve or double the visible range.
pub(crate) const PLOT_WHEEL: f32 = 180.0;
/// Width for the numbers of the vertical axis.
pub(crate) const PLOT_AXIS: f32 = 48.0;
/// Width for half of a time label beyond the right edge.
pub(crate) const PLOT_END: f32 = 12.0;
/// Height for the numbers of the time axis.
pub(crate) const PLOT_TIME_AXIS: f32 = 20.0;
/// Height of a plot's title.
pub(crate) const PLOT_CAPTION: f32 = 18.0;
/// Height that a number on the vertical axis needs.
pub(crate) const PLOT_NUMBER: f32 = 22.0;
/// Width of a line sample in a legend.
pub(crate) const KEY_SIGN: f32 = 20.0;
