//! Settings that persist between runs. Never a setpoint: a stored plan of trials moves nothing before the user arms and starts
//! it.

use crate::app::env::day_folder;
use crate::app::layout::Layout;
use crate::app::readings::tare::StoredTare;
use crate::hand::gap::SizeBlocks;
use crate::hand::kinematics::Side;
use crate::hand::{Gesture, GestureRoute};
use crate::inputs::pad::{self, PadMap};
use crate::link::PollPriority;
use crate::motion::follow::step::FollowLimits;
use crate::poses::library::clean;
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Colour theme.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

impl Theme {
    /// The other theme.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Dark,
        }
    }
}

/// Language of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// English.
    #[default]
    En,
    Zh,
}

impl Language {
    /// Language for a system locale such as `zh_CN` or `zh-Hans-CN`.
    #[must_use]
    pub fn of_locale(locale: &str) -> Self {
        match locale.split(['-', '_', '.']).next() {
            Some("zh") => Self::Zh,
            _ => Self::En,
        }
    }

    /// The other language.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::En => Self::Zh,
            Self::Zh => Self::En,
        }
    }
}

/// Unit in which angles are shown and entered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AngleUnit {
    /// Raw register value, 0 to 1000.
    #[default]
    Raw,
    /// Degrees of the joint.
    Degrees,
    /// Percentage of opening.
    Percent,
}

impl AngleUnit {
    /// The next unit, cyclically.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::Raw => Self::Degrees,
            Self::Degrees => Self::Percent,
            Self::Percent => Self::Raw,
        }
    }
}

/// Time span of the plots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlotWindow {
    S5,
    #[default]
    S10,
    S30,
    M1,
    M5,
    M10,
    M30,
    /// One hour: the whole history.
    H1,
}

impl PlotWindow {
    /// All, shortest first.
    pub const ALL: [Self; 8] = [
        Self::S5,
        Self::S10,
        Self::S30,
        Self::M1,
        Self::M5,
        Self::M10,
        Self::M30,
        Self::H1,
    ];

    pub const fn seconds(self) -> f64 {
        match self {
            Self::S5 => 5.0,
            Self::S10 => 10.0,
            Self::S30 => 30.0,
            Self::M1 => 60.0,
            Self::M5 => 300.0,
            Self::M10 => 600.0,
            Self::M30 => 1800.0,
            Self::H1 => 3600.0,
        }
    }
}

/// One of the stacked plots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlotKind {
    /// Force of the joints.
    Force,
    /// Normal force at the fingertips.
    Normal,
    /// Tangential force at the fingertips.
    Tangential,
    /// Current of the drives.
    Current,
    /// Temperature of the drives.
    Temperature,
    /// Angle of the joints: actual and target.
    Angle,
}

/// The visible plots; always at least one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "BTreeSet<PlotKind>")]
pub struct ShownPlots(BTreeSet<PlotKind>);

impl PlotKind {
    /// All, from top to bottom.
    pub const ALL: [Self; 6] = [
        Self::Force,
        Self::Normal,
        Self::Tangential,
        Self::Current,
        Self::Temperature,
        Self::Angle,
    ];
}

impl Default for ShownPlots {
    fn default() -> Self {
        use PlotKind::{Angle, Current, Force, Temperature};
        Self([Force, Current, Temperature, Angle].into())
    }
}

impl From<BTreeSet<PlotKind>> for ShownPlots {
    fn from(kinds: BTreeSet<PlotKind>) -> Self {
        if kinds.is_empty() {
            Self::default()
        } else {
            Self(kinds)
        }
    }
}

impl ShownPlots {
    /// True if this plot is visible.
    pub fn shows(&self, kind: PlotKind) -> bool {
        self.0.contains(&kind)
    }

    /// Number of visible plots.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Shows or hides a plot. The last one stays visible.
    pub fn set(&mut self, kind: PlotKind, on: bool) {
        if on {
            self.0.insert(kind);
        } else if self.0.len() > 1 {
            self.0.remove(&kind);
        }
    }
}

/// The two enlarged plots, the latest one last; the others are sparklines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<PlotKind>")]
pub struct TallPlots([PlotKind; 2]);

impl Default for TallPlots {
    fn default() -> Self {
        Self([PlotKind::Angle, PlotKind::Force])
    }
}

impl From<Vec<PlotKind>> for TallPlots {
    fn from(kinds: Vec<PlotKind>) -> Self {
        let mut tall = Self::default();
        kinds.into_iter().for_each(|kind| tall.grow(kind));
        tall
    }
}

impl TallPlots {
    /// Enlarges a plot in place of the older of the two.
    pub fn grow(&mut self, kind: PlotKind) {
        let [_, last] = self.0;
        if last != kind {
            self.0 = [last, kind];
        }
    }

