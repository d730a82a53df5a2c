//! Every colour and size of the window, dark and light. Nothing here knows what is drawn with them.

use crate::app::settings::Theme;
use crate::hand::PerDof;
use egui::style::{Selection, WidgetVisuals};
use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, Style, TextStyle, vec2};

/// Space between cards, and the step of the grid twice.
pub(crate) const GAP: f32 = 8.0;
/// Half a gap: the step of the grid.
pub(crate) const STEP: f32 = 4.0;
/// Space inside a card.
pub(crate) const PAD: f32 = 12.0;
/// Height of the top bar.
pub(crate) const TOP_BAR: f32 = 56.0;
/// Height of the row of tabs.
pub(crate) const TABS: f32 = 36.0;
/// Height of a banner.
pub(crate) const BANNER: f32 = 44.0;
/// Height of a button or field.
pub(crate) const CONTROL: f32 = 24.0;
/// Height of a button that matters.
pub(crate) const CONTROL_LARGE: f32 = 32.0;
/// Corner radius of cards.
pub(crate) const ROUND: u8 = 8;
/// Corner radius of controls.
pub(crate) const ROUND_SMALL: u8 = 5;
/// Radius of a status lamp.
pub(crate) const LAMP: f32 = 4.0;
/// Width of a plotted line.
pub(crate) const LINE: f32 = 1.4;

/// All colours of one theme, by what they are for.
#[derive(Debug)]
pub(crate) struct Palette {
    /// Behind everything.
    pub(crate) window: Color32,
    /// Cards and bars.
    pub(crate) card: Color32,
    /// Buttons at rest.
    pub(crate) control: Color32,
    /// Buttons under the pointer.
    pub(crate) control_hover: Color32,
    /// Fields, rails, plot grounds.
    pub(crate) sunken: Color32,
    /// Edges of cards and fields.
    pub(crate) edge: Color32,
    /// Lines of a plot's grid.
    pub(crate) grid: Color32,
    /// Text.
    pub(crate) text: Color32,
    /// Labels beside values.
    pub(crate) muted: Color32,
    /// Old values, disabled controls, hints.
    pub(crate) faint: Color32,
    /// The one colour for "chosen" and "focused".
    pub(crate) accent: Color32,
    /// Text on [`Self::accent`], [`Self::stop`], [`Self::armed`].
    pub(crate) on_strong: Color32,
    /// All is well.
    pub(crate) ok: Color32,
    /// Look at it.
    pub(crate) warn: Color32,
    /// Act on it.
    pub(crate) bad: Color32,
    /// The built-in hand, and nothing else.
    pub(crate) simulated: Color32,
    /// Text on [`Self::simulated`].
    pub(crate) on_simulated: Color32,
    /// Setpoints pass.
    pub(crate) armed: Color32,
    /// Text on [`Self::armed`].
    pub(crate) on_armed: Color32,
    /// The stop button.
    pub(crate) stop: Color32,
    /// The stop button under the pointer.
    pub(crate) stop_hover: Color32,
    /// The stop button's edge.
    pub(crate) stop_edge: Color32,
    /// The handle of a track.
    pub(crate) handle: Color32,
    /// The dot in a handle.
    pub(crate) handle_dot: Color32,
    /// The skin of a drawn fingertip.
    pub(crate) skin: Color32,
    /// The fingers and palm of the drawn hand in half light.
    pub(crate) limb: Color32,
    /// The same in full light.
    pub(crate) limb_lit: Color32,
    /// Their edges.
    pub(crate) limb_edge: Color32,
    /// The shear arrow over the heat.
    pub(crate) arrow: Color32,
    /// The six joints; told apart by all common kinds of colour blindness.
    pub(crate) dof: PerDof<Color32>,
    /// True for light on dark.
    dark: bool,
}

