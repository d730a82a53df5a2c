//! Lengths of the single views in points: tiles, columns, rows. No colours, no fonts.

/// Width from which six tiles stand in one row.
pub(crate) const DRIVE_TILES_ROW: f32 = 840.0;
/// Height of a tile without its cause.
pub(crate) const DRIVE_TILE_LOW: f32 = 52.0;
/// Height of the view from which tiles say the cause, too.
pub(crate) const DRIVE_TILES_ROOMY: f32 = 560.0;
/// Size of the number on a tab.
pub(crate) const FAULT_BADGE: f32 = 16.0;
/// Height of a finger's name with its number.
pub(crate) const HAND_HEAD: f32 = 34.0;
/// Size from which numbers find room.
pub(crate) const HAND_NUMBERS_ROOM: (f32, f32) = (240.0, 230.0);
/// Width of a message's age.
pub(crate) const MESSAGE_AGE: f32 = 52.0;
/// The filter's field has a row of its own where it would be narrower.
pub(crate) const MESSAGE_FIELD: f32 = 96.0;
/// Above and below the text of a message.
pub(crate) const MESSAGE_AIR: f32 = 3.0;
/// Width of a number.
pub(crate) const POSE_NUMBER: f32 = 64.0;
/// Width of what stands before a field.
pub(crate) const POSE_CAPTION: f32 = 88.0;
/// The least size of a tile.
pub(crate) const POSE_TILE: egui::Vec2 = egui::vec2(112.0, 158.0);
/// Width of the field that finds poses.
pub(crate) const POSE_FIND: f32 = 200.0;
/// Height of a step.
pub(crate) const STEP_ROW: f32 = 40.0;
/// Width of the list of sequences.
pub(crate) const SEQUENCE_LIST: f32 = 148.0;
/// Width from which the force in space finds room beside the compass, and height from which below it.
pub(crate) const TIP_DETAIL_WIDE: f32 = 760.0;
/// Least side of the force seen from the side.
pub(crate) const TIP_SQUARE_LEAST: f32 = 118.0;
/// Width of the readings: least and most.
pub(crate) const TIP_READINGS: (f32, f32) = (150.0, 230.0);
/// Height from which the forces find room over the channels.
pub(crate) const TIP_BOTH_PLOTS: f32 = 270.0;
/// Heights of the drawn hand in the overview: less shows nothing, more would take the room of the faults.
pub(crate) const HAND_LEAST: f32 = 130.0;
/// Greatest width of the drawn hand.
pub(crate) const HAND_MOST: f32 = 340.0;
/// Height that the faults below keep.
pub(crate) const TOUCH_FAULTS_LEAST: f32 = 150.0;
/// Height of a fingertip's name, and of its forces.
pub(crate) const TIP_TITLE: f32 = 18.0;
/// Height of the two values below a fingertip.
pub(crate) const TIP_VALUES: f32 = 40.0;
/// Smallest height of the chosen frame's card.
pub(crate) const FRAME_DETAIL_LEAST: f32 = 150.0;
/// Width of the filter's field.
pub(crate) const TRAFFIC_FILTER: f32 = 220.0;
/// Height of a field's row.
pub(crate) const FIELD_ROW: f32 = 17.0;
/// Height of a row.
pub(crate) const FRAME_ROW: f32 = 19.0;
/// Width of the scroll bar.
pub(crate) const FRAME_BAR: f32 = 12.0;
/// Room of a mark for what nobody has seen yet.
pub(crate) const UNSEEN_MARK: f32 = 12.0;
/// Width of a ring.
pub(crate) const RING_LINE: f32 = 1.6;
/// Where the middle of the first line of a message is.
pub(crate) const MESSAGE_FIRST: f32 = 7.0;
/// Height of a line of small words.
pub(crate) const MESSAGE_LINE: f32 = 14.0;
/// Least and greatest length of the head of an arrow.
pub(crate) const ARROW_HEAD: (f32, f32) = (3.0, 8.0);
/// Width of the line of a force.
pub(crate) const ARROW_LINE: f32 = 2.5;
/// Width of a caption beside a gesture.
pub(crate) const GESTURE_CAPTION: f32 = 96.0;
/// Least and greatest height of a gesture's tile.
pub(crate) const GESTURE_HEIGHTS: (f32, f32) = (22.0, 72.0);
/// Least and greatest height of the picture of a pose that is edited.
pub(crate) const POSE_PICTURE: (f32, f32) = (48.0, 320.0);
/// Width of a field of a pose.
pub(crate) const POSE_FIELD: f32 = 56.0;
/// Height of name and tags below the picture of a pose.
pub(crate) const POSE_WORDS: f32 = 36.0;
/// Least and greatest width of the pose that is edited.
pub(crate) const POSE_SIDE: (f32, f32) = (244.0, 340.0);
/// Least and greatest width of the gesture that is edited.
pub(crate) const GESTURE_SIDE: (f32, f32) = (268.0, 380.0);
/// What stands where there are no poses.
pub(crate) const POSE_EMPTY: egui::Vec2 = egui::vec2(560.0, 250.0);
/// Height of the picture in it.
pub(crate) const POSE_EMPTY_PICTURE: f32 = 120.0;
/// Least and greatest width of the list of recordings.
pub(crate) const RECORDINGS_LIST: (f32, f32) = (168.0, 300.0);
/// Width of what a step of a sequence is dragged by.
pub(crate) const STEP_HANDLE: f32 = 22.0;
/// Width of a figure of a step.
pub(crate) const STEP_FIGURE: f32 = 58.0;
/// Least and greatest height of the picture of a sequence.
pub(crate) const SEQUENCE_PICTURE: (f32, f32) = (96.0, 360.0);
/// Width of the button that adds a step.
pub(crate) const SEQUENCE_ADD: f32 = 88.0;
/// Height of the words where there are no steps.
pub(crate) const SEQUENCE_EMPTY: f32 = 64.0;
/// Width of a button that plays a sequence.
pub(crate) const SEQUENCE_BUTTON: f32 = 72.0;
/// Room of the word that says where the fingertip's end is.
pub(crate) const COMPASS_WORD: egui::Vec2 = egui::vec2(40.0, 12.0);
/// Width of the captions beside the fingertips' numbers.
pub(crate) const TIP_NUMBERS_CAPTION: f32 = 44.0;
/// The bar of the heat scale.
pub(crate) const HEAT_BAR: egui::Vec2 = egui::vec2(64.0, 8.0);
/// The sign of a frame with something wrong.
pub(crate) const FRAME_WRONG: egui::Vec2 = egui::vec2(12.0, 11.0);
/// Room inside a number field.
pub(crate) const NUMBER_INSET: egui::Margin = egui::Margin::symmetric(6, 0);
/// Room inside a text field.
pub(crate) const FIELD_INSET: egui::Margin = egui::Margin::symmetric(8, 2);
/// Room inside a text field in a low row.
pub(crate) const FIELD_INSET_LOW: egui::Margin = egui::Margin::symmetric(8, 0);
/// Room inside the field of a gesture's name.
pub(crate) const NAME_INSET: egui::Margin = egui::Margin::symmetric(4, 0);
/// Width from which gestures stand in five columns.
pub(crate) const GESTURES_FIVE: f32 = 640.0;
/// Height from which a drive's tile says the cause.
pub(crate) const CAUSE_LEAST: f32 = 26.0;
/// Least width of a message.
pub(crate) const MESSAGE_LEAST: f32 = 40.0;