    /// Selects up to `count` visible plots, the enlarged ones first.
    pub fn of(self, shown: &ShownPlots, count: usize) -> Vec<PlotKind> {
        let [first, last] = self.0;
        let mut tall = Vec::new();
        for kind in [last, first].into_iter().chain(PlotKind::ALL) {
            if shown.shows(kind) && !tall.contains(&kind) && tall.len() < count {
                tall.push(kind);
            }
        }
        tall
    }
}

/// Zoom factor of the window, limited to 0.5 to 3.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "f32", into = "f32")]
pub struct Zoom(f32);

impl From<f32> for Zoom {
    fn from(factor: f32) -> Self {
        let sane = factor.is_finite();
        Self(if sane { factor.clamp(0.5, 3.0) } else { 1.0 })
    }
}

impl From<Zoom> for f32 {
    fn from(zoom: Zoom) -> Self {
        zoom.0
    }
}

impl Default for Zoom {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Maximum number of recent hands: as many as a window has at once.
pub const RECENT_MAX: usize = 8;
/// Maximum number of hands with stored name and side. Beyond it, those that are not among the recent ones are dropped.
pub const KNOWN_MAX: usize = 64;
/// Maximum number of stored tares; the oldest is dropped first.
pub const TARES_MAX: usize = 20;

/// User data of one hand.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct KnownHand {
    /// Name; empty if none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Side; `None` = as [`Settings::side`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<Side>,
    /// Day of the last connection by the user, such as `2026-11-24`; empty if unknown.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub last_day: String,
    /// Blocks of known size that were measured with the hand.
    #[serde(skip_serializing_if = "SizeBlocks::is_empty")]
    pub size_blocks: SizeBlocks,
    /// Keys of a newer version, preserved on save.
    #[serde(flatten)]
    pub others: toml::Table,
}

/// Settings of recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RecordingSettings {
    /// True if hands are recorded.
    pub record: bool,
    /// True if built-in hands are recorded as well.
    pub record_simulated: bool,
    /// Folder of the recordings; `None` = the user's documents.
    pub folder: Option<PathBuf>,
    /// Maximum total size of all recordings in gigabytes.
    pub budget_gb: f64,
}

impl Default for RecordingSettings {
    fn default() -> Self {
        Self {
            record: true,
            record_simulated: false,
            folder: None,
            budget_gb: 5.0,
        }
    }
}

impl RecordingSettings {
    /// Maximum total size of all recordings in bytes.
    pub fn budget_bytes(&self) -> u64 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "cut to a range that fits"
        )]
        let bytes = (self.budget_gb.clamp(0.01, 1e6) * 1e9) as u64;
        bytes
    }
}

