//! The forty stored poses by number, and the names that a person gave them. Starts none.

use crate::app::settings::Settings;
use crate::hand::{Angle, Gesture, GestureRoute, Moment, PerDof, UserGesture};
use std::collections::BTreeMap;

/// Characters in a name: what fits a button.
pub const NAME_CHARS_MAX: usize = 32;
/// Numbers up to this one are fixed by the maker; the others are the person's own (manual 2.6.7).
const FIXED_TO: u8 = 13;

/// How far the last gesture came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GestureProgress {
    /// Asked; no answer yet.
    Asked,
    /// The hand acknowledged. It does not say that the pose is reached.
    Acknowledged,
    /// It did not work; a notice says why.
    Failed,
}

/// The gesture that was started last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LastGesture {
    /// Its number.
    pub gesture: Gesture,
    /// When it was asked.
    pub at: Moment,
    /// How far it came.
    pub progress: GestureProgress,
}

/// What the hand has stored under a number, as it was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stored {
    /// The number.
    pub gesture: UserGesture,
    /// Its six shorts, as they are.
    pub angles: PerDof<i16>,
}

/// How far storing a pose in the hand came. Written, acknowledged and read back are three things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// On its way.
    Writing,
    /// Acknowledged; being read back.
    ReadingBack,
    /// Read back as it was written.
    Same,
    /// Read back as something else: the hand does not keep it there.
    Differs,
    /// It did not work; a notice says why.
    Failed,
}

/// The pose that was stored last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Upload {
    /// Its number.
    pub gesture: UserGesture,
    /// What was written.
    pub wanted: PerDof<Angle>,
    /// How far it came.
    pub verdict: Verdict,
}

/// The stored poses.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GestureBook {
    names: BTreeMap<u8, String>,
    /// How gestures are started; the manual gives no address.
    pub route: GestureRoute,
    /// The one that was started last.
    pub last: Option<LastGesture>,
    /// The pose that was stored last.
    pub upload: Option<Upload>,
    /// What was read last of what the hand has stored.
    pub stored: Option<Stored>,
}

impl GestureBook {
    /// With the names and the route that were kept.
    // Manual: 2.6.7 lists no names by number, so there are none but the person's.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let mut book = Self {
            route: settings.gesture_route,
            ..Self::default()
        };
        for (number, name) in &settings.gesture_names {
            if let Some(gesture) = number
                .parse::<u8>()
                .ok()
                .and_then(|number| Gesture::new(number).ok())
            {
                book.set_name(gesture, name);
            }
        }
        book
    }

    /// All numbers, in order.
    pub fn all() -> impl Iterator<Item = Gesture> {
        (Gesture::MIN.get()..=Gesture::MAX.get()).filter_map(|number| Gesture::new(number).ok())
    }

    /// The name that a person gave.
    #[must_use]
    pub fn name(&self, gesture: Gesture) -> Option<&str> {
        self.names.get(&gesture.get()).map(String::as_str)
    }

    /// True if the maker fixed this pose, false if the person can store it.
    #[must_use]
    pub const fn is_fixed(gesture: Gesture) -> bool {
        gesture.get() <= FIXED_TO
    }

    /// Gives a name; an empty one takes it away. Long ones are cut, line breaks become spaces.
    pub fn set_name(&mut self, gesture: Gesture, name: &str) {
        let clean: String = name
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let clean: String = clean.trim().chars().take(NAME_CHARS_MAX).collect();
        if clean.is_empty() {
            self.names.remove(&gesture.get());
        } else {
            self.names.insert(gesture.get(), clean);
        }
    }

    /// The names, as they are kept.
    #[must_use]
    pub fn kept_names(&self) -> BTreeMap<String, String> {
        self.names
            .iter()
            .map(|(number, name)| (number.to_string(), name.clone()))
            .collect()
    }

    /// Nothing of one hand's memory is taken for another's.
    pub(crate) const fn another_hand(&mut self) {
        self.last = None;
        self.upload = None;
        self.stored = None;
    }

    /// Notes how far storing came.
    pub(crate) fn judge(&mut self, gesture: UserGesture, verdict: Verdict) {
        if let Some(upload) = &mut self.upload
            && upload.gesture == gesture
            && matches!(upload.verdict, Verdict::Writing | Verdict::ReadingBack)
        {
            upload.verdict = verdict;
        }
    }

    /// Takes what was read, and compares it with what was written.
    pub(crate) fn read_back(&mut self, stored: Stored) {
        self.stored = Some(stored);
        let wanted = self.upload.map(|upload| upload.wanted.map(Angle::get));
        let verdict = if wanted == Some(stored.angles) {
            Verdict::Same
        } else {
            Verdict::Differs
        };
        self.judge(stored.gesture, verdict);
    }

    /// Notes how the last gesture went on.
    pub(crate) const fn progress(&mut self, progress: GestureProgress) {
        if let Some(last) = &mut self.last {
            last.progress = progress;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_that_exist_get_names_and_they_survive_a_round() {
        let mut settings = Settings::default();
        for (number, name) in [
            ("1", " open\n"),
            ("40", "握拳"),
            ("0", "none"),
            ("41", "none"),
            ("x", "none"),
            ("7", " "),
        ] {
            settings.gesture_names.insert(number.into(), name.into());
        }
        let book = GestureBook::new(&settings);
        let kept: Vec<_> = book.kept_names().into_iter().collect();
        assert_eq!(
            kept,
            [
                ("1".to_owned(), "open".to_owned()),
                ("40".to_owned(), "握拳".to_owned())
            ]
        );
        assert_eq!(GestureBook::all().count(), 40);
        assert!(
            GestureBook::is_fixed(Gesture::nearest(13))
                && !GestureBook::is_fixed(Gesture::nearest(14))
        );
    }

    #[test]
    fn long_names_are_cut_at_whole_characters() {
        let mut book = GestureBook::default();
        book.set_name(Gesture::MIN, &"手".repeat(100));
        assert_eq!(
            book.name(Gesture::MIN).map(|name| name.chars().count()),
            Some(NAME_CHARS_MAX)
        );
    }
}
