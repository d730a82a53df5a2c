//! Kinds of strokes: lines of one colour that an eye tells apart. Cuts lines into pieces; knows no plot.

use crate::ui::theme;
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke};

/// A kind of stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Dash {
    /// Without gaps.
    #[default]
    Solid,
    /// Long pieces.
    Long,
    /// Short pieces.
    Dots,
    /// Long and short ones by turns.
    Mixed,
}

impl Dash {
    /// The kinds in their order, round and round.
    pub(crate) const fn nth(number: usize) -> Self {
        match number % 4 {
            0 => Self::Solid,
            1 => Self::Long,
            2 => Self::Dots,
            _ => Self::Mixed,
        }
    }

    /// Drawn and left out by turns, points.
    const fn pattern(self) -> &'static [f32] {
        match self {
            Self::Solid => &[],
            Self::Long => &theme::DASH_LONG,
            Self::Dots => &theme::DASH_DOTS,
            Self::Mixed => &theme::DASH_MIXED,
        }
    }

    /// A line, in its pieces.
    pub(crate) fn shapes(self, places: Vec<Pos2>, stroke: Stroke) -> Vec<Shape> {
        if self == Self::Solid {
            return vec![Shape::line(places, stroke)];
        }
        let pieces = pieces(&places, self.pattern()).into_iter();
        pieces.map(|piece| Shape::line(piece, stroke)).collect()
    }

    /// Draws a sign of it across the middle of a place.
    pub(crate) fn sample(self, painter: &Painter, place: Rect, stroke: Stroke) {
        let ends = vec![place.left_center(), place.right_center()];
        painter.extend(self.shapes(ends, stroke));
    }
}

/// The parts of a line that are drawn. A line that is long because it trembles gets longer pieces, not more of them.
fn pieces(places: &[Pos2], pattern: &[f32]) -> Vec<Vec<Pos2>> {
    let pairs = || places.iter().zip(places.iter().skip(1));
    let long: f32 = pairs().map(|(from, to)| from.distance(*to)).sum();
    let period: f32 = pattern.iter().sum();
    let stretch = (long / (period * theme::DASHES_MOST)).max(1.0);
    let mut lengths = pattern.iter().map(|length| length * stretch).cycle();
    let (Some(mut left), Some(first)) = (lengths.next(), places.first()) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let mut piece = vec![*first];
    let mut drawn = true;
    for (from, to) in pairs() {
        let (mut from, mut rest) = (*from, from.distance(*to));
        while rest > left {
            from = from.lerp(*to, left / rest);
            rest -= left;
            if drawn {
                piece.push(from);
                all.push(std::mem::take(&mut piece));
            } else {
                piece = vec![from];
            }
            drawn = !drawn;
            left = lengths.next().unwrap_or(f32::INFINITY);
        }
        left -= rest;
        if drawn {
            piece.push(*to);
        }
    }
    if drawn && piece.len() > 1 {
        all.push(piece);
    }
    all
}

/// The colour of lines that stand back behind another one.
pub(crate) fn behind(color: Color32) -> Color32 {
    color.gamma_multiply(theme::CURVE_BEHIND)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    fn drawn(piece: &[Pos2]) -> f32 {
        let pairs = piece.iter().zip(piece.iter().skip(1));
        pairs.map(|(from, to)| from.distance(*to)).sum()
    }

    #[test]
    fn pieces_and_gaps_follow_the_pattern_round_corners() {
        let corner = [pos2(0.0, 0.0), pos2(10.0, 0.0), pos2(10.0, 100.0)];
        let all = pieces(&corner, &[7.0, 4.0]);
        assert_eq!(all.len(), 10);
        let middle = all.get(1).map(Vec::as_slice).unwrap_or_default();
        let meant = [pos2(10.0, 1.0), pos2(10.0, 8.0)];
        let apart = |(a, b): (&Pos2, &Pos2)| a.distance(*b) > 0.01;
        assert!(
            middle.len() == 2 && !middle.iter().zip(&meant).any(apart),
            "{middle:?}"
        );
        assert!(all.iter().all(|piece| drawn(piece) <= 7.01));
        let around = pieces(&corner, &[12.0, 4.0]);
        assert_eq!(around.first().map(Vec::len), Some(3), "over the corner");
    }

    #[test]
    fn a_line_that_trembles_is_cut_into_no_more_pieces() {
        let places: Vec<Pos2> = (0_u16..2000)
            .map(|n| pos2(f32::from(n), f32::from(n % 2) * 500.0))
            .collect();
        let all = pieces(&places, &[2.0, 3.0]);
        let most = theme::DASHES_MOST + 1.0;
        assert!(all.len() > 10 && f32::from(u16::try_from(all.len()).unwrap_or(u16::MAX)) <= most);
        assert!(pieces(&[], &[2.0, 3.0]).is_empty());
    }
}