/// Light on dark.
static DARK: Palette = Palette {
    window: Color32::from_rgb(0x0E, 0x11, 0x15),
    card: Color32::from_rgb(0x16, 0x1A, 0x20),
    control: Color32::from_rgb(0x23, 0x2A, 0x33),
    control_hover: Color32::from_rgb(0x2E, 0x37, 0x42),
    sunken: Color32::from_rgb(0x0F, 0x13, 0x18),
    edge: Color32::from_rgb(0x29, 0x30, 0x3A),
    grid: Color32::from_rgb(0x21, 0x27, 0x30),
    text: Color32::from_rgb(0xE8, 0xEC, 0xF2),
    muted: Color32::from_rgb(0xA2, 0xAC, 0xBA),
    faint: Color32::from_rgb(0x6B, 0x76, 0x85),
    accent: Color32::from_rgb(0x4C, 0x9B, 0xFF),
    on_strong: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    ok: Color32::from_rgb(0x43, 0xC4, 0x82),
    warn: Color32::from_rgb(0xF2, 0xB5, 0x3A),
    bad: Color32::from_rgb(0xFF, 0x65, 0x69),
    simulated: Color32::from_rgb(0xB5, 0x8C, 0xFF),
    on_simulated: Color32::from_rgb(0x1A, 0x10, 0x2E),
    armed: Color32::from_rgb(0xF2, 0xB5, 0x3A),
    on_armed: Color32::from_rgb(0x24, 0x1A, 0x04),
    stop: Color32::from_rgb(0xD6, 0x2D, 0x3A),
    stop_hover: Color32::from_rgb(0xEA, 0x3F, 0x4B),
    stop_edge: Color32::from_rgb(0xFF, 0x7A, 0x80),
    handle: Color32::from_rgb(0xE8, 0xEC, 0xF2),
    handle_dot: Color32::from_rgb(0x16, 0x1A, 0x20),
    skin: Color32::from_rgb(0x1E, 0x24, 0x2D),
    limb: Color32::from_rgb(0x2B, 0x33, 0x3E),
    limb_lit: Color32::from_rgb(0x4E, 0x5A, 0x69),
    limb_edge: Color32::from_rgb(0x56, 0x62, 0x72),
    arrow: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    dof: PerDof::new([
        Color32::from_rgb(0x5A, 0xB4, 0xE8),
        Color32::from_rgb(0xE8, 0xA0, 0x20),
        Color32::from_rgb(0x2F, 0xC0, 0x96),
        Color32::from_rgb(0xEE, 0xE2, 0x5A),
        Color32::from_rgb(0xF0, 0x78, 0x4A),
        Color32::from_rgb(0xD8, 0x8A, 0xC0),
    ]),
    dark: true,
};

/// Dark on light.
static LIGHT: Palette = Palette {
    window: Color32::from_rgb(0xEC, 0xEF, 0xF3),
    card: Color32::from_rgb(0xFC, 0xFD, 0xFE),
    control: Color32::from_rgb(0xE6, 0xEA, 0xF0),
    control_hover: Color32::from_rgb(0xD9, 0xDF, 0xE7),
    sunken: Color32::from_rgb(0xF1, 0xF4, 0xF7),
    edge: Color32::from_rgb(0xD3, 0xDA, 0xE2),
    grid: Color32::from_rgb(0xE2, 0xE7, 0xED),
    text: Color32::from_rgb(0x16, 0x1C, 0x24),
    muted: Color32::from_rgb(0x4E, 0x5A, 0x69),
    faint: Color32::from_rgb(0x86, 0x91, 0x9F),
    accent: Color32::from_rgb(0x1C, 0x6F, 0xD8),
    on_strong: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    ok: Color32::from_rgb(0x16, 0x8A, 0x52),
    warn: Color32::from_rgb(0xA8, 0x6C, 0x00),
    bad: Color32::from_rgb(0xC8, 0x22, 0x2E),
    simulated: Color32::from_rgb(0x76, 0x42, 0xD0),
    on_simulated: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    armed: Color32::from_rgb(0xF0, 0xA8, 0x1E),
    on_armed: Color32::from_rgb(0x24, 0x1A, 0x04),
    stop: Color32::from_rgb(0xD0, 0x22, 0x30),
    stop_hover: Color32::from_rgb(0xB6, 0x18, 0x26),
    stop_edge: Color32::from_rgb(0x96, 0x10, 0x1C),
    handle: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    handle_dot: Color32::from_rgb(0x4E, 0x5A, 0x69),
    skin: Color32::from_rgb(0xE4, 0xE9, 0xEF),
    limb: Color32::from_rgb(0xD3, 0xDA, 0xE3),
    limb_lit: Color32::from_rgb(0xF4, 0xF7, 0xFA),
    limb_edge: Color32::from_rgb(0xA4, 0xB0, 0xBE),
    arrow: Color32::from_rgb(0x10, 0x14, 0x1A),
    dof: PerDof::new([
        Color32::from_rgb(0x00, 0x72, 0xB2),
        Color32::from_rgb(0xC2, 0x7A, 0x00),
        Color32::from_rgb(0x00, 0x8A, 0x66),
        Color32::from_rgb(0x8C, 0x80, 0x00),
        Color32::from_rgb(0xC8, 0x4A, 0x10),
        Color32::from_rgb(0xA8, 0x4A, 0x86),
    ]),
    dark: false,
};

