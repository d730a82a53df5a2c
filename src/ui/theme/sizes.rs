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
/// Height of a banner.
pub(crate) const BANNER: f32 = 44.0;
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
pub(crate) const JOINTS_RAIL: f32 = 116.0;
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
pub(crate) const STRIP: f32 = 164.0;
/// Height of the overview from which its strip has several rows.
pub(crate) const STRIP_ROOMY: f32 = 640.0;
/// The least height of the fingertips.
pub(crate) const TIPS_LEAST: f32 = 200.0;
/// The least height of the list of faults.
pub(crate) const FAULTS_LEAST: f32 = 84.0;
/// Width or height of a room that is shut.
pub(crate) const SHUT: f32 = 40.0;
/// How far a border can be grasped beside itself; less than [`PAD`], so that it never covers a control.
pub(crate) const GRASP: f32 = 10.0;
/// Length of the button in a border.
pub(crate) const GRIP: f32 = 48.0;
/// How far one arrow key moves a border.
pub(crate) const NUDGE: f32 = 16.0;
/// Widest menu.
pub(crate) const MENU_WIDTH: f32 = 220.0;
/// Width of a square icon button.
pub(crate) const ICON_BUTTON: f32 = 32.0;
/// Width of the list of keys.
pub(crate) const KEY_LIST_WIDTH: f32 = 640.0;
/// Height of one of its rows.
pub(crate) const KEY_ROW: f32 = 24.0;
/// Width of the keys in a row.
pub(crate) const KEY_COLUMN: f32 = 112.0;
/// Room above and below a drawn key.
pub(crate) const KEY_CAP_MARGIN: f32 = 2.0;
