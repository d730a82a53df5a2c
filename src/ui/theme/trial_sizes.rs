//! Lengths of the views of grasp trials, points. No colours, no fonts.

/// Columns of numbers in the table of trials, with the room of the end in their widths.
pub(crate) const TRIAL_COLUMNS: f32 = 11.6;
/// Width of the plan as a share of its view, and between which widths.
pub(crate) const PLAN_SHARE: f32 = 0.44;
/// Its least width: every joint with two angles.
pub(crate) const PLAN_LEAST: f32 = 318.0;
/// Its greatest width.
pub(crate) const PLAN_MOST: f32 = 420.0;
/// Width of a joint's button in the plan.
pub(crate) const PLAN_JOINT: f32 = 94.0;
/// Width of the start or target of a joint.
pub(crate) const PLAN_WAY: f32 = 52.0;
/// Width of a number in the plan.
pub(crate) const PLAN_ANGLE: f32 = 72.0;
/// Width of what stands before a field of the plan.
pub(crate) const PLAN_CAPTION: f32 = 116.0;
/// Width of what stands before the second field of a row.
pub(crate) const PLAN_CAPTION_SHORT: f32 = 64.0;
/// Least height of the force while a series runs.
pub(crate) const TRIAL_PLOT_LEAST: f32 = 96.0;
/// Height of the bar that shows how far a series is.
pub(crate) const TRIAL_BAR: f32 = 6.0;
/// Height of a row of the table of trials.
pub(crate) const TRIAL_ROW: f32 = 20.0;
/// Least width of a column of the table of trials.
pub(crate) const TRIAL_COLUMN: f32 = 64.0;
/// Width of the first column of the table of trials.
pub(crate) const TRIAL_FIRST_COLUMN: f32 = 150.0;
/// Height of a cell of the map.
pub(crate) const MAP_CELL: f32 = 26.0;
/// Least width of a cell of the map.
pub(crate) const MAP_CELL_LEAST: f32 = 40.0;
/// Greatest width of a cell of the map.
pub(crate) const MAP_CELL_MOST: f32 = 84.0;
/// Width of the map's own numbers.
pub(crate) const MAP_HEAD: f32 = 52.0;
/// Width of the map as a share of its view.
pub(crate) const MAP_SHARE: f32 = 0.36;
/// Least width of the map.
pub(crate) const MAP_LEAST: f32 = 240.0;
/// Greatest width of the map.
pub(crate) const MAP_MOST: f32 = 440.0;
/// Share of the height that the curves get.
pub(crate) const CURVES_SHARE: f32 = 0.48;
/// From this share of the heat on its colour is strong.
pub(crate) const HEAT_BRIGHT: f32 = 0.6;
/// Sessions whose rows are seen without scrolling, and how many of more.
pub(crate) const SESSIONS_SEEN: (f32, f32) = (3.0, 3.4);
/// Width of the tick of a session.
pub(crate) const SESSION_TICK: f32 = 20.0;
/// Width of the sign of a session's stroke.
pub(crate) const SESSION_DASH: f32 = 26.0;
/// Width of a session's name.
pub(crate) const SESSION_NAME: f32 = 76.0;
/// Width of how many trials a session has.
pub(crate) const SESSION_TRIALS: f32 = 60.0;
/// Width of whether a session is in files.
pub(crate) const SESSION_STATE: f32 = 116.0;
/// Width of the column of sessions in the table of trials.
pub(crate) const SESSION_COLUMN: f32 = 56.0;
/// Width of a column's arrow.
pub(crate) const SORT_ARROW: f32 = 11.0;
/// Width of the sign of a line in the legend.
pub(crate) const KEY_SIGN: f32 = 20.0;
/// Height of the words about a series, where there is plenty.
pub(crate) const RESULT_WORDS: f32 = 260.0;
/// Least share of the height that the curves of the last series get below its words.
pub(crate) const RESULT_SHARE: f32 = 0.45;