/// Settings that persist between runs. Unknown keys of the file survive in [`Self::others`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Endpoint of the last hand, as text.
    pub endpoint: Option<String>,
    /// Endpoints of all open hands in their order, as text; empty for a single one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<String>,
    /// Endpoints that the user connected to, newest first, as text.
    pub recent: Vec<String>,
    pub theme: Theme,
    /// Default side of a hand: no register reports it.
    pub side: Side,
    /// User data of each hand, by its endpoint.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub hands: BTreeMap<String, KnownHand>,
    pub language: Language,
    pub angle_unit: AngleUnit,
    /// Time span of the plots.
    pub plot_window: PlotWindow,
    pub plots: ShownPlots,
    pub tall_plots: TallPlots,
    /// Interface used to start gestures.
    pub gesture_route: GestureRoute,
    /// User-given names of gestures, by number.
    pub gesture_names: BTreeMap<String, String>,
    /// Names of hidden shipped poses, sequences and reactions.
    pub hidden_poses: BTreeSet<String>,
    pub layout: Layout,
    pub zoom: Zoom,
    /// Last tare of each hand, by its address and ID.
    pub tares: BTreeMap<String, StoredTare>,
    /// Group that is polled first during motion.
    pub read_first: PollPriority,
    #[serde(rename = "sessions")]
    pub recordings: RecordingSettings,
    /// True if the hand may move only while the user holds a key.
    pub hold_to_run: bool,
    /// True if an armed hand that receives no commands for some minutes is disarmed.
    pub disarm_idle: bool,
    /// Distance and speed limits of a hand that follows a source.
    pub follow: FollowLimits,
    /// True if the first gateway client that writes gets control without the user granting it. Can be set only by editing the
    /// file.
    pub first_client_moves: bool,
    /// Gamepad mapping in its file format; `None` = default mapping.
    pub pad_map: Option<String>,
    /// Last edited plan of trials ([`crate::trials::plan_settings`]); untyped, so that a newer format does not invalidate other
    /// keys.
    pub trial_plan: Option<toml::Value>,
    /// Keys of a newer version, preserved on save.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl Settings {
    /// True if a hand, built-in or not, is recorded.
    pub const fn records(&self, is_simulated: bool) -> bool {
        self.recordings.record && (!is_simulated || self.recordings.record_simulated)
    }

    /// Effective gamepad mapping; the default if there is none or it is invalid.
    pub fn pad_map(&self) -> PadMap {
        let own = self.pad_map.as_deref();
        let own = own.and_then(|text| pad::file::read(text).ok());
        own.unwrap_or_else(PadMap::usual)
    }

    /// Folder of the recordings; `None` if none is available.
    pub fn recordings_folder(&self, documents: Option<&Path>) -> Option<PathBuf> {
        let own = self.recordings.folder.clone();
        own.or_else(|| documents.map(day_folder::of_all))
    }

    /// Stores this hand as the last and most recent one.
    pub(crate) fn remember(&mut self, endpoint: &Endpoint) {
        let text = endpoint.to_string();
        self.recent.retain(|other| *other != text);
        self.recent.insert(0, text.clone());
        self.recent.truncate(RECENT_MAX);
        self.endpoint = Some(text);
    }

    /// Day of the last connection to this hand by the user.
    pub fn last_day(&self, endpoint: &Endpoint) -> Option<&str> {
        let day = &self.hands.get(&endpoint.to_string())?.last_day;
        (!day.is_empty()).then_some(day)
    }

    /// Sets the day of the last connection to a hand by the user.
    pub(crate) fn used_on(&mut self, endpoint: &Endpoint, day: String) {
        self.update_hand(endpoint, |known| known.last_day = day);
    }

    /// Side of this hand; if not set for it, the default side.
    pub fn side_of(&self, endpoint: Option<&Endpoint>) -> Side {
        let known = endpoint.and_then(|endpoint| self.hands.get(&endpoint.to_string()));
        known.and_then(|known| known.side).unwrap_or(self.side)
    }

    /// User-given name of this hand.
    pub fn hand_name(&self, endpoint: &Endpoint) -> Option<&str> {
        let name = &self.hands.get(&endpoint.to_string())?.name;
        (!name.is_empty()).then_some(name)
    }

    /// Sets the side of a hand.
    pub(crate) fn set_side_of(&mut self, endpoint: &Endpoint, side: Side) {
        self.update_hand(endpoint, |known| known.side = Some(side));
    }

    /// Sets the name of a hand, reduced to one line; an empty name removes it.
    pub(crate) fn name_hand(&mut self, endpoint: &Endpoint, name: &str) {
        self.update_hand(endpoint, |known| known.name = clean(name));
    }

    /// Blocks that were measured with this hand.
    pub fn size_blocks(&self, endpoint: Option<&Endpoint>) -> SizeBlocks {
        let known = endpoint.and_then(|endpoint| self.hands.get(&endpoint.to_string()));
        known.map_or_else(SizeBlocks::default, |known| known.size_blocks.clone())
    }

    /// Stores the blocks that were measured with a hand.
    pub(crate) fn keep_size_blocks(&mut self, endpoint: &Endpoint, blocks: SizeBlocks) {
        self.update_hand(endpoint, |known| known.size_blocks = blocks);
    }

    fn update_hand(&mut self, endpoint: &Endpoint, change: impl FnOnce(&mut KnownHand)) {
        let text = endpoint.to_string();
        change(self.hands.entry(text.clone()).or_default());
        self.hands.retain(|_, known| *known != KnownHand::default());
        if self.hands.len() > KNOWN_MAX {
            let recent = &self.recent;
            self.hands
                .retain(|hand, _| *hand == text || recent.contains(hand));
        }
    }

    /// Stores the tare of a hand; `None` removes it.
    pub(crate) fn keep_tare(&mut self, hand: String, kept: Option<StoredTare>) {
        match kept {
            Some(kept) => self.tares.insert(hand, kept),
            None => self.tares.remove(&hand),
        };
        while self.tares.len() > TARES_MAX {
            let oldest = self.tares.iter().min_by_key(|(_, kept)| kept.unix_s);
            let oldest = oldest.map(|(hand, _)| hand.clone()).unwrap_or_default();
            self.tares.remove(&oldest);
        }
    }

    /// User-given name of a gesture. Manual: 2.6.7 lists no names by number, so there are no others.
    pub fn gesture_name(&self, gesture: Gesture) -> Option<&str> {
        let name = self.gesture_names.get(&gesture.get().to_string())?.trim();
        (!name.is_empty()).then_some(name)
    }

    /// Sets the name of a gesture, reduced to one line; an empty name removes it.
    pub fn name_gesture(&mut self, gesture: Gesture, name: &str) {
        let line = clean(name);
        let number = gesture.get().to_string();
        if line.is_empty() {
            self.gesture_names.remove(&number);
        } else {
            self.gesture_names.insert(number, line);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_speaks_chinese_is_answered_in_it() {
        for locale in ["zh", "zh_CN.UTF-8", "zh-Hans-CN", "zh_TW"] {
            assert_eq!(Language::of_locale(locale), Language::Zh, "{locale}");
        }
        for locale in ["", "C", "en_US.UTF-8", "de-DE", "zhx"] {
            assert_eq!(Language::of_locale(locale), Language::En, "{locale}");
        }
    }

    #[test]
    fn the_last_few_hands_are_remembered_once_each_and_the_newest_first() {
        let mut settings = Settings::default();
        for port in [1, 2, 3, 4, 5, 6, 7, 8, 9, 3] {
            let endpoint = format!("rs485:COM{port}").parse().unwrap();
            settings.remember(&endpoint);
        }
        let ports = [
            "COM3", "COM9", "COM8", "COM7", "COM6", "COM5", "COM4", "COM2",
        ];
        let spelled = ports.map(|port| format!("rs485:{port}?baud=115200&id=1"));
        assert_eq!(settings.recent, spelled);
        assert_eq!(settings.endpoint.as_ref(), spelled.first());
    }

    #[test]
    fn name_and_side_are_kept_of_each_hand_and_only_so_many() {
        let mut settings = Settings::default();
        let endpoint = |n: usize| format!("tcp:10.0.0.1:{}", 6000 + n).parse().unwrap();
        for n in 0..=KNOWN_MAX {
            settings.remember(&endpoint(n));
            settings.name_hand(&endpoint(n), &format!(" hand\n{n} "));
        }
        assert_eq!(settings.hands.len(), RECENT_MAX, "those that are recent");
        let last = endpoint(KNOWN_MAX);
        assert_eq!(settings.hand_name(&last), Some("hand 64"));
        settings.set_side_of(&last, Side::Left);
        assert_eq!(settings.side_of(Some(&last)), Side::Left);
        assert_eq!(settings.side_of(Some(&endpoint(60))), Side::Right);
        settings.name_hand(&last, "");
        assert_eq!(settings.hand_name(&last), None);
        settings.used_on(&last, "2026-11-24".into());
        assert_eq!(settings.last_day(&last), Some("2026-11-24"));
        assert_eq!(settings.last_day(&endpoint(60)), None);
    }

    #[test]
    fn the_plots_that_were_grown_last_are_tall_as_far_as_they_are_shown() {
        use PlotKind::{Angle, Current, Force, Normal, Temperature};
        let (mut tall, mut shown) = (TallPlots::default(), ShownPlots::default());
        assert_eq!(tall.of(&shown, 2), [Force, Angle]);
        assert_eq!(tall.of(&shown, 1), [Force]);
        tall.grow(Temperature);
        assert_eq!(tall.of(&shown, 2), [Temperature, Force]);
        tall.grow(Force);
        assert_eq!(tall.of(&shown, 2), [Force, Temperature]);
        tall.grow(Normal);
        assert_eq!(
            tall.of(&shown, 2),
            [Force, Current],
            "what is not shown is not tall"
        );
        for kind in [Force, Current, Temperature] {
            shown.set(kind, false);
        }
        assert_eq!(tall.of(&shown, 2), [Angle]);
    }

    #[test]
    fn the_tarings_of_the_last_hands_are_kept() {
        let mut settings = Settings::default();
        for unix_s in 0..25 {
            let kept = StoredTare {
                unix_s,
                ..StoredTare::default()
            };
            settings.keep_tare(format!("hand {unix_s}"), Some(kept));
        }
        assert_eq!(settings.tares.len(), TARES_MAX);
        assert!(!settings.tares.contains_key("hand 4"), "the oldest went");
        settings.keep_tare("hand 24".into(), None);
        assert!(!settings.tares.contains_key("hand 24"));
    }

    #[test]
    fn names_of_gestures_are_lines_that_fit_and_empty_ones_are_none() {
        let mut settings = Settings::default();
        let gesture = Gesture::MIN;
        settings.name_gesture(gesture, " a\nfist ");
        assert_eq!(settings.gesture_name(gesture), Some("a fist"));
        settings.name_gesture(gesture, &"手".repeat(100));
        let chars = settings
            .gesture_name(gesture)
            .map(|name| name.chars().count());
        assert_eq!(chars, Some(crate::poses::library::NAME_CHARS_MAX));
        settings.name_gesture(gesture, "  ");
        assert_eq!(
            (settings.gesture_name(gesture), settings.gesture_names.len()),
            (None, 0)
        );
    }
}
