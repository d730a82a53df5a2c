//! `export`: writes recordings, or a time range of each, in another format; `recover`: repairs a damaged one.

use crate::cli::out::ending::EndFlag;
use crate::cli::out::failure::FailureKind;
use crate::cli::out::progress::ProgressLine;
use crate::cli::out::{Out, ReaderGone, WrongUsage, notify};
use crate::cli::recordings::picture;
use crate::cli::recordings::recording_file::{
    self, FileArgs, StretchArgs, is_standard, lost, report_remarks,
};
use crate::record::export::{
    Destination, EpisodeCounts, EpisodeStart, ExportError, ExportFormat, ExportOptions,
    ExportSource, ExportSummary, Exported, LeRobotPlan, OutputKind, cut,
};
use crate::record::file::RecordingFile;
use crate::record::file::reader::TimeRange;
use anyhow::{anyhow, bail};
use serde_json::json;
use std::io::{self, IsTerminal as _};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(crate) struct ExportArgs {
    /// Recording files, as 'handscope record' and the window write them; - reads one from standard input
    #[arg(value_name = "FILE.mcap", required = true, num_args = 1..)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    output: ExportOutput,
    #[command(flatten)]
    stretch: StretchArgs,
    /// The file or folder to write, which must not exist yet; of several recordings a folder; - is standard output
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    /// With --lerobot: frames a second [default: 30]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=200))]
    fps: Option<u32>,
    /// With --lerobot: what the hand does, in words [default: the note that begins the episode, or grasp]
    #[arg(long, value_name = "WORDS")]
    task: Option<String>,
    /// With --lerobot: where an episode begins: after a silence, or at each note [default: gaps]
    #[arg(long, value_name = "WHERE")]
    episode: Option<Episodes>,
    /// With --lerobot: write a set also if no joint was commanded, so that its actions mean nothing
    #[arg(long)]
    uncommanded: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Where episodes begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Episodes {
    Gaps,
    Notes,
}

/// The output, named by one flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ExportOutput {
    Format(ExportFormat),
    /// A picture of the window.
    Picture,
}

impl ExportOutput {
    /// All outputs, in the order of the help.
    fn all() -> Vec<Self> {
        let mut formats = ExportFormat::ALL.to_vec();
        // The data set is last, because only it has options of its own.
        formats.sort_by_key(|format| *format == ExportFormat::LeRobot);
        let formats = formats.into_iter().map(Self::Format);
        formats.chain([Self::Picture]).collect()
    }

    /// Name of the flag.
    const fn name(self) -> &'static str {
        match self {
            Self::Format(format) => format.properties().name,
            Self::Picture => "png",
        }
    }

    fn flag(self) -> clap::Arg {
        let help = match self {
            Self::Format(format) => format.properties().description,
            Self::Picture => "A picture of the window, its plots over the stretch",
        };
        let flag = clap::Arg::new(self.name()).long(self.name()).help(help);
        flag.action(clap::ArgAction::SetTrue)
    }
}

