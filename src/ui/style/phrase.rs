//! A sentence in all languages of the window. The sentences themselves are in `ui::text`.

use crate::app::settings::Language;
use std::fmt::Display;

/// A sentence in all languages, and for a control the tooltip that explains it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Text {
    /// English.
    pub(crate) en: &'static str,
    pub(crate) zh: &'static str,
    /// Tooltip in both languages, empty without one.
    tip: [&'static str; 2],
}

impl Text {
    /// A sentence without a tooltip.
    pub(crate) const fn new(en: &'static str, zh: &'static str) -> Self {
        let tip = ["", ""];
        Self { en, zh, tip }
    }

    /// Adds a tooltip.
    pub(crate) const fn with_tip(self, en: &'static str, zh: &'static str) -> Self {
        let tip = [en, zh];
        Self { tip, ..self }
    }

    /// The tooltip as a sentence of its own.
    pub(crate) const fn tip(self) -> Self {
        let [en, zh] = self.tip;
        Self::new(en, zh)
    }

    /// The sentence in one language.
    pub(crate) const fn of(self, language: Language) -> &'static str {
        match language {
            Language::En => self.en,
            Language::Zh => self.zh,
        }
    }

    /// Replaces each `{}` of the sentence by these parts, in order.
    pub(crate) fn fill(self, language: Language, parts: &[&dyn Display]) -> String {
        let mut pieces = self.of(language).split("{}");
        let first = pieces.next().unwrap_or_default().to_owned();
        let rest = parts.iter().zip(pieces);
        rest.fold(first, |text, (part, piece)| format!("{text}{part}{piece}"))
    }
}

/// Writes a table of sentences as constants, then functions that return the text of each value of a type, and a list of all
/// texts for the tests. A row holds English and Chinese, and for a control its tooltip in both.
macro_rules! texts {
    (
        $($name:ident: $en:literal, $zh:literal $(, $tip_en:literal, $tip_zh:literal)?;)*
        $(
            $(#[$doc:meta])+
            fn $of:ident($type:ty) { $($value:pat => $of_en:literal, $of_zh:literal $(, $of_tip_en:literal, $of_tip_zh:literal)?;)* }
        )*
    ) => {
        $(
            #[doc = $en]
            pub(crate) const $name: $crate::ui::style::Text = $crate::ui::style::Text::new($en, $zh)$(.with_tip($tip_en, $tip_zh))?;
        )*
        $(
            $(#[$doc])+
            pub(crate) fn $of(of: $type) -> $crate::ui::style::Text {
                match of {
                    $($value => $crate::ui::style::Text::new($of_en, $of_zh)$(.with_tip($of_tip_en, $of_tip_zh))?,)*
                }
            }
        )*
        #[cfg(test)]
        pub(crate) const ALL: &[$crate::ui::style::Text] = &[$($name,)* $($($crate::ui::style::Text::new($of_en, $of_zh)$(.with_tip($of_tip_en, $of_tip_zh))?,)*)*];
    };
}
pub(crate) use texts;

#[cfg(test)]
mod tests {
    use crate::ui::style::phrase::Text;
    use crate::ui::text::{
        cards, checkup, device, exhibit, hold, inputs, main, notices, panels, poses, recordings,
        scan, traffic, tune, window,
    };

    fn all() -> impl Iterator<Item = Text> {
        let lists = [
            cards::ALL,
            checkup::ALL,
            device::ALL,
            exhibit::ALL,
            hold::ALL,
            tune::search::ALL,
            notices::ALL,
            inputs::ALL,
            main::ALL,
            panels::ALL,
            poses::ALL,
            scan::ALL,
            traffic::ALL,
            recordings::ALL,
            tune::ALL,
            window::ALL,
        ];
        let texts = lists.into_iter().flatten().copied();
        let all = texts.flat_map(|text| [text, text.tip()]);
        all.filter(|text| *text != Text::new("", ""))
    }

    #[test]
    fn no_sentence_lacks_a_language() {
        for text in all() {
            assert!(!text.en.is_empty() && !text.zh.is_empty(), "{text:?}");
            let parts = |sentence: &str| sentence.matches("{}").count();
            assert_eq!(parts(text.en), parts(text.zh), "{text:?}");
            assert!(
                text.en.is_ascii() || text.en.contains(['°', '±', '≠']),
                "{text:?}"
            );
        }
    }

    #[test]
    fn every_chinese_character_is_in_the_font() {
        let known = include_str!("../../../assets/fonts/characters.txt");
        for text in all() {
            let signs = text.zh.chars();
            for sign in signs.filter(|sign| !sign.is_ascii() && !['°', '≠'].contains(sign)) {
                assert!(known.contains(sign), "{sign} in {}", text.zh);
            }
        }
    }
}
