//! Where the rooms of the window stand. Places only: draws nothing and knows no state but the layout.
//!
//! ```text
//! +----------------------------------------------------------+
//! | top bar: hand, link, rates            arm, STOP          |
//! | banners, one row each, and the note being written        |
//! | tabs                                   theme, language, ≡ |
//! +----------+-----------------------------------------------+
//! | joints   | view                                          |
//! |          |   Live: plots         | fingertips            |
//! |          |         (main room)   +---------------------- |
//! |          |                       | faults                |
//! |          |   --------------------+---------------------- |
//! |          |   poses and gestures                          |
//! +----------+-----------------------------------------------+
//! ```
//!
//! A border between two rooms can be dragged, within what both need. Every room but the main one can be shut: the joints
//! become a rail with the values that matter, the others a bar with their name.

use crate::app::layout::{Layout, Room, RoomLayout};
use crate::ui::theme;
use egui::{Pos2, Rect, pos2};

/// The side of the divided place at which the room stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// At the left.
    Left,
    /// At the right.
    Right,
    /// Above.
    Top,
    /// Below.
    Bottom,
}

impl Side {
    /// Whether the border runs from top to bottom.
    pub(crate) const fn is_upright(self) -> bool {
        matches!(self, Self::Left | Self::Right)
    }
}

/// A border that can be dragged.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Border {
    /// Whose it is.
    pub(crate) room: Room,
    /// Where that room is.
    pub(crate) side: Side,
    /// The gap between the two rooms.
    pub(crate) gap: Rect,
    /// What is divided.
    whole: Rect,
    /// Between which sizes the room may be.
    least: f32,
    most: f32,
    /// The room's size.
    size: f32,
}

impl Border {
    /// The share that the room has if the border is dragged to this point.
    pub(crate) fn share_at(&self, pointer: Pos2) -> f32 {
        let size = match self.side {
            Side::Left => pointer.x - self.whole.left(),
            Side::Right => self.whole.right() - pointer.x,
            Side::Top => pointer.y - self.whole.top(),
            Side::Bottom => self.whole.bottom() - pointer.y,
        };
        self.share(size - theme::GAP / 2.0)
    }

    /// The share that the room has if it grows by this much.
    pub(crate) fn share_grown(&self, by: f32) -> f32 {
        self.share(self.size + by)
    }

    fn share(&self, size: f32) -> f32 {
        size.clamp(self.least, self.most) / self.extent()
    }

    fn extent(&self) -> f32 {
        extent(self.whole, self.side)
    }
}

/// What a room wants of the place it shares.
struct Wish {
    room: Room,
    side: Side,
    designed: f32,
    shut: f32,
    least: f32,
    /// What the other side needs.
    rest: f32,
}

/// A place in two.
struct Halves {
    room: Rect,
    rest: Rect,
    border: Border,
}

fn extent(whole: Rect, side: Side) -> f32 {
    if side.is_upright() {
        whole.width()
    } else {
        whole.height()
    }
}

fn divide(whole: Rect, standing: RoomLayout, wish: &Wish) -> Halves {
    let extent = extent(whole, wish.side);
    let most = (extent - theme::GAP - wish.rest).max(wish.least);
    let open = standing.share.map_or(wish.designed, |share| share * extent);
    let size = if standing.shut {
        wish.shut
    } else {
        open.clamp(wish.least, most)
    };
    let size = size.round();
    let far = size + theme::GAP;
    let (room, gap, rest) = match wish.side {
        Side::Left => cut(whole, [whole.left() + size, whole.left() + far], upright),
        Side::Top => cut(whole, [whole.top() + size, whole.top() + far], flat),
        Side::Right => turned(cut(
            whole,
            [whole.right() - far, whole.right() - size],
            upright,
        )),
        Side::Bottom => turned(cut(
            whole,
            [whole.bottom() - far, whole.bottom() - size],
            flat,
        )),
    };
    Halves {
        room,
        rest,
        border: Border {
            room: wish.room,
            side: wish.side,
            gap,
            whole,
            least: wish.least,
            most,
            size,
        },
    }
}

fn upright(rect: Rect, at: f32) -> (Rect, Rect) {
    rect.split_left_right_at_x(at)
}