impl clap::Args for ExportOutput {
    fn augment_args(command: clap::Command) -> clap::Command {
        let all = Self::all();
        let group = clap::ArgGroup::new("output").required(true);
        let group = group.args(all.iter().map(|output| output.name()));
        let flags = all.into_iter().map(Self::flag);
        command.args(flags).group(group)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl clap::FromArgMatches for ExportOutput {
    fn from_arg_matches(matches: &clap::ArgMatches) -> Result<Self, clap::Error> {
        let named = Self::all()
            .into_iter()
            .find(|output| matches.get_flag(output.name()));
        named.ok_or_else(|| clap::Error::new(clap::error::ErrorKind::MissingRequiredArgument))
    }

    fn update_from_arg_matches(&mut self, matches: &clap::ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[derive(Debug, clap::Args)]
pub(crate) struct RecoverArgs {
    #[command(flatten)]
    file: FileArgs,
    /// The copy to write; it must not exist yet [default: FILE-recovered.mcap, beside the file]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(out: &mut Out, args: &ExportArgs) -> anyhow::Result<()> {
    args.check()?;
    let mut files: Vec<RecordingFile> = Vec::new();
    for path in &args.files {
        // Several files of one recording, as matched by a pattern like *.mcap, are one recording.
        let file = path.canonicalize();
        let file = file.unwrap_or_else(|_unknown| path.clone());
        let is_it =
            |open: &Path| open.canonicalize().is_ok_and(|open| open == file) || open == path;
        if !files.iter().flat_map(RecordingFile::paths).any(is_it) {
            files.push(recording_file::open_or_stdin(path)?);
        }
    }
    files.iter().for_each(report_remarks);
    let named = |file: &RecordingFile| match args.stretch.of(file) {
        Err(why) if files.len() > 1 => Err(why.context(file.path().display().to_string())),
        stretch => stretch,
    };
    let stretches: Vec<TimeRange> = files.iter().map(named).collect::<anyhow::Result<_>>()?;
    let format = match args.output {
        ExportOutput::Format(format) => format,
        ExportOutput::Picture => {
            let (Some(file), Some(stretch)) = (files.first(), stretches.first()) else {
                return Ok(());
            };
            return picture(out, args, file, *stretch);
        }
    };
    let summary = write(args, format, &files, &stretches)?;
    report(out, args, format, &files, &summary)
}

/// Writes the export, with progress over all recordings.
fn write(
    args: &ExportArgs,
    format: ExportFormat,
    files: &[RecordingFile],
    stretches: &[TimeRange],
) -> anyhow::Result<ExportSummary> {
    // Standard output leaves no partial file, and its reader may stop reading.
    let (to, wished) = if is_standard(&args.out) {
        (Destination::Stdout, EndFlag::never())
    } else {
        (Destination::Path(args.out.clone()), EndFlag::listen()?)
    };
    let progress = ProgressLine::new();
    let watch = |number: usize| {
        let (progress, wished) = (&progress, &wished);
        move |share: f64| {
            progress.report(share_of_all(number, share, files.len()));
            wished.flow()
        }
    };
    let watches: Vec<_> = (0..files.len()).map(watch).collect();
    let sources = files.iter().zip(stretches).zip(&watches);
    let sources = sources.map(|((file, stretch), watch)| ExportSource {
        file,
        stretch: *stretch,
        watch,
    });
    let sources: Vec<ExportSource<'_>> = sources.collect();
    let written = format.write(&sources, &to, &args.options());
    written.map_err(explained)
}

impl ExportArgs {
    /// Checks that clap cannot do.
    fn check(&self) -> anyhow::Result<()> {
        // clap does not require a flag that conflicts with another one of its group.
        let of_sets = self.fps.is_some() || self.task.is_some() || self.episode.is_some();
        let of_sets = of_sets || self.uncommanded;
        if self.output != ExportOutput::Format(ExportFormat::LeRobot) && of_sets {
            return Err(WrongUsage::error(
                "--fps, --task, --uncommanded and --episode are for --lerobot; leave them out, or export with --lerobot",
            ));
        }
        let from_stdin = self.files.iter().filter(|file| is_standard(file)).count();
        if from_stdin > 1 {
            return Err(WrongUsage::error(
                "standard input holds one file: write - once",
            ));
        }
        if self.output == ExportOutput::Picture && (self.files.len() > 1 || from_stdin > 0) {
            return Err(WrongUsage::error(
                "--png draws one recording: name its file",
            ));
        }
        if !is_standard(&self.out) {
            return Ok(());
        }
        let kind = match self.output {
            ExportOutput::Format(format) => Some(format.properties().kind),
            ExportOutput::Picture => None,
        };
        let why = match kind {
            _ if self.files.len() > 1 => {
                "of several recordings a folder is made: name it with --out"
            }
            Some(OutputKind::Folder) => "this format is a folder: name it with --out",
            None => "a picture is a file: name it with --out",
            _ if self.json => "standard output holds what is exported: leave out --json",
            Some(OutputKind::Text) => return Ok(()),
            Some(OutputKind::Binary) if io::stdout().is_terminal() => {
                "this format is not text for a terminal: pipe it into a program, or name a file with --out"
            }
            Some(OutputKind::Binary) => return Ok(()),
        };
        Err(WrongUsage::error(why))
    }

    fn options(&self) -> ExportOptions {
        let default = LeRobotPlan::default();
        ExportOptions {
            lerobot: LeRobotPlan {
                fps: self.fps.unwrap_or(default.fps),
                task: self.task.clone(),
                episodes: match self.episode {
                    Some(Episodes::Notes) => EpisodeStart::Note,
                    Some(Episodes::Gaps) => EpisodeStart::Gap,
                    None => default.episodes,
                },
                uncommanded: self.uncommanded,
            },
        }
    }
}

/// Total progress when recording `number` is at this share.
fn share_of_all(number: usize, share: f64, all: usize) -> f64 {
    let count = |number: usize| f64::from(u32::try_from(number).unwrap_or(u32::MAX));
    (count(number) + share) / count(all.max(1))
}

fn report(
    out: &mut Out,
    args: &ExportArgs,
    format: ExportFormat,
    files: &[RecordingFile],
    summary: &ExportSummary,
) -> anyhow::Result<()> {
    let mut all = Exported::default();
    for (file, recording) in files.iter().zip(&summary.recordings) {
        if let Some(words) = lost(&recording.damage) {
            notify(&format!("{} is damaged: {words}", file.path().display()));
        }
        if recording.rows == 0 && files.len() > 1 {
            notify(&format!(
                "there is nothing to export of {}",
                file.path().display()
            ));
        }
        all.rows += recording.rows;
        all.readings = recording.readings;
        all.damage.add(&recording.damage);
    }
    let unit = format.properties().unit;
    let mut line = format!("{} {unit} in {}", all.rows, args.out.display());
    let mut object = as_json(&args.out, &all);
    if let Some(counts) = &summary.episodes {
        line = format!("{line}, {} episodes", counts.episodes);
        if let Some(fields) = object.as_object_mut() {
            fields.insert("episodes".into(), counts.episodes.into());
            for (name, count) in [
                ("action_uncommanded_episodes", counts.uncommanded),
                ("action_read_back_frames", counts.read_back),
                ("action_unfollowed_frames", counts.unfollowed),
            ] {
                fields.insert(name.into(), count.into());
            }
        }
        warn_actions(counts, all.rows);
    }
    if is_standard(&args.out) {
        notify(&format!("{} {unit}", all.rows));
    } else {
        out.result(args.json, &object, [line])?;
    }
    if all.readings == Some(0) {
        bail!(
            "the hand was not read in this time range, so the export has no readings; 'handscope info' shows where that is so"
        );
    }
    Ok(())
}

fn warn_actions(counts: &EpisodeCounts, frames: u64) {
    if counts.uncommanded > 0 {
        notify(&format!(
            "in {} of {} episodes no joint was commanded: 'action' is there what the hand held before, and says nothing about what moved it",
            counts.uncommanded, counts.episodes
        ));
    }
    if counts.unfollowed > 0 {
        let joints = counts.unfollowed_joints.iter().filter(|(_, moved)| **moved);
        let joints: Vec<&str> = joints.map(|(dof, _)| dof.name()).collect();
        notify(&format!(
            "in {} of {frames} frames a joint ({}) moved while its 'action' stood still: something moved it that the recording does not show",
            counts.unfollowed,
            joints.join(", ")
        ));
    }
    if counts.read_back > 0 {
        notify(&format!(
            "in {} of {frames} frames something other than the recorded commands set a target, another controller or the hand itself for a gesture: 'action' is there what the hand held when it was read, up to half a second late",
            counts.read_back
        ));
    }
}

fn picture(
    out: &mut Out,
    args: &ExportArgs,
    file: &RecordingFile,
    stretch: TimeRange,
) -> anyhow::Result<()> {
    let drawn = picture::draw(file, stretch, &args.out);
    drawn.map_err(|error| match error.downcast() {
        Ok(error) => explained(error),
        Err(error) => error,
    })?;
    let exported = Exported {
        rows: 1,
        ..Exported::default()
    };
    let line = format!("1 picture in {}", args.out.display());
    out.result(args.json, &as_json(&args.out, &exported), [line])
}

/// Writes a repaired copy of a file that is damaged or was not closed.
pub(crate) fn recover(out: &mut Out, args: &RecoverArgs) -> anyhow::Result<()> {
    let path = &args.file.file;
    let file = recording_file::open(path)?;
    report_remarks(&file);
    let to = args.out.clone().unwrap_or_else(|| beside(path));
    let wished = EndFlag::listen()?;
    let progress = ProgressLine::new();
    let watch = |share: f64| {
        progress.report(share);
        wished.flow()
    };
    let source = ExportSource {
        file: &file,
        stretch: TimeRange::WHOLE,
        watch: &watch,
    };
    let recovered = cut::recover(source, &Destination::Path(to.clone()));
    drop(progress);
    let recovered = recovered.map_err(explained)?;
    let mut lines = vec![format!("{} entries in {}", recovered.rows, to.display())];
    lines.push(match (lost(&recovered.damage), file.is_closed()) {
        (Some(words), _) => format!("lost: {words}"),
        (None, true) => "nothing was lost: the file was whole".into(),
        (None, false) => "nothing that was on the disk was lost; the file was not closed".into(),
    });
    let mut object = as_json(&to, &recovered);
    if let Some(fields) = object.as_object_mut() {
        fields.insert("was_closed".into(), file.is_closed().into());
    }
    out.result(args.json, &object, lines)?;
    if recovered.rows == 0 {
        bail!("{} holds no entry that can be read", path.display());
    }
    Ok(())
}

fn beside(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-recovered.mcap"))
}

fn as_json(path: &Path, exported: &Exported) -> serde_json::Value {
    json!({
        "file": path,
        "rows": exported.rows,
        "damaged_chunks": exported.damage.chunks,
        "damaged_bytes": exported.damage.bytes,
    })
}

/// An export error with advice.
pub(crate) fn explained(error: ExportError) -> anyhow::Error {
    match error {
        ExportError::Exists { .. } => {
            FailureKind::File.error(format!("{error}; name another place with --out"))
        }
        ExportError::Unwritable { .. } => {
            FailureKind::File.error(format!("{error}; choose a folder that exists and has room"))
        }
        ExportError::Unreadable { .. } => {
            FailureKind::File.error(format!("{error}; nothing was written"))
        }
        ExportError::Interrupted => {
            FailureKind::Interrupted.error(format!("{error}; nothing was written"))
        }
        ExportError::Empty => anyhow!(
            "{error}; 'handscope info' shows what a recording holds, --from and --to choose of it"
        ),
        ExportError::NoNotes => anyhow!("{error}; leave out --episode notes"),
        ExportError::NeverCommanded => anyhow!(
            "{error}; record while the hand is moved from here, by the window, a script, 'follow' or a client of 'share', or write the set nevertheless with --uncommanded"
        ),
        ExportError::BothSides => anyhow!("{error}; make a set of each"),
        ExportError::ReaderGone => ReaderGone.into(),
    }
}
