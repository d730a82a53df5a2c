//! Lengths of the drawn hand, in millimetres, and of the view of one fingertip, in points. No colours, no fonts.

/// Thickness of a finger at its knuckle, in millimetres.
pub(crate) const KNUCKLE_MM: f32 = 19.0;
/// Thickness of a finger at its tip.
pub(crate) const FINGERTIP_MM: f32 = 14.0;
/// The thumb is this much thicker.
pub(crate) const THUMB_MORE: f32 = 1.18;
/// Rounding of the palm.
pub(crate) const PALM_MM: f32 = 14.0;
/// Half the palm's thickness.
pub(crate) const PALM_HALF_MM: f32 = 7.0;
/// Room around the bones, for halos.
pub(crate) const HAND_MARGIN_MM: f32 = 13.0;
/// How far in front and behind light and shade go.
pub(crate) const SHADE_MM: f32 = 70.0;
/// How far the light on a bone lies beside its middle, in its widths.
pub(crate) const LIGHT_ASIDE: f32 = 0.16;

/// A line that only leads the eye.
pub(crate) const THIN: f32 = 1.2;
/// The outline of what is meant, not measured.
pub(crate) const MEANT: f32 = 1.5;
/// A force as a line.
pub(crate) const NEEDLE: f32 = 2.5;

/// Width from which the list of channels finds room beside their plot.
pub(crate) const CHANNELS_ROOMY: f32 = 330.0;
/// Width of that list.
pub(crate) const CHANNEL_LIST: f32 = 176.0;
/// Height of its rows, at most.
pub(crate) const CHANNEL_ROW: f32 = 20.0;
/// Height of a row in the table of all numbers, at least.
pub(crate) const TABLE_ROW_LEAST: f32 = 11.0;
/// Room of a number at an axis.
pub(crate) const AXIS_WIDTH: f32 = 70.0;
/// Its height.
pub(crate) const AXIS_HEIGHT: f32 = 14.0;
/// How far the end of the force axis is written beside it.
pub(crate) const AXIS_ASIDE: f32 = 30.0;
/// Columns of pixels that a screen has at most.
pub(crate) const COLUMNS_MOST: f32 = 8192.0;
