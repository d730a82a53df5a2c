//! Saving to a file that the user chooses: how the place is asked for, and what is written there. Never blocks the window.

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
use crate::store::{BackgroundJob, on_thread, write_private};
use crate::trials::overshoot_file;
use std::io;
use std::sync::Arc;

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
pub enum Export {
    /// Frames of the wire, in this order.
    Traffic(TrafficForm, Vec<Arc<Frame>>),
    /// What the plots show, as comma-separated values.
    Plots(Table),
    /// What was recorded around a fault, as comma-separated values.
    Recording(Table),
    /// A finished picture of the plots, as the bytes of a PNG file.
    Picture(Vec<u8>),
    /// The page of a check-up.
    Checkup(Box<CheckupReport>),
    /// Poses and sequences.
    Poses(PoseLibrary),
    /// What a hand keeps, as it was read.
    Params(Box<ParamsFile>),
    /// What trials measured of a hand.
    Overshoot(Arc<OvershootMap>),
}

impl Export {
    /// The name that is suggested for the file.
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

    /// Entries in it; a picture is one.
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

/// Writes into the folder of the day in the user's documents, under a name that is free; where there are none, asks for
/// a place. What to tell the user of it.
pub(crate) fn save(content: Export, env: &Env) -> BackgroundJob<NoticeKind> {
    let chosen = match &env.documents {
        Some(documents) => {
            let folder = day_folder::of_day(documents, &calendar::day(calendar::since_1970()));
            let path = day_folder::free_path(&folder, content.file_name());
            Box::pin(std::future::ready(Some(path)))
        }
        None => env.files.choose(content.file_name()),
    };
    BackgroundJob::start(&env.runtime, &env.wake, async move {
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
    })
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
