//! The short name of each line beside its right end, so that lines are told apart by more than their colour.

use crate::hand::Finger;
use crate::history::Series;
use crate::ui::kit::controls;
use crate::ui::kit::look::Look;
use crate::ui::plots::plot_rows::PlotLine;
use crate::ui::text::{Text, plots};
use crate::ui::theme;
use egui::{Align2, Rect, Stroke, Ui, pos2};

/// Where a line ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct End {
    /// Which.
    pub(crate) line: PlotLine,
    /// At what height.
    pub(crate) y: f32,
}

/// Draws the names of lines that end at the right edge of `plot`.
pub(crate) fn ends_ui(ui: &Ui, plot: Rect, look: Look, ends: Vec<End>) {
    let ends = ordered(ends);
    let mut heights: Vec<f32> = ends.iter().map(|end| end.y).collect();
    let apart = spread(&mut heights, (plot.top(), plot.bottom()));
    let aside = if apart < theme::END_NAME {
        theme::END_ASIDE
    } else {
        0.0
    };
    for ((end, y), aside) in ends
        .iter()
        .zip(heights)
        .zip([0.0, aside].into_iter().cycle())
    {
        let color = look.palette.dof[end.line.dof];
        let at = end.y.clamp(plot.top(), plot.bottom());
        let lead = [
            pos2(plot.right() + 1.0, at),
            pos2(plot.right() + theme::END_LEAD, y),
        ];
        ui.painter().line_segment(lead, Stroke::new(1.0, color));
        let left = plot.right() + theme::END_LEAD + 2.0 + aside;
        let place = Rect::from_min_max(
            pos2(left, y - theme::END_NAME / 2.0),
            pos2(plot.right() + theme::PLOT_ENDS, y + theme::END_NAME / 2.0),
        );
        let (text, font) = (look.say(short(end.line.series)), theme::tiny());
        controls::paint_text(ui, place, Align2::LEFT_CENTER, text, font, color);
    }
}

/// From top to bottom; those that end together keep the order in which they came, so that noise shuffles no names.
fn ordered(ends: Vec<End>) -> Vec<End> {
    let mut sorted: Vec<End> = Vec::with_capacity(ends.len());
    for end in ends {
        let above = |other: &End| other.y <= end.y + theme::END_TOGETHER;
        let place = sorted.iter().rposition(above).map_or(0, |last| last + 1);
        sorted.insert(place, end);
    }
    sorted
}

/// Moves heights apart, as little as it takes, so that names of [`theme::END_NAME`] do not overlap; closer where there is no room.
/// How far apart they are at least.
fn spread(heights: &mut [f32], (top, bottom): (f32, f32)) -> f32 {
    let count = f32::from(u8::try_from(heights.len()).unwrap_or(u8::MAX).max(1));
    let apart = theme::END_NAME.min((bottom - top) / count);
    let mut least = top + apart / 2.0;
    for y in heights.iter_mut() {
        *y = y.max(least);
        least = *y + apart;
    }
    let mut most = bottom - apart / 2.0;
    for y in heights.iter_mut().rev() {
        *y = y.min(most);
        most = *y - apart;
    }
    apart
}

/// The short name of a line: of its joint, or of its finger.
const fn short(series: Series) -> Text {
    use crate::hand::Dof;
    match series {
        Series::Joint(_, Dof::Little) => plots::SHORT_LITTLE,
        Series::Joint(_, Dof::Ring) => plots::SHORT_RING,
        Series::Joint(_, Dof::Middle) => plots::SHORT_MIDDLE,
        Series::Joint(_, Dof::Index) => plots::SHORT_INDEX,
        Series::Joint(_, Dof::ThumbBend) => plots::SHORT_BEND,
        Series::Joint(_, Dof::ThumbRotate) => plots::SHORT_ROTATE,
        Series::Tip(_, finger) | Series::Channel(_, finger) => of_finger(finger),
    }
}

const fn of_finger(finger: Finger) -> Text {
    match finger {
        Finger::Little => plots::SHORT_LITTLE,
        Finger::Ring => plots::SHORT_RING,
        Finger::Middle => plots::SHORT_MIDDLE,
        Finger::Index => plots::SHORT_INDEX,
        Finger::Thumb => plots::SHORT_THUMB,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Dof;
    use crate::hand::Quantity;

    fn end(dof: Dof, y: f32) -> End {
        let line = PlotLine {
            series: Series::Joint(Quantity::Force, dof),
            dof,
            wished: false,
        };
        End { line, y }
    }

    #[test]
    fn names_stand_as_their_lines_do_and_noise_shuffles_none() {
        let order = |heights: [f32; 3]| {
            let dofs = [Dof::Little, Dof::Ring, Dof::Middle];
            let ends = dofs.into_iter().zip(heights).map(|(dof, y)| end(dof, y));
            let ordered = ordered(ends.collect());
            ordered.iter().map(|end| end.line.dof).collect::<Vec<_>>()
        };
        let (little, ring, middle) = (Dof::Little, Dof::Ring, Dof::Middle);
        assert_eq!(order([90.0, 10.0, 50.0]), [ring, middle, little]);
        assert_eq!(order([50.0, 51.0, 49.0]), [little, ring, middle]);
        assert_eq!(order([51.0, 48.0, 50.0]), [little, ring, middle]);
        assert_eq!(order([50.0, 51.0, 20.0]), [middle, little, ring]);
    }

    #[test]
    fn names_keep_their_order_stay_inside_and_do_not_overlap() {
        for mut heights in [
            vec![50.0; 6],
            vec![0.0, 1.0, 2.0, 99.0, 99.5, 100.0],
            vec![30.0, 60.0],
            vec![-500.0, 700.0],
        ] {
            assert!(spread(&mut heights, (0.0, 100.0)) >= theme::END_NAME);
            let pairs = heights.iter().zip(heights.iter().skip(1));
            assert!(
                pairs
                    .clone()
                    .all(|(one, two)| two - one > theme::END_NAME - 0.01),
                "{heights:?}"
            );
            assert!(
                heights
                    .iter()
                    .all(|y| (theme::END_NAME / 2.0..=100.0 - theme::END_NAME / 2.0).contains(y))
            );
        }
    }

    #[test]
    fn a_name_with_room_stands_where_its_line_ends() {
        let mut heights = vec![20.0, 50.0, 80.0];
        spread(&mut heights, (0.0, 100.0));
        assert_eq!(heights, [20.0, 50.0, 80.0]);
    }

    #[test]
    fn in_little_room_names_come_closer_and_stay_inside() {
        let mut heights = vec![10.0; 6];
        assert!(spread(&mut heights, (0.0, 36.0)) < theme::END_NAME);
        let pairs = heights.iter().zip(heights.iter().skip(1));
        assert!(
            pairs.clone().all(|(one, two)| two - one > 5.9),
            "{heights:?}"
        );
        assert!(heights.iter().all(|y| (0.0..=36.0).contains(y)));
    }
}
