//! The window's icon: an open hand with five fingertips, drawn in code so that no image file is needed.

use egui::{Color32, IconData, Pos2, Rgba, pos2};
use std::sync::Arc;

/// Width and height in pixels.
const SIZE: u16 = 64;
const GROUND: Color32 = Color32::from_rgb(24, 34, 46);
const HAND: Color32 = Color32::from_rgb(226, 232, 238);
const TIP: Color32 = Color32::from_rgb(255, 148, 56);
/// The fingers from knuckle to tip, the thumb last, in a square of 64.
const FINGERS: [(Pos2, Pos2); 5] = [
    (pos2(22.0, 38.0), pos2(16.0, 22.0)),
    (pos2(28.0, 36.0), pos2(26.0, 14.0)),
    (pos2(35.0, 36.0), pos2(36.0, 11.0)),
    (pos2(41.0, 37.0), pos2(46.0, 15.0)),
    (pos2(40.0, 48.0), pos2(54.0, 34.0)),
];
/// The palm, as a thick line.
const PALM: (Pos2, Pos2) = (pos2(28.0, 46.0), pos2(36.0, 46.0));

/// The icon in the format of all window systems.
pub(crate) fn icon() -> Arc<IconData> {
    let rows = (0..SIZE).map(|y| f32::from(y) + 0.5);
    let points = rows.flat_map(|y| (0..SIZE).map(move |x| pos2(f32::from(x) + 0.5, y)));
    Arc::new(IconData {
        rgba: points.flat_map(pixel).collect(),
        width: SIZE.into(),
        height: SIZE.into(),
    })
}

fn pixel(at: Pos2) -> [u8; 4] {
    // A rounded square: all points near a smaller square.
    let inner = pos2(at.x.clamp(14.0, 50.0), at.y.clamp(14.0, 50.0));
    let mut color = Rgba::from(GROUND) * covered(at.distance(inner), 13.0);
    let palm = covered(distance(at, PALM), 10.0);
    let fingers = FINGERS.map(|finger| covered(distance(at, finger), 3.5));
    let tips = FINGERS.map(|(_, tip)| covered(at.distance(tip), 2.5));
    let hand = fingers.into_iter().fold(palm, f32::max);
    color = mixed(color, HAND, hand);
    color = mixed(color, TIP, tips.into_iter().fold(0.0, f32::max));
    Color32::from(color).to_srgba_unmultiplied()
}

/// Coverage of a pixel by a disc of this radius at a distance from its centre.
fn covered(distance: f32, radius: f32) -> f32 {
    (radius + 0.5 - distance).clamp(0.0, 1.0)
}

fn mixed(under: Rgba, over: Color32, part: f32) -> Rgba {
    under * (1.0 - part) + Rgba::from(over) * part
}

fn distance(at: Pos2, (from, to): (Pos2, Pos2)) -> f32 {
    let way = to - from;
    let part = (at - from).dot(way) / way.length_sq();
    at.distance(from + way * part.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_shows_a_hand_on_a_ground_with_clear_corners() {
        let icon = icon();
        assert_eq!(icon.rgba.len(), 64 * 64 * 4);
        let (pixels, _) = icon.rgba.as_chunks::<4>();
        let at = |x: usize, y: usize| pixels.get(y * 64 + x).copied().unwrap_or_default();
        assert_eq!(at(0, 0), [0; 4], "a corner");
        assert_eq!(at(32, 46), HAND.to_array(), "the palm");
        assert_eq!(at(6, 58), GROUND.to_array(), "beside it");
        for (_, tip) in FINGERS {
            let [x, y] = [tip.x, tip.y].map(|along| format!("{along}").parse().unwrap_or(0));
            assert_eq!(at(x, y), TIP.to_array(), "a tip at {tip}");
        }
    }
}
