//! Settings on disk: read at start, written whole and off the window's thread. Knows no setpoint.

use crate::app::notices::NoticeKind;
use crate::app::settings::Settings;
use crate::hand::Moment;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::sync::oneshot;

/// A typed name or a dragged window changes settings many times a second; the disk sees one of them.
const SAVE_EVERY: Duration = Duration::from_secs(1);
/// A settings file is a page of text; anything longer is not ours.
const FILE_LEN_MAX: u64 = 1024 * 1024;
/// Unreadable files that are kept beside each other; then the last one is replaced.
const UNREADABLE_MAX: u32 = 9;

/// Where settings lie on this system; `None` if the person has no home.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "handscope")?;
    Some(folders.config_dir().join("settings.toml"))
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loaded {
    /// The settings in force.
    pub settings: Settings,
    /// What a person should know about the file.
    pub notice: Option<NoticeKind>,
}

/// Reads settings. A missing file means the defaults. A bad one too, and it is kept under another name.
#[must_use]
pub fn load(path: &Path) -> Loaded {
    let message = match read(path) {
        Ok(None) => return Loaded::default(),
        Ok(Some(text)) => match toml::from_str(&text) {
            Ok(settings) => {
                return Loaded {
                    settings,
                    notice: None,
                };
            }
            Err(error) => error.to_string(),
        },
        Err(error) => error.to_string(),
    };
    let kept_as = set_aside(path);
    Loaded {
        settings: Settings::default(),
        notice: Some(NoticeKind::SettingsIgnored { message, kept_as }),
    }
}

fn read(path: &Path) -> std::io::Result<Option<String>> {
    match std::fs::metadata(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
        Ok(about) if about.len() > FILE_LEN_MAX => {
            Err(std::io::Error::other("the file is too long for settings"))
        }
        Ok(_) => std::fs::read_to_string(path).map(Some),
    }
}

/// Gives an unreadable file another name; the name, if that worked.
pub(crate) fn set_aside(path: &Path) -> Option<PathBuf> {
    let name = |number: u32| path.with_extension(format!("unreadable-{number}.toml"));
    let free = (1..UNREADABLE_MAX).map(name).find(|aside| !aside.exists());
    let aside = free.unwrap_or_else(|| name(UNREADABLE_MAX));
    std::fs::rename(path, &aside).ok().map(|()| aside)
}

/// What is kept in a file of its own.
pub trait Kept: Clone + PartialEq + Send + 'static {
    /// The file's text.
    ///
    /// # Errors
    /// What the writer of the format says.
    fn text(&self) -> std::io::Result<String>;
    /// What a person is told when it could not be written.
    fn not_saved(message: String) -> NoticeKind;
}

impl Kept for Settings {
    fn text(&self) -> std::io::Result<String> {
        toml::to_string_pretty(self).map_err(std::io::Error::other)
    }

    fn not_saved(message: String) -> NoticeKind {
        NoticeKind::SettingsNotSaved { message }
    }
}

/// Writes a file so that at any moment either the old or the new one is there, whole. The old one stays beside it as
/// `….last.toml`.
///
/// # Errors
/// What the system says.
pub fn save<K: Kept>(path: &Path, kept: &K) -> std::io::Result<()> {
    replace(path, &kept.text()?)
}

/// Writes a text as [`save`] does.
pub(crate) fn replace(path: &Path, text: &str) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let new = path.with_extension("new.toml");
    let mut file = std::fs::File::create(&new)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    drop(file);
    if path.exists() {
        std::fs::copy(path, path.with_extension("last.toml"))?;
    }
    std::fs::rename(&new, path)
}

/// Writes what is kept when it changed, at most once a second and one at a time. Without a path, nothing is kept.
#[derive(Debug)]
pub(crate) struct Saver<K> {
    path: Option<PathBuf>,
    runtime: tokio::runtime::Handle,
    kept: K,
    begun: Option<Moment>,
    under_way: Option<oneshot::Receiver<std::io::Result<()>>>,
}

impl<K: Kept> Saver<K> {
    pub(crate) const fn new(
        path: Option<PathBuf>,
        runtime: tokio::runtime::Handle,
        kept: K,
    ) -> Self {
        Self {
            path,
            runtime,
            kept,
            begun: None,
            under_way: None,
        }
    }

    /// Writes if needed. What went wrong with an earlier write comes back.
    pub(crate) fn tick(&mut self, newest: &K, now: Moment) -> Option<NoticeKind> {
        let failed = self.finished();
        let waits = self
            .begun
            .is_some_and(|begun| now.since(begun) < SAVE_EVERY);
        if !waits {
            self.begin(newest, now);
        }
        failed
    }

    /// Writes what is not written yet, at once. True when all is on disk, or cannot be.
    pub(crate) fn flush(&mut self, newest: &K, now: Moment) -> bool {
        let failed = self.finished();
        self.begin(newest, now);
        failed.is_some() || self.under_way.is_none()
    }

    fn begin(&mut self, newest: &K, now: Moment) {
        let Some(path) = self.path.clone() else {
            return;
        };
        if self.under_way.is_some() || *newest == self.kept {
            return;
        }
        let (done, under_way) = oneshot::channel();
        self.kept = newest.clone();
        let kept = newest.clone();
        self.runtime.spawn_blocking(move || {
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = done.send(save(&path, &kept));
        });
        self.begun = Some(now);
        self.under_way = Some(under_way);
    }

    /// A failed write is not tried again before something changes again: the notice stands until then.
    fn finished(&mut self) -> Option<NoticeKind> {
        let under_way = self.under_way.as_mut()?;
        let message = match under_way.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return None,
            Ok(Ok(())) => None,
            Ok(Err(error)) => Some(error.to_string()),
            Err(oneshot::error::TryRecvError::Closed) => Some("the program is ending".into()),
        };
        self.under_way = None;
        message.map(K::not_saved)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::app::settings::{Language, PlotWindow, Theme};

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
        save(&path, &some()).unwrap();
        assert_eq!(
            load(&path),
            Loaded {
                settings: some(),
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
        save(&path, &loaded.settings).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let table: toml::Table = text.parse().unwrap();
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
            let Some(NoticeKind::SettingsIgnored {
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

    #[test]
    fn the_last_good_file_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        save(&path, &some()).unwrap();
        save(&path, &Settings::default()).unwrap();
        assert_eq!(load(&path.with_extension("last.toml")).settings, some());
    }

    #[tokio::test]
    async fn only_changes_are_written_and_a_failure_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        let mut saver = Saver::new(
            Some(path.clone()),
            tokio::runtime::Handle::current(),
            Settings::default(),
        );
        assert_eq!(saver.tick(&Settings::default(), Moment::ZERO), None);
        assert!(saver.under_way.is_none(), "nothing changed");
        assert!(!saver.flush(&some(), Moment::ZERO));
        while !saver.flush(&some(), Moment::ZERO) {
            tokio::task::yield_now().await;
        }
        assert_eq!(load(&path).settings, some());
        let mut saver = Saver::new(
            Some(path.join("below/a/file")),
            tokio::runtime::Handle::current(),
            some(),
        );
        let told = loop {
            if let Some(told) = saver.tick(&Settings::default(), Moment::ZERO) {
                break told;
            }
            tokio::task::yield_now().await;
        };
        assert!(matches!(told, NoticeKind::SettingsNotSaved { .. }));
    }
}
