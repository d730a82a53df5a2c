//! From tactile counts to heat: one scale for all fingers, automatic or locked. Draws only the scale.

use crate::app::hand::Freshness;
use crate::hand::{Finger, PerFinger, TactileBlock};
use crate::ui::kit::controls;
use crate::ui::kit::controls::Label;
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::panels;
use crate::ui::theme;
use crate::ui::touch::fingertip::{Sense, Tip};
use egui::{CornerRadius, Rect, Ui, pos2, vec2};

/// Counts above rest at which a pad is hottest, at least: below this, noise would look like touch.
const HEAT_FLOOR_COUNTS: f32 = 20_000.0;
/// The scale of the sensor ends here, in counts.
const MOST_COUNTS: u32 = 1 << 24;
/// Steps in which the scale's bar is drawn.
const STEPS: u8 = 16;

/// The scale of the heat.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct HeatScale {
    /// Counts of the hottest colour, if a person keeps them where they are.
    pub(crate) locked: Option<f32>,
}

impl HeatScale {
    /// Counts above rest of the hottest colour, the same for all fingers.
    pub(crate) fn full(self, pane: &Pane<'_>) -> f32 {
        self.locked.unwrap_or_else(|| automatic(pane))
    }

    /// What is drawn of each fingertip; none where it was never read.
    pub(crate) fn tips(self, pane: &Pane<'_>) -> PerFinger<Option<Tip>> {
        let full = self.full(pane);
        PerFinger::from_fn(|finger| {
            let block = pane.state.hand().sample.tactile[finger]?;
            Some(Tip {
                stale: pane.state.hand().tip_freshness(finger) != Freshness::Live,
                ..tip(pane, finger, &block.value, full)
            })
        })
    }

    /// The scale with its end, at the right of a title.
    pub(crate) fn ui(self, ui: &mut Ui, head: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let mut rest = head;
        let end = format::counts(Some(whole(self.full(pane))));
        let width = controls::text_width(ui, &end, theme::small());
        let end_place = controls::take_right(&mut rest, width + 1.0);
        Label::new(&end, look.palette.faint)
            .small()
            .right()
            .named(look.say(panels::TOUCH_SCALE_END))
            .put(ui, end_place);
        let bar = controls::middle(
            controls::take_right(&mut rest, theme::HEAT_BAR.x),
            theme::HEAT_BAR.y,
        );
        let width = bar.width() / f32::from(STEPS);
        for step in 0..STEPS {
            let left = bar.left() + width * f32::from(step);
            let piece = Rect::from_min_size(pos2(left, bar.top()), vec2(width + 0.5, bar.height()));
            let color = look.palette.heat(f32::from(step) / f32::from(STEPS - 1));
            ui.painter().rect_filled(piece, CornerRadius::ZERO, color);
        }
        let chosen = pane.state.hand().tare.chosen_at();
        let text = chosen.map_or_else(
            || look.say(panels::TOUCH_SCALE).to_owned(),
            |at| {
                let age = format::age(pane.state.now.since(at));
                format!("{} {age}", look.say(panels::TOUCH_SCALE_TARED))
            },
        );
        Label::new(&text, look.palette.faint)
            .small()
            .right()
            .shorter(look.say(panels::TOUCH_SCALE_SHORT))
            .put(ui, rest);
    }
}

fn automatic(pane: &Pane<'_>) -> f32 {
    let mut full = HEAT_FLOOR_COUNTS;
    for (finger, block) in pane.state.hand().sample.tactile.iter() {
        let (Some(block), Some(rest)) = (block, pane.state.hand().tare.rest(finger)) else {
            continue;
        };
        for (raw, rest) in block.value.raw.into_iter().zip(rest.raw) {
            if known(raw) {
                full = full.max(above(raw, rest));
            }
        }
    }
    // Steps of a fifth of a decade, so that the colours do not breathe with every reading.
    let step = 10.0_f32.powf((full.log10() * 5.0).ceil() / 5.0);
    step.max(HEAT_FLOOR_COUNTS)
}

fn tip(pane: &Pane<'_>, finger: Finger, block: &TactileBlock, full: f32) -> Tip {
    let rest = pane.state.hand().tare.rest(finger);
    let rest = rest.map_or(block.raw, |rest| rest.raw);
    let mut heat = [None; 8];
    for ((heat, raw), rest) in heat.iter_mut().zip(block.raw).zip(rest) {
        *heat = known(raw).then(|| above(raw, rest) / full);
    }
    Tip {
        heat,
        normal_n: block.normal(),
        shear: block.tangential().zip(block.direction_deg().map(f32::from)),
        proximity: Some(counts_of(i64::from(block.proximity))),
        stale: false,
        sense: Sense::of(block.normal_n, block.tangential_n),
    }
}

/// Whether a channel says something: a live one rests near 3 million counts and ends below this.
const fn known(raw: u32) -> bool {
    raw > 0 && raw <= MOST_COUNTS
}

fn above(raw: u32, rest: u32) -> f32 {
    counts_of(i64::from(raw) - i64::from(rest)).max(0.0)
}

fn counts_of(value: i64) -> f32 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "only its place on a colour scale matters"
    )]
    let float = value as f32;
    float
}

fn whole(value: f32) -> i64 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a float cast is cut to the range"
    )]
    let whole = value as i64;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dead_or_overflowing_channel_has_no_heat() {
        assert!(known(3_000_000) && known(1));
        assert!(!known(0) && !known(u32::MAX));
    }
}
