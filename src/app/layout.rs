//! Where a person put the borders between the rooms of the window, which rooms are shut, and how large the window is.
//! Shares and flags only: what a room shows, and how small it may become, is the window's matter.

use serde::{Deserialize, Deserializer, Serialize};

/// The smallest window that shows everything, points.
pub const WINDOW_LEAST: [f32; 2] = [1024.0, 640.0];
/// The window as it first opens, points.
pub const WINDOW_FIRST: [f32; 2] = [1440.0, 900.0];
/// No screen is larger, points.
const WINDOW_MOST: [f32; 2] = [7680.0, 4320.0];
/// A border stands within these shares of what it divides.
const SHARES: std::ops::RangeInclusive<f32> = 0.05..=0.95;

/// A room of the window that has a border of its own or can be shut. The room in the middle has neither.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WindowRoom {
    /// The column of joints; its border is at its right.
    Joints,
    /// Fingertips over faults; its border is at its left.
    Side,
    /// The faults below the fingertips; their border is above.
    Faults,
    /// Poses and gestures; its border is above.
    Strip,
}

impl WindowRoom {
    pub const ALL: [Self; 4] = [Self::Joints, Self::Side, Self::Faults, Self::Strip];
}

/// How one room stands.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct RoomLayout {
    /// Its part of what its border divides, 0.05..=0.95; none as designed.
    #[serde(
        skip_serializing_if = "Option::is_none",
        deserialize_with = "sane_share"
    )]
    pub share: Option<f32>,
    /// Only its name is shown.
    pub shut: bool,
}

impl RoomLayout {
    /// This part of what its border divides, cut to what makes sense.
    #[must_use]
    pub fn with_share(self, share: f32) -> Self {
        let sane = share.is_finite();
        Self {
            share: sane.then(|| share.clamp(*SHARES.start(), *SHARES.end())),
            ..self
        }
    }
}

fn sane_share<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    let share = Option::<f32>::deserialize(from)?;
    Ok(share.and_then(|share| RoomLayout::default().with_share(share).share))
}

/// Width and height of the window, points, within what a screen can have.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f32; 2]", into = "[f32; 2]")]
pub struct WindowSize([f32; 2]);

impl From<[f32; 2]> for WindowSize {
    fn from(size: [f32; 2]) -> Self {
        let bounds = WINDOW_LEAST.into_iter().zip(WINDOW_MOST);
        let mut sane = WINDOW_FIRST;
        for ((kept, wish), (least, most)) in sane.iter_mut().zip(size).zip(bounds) {
            if wish.is_finite() {
                *kept = wish.round().clamp(least, most);
            }
        }
        Self(sane)
    }
}

impl From<WindowSize> for [f32; 2] {
    fn from(size: WindowSize) -> Self {
        size.0
    }
}

impl Default for WindowSize {
    fn default() -> Self {
        Self(WINDOW_FIRST)
    }
}

/// How the window is divided. The default is as designed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Layout {
    pub window: WindowSize,
    /// See [`WindowRoom::Joints`].
    pub joints: RoomLayout,
    /// See [`WindowRoom::Side`].
    pub side: RoomLayout,
    /// See [`WindowRoom::Faults`].
    pub faults: RoomLayout,
    /// See [`WindowRoom::Strip`].
    pub strip: RoomLayout,
}

impl Layout {
    /// How a room stands.
    pub const fn room(&self, room: WindowRoom) -> RoomLayout {
        match room {
            WindowRoom::Joints => self.joints,
            WindowRoom::Side => self.side,
            WindowRoom::Faults => self.faults,
            WindowRoom::Strip => self.strip,
        }
    }

    /// With another standing of one room.
    #[must_use]
    pub const fn with(mut self, room: WindowRoom, standing: RoomLayout) -> Self {
        match room {
            WindowRoom::Joints => self.joints = standing,
            WindowRoom::Side => self.side = standing,
            WindowRoom::Faults => self.faults = standing,
            WindowRoom::Strip => self.strip = standing,
        }
        self
    }

    /// With a room shut or opened.
    #[must_use]
    pub const fn toggled(self, room: WindowRoom) -> Self {
        let standing = self.room(room);
        let shut = !standing.shut;
        self.with(room, RoomLayout { shut, ..standing })
    }

    /// All rooms as designed; the window keeps its size.
    #[must_use]
    pub fn reset(self) -> Self {
        Self {
            window: self.window,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_says_is_cut_to_what_makes_sense() {
        let read = |text: &str| toml::from_str::<Layout>(text).unwrap();
        assert_eq!(read(""), Layout::default());
        let odd =
            read("window = [10.0, inf]\n[joints]\nshare = 7.5\nshut = true\n[side]\nshare = nan\n");
        assert_eq!(odd.window, WindowSize([1024.0, 900.0]));
        assert_eq!(odd.joints.share, Some(0.95));
        assert!(odd.joints.shut && !odd.side.shut);
        assert_eq!(odd.side.share, None);
        let huge = read("window = [1e9, 1080.4]");
        assert_eq!(huge.window, WindowSize([7680.0, 1080.0]));
    }

    #[test]
    fn a_layout_comes_back_as_it_was_written() {
        let shut = RoomLayout {
            share: None,
            shut: true,
        };
        let layout = Layout::default()
            .with(WindowRoom::Side, RoomLayout::default().with_share(0.25))
            .with(WindowRoom::Strip, shut);
        let text = toml::to_string(&layout).unwrap();
        assert_eq!(toml::from_str::<Layout>(&text).unwrap(), layout);
    }

    #[test]
    fn reset_opens_every_room_and_keeps_the_window() {
        let mut layout = Layout {
            window: [1920.0, 1080.0].into(),
            ..Layout::default()
        };
        for room in [
            WindowRoom::Joints,
            WindowRoom::Side,
            WindowRoom::Faults,
            WindowRoom::Strip,
        ] {
            let standing = RoomLayout {
                shut: true,
                ..RoomLayout::default()
            };
            layout = layout.with(room, standing.with_share(0.7));
            assert_eq!(layout.room(room).share, Some(0.7), "{room:?}");
        }
        let reset = layout.reset();
        assert_eq!(reset.window, layout.window);
        assert_eq!(
            reset,
            Layout {
                window: layout.window,
                ..Layout::default()
            }
        );
    }
}
