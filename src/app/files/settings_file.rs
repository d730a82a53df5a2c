//! Settings on disk: read at start, written completely, off the window's thread. Knows no setpoint.

use crate::app::files::put_aside;
use crate::app::notices::NoticeKind;
use crate::app::settings::Settings;
use crate::store::toml_file::{self, FileText};
use std::path::{Path, PathBuf};

/// Maximum size of a settings file in bytes; a valid one is a page of text.
const FILE_LEN_MAX: u64 = 1024 * 1024;
/// Default path of the settings on this system; `None` if the user has no home.
pub fn default_path() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "handscope")?;
    Some(folders.config_dir().join("settings.toml"))
}

/// Result of loading settings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loaded {
    /// Effective settings.
    pub settings: Settings,
    /// True if they come from the file.
    pub found: bool,
    /// Notice for the user about the file.
    pub notice: Option<NoticeKind>,
}

/// Loads settings. A missing or invalid file yields the defaults; an invalid one is set aside under another name.
pub fn load(path: &Path) -> Loaded {
    if matches!(path.try_exists(), Ok(false)) {
        return Loaded::default();
    }
    match toml_file::load(path, FILE_LEN_MAX, |text| FileText::plain(text).parse()) {
        Ok(settings) => Loaded {
            settings,
            found: true,
            notice: None,
        },
        Err(error) => Loaded {
            settings: Settings::default(),
            found: false,
            notice: Some(put_aside(path, error)),
        },
    }
}

/// Reads the settings without touching the file; `None` if they are missing or unreadable.
pub fn peek(path: &Path) -> Option<Settings> {
    toml_file::load(path, FILE_LEN_MAX, |text| FileText::plain(text).parse()).ok()
}

/// Serializes the settings.
///
/// # Errors
/// The error of the TOML serializer.
pub fn text(settings: &Settings) -> std::io::Result<String> {
    toml::to_string_pretty(settings).map_err(std::io::Error::other)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::app::settings::{Language, PlotWindow, Theme};

    fn save(path: &Path, settings: &Settings) {
        crate::store::replace_keeping_last(path, &text(settings).unwrap()).unwrap();
    }

    fn some() -> Settings {
        let mut settings = Settings {
            endpoint: Some("tcp:10.0.0.1:6000?unit=255".into()),
            theme: Theme::Light,
            language: Language::Zh,
            plot_window: PlotWindow::M5,
            ..Settings::default()
        };
        settings.gesture_names.insert("3".into(), "捏".into());
        settings
    }

    #[test]
    fn settings_come_back_as_they_were_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/settings.toml");
        assert_eq!(load(&path), Loaded::default());
        save(&path, &some());
        assert_eq!(
            load(&path),
            Loaded {
                settings: some(),
                found: true,
                notice: None
            }
        );
    }

    #[test]
    fn keys_of_a_newer_version_survive_load_and_save() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        std::fs::write(
            &path,
            "theme = \"light\"\nwarp = 9\n[crew]\nnames = [\"a\", \"b\"]\n",
        )
        .unwrap();
        let loaded = load(&path);
        assert_eq!((loaded.notice, loaded.settings.theme), (None, Theme::Light));
        save(&path, &loaded.settings);
        let written = std::fs::read_to_string(&path).unwrap();
        let table: toml::Table = written.parse().unwrap();
        assert_eq!(table.get("warp").and_then(toml::Value::as_integer), Some(9));
        assert!(table.get("crew").is_some_and(toml::Value::is_table));
    }

    #[test]
    fn a_bad_file_gives_defaults_and_is_kept_under_another_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        for bad in ["theme = ", "theme = \"mauve\"", "\0\0\0"] {
            std::fs::write(&path, bad).unwrap();
            let loaded = load(&path);
            assert_eq!(loaded.settings, Settings::default());
            let Some(NoticeKind::FileIgnored {
                kept_as: Some(aside),
                ..
            }) = loaded.notice
            else {
                unreachable!("a notice must say so");
            };
            assert_eq!(std::fs::read_to_string(aside).unwrap(), bad);
            assert!(!path.exists());
        }
    }
}
