//! Saving to a file that a person chooses: how the place is asked for, and what is written there. Never blocks the window.

use crate::app::config::Kept;
use crate::app::device::keeper;
use crate::app::history::Table;
use crate::app::notices::NoticeKind;
use crate::app::params::file::ParamsFile;
use crate::app::poses::library::Library;
use crate::app::poses::store;
use crate::link::Traffic;
use crate::link::traffic::frame::Frame;
use crate::link::traffic::words::CSV_HEAD;
use futures::future::BoxFuture;
use std::path::PathBuf;
use std::sync::Arc;
use tokio::sync::oneshot;

/// Asks a person where a file should go. Called on the window's thread; what it gives is awaited elsewhere.
pub trait ChooseFile: Send + Sync + 'static {
    /// Resolves to the chosen place; `None` if there was no choice. `suggested` is a file name.
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to a file that is there, to be read; `None` if there was no choice.
    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to a folder that is there, to put another into; `None` if there was no choice.
    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>>;
}

/// Where nobody can be asked: nothing is ever chosen.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoChoice;

impl ChooseFile for NoChoice {
    fn choose(&self, _suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }

    fn open(&self, _suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }

    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }
}

/// Without asking: always into one folder, under the suggested name.
#[derive(Debug, Clone)]
pub struct InFolder(pub PathBuf);

impl ChooseFile for InFolder {
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(Some(self.0.join(suggested))))
    }

    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        self.choose(suggested)
    }

    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(Some(self.0.clone())))
    }
}

/// The form of an exported list of frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TrafficForm {
    /// A table with a head, for spreadsheets.
    Csv,
    /// One JSON object a line.
    JsonLines,
}

/// What is to be saved.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Frames of the wire, in this order.
    Traffic(TrafficForm, Vec<Arc<Frame>>),
    /// What the plots show, as comma-separated values.
    Plots(Table),
    /// What was recorded around a fault, as comma-separated values.
    Recording(Table),
    /// A finished picture of the plots, as the bytes of a PNG file.
    Picture(Vec<u8>),
    /// Poses and sequences.
    Poses(Library),
    /// What a hand keeps, as it was read.
    Params(Box<ParamsFile>),
}

impl Content {
    /// The name that is suggested for the file.
    #[must_use]
    pub const fn file_name(&self) -> &'static str {
        match self {
            Self::Traffic(TrafficForm::Csv, _) => "handscope-traffic.csv",
            Self::Traffic(TrafficForm::JsonLines, _) => "handscope-traffic.jsonl",
            Self::Plots(_) => "handscope-plots.csv",
            Self::Recording(_) => "handscope-fault.csv",
            Self::Picture(_) => "handscope-plots.png",
            Self::Poses(_) => store::FILE_NAME,
            Self::Params(_) => keeper::FILE_NAME,
        }
    }

    /// Entries in it; a picture is one.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Traffic(_, frames) => frames.len(),
            Self::Plots(table) | Self::Recording(table) => table.len(),
            Self::Picture(bytes) => usize::from(!bytes.is_empty()),
            Self::Poses(library) => library.poses.len() + library.sequences.len(),
            Self::Params(file) => file.params.iter().count(),
        }
    }

    /// True if there is nothing to save.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn bytes(&self) -> std::io::Result<Vec<u8>> {
        Ok(match self {
            Self::Traffic(form, frames) => frame_lines(*form, frames).into_bytes(),
            Self::Plots(table) | Self::Recording(table) => table.csv().into_bytes(),
            Self::Picture(bytes) => bytes.clone(),
            Self::Poses(library) => library.text()?.into_bytes(),
            Self::Params(file) => file.to_toml().into_bytes(),
        })
    }
}

fn frame_lines(form: TrafficForm, frames: &[Arc<Frame>]) -> String {
    let (head, line): (Option<String>, fn(&Frame) -> String) = match form {
        TrafficForm::Csv => (Some(CSV_HEAD.into()), Frame::csv_line),
        TrafficForm::JsonLines => (None, Frame::json_line),
    };
    let lines = frames.iter().map(|frame| line(frame));
    let mut text = head.into_iter().chain(lines).collect::<Vec<_>>().join("\n");
    text.push('\n');
    text
}

/// A file that is being chosen and written.
#[derive(Debug)]
pub(crate) struct Saving(oneshot::Receiver<NoticeKind>);

impl Saving {
    /// Asks for a place and writes, on the runtime. `wake` is called at the end.
    pub(crate) fn start(
        content: Content,
        files: &dyn ChooseFile,
        runtime: &tokio::runtime::Handle,
        wake: crate::link::Wake,
    ) -> Self {
        let (told, ended) = oneshot::channel();
        let chosen = files.choose(content.file_name());
        runtime.spawn(async move {
            let end = match chosen.await {
                None => NoticeKind::NoFileChosen,
                Some(path) => write(content, path).await,
            };
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = told.send(end);
            wake();
        });
        Self(ended)
    }

    /// How it ended, once it has.
    pub(crate) fn ended(&mut self) -> Option<NoticeKind> {
        match self.0.try_recv() {
            Ok(end) => Some(end),
            Err(oneshot::error::TryRecvError::Empty) => None,
            Err(oneshot::error::TryRecvError::Closed) => Some(NoticeKind::NoFileChosen),
        }
    }
}

async fn write(content: Content, path: PathBuf) -> NoticeKind {
    let place = path.clone();
    let work = move || std::fs::write(&place, content.bytes()?).map(|()| content.len());
    match tokio::task::spawn_blocking(work).await {
        Ok(Ok(entries)) => NoticeKind::Saved { path, entries },
        Ok(Err(error)) => NoticeKind::NotSaved {
            message: error.to_string(),
            path,
        },
        Err(error) => NoticeKind::NotSaved {
            message: error.to_string(),
            path,
        },
    }
}

/// Reads pieces on for as long as one frame of the window may take; the rest waits for the next one.
pub(crate) fn read_on(traffic: &mut Traffic, now: crate::hand::Moment) {
    /// As much as half of a full ring: opening the view shows it in two frames.
    const ROUNDS: usize = 5;
    for _ in 0..ROUNDS {
        if !traffic.read_some(now) {
            return;
        }
    }
}
