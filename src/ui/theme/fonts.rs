//! All font sizes, and the fonts and icons behind them. No colours.

use egui::{FontFamily, FontId};

/// Labels, units, hints, and narrow places.
pub(crate) const fn small() -> FontId {
    FontId::proportional(12.0)
}

/// Body text, titles of cards, and buttons.
pub(crate) const fn body() -> FontId {
    FontId::proportional(14.0)
}

/// What is read first in a view: a state, the title of a dialog or an empty page, the stop button.
pub(crate) const fn large() -> FontId {
    FontId::proportional(20.0)
}

/// Numbers, with digits of equal width.
pub(crate) const fn number() -> FontId {
    FontId::monospace(13.0)
}

/// Icons inside buttons.
pub(crate) fn icon() -> FontId {
    icon_of(16.0)
}

/// An icon about this high, in points.
pub(crate) fn icon_high(height: f32) -> FontId {
    // The icons leave a margin within their square.
    icon_of(height * 1.3)
}

fn icon_of(size: f32) -> FontId {
    FontId::new(
        size,
        FontFamily::Name(egui_material_icons::FONT_FAMILY_OUTLINED.into()),
    )
}

/// The fonts: egui's own, then the symbols of Hack, then Chinese.
pub(crate) fn fonts() -> egui::FontDefinitions {
    const CHINESE: &str = "NotoSansSC";
    let mut fonts = egui::FontDefinitions::default();
    let bytes: &'static [u8] = include_bytes!("../../../assets/fonts/NotoSansSC-subset.otf");
    let mut chinese = egui::FontData::from_static(bytes);
    // Han characters sit lower than adjacent Latin letters.
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
    add_icons(&mut fonts);
    fonts
}

/// Adds the icons as a family of their own: an icon must never replace a missing letter.
fn add_icons(fonts: &mut egui::FontDefinitions) {
    const ICONS: &str = "MaterialSymbols";
    let insert = egui_material_icons::font_insert();
    fonts
        .font_data
        .insert(ICONS.into(), std::sync::Arc::new(insert.data));
    let family = FontFamily::Name(egui_material_icons::FONT_FAMILY_OUTLINED.into());
    fonts.families.insert(family, vec![ICONS.into()]);
}

#[cfg(test)]
mod tests {
    use crate::ui::theme::{fonts, icons};
    use egui::epaint::text::{Fonts, TextOptions};

    #[test]
    fn every_sign_is_in_the_icon_font() {
        let mut all = Fonts::new(TextOptions::default(), fonts::fonts());
        let mut view = all.with_pixels_per_point(1.0);
        for sign in icons::ALL {
            assert!(view.has_glyphs(&fonts::icon(), sign), "{sign:?}");
        }
        assert!(!view.has_glyphs(&fonts::icon(), "\u{1F600}"));
    }

    #[test]
    fn digits_signs_and_gaps_of_numbers_are_equally_wide() {
        let mut all = Fonts::new(TextOptions::default(), fonts::fonts());
        for scale in [1.0, 1.5, 3.0] {
            let mut view = all.with_pixels_per_point(scale);
            let font = fonts::number();
            let zero = view.glyph_width(&font, '0');
            assert!(zero > 0.0);
            for sign in "123456789-+. ".chars() {
                let width = view.glyph_width(&font, sign);
                assert!(
                    (width - zero).abs() < 1e-3,
                    "{sign} at {scale}: {width}, {zero}"
                );
            }
        }
    }

    #[test]
    fn there_are_three_levels_of_type() {
        let sizes = [fonts::large(), fonts::body(), fonts::small()].map(|font| font.size);
        assert_eq!(sizes, [20.0, 14.0, 12.0]);
        // Digits of equal width look larger than letters of their size.
        assert_eq!(fonts::number().size, 13.0);
    }
}
