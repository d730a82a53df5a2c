//! Every length of the window in points: spacing, radii, strokes, widths and heights with a name. No colours, no fonts.

/// Space between cards, and the step of the grid twice.
pub(crate) const GAP: f32 = 8.0;
/// Half a gap: the step of the grid.
pub(crate) const STEP: f32 = 4.0;
/// Space inside a card.
pub(crate) const PAD: f32 = 12.0;
/// Height of the top bar.
pub(crate) const TOP_BAR: f32 = 56.0;
/// Height of the row of tabs.
pub(crate) const TABS: f32 = 36.0;
/// Height of the line with warnings and messages.
pub(crate) const STATUS: f32 = 40.0;
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

/// Width of the joints, as a share of the window, and between which widths.
pub(crate) const JOINTS_SHARE: f32 = 0.29;
/// The least width of the joints: every number in its place.
pub(crate) const JOINTS_LEAST: f32 = 384.0;
/// The width of the joints from which more does not help.
pub(crate) const JOINTS_MOST: f32 = 560.0;
/// Width of the joints' rail.
pub(crate) const JOINTS_RAIL: f32 = 144.0;
/// The side column's width as a share of the view.
pub(crate) const SIDE_SHARE: f32 = 0.4;
/// Its least width.
pub(crate) const SIDE_LEAST: f32 = 288.0;
/// Its greatest width as designed.
pub(crate) const SIDE_MOST: f32 = 560.0;
/// The least width of the plots.
pub(crate) const PLOTS_LEAST: f32 = 320.0;
/// The least height of plots and side column.
pub(crate) const UPPER_LEAST: f32 = 300.0;
/// Height of the strip in a low window, and its least one.
pub(crate) const STRIP_LEAST: f32 = 88.0;
/// Height of the strip.
pub(crate) const STRIP: f32 = 144.0;
/// Height of the overview from which its strip has several rows.
pub(crate) const STRIP_ROOMY: f32 = 640.0;
/// The least height of the fingertips.
pub(crate) const TIPS_LEAST: f32 = 200.0;
/// Height of the list of faults beside the plots.
pub(crate) const FAULTS: f32 = 104.0;
/// The least height of the list of faults.
pub(crate) const FAULTS_LEAST: f32 = 84.0;
/// Widest menu.
pub(crate) const MENU_WIDTH: f32 = 220.0;

/// Corner radius of a badge.
pub(crate) const ROUND_PILL: u8 = 12;
/// Corner radius of a rail.
pub(crate) const ROUND_TRACK: u8 = 3;
/// Width of the ring around what has the keyboard.
pub(crate) const FOCUS_LINE: f32 = 1.5;
/// What a lamp shines beyond its edge; the dot in a handle.
pub(crate) const HALO: f32 = 2.5;
/// Width of a sign.
pub(crate) const SIGN: f32 = 16.0;
/// Height of a sign in a banner.
pub(crate) const SIGN_HEIGHT: f32 = 14.0;
/// Height of a sign in a row.
pub(crate) const SIGN_SMALL: f32 = 12.0;
/// Where a lamp's middle is in its row.
pub(crate) const LAMP_AT: f32 = 6.0;
/// Where the words beside a lamp begin.
pub(crate) const INDENT: f32 = 17.0;
/// What lamp and margins add to the words of a button.
pub(crate) const LAMP_BUTTON: f32 = 40.0;
/// Where a lamp's middle is in a button.
pub(crate) const LAMP_IN_BUTTON: f32 = 16.0;
/// Where the words beside it begin.
pub(crate) const WORDS_IN_BUTTON: f32 = 29.0;
/// Width of STOP.
pub(crate) const STOP_WIDTH: f32 = 148.0;
/// Width of Arm.
pub(crate) const ARM_WIDTH: f32 = 96.0;
/// Height of a caption over its figure.
pub(crate) const FIGURE: f32 = 34.0;
/// A line of a paragraph.
pub(crate) const TEXT_LINE: f32 = 16.0;
/// A line of a list.
pub(crate) const LIST_LINE: f32 = 17.0;
/// A row of figures.
pub(crate) const FIGURE_ROW: f32 = 18.0;

/// The first line of an entry.
pub(crate) const TITLE_LINE: f32 = 20.0;
/// Width of a number field.
pub(crate) const FIELD: f32 = 52.0;
/// What the edges of a number field take.
pub(crate) const FIELD_MARGIN_SMALL: f32 = 14.0;
/// Width of counts.
pub(crate) const COUNT_COLUMN: f32 = 96.0;
/// Height of the rail of a track.
pub(crate) const TRACK_RAIL: f32 = 6.0;
/// Width of a card over the window.
pub(crate) const CARD_WIDTH: f32 = 560.0;
/// Space inside it.
pub(crate) const CARD_PAD: f32 = 20.0;