impl Palette {
    /// The colours of a theme.
    pub(crate) fn of(theme: Theme) -> &'static Self {
        match theme {
            Theme::Dark => &DARK,
            Theme::Light => &LIGHT,
        }
    }

    /// A weak wash of a colour over a card.
    pub(crate) fn wash(&self, color: Color32) -> Color32 {
        color.gamma_multiply(if self.dark { 0.16 } else { 0.12 })
    }

    /// A colour of the heat scale; `level` is 0..=1 and is cut to it.
    pub(crate) fn heat(&self, level: f32) -> Color32 {
        let level = f64::from(level.clamp(0.0, 1.0));
        // Rest must look calm on both grounds: dark on the dark skin, pale on the light one.
        let color = if self.dark {
            colorous::INFERNO.eval_continuous(0.12 + 0.88 * level)
        } else {
            colorous::YELLOW_ORANGE_RED.eval_continuous(level)
        };
        Color32::from_rgb(color.r, color.g, color.b)
    }
}

/// Labels, hints.
pub(crate) const fn small() -> FontId {
    FontId::proportional(11.5)
}

/// Hints inside a button.
pub(crate) const fn tiny() -> FontId {
    FontId::proportional(10.5)
}

/// Running text and buttons.
pub(crate) const fn body() -> FontId {
    FontId::proportional(13.0)
}

/// Titles of cards.
pub(crate) const fn title() -> FontId {
    FontId::proportional(14.5)
}

/// The stop button, the badge of a state.
pub(crate) const fn large() -> FontId {
    FontId::proportional(17.0)
}

/// Numbers, all digits of one width.
pub(crate) const fn number() -> FontId {
    FontId::monospace(12.0)
}

/// Numbers where room is short.
pub(crate) const fn number_small() -> FontId {
    FontId::monospace(10.5)
}

/// egui's own widgets in this theme. Keeps what moves by itself as it was `before`.
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
        (TextStyle::Heading, title()),
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

/// The fonts: egui's own, then the signs of Hack, then Chinese.
pub(crate) fn fonts() -> egui::FontDefinitions {
    const CHINESE: &str = "NotoSansSC";
    let mut fonts = egui::FontDefinitions::default();
    let bytes: &'static [u8] = include_bytes!("../../assets/fonts/NotoSansSC-subset.otf");
    let mut chinese = egui::FontData::from_static(bytes);
    // Han signs hang lower than the Latin letters they stand beside.
    chinese.tweak.y_offset_factor = -0.06;
    fonts
        .font_data
        .insert(CHINESE.into(), std::sync::Arc::new(chinese));
    for (family, extra) in [
        (FontFamily::Proportional, &["Hack", CHINESE][..]),
        (FontFamily::Monospace, &[CHINESE][..]),
    ] {
        let names = fonts.families.entry(family).or_default();
        for name in extra {
            if !names.iter().any(|known| known == name) {
                names.push((*name).into());
            }
        }
    }
    fonts
}