fn flat(rect: Rect, at: f32) -> (Rect, Rect) {
    rect.split_top_bottom_at_y(at)
}

fn cut(whole: Rect, at: [f32; 2], split: fn(Rect, f32) -> (Rect, Rect)) -> (Rect, Rect, Rect) {
    let (first, rest) = split(whole, at[0]);
    let (gap, last) = split(rest, at[1]);
    (first, gap, last)
}

fn turned((first, gap, last): (Rect, Rect, Rect)) -> (Rect, Rect, Rect) {
    (last, gap, first)
}

/// The window below the tabs.
pub(crate) struct Body {
    /// The column of joints, or their rail.
    pub(crate) joints: Rect,
    /// The open view.
    pub(crate) view: Rect,
    /// What divides them.
    pub(crate) border: Border,
}

impl Body {
    /// Divides the place below the tabs; `window` is the width of the whole window.
    pub(crate) fn of(rect: Rect, window: f32, layout: &Layout) -> Self {
        let wish = Wish {
            room: Room::Joints,
            side: Side::Left,
            designed: (window * theme::JOINTS_SHARE).clamp(theme::JOINTS_LEAST, theme::JOINTS_MOST),
            shut: theme::JOINTS_RAIL,
            least: theme::JOINTS_LEAST,
            rest: theme::PLOTS_LEAST + theme::GAP + theme::SIDE_LEAST,
        };
        let halves = divide(rect, layout.joints, &wish);
        Self {
            joints: halves.room,
            view: halves.rest,
            border: halves.border,
        }
    }
}

/// The rooms of the overview.
pub(crate) struct Overview {
    /// The main room.
    pub(crate) plots: Rect,
    /// The whole side column.
    pub(crate) side: Rect,
    /// Fingertips, in the side column.
    pub(crate) tips: Rect,
    /// Faults, in the side column.
    pub(crate) faults: Rect,
    /// Poses and gestures.
    pub(crate) strip: Rect,
    /// Of the strip, of the side column, of the fingertips.
    pub(crate) borders: [Border; 3],
}

impl Overview {
    /// Divides the view; `tips` gives the height that the fingertips were designed for in a column.
    pub(crate) fn of(rect: Rect, layout: &Layout, tips: fn(Rect) -> f32) -> Self {
        let low = rect.height() < theme::STRIP_ROOMY;
        let strip = Wish {
            room: Room::Strip,
            side: Side::Bottom,
            designed: if low {
                theme::STRIP_LEAST
            } else {
                theme::STRIP
            },
            shut: theme::SHUT,
            least: theme::STRIP_LEAST,
            rest: theme::UPPER_LEAST,
        };
        let strip = divide(rect, layout.strip, &strip);
        let side = Wish {
            room: Room::Side,
            side: Side::Right,
            designed: (rect.width() * theme::SIDE_SHARE).clamp(theme::SIDE_LEAST, theme::SIDE_MOST),
            shut: theme::SHUT,
            least: theme::SIDE_LEAST,
            rest: theme::PLOTS_LEAST,
        };
        let side = divide(strip.rest, layout.side, &side);
        let column = side.room;
        let wish = Wish {
            room: Room::Tips,
            side: Side::Top,
            designed: tips(column),
            shut: theme::SHUT,
            least: theme::TIPS_LEAST,
            rest: theme::FAULTS_LEAST,
        };
        let mut inner = divide(column, layout.tips, &wish);
        if layout.faults.shut && !layout.tips.shut {
            let (tips, faults) = flat(column, column.bottom() - theme::SHUT);
            inner.room = tips.with_max_y(tips.bottom() - theme::GAP);
            inner.rest = faults;
            inner.border.gap = Rect::from_min_max(
                pos2(column.left(), inner.room.bottom()),
                pos2(column.right(), faults.top()),
            );
        }
        Self {
            plots: side.rest,
            side: column,
            tips: inner.room,
            faults: inner.rest,
            strip: strip.room,
            borders: [strip.border, side.border, inner.border],
        }
    }
}

