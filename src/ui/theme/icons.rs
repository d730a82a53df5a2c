//! The signs of the window, by what they mean. Drawn with [`crate::ui::theme::icon`].

use egui_material_icons::icons;

/// A sign of the icon font.
pub(crate) type Icon = &'static str;

/// Towards the left: fold a room at the left, unfold one at the right.
pub(crate) const TO_LEFT: Icon = icons::ICON_CHEVRON_LEFT.codepoint;
/// Towards the right.
pub(crate) const TO_RIGHT: Icon = icons::ICON_CHEVRON_RIGHT.codepoint;
/// Upwards.
pub(crate) const TO_TOP: Icon = icons::ICON_KEYBOARD_ARROW_UP.codepoint;
/// Downwards.
pub(crate) const TO_BOTTOM: Icon = icons::ICON_KEYBOARD_ARROW_DOWN.codepoint;
/// Opens a menu.
pub(crate) const MENU: Icon = icons::ICON_MENU.codepoint;
/// Left alone.
pub(crate) const LOCKED: Icon = icons::ICON_LOCK.codepoint;
/// Free to move.
pub(crate) const UNLOCKED: Icon = icons::ICON_LOCK_OPEN.codepoint;
/// What can be set.
pub(crate) const TUNE: Icon = icons::ICON_TUNE.codepoint;
/// Moves together.
pub(crate) const LINKED: Icon = icons::ICON_LINK.codepoint;
/// Look at it.
pub(crate) const WARNING: Icon = icons::ICON_WARNING.codepoint;
/// Takes away.
pub(crate) const CLOSE: Icon = icons::ICON_CLOSE.codepoint;
/// Stands still.
pub(crate) const PAUSE: Icon = icons::ICON_PAUSE.codepoint;
/// Goes on.
pub(crate) const PLAY: Icon = icons::ICON_PLAY_ARROW.codepoint;
/// Kept, whatever else goes.
pub(crate) const STAR: Icon = icons::ICON_BOOKMARK_ADDED.codepoint;
/// Could be kept.
pub(crate) const NO_STAR: Icon = icons::ICON_BOOKMARK.codepoint;
/// The best of several.
pub(crate) const BEST: Icon = icons::ICON_STAR.codepoint;
/// More of the same.
pub(crate) const MORE: Icon = icons::ICON_MORE_VERT.codepoint;

/// Takes the last one back.
pub(crate) const BACKSPACE: Icon = icons::ICON_BACKSPACE.codepoint;

#[cfg(test)]
pub(crate) const ALL: [Icon; 18] = [
    TO_LEFT, TO_RIGHT, TO_TOP, TO_BOTTOM, MENU, LOCKED, UNLOCKED, TUNE, LINKED, WARNING, CLOSE,
    PAUSE, PLAY, STAR, NO_STAR, BEST, MORE, BACKSPACE,
];
