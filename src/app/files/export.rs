//! Saving exports to files: choice of the path, and the contents. Never blocks the window.

use crate::app::env::Env;
use crate::app::env::day_folder;
use crate::app::files::pose_file;
use crate::app::notices::NoticeKind;
use crate::checkup::report::CheckupReport;
use crate::hand::overshoot::OvershootMap;
use crate::history::Table;
use crate::link::Traffic;
use crate::link::traffic::frame::Frame;
use crate::link::traffic::words::CSV_HEAD;
use crate::params;
use crate::params::file::ParamsFile;
use crate::poses::library::PoseLibrary;
use crate::store::calendar;
use crate::store::{on_thread, write_private};
use crate::trials::overshoot_file;
use std::io;
use std::sync::Arc;

/// Format of an exported list of frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TrafficForm {
    /// Table with a header row, for spreadsheets.
    Csv,
    /// One JSON object per line.
    JsonLines,
}

/// Contents to export.
#[derive(Debug, Clone, PartialEq)]
pub enum Export {
    /// Frames of the wire, in this order.
    Traffic(TrafficForm, Vec<Arc<Frame>>),
    /// Plotted values, as CSV.
    Plots(Table),
    /// Recording of a fault, as CSV.
    Recording(Table),
    /// Picture of the plots, as the bytes of a PNG file.
    Picture(Vec<u8>),
    /// Report page of a check-up.
    Checkup(Box<CheckupReport>),
    /// Poses and sequences.
    Poses(PoseLibrary),
    /// Persistent parameters of a hand, as read.
    Params(Box<ParamsFile>),
    /// Measured overshoot of a hand.
    Overshoot(Arc<OvershootMap>),
}

impl Export {
    /// Suggested file name.
    pub const fn file_name(&self) -> &'static str {
        match self {
            Self::Traffic(TrafficForm::Csv, _) => "handscope-traffic.csv",
            Self::Traffic(TrafficForm::JsonLines, _) => "handscope-traffic.jsonl",
            Self::Plots(_) => "handscope-plots.csv",
            Self::Recording(_) => "handscope-fault.csv",
            Self::Picture(_) => "handscope-plots.png",
            Self::Checkup(_) => "handscope-check.html",
            Self::Poses(_) => pose_file::FILE_NAME,
            Self::Params(_) => params::file::FILE_NAME,
            Self::Overshoot(_) => "handscope-overshoot.csv",
        }
    }

    /// Number of entries; a picture counts as one.
    pub fn entries(&self) -> usize {
        match self {
            Self::Traffic(_, frames) => frames.len(),
            Self::Plots(table) | Self::Recording(table) => table.rows(),
            Self::Checkup(report) => report.checks.len(),
            Self::Picture(bytes) => usize::from(!bytes.is_empty()),
            Self::Poses(library) => library.poses.len() + library.sequences.len(),
            Self::Params(file) => file.params.iter().count(),
            Self::Overshoot(map) => map.kinds().len(),
        }
    }

    fn bytes(&self) -> io::Result<Vec<u8>> {
        Ok(match self {
            Self::Traffic(form, frames) => frame_lines(*form, frames).into_bytes(),
            Self::Plots(table) | Self::Recording(table) => table.csv().into_bytes(),
            Self::Checkup(report) => report.html().map_err(io::Error::other)?.into_bytes(),
            Self::Picture(bytes) => bytes.clone(),
            Self::Poses(library) => pose_file::text(library)?.into_bytes(),
            Self::Params(file) => file.to_toml().into_bytes(),
            Self::Overshoot(map) => overshoot_file::csv(map).into_bytes(),
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

/// Saves under an unused name in the day's folder in the user's documents; without a documents folder, asks for a path.
/// Yields the notice for the user.
pub(crate) fn save(content: Export, env: &Env) -> impl Future<Output = NoticeKind> + Send + use<> {
    let chosen = match &env.documents {
        Some(documents) => {
            let folder = day_folder::of_day(documents, &calendar::day(calendar::since_1970()));
            let path = day_folder::free_path(&folder, content.file_name());
            Box::pin(std::future::ready(Some(path)))
        }
        None => env.files.choose(content.file_name()),
    };
    async move {
        let Some(path) = chosen.await else {
            return NoticeKind::NoFileChosen;
        };
        let place = path.clone();
        let work = move || {
            write_private(&place, &content.bytes()?)?;
            Ok(content.entries())
        };
        match on_thread(work).await {
            Ok(entries) => NoticeKind::Saved { path, entries },
            Err(error) => NoticeKind::not_saved(path, &error),
        }
    }
}

/// Reads traffic for as long as one frame of the window permits; the rest waits for the next frame.
pub(crate) fn read_on(traffic: &mut Traffic, now: crate::hand::Moment) {
    /// Half of a full ring: opening the view shows it in two frames.
    const ROUNDS: usize = 5;
    for _ in 0..ROUNDS {
        if !traffic.read_some(now) {
            return;
        }
    }
}
