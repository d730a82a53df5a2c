//! Converts tactile counts to heat, on one fixed scale for all fingers. Draws only the scale.

use crate::app::readings::Freshness;
use crate::hand::{Finger, PerFinger};
use crate::ui::hand::fingertip::{Sense, Tip};
use crate::ui::kit::{Label, Pane};
use crate::ui::text::panels;
use egui::{CornerRadius, Rect, Ui, vec2};

/// Counts above zero at the hottest colour: about a firm grip of 15 N on one pad.
const FULL_COUNTS: i64 = 250_000;
/// End of the sensor's scale, in counts.
const MOST_COUNTS: u32 = 1 << 24;
/// Number of steps in the drawn scale.
const STEPS: u8 = 16;

/// Pictures of all fingertips; `None` for those never read.
pub(crate) fn tips(pane: &Pane<'_>) -> PerFinger<Option<Tip>> {
    PerFinger::from_fn(|finger| tip(pane, finger))
}

/// Draws the scale with its range, from right to left; or that a fingertip has no zero.
pub(crate) fn scale_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let range = look.fill(panels::TOUCH_SCALE, &[&(FULL_COUNTS / 1000)]);
    let range = Label::new(&range, look.palette.muted).small();
    let range = range.named(look.tr(panels::TOUCH_SCALE_END)).ui(ui);
    range.on_hover_text(look.tip(panels::TOUCH));
    let (_, bar) = ui.allocate_space(egui::vec2(64.0, 8.0));
    let width = bar.width() / f32::from(STEPS);
    for step in 0..STEPS {
        let left = bar.left_top() + vec2(width * f32::from(step), 0.0);
        let piece = Rect::from_min_size(left, vec2(width + 0.5, bar.height()));
        let color = look.palette.heat(f32::from(step) / f32::from(STEPS - 1));
        ui.painter().rect_filled(piece, CornerRadius::ZERO, color);
    }
    no_zero_ui(ui, pane);
}

/// Draws a note if a fingertip has no zero yet.
pub(crate) fn no_zero_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, hand) = (pane.look, pane.hand());
    let touched = Finger::ALL.into_iter().any(|finger| {
        hand.readings.sample.tactile[finger].is_some() && hand.readings.tare.zero(finger).is_none()
    });
    if touched {
        let label = Label::new(look.tr(panels::TOUCH_NO_ZERO), look.palette.warn);
        let label = label.small().ui(ui);
        label.on_hover_text(look.tip(panels::TOUCH_NO_ZERO));
    }
}

/// Picture of one fingertip; `None` if it was never read.
pub(crate) fn tip(pane: &Pane<'_>, finger: Finger) -> Option<Tip> {
    let block = pane.hand().readings.sample.tactile[finger]?.value;
    let mut heat = [None; 8];
    if let Some(zero) = pane.hand().readings.tare.zero(finger) {
        for ((heat, raw), zero) in heat.iter_mut().zip(block.raw).zip(zero.raw) {
            *heat = known(raw).then(|| part(raw, zero));
        }
    }
    Some(Tip {
        heat,
        normal_n: block.normal(),
        shear: block.tangential().zip(block.direction_deg().map(f32::from)),
        proximity: Some(counts_of(i64::from(block.proximity))),
        stale: pane.tip_freshness(finger) != Freshness::Live,
        sense: Sense::of(block.normal_n, block.tangential_n),
    })
}

/// True if a channel has a valid value: a live one rests near 3 million counts and never exceeds [`MOST_COUNTS`].
const fn known(raw: u32) -> bool {
    raw > 0 && raw <= MOST_COUNTS
}

/// Heat of a channel, 0..=1. Uses the square root, so that a light touch is visible beside a firm grip.
fn part(raw: u32, zero: u32) -> f32 {
    let above = counts_of(i64::from(raw) - i64::from(zero)).max(0.0);
    (above / counts_of(FULL_COUNTS)).sqrt().min(1.0)
}

fn counts_of(value: i64) -> f32 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "only its place on a colour scale matters"
    )]
    let float = value as f32;
    float
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dead_or_overflowing_channel_has_no_heat() {
        assert!(known(3_000_000) && known(1));
        assert!(!known(0) && !known(u32::MAX));
    }

    #[test]
    fn heat_grows_from_the_zero_to_the_end_of_a_scale_that_stays() {
        assert_eq!(part(3_000_000, 3_000_000), 0.0);
        assert_eq!(part(2_900_000, 3_000_000), 0.0);
        assert!(part(3_010_000, 3_000_000) > 0.15);
        assert_eq!(part(3_250_000, 3_000_000), 1.0);
        assert_eq!(part(3_900_000, 3_000_000), 1.0);
    }
}
