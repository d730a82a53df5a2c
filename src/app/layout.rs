//! Layout of the window: positions of the borders between its rooms, closed rooms, and the window size. Shares and
//! flags only: the contents and minimum sizes of rooms are defined by the window.

use serde::{Deserialize, Deserializer, Serialize};

/// Smallest window that shows everything, in points.
pub const WINDOW_LEAST: [f32; 2] = [1024.0, 640.0];
/// Initial size of the window, in points.
pub const WINDOW_FIRST: [f32; 2] = [1440.0, 900.0];
/// Maximum size of the window, larger than any screen, in points.
const WINDOW_MOST: [f32; 2] = [7680.0, 4320.0];
/// Range of a border's position, as a share of the area that it divides.
const SHARES: std::ops::RangeInclusive<f32> = 0.05..=0.95;

/// A room of the window that has a border of its own or can be closed. The room in the middle has neither.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WindowRoom {
    /// Column of joints; its border is on the right.
    Joints,
    /// Drawing of the hand above its fingertips; its border is on the right.
    Stage,
    /// Poses and demos; its border is at the top.
    Strip,
}

impl WindowRoom {
    pub const ALL: [Self; 3] = [Self::Joints, Self::Stage, Self::Strip];
}

/// Size class of the window. Each has a layout of its own, so that a small screen does not affect the layout for a
/// large one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Breakpoint {
    Small,
    Medium,
    Large,
}

impl Breakpoint {
    /// Size class of a window of this width in points.
    pub fn of(width: f32) -> Self {
        match width {
            ..1280.0 => Self::Small,
            ..1720.0 => Self::Medium,
            _ => Self::Large,
        }
    }
}

/// Layout of one room.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct RoomLayout {
    /// Share of the area that its border divides, 0.05..=0.95; `None` = default.
    #[serde(
        skip_serializing_if = "Option::is_none",
        deserialize_with = "sane_share"
    )]
    pub share: Option<f32>,
    /// True if collapsed to its title.
    pub shut: bool,
}

impl RoomLayout {
    /// Sets the share, clamped to the valid range; a non-finite one is dropped.
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

/// Width and height of the window in points, limited to plausible values.
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

/// Layout of the rooms at one [`Breakpoint`].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct RoomLayouts {
    /// See [`WindowRoom::Joints`].
    pub joints: RoomLayout,
    /// See [`WindowRoom::Stage`].
    pub stage: RoomLayout,
    /// See [`WindowRoom::Strip`].
    pub strip: RoomLayout,
}

impl RoomLayouts {
    pub const fn room(&self, room: WindowRoom) -> RoomLayout {
        match room {
            WindowRoom::Joints => self.joints,
            WindowRoom::Stage => self.stage,
            WindowRoom::Strip => self.strip,
        }
    }

    #[must_use]
    pub const fn with(mut self, room: WindowRoom, standing: RoomLayout) -> Self {
        match room {
            WindowRoom::Joints => self.joints = standing,
            WindowRoom::Stage => self.stage = standing,
            WindowRoom::Strip => self.strip = standing,
        }
        self
    }

    /// Toggles a room between open and closed.
    #[must_use]
    pub const fn toggled(self, room: WindowRoom) -> Self {
        let standing = self.room(room);
        let shut = !standing.shut;
        self.with(room, RoomLayout { shut, ..standing })
    }
}

/// Size of the window, and the layout of its rooms at each [`Breakpoint`].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Layout {
    /// Size when not maximised.
    pub window: WindowSize,
    pub maximized: bool,
    pub small: RoomLayouts,
    pub medium: RoomLayouts,
    pub large: RoomLayouts,
}

impl Layout {
    pub const fn at(&self, breakpoint: Breakpoint) -> RoomLayouts {
        match breakpoint {
            Breakpoint::Small => self.small,
            Breakpoint::Medium => self.medium,
            Breakpoint::Large => self.large,
        }
    }

    #[must_use]
    pub const fn with(mut self, breakpoint: Breakpoint, rooms: RoomLayouts) -> Self {
        match breakpoint {
            Breakpoint::Small => self.small = rooms,
            Breakpoint::Medium => self.medium = rooms,
            Breakpoint::Large => self.large = rooms,
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_says_is_cut_to_what_makes_sense() {
        let read = |text: &str| toml::from_str::<Layout>(text).unwrap();
        assert_eq!(read(""), Layout::default());
        let odd = read(
            "window = [10.0, inf]\n[small.joints]\nshare = 7.5\nshut = true\n[small.stage]\nshare = nan\n",
        );
        assert_eq!(odd.window, WindowSize([1024.0, 900.0]));
        assert_eq!(odd.small.joints.share, Some(0.95));
        assert!(odd.small.joints.shut && !odd.small.stage.shut);
        assert_eq!(odd.small.stage.share, None);
        let huge = read("window = [1e9, 1080.4]");
        assert_eq!(huge.window, WindowSize([7680.0, 1080.0]));
        let old = read("window = [1440.0, 900.0]\n[side]\nshare = 0.3\n");
        assert_eq!(
            old,
            Layout::default(),
            "older borders were of all sizes at once"
        );
    }

    #[test]
    fn a_layout_comes_back_as_it_was_written_and_belongs_to_one_breakpoint() {
        let shut = RoomLayout {
            share: None,
            shut: true,
        };
        let rooms = RoomLayouts::default()
            .with(WindowRoom::Stage, RoomLayout::default().with_share(0.25))
            .with(WindowRoom::Strip, shut);
        let layout = Layout {
            maximized: true,
            ..Layout::default().with(Breakpoint::of(1366.0), rooms)
        };
        let text = toml::to_string(&layout).unwrap();
        assert_eq!(toml::from_str::<Layout>(&text).unwrap(), layout);
        for other in [1024.0, 1920.0, 2560.0] {
            let there = layout.at(Breakpoint::of(other));
            assert_eq!(there, RoomLayouts::default(), "{other}");
        }
    }
}
