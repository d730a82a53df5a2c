//! What every part of the window is given: the state, the colours, the language, and where to put actions.

use crate::app::action::Action;
use crate::app::hand::Freshness;
use crate::app::notices::Level;
use crate::app::poses::PoseState;
use crate::app::settings::Language;
use crate::app::state::State;
use crate::hand::kinematics::Side;
use crate::hand::{Dof, Moment, PerDof, Timed};
use crate::poses::library::EntryId;
use crate::record::ArmRefusal;
use crate::ui::text::{Text, inputs, main};
use crate::ui::theme::Palette;
use crate::ui::view::View;
use egui::{Color32, Id};
use std::fmt::Display;

/// Colours, language and hand of this frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look {
    /// Colours.
    pub(crate) palette: &'static Palette,
    /// Language.
    pub(crate) language: Language,
    /// The hand that is drawn.
    pub(crate) side: Side,
}

impl Look {
    /// As the settings and the shown hand say.
    pub(crate) fn of(state: &State) -> Self {
        Self {
            palette: Palette::of(state.settings.theme),
            language: state.settings.language,
            side: state.hand().side,
        }
    }

    /// A text in the window's language.
    pub(crate) const fn say(self, text: Text) -> &'static str {
        text.of(self.language)
    }

    /// The sentence with this behind it.
    pub(crate) fn told(self, text: Text, more: impl Display) -> String {
        format!("{} {more}", self.say(text))
    }

    /// What an entry of the library is called in the window's language.
    pub(crate) fn entry_name(self, poses: &PoseState, entry: EntryId) -> &str {
        match (poses.named(entry), self.language) {
            (Some(names), Language::Zh) if !names.zh.is_empty() => names.zh,
            (Some(names), _) => names.text,
            (None, _) => "",
        }
    }

    /// The colour of a message.
    pub(crate) const fn level(self, level: Level) -> Color32 {
        match level {
            Level::Info => self.palette.accent,
            Level::Warn => self.palette.warn,
            Level::Alarm => self.palette.bad,
        }
    }

    /// The name of a control and its tooltip or hint in the window's language.
    pub(crate) const fn both(self, text: Text) -> (&'static str, &'static str) {
        (self.say(text), self.tip(text))
    }

    /// The tooltip of a control in the window's language.
    pub(crate) const fn tip(self, text: Text) -> &'static str {
        self.say(text.tip())
    }

    /// A name and what is said of it, with the colon of the language.
    pub(crate) fn pair(self, name: &str, said: &str) -> String {
        let colon = match self.language {
            Language::En => ": ",
            Language::Zh => "：",
        };
        format!("{name}{colon}{said}")
    }

    /// A sentence in the window's language with these parts in it.
    pub(crate) fn fill(self, text: Text, parts: &[&dyn Display]) -> String {
        text.fill(self.language, parts)
    }

    /// Names after each other.
    pub(crate) fn list(self, names: &[&str]) -> String {
        names.join(match self.language {
            Language::En => ", ",
            Language::Zh => "、",
        })
    }

    /// The colour of a value of this freshness that would be `live`.
    pub(crate) fn value(self, freshness: Freshness, live: Color32) -> Color32 {
        match freshness {
            Freshness::Live => live,
            Freshness::Stale | Freshness::Unknown => self.palette.faint,
        }
    }
}

/// One pass over one part of the window.
pub(crate) struct Pane<'a> {
    /// What is shown.
    pub(crate) state: &'a State,
    /// How it looks.
    pub(crate) look: Look,
    /// What the person asked for.
    pub(crate) actions: &'a mut Vec<Action>,
    /// The field being typed into.
    pub(crate) typing: &'a mut Typing,
    /// What is to be opened after this frame.
    pub(crate) opens: &'a mut Option<Opens>,
}

/// What a person opens from another part of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Opens {
    /// A view.
    View(View),
    /// What is and was wrong.
    Faults,
    /// What a drive says, with its faults.
    Drive(Dof),
    /// A note of this moment.
    Note,
    /// The list of keys, or away with it.
    Keys,
}

impl Pane<'_> {
    /// Opens this after the frame.
    pub(crate) const fn open(&mut self, opens: Opens) {
        *self.opens = Some(opens);
    }

    /// Why nothing that moves the hand can be asked for now.
    pub(crate) fn unready(&self) -> Option<&'static str> {
        if self.state.hand().runs_series() {
            return Some(self.look.say(main::SERIES_RUNS));
        }
        if self.state.hand().outside_owner().is_some() {
            return Some(self.look.say(inputs::TAKEN));
        }
        let advice = match self.state.hand().arm_refusal() {
            Some(ArmRefusal::LetGo) => main::REFUSED_LET_GO,
            _ => main::NOT_ARMED,
        };
        (!self.state.hand().is_armed()).then(|| self.look.say(advice))
    }

    /// How fresh something asked for at `asked` is.
    pub(crate) fn freshness(&self, asked: Option<Moment>) -> Freshness {
        self.state.hand().freshness(asked)
    }

    /// The newest value of one joint, and how fresh it is.
    pub(crate) fn newest<T: Copy>(
        &self,
        dof: Dof,
        group: Option<Timed<PerDof<T>>>,
    ) -> (Option<T>, Freshness) {
        let freshness = self.freshness(group.map(|group| group.asked));
        (group.map(|group| group.value[dof]), freshness)
    }
}

/// The one field that is being typed into, or whose text was refused.
#[derive(Debug, Default)]
pub(crate) struct Typing {
    /// Which, and what was typed so far.
    pub(crate) field: Option<(Id, String)>,
    /// Why that was refused.
    pub(crate) refused: Option<String>,
}