/// The layout with a room shut or opened. Of fingertips and faults one is always open: the column is shut as a whole.
pub(crate) fn toggled(layout: &Layout, room: Room) -> Layout {
    let standing = layout.room(room);
    let shut = !standing.shut;
    let layout = layout.with(room, RoomLayout { shut, ..standing });
    let other = match room {
        Room::Tips => Room::Faults,
        Room::Faults => Room::Tips,
        _ => return layout,
    };
    let standing = layout.room(other);
    let shut = standing.shut && !shut;
    layout.with(other, RoomLayout { shut, ..standing })
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Vec2, vec2};

    const ROOMS: [Room; 5] = [
        Room::Joints,
        Room::Side,
        Room::Tips,
        Room::Faults,
        Room::Strip,
    ];
    /// Below bar and tabs of the smallest window with two banners, of a common one, of a large one.
    const PLACES: [Vec2; 3] = [
        vec2(1008.0, 452.0),
        vec2(1424.0, 800.0),
        vec2(3824.0, 2060.0),
    ];

    fn tips(column: Rect) -> f32 {
        (column.height() * 0.5).max(theme::TIPS_LEAST)
    }

    fn rooms(size: Vec2, layout: &Layout) -> [(Room, Rect); 5] {
        let whole = Rect::from_min_size(pos2(8.0, 92.0), size);
        let body = Body::of(whole, size.x, layout);
        let live = Overview::of(body.view, layout, tips);
        let rooms = [
            (Room::Joints, body.joints),
            (Room::Side, live.plots),
            (Room::Tips, live.tips),
            (Room::Faults, live.faults),
            (Room::Strip, live.strip),
        ];
        for (at, (room, rect)) in rooms.iter().enumerate() {
            assert!(whole.contains_rect(*rect), "{size} {room:?} {rect}");
            assert!(rect.is_positive(), "{size} {room:?} {rect}");
            for (other, place) in rooms.iter().skip(at + 1) {
                let apart = !rect.shrink(0.1).intersects(*place);
                assert!(apart, "{size} {room:?} {rect} on {other:?} {place}");
            }
        }
        rooms
    }

    #[test]
    fn rooms_never_overlap_and_keep_what_they_need_wherever_the_borders_are() {
        for size in PLACES {
            for shares in [None, Some(0.05), Some(0.3), Some(0.95)] {
                for shut in 0_u8..32 {
                    let mut layout = Layout::default();
                    for (bit, room) in ROOMS.into_iter().enumerate() {
                        if shut >> bit & 1 == 1 {
                            layout = toggled(&layout, room);
                        }
                        let mut standing = layout.room(room);
                        standing.share = shares;
                        layout = layout.with(room, standing);
                    }
                    for (room, rect) in rooms(size, &layout) {
                        if room == Room::Side {
                            assert!(rect.width() >= theme::PLOTS_LEAST, "{size} {layout:?}");
                            assert!(rect.height() >= 248.0, "{size} {layout:?}");
                        }
                        if room == Room::Joints && !layout.joints.shut {
                            assert!(rect.width() >= theme::JOINTS_LEAST, "{size} {layout:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_border_stands_where_it_was_dragged_to() {
        let whole = Rect::from_min_size(pos2(8.0, 92.0), vec2(1424.0, 800.0));
        let layout = Layout::default();
        let body = Body::of(whole, 1440.0, &layout);
        let share = body.border.share_at(pos2(508.0, 400.0));
        let moved = layout.with(Room::Joints, RoomLayout::default().with_share(share));
        let body = Body::of(whole, 1440.0, &moved);
        assert!((body.border.gap.center().x - 508.0).abs() <= 1.0);
        let live = Overview::of(body.view, &moved, tips);
        for (border, by) in live.borders.into_iter().zip([40.0, -30.0, 20.0]) {
            let standing = RoomLayout::default().with_share(border.share_grown(by));
            let again = Overview::of(body.view, &moved.with(border.room, standing), tips);
            let grown = again
                .borders
                .into_iter()
                .find(|one| one.room == border.room);
            let size = grown.map_or(0.0, |grown| grown.size);
            assert!((size - border.size - by).abs() <= 1.0, "{:?}", border.room);
        }
    }

    #[test]
    fn one_of_fingertips_and_faults_is_always_open() {
        let both = toggled(&toggled(&Layout::default(), Room::Tips), Room::Faults);
        assert!(both.faults.shut && !both.tips.shut);
        assert!(toggled(&both, Room::Tips).tips.shut);
        assert!(!toggled(&both, Room::Tips).faults.shut);
    }
}
