//! egui's own widgets in this program's colours and sizes.

use crate::app::settings::Theme;
use crate::ui::theme::fonts::{body, large, number, small};
use crate::ui::theme::palette::Palette;
use crate::ui::theme::sizes::{CONTROL, GAP, ROUND, ROUND_SMALL, STEP};
use egui::style::{Selection, WidgetVisuals};
use egui::{Color32, CornerRadius, Margin, Stroke, Style, TextStyle, vec2};

/// Style of egui's own widgets in this theme. Animation settings are copied from `before`.
pub(crate) fn style(theme: Theme, before: &Style) -> Style {
    let palette = Palette::of(theme);
    let mut style = Style {
        visuals: match theme {
            Theme::Dark => egui::Visuals::dark(),
            Theme::Light => egui::Visuals::light(),
        },
        animation_time: before.animation_time,
        ..Style::default()
    };
    style.text_styles = [
        (TextStyle::Small, small()),
        (TextStyle::Body, body()),
        (TextStyle::Button, body()),
        (TextStyle::Monospace, number()),
        (TextStyle::Heading, large()),
    ]
    .into();
    spacing(&mut style);
    visuals(&mut style, palette);
    style.visuals.text_cursor.blink = before.visuals.text_cursor.blink;
    style
}

fn spacing(style: &mut Style) {
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(GAP, STEP);
    spacing.button_padding = vec2(GAP, STEP);
    spacing.interact_size = vec2(32.0, CONTROL);
    spacing.window_margin = Margin::same(12);
    spacing.menu_margin = Margin::same(6);
    spacing.tooltip_width = 340.0;
    spacing.scroll.floating = true;
    style.interaction.tooltip_delay = 0.35;
    style.interaction.selectable_labels = false;
}

fn visuals(style: &mut Style, palette: &Palette) {
    let visuals = &mut style.visuals;
    visuals.panel_fill = palette.window;
    visuals.window_fill = palette.card;
    visuals.window_stroke = Stroke::new(1.0, palette.edge);
    visuals.window_corner_radius = CornerRadius::same(ROUND);
    visuals.menu_corner_radius = CornerRadius::same(ROUND_SMALL);
    visuals.extreme_bg_color = palette.sunken;
    visuals.text_edit_bg_color = Some(palette.sunken);
    visuals.faint_bg_color = palette.sunken;
    visuals.override_text_color = Some(palette.text);
    visuals.weak_text_color = Some(palette.muted);
    visuals.warn_fg_color = palette.warn;
    visuals.error_fg_color = palette.bad;
    visuals.hyperlink_color = palette.accent;
    visuals.selection = Selection {
        bg_fill: palette.accent.gamma_multiply(0.45),
        stroke: Stroke::new(1.0, palette.accent),
    };
    let widget = |fill: Color32, edge: Color32, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, edge),
        corner_radius: CornerRadius::same(ROUND_SMALL),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    visuals.widgets.noninteractive = widget(palette.card, palette.edge, palette.muted);
    visuals.widgets.inactive = widget(palette.control, palette.edge, palette.text);
    visuals.widgets.hovered = widget(palette.control_hover, palette.faint, palette.text);
    visuals.widgets.active = widget(palette.control_hover, palette.accent, palette.text);
    visuals.widgets.open = widget(palette.control_hover, palette.faint, palette.text);
}
