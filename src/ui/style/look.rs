//! Colours and language of a frame, and sentences in that language.

use crate::app::notices::Level;
use crate::app::poses::PoseState;
use crate::app::readings::Freshness;
use crate::app::settings::Language;
use crate::app::state::State;
use crate::hand::kinematics::Side;
use crate::poses::library::EntryId;
use crate::ui::style::Text;
use crate::ui::theme::Palette;
use egui::Color32;
use std::fmt::Display;

/// Colours, language and hand of this frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look {
    pub(crate) palette: &'static Palette,
    pub(crate) language: Language,
    /// Side of the drawn hand.
    pub(crate) side: Side,
}

impl Look {
    /// From the settings and the shown hand.
    pub(crate) fn of(state: &State) -> Self {
        Self {
            palette: Palette::of(state.settings.theme),
            language: state.settings.language,
            side: state.hand().side,
        }
    }

    /// A text in the window's language.
    pub(crate) const fn tr(self, text: Text) -> &'static str {
        text.of(self.language)
    }

    /// The sentence, followed by `more`.
    pub(crate) fn tr_with(self, text: Text, more: impl Display) -> String {
        format!("{} {more}", self.tr(text))
    }

    /// Name of a library entry in the window's language.
    pub(crate) fn entry_name(self, poses: &PoseState, entry: EntryId) -> &str {
        match (poses.named(entry), self.language) {
            (Some(names), Language::Zh) if !names.zh.is_empty() => names.zh,
            (Some(names), _) => names.text,
            (None, _) => "",
        }
    }

    /// Colour of a message.
    pub(crate) const fn level(self, level: Level) -> Color32 {
        match level {
            Level::Info => self.palette.accent,
            Level::Warn => self.palette.warn,
            Level::Alarm => self.palette.bad,
        }
    }

    /// The tooltip of a control in the window's language.
    pub(crate) const fn tip(self, text: Text) -> &'static str {
        self.tr(text.tip())
    }

    /// A name and its description, separated by the language's colon.
    pub(crate) fn pair(self, name: &str, description: &str) -> String {
        let colon = match self.language {
            Language::En => ": ",
            Language::Zh => "：",
        };
        format!("{name}{colon}{description}")
    }

    /// A sentence in the window's language with these parts inserted.
    pub(crate) fn fill(self, text: Text, parts: &[&dyn Display]) -> String {
        text.fill(self.language, parts)
    }

    /// Joins names with the language's separator.
    pub(crate) fn list<N: AsRef<str>>(self, names: &[N]) -> String {
        let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        names.join(match self.language {
            Language::En => ", ",
            Language::Zh => "、",
        })
    }

    /// Colour of a value: `live` if it is fresh, else faint.
    pub(crate) fn value(self, freshness: Freshness, live: Color32) -> Color32 {
        match freshness {
            Freshness::Live => live,
            Freshness::Stale | Freshness::Unknown => self.palette.faint,
        }
    }
}
